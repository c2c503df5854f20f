//! The command group of a body's state: what its plans want it to do.

use motiondb::motion::Parameters;

use crate::planning::plan::Plan;
use crate::synthesis::blending::Reachable;
use crate::synthesis::command::blend_query::{requested_of_base_walk, requested_of_blending};
use crate::synthesis::command::command_filter::CommandFilter;
use crate::synthesis::command::displacement_accumulator::DisplacementAccumulator;
use crate::synthesis::command::step_state::StepState;
use crate::synthesis::semi_procedural::BaseWalk;
use crate::synthesis::{SynthesisContext, TimeStep};

/// Displacement accumulator, command filter and step state of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CommandState {
    /// Planned displacement that is too slow to walk.
    pub(crate) accumulator: DisplacementAccumulator,
    /// Filter from requested parameters to the command.
    pub(crate) filter: CommandFilter,
    /// Whether the body stands or steps.
    pub(crate) step_state: StepState,
}

impl CommandState {
    /// The state of a body that stands and has no command.
    pub(crate) fn standing() -> Self {
        let (accumulator, filter) = (DisplacementAccumulator::default(), CommandFilter::default());
        Self { accumulator, filter, step_state: StepState::STANDING }
    }

    /// Follows a plan while the body blends. Returns what the examples reach of the command.
    pub(crate) fn follow_blending(
        &mut self,
        plan: &Plan,
        facing_rad: f32,
        context: &SynthesisContext,
        step: &TimeStep,
    ) -> Reachable {
        let requested = requested_of_blending(plan, facing_rad, &context.domain, &context.params);
        self.filter.follow(requested, self.step_state.stands, step);
        self.step_state.reachable(&self.filter, &context.domain)
    }

    /// Follows a plan in semi-procedural locomotion, at present at `current`. Returns what the examples reach of the
    /// command.
    pub(crate) fn follow_base_walk(
        &mut self,
        plan: &Plan,
        facing_rad: f32,
        current: Parameters,
        base_walk: &BaseWalk,
        context: &SynthesisContext,
        step: &TimeStep,
    ) -> Reachable {
        let turning_rad = step.dt_s * current.turn_rate_rad_s;
        self.filter.turn(turning_rad);
        let requested = requested_of_base_walk(plan, facing_rad, turning_rad, base_walk, &context.params);
        self.filter.follow(requested, false, step);
        context.domain.reachable(self.filter.command)
    }
}
