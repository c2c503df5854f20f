//! A recording as a table for other programs: a row per frame and present agent, frame by frame, agents in the order of
//! their ids.
//!
//! CSV as in RFC 4180: the first line names columns and units, commas separate fields, lines end with CR LF, decimals
//! have a point. World, metres, seconds, degrees counter-clockwise from the x axis.
//!
//! Two columns are derived as in `root_measures`, all others are as recorded. The velocity is the root's displacement
//! in the step that led to the frame, over dt. `arrived` is 1 from the frame on in which an agent that has passed its
//! waypoints first comes within 0.5 m of its last goal, or one that begins in a state enters a final state.

use std::borrow::Cow;
use std::io::{self, Write};

use glam::Vec2;

use crate::planning::plan::VelocitySet;
use crate::recording::frame::AgentFrame;
use crate::recording::reader::Recording;
use crate::route::arrival::Arrival;
use crate::synthesis::Mode;

/// Names of the columns, in the order of the fields.
const COLUMNS: [&str; 22] = [
    "step",
    "time_s",
    "agent",
    "x_m",
    "y_m",
    "facing_deg",
    "velocity_x_mps",
    "velocity_y_mps",
    "preferred_x_mps",
    "preferred_y_mps",
    "planned_x_mps",
    "planned_y_mps",
    "mode",
    "velocity_set",
    "strafing_s",
    "stepping_back_s",
    "phase",
    "left_contact",
    "right_contact",
    "time_to_landing_s",
    "arrived",
    "state",
];

/// Writes the table of a recording; holds two frames in memory.
///
/// # Errors
/// If writing fails or, as the source of the error, a frame cannot be read.
pub fn write_table(recording: &Recording, out: &mut impl Write) -> io::Result<()> {
    let (scenario, population) = (&recording.header().scenario, recording.population());
    let mut arrivals = vec![Arrival::default(); population.agents.len()];
    let (mut agents, mut before) = (Vec::new(), Vec::new());
    write!(out, "{}\r\n", COLUMNS.join(","))?;
    for step in 0..recording.frame_count() {
        std::mem::swap(&mut agents, &mut before);
        recording.read_frame(step, &mut agents).map_err(io::Error::other)?;
        let time_s = step as f64 * f64::from(scenario.dt_s);
        let mut earlier = before.iter().peekable();
        for frame in &agents {
            let arrival = &mut arrivals[frame.id.index()];
            let is_in_final_state = scenario.behaviour.is_final(frame.state.into());
            arrival.follow(population.spec(frame.id), frame.root.position_m, is_in_final_state, time_s);
            while earlier.next_if(|before: &&AgentFrame| before.id < frame.id).is_some() {}
            // Agents start from rest.
            let from_m = earlier.next_if(|before| before.id == frame.id).unwrap_or(frame).root.position_m;
            let velocity_mps = (frame.root.position_m - from_m) / scenario.dt_s;
            write!(out, "{step},{time_s:.6},{},", frame.id.0)?;
            write_row(frame, velocity_mps, arrival.at_s.is_some(), out)?;
            write!(out, "{}\r\n", quoted(scenario.behaviour.state_name(frame.state.into())))?;
        }
    }
    Ok(())
}

/// Writes the fields between the agent's index and its state.
fn write_row(frame: &AgentFrame, velocity_mps: Vec2, has_arrived: bool, out: &mut impl Write) -> io::Result<()> {
    let facing_deg = f64::from(frame.root.facing_rad).to_degrees();
    write!(out, "{},{facing_deg:.4},", pair(frame.root.position_m))?;
    write!(out, "{},{},{},", pair(velocity_mps), pair(frame.preferred_mps), pair(frame.planned_mps))?;
    write!(out, "{},{},{:.6},{:.6},", mode(frame.mode), set(frame.set), frame.strafing_s, frame.stepping_back_s)?;
    let [left, right] = frame.contacts;
    let landing_s = frame.time_to_landing_s;
    write!(out, "{:.6},{left:.6},{right:.6},{landing_s:.6},{},", frame.phase, u8::from(has_arrived))
}

/// A field of text: in quotes where commas, quotes or line breaks would end it.
fn quoted(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\r', '\n']) {
        return Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")));
    }
    Cow::Borrowed(text)
}

/// x and y to the micrometre, or µm/s.
fn pair(vector: Vec2) -> String {
    format!("{:.6},{:.6}", vector.x, vector.y)
}

fn mode(mode: Mode) -> &'static str {
    match mode {
        Mode::Blending => "blending",
        Mode::SemiProcedural => "semi_procedural",
        Mode::Transition => "transition",
    }
}

fn set(set: VelocitySet) -> &'static str {
    match set {
        VelocitySet::Turning => "turning",
        VelocitySet::Holding => "holding",
    }
}
