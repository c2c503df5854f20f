//! The rules of schedules: rows in the order of time, numbers in range. Seconds.

use crate::scenario::fault::TableFault;
use crate::scenario::ranges::{AGENTS_MAX, DURATION_S};
use crate::scenario::schedule::{RateRow, Schedule, TimeRow};

/// Greatest number of rows: one for each 9 s of a day.
pub(crate) const ROWS_MAX: usize = 10_000;
/// Greatest number of agents per second of a source: the flow through a gate of 500 m.
pub(crate) const RATE_MAX_PER_S: f32 = 1_000.0;

/// The first row that breaks a rule, what is wrong with it, and how to mend it.
pub(crate) fn check_schedule(schedule: &Schedule) -> Result<(), (usize, TableFault)> {
    let rows = match schedule {
        Schedule::Rates(rows) => rows.len(),
        Schedule::Times(rows) => rows.len(),
    };
    if !(1..=ROWS_MAX).contains(&rows) {
        let message = format!("a schedule has 1 to {ROWS_MAX} rows, this one has {rows}");
        return Err((0, (message, "write `schedule = [[from_s, to_s, rate_per_s], …]`")));
    }
    let fault = |row| match schedule {
        Schedule::Rates(rows) => rate_fault(rows, row).map(|fault| (row, fault)),
        Schedule::Times(rows) => time_fault(rows, row).map(|fault| (row, fault)),
    };
    (0..rows).find_map(fault).map_or(Ok(()), Err)
}

fn rate_fault(rows: &[RateRow], row: usize) -> Option<TableFault> {
    let RateRow { from_s, to_s, rate_per_s } = rows[row];
    let before_s = row.checked_sub(1).map_or(0.0, |before| rows[before].to_s);
    let end_s = *DURATION_S.end();
    if from_s < before_s {
        let message = format!("the row begins at {from_s} s, before the row above ends at {before_s} s");
        return Some((message, "sort the rows by time, so that none overlaps another"));
    }
    if !(from_s < to_s && to_s <= end_s) {
        let message = format!("the row lasts from {from_s} s to {to_s} s");
        return Some((message, "write `[from_s, to_s, rate_per_s]`, with rising times of 0 to 86400 s"));
    }
    let message = format!("the rate is {rate_per_s} agents per second, not within 0 and {RATE_MAX_PER_S}");
    let is_rate = (0.0..=RATE_MAX_PER_S).contains(&rate_per_s);
    (!is_rate).then_some((message, "give the mean number of agents per second"))
}

fn time_fault(rows: &[TimeRow], row: usize) -> Option<TableFault> {
    let TimeRow { time_s, count } = rows[row];
    let before_s = row.checked_sub(1).map_or(0.0, |before| rows[before].time_s);
    if time_s < before_s {
        let message = format!("the row is at {time_s} s, after one at {before_s} s");
        return Some((message, "sort the rows by time"));
    }
    if !(0.0..=*DURATION_S.end()).contains(&time_s) {
        return Some((format!("the time is {time_s} s"), "give a time of 0 to 86400 s"));
    }
    let message = format!("the number of agents is {count}, not between 1 and {AGENTS_MAX}");
    let is_count = (1..=AGENTS_MAX).contains(&(count as usize));
    (!is_count).then_some((message, "write `[time_s, count]`, with a whole number of agents"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_that_is_no_number_is_found() {
        let rates =
            |from_s, to_s, rate_per_s| check_schedule(&Schedule::Rates(vec![RateRow { from_s, to_s, rate_per_s }]));
        assert!(rates(0.0, 1.0, 0.0).is_ok());
        let nan = f32::NAN;
        for (from_s, to_s, rate_per_s) in [(nan, 1.0, 1.0), (0.0, nan, 1.0), (0.0, 1.0, nan), (-1.0, 1.0, 1.0)] {
            assert!(rates(from_s, to_s, rate_per_s).is_err(), "{from_s} {to_s} {rate_per_s}");
        }
        assert!(check_schedule(&Schedule::Times(vec![TimeRow { time_s: nan, count: 1 }])).is_err());
        assert!(check_schedule(&Schedule::Times(Vec::new())).is_err());
    }
}
