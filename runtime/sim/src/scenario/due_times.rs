//! The times at which the agents of a source are due, s.
//!
//! In a span of time with a rate they are a Poisson process: independent gaps with an exponential distribution. It has
//! no memory, so each span of a schedule begins anew.

use crate::maths::random::SplitMix64;
use crate::scenario::schedule::{RateRow, Schedule, TimeRow};

/// The times at which the agents of one source are due, in order, s.
#[derive(Clone, Debug)]
pub struct DueTimes {
    random: SplitMix64,
    now: DueSpan,
    later: std::vec::IntoIter<DueSpan>,
    remaining: u32,
}

/// A part of a schedule, as far as it is still to come.
#[derive(Clone, Copy, Debug)]
enum DueSpan {
    /// Random times until one at a rate.
    Random { now_s: f64, to_s: f64, rate_per_s: f64 },
    /// Agents that are due at once.
    Stated { time_s: f64, count: u32 },
}

impl DueTimes {
    /// The first times of a schedule, at most this number of them.
    pub(crate) fn new(schedule: &Schedule, count_max: u32, random: SplitMix64) -> Self {
        let of_rate = |row: &RateRow| DueSpan::Random {
            now_s: row.from_s.into(),
            to_s: row.to_s.into(),
            rate_per_s: row.rate_per_s.into(),
        };
        let of_time = |row: &TimeRow| DueSpan::Stated { time_s: row.time_s.into(), count: row.count };
        let spans: Vec<DueSpan> = match schedule {
            // No agent is due at a rate of 0.
            Schedule::Rates(rows) => rows.iter().filter(|row| row.rate_per_s > 0.0).map(of_rate).collect(),
            Schedule::Times(rows) => rows.iter().map(of_time).collect(),
        };
        Self { random, now: DueSpan::Stated { time_s: 0.0, count: 0 }, later: spans.into_iter(), remaining: count_max }
    }
}

impl Iterator for DueTimes {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        self.remaining = self.remaining.checked_sub(1)?;
        loop {
            if let Some(due_s) = self.now.next_s(&mut self.random) {
                return Some(due_s);
            }
            let Some(next) = self.later.next() else {
                self.remaining = 0;
                return None;
            };
            self.now = next;
        }
    }
}

impl DueSpan {
    fn next_s(&mut self, random: &mut SplitMix64) -> Option<f64> {
        match self {
            Self::Random { now_s, to_s, rate_per_s } => {
                *now_s -= libm::log(1.0 - random.unit()) / *rate_per_s;
                (*now_s <= *to_s).then_some(*now_s)
            }
            Self::Stated { time_s, count } => {
                *count = count.checked_sub(1)?;
                Some(*time_s)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times_s(schedule: &Schedule, count_max: u32) -> Vec<f64> {
        DueTimes::new(schedule, count_max, SplitMix64::new(1, 0)).collect()
    }

    fn rates(rows: &[[f32; 3]]) -> Schedule {
        Schedule::Rates(rows.iter().map(|&[from_s, to_s, rate_per_s]| RateRow { from_s, to_s, rate_per_s }).collect())
    }

    #[test]
    fn due_times_are_a_poisson_process() {
        let times_s = times_s(&rates(&[[10.0, 1_010.0, 2.0]]), u32::MAX);
        assert!(times_s.is_sorted() && times_s[0] > 10.0 && times_s[times_s.len() - 1] <= 1_010.0);
        // 2000 ± 45 agents, and gaps whose deviation is their mean.
        assert!(times_s.len().abs_diff(2_000) < 150, "{}", times_s.len());
        let gaps_s: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let deviation_s = motiondb::statistics::standard_deviation(gaps_s.iter().copied()).unwrap();
        assert!((deviation_s - 0.5).abs() < 0.05, "{deviation_s}");
    }

    #[test]
    fn each_row_of_a_schedule_has_its_rate() {
        let times_s = times_s(&rates(&[[0.0, 500.0, 0.4], [500.0, 700.0, 0.0], [800.0, 1_000.0, 5.0]]), u32::MAX);
        let between = |from_s, to_s| times_s.iter().filter(|due_s| (from_s..to_s).contains(*due_s)).count();
        assert!(times_s.is_sorted());
        // 200 ± 14 and 1000 ± 32 agents.
        assert!(between(0.0, 500.0).abs_diff(200) < 45, "{}", between(0.0, 500.0));
        assert_eq!(between(500.0, 800.0), 0);
        assert!(between(800.0, 1_000.1).abs_diff(1_000) < 100, "{}", between(800.0, 1_000.1));
    }

    #[test]
    fn stated_times_come_as_stated_up_to_the_count() {
        let row = |time_s, count| TimeRow { time_s, count };
        let schedule = Schedule::Times(vec![row(0.0, 2), row(3.0, 1), row(3.0, 2)]);
        assert_eq!(times_s(&schedule, u32::MAX), [0.0, 0.0, 3.0, 3.0, 3.0]);
        assert_eq!(times_s(&schedule, 3), [0.0, 0.0, 3.0]);
    }
}
