//! A scenario file in a folder of its own, and how its mistakes are checked.

use std::fs;
use std::path::PathBuf;

use fbcrowd_sim::scenario::{Invalid, Scenario, ScenarioError, read};

use crate::common::folder;

pub(crate) const HEAD: &str = "clips = \".\"\nduration_s = 10\n";
pub(crate) const BLOCK: &str = "[[20, 20], [22, 20], [22, 22], [20, 22]]";
pub(crate) const ONE: &str = "agents = { at_m = [0, 0], goals_m = [[5, 0]] }\n";

pub(crate) fn write(test: &str, text: &str) -> PathBuf {
    let path = folder(test).join("scene.toml");
    fs::write(&path, text).unwrap();
    path
}

pub(crate) fn scenario(test: &str, body: &str) -> Scenario {
    read(&write(test, &format!("{HEAD}{body}"))).unwrap().0
}

/// Checks that reading fails, at exactly this part of the text, with a message that contains these words.
pub(crate) fn check_rejected(test: &str, text: &str, part: &str, message: &str) {
    match read(&write(test, text)).and_then(|(scenario, motion)| Ok((scenario, motion?))) {
        Err(ScenarioError::Invalid(invalid)) => check_points_at(&invalid, part, message),
        other => panic!("{text} gave {other:?}"),
    }
}

pub(crate) fn check_points_at(invalid: &Invalid, part: &str, message: &str) {
    assert!(invalid.message.contains(message), "{invalid}");
    assert_eq!(&invalid.text[invalid.span.clone()], part, "{invalid}");
    assert!(!invalid.help.is_empty());
}

/// Checks that a fault is shown at the line of its table, or at the key of the table that the message names first.
pub(crate) fn check_at_table_or_key(invalid: &Invalid, table_line: usize) {
    let line = invalid.text.lines().nth(invalid.line() - 1).unwrap();
    let is_named = line.split_once(" = ").is_some_and(|(key, _)| invalid.message.starts_with(&format!("{key} ")));
    assert!(invalid.line() == table_line || invalid.line() > table_line && is_named, "{invalid}");
}
