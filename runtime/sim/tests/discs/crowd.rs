//! A crowd of discs without bodies, moved by the planner alone or through a lag and a turn rate like a body's. World,
//! metres, seconds, radians.

use std::path::Path;

use fbcrowd_sim::measures::Collisions;
use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::mcn::MotionConstraints;
use fbcrowd_sim::planning::{Plan, Planner, PlannerMemory, Stance, WorldView, plan, ranking_horizon_s};
use fbcrowd_sim::route::{Braking, CrowdRoutes, KeepSide, PathProgress, RouteMemory, RouteView, preferred_motion};
use fbcrowd_sim::scenario::AgentSpec;
use fbcrowd_sim::world::neighbours::NeighbourSearch;
use fbcrowd_sim::world::obstacles::Obstacles;
use glam::Vec2;
use motiondb::velocity_sets::velocity_hull::VelocityHull;

/// Radius of the discs, m: the protocol of `assets/scenarios/table1`.
pub(crate) const RADIUS_M: f32 = 0.25;
/// Preferred speed, m/s: of the same protocol.
const SPEED_MPS: f32 = 1.33;
/// Distance from the goal at which a disc has arrived, m.
const ARRIVED_M: f32 = 0.5;
/// Speed below which a disc stands, m/s.
const STALL_SPEED_MPS: f32 = 0.1;
/// Time of standing that counts as stalling, s.
const STALL_S: f32 = 5.0;

/// How discs respond to their plans.
#[derive(Clone, Copy)]
pub(crate) enum DiscResponse {
    /// At once.
    Immediate,
    /// Velocity with a time constant, s, facing at a rate, rad/s.
    Lagging(f32, f32),
}

/// The planner and its surroundings.
#[derive(Clone, Copy)]
pub(crate) struct CrowdSetting<'a> {
    pub(crate) planner: Planner,
    pub(crate) params: &'a Params,
    pub(crate) hull: &'a VelocityHull,
    pub(crate) walls: &'a Obstacles,
    pub(crate) response: DiscResponse,
    pub(crate) dt_s: f32,
}

pub(crate) struct DiscCrowd {
    positions_m: Vec<Vec2>,
    agents: Vec<AgentSpec>,
    progress: Vec<PathProgress>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    radii_m: Vec<f32>,
    plans: Vec<Plan>,
    neighbours: NeighbourSearch,
    slow_s: Vec<f32>,
    arrivals_s: Vec<Option<f32>>,
}

/// Measures of a run: C and A of `FbCrowd` App. 11, arrivals and stalls.
#[derive(Debug, Default)]
pub(crate) struct CrowdFigures {
    /// C, Eq. 17.
    pub(crate) collisions: f32,
    /// A, Eq. 18, m/s².
    pub(crate) acceleration_mps2: f32,
    pub(crate) arrived: usize,
    pub(crate) stalled: usize,
    /// Positions, step by step, m.
    pub(crate) trails_m: Vec<Vec<Vec2>>,
}

/// Starts and goals of a bundled scene: lines `x y goal_x goal_y`.
pub(crate) fn bundled_scene(name: &str) -> Vec<(Vec2, Vec2)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../assets/scenarios/{name}.txt"));
    let text = std::fs::read_to_string(path).unwrap();
    let agent = |line: &str| {
        let numbers: Vec<f32> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        (Vec2::new(numbers[0], numbers[1]), Vec2::new(numbers[2], numbers[3]))
    };
    text.lines().filter(|line| !line.starts_with('#')).map(agent).collect()
}

impl DiscCrowd {
    /// Agents from starts to goals, all through the door first, if there is one.
    pub(crate) fn new(agents: &[(Vec2, Vec2)], door_m: Option<Vec2>) -> Self {
        let count = agents.len();
        let spec = |&(from_m, to_m): &(Vec2, Vec2)| AgentSpec {
            position_m: from_m,
            facing_rad: libm::atan2f(to_m.y - from_m.y, to_m.x - from_m.x),
            goals_m: door_m.into_iter().chain([to_m]).collect(),
            radius_m: RADIUS_M,
            wall_radius_m: RADIUS_M,
            preferred_speed_mps: SPEED_MPS,
            ..AgentSpec::default()
        };
        let agents: Vec<AgentSpec> = agents.iter().map(spec).collect();
        Self {
            positions_m: agents.iter().map(|agent| agent.position_m).collect(),
            velocities_mps: vec![Vec2::ZERO; count],
            facings_rad: agents.iter().map(|agent| agent.facing_rad).collect(),
            radii_m: vec![RADIUS_M; count],
            plans: vec![Plan::default(); count],
            neighbours: NeighbourSearch::default(),
            progress: vec![PathProgress::default(); count],
            slow_s: vec![0.0; count],
            arrivals_s: vec![None; count],
            agents,
        }
    }

    /// The crowd with every agent's back to its goal.
    pub(crate) fn turned_about(mut self) -> Self {
        self.facings_rad.iter_mut().for_each(|facing_rad| *facing_rad += std::f32::consts::PI);
        self
    }

    /// Runs until all agents are at their goals at once, or the time is over.
    pub(crate) fn run(&mut self, setting: &CrowdSetting, duration_s: f32) -> CrowdFigures {
        let dt_s = setting.dt_s;
        let mut figures = CrowdFigures::default();
        let mut collisions = Collisions::default();
        let mut steps = 0;
        while steps as f32 * dt_s < duration_s && !(0..self.agents.len()).all(|agent| self.is_at_goal(agent)) {
            self.plan(setting);
            let before_m = self.positions_m.clone();
            figures.acceleration_mps2 += self.advance(setting.response, dt_s);
            collisions.push(&self.radii_m, &before_m, &self.positions_m);
            figures.trails_m.push(self.positions_m.clone());
            steps += 1;
            self.note_arrivals_and_stalls(steps as f32 * dt_s, dt_s);
        }
        figures.collisions = collisions.rate() as f32;
        figures.acceleration_mps2 /= (steps * self.positions_m.len()) as f32;
        figures.arrived = self.arrivals_s.iter().flatten().count();
        figures.stalled = self.slow_s.iter().filter(|&&slow_s| slow_s >= STALL_S).count();
        figures
    }

    fn plan(&mut self, setting: &CrowdSetting) {
        let horizon_s = ranking_horizon_s(setting.planner, setting.params);
        self.neighbours.rebuild(&self.positions_m, &self.velocities_mps, &self.radii_m, horizon_s);
        let count = self.plans.len();
        let preferred_mps = self.follow_paths(setting);
        let planned_mps: Vec<Vec2> = self.plans.iter().map(|plan| plan.velocity_mps).collect();
        let strafing_s: Vec<f32> = self.plans.iter().map(|plan| plan.strafing_s).collect();
        let stepping_back_s: Vec<f32> = self.plans.iter().map(|plan| plan.stepping_back_s).collect();
        let free_speeds_mps: Vec<f32> = self.agents.iter().map(|agent| agent.preferred_speed_mps).collect();
        let world = WorldView {
            positions_m: &self.positions_m,
            velocities_mps: &self.velocities_mps,
            facings_rad: &self.facings_rad,
            radii_m: &self.radii_m,
            wall_radii_m: &self.radii_m,
            preferred_mps: &preferred_mps,
            free_speeds_mps: &free_speeds_mps,
            facing_offsets_rad: &vec![0.0; count],
            stances: &vec![Stance::default(); count],
            planned_mps: &planned_mps,
            strafing_s: &strafing_s,
            stepping_back_s: &stepping_back_s,
            neighbours: &self.neighbours,
            obstacles: setting.walls,
            own_walls: None,
            one_way: &[],
            priorities: None,
            constraints: &MotionConstraints::new(setting.hull),
            own_constraints: None,
            speed_factors: None,
            dt_s: setting.dt_s,
            bodies: matches!(setting.response, DiscResponse::Lagging(..)),
        };
        let mut memory = PlannerMemory::default();
        let mut planned = |agent| plan(setting.planner, &world, agent, setting.params, &mut memory);
        self.plans = (0..count).map(&mut planned).collect();
    }

    fn follow_paths(&mut self, setting: &CrowdSetting) -> Vec<Vec2> {
        let braking = match setting.response {
            DiscResponse::Immediate => Braking::Within(setting.dt_s),
            DiscResponse::Lagging(..) => Braking::Evenly,
        };
        let view = RouteView {
            routes: &CrowdRoutes::default(),
            doors: None,
            obstacles: setting.walls,
            keep: KeepSide::Right,
            braking,
            coasting_mps: Vec2::ZERO,
        };
        let agents = self.agents.iter().zip(&self.positions_m).zip(&mut self.progress);
        agents
            .map(|((agent, &position_m), progress)| {
                preferred_motion(agent, position_m, &view, progress, &mut RouteMemory::default()).velocity_mps
            })
            .collect()
    }

    /// Moves all agents by one step; returns the sum of their accelerations, m/s².
    fn advance(&mut self, response: DiscResponse, dt_s: f32) -> f32 {
        let mut accelerations_mps2 = 0.0;
        for (agent, plan) in self.plans.iter().enumerate() {
            let (velocity_mps, facing_rad) =
                response.follow(self.velocities_mps[agent], self.facings_rad[agent], plan, dt_s);
            accelerations_mps2 += velocity_mps.distance(self.velocities_mps[agent]) / dt_s;
            self.velocities_mps[agent] = velocity_mps;
            self.facings_rad[agent] = facing_rad;
            self.positions_m[agent] += dt_s * velocity_mps;
        }
        accelerations_mps2
    }

    fn is_at_goal(&self, agent: usize) -> bool {
        let goal_m = *self.agents[agent].goals_m.last().unwrap();
        self.positions_m[agent].distance(goal_m) <= ARRIVED_M
    }

    fn note_arrivals_and_stalls(&mut self, time_s: f32, dt_s: f32) {
        for agent in 0..self.positions_m.len() {
            if self.arrivals_s[agent].is_none() && self.is_at_goal(agent) {
                self.arrivals_s[agent] = Some(time_s);
            }
            let slow = self.velocities_mps[agent].length() < STALL_SPEED_MPS && self.arrivals_s[agent].is_none();
            if self.slow_s[agent] < STALL_S {
                self.slow_s[agent] = if slow { self.slow_s[agent] + dt_s } else { 0.0 };
            }
        }
    }
}

impl DiscResponse {
    fn follow(self, velocity_mps: Vec2, facing_rad: f32, plan: &Plan, dt_s: f32) -> (Vec2, f32) {
        let Self::Lagging(lag_s, turn_rad_s) = self else { return (plan.velocity_mps, plan.facing_rad) };
        let off_rad = libm::remainderf(plan.facing_rad - facing_rad, std::f32::consts::TAU);
        let turn_rad = off_rad.clamp(-turn_rad_s * dt_s, turn_rad_s * dt_s);
        (velocity_mps.lerp(plan.velocity_mps, 1.0 - libm::expf(-dt_s / lag_s)), facing_rad + turn_rad)
    }
}
