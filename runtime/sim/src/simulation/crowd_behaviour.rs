//! Stage 0 of a step: the state machine decides what each agent wants, and the simulation takes it over. World, metres,
//! seconds.
//!
//! Without states in the scenario nothing here acts, and every agent follows its waypoints.

use glam::Vec2;

use crate::agents::{Agents, Removal};
use crate::behaviour::{Aim, CrowdBehaviour, CrowdView, GoalRef, Movement, Traits};
use crate::population::{Population, RadiusChange, SignalChange};
use crate::route::crowd_routes::{CrowdRoutes, MeshClass};
use crate::scenario::{AgentSpec, Scenario, WALL_RADIUS_M};
use crate::simulation::Simulation;
use crate::synthesis::library::context_of;

/// Rounding of discs that are meant to touch a wall, m.
const TOUCH_M: f32 = 1e-4;

impl Simulation {
    /// The behaviour of an agent that is born.
    pub(super) fn add_behaviour(crowd: &mut CrowdBehaviour, scenario: &Scenario, spec: &AgentSpec) {
        if !scenario.behaviour.states.is_empty() {
            let &AgentSpec { preferred_speed_mps, radius_m, position_m, state, .. } = spec;
            crowd.add(state, Traits { preferred_speed_mps, radius_m }, position_m);
        }
    }

    /// Lets every agent decide what it wants, from positions as the last step left them.
    pub(super) fn decide(&mut self) {
        let leads = if self.has_groups { self.walking_groups().leads(self.agents.count()) } else { Vec::new() };
        let Self {
            scenario, agents, population, obstacles, zone_walls, state_zones, routes, doors, crowd, steps, ..
        } = self;
        let behaviour = &scenario.behaviour;
        if behaviour.states.is_empty() && behaviour.events.is_empty() {
            return;
        }
        let closed_zones = |index: usize, state: u32| {
            state_zones.for_routes(population.spec(agents.ids[index]).closed_zones, state as usize)
        };
        let to_area_m = |routes: &CrowdRoutes, (index, state): (usize, u32), from_m: Vec2, at: GoalRef| {
            let GoalRef { set, area } = at;
            let area = &behaviour.goals[set as usize].areas[area as usize].area;
            let wall_radius_m = population.spec(agents.ids[index]).wall_radius_m;
            routes.to_area_m(MeshClass::new(wall_radius_m, closed_zones(index, state)), from_m, at, area)
        };
        let open_route_m = |of: (usize, u32), from_m: Vec2, at: GoalRef| to_area_m(routes.all_open(), of, from_m, at);
        let view = CrowdView {
            time_s: f64::from(*steps) * f64::from(scenario.dt_s),
            seed: scenario.seed,
            ids: &agents.ids,
            positions_m: &agents.positions_m,
            leads: &leads,
            route_m: &|of, from_m, at| to_area_m(routes.present(), of, from_m, at),
            open_route_m: doors.is_any_red().then_some(&open_route_m),
            path_end_m: &|index| path_end_m(agents, population, index),
            has_come_to_goal: &|index| agents.progress[index].arrived,
            has_begun: &|index| population.agents[agents.ids[index].index()].begins_at(scenario.dt_s) <= *steps,
            is_clear: &|(index, state), position_m| {
                let walls = zone_walls.of(closed_zones(index, state)).unwrap_or(obstacles);
                walls.depth_m(position_m, WALL_RADIUS_M) <= TOUCH_M
            },
        };
        crowd.decide(behaviour, &view);
        population.goals.iter_mut().zip(&crowd.waiting).for_each(|(count, &waiting)| count.add(waiting));
        let change = |&(signal, order): &(usize, _)| SignalChange { frame: *steps, signal: signal as u32, order };
        population.signals.extend(crowd.ordered.iter().map(change));
        self.take_over_states();
    }

    /// Takes over radii and removals from the states.
    fn take_over_states(&mut self) {
        let Self { scenario, agents, population, crowd, state_zones, steps, .. } = self;
        for (index, state) in crowd.agents.iter().enumerate() {
            let life = &mut population.agents[agents.ids[index].index()];
            agents.priorities[index] = scenario.behaviour.priority(state.state as usize, life.spec.priority);
            if agents.radii_m[index] != state.traits.radius_m {
                life.radii_m.push(RadiusChange { frame: *steps + 1, radius_m: state.traits.radius_m });
                agents.radii_m[index] = state.traits.radius_m;
                agents.wall_radii_m[index] = life.wall_radius_m(*steps + 1);
            }
            let (position_m, wall_radius_m) = (agents.positions_m[index], agents.wall_radii_m[index]);
            let (own, state_index) = (life.spec.closed_zones, state.state as usize);
            agents.closed_zones[index] = state_zones.for_walls(own, state_index, position_m, wall_radius_m);
            if let Aim::Leave { at_once } = state.aim
                && agents.removals[index].is_none()
            {
                agents.removals[index] = Some(if at_once { Removal::AtOnce } else { Removal::BetweenSteps });
            }
        }
    }

    /// Whether an agent, by index, follows its own waypoints.
    pub(super) fn follows_path(&self, index: usize) -> bool {
        let states = &self.scenario.behaviour.states;
        self.crowd.agents.get(index).is_none_or(|agent| states[agent.state as usize].movement == Movement::OwnPath)
    }

    /// Moves agents to where their states want them at once; there they stand.
    pub(super) fn teleport(&mut self) {
        let Self { agents, population, crowd, scenario, contexts, steps, .. } = self;
        for &(id, position_m) in &crowd.teleports {
            let Ok(index) = agents.ids.binary_search(&id) else { continue };
            let context = context_of(contexts, agents.styles[index]);
            agents.stand_at(index, position_m, scenario, context);
            population.agents[id.index()].teleports.push(*steps);
        }
    }
}

/// Distance of an agent to the end of its own waypoints, m; none before it has passed all others.
fn path_end_m(agents: &Agents, population: &Population, index: usize) -> Option<f32> {
    let spec = population.spec(agents.ids[index]);
    let is_last = agents.progress[index].is_at_last(spec);
    spec.goals_m.last().filter(|_| is_last).map(|goal_m| goal_m.distance(agents.positions_m[index]))
}
