//! A test of a crowd: its scenario, its criterion, and the measures that both have in common. World, metres, seconds.

use fbcrowd_sim::measures::Gate;
use glam::Vec2;
use schemars::JsonSchema;
use serde::Serialize;

use crate::kit::report::Criterion;
use crate::kit::scenario_run::{ScenarioFile, ScenarioRun};

/// A test: what is simulated, and how it is judged.
pub(crate) struct CrowdCase {
    /// Name of the test.
    pub(crate) test: &'static str,
    /// The scenario.
    pub(crate) file: ScenarioFile,
    /// The criterion in words.
    pub(crate) criterion: &'static str,
    /// Angles by which the scenario is turned about the origin; it is simulated once for each, degrees.
    pub(crate) turned_deg: &'static [f32],
    /// Judges the runs, one for each angle.
    pub(crate) judge: fn(&[ScenarioRun]) -> CaseOutcome,
}

/// A scenario that is simulated once, without a turn.
pub(crate) const UNTURNED: &[f32] = &[0.0];
/// Greatest overlap of two discs, or of a disc and a wall, that touch: rounding of positions, m.
pub(crate) const TOUCH_M: f64 = 1e-3;

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
