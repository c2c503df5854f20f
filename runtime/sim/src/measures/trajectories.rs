//! Trajectories of the roots as text: a line per frame, `x y` of each agent in index order, metres, to the micrometre.

use std::io::{self, Write};

use crate::recording::frame::AgentFrame;
use crate::recording::reader::Recording;

/// Writes the trajectories of a recording, from the start on.
///
/// # Errors
/// If writing fails or, as the source of the error, a frame cannot be read.
pub fn write_trajectories(recording: &Recording, out: &mut impl Write) -> io::Result<()> {
    let mut agents = Vec::new();
    for frame in 0..recording.frame_count() {
        recording.read_frame(frame, &mut agents).map_err(io::Error::other)?;
        write_roots(&agents, out)?;
    }
    Ok(())
}

/// Writes the line of one frame.
///
/// # Errors
/// If writing fails.
pub fn write_roots(agents: &[AgentFrame], out: &mut impl Write) -> io::Result<()> {
    let roots_m = agents.iter().map(|agent| agent.root.position_m);
    let fields: Vec<String> = roots_m.map(|root_m| format!("{:.6} {:.6}", root_m.x, root_m.y)).collect();
    writeln!(out, "{}", fields.join(" "))
}
