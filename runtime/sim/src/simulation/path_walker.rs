//! Stage 1 of a step for one agent: what its state wants, or its own waypoints, becomes v_pref. World, metres.

use glam::Vec2;

use crate::behaviour::{AgentState, Aim};
use crate::route::crowd_routes::{MeshClass, RouteEnd, RouteMemory};
use crate::route::path::{self, Braking, PathProgress, RouteView, Walker};
use crate::scenario::ranges::COORDINATE_MAX_M;
use crate::scenario::{AgentSpec, AtGoal};

/// An agent that walks.
pub(super) struct PathWalker<'a> {
    pub(super) spec: &'a AgentSpec,
    /// Its state; none in a scenario without states.
    pub(super) state: Option<&'a AgentState>,
    pub(super) position_m: Vec2,
}

impl PathWalker<'_> {
    /// v_pref, m/s.
    pub(super) fn preferred_mps(
        &self,
        view: &RouteView,
        progress: &mut PathProgress,
        memory: &mut RouteMemory,
    ) -> Vec2 {
        let Some(state) = self.state else { return self.along_path_mps(view, progress, memory) };
        progress.arrived &= !state.has_new_aim;
        match state.aim {
            Aim::OwnPath => self.along_path_mps(view, progress, memory),
            Aim::Goal { position_m, .. } | Aim::Position(position_m) => {
                let end = RouteEnd { position_m, area: state.goal.map(|goal| goal.at) };
                path::towards_mps(&self.walker(state), &end, view, &mut progress.arrived, memory)
            }
            // Beyond all scenarios it stands.
            Aim::Velocity(_) if self.position_m.abs().max_element() > COORDINATE_MAX_M => Vec2::ZERO,
            Aim::Velocity(velocity_mps) => velocity_mps,
            Aim::Stay { .. } | Aim::Leave { .. } => Vec2::ZERO,
        }
    }

    fn walker(&self, state: &AgentState) -> Walker {
        let (position_m, wall_radius_m) = (self.position_m, self.spec.wall_radius_m);
        let class = MeshClass::of(self.spec);
        Walker { position_m, speed_mps: state.traits.preferred_speed_mps, wall_radius_m, class }
    }

    /// v_pref along its own waypoints, at the speed of its state, m/s.
    fn along_path_mps(&self, view: &RouteView, progress: &mut PathProgress, memory: &mut RouteMemory) -> Vec2 {
        let view = match self.spec.at_goal {
            AtGoal::Stay => *view,
            AtGoal::Leave | AtGoal::LeaveAtOnce => RouteView { braking: Braking::Not, ..*view },
        };
        let speed_mps = self.state.map_or(self.spec.preferred_speed_mps, |state| state.traits.preferred_speed_mps);
        if speed_mps == self.spec.preferred_speed_mps {
            return path::preferred_mps(self.spec, self.position_m, &view, progress, memory);
        }
        let spec = AgentSpec { preferred_speed_mps: speed_mps, ..self.spec.clone() };
        path::preferred_mps(&spec, self.position_m, &view, progress, memory)
    }
}
