//! `schedule` of a source, as written: rows `[from_s, to_s, rate_per_s]`, or rows `[time_s, count]`. Seconds.

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::scenario::error::ScenarioError;
use crate::scenario::fault::TableFault;
use crate::scenario::rules::schedule_check::check_schedule;
use crate::scenario::schedule::{RateRow, Schedule, TimeRow};

/// How to write a row.
const ROWS: &str = "write rows `[from_s, to_s, rate_per_s]`, or rows `[time_s, count]`";

/// Rows of numbers, as written.
#[derive(Debug, Deserialize)]
#[serde(transparent)]
pub(crate) struct ScheduleValue(Vec<Spanned<Vec<f32>>>);

impl ScheduleValue {
    /// The schedule; every mistake is shown at its row.
    pub(crate) fn resolve(value: &Spanned<Self>, source: &SourceText) -> Result<Schedule, ScenarioError> {
        let Self(rows) = value.get_ref();
        let at_row = |row: usize| rows.get(row).map_or_else(|| value.span(), Spanned::span);
        let numbers: Vec<&[f32]> = rows.iter().map(|row| row.get_ref().as_slice()).collect();
        schedule(&numbers).map_err(|(row, (message, help))| source.invalid(at_row(row), message, help).into())
    }
}

/// The schedule of rows of numbers.
///
/// # Errors
/// The first row that is wrong, by index.
pub(super) fn schedule(rows: &[&[f32]]) -> Result<Schedule, (usize, TableFault)> {
    let length = rows.first().map_or(3, |row| row.len());
    let wrong = |(row, numbers): (usize, &&[f32])| Some((row, (row_fault(numbers, length)?, ROWS)));
    if let Some(fault) = rows.iter().enumerate().find_map(wrong) {
        return Err(fault);
    }
    let schedule = match length {
        2 => Schedule::Times(rows.iter().map(|row| TimeRow { time_s: row[0], count: row[1] as u32 }).collect()),
        _ => Schedule::Rates(
            rows.iter().map(|row| RateRow { from_s: row[0], to_s: row[1], rate_per_s: row[2] }).collect(),
        ),
    };
    check_schedule(&schedule).map(|()| schedule)
}

/// What is wrong with the form of a row, where the first row has this many numbers.
fn row_fault(row: &[f32], length: usize) -> Option<String> {
    match *row {
        _ if row.len() != length => Some(format!("the row has {} numbers, but the first row has {length}", row.len())),
        [_, count] if !(count >= 0.0 && count % 1.0 == 0.0) => Some(format!("{count} is no number of agents")),
        [_, _] | [_, _, _] => None,
        _ => Some(format!("the row has {length} numbers")),
    }
}
