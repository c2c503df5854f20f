//! What a bench demands: bars, which decide the exit code, and goals, which depend on the machine and do not.

use std::borrow::Cow;

use serde::Serialize;

use crate::failure::{Answer, Failure};
use crate::output;

/// One figure that must hold wherever it is measured: a quality, or a ratio of two times of one run.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Bar {
    pub(super) name: Cow<'static, str>,
    /// Null where there was nothing to measure: the bar is missed then.
    pub(super) measured: Option<f64>,
    pub(super) limit: f64,
    pub(super) met: bool,
    #[serde(skip)]
    sign: char,
}

impl Bar {
    pub(super) fn at_least(name: impl Into<Cow<'static, str>>, limit: f64, measured: impl Into<Option<f64>>) -> Self {
        Self::new(name.into(), '≥', limit, measured.into(), |measured| measured >= limit)
    }

    pub(super) fn at_most(name: impl Into<Cow<'static, str>>, limit: f64, measured: impl Into<Option<f64>>) -> Self {
        Self::new(name.into(), '≤', limit, measured.into(), |measured| measured <= limit)
    }

    /// Less than a rival's figure, or as nothing as it.
    pub(super) fn below(name: impl Into<Cow<'static, str>>, limit: f64, measured: impl Into<Option<f64>>) -> Self {
        Self::new(name.into(), '<', limit, measured.into(), |measured| measured < limit || measured == 0.0)
    }

    fn new(
        name: Cow<'static, str>,
        sign: char,
        limit: f64,
        measured: Option<f64>,
        meets: impl FnOnce(f64) -> bool,
    ) -> Self {
        Self { name, measured, limit, met: measured.is_some_and(meets), sign }
    }

    fn line(&self) -> String {
        let verdict = if self.met { "met   " } else { "MISSED" };
        let measured = self.measured.map_or_else(|| "–".to_owned(), figure);
        format!("{verdict}  {}: {measured}, {} {}\n", self.name, self.sign, figure(self.limit))
    }
}

/// An absolute time or size beside what is hoped for.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Goal {
    pub(super) name: &'static str,
    /// Null where this system does not tell.
    pub(super) measured: Option<f64>,
    pub(super) goal: f64,
}

impl Goal {
    fn line(&self) -> String {
        let measured = self.measured.map_or_else(|| "–".to_owned(), figure);
        format!("goal    {}: {measured}, {}\n", self.name, figure(self.goal))
    }
}

/// As many digits as count.
fn figure(value: f64) -> String {
    let digits = match value.abs() {
        0.0 | 0.01..10.0 => 3,
        small if small < 0.01 => 6,
        _ => 1,
    };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// What a bench found; its JSON ends with the bars.
#[derive(Serialize)]
pub(super) struct Found<T: Serialize> {
    #[serde(flatten)]
    pub(super) details: T,
    pub(super) goals: Vec<Goal>,
    pub(super) bars: Vec<Bar>,
}

/// Prints what was found, the bars last; no where a bar is missed.
pub(super) fn conclude<T: Serialize>(found: &Found<T>, text: &str, json: bool) -> Result<Answer, Failure> {
    if json {
        output::print_json(found)?;
    } else {
        let goals: String = found.goals.iter().map(Goal::line).collect();
        let bars: String = found.bars.iter().map(Bar::line).collect();
        output::print(&format!("{text}{goals}{bars}"))?;
    }
    Ok(if found.bars.iter().all(|bar| bar.met) { Answer::Yes } else { Answer::No })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_without_a_measurement_is_missed() {
        assert!(!Bar::at_least("share", 0.9, None).met && !Bar::at_most("rmse", 0.05, f64::NAN).met);
        assert!(Bar::at_least("share", 0.9, 0.9).met && Bar::at_most("rmse", 0.05, 0.04).met);
        assert!(!Bar::below("collisions", 0.1, 0.1).met && Bar::below("collisions", 0.0, 0.0).met);
    }

    #[test]
    fn figures_keep_what_counts() {
        assert_eq!([0.95, 20.0, 0.04567, 123.44].map(figure), ["0.95", "20", "0.046", "123.4"]);
        assert_eq!([0.0, 0.000_123_4, -0.000_02].map(figure), ["0", "0.000123", "-0.00002"]);
    }
}
