//! A crowd of discs that walk as planned, without bodies: moved by the planner alone, or through a lag and a turning
//! rate like a body's.

use std::path::Path;
use std::time::{Duration, Instant};

use fbcrowd_sim::mcn::motion_constraints::MotionConstraints;
use fbcrowd_sim::neighbours::Neighbours;
use fbcrowd_sim::obstacles::Obstacles;
use fbcrowd_sim::params::Params;
use fbcrowd_sim::path::{Braking, Progress, preferred_mps};
use fbcrowd_sim::plan::{Plan, Stance};
use fbcrowd_sim::planner::{Planner, Scratch, ahead_s, plan};
use fbcrowd_sim::scenario::AgentSpec;
use fbcrowd_sim::split_mix::SplitMix64;
use fbcrowd_sim::world::World;
use glam::Vec2;
use motiondb::velocity_hull::VelocityHull;

/// The protocol of `assets/scenarios/table1`.
pub(crate) const RADIUS_M: f32 = 0.25;
const SPEED_MPS: f32 = 1.33;
const ARRIVED_M: f32 = 0.5;
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

/// Who plans, and amid what.
#[derive(Clone, Copy)]
pub(crate) struct Setting<'a> {
    pub(crate) planner: Planner,
    pub(crate) params: &'a Params,
    pub(crate) hull: &'a VelocityHull,
    pub(crate) walls: &'a Obstacles,
    pub(crate) body: Body,
    pub(crate) dt_s: f32,
}

pub(crate) struct Crowd {
    positions_m: Vec<Vec2>,
    agents: Vec<AgentSpec>,
    progress: Vec<Progress>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    radii_m: Vec<f32>,
    plans: Vec<Plan>,
    neighbours: Neighbours,
    slow_s: Vec<f32>,
    arrivals_s: Vec<Option<f32>>,
}

/// `FbCrowd` App. 11's C and A, and who arrives or stalls.
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

/// One of the bundled scenes: lines `x y goal_x goal_y`; start and goal of each agent.
pub(crate) fn bundled_scene(name: &str) -> Vec<(Vec2, Vec2)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../assets/scenarios/{name}.txt"));
    let text = std::fs::read_to_string(path).unwrap();
    let agent = |line: &str| {
        let numbers: Vec<f32> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        (Vec2::new(numbers[0], numbers[1]), Vec2::new(numbers[2], numbers[3]))
    };
    text.lines().filter(|line| !line.starts_with('#')).map(agent).collect()
}

/// A jittered lattice of 0.3 agents/m² in a disc; the goal of each agent is the opposite point.
pub(crate) fn disc(count: usize) -> Vec<(Vec2, Vec2)> {
    let spacing_m = 0.3_f32.sqrt().recip();
    let half = (count as f32).sqrt() as i32;
    let coordinate_m = |index: i32| spacing_m * (index as f32 + 0.5);
    let mut points_m: Vec<Vec2> =
        (-half..half).flat_map(|x| (-half..half).map(move |y| Vec2::new(coordinate_m(x), coordinate_m(y)))).collect();
    points_m.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let mut random = SplitMix64::new(1, count as u64);
    let mut jitter_m = || spacing_m * random.within(0.2) as f32;
    let jittered_m = points_m.into_iter().take(count).map(|point_m| point_m + Vec2::new(jitter_m(), jitter_m()));
    jittered_m.map(|point_m| (point_m, -point_m)).collect()
}

impl Crowd {
    /// Agents from here to there, all through the door first, if there is one.
    pub(crate) fn new(agents: &[(Vec2, Vec2)], door_m: Option<Vec2>) -> Self {
        let count = agents.len();
        let spec = |&(from_m, to_m): &(Vec2, Vec2)| AgentSpec {
            position_m: from_m,
            facing_rad: libm::atan2f(to_m.y - from_m.y, to_m.x - from_m.x),
            goals_m: door_m.into_iter().chain([to_m]).collect(),
            radius_m: RADIUS_M,
            preferred_speed_mps: SPEED_MPS,
        };
        let agents: Vec<AgentSpec> = agents.iter().map(spec).collect();
        Self {
            positions_m: agents.iter().map(|agent| agent.position_m).collect(),
            velocities_mps: vec![Vec2::ZERO; count],
            facings_rad: agents.iter().map(|agent| agent.facing_rad).collect(),
            radii_m: vec![RADIUS_M; count],
            plans: vec![Plan::default(); count],
            neighbours: Neighbours::default(),
            progress: vec![Progress::default(); count],
            slow_s: vec![0.0; count],
            arrivals_s: vec![None; count],
            agents,
        }
    }

    /// All turn their backs to their goals.
    pub(crate) fn turned_about(mut self) -> Self {
        self.facings_rad.iter_mut().for_each(|facing_rad| *facing_rad += std::f32::consts::PI);
        self
    }

    /// Runs until all are at their goals at once, or the time is over.
    pub(crate) fn run(&mut self, setting: &Setting, duration_s: f32) -> Figures {
        let &Setting { body, dt_s, .. } = setting;
        let mut figures = Figures::default();
        let mut planning = Duration::ZERO;
        let mut steps = 0;
        while steps as f32 * dt_s < duration_s && !(0..self.agents.len()).all(|agent| self.is_home(agent)) {
            let start = Instant::now();
            self.plan(setting);
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

    fn plan(&mut self, setting: &Setting) {
        let ahead_s = ahead_s(setting.planner, setting.params);
        self.neighbours.rebuild(&self.positions_m, &self.velocities_mps, &self.radii_m, ahead_s);
        let count = self.plans.len();
        let preferred_mps = self.follow_paths(setting);
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
            obstacles: setting.walls,
            constraints: &MotionConstraints::new(setting.hull),
            dt_s: setting.dt_s,
            bodies: matches!(setting.body, Body::Lagging(..)),
        };
        let mut scratch = Scratch::default();
        let mut planned = |agent| plan(setting.planner, &world, agent, setting.params, &mut scratch);
        self.plans = (0..count).map(&mut planned).collect();
    }

    fn follow_paths(&mut self, setting: &Setting) -> Vec<Vec2> {
        let braking = match setting.body {
            Body::Ideal => Braking::Within(setting.dt_s),
            Body::Lagging(..) => Braking::Evenly,
        };
        let agents = self.agents.iter().zip(&self.positions_m).zip(&mut self.progress);
        agents
            .map(|((agent, &position_m), progress)| preferred_mps(agent, position_m, setting.walls, braking, progress))
            .collect()
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

    fn is_home(&self, agent: usize) -> bool {
        let goal_m = *self.agents[agent].goals_m.last().unwrap();
        self.positions_m[agent].distance(goal_m) <= ARRIVED_M
    }

    /// Arrivals and stalls.
    fn notice(&mut self, time_s: f32, dt_s: f32) {
        for agent in 0..self.positions_m.len() {
            if self.arrivals_s[agent].is_none() && self.is_home(agent) {
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
