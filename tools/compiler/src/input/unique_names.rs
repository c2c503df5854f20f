//! Unique names: of several equal names the first one stays, the others get `_2`, `_3` … appended.
//!
//! Callers sort by content first, so that neither folders nor the order of arguments decide which one is first.

use std::collections::{BTreeMap, BTreeSet};

/// Makes names unique. A name that occurs in the input keeps its first owner.
pub(crate) fn make_unique<'a>(names: impl Iterator<Item = &'a mut String>) {
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
        *name = free.expect("there are more numbers than names");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_name_stays_and_numbers_are_unique() {
        let mut names = ["walk", "run", "walk", "walk_2", "walk"].map(str::to_owned);
        make_unique(names.iter_mut());
        assert_eq!(names, ["walk", "run", "walk_3", "walk_2", "walk_4"]);
    }

    #[test]
    fn ten_thousand_equal_names_become_unique() {
        let mut names = vec!["walk".to_owned(); 10_000];
        make_unique(names.iter_mut());
        assert_eq!(names[9_999], "walk_10000");
    }
}
