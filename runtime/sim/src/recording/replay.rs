//! Any step of a recording, as the planner saw it: a recording is complete enough for it.
//!
//! Step k leads from frame k to frame k + 1. Places, facings, spent whiles and the stance foot are frame k's,
//! velocities those that led to it; v_pref, which the step itself finds, stands in frame k + 1. All but the stance foot
//! is kept bit for bit: it comes from a packed pose and time to landing, and where it decides, so does their rounding
//! (a tenth of a millimetre at the sole, so some mm/s of what is planned). What a body is committed to on the paper's
//! way from one synthesis to the other (`transition = "through_m_mb"`) is not recorded: there the velocity walked
//! stands. World axes, metres, seconds, radians.

use glam::Vec2;

use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::plan::Stance;
use crate::planning::planner::ahead_s;
use crate::planning::world_view::World;
use crate::recording::error::RecordingError;
use crate::recording::frame::AgentFrame;
use crate::recording::{Header, Recording};
use crate::scenario::Scenario;
use crate::world::neighbours::Neighbours;
use crate::world::obstacles::Obstacles;

/// A recording whose steps are looked at.
#[derive(Debug)]
pub struct Replay<'a> {
    recording: &'a Recording,
    obstacles: Obstacles,
    constraints: MotionConstraints,
    radii_m: Vec<f32>,
}

/// One step, from its beginning to its end.
#[derive(Debug)]
pub struct RecordedStep<'a> {
    replay: &'a Replay<'a>,
    /// The frame in which it begins.
    pub frame: usize,
    /// Every agent at its beginning.
    pub before: Vec<AgentFrame>,
    /// Every agent at its end.
    pub after: Vec<AgentFrame>,
    positions_m: Vec<Vec2>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    preferred_mps: Vec<Vec2>,
    stances: Vec<Stance>,
    strafing_s: Vec<f32>,
    stepping_back_s: Vec<f32>,
    neighbours: Neighbours,
}

impl<'a> Replay<'a> {
    /// Finds what is the same in all steps.
    pub fn new(recording: &'a Recording) -> Self {
        let scenario = &recording.header().scenario;
        Self {
            recording,
            constraints: MotionConstraints::new(&recording.header().velocity_hull),
            obstacles: Obstacles::new(&scenario.obstacles_m),
            radii_m: scenario.agents.iter().map(|agent| agent.radius_m).collect(),
        }
    }

    /// What holds for all frames.
    pub fn header(&self) -> &Header {
        self.recording.header()
    }

    /// Steps recorded.
    pub fn step_count(&self) -> usize {
        self.recording.frame_count().saturating_sub(1)
    }

    /// The step that begins in a frame.
    ///
    /// # Errors
    /// Where a frame of it is missing or damaged.
    pub fn step(&'a self, frame: usize) -> Result<RecordedStep<'a>, RecordingError> {
        let read = |index: usize| {
            let mut agents = Vec::new();
            self.recording.read_frame(index, &mut agents).map(|()| agents)
        };
        let (earlier, before, after) = (read(frame.saturating_sub(1))?, read(frame)?, read(frame + 1)?);
        let positions_m: Vec<Vec2> = before.iter().map(|agent| agent.root.position_m).collect();
        let velocities_mps = self.velocities_mps(&earlier, &before);
        let mut neighbours = Neighbours::default();
        let Scenario { planner, params, .. } = &self.header().scenario;
        neighbours.rebuild(&positions_m, &velocities_mps, &self.radii_m, ahead_s(*planner, params));
        Ok(RecordedStep {
            replay: self,
            frame,
            positions_m,
            velocities_mps,
            facings_rad: before.iter().map(|agent| agent.root.facing_rad).collect(),
            preferred_mps: after.iter().map(|agent| agent.preferred_mps).collect(),
            stances: before.iter().map(|agent| self.stance(agent)).collect(),
            strafing_s: before.iter().map(|agent| agent.strafing_s).collect(),
            stepping_back_s: before.iter().map(|agent| agent.stepping_back_s).collect(),
            neighbours,
            before,
            after,
        })
    }

    /// As [`crate::coupling::body_to_disc`] finds them; all stand at the start.
    fn velocities_mps(&self, from: &[AgentFrame], to: &[AgentFrame]) -> Vec<Vec2> {
        let dt_s = self.header().scenario.dt_s;
        from.iter().zip(to).map(|(from, to)| (to.root.position_m - from.root.position_m) / dt_s).collect()
    }

    fn stance(&self, agent: &AgentFrame) -> Stance {
        let skeleton = &self.header().skeleton;
        let joints = agent.pose.forward_kinematics(skeleton);
        let soles_m = [0, 1].map(|side| joints.sole_points_m(skeleton, side));
        Stance::on_soles(&soles_m, agent.root.forward(), agent.contacts, |_| agent.time_to_landing_s)
    }
}

impl RecordedStep<'_> {
    /// What holds for all frames.
    pub fn header(&self) -> &Header {
        self.replay.header()
    }

    /// What the planner saw.
    pub fn world(&self) -> World<'_> {
        let Scenario { coupling, dt_s, .. } = self.header().scenario;
        World {
            positions_m: &self.positions_m,
            velocities_mps: &self.velocities_mps,
            facings_rad: &self.facings_rad,
            radii_m: &self.replay.radii_m,
            preferred_mps: &self.preferred_mps,
            stances: &self.stances,
            strafing_s: &self.strafing_s,
            stepping_back_s: &self.stepping_back_s,
            neighbours: &self.neighbours,
            obstacles: &self.replay.obstacles,
            constraints: &self.replay.constraints,
            dt_s,
            bodies: coupling.plans_for_bodies(),
        }
    }

    /// The velocity at which an agent really went, m/s.
    pub fn walked_mps(&self, agent: usize) -> Vec2 {
        let moved_m = self.after[agent].root.position_m - self.before[agent].root.position_m;
        moved_m / self.header().scenario.dt_s
    }
}
