//! Draws one frame of a recording, seen from above, and writes it as a PNG.
//!
//! ```text
//! cargo run --release -p fbcrowd-render --example draw_one_frame -- crossing.fbrec 2.5 frame.png
//! ```
//!
//! Arguments: recording, time in seconds, picture. All are optional; the defaults are a recording of the crate's tests,
//! 1.0 and `frame.png`. A recording is made by `fbcrowd simulate`.

use std::error::Error;
use std::path::Path;

use fbcrowd_render::top_view::{read_tracks, sample};
use fbcrowd_render::{TopView, png_frame};
use fbcrowd_sim::Recording;

const DEFAULT_RECORDING: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/walkers.fbrec");

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let recording = arguments.next().unwrap_or_else(|| DEFAULT_RECORDING.to_owned());
    let time_s: f64 = arguments.next().unwrap_or_else(|| "1.0".to_owned()).parse()?;
    let picture = arguments.next().unwrap_or_else(|| "frame.png".to_owned());

    let recording = Recording::open(Path::new(&recording))?;
    // Tracks give the trails, and the part of the world that all frames show.
    let tracks = read_tracks(&recording)?;
    let top_view = TopView::new(recording.header(), &tracks)?.with_doors(recording.population());

    // Buffers can be used for any number of frames.
    let mut buffers = top_view.buffers();
    let agents = sample(&recording, time_s)?;
    let frame = top_view.draw(&mut buffers, time_s as f32, &agents);
    png_frame::write(Path::new(&picture), frame)?;

    println!("{picture}: {} agents at {time_s} s, {} × {} pixels", agents.len(), frame.width(), frame.height());
    Ok(())
}
