//! Stage 1 of a step for one agent: what its state wants, or its own waypoints, becomes v_pref and facing. World, metres.

use glam::Vec2;

use crate::behaviour::{AgentState, Aim};
use crate::route::braking::Braking;
use crate::route::crowd_routes::{MeshClass, RouteEnd, RouteMemory};
use crate::route::path::{self, PathProgress, PreferredMotion, RouteView, Walker};
use crate::scenario::places::state_zones::StateZones;
use crate::scenario::ranges::COORDINATE_MAX_M;
use crate::scenario::{AgentSpec, AtGoal};

/// An agent that walks.
pub(super) struct PathWalker<'a> {
    spec: &'a AgentSpec,
    /// Its state; none in a scenario without states.
    state: Option<&'a AgentState>,
    position_m: Vec2,
    /// The zones that its routes do not enter, by bits.
    closed_zones: u32,
}

impl<'a> PathWalker<'a> {
    pub(super) fn new(
        spec: &'a AgentSpec,
        state: Option<&'a AgentState>,
        position_m: Vec2,
        state_zones: &StateZones,
    ) -> Self {
        let closed_zones = state_zones.for_routes(spec.closed_zones, state.map_or(0, |state| state.state as usize));
        Self { spec, state, position_m, closed_zones }
    }

    /// The motion that it prefers.
    pub(super) fn preferred_motion(
        &self,
        view: &RouteView,
        progress: &mut PathProgress,
        memory: &mut RouteMemory,
    ) -> PreferredMotion {
        let Some(state) = self.state else { return self.motion_along_path(view, progress, memory) };
        progress.arrived &= !state.has_new_aim;
        match state.aim {
            Aim::OwnPath => self.motion_along_path(view, progress, memory),
            Aim::Goal { position_m, .. } | Aim::Position(position_m) => {
                let end = RouteEnd { position_m, area: state.goal.map(|goal| goal.at) };
                path::motion_towards(&self.walker(state), &end, view, &mut progress.arrived, memory)
            }
            // Beyond all scenarios it stands.
            Aim::Velocity(_) if self.position_m.abs().max_element() > COORDINATE_MAX_M => PreferredMotion::default(),
            Aim::Velocity(velocity_mps) => PreferredMotion::ahead(velocity_mps),
            Aim::Stay { .. } | Aim::Leave { .. } => PreferredMotion::default(),
        }
    }

    fn walker(&self, state: &AgentState) -> Walker {
        let (position_m, wall_radius_m) = (self.position_m, self.spec.wall_radius_m);
        let class = MeshClass::new(wall_radius_m, self.closed_zones);
        Walker { position_m, speed_mps: state.traits.preferred_speed_mps, wall_radius_m, class }
    }

    /// The motion along its own waypoints, at the speed of its state.
    fn motion_along_path(
        &self,
        view: &RouteView,
        progress: &mut PathProgress,
        memory: &mut RouteMemory,
    ) -> PreferredMotion {
        let view = match self.spec.at_goal {
            AtGoal::Stay => *view,
            AtGoal::Leave | AtGoal::LeaveAtOnce => RouteView { braking: Braking::Not, ..*view },
        };
        let speed_mps = self.state.map_or(self.spec.preferred_speed_mps, |state| state.traits.preferred_speed_mps);
        if speed_mps == self.spec.preferred_speed_mps && self.closed_zones == self.spec.closed_zones {
            return path::preferred_motion(self.spec, self.position_m, &view, progress, memory);
        }
        let closed_zones = self.closed_zones;
        let spec = AgentSpec { preferred_speed_mps: speed_mps, closed_zones, ..self.spec.clone() };
        path::preferred_motion(&spec, self.position_m, &view, progress, memory)
    }
}
