//! The constraint overlay: the same picture in every run, for any planner and agents; errors state the remedy.

use std::fs;
use std::path::Path;

use fbcrowd_render::error::RenderError;
use fbcrowd_render::top_view::{PictureFormat, SequenceOptions, render_sequence};
use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::recording::Recording;

use crate::sequence::options;
use crate::support::{self, Scratch};

/// A recording of the scene of the golden pictures, with a planner.
fn recording(folder: &Path, planner: Planner, steps: usize) -> Recording {
    let mut header = support::golden_header();
    header.scenario.planner = planner;
    let path = folder.join("walkers.fbrec");
    support::write_steps(&path, &header, steps);
    Recording::open(&path).unwrap()
}

/// The bytes of one picture, drawn with a number of threads.
fn bytes(recording: &Recording, folder: &Path, format: PictureFormat, agents: &[usize], threads: usize) -> Vec<u8> {
    let options = SequenceOptions { constraints_of: agents.to_vec(), ..options(folder, format, Some("1021,1022")) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let files = pool.install(|| render_sequence(recording, &options, &|_, _| ())).unwrap();
    fs::read(&files[0]).unwrap()
}

fn width_px(png: &[u8]) -> u32 {
    png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap().info().width
}

#[test]
fn panels_depend_on_the_planner_not_on_threads() {
    let scratch = Scratch::new("overlay");
    let folder = scratch.path();
    let planners = [Planner::Mcn, Planner::Orca, Planner::SocialForce];
    let drawn = planners.map(|planner| {
        let recording = recording(folder, planner, 16);
        let [one, two] = [1, 2].map(|threads| bytes(&recording, folder, PictureFormat::Png, &[2], threads));
        assert!(one == two, "{planner:?}");
        one
    });
    assert!(drawn[0] != drawn[1] && drawn[1] != drawn[2]);
}

#[test]
fn each_agent_has_a_panel_in_png_and_exr() {
    let scratch = Scratch::new("panels");
    let folder = scratch.path();
    let recording = recording(folder, Planner::Mcn, 16);
    let [scene, one, two] =
        [&[][..], &[2], &[5, 2]].map(|agents| width_px(&bytes(&recording, folder, PictureFormat::Png, agents, 1)));
    assert!(one > scene && two - one == one - scene, "{scene} {one} {two}");
    let [scene, one] = [&[][..], &[2]].map(|agents| bytes(&recording, folder, PictureFormat::Exr, agents, 1).len());
    assert!(one > scene);
}

#[test]
fn overlays_that_cannot_be_drawn_are_rejected() {
    let scratch = Scratch::new("rejected");
    let folder = scratch.path();
    let rejection = |steps: usize, agents: Vec<usize>| {
        let recording = recording(folder, Planner::Mcn, steps);
        let options = SequenceOptions { constraints_of: agents, ..options(folder, PictureFormat::Png, None) };
        render_sequence(&recording, &options, &|_, _| ()).unwrap_err()
    };
    let error = rejection(1, vec![2, 7]);
    assert!(matches!(error, RenderError::NoSuchAgent { agent: 7, count: 7 }), "{error}");
    assert!(error.to_string().contains("0 to 6"), "{error}");
    assert!(matches!(rejection(0, vec![2]), RenderError::NoStep));
    assert!(matches!(rejection(1, vec![2; 99]), RenderError::TooManyPanels { requested: 99, .. }));
}
