//! Many sentences that differ in one number → one sentence with the range of the number: `turn rate 1.1 to 2.8 deg/s
//! taken as 0 (9)`.

use std::collections::BTreeMap;

/// Sentences that are equal but for their first number, and the subjects that they are about.
pub(crate) struct SentenceGroup {
    before: String,
    after: String,
    /// The least and the greatest number as written; none in sentences without a number.
    range: Option<[String; 2]>,
    /// The subjects, in the order of the sentences.
    pub(crate) subjects: Vec<String>,
}

impl SentenceGroup {
    /// The sentence, with the range of its number.
    pub(crate) fn sentence(&self) -> String {
        match &self.range {
            None => self.before.clone(),
            Some([least, greatest]) if least == greatest => format!("{}{least}{}", self.before, self.after),
            Some([least, greatest]) => format!("{}{least} to {greatest}{}", self.before, self.after),
        }
    }
}

/// Groups pairs of subject and sentence; the largest groups first.
pub(crate) fn group(sentences: impl IntoIterator<Item = (String, String)>) -> Vec<SentenceGroup> {
    let mut groups: BTreeMap<(String, String), SentenceGroup> = BTreeMap::new();
    for (subject, sentence) in sentences {
        let (before, number, after) = around_number(&sentence);
        let new =
            || SentenceGroup { before: before.to_owned(), after: after.to_owned(), range: None, subjects: Vec::new() };
        let group = groups.entry((before.to_owned(), after.to_owned())).or_insert_with(new);
        group.subjects.push(subject);
        if !number.is_empty() {
            widen(&mut group.range, number);
        }
    }
    let mut groups: Vec<SentenceGroup> = groups.into_values().collect();
    groups.sort_by_key(|group| std::cmp::Reverse(group.subjects.len()));
    groups
}

/// The text before the first number, the number, and the text after it. Digits within a word, such as a file name, are
/// no number.
fn around_number(sentence: &str) -> (&str, &str, &str) {
    let is_part = |letter: char| letter.is_ascii_digit() || letter == '.' || letter == '-';
    let is_within_word = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '/';
    let mut start = 0;
    while let Some(first) = sentence[start..].find(is_part) {
        start += first;
        let length = sentence[start..].find(|letter: char| !is_part(letter)).unwrap_or(sentence.len() - start);
        let (before, number, after) =
            (&sentence[..start], &sentence[start..start + length], &sentence[start + length..]);
        let stands_alone = !before.ends_with(is_within_word) && !after.starts_with(is_within_word);
        if stands_alone && number.parse::<f64>().is_ok() {
            return (before, number, after);
        }
        start += length;
    }
    (sentence, "", "")
}

/// Widens a range to hold a number.
fn widen(range: &mut Option<[String; 2]>, number: &str) {
    let value = |text: &str| text.parse::<f64>().unwrap_or(0.0);
    let [least, greatest] = range.get_or_insert_with(|| [number.to_owned(), number.to_owned()]);
    if value(number) < value(least) {
        *least = number.to_owned();
    }
    if value(number) > value(greatest) {
        *greatest = number.to_owned();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(sentences: &[&str], wanted: &[(&str, usize)]) {
        let groups = group(sentences.iter().map(|&sentence| ("clip".to_owned(), sentence.to_owned())));
        let found: Vec<(String, usize)> = groups.iter().map(|group| (group.sentence(), group.subjects.len())).collect();
        let wanted: Vec<(String, usize)> = wanted.iter().map(|&(text, count)| (text.to_owned(), count)).collect();
        assert_eq!(found, wanted);
    }

    #[test]
    fn sentences_that_differ_in_a_number_become_one() {
        check(
            &["turn -2.2 deg/s", "no step", "turn 1.6 deg/s", "turn 0.3 deg/s", "1 frame", "1 frame"],
            &[("turn -2.2 to 1.6 deg/s", 3), ("1 frame", 2), ("no step", 1)],
        );
    }

    #[test]
    fn digits_of_file_names_are_no_numbers() {
        let sentences = ["the same take as fps8.bvh", "the same take as fps60.bvh", "the same take as 002_01.bvh"];
        check(&sentences, &[(sentences[2], 1), (sentences[1], 1), (sentences[0], 1)]);
    }
}
