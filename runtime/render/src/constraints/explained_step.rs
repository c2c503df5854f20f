//! The replanned step of one agent: the data for its panel and its marks.

use fbcrowd_sim::AgentId;
use fbcrowd_sim::planning::orca::HalfPlaneSource;
use fbcrowd_sim::planning::{PlanExplanation, Planner};
use fbcrowd_sim::recording::RecordedStep;
use glam::Vec2;

/// Limits of the axes' half-width, as multiples of the preferred speed. Between these limits the half-width is the
/// database's greatest speed.
const AXIS_LIMITS_OF_PREFERRED: [f32; 2] = [1.5, 1.75];
/// Least preferred speed that determines the axes' half-width, m/s: a slow walk.
const MIN_PREFERRED_MPS: f32 = 0.5;
/// Factor on the axes' half-width: a margin beyond the greatest speed.
const AXIS_MARGIN: f32 = 1.08;

/// One agent in one step, with the explanation of its plan.
#[derive(Debug)]
pub(crate) struct ExplainedStep<'a> {
    /// The recorded step.
    pub(crate) step: &'a RecordedStep<'a>,
    /// Index of the agent among those of the step.
    pub(crate) agent: usize,
    /// Plan of the agent, with its half-planes and forces, whose sources are ids here.
    pub(crate) explanation: PlanExplanation,
    /// Greatest velocity component that is shown, m/s.
    pub(crate) axis_limit_mps: f32,
}

impl<'a> ExplainedStep<'a> {
    /// Plans the step of an agent again.
    pub(crate) fn new(step: &'a RecordedStep<'a>, agent: usize) -> Self {
        let scenario = &step.header().scenario;
        let mut explanation = PlanExplanation::new(scenario.planner, &step.world(), agent, &scenario.params);
        // Pictures name agents by their ids.
        let half_planes = explanation.half_planes.iter_mut().map(|half_plane| &mut half_plane.source);
        for source in half_planes.chain(explanation.forces.iter_mut().map(|force| &mut force.source)) {
            if let HalfPlaneSource::Agent(index) = source {
                *index = step.before[*index as usize].id.0;
            }
        }
        Self { step, agent, explanation, axis_limit_mps: axis_limit_mps(step, agent) }
    }

    /// Id of the agent with an index.
    pub(crate) fn id(&self, agent: usize) -> AgentId {
        self.step.before[agent].id
    }

    /// Planner of the step.
    pub(crate) fn planner(&self) -> Planner {
        self.step.header().scenario.planner
    }
}

/// Greatest velocity component that is shown. It does not depend on the step, so all pictures of a sequence have equal
/// axes.
fn axis_limit_mps(step: &RecordedStep, agent: usize) -> f32 {
    let hull = step.velocity_hull(agent);
    let corners_mps = hull.turning_mps.iter().chain(&hull.holding_mps);
    let fastest_mps = corners_mps.map(|corner_mps: &Vec2| corner_mps.length()).fold(0.0, f32::max);
    let preferred_mps = step.spec(agent).preferred_speed_mps.max(MIN_PREFERRED_MPS);
    let [least, most] = AXIS_LIMITS_OF_PREFERRED.map(|factor| factor * preferred_mps);
    AXIS_MARGIN * (step.speed_factor(agent) * fastest_mps).clamp(least, most)
}
