//! One step of the simulation, in the order of the paper's Fig. 2 (`FbCrowd` §3).
//!
//! 0. behaviour (BFSM, §6): what each agent wants, where the scenario has states (`simulation/crowd_behaviour.rs`);
//! 1. route: the preferred velocity of each agent, v_pref, and what it faces; before it, doors open and close
//!    (`simulation/moving_doors.rs`);
//! 2. neighbours: the agents near each agent;
//! 3. planning (MCN, §4): v_pref becomes a velocity that satisfies the constraints of body, stance foot and crowd;
//! 4. synthesis (HMS, §5): the body follows its plan;
//! 5. coupling (CNS, §3.4): the disc takes the body's position; the step is recorded.
//!
//! Every plan is made from the world as the last step left it, and each body follows its own plan alone. So neither the
//! order of agents nor the number of threads changes a bit. The simulation reads no clock; an observer receives the end
//! of each stage.
//!
//! Agents come and go between steps (`simulation/turnover.rs`): a step begins with the removal of agents that leave, and
//! ends with the birth of agents that are due, which stand at their starts in the frame of that step.
//!
//! World frame; metres, seconds, radians.

use std::sync::Arc;

use glam::{Quat, Vec2};
use motiondb::motion::MotionDb;
use rayon::prelude::*;

use crate::agents::Agents;
use crate::behaviour::{CrowdBehaviour, EndlessTransitions};
use crate::coupling::{body_to_disc, decoupled};
use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::plan::PLANTED_CONTACT;
use crate::planning::plan_all::{self, plan_all};
use crate::planning::planner::ranking_horizon_s;
use crate::planning::world_view::{OwnConstraints, OwnWalls, WorldView};
use crate::population::{AgentLife, Population};
use crate::recording::frame::AgentFrame;
use crate::recording::frame_packing::recorded_offset_rad;
use crate::route::braking::{Braking, coasting_mps};
use crate::route::door_routes::{ClosedDoors, DoorRoutes};
use crate::route::mesh::RouteError;
use crate::route::path::RouteView;
use crate::scenario::Scenario;
use crate::scenario::coupling::Coupling;
use crate::scenario::places::state_zones::StateZones;
use crate::simulation::doors::Doors;
use crate::simulation::path_walker::PathWalker;
use crate::simulation::source_state::SourceState;
use crate::synthesis::library::context_of;
use crate::synthesis::{ExtraState, HmsParams, SynthesisContext, TimeStep};
use crate::world::neighbours::NeighbourSearch;
use crate::world::obstacles::{Obstacles, ZoneWalls};
use crate::world::one_way::OneWayZone;

mod crowd_behaviour;
mod door_waiting;
mod doors;
mod facing_at_rest;
mod moving_doors;
mod path_walker;
mod source_state;
mod standing_crowd;
mod taken_goals;
mod turnover;
mod walking_groups;
mod zones;

/// Bodies that one thread takes at a time, at least: enough to outweigh the hand-over, few enough to share out 100.
const BODIES_PER_TASK_MIN: usize = 16;

/// Routes that one thread takes at a time, at least.
const ROUTES_PER_TASK_MIN: usize = 256;

/// Memory of an agent in the sorted grids of [`NeighbourSearch`], bytes: position, velocity, radius, rank and cells,
/// some of them twice.
const GRID_BYTES: usize = 64;

/// A stage of a step, for measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Preferred velocities.
    Route,
    /// The grid of agents.
    Neighbours,
    /// MCN: plans.
    Planning,
    /// HMS: bodies.
    Synthesis,
    /// CNS, and the recorded frame.
    Coupling,
}

/// A running simulation.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// What bodies move by, for agents without a style, then for each style of the scenario.
    contexts: Vec<SynthesisContext>,
    scenario: Scenario,
    /// The walls, with the doors that are closed now.
    obstacles: Obstacles,
    /// The walls of agents that do not enter some zones.
    zone_walls: ZoneWalls,
    /// The zones that states close.
    state_zones: StateZones,
    one_way: Vec<OneWayZone>,
    routes: DoorRoutes,
    doors: Doors,
    /// Why there are no routes; none of a checked scenario.
    route_error: Option<RouteError>,
    /// The constraints of each context.
    constraints: Vec<MotionConstraints>,
    neighbours: NeighbourSearch,
    planning: plan_all::CrowdPlanningMemory,
    agents: Agents,
    /// State of every present agent, by index; empty without states in the scenario.
    crowd: CrowdBehaviour,
    population: Population,
    /// The state of every source, by index.
    sources: Vec<SourceState>,
    /// Whether any agent is, or a source's may be, in a group.
    has_groups: bool,
    /// Whether agents may have different priorities.
    has_priorities: bool,
    /// Number of steps so far: the index of the present frame.
    steps: u32,
}

impl Simulation {
    /// At time 0: every agent stands at its start.
    pub fn new(db: Arc<MotionDb>, scenario: &Scenario) -> Self {
        let params = HmsParams { modes: scenario.modes(), ..scenario.params.synthesis.clone() };
        let of_style = |style: &String| db.of_style(style).map_or_else(|| db.clone(), |db| Arc::new(db.clone()));
        let databases: Vec<Arc<MotionDb>> = scenario.styles.iter().map(of_style).collect();
        let context = |db| SynthesisContext::new(db, params.clone());
        let contexts: Vec<SynthesisContext> = std::iter::once(db).chain(databases).map(context).collect();
        let (mut agents, mut crowd) = (Agents::default(), CrowdBehaviour::new(&scenario.behaviour));
        let population = Population::of(scenario);
        for (index, AgentLife { spec, stature, .. }) in population.agents.iter().enumerate() {
            Self::add_behaviour(&mut crowd, scenario, spec);
            agents.push(index.into(), spec, *stature, scenario, context_of(&contexts, spec.style));
        }
        let (routes, route_error) = match DoorRoutes::new(scenario) {
            Ok(routes) => (routes, None),
            Err(error) => (DoorRoutes::default(), Some(error)),
        };
        let mut simulation = Self {
            obstacles: scenario.walls(),
            zone_walls: scenario.zone_walls(&[]),
            state_zones: StateZones::new(scenario),
            one_way: scenario.one_way_zones(),
            doors: Doors::new(scenario),
            routes,
            route_error,
            constraints: contexts.iter().map(|context| MotionConstraints::new(&context.db.velocity_hull)).collect(),
            neighbours: NeighbourSearch::default(),
            planning: plan_all::CrowdPlanningMemory::default(),
            population,
            sources: SourceState::all(scenario),
            scenario: scenario.clone(),
            agents,
            crowd,
            contexts,
            has_groups: scenario.has_groups(),
            has_priorities: scenario.has_priorities(),
            steps: 0,
        };
        simulation.close_doors_at_start();
        simulation.bear_due_agents();
        simulation.record();
        simulation
    }

    /// The database that bodies without a style move by: the given one, augmented where it lacks what a crowd needs.
    pub fn database(&self) -> &MotionDb {
        &self.contexts[0].db
    }

    /// The databases of all styles that the scenario names, in their order, augmented.
    pub fn style_databases(&self) -> impl Iterator<Item = &MotionDb> {
        self.contexts[1..].iter().map(|context| &*context.db)
    }

    /// All agents so far, and the counts of the sources.
    pub fn population(&self) -> &Population {
        &self.population
    }

    /// Why no routes were found, where walls allow no mesh: the agents walk straight; or, with closed doors, wait. None
    /// where the scenario was read from a file, which makes the same meshes.
    pub fn route_error(&self) -> Option<&RouteError> {
        self.route_error.as_ref().or(self.routes.error())
    }

    /// Transitions between states that did not end within a step, the first that there were: the scenario is wrong.
    pub fn endless_transitions(&self) -> Option<&EndlessTransitions> {
        self.crowd.endless.as_ref()
    }

    /// The recorded frame of each present agent at the present time, in the order of their ids.
    pub fn frames(&self) -> &[AgentFrame] {
        &self.agents.frames
    }

    /// Rotations of the extra joints of each present agent, in the order of their ids and of the database's extra joints.
    pub fn extra_rotations(&self) -> impl Iterator<Item = &[Quat]> {
        self.agents.extras.iter().map(ExtraState::rotations)
    }

    /// Memory per present agent, bytes: its elements in all arrays, its start and its waypoints.
    pub fn bytes_per_agent(&self) -> usize {
        let lives = &self.population.agents;
        let goals: usize = lives.iter().map(|life| size_of_val(&*life.spec.goals_m)).sum();
        let held = self.agents.size_bytes() + self.planning.size_bytes() + size_of_val(&**lives) + goals;
        held / self.agents.count().max(1) + GRID_BYTES
    }

    /// Advances by the scenario's dt; `finished` receives each stage at its end.
    pub fn step(&mut self, finished: &mut dyn FnMut(Stage)) {
        self.move_doors();
        self.decide();
        self.remove_leaving_agents();
        self.follow_paths();
        self.walk_together();
        self.wait_before_doors();
        self.stand_around_goals();
        self.apply_zones();
        finished(Stage::Route);
        let Agents { positions_m, velocities_mps, radii_m, .. } = &self.agents;
        let Scenario { planner, params, .. } = &self.scenario;
        self.neighbours.rebuild(positions_m, velocities_mps, radii_m, ranking_horizon_s(*planner, params));
        finished(Stage::Neighbours);
        self.plan();
        self.turn_at_rest();
        finished(Stage::Planning);
        self.synthesize();
        finished(Stage::Synthesis);
        body_to_disc::synchronize(&mut self.agents, &self.contexts, self.scenario.dt_s);
        self.steps += 1;
        self.teleport();
        self.bear_due_agents();
        self.record();
        finished(Stage::Coupling);
    }

    fn follow_paths(&mut self) {
        let (keep, dt_s, coupling) = (self.scenario.params.route.keep, self.scenario.dt_s, self.scenario.coupling);
        let Self { agents, population, obstacles, zone_walls, state_zones, routes, doors, crowd, steps, .. } = self;
        let red = ClosedDoors { open_routes: routes.all_open(), leaves: &doors.red_leaves };
        let red = doors.is_any_red().then_some(red);
        let (routes_now, braking) = (routes.present(), Braking::of(coupling, dt_s));
        // `coasting_mps` is a placeholder: that of each agent is set below.
        let view = RouteView { routes: routes_now, doors: red, obstacles, keep, braking, coasting_mps: Vec2::ZERO };
        let passing = doors.passing(agents);
        let view_passing = RouteView { routes: routes.all_open(), doors: None, ..view };
        let Agents { ids, removals, positions_m, velocities_mps, closed_zones, progress, route_memory, .. } = agents;
        let remembered = progress.par_iter_mut().zip(route_memory).with_min_len(ROUTES_PER_TASK_MIN);
        let preferred = agents.preferred_mps.par_iter_mut().zip(&mut agents.facing_offsets_rad);
        let moving = positions_m.par_iter().zip(velocities_mps);
        let present = ids.par_iter().zip(removals).zip(moving.zip(preferred)).enumerate();
        present.zip(remembered).for_each(|((index, ((id, removal), (moving, preferred))), (progress, memory))| {
            let (position_m, velocity_mps) = moving;
            // An agent that leaves goes on as it went: it may have passed its goal.
            if removal.is_some() {
                return;
            }
            let life = &population.agents[id.index()];
            let walker = PathWalker::new(&life.spec, crowd.agents.get(index), *position_m, state_zones);
            let has_begun = life.begins_at(dt_s) <= *steps;
            let view = if passing.get(index) == Some(&true) { &view_passing } else { &view };
            let obstacles = zone_walls.of(closed_zones[index]).unwrap_or(view.obstacles);
            let view = &RouteView { obstacles, coasting_mps: coasting_mps(coupling, *velocity_mps), ..*view };
            let motion = if has_begun { walker.preferred_motion(view, progress, memory) } else { Default::default() };
            let (preferred_mps, facing_offset_rad) = preferred;
            *preferred_mps = motion.velocity_mps;
            *facing_offset_rad = recorded_offset_rad(motion.facing_offset_rad);
        });
    }

    /// The view of the world that planners read. The neighbours are those of the last step's beginning, so they lack
    /// agents that were born since.
    pub fn world(&self) -> WorldView<'_> {
        let agents = &self.agents;
        WorldView {
            positions_m: &agents.positions_m,
            velocities_mps: &agents.velocities_mps,
            facings_rad: &agents.facings_rad,
            radii_m: &agents.radii_m,
            wall_radii_m: &agents.wall_radii_m,
            preferred_mps: &agents.preferred_mps,
            free_speeds_mps: &agents.free_speeds_mps,
            facing_offsets_rad: &agents.facing_offsets_rad,
            stances: &agents.stances,
            planned_mps: &agents.planned_mps,
            strafing_s: &agents.strafing_s,
            stepping_back_s: &agents.stepping_back_s,
            neighbours: &self.neighbours,
            obstacles: &self.obstacles,
            own_walls: (!self.zone_walls.sets.is_empty())
                .then_some(OwnWalls { closed_zones: &agents.closed_zones, zone_walls: &self.zone_walls }),
            one_way: &self.one_way,
            priorities: self.has_priorities.then_some(&agents.priorities[..]),
            constraints: &self.constraints[0],
            own_constraints: (self.constraints.len() > 1)
                .then_some(OwnConstraints { styles: &agents.styles, constraints: &self.constraints }),
            speed_factors: Some(&agents.speed_factors),
            dt_s: self.scenario.dt_s,
            bodies: self.scenario.coupling.plans_for_bodies(),
        }
    }

    fn plan(&mut self) {
        let mut plans = std::mem::take(&mut self.agents.plans);
        let mut planning = std::mem::take(&mut self.planning);
        let Scenario { planner, params, .. } = &self.scenario;
        plan_all(*planner, &self.world(), params, &mut planning, &mut plans);
        (self.agents.plans, self.planning) = (plans, planning);
    }

    fn synthesize(&mut self) {
        let (contexts, agents, obstacles) = (&self.contexts, &mut self.agents, &self.obstacles);
        let zone_walls = &self.zone_walls;
        let Scenario { coupling, dt_s, .. } = self.scenario;
        let time_step = TimeStep::new(dt_s);
        let bodies = agents.bodies.par_iter_mut().with_min_len(BODIES_PER_TASK_MIN);
        let bodies = bodies.zip(&mut agents.extras);
        let written = bodies.zip(&mut agents.stances).zip(&mut agents.frames).zip(&mut agents.are_between_steps);
        let read = agents.plans.par_iter().zip(&agents.statures).zip(&agents.styles);
        let read = read.zip(&agents.wall_radii_m).zip(&agents.closed_zones);
        written.zip(read).for_each(|(written, read)| {
            let ((((body, extra), stance), frame), is_between_steps) = written;
            let ((((plan, stature), &style), &wall_radius_m), &closed_zones) = read;
            let context = context_of(contexts, style);
            let obstacles = zone_walls.of(closed_zones).unwrap_or(obstacles);
            let (plan, step) = (&stature.plan_of_body(plan), &stature.step_of_body(&time_step));
            let from = body.root;
            match coupling {
                Coupling::TwoWay => body.advance_with(extra, context, plan, step),
                Coupling::Discs | Coupling::Decoupled => {
                    body.root = body_to_disc::as_planned(from, plan, step.dt_s);
                }
            }
            let [before, root] = [from, body.root].map(|root| stature.root_of_crowd(root));
            let kept = body_to_disc::outside_walls(before.position_m, root, wall_radius_m, obstacles);
            body.place_root(from.position_m, stature.root_of_body(kept), step.dt_s);
            let output = match coupling {
                Coupling::TwoWay => body.synthesize(context, step),
                Coupling::Decoupled => decoupled::follow(body, context, from, step.dt_s),
                Coupling::Discs => return,
            };
            body.pose_extra(extra, context);
            let output = stature.output_of_crowd(&output);
            *stance = output.stance;
            *is_between_steps = are_between_steps(frame.contacts, output.contacts);
            frame.show(&output);
        });
    }

    fn record(&mut self) {
        (0..self.agents.count()).for_each(|index| self.record_agent(index));
    }

    fn record_agent(&mut self, index: usize) {
        let agents = &mut self.agents;
        let (body, plan, frame) = (&agents.bodies[index], &agents.plans[index], &mut agents.frames[index]);
        *frame = AgentFrame {
            state: self.crowd.agents.get(index).map_or(0, |agent| agent.state as u16),
            root: agents.statures[index].root_of_crowd(body.root),
            preferred_mps: agents.preferred_mps[index],
            facing_offset_rad: agents.facing_offsets_rad[index],
            planned_mps: plan.velocity_mps,
            phase: body.motion.phase,
            mode: body.motion.mode,
            set: plan.set,
            strafing_s: plan.strafing_s,
            stepping_back_s: plan.stepping_back_s,
            ..*frame
        };
    }
}

/// Whether a body is between two steps of its feet, given the contacts before and after a step of time: both feet are
/// planted, or a foot has just landed.
fn are_between_steps(before: [f32; 2], after: [f32; 2]) -> bool {
    let [was_planted, is_planted] = [before, after].map(|contacts| contacts.map(|contact| contact >= PLANTED_CONTACT));
    let has_landed = (0..2).any(|side| is_planted[side] && !was_planted[side]);
    has_landed || is_planted == [true; 2]
}

#[cfg(test)]
pub(crate) mod tests;
