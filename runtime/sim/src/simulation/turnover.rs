//! Agents that come and go between two steps. Removals come first in a step, births last, so the frames before and after
//! a step both show exactly the agents that were planned in it. World, metres, seconds.

use glam::Vec2;

use crate::agents::Removal;
use crate::population::{AgentId, AgentLife, drawn_stature};
use crate::route::arrival::is_at_goal;
use crate::scenario::ranges::{AGENTS_MAX, check_agent};
use crate::scenario::{AgentSpec, AtGoal, SourceSpec};
use crate::simulation::Simulation;
use crate::synthesis::library::context_of;

/// Rounding of discs that are meant to touch, m.
const TOUCH_M: f32 = 1e-4;
/// Positions that a source with an area tries in a frame before it counts as blocked.
const TRIES: usize = 10;

impl Simulation {
    /// Adds an agent, which stands at its start and takes part from the next step on. None where it has no room: its
    /// disc overlaps another or a wall. None, too, where it is no valid agent of a scenario, where its style is none of
    /// the scenario's, where it stays out of a set of zones that no agent or source of the scenario stays out of, or a
    /// million have been.
    pub fn add(&mut self, spec: AgentSpec) -> Option<AgentId> {
        let is_state = spec.state == 0 || (spec.state as usize) < self.scenario.behaviour.states.len();
        let is_style = (spec.style as usize) < self.contexts.len();
        let is_valid =
            is_state && is_style && check_agent(0, &spec).is_ok() && self.population.agents.len() < AGENTS_MAX;
        // Walls and meshes are made for the sets of the scenario.
        let has_walls = spec.closed_zones == 0 || self.zone_walls.of(spec.closed_zones).is_some();
        let has_room = is_valid && has_walls && self.has_room(&spec);
        has_room.then(|| self.bear(spec, None))
    }

    /// Removes an agent: the next step begins without it, or a later one. Until then it goes on as it went. Returns
    /// whether the agent is present.
    pub fn remove(&mut self, id: AgentId, removal: Removal) -> bool {
        let Ok(index) = self.agents.ids.binary_search(&id) else { return false };
        let pending = &mut self.agents.removals[index];
        if *pending != Some(Removal::AtOnce) {
            *pending = Some(removal);
        }
        true
    }

    /// Removes the agents whose time has come; those that have arrived at a goal where they leave are among them.
    pub(super) fn remove_leaving_agents(&mut self) {
        self.note_arrivals();
        let agents = &mut self.agents;
        if agents.removals.iter().all(Option::is_none) {
            return;
        }
        let stays = |(removal, is_between_steps): (&Option<Removal>, &bool)| match removal {
            None => true,
            Some(Removal::AtOnce) => false,
            Some(Removal::BetweenSteps) => !is_between_steps,
        };
        let keeps: Vec<bool> = agents.removals.iter().zip(&agents.are_between_steps).map(stays).collect();
        for (id, _) in agents.ids.iter().zip(&keeps).filter(|(_, keep)| !**keep) {
            self.population.agents[id.index()].removed = Some(self.steps + 1);
        }
        agents.retain(&keeps);
        self.crowd.retain(&keeps);
    }

    /// Marks the agents that have arrived at a goal where they leave.
    fn note_arrivals(&mut self) {
        for index in 0..self.agents.count() {
            if !self.follows_path(index) {
                continue;
            }
            let (agents, population) = (&mut self.agents, &self.population);
            let id = agents.ids[index];
            let spec = population.spec(id);
            let removal = match spec.at_goal {
                AtGoal::Stay => continue,
                AtGoal::Leave => Removal::BetweenSteps,
                AtGoal::LeaveAtOnce => Removal::AtOnce,
            };
            let has_arrived = is_at_goal(spec, agents.positions_m[index], &mut agents.progress[index]);
            if agents.removals[index].is_none() && has_arrived {
                agents.removals[index] = Some(removal);
            }
        }
    }

    /// Lets the sources place the agents that are due, as far as there is room.
    pub(super) fn bear_due_agents(&mut self) {
        let now_s = f64::from(self.steps) * f64::from(self.scenario.dt_s);
        for source in 0..self.sources.len() {
            let due = self.sources[source].due_until(now_s);
            self.population.sources[source].waiting += due;
            while self.population.sources[source].waiting > 0 {
                let is_placed = self.place_agent_of(source);
                let count = &mut self.population.sources[source];
                if !is_placed {
                    count.blocked_frames += 1;
                    break;
                }
                count.waiting -= 1;
                count.born += 1;
            }
        }
    }

    /// Places one agent of a source where there is room, near the first member of its group. Returns whether there is.
    fn place_agent_of(&mut self, source: usize) -> bool {
        let born = self.population.sources[source].born;
        let spec = self.scenario.sources[source].drawn(self.scenario.seed, source, born);
        let tries = if spec.low_m == spec.high_m { 1 } else { TRIES };
        let group = self.sources[source].group_of_next(AgentId::from(self.population.agents.len()));
        let first = group.and_then(|group| self.population.agents.get(group.first as usize));
        let (first_m, first_begins_s) = match first {
            Some(first) => (Some(first.spec.position_m), first.spec.pre_movement_s),
            None => (None, spec.pre_movement_s),
        };
        let mut nearest: Option<Vec2> = None;
        for _ in 0..tries {
            let position_m = spec.position_m(&mut self.sources[source].positions);
            let is_nearer = match (nearest, first_m) {
                (Some(nearest_m), Some(first_m)) => first_m.distance(position_m) < first_m.distance(nearest_m),
                _ => true,
            };
            if is_nearer && self.has_room(&self.dressed(spec.agent(position_m))) {
                nearest = Some(position_m);
                if first_m.is_none() {
                    break;
                }
            }
        }
        let Some(position_m) = nearest else { return false };
        self.sources[source].has_appeared(group);
        let of_state = || self.scenario.behaviour.start_facing_rad(spec.state, position_m);
        let spec = SourceSpec { facing_rad: spec.facing_rad.or_else(of_state), ..spec };
        let agent = AgentSpec { group, pre_movement_s: first_begins_s, ..spec.agent(position_m) };
        self.bear(agent, Some(source as u32));
        true
    }

    /// Whether the discs of an agent overlap neither a present agent nor a wall.
    fn has_room(&self, spec: &AgentSpec) -> bool {
        let &AgentSpec { position_m, radius_m, wall_radius_m, closed_zones, .. } = spec;
        let walls = self.zone_walls.of(closed_zones).unwrap_or(&self.obstacles);
        let agents = &self.agents;
        let mut discs = agents.positions_m.iter().zip(&agents.radii_m);
        let overlaps = discs.any(|(other_m, other_radius_m)| {
            let apart_m = (radius_m + other_radius_m - TOUCH_M).max(0.0);
            position_m.distance_squared(*other_m) < apart_m * apart_m
        });
        !overlaps && walls.depth_m(position_m, wall_radius_m) <= TOUCH_M
    }

    /// The next agent with the radius of its character.
    fn dressed(&self, mut spec: AgentSpec) -> AgentSpec {
        self.scenario.dress(self.population.agents.len() as u32, &mut spec);
        spec
    }

    /// Appends an agent with the next id.
    fn bear(&mut self, spec: AgentSpec, source: Option<u32>) -> AgentId {
        let spec = self.dressed(spec);
        let id = AgentId::from(self.population.agents.len());
        self.has_groups |= spec.group.is_some();
        self.has_priorities |= spec.priority != 0.0;
        Self::add_behaviour(&mut self.crowd, &self.scenario, &spec);
        let stature = drawn_stature(&self.scenario, id, &spec);
        self.agents.push(id, &spec, stature, &self.scenario, context_of(&self.contexts, spec.style));
        let character = self.scenario.character_of(id.0, &spec);
        self.population.agents.push(AgentLife { character, stature, ..AgentLife::new(spec, source, self.steps) });
        self.record_agent(self.agents.count() - 1);
        id
    }
}
