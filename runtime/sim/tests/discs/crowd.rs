//! A crowd of discs that walk as planned, without bodies: moved by the planner alone, or through a lag and a turning rate like a body's.

use std::path::Path;
use std::time::{Duration, Instant};

use fbcrowd_sim::mcn::half_plane::HalfPlane;
use fbcrowd_sim::mcn::orca::{self, Disc};
use fbcrowd_sim::mcn::params::McnParams;
use fbcrowd_sim::mcn::{self, linear_program};
use fbcrowd_sim::neighbours::{Nearest, Neighbours, Query, Ranking};
use fbcrowd_sim::obstacles::Obstacles;
use fbcrowd_sim::plan::{Plan, Stance};
use fbcrowd_sim::planner::Scratch;
use fbcrowd_sim::world::World;
use glam::Vec2;
use motiondb::velocity_hull::VelocityHull;

/// Protocol of `facts/planning.md` §3.
pub(crate) const RADIUS_M: f32 = 0.25;
const SPEED_MPS: f32 = 1.33;
const SPEED_MAX_MPS: f32 = 2.0;
const HORIZON_S: f32 = 5.0;
const RANGE_M: f32 = 10.0;
const ARRIVED_M: f32 = 0.5;
/// A walker slows down within this time of its goal, s: as long as Eq. 9 needs to take a slower velocity up, twice.
const SLOWING_S: f32 = 1.0;
/// Stalled: under this speed, m/s, for this long, s.
const STALL: (f32, f32) = (0.1, 5.0);

/// How discs take up what is planned.
#[derive(Clone, Copy)]
pub(crate) enum Body {
    /// At once.
    Ideal,
    /// Velocity with this time constant, s, facing at this rate, rad/s.
    Lagging(f32, f32),
}

/// Who plans.
pub(crate) enum Planner<'a> {
    /// Only the half-planes of other agents: what RVO2 does.
    Orca,
    /// The whole of §4.
    Mcn(&'a McnParams, &'a VelocityHull, &'a Obstacles),
}

pub(crate) struct Crowd {
    positions_m: Vec<Vec2>,
    goals_m: Vec<Vec2>,
    /// Where all walk first whose x is less than its.
    door_m: Option<Vec2>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    radii_m: Vec<f32>,
    plans: Vec<Plan>,
    neighbours: Neighbours,
    slow_s: Vec<f32>,
    arrivals_s: Vec<Option<f32>>,
}

/// Metrics of `definitions.md`.
#[derive(Debug, Default)]
pub(crate) struct Figures {
    pub(crate) collisions: f32,
    pub acceleration_mps2: f32,
    pub(crate) arrived: usize,
    pub(crate) mean_arrival_s: f32,
    pub(crate) stalled: usize,
    pub(crate) planning_us: f32,
    /// Positions, step by step.
    pub(crate) trails_m: Vec<Vec<Vec2>>,
}

/// Lines `x y goal_x goal_y`; none where the file is missing.
pub(crate) fn read_scene(name: &str) -> Option<Vec<(Vec2, Vec2)>> {
    let path = Path::new("/work/shared/bench/scenes").join(name);
    let text = std::fs::read_to_string(path).ok()?;
    let agent = |line: &str| {
        let numbers: Vec<f32> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        (Vec2::new(numbers[0], numbers[1]), Vec2::new(numbers[2], numbers[3]))
    };
    Some(text.lines().map(agent).collect())
}

impl Crowd {
    pub(crate) fn new(agents: &[(Vec2, Vec2)], door_m: Option<Vec2>) -> Self {
        let count = agents.len();
        let facing = |(from, to): &(Vec2, Vec2)| libm::atan2f(to.y - from.y, to.x - from.x);
        Self {
            positions_m: agents.iter().map(|agent| agent.0).collect(),
            goals_m: agents.iter().map(|agent| agent.1).collect(),
            door_m,
            velocities_mps: vec![Vec2::ZERO; count],
            facings_rad: agents.iter().map(facing).collect(),
            radii_m: vec![RADIUS_M; count],
            plans: vec![Plan::default(); count],
            neighbours: Neighbours::default(),
            slow_s: vec![0.0; count],
            arrivals_s: vec![None; count],
        }
    }

    /// All turn their backs to their goals.
    pub(crate) fn turned_about(mut self) -> Self {
        self.facings_rad.iter_mut().for_each(|facing_rad| *facing_rad += std::f32::consts::PI);
        self
    }

    /// Runs until all have arrived, or the time is over.
    pub(crate) fn run(&mut self, planner: &Planner, body: Body, dt_s: f32, duration_s: f32) -> Figures {
        let mut figures = Figures::default();
        let mut planning = Duration::ZERO;
        let mut steps = 0;
        while steps as f32 * dt_s < duration_s && self.arrivals_s.iter().any(Option::is_none) {
            let start = Instant::now();
            self.plan(planner, dt_s);
            planning += start.elapsed();
            figures.collisions += self.advance(body, dt_s, &mut figures.acceleration_mps2);
            figures.trails_m.push(self.positions_m.clone());
            steps += 1;
            self.notice(steps as f32 * dt_s, dt_s);
        }
        let agent_steps = (steps * self.positions_m.len()) as f32;
        figures.collisions /= agent_steps;
        figures.acceleration_mps2 /= agent_steps;
        figures.planning_us = planning.as_secs_f32() * 1e6 / agent_steps;
        figures.arrived = self.arrivals_s.iter().flatten().count();
        figures.mean_arrival_s = self.arrivals_s.iter().flatten().sum::<f32>() / figures.arrived.max(1) as f32;
        figures.stalled = self.slow_s.iter().filter(|&&slow_s| slow_s >= STALL.1).count();
        figures
    }

    fn plan(&mut self, planner: &Planner, dt_s: f32) {
        self.neighbours.rebuild(&self.positions_m, &self.velocities_mps, &self.radii_m);
        match planner {
            Planner::Orca => self.plan_orca(dt_s),
            Planner::Mcn(params, hull, obstacles) => self.plan_mcn(params, hull, obstacles, dt_s),
        }
    }

    fn plan_orca(&mut self, dt_s: f32) {
        let (mut nearest, mut projected) = (Nearest::default(), Vec::new());
        let disc = |agent: usize| Disc {
            position_m: self.positions_m[agent],
            velocity_mps: self.velocities_mps[agent],
            radius_m: self.radii_m[agent],
        };
        for agent in 0..self.plans.len() {
            let Disc { position_m, velocity_mps, radius_m } = disc(agent);
            self.neighbours.nearest(
                &Query { agent, position_m, velocity_mps, radius_m, range_m: RANGE_M, ranking: Ranking::Distance },
                &mut nearest,
            );
            let half_plane =
                |other: u32| orca::agent_half_plane(&disc(agent), &disc(other as usize), 0.5, other, HORIZON_S, dt_s);
            let found: Vec<HalfPlane> =
                nearest.as_slice().iter().map(|neighbour| half_plane(neighbour.agent)).collect();
            let preferred_mps = self.preferred_mps(agent, dt_s);
            let solution = linear_program::solve(&found, preferred_mps, SPEED_MAX_MPS, &mut projected);
            self.plans[agent].velocity_mps = solution.velocity_mps;
        }
    }

    fn plan_mcn(&mut self, params: &McnParams, hull: &VelocityHull, obstacles: &Obstacles, dt_s: f32) {
        let count = self.plans.len();
        let preferred_mps: Vec<Vec2> = (0..count).map(|agent| self.preferred_mps(agent, SLOWING_S)).collect();
        let strafing_s: Vec<f32> = self.plans.iter().map(|plan| plan.strafing_s).collect();
        let stepping_back_s: Vec<f32> = self.plans.iter().map(|plan| plan.stepping_back_s).collect();
        let world = World {
            positions_m: &self.positions_m,
            velocities_mps: &self.velocities_mps,
            facings_rad: &self.facings_rad,
            radii_m: &self.radii_m,
            preferred_mps: &preferred_mps,
            stances: &vec![Stance::default(); count],
            strafing_s: &strafing_s,
            stepping_back_s: &stepping_back_s,
            neighbours: &self.neighbours,
            obstacles,
            hull,
            dt_s,
        };
        let mut scratch = Scratch::default();
        self.plans = (0..count).map(|agent| mcn::plan(&world, agent, params, &mut scratch)).collect();
    }

    /// Towards the door, or the goal, slower within `slowing` of it.
    fn preferred_mps(&self, agent: usize, slowing_s: f32) -> Vec2 {
        let before = |door_m: &Vec2| self.positions_m[agent].x < door_m.x;
        if let Some(door_m) = self.door_m.filter(before) {
            return (door_m - self.positions_m[agent]).normalize_or_zero() * SPEED_MPS;
        }
        ((self.goals_m[agent] - self.positions_m[agent]) / slowing_s).clamp_length_max(SPEED_MPS)
    }

    /// Moves everyone; returns Σ PD (Eqs. 16, 17) of the step and adds the accelerations.
    fn advance(&mut self, body: Body, dt_s: f32, accelerations_mps2: &mut f32) -> f32 {
        for (agent, plan) in self.plans.iter().enumerate() {
            let (velocity_mps, facing_rad) =
                body.follow(self.velocities_mps[agent], self.facings_rad[agent], plan, dt_s);
            *accelerations_mps2 += velocity_mps.distance(self.velocities_mps[agent]) / dt_s;
            self.velocities_mps[agent] = velocity_mps;
            self.facings_rad[agent] = facing_rad;
        }
        let collisions = self.penetration(dt_s);
        for (position_m, velocity_mps) in self.positions_m.iter_mut().zip(&self.velocities_mps) {
            *position_m += dt_s * *velocity_mps;
        }
        collisions
    }

    fn penetration(&self, dt_s: f32) -> f32 {
        let mut sum = 0.0;
        for first in 0..self.positions_m.len() {
            for second in first + 1..self.positions_m.len() {
                let offset_m = self.positions_m[first] - self.positions_m[second];
                if offset_m.length_squared() > 1.0 {
                    continue;
                }
                let moved_m = dt_s * (self.velocities_mps[first] - self.velocities_mps[second]);
                let share = (-offset_m.dot(moved_m) / moved_m.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
                let closest_m = (offset_m + share * moved_m).length();
                sum += (1.0 - closest_m / (2.0 * RADIUS_M)).max(0.0);
            }
        }
        sum
    }

    /// Arrivals and stalls.
    fn notice(&mut self, time_s: f32, dt_s: f32) {
        for agent in 0..self.positions_m.len() {
            if self.arrivals_s[agent].is_none() && self.positions_m[agent].distance(self.goals_m[agent]) <= ARRIVED_M {
                self.arrivals_s[agent] = Some(time_s);
            }
            let slow = self.velocities_mps[agent].length() < STALL.0 && self.arrivals_s[agent].is_none();
            if self.slow_s[agent] < STALL.1 {
                self.slow_s[agent] = if slow { self.slow_s[agent] + dt_s } else { 0.0 };
            }
        }
    }
}

impl Body {
    fn follow(self, velocity_mps: Vec2, facing_rad: f32, plan: &Plan, dt_s: f32) -> (Vec2, f32) {
        let Self::Lagging(lag_s, turn_rad_s) = self else { return (plan.velocity_mps, plan.facing_rad) };
        let off_rad = libm::remainderf(plan.facing_rad - facing_rad, std::f32::consts::TAU);
        let turned_rad = off_rad.clamp(-turn_rad_s * dt_s, turn_rad_s * dt_s);
        (velocity_mps.lerp(plan.velocity_mps, 1.0 - libm::expf(-dt_s / lag_s)), facing_rad + turned_rad)
    }
}
