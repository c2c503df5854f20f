//! What a recording shows in numbers (`FbCrowd` App. 11; `definitions.md`, "measure"), streamed: two frames at a time.
//!
//! Collisions stand in [`collision_rate`](crate::collision_rate), accelerations, arrivals and tracking in [`root_measures`](crate::root_measures),
//! foot slide in [`planted_slide`](crate::planted_slide). Positions are those of the root as synthesised.

use std::io::{self, Write};

use glam::Vec2;
use serde::Serialize;

use crate::collision_rate::Collisions;
use crate::planted_slide::PlantedSlide;
use crate::recording::Recording;
use crate::recording_error::RecordingError;
use crate::recording_frame::AgentFrame;
use crate::root_measures::RootMeasures;

/// The figures of one recording, under the names of `measure --json`.
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
    /// Of planted feet; none where no foot was planted.
    pub planted_slide_cm_s: Option<f64>,
    /// Of the examples that the bodies were blended from, over the same contacts.
    pub examples_slide_cm_s: Option<f64>,
    /// Share of all feet and frames that are planted.
    pub planted_share: f64,
    /// Mean distance between the synthesised root and where the planned velocity would have brought it in a step.
    pub root_tracking_error_m: f64,
}

/// Reads a recording once, from its first frame to its last.
///
/// # Errors
/// Where a frame cannot be read.
pub fn measure(recording: &Recording) -> Result<Measures, RecordingError> {
    let scenario = &recording.header().scenario;
    let (agents, dt_s) = (&scenario.agents, scenario.dt_s);
    let (mut before, mut after) = (Vec::new(), Vec::new());
    recording.read_frame(0, &mut before)?;
    let mut collisions = Collisions::new(agents.iter().map(|agent| agent.radius_m));
    let mut roots = RootMeasures::new(agents, &before, dt_s);
    let mut slide = PlantedSlide::new(&recording.header().skeleton, agents.len(), dt_s);
    slide.push(&before);
    for frame in 1..recording.frame_count() {
        recording.read_frame(frame, &mut after)?;
        collisions.push(&roots_m(&before), &roots_m(&after));
        roots.push(&before, &after);
        slide.push(&after);
        std::mem::swap(&mut before, &mut after);
    }
    let (steps, slide) = (recording.frame_count() - 1, slide.finish());
    Ok(Measures {
        agents: agents.len(),
        steps,
        dt_s,
        collision_rate: collisions.rate(steps),
        mean_acceleration_mps2: roots.mean_acceleration_mps2(),
        mean_acceleration_before_arrival_mps2: roots.mean_acceleration_before_arrival_mps2(),
        arrived: roots.arrived(),
        stalled: roots.stalled(),
        mean_time_to_goal_s: roots.mean_time_to_goal_s(),
        planted_slide_cm_s: slide.slide_cm_s,
        examples_slide_cm_s: slide.examples_slide_cm_s,
        planted_share: slide.planted_share,
        root_tracking_error_m: roots.root_tracking_error_m(),
    })
}

/// A line a frame, from the start on: `x y` of each agent's root in index order, metres, to the micrometre.
///
/// # Errors
/// Where writing fails or, as the source of the error, a frame cannot be read.
pub fn write_trajectories(recording: &Recording, out: &mut impl Write) -> io::Result<()> {
    let mut agents = Vec::new();
    for frame in 0..recording.frame_count() {
        recording.read_frame(frame, &mut agents).map_err(io::Error::other)?;
        let places = roots_m(&agents).into_iter().map(|root_m| format!("{:.6} {:.6}", root_m.x, root_m.y));
        writeln!(out, "{}", places.collect::<Vec<String>>().join(" "))?;
    }
    Ok(())
}

fn roots_m(agents: &[AgentFrame]) -> Vec<Vec2> {
    agents.iter().map(|agent| agent.root.position_m).collect()
}
