//! Pictures of a small committed recording look like the committed pictures.
//!
//! After an intended change, or a new recording format, run `cargo test -p fbcrowd-render --test pictures -- --ignored`.
//! Look at the pictures in `tests/golden` before you commit them.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use fbcrowd_render::constraints::ConstraintOverlay;
use fbcrowd_render::plots::crowd::{agent_strip, trajectories};
use fbcrowd_render::raster::png_frame;
use fbcrowd_render::top_view::{TopView, read_tracks, sample};
use fbcrowd_sim::recording::Recording;
use fbcrowd_sim::scenario::View;
use tiny_skia::Pixmap;

use crate::camera::portrait;
use crate::support;

/// Greatest mean difference of a channel, code values: another machine rounds differently.
const MEAN_TOLERANCE: f64 = 0.25;
/// Greatest share of values that differ by more than [`PIXEL_TOLERANCE`]: an edge may be on the other side of a pixel's
/// centre.
const EDGE_SHARE: f64 = 0.002;
/// Difference of a value that is clearly visible, code values.
const PIXEL_TOLERANCE: u8 = 24;

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name)
}

/// Every golden picture, drawn again, with its file name.
fn pictures() -> Vec<(&'static str, Pixmap)> {
    let recording = Recording::open(&golden("walkers.fbrec")).unwrap();
    let tracks = read_tracks(&recording).unwrap();
    let top_view = |view: View, time_s: f64| {
        let mut header = recording.header().clone();
        header.scenario.view = view;
        let view = TopView::new(&header, &tracks).unwrap();
        view.draw(&mut view.buffers(), time_s as f32, &sample(&recording, time_s).unwrap()).clone()
    };
    let overlaid = |agents: &[usize], time_s: f64| {
        let view = TopView::new(recording.header(), &tracks).unwrap();
        let overlay = ConstraintOverlay::new(&recording, view.framing(), agents).unwrap();
        let bodies = sample(&recording, time_s).unwrap();
        overlay.draw(view.draw(&mut view.buffers(), time_s as f32, &bodies), time_s).unwrap()
    };
    let view = recording.header().scenario.view.clone();
    let near = View { width: 240, height: 135, width_m: Some(2.4), labels: false, ..view.clone() };
    let far = View { width_m: Some(26.0), labels: false, ..view.clone() };
    let dots = View { width_m: Some(60.0), labels: false, ..view.clone() };
    vec![
        ("top_start.png", top_view(view.clone(), 0.0)),
        ("top_between_frames.png", top_view(view, 1.25)),
        ("top_near.png", top_view(near, 1.2)),
        ("top_far.png", top_view(far, 1.2)),
        ("top_dots.png", top_view(dots, 1.2)),
        ("camera_front.png", portrait(&recording, 0.5, [128, 160])),
        ("camera_side.png", portrait(&recording, 1.6, [128, 160])),
        ("overlay_constraints.png", overlaid(&[2], 1.0)),
        ("agent_strip.png", quarter(&agent_strip(&recording, &[], 1, &[0.5, 0.8, 1.1]).unwrap())),
        ("trajectories.png", quarter(&trajectories(recording.header(), &tracks))),
    ]
}

/// A picture at a quarter of its size; each pixel is the mean of sixteen. So golden files stay small.
fn quarter(pixmap: &Pixmap) -> Pixmap {
    let mut small = Pixmap::new(pixmap.width() / 4, pixmap.height() / 4).unwrap();
    let (width, small_width) = (pixmap.width() as usize, small.width() as usize);
    for (index, bytes) in small.data_mut().chunks_mut(4).enumerate() {
        let (x, y) = (4 * (index % small_width), 4 * (index / small_width));
        for (channel, byte) in bytes.iter_mut().enumerate() {
            let at = |dx: usize, dy: usize| u32::from(pixmap.data()[4 * ((y + dy) * width + x + dx) + channel]);
            let sum: u32 = (0..16).map(|cell| at(cell % 4, cell / 4)).sum();
            *byte = (sum / 16) as u8;
        }
    }
    small
}

fn read_rgb(path: &Path) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    (info.width, info.height, bytes)
}

fn check(name: &str, drawn: &Pixmap) {
    let (width, height, expected) = read_rgb(&golden(name));
    assert_eq!((drawn.width(), drawn.height()), (width, height), "{name}");
    let found = drawn.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]);
    let differences: Vec<u8> = found.zip(&expected).map(|(found, expected)| found.abs_diff(*expected)).collect();
    let mean = differences.iter().map(|value| f64::from(*value)).sum::<f64>() / differences.len() as f64;
    let far_off = differences.iter().filter(|value| **value > PIXEL_TOLERANCE).count() as f64;
    let share = far_off / differences.len() as f64;
    assert!(mean <= MEAN_TOLERANCE && share <= EDGE_SHARE, "{name}: mean {mean:.3}, far off {:.2} %", 100.0 * share);
}

#[test]
fn pictures_look_as_committed() {
    for (name, drawn) in pictures() {
        check(name, &drawn);
    }
}

#[test]
#[ignore = "rewrites the committed recording and pictures; look at them before committing"]
fn rewrite_the_golden_recording_and_its_pictures() {
    std::fs::create_dir_all(golden("")).unwrap();
    support::write_recording(&golden("walkers.fbrec"));
    for (name, drawn) in pictures() {
        png_frame::write(&golden(name), &drawn).unwrap();
    }
}
