//! The command group of a body's state: the command, and the state that it depends on.
//!
//! Plans are in the world, parameters (v_f, ω_t, ω_s) in the body's frame; m/s, rad/s.

use motiondb::motion::Parameters;

use crate::planning::plan::Plan;
use crate::synthesis::blending::Reachable;
use crate::synthesis::command::blend_query::{requested_of_base_walk, requested_of_blending};
use crate::synthesis::command::command_filter::CommandFilter;
use crate::synthesis::command::displacement_accumulator::DisplacementAccumulator;
use crate::synthesis::command::step_state::StepState;
use crate::synthesis::semi_procedural::BaseWalk;
use crate::synthesis::{SynthesisContext, TimeStep, Traits};

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

    /// Follows a plan. `deformed` is the base walk and its current parameters in semi-procedural locomotion, `None`
    /// while the body blends. Returns what the examples reach of the command.
    pub(crate) fn follow(
        &mut self,
        plan: &Plan,
        facing_rad: f32,
        deformed: Option<(&BaseWalk, Parameters)>,
        traits: &Traits,
        context: &SynthesisContext,
        step: &TimeStep,
    ) -> Reachable {
        let Self { filter, step_state, .. } = self;
        let SynthesisContext { domain, params, .. } = context;
        match deformed {
            None => filter.follow(requested_of_blending(plan, facing_rad, domain, params), step_state.stands, step),
            Some((base_walk, current)) => {
                let turning_rad = step.dt_s * current.turn_rate_rad_s;
                filter.turn(turning_rad);
                filter.follow(requested_of_base_walk(plan, facing_rad, turning_rad, base_walk, params), false, step);
            }
        }
        step_state.reachable(filter, domain, traits)
    }
}
