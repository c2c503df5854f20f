//! Names that several things share, told apart: the first keeps the name, the others get `_2`, `_3` … appended.
//!
//! Which is first must not depend on folders or on the order of arguments: callers sort by content before.

use std::collections::{BTreeMap, BTreeSet};

/// Makes names unique. No name that was given is taken away from whoever had it first.
pub(crate) fn tell_apart<'a>(names: impl Iterator<Item = &'a mut String>) {
    let names: Vec<&mut String> = names.collect();
    let mut taken: BTreeSet<String> = names.iter().map(|name| (**name).clone()).collect();
    let mut last_number: BTreeMap<String, usize> = BTreeMap::new();
    for name in names {
        let Some(number) = last_number.get_mut(name) else {
            last_number.insert(name.clone(), 1);
            continue;
        };
        let numbered = || {
            *number += 1;
            Some(format!("{name}_{number}"))
        };
        let free = std::iter::from_fn(numbered).find(|other| taken.insert(other.clone()));
        *name = free.expect("numbers do not end before names do");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_keeps_its_name_and_no_number_is_given_twice() {
        let mut names = ["walk", "run", "walk", "walk_2", "walk"].map(str::to_owned);
        tell_apart(names.iter_mut());
        assert_eq!(names, ["walk", "run", "walk_3", "walk_2", "walk_4"]);
    }

    #[test]
    fn thousands_of_one_name_are_told_apart_quickly() {
        let mut names = vec!["walk".to_owned(); 10_000];
        tell_apart(names.iter_mut());
        assert_eq!(names[9_999], "walk_10000");
    }
}
