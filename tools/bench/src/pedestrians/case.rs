//! A test of a crowd: its scenarios, its criterion, and the measures that tests have in common. World, metres, seconds.

use fbcrowd_sim::measures::{EgressMeasures, Gate, Passages};
use fbcrowd_sim::scenario::Scenario;
use glam::Vec2;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::report::Criterion;
use crate::kit::scenario_run::{ScenarioFile, ScenarioRun, scenario};

/// A test: what is simulated, and how it is judged.
pub(crate) struct CrowdCase {
    /// Name of the test among the arguments of the bench.
    pub(crate) key: &'static str,
    /// What the test shows.
    pub(crate) test: &'static str,
    /// The criterion in words.
    pub(crate) criterion: &'static str,
    /// The scenarios that are simulated.
    pub(crate) scenarios: fn() -> Result<Vec<Scenario>, BenchError>,
    /// Judges the runs of the scenarios, in their order.
    pub(crate) judge: fn(&[ScenarioRun]) -> CaseOutcome,
}

/// Greatest overlap of two discs, or of a disc and a wall, that touch: rounding of positions, m.
pub(crate) const TOUCH_M: f64 = 1e-3;

/// Greatest overlap that two discs of 0.25 m radius may have, m. It keeps their roots as far apart as a man's chest is deep
/// (Pheasant 1986: 0.215 to 0.285 m).
pub(crate) const OVERLAP_MAX_M: f64 = 0.25;

/// A measure of a test.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct CaseFigure {
    /// Name of the measure, with its unit.
    pub name: String,
    /// The measure; null where nothing could be measured.
    #[schemars(with = "Option<f64>")]
    pub value: f64,
}

/// The outcome of a test.
pub(crate) struct CaseOutcome {
    pub(crate) figures: Vec<CaseFigure>,
    pub(crate) criteria: Vec<Criterion>,
}

/// Scenarios of files, each once.
pub(crate) fn of_files(files: &[ScenarioFile]) -> Result<Vec<Scenario>, BenchError> {
    files.iter().map(|file| scenario(*file)).collect()
}

/// A measure by name.
pub(crate) fn figure(name: impl Into<String>, value: impl Into<Option<f64>>) -> CaseFigure {
    CaseFigure { name: name.into(), value: value.into().unwrap_or(f64::NAN) }
}

/// The gate at x, from one y to another, with all passages in the direction of +x.
pub(crate) fn gate(run: &ScenarioRun, x_m: f32, [low_m, high_m]: [f32; 2]) -> Gate {
    let mut gate = Gate::new([Vec2::new(x_m, high_m), Vec2::new(x_m, low_m)], run.agent_count());
    for step in run.steps() {
        gate.push(&step.before_m, &step.after_m, step.end_s, run.dt_s());
    }
    gate
}

/// Speed of an agent from one gate to another, m/s; none where it does not pass both.
pub(crate) fn speed_mps(agent: usize, gates: &[Gate; 2], apart_m: f64) -> Option<f64> {
    Some(apart_m / (gates[1].passed_s(agent)? - gates[0].passed_s(agent)?))
}

/// Deepest overlap of any two discs, m; all discs have one size.
pub(crate) fn overlap_m(run: &ScenarioRun) -> Option<f64> {
    let reach_m = 2.0 * f64::from(run.scenario.agents[0].radius_m);
    run.measures.minimum_separation_m.map(|separation_m| (reach_m - separation_m).max(0.0))
}

/// The forward passages over a line that the scenario measures.
pub(crate) fn passages<'a>(run: &'a ScenarioRun, line: &str) -> Option<&'a Passages> {
    let place = run.measures.places.iter().find(|place| place.name == line)?;
    Some(&place.line.as_ref()?.forward)
}

/// The egress that the scenario measures.
pub(crate) fn egress(run: &ScenarioRun) -> Option<&EgressMeasures> {
    run.measures.places.iter().find_map(|place| place.egress.as_ref())
}

/// Time at which the last agent left; none where one remains.
pub(crate) fn all_out_s(run: &ScenarioRun) -> Option<f64> {
    egress(run).filter(|egress| egress.remaining == 0)?.last_s
}
