//! The report of a bench: its details, goals, which depend on the machine, and criteria, which decide.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::Serialize;

/// A value that must hold on every machine: a quality, or a ratio of two durations of one run.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct Criterion {
    /// What is measured, and its unit.
    pub name: Cow<'static, str>,
    /// The measured value; null where nothing could be measured, which misses the criterion.
    pub measured: Option<f64>,
    /// The limit of the value; null where the baseline that gives it could not be measured.
    #[schemars(with = "Option<f64>")]
    pub limit: f64,
    /// Whether the criterion is met.
    pub met: bool,
    #[serde(skip)]
    sign: char,
}

impl Criterion {
    /// The value must not be less than the limit.
    pub fn at_least(name: impl Into<Cow<'static, str>>, limit: f64, measured: impl Into<Option<f64>>) -> Self {
        Self::new(name.into(), '≥', limit, measured.into(), |measured| measured >= limit)
    }

    /// The value must not be greater than the limit.
    pub fn at_most(name: impl Into<Cow<'static, str>>, limit: f64, measured: impl Into<Option<f64>>) -> Self {
        Self::new(name.into(), '≤', limit, measured.into(), |measured| measured <= limit)
    }

    /// The value must be less than a baseline's, or 0.
    pub fn below(name: impl Into<Cow<'static, str>>, limit: f64, measured: impl Into<Option<f64>>) -> Self {
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

/// A duration or size that depends on the machine, and its goal.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct Goal {
    /// What is measured, and its unit.
    pub name: &'static str,
    /// The measured value; null where this system does not report it.
    pub measured: Option<f64>,
    /// The value to reach on a quiet machine.
    pub goal: f64,
}

impl Goal {
    fn line(&self) -> String {
        let measured = self.measured.map_or_else(|| "–".to_owned(), figure);
        format!("goal    {}: {measured}, {}\n", self.name, figure(self.goal))
    }
}

/// A number with as many digits as matter.
fn figure(value: f64) -> String {
    let digits = match value.abs() {
        0.0 | 0.01..10.0 => 3,
        small if small < 0.01 => 6,
        _ => 1,
    };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The result of a bench.
#[derive(JsonSchema, Serialize)]
pub struct BenchReport<T> {
    /// What was measured.
    #[serde(flatten)]
    pub details: T,
    /// Durations and sizes beside their goals. They decide nothing.
    pub goals: Vec<Goal>,
    /// Criteria of a release. The bench answers yes where all are met.
    #[serde(rename = "bars")]
    pub criteria: Vec<Criterion>,
    /// The details as text for people.
    #[serde(skip)]
    pub text: String,
}

impl<T> BenchReport<T> {
    /// Whether every criterion is met.
    pub fn all_met(&self) -> bool {
        self.criteria.iter().all(|criterion| criterion.met)
    }
}

/// The result of any bench, ready to print.
pub struct PrintableReport {
    /// Details, goals and criteria as text for people.
    pub text: String,
    /// The same as JSON.
    pub json: String,
    /// Whether every criterion is met.
    pub all_met: bool,
}

impl<T: Serialize> From<BenchReport<T>> for PrintableReport {
    fn from(report: BenchReport<T>) -> Self {
        let goals: String = report.goals.iter().map(Goal::line).collect();
        let criteria: String = report.criteria.iter().map(Criterion::line).collect();
        Self {
            text: format!("{}{goals}{criteria}", report.text),
            json: serde_json::to_string_pretty(&report).expect("plain structs with string keys serialise"),
            all_met: report.all_met(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_criterion_without_measurement_is_missed() {
        assert!(!Criterion::at_least("share", 0.9, None).met && !Criterion::at_most("rmse", 0.05, f64::NAN).met);
        assert!(Criterion::at_least("share", 0.9, 0.9).met && Criterion::at_most("rmse", 0.05, 0.04).met);
        assert!(!Criterion::below("collisions", 0.1, 0.1).met && Criterion::below("collisions", 0.0, 0.0).met);
    }

    #[test]
    fn figures_keep_the_digits_that_matter() {
        assert_eq!([0.95, 20.0, 0.04567, 123.44].map(figure), ["0.95", "20", "0.046", "123.4"]);
        assert_eq!([0.0, 0.000_123_4, -0.000_02].map(figure), ["0", "0.000123", "-0.00002"]);
    }
}
