//! Suggestions for a name that does not exist: the existing names, nearest first.

/// The names, sorted by their edit distance to `name`; equally near ones keep their order. Case is ignored.
pub fn nearest_first<'a>(name: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let mut names: Vec<&str> = names.into_iter().collect();
    names.sort_by_cached_key(|other| edit_distance(&name.to_lowercase(), &other.to_lowercase()));
    names
}

/// Number of letters to insert, remove or replace (Levenshtein) to turn `name` into the best part of `other`. Letters
/// of `other` beyond that part cost nothing, so a part of a name is near it.
fn edit_distance(name: &str, other: &str) -> usize {
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
    fn a_part_of_a_name_is_nearest() {
        assert_eq!(edit_distance("walk", "ChrMarine_Walk01".to_lowercase().as_str()), 0);
        assert_eq!(edit_distance("wlak_110", "walk_110"), 2);
        assert_eq!(nearest_first("walk_11", ["run_350", "walk_080", "walk_110"]), ["walk_110", "walk_080", "run_350"]);
    }
}
