//! `schedule` of a source, as written: rows `[from_s, to_s, rate_per_s]`, or rows `[time_s, count]`. Seconds.

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::scenario::error::ScenarioError;
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
        let length = rows.first().map_or(3, |row| row.get_ref().len());
        for (row, numbers) in rows.iter().enumerate() {
            if let Some(message) = row_fault(numbers.get_ref(), length) {
                return Err(source.invalid(at_row(row), message, ROWS).into());
            }
        }
        let numbers = rows.iter().map(|row| row.get_ref().as_slice());
        let schedule = match length {
            2 => Schedule::Times(numbers.map(|row| TimeRow { time_s: row[0], count: row[1] as u32 }).collect()),
            _ => Schedule::Rates(
                numbers.map(|row| RateRow { from_s: row[0], to_s: row[1], rate_per_s: row[2] }).collect(),
            ),
        };
        let fault = |(row, (message, help))| source.invalid(at_row(row), message, help).into();
        check_schedule(&schedule).map(|()| schedule).map_err(fault)
    }
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
