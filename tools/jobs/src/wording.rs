//! Words for numbers, shared by all texts for people.

/// A count with its noun: "1 simplex", "2 simplices".
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
