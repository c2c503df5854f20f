//! How agents get on: acceleration, arrival, stalling, tracking (`FbCrowd` App. 11, Eq. 18, corrected; `definitions.md`, "measure").
//!
//! Velocities are differences of the synthesised root, whose path is ripple-free. Agents start from rest, so T steps have T accelerations.

use glam::DVec2;

use crate::recording_frame::AgentFrame;
use crate::scenario::AgentSpec;

/// An agent whose root comes this near to its last goal has arrived, m.
const ARRIVAL_M: f64 = 0.5;
/// Slower than this for [`STALL_S`] before arriving is stalling, m/s.
const STALL_SPEED_MPS: f64 = 0.1;
/// How long, s.
const STALL_S: f64 = 5.0;

/// Follows every agent, step by step.
#[derive(Debug)]
pub struct RootMeasures {
    dt_s: f64,
    steps: usize,
    walkers: Vec<Walker>,
    acceleration: Mean,
    acceleration_before_arrival: Mean,
    tracking_error: Mean,
}

/// A sum on its way to a mean.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mean {
    sum: f64,
    count: usize,
}

#[derive(Debug)]
struct Walker {
    goal_m: DVec2,
    velocity_mps: DVec2,
    arrival_s: Option<f64>,
    slow_steps: usize,
    stalled: bool,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    /// 0 of nothing.
    pub fn value(self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

impl RootMeasures {
    /// At the start.
    pub fn new(agents: &[AgentSpec], start: &[AgentFrame], dt_s: f32) -> Self {
        let mut walkers: Vec<Walker> = agents.iter().map(Walker::new).collect();
        for (walker, frame) in walkers.iter_mut().zip(start) {
            walker.arrive(frame, 0.0);
        }
        let [acceleration, acceleration_before_arrival, tracking_error] = [Mean::default(); 3];
        Self { dt_s: dt_s.into(), steps: 0, walkers, acceleration, acceleration_before_arrival, tracking_error }
    }

    /// Adds one step, given every agent before and after it.
    pub fn push(&mut self, before: &[AgentFrame], after: &[AgentFrame]) {
        self.steps += 1;
        for (walker, (before, after)) in self.walkers.iter_mut().zip(before.iter().zip(after)) {
            let displacement_m = position_m(after) - position_m(before);
            let velocity_mps = displacement_m / self.dt_s;
            let acceleration_mps2 = (velocity_mps - walker.velocity_mps).length() / self.dt_s;
            walker.velocity_mps = velocity_mps;
            self.acceleration.add(acceleration_mps2); // Eq. 18
            if walker.arrival_s.is_none() {
                self.acceleration_before_arrival.add(acceleration_mps2);
                walker.watch_for_stall(self.dt_s);
            }
            let planned_m = DVec2::from(after.planned_mps) * self.dt_s;
            self.tracking_error.add(displacement_m.distance(planned_m));
            walker.arrive(after, self.steps as f64 * self.dt_s);
        }
    }

    /// Over all agents and steps, m/s².
    pub fn mean_acceleration_mps2(&self) -> f64 {
        self.acceleration.value()
    }

    /// Over the steps before each agent's arrival, m/s².
    pub fn mean_acceleration_before_arrival_mps2(&self) -> f64 {
        self.acceleration_before_arrival.value()
    }

    /// Mean distance between the synthesised root and where the planned velocity would have brought it, m.
    pub fn root_tracking_error_m(&self) -> f64 {
        self.tracking_error.value()
    }

    /// Agents that came within 0.5 m of their last goal at any time.
    pub fn arrived(&self) -> usize {
        self.walkers.iter().filter(|walker| walker.arrival_s.is_some()).count()
    }

    /// Agents that stayed under 0.1 m/s for 5 s before arriving.
    pub fn stalled(&self) -> usize {
        self.walkers.iter().filter(|walker| walker.stalled).count()
    }

    /// Over the agents that arrived; none where nobody did.
    pub fn mean_time_to_goal_s(&self) -> Option<f64> {
        let mut mean = Mean::default();
        self.walkers.iter().filter_map(|walker| walker.arrival_s).for_each(|arrival_s| mean.add(arrival_s));
        (mean.count > 0).then(|| mean.value())
    }
}

impl Walker {
    fn new(agent: &AgentSpec) -> Self {
        let goal_m = DVec2::from(agent.goals_m.last().copied().unwrap_or(agent.position_m));
        Self { goal_m, velocity_mps: DVec2::ZERO, arrival_s: None, slow_steps: 0, stalled: false }
    }

    fn arrive(&mut self, frame: &AgentFrame, now_s: f64) {
        if self.arrival_s.is_none() && position_m(frame).distance(self.goal_m) < ARRIVAL_M {
            self.arrival_s = Some(now_s);
        }
    }

    fn watch_for_stall(&mut self, dt_s: f64) {
        let slow = self.velocity_mps.length() < STALL_SPEED_MPS;
        self.slow_steps = if slow { self.slow_steps + 1 } else { 0 };
        // Half a step of tolerance, since dt is not exact in binary.
        self.stalled |= (self.slow_steps as f64 + 0.5) * dt_s >= STALL_S;
    }
}

fn position_m(frame: &AgentFrame) -> DVec2 {
    DVec2::from(frame.root.position_m)
}
