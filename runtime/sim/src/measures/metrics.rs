//! What a simulation shows in numbers (`FbCrowd` App. 11), streamed: two frames at a time.
//!
//! Collisions of discs stand in `collision_rate`, those of bodies in
//! `body_penetration`, accelerations, arrivals, detours and tracking in
//! `root_measures`, foot slide in `planted_slide`. Positions are those
//! of the root as synthesised.

use std::io::{self, Write};

use glam::Vec2;
use motiondb::body::{Joints, Skeleton};
use serde::Serialize;

use crate::measures::body_penetration::BodyPenetration;
use crate::measures::collision_rate::Collisions;
use crate::measures::planted_slide::PlantedSlide;
use crate::measures::root_measures::RootMeasures;
use crate::measures::wall_contact::WallContact;
use crate::recording::Recording;
use crate::recording::error::RecordingError;
use crate::recording::frame::AgentFrame;
use crate::scenario::Scenario;

/// The figures of one simulation, under the names of `measure --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measures {
    /// N.
    pub agents: usize,
    /// T: frames less one.
    pub steps: usize,
    /// Step, s.
    pub dt_s: f32,
    /// C: Eq. 17.
    pub collision_rate: f64,
    /// Least distance between the centres of any two discs, Eq. 16; none of a single agent.
    pub minimum_separation_m: Option<f64>,
    /// A: Eq. 18, over all agents and steps.
    pub mean_acceleration_mps2: f64,
    /// The same over the steps before each agent's arrival: waiting at the goal does not dilute it.
    pub mean_acceleration_before_arrival_mps2: f64,
    /// Agents that came within 0.5 m of their last goal.
    pub arrived: usize,
    /// Agents that stayed under 0.1 m/s for 5 s before arriving.
    pub stalled: usize,
    /// Over the agents that arrived; none where nobody did.
    pub mean_time_to_goal_s: Option<f64>,
    /// Path walked until the arrival over the straight way, waypoints included; mean over the agents that arrived.
    pub path_over_straight_line: Option<f64>,
    /// Share of the steps before each agent's arrival in which it walks sidewards at held facing.
    pub strafing_share: f64,
    /// Share of the steps before each agent's arrival in which it walks backward at held facing.
    pub stepping_back_share: f64,
    /// Deepest overlap of the capsules of two bodies, summed over pairs and steps, per agent and step.
    pub body_penetration_mm: f64,
    /// Its mean over the pairs and steps in which bodies touch; none where none ever did.
    pub body_penetration_touching_mm: Option<f64>,
    /// Greatest of all.
    pub body_penetration_max_mm: f64,
    /// Share of agents and steps in which a body touches another.
    pub body_touching_share: f64,
    /// Share of agents and frames in which a disc is held at a wall.
    pub wall_disc_share: f64,
    /// Share of agents and frames in which a body reaches into a wall.
    pub wall_body_share: f64,
    /// The deepest of it.
    pub wall_body_max_mm: f64,
    /// Of planted feet until each agent's arrival; none where no foot was planted.
    pub planted_slide_cm_s: Option<f64>,
    /// Of the examples that the bodies were blended from, over the same contacts.
    pub examples_slide_cm_s: Option<f64>,
    /// Share of all feet and frames until each agent's arrival that are planted.
    pub planted_share: f64,
    /// Mean distance between the synthesised root and where the planned velocity would have brought it in a step.
    pub root_tracking_error_m: f64,
    /// The greatest such distance of any agent in any step.
    pub root_tracking_worst_m: f64,
    /// Mean angle between facing and travel, over the steps before each agent's arrival in which it walks and is not to
    /// side-step or step back.
    pub heading_error_deg: f64,
    /// The same over all steps before arrival in which it walks, side-steps and steps back too.
    pub walking_heading_error_deg: f64,
}

/// Figures on their way: takes frames one by one and keeps one, so that a crowd is measured while it runs.
#[derive(Debug)]
pub struct Measuring {
    skeleton: Skeleton,
    dt_s: f32,
    steps: usize,
    before: Vec<AgentFrame>,
    /// Of one frame, in the roots' frames.
    joints: Vec<Joints>,
    collisions: Collisions,
    roots: RootMeasures,
    slide: PlantedSlide,
    bodies: BodyPenetration,
    walls: WallContact,
}

impl Measuring {
    /// At the start of a scenario, with every agent in index order.
    pub fn new(skeleton: &Skeleton, scenario: &Scenario, start: &[AgentFrame]) -> Self {
        let (agents, dt_s) = (&scenario.agents, scenario.dt_s);
        let mut measuring = Self {
            skeleton: skeleton.clone(),
            dt_s,
            steps: 0,
            before: start.to_vec(),
            joints: Vec::with_capacity(agents.len()),
            collisions: Collisions::new(agents.iter().map(|agent| agent.radius_m)),
            roots: RootMeasures::new(agents, start, dt_s),
            slide: PlantedSlide::new(skeleton, agents.len(), dt_s),
            bodies: BodyPenetration::new(skeleton, agents.len()),
            walls: WallContact::new(skeleton, scenario),
        };
        measuring.pose(start);
        measuring.follow_feet(start);
        measuring
    }

    /// Adds one step, given every agent after it, in index order.
    pub fn push(&mut self, after: &[AgentFrame]) {
        self.steps += 1;
        self.pose(after);
        self.collisions.push(&roots_m(&self.before), &roots_m(after));
        self.follow_feet(after);
        self.roots.push(&self.before, after);
        self.bodies.push(after.iter().map(|agent| &agent.root).zip(&self.joints));
        self.walls.push(after, &self.joints);
        self.before.clear();
        self.before.extend_from_slice(after);
    }

    /// Whether every agent is near its last goal now; one that was and has been pushed away is not.
    pub fn all_are_at_goals(&self) -> bool {
        self.roots.all_are_at_goals()
    }

    /// After the last frame.
    pub fn finish(self) -> Measures {
        let (slide, bodies, walls) = (self.slide.finish(), self.bodies.finish(), self.walls.finish());
        Measures {
            agents: self.before.len(),
            steps: self.steps,
            dt_s: self.dt_s,
            collision_rate: self.collisions.rate(self.steps),
            minimum_separation_m: self.collisions.least_distance_m(),
            mean_acceleration_mps2: self.roots.mean_acceleration_mps2(),
            mean_acceleration_before_arrival_mps2: self.roots.mean_acceleration_before_arrival_mps2(),
            arrived: self.roots.arrived(),
            stalled: self.roots.stalled(),
            mean_time_to_goal_s: self.roots.mean_time_to_goal_s(),
            path_over_straight_line: self.roots.path_over_straight_line(),
            strafing_share: self.roots.strafing_share(),
            stepping_back_share: self.roots.stepping_back_share(),
            body_penetration_mm: bodies.mean_mm,
            body_penetration_touching_mm: bodies.touching_mm,
            body_penetration_max_mm: bodies.greatest_mm,
            body_touching_share: bodies.touching_share,
            wall_disc_share: walls.disc_share,
            wall_body_share: walls.body_share,
            wall_body_max_mm: walls.greatest_depth_mm,
            planted_slide_cm_s: slide.slide_cm_s,
            examples_slide_cm_s: slide.examples_slide_cm_s,
            planted_share: slide.planted_share,
            root_tracking_error_m: self.roots.root_tracking_error_m(),
            root_tracking_worst_m: self.roots.root_tracking_worst_m(),
            heading_error_deg: self.roots.heading_error_deg(),
            walking_heading_error_deg: self.roots.walking_heading_error_deg(),
        }
    }

    /// Those of who had not arrived before: waiting at the goal does not dilute their slide.
    fn follow_feet(&mut self, agents: &[AgentFrame]) {
        for (index, (agent, joints)) in agents.iter().zip(&self.joints).enumerate() {
            if !self.roots.has_arrived(index) {
                self.slide.push_one(index, agent, joints);
            }
        }
    }

    fn pose(&mut self, agents: &[AgentFrame]) {
        self.joints.clear();
        self.joints.extend(agents.iter().map(|agent| agent.pose.forward_kinematics(&self.skeleton)));
    }
}

/// Reads a recording once, from its first frame to its last.
///
/// # Errors
/// Where a frame cannot be read.
pub fn measure(recording: &Recording) -> Result<Measures, RecordingError> {
    let header = recording.header();
    let mut agents = Vec::new();
    recording.read_frame(0, &mut agents)?;
    let mut measuring = Measuring::new(&header.skeleton, &header.scenario, &agents);
    for frame in 1..recording.frame_count() {
        recording.read_frame(frame, &mut agents)?;
        measuring.push(&agents);
    }
    Ok(measuring.finish())
}

/// A line a frame, from the start on, as [`write_roots`] has it.
///
/// # Errors
/// Where writing fails or, as the source of the error, a frame cannot be read.
pub fn write_trajectories(recording: &Recording, out: &mut impl Write) -> io::Result<()> {
    let mut agents = Vec::new();
    for frame in 0..recording.frame_count() {
        recording.read_frame(frame, &mut agents).map_err(io::Error::other)?;
        write_roots(&agents, out)?;
    }
    Ok(())
}

/// One line: `x y` of each agent's root in index order, metres, to the micrometre.
///
/// # Errors
/// Where writing fails.
pub fn write_roots(agents: &[AgentFrame], out: &mut impl Write) -> io::Result<()> {
    let places = roots_m(agents).into_iter().map(|root_m| format!("{:.6} {:.6}", root_m.x, root_m.y));
    writeln!(out, "{}", places.collect::<Vec<String>>().join(" "))
}

fn roots_m(agents: &[AgentFrame]) -> Vec<Vec2> {
    agents.iter().map(|agent| agent.root.position_m).collect()
}
