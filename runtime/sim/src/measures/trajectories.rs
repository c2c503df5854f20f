//! Trajectories of the roots as text, metres, to the micrometre.
//!
//! Of a recording with the same agents in all frames: a line per frame, `x y` of each agent in the order of ids. Where
//! agents come and go: a line `frame id x y` per frame and present agent, below a line that begins with `#`.

use std::io::{self, Write};

use crate::recording::frame::AgentFrame;
use crate::recording::reader::Recording;

/// Writes the trajectories of a recording, from the start on.
///
/// # Errors
/// If writing fails or, as the source of the error, a frame cannot be read.
pub fn write_trajectories(recording: &Recording, out: &mut impl Write) -> io::Result<()> {
    let (mut agents, changes) = (Vec::new(), recording.population().changes());
    if changes {
        writeln!(out, "# frame id x_m y_m")?;
    }
    for frame in 0..recording.frame_count() {
        recording.read_frame(frame, &mut agents).map_err(io::Error::other)?;
        if changes {
            write_rows(frame, &agents, out)?;
        } else {
            write_roots(&agents, out)?;
        }
    }
    Ok(())
}

/// Writes a line for each agent of one frame.
fn write_rows(frame: usize, agents: &[AgentFrame], out: &mut impl Write) -> io::Result<()> {
    for AgentFrame { id, root, .. } in agents {
        writeln!(out, "{frame} {} {:.6} {:.6}", id.0, root.position_m.x, root.position_m.y)?;
    }
    Ok(())
}

/// Writes the line of one frame with all agents.
///
/// # Errors
/// If writing fails.
pub fn write_roots(agents: &[AgentFrame], out: &mut impl Write) -> io::Result<()> {
    let roots_m = agents.iter().map(|agent| agent.root.position_m);
    let fields: Vec<String> = roots_m.map(|root_m| format!("{:.6} {:.6}", root_m.x, root_m.y)).collect();
    writeln!(out, "{}", fields.join(" "))
}
