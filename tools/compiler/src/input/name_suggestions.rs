//! Names that are near to one that nobody has: what a misspelt name may have been meant to be.

/// The names, those first that a person may have meant; of equally near ones in the order in which they came.
pub fn nearest_first<'a>(name: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let mut names: Vec<&str> = names.into_iter().collect();
    names.sort_by_cached_key(|other| edits(&name.to_lowercase(), &other.to_lowercase()));
    names
}

/// Letters to be put in, taken out or changed (Levenshtein). To go on where a name ends costs nothing: a part of a name
/// is near it.
fn edits(name: &str, other: &str) -> usize {
    let mut costs: Vec<usize> = vec![0; other.chars().count() + 1];
    for (row, letter) in name.chars().enumerate() {
        let mut diagonal = costs[0];
        costs[0] = row + 1;
        for (column, other_letter) in other.chars().enumerate() {
            let change = diagonal + usize::from(letter != other_letter);
            diagonal = costs[column + 1];
            costs[column + 1] = change.min(diagonal + 1).min(costs[column] + 1);
        }
    }
    costs.into_iter().min().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_name_is_nearer_than_another_name() {
        assert_eq!(edits("walk", "ChrMarine_Walk01".to_lowercase().as_str()), 0);
        assert_eq!(edits("wlak_110", "walk_110"), 2);
        assert_eq!(nearest_first("walk_11", ["run_350", "walk_080", "walk_110"]), ["walk_110", "walk_080", "run_350"]);
    }
}
