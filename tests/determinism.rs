//! Same input, same bytes: with any number of threads and any folder and order of the clips.

mod support;

use std::fs;
use std::path::{Path, PathBuf};

use support::{compile, fbcrowd, files, folder, repository, text};

/// 1,000 agents, and some that come and go, for a few steps: enough for every thread to plan, synthesise and draw.
const CROWD: &str = "duration_s = 0.5\nclips = \"CLIPS\"\nagents = { grid = { columns = 40, rows = 25, spacing_m = 1.5, jitter_m = 0.2 }, goal_offset_m = [30, 0] }\n\n[[sources]]\nrect_m = [-40, -20, -35, 20]\nrate_per_s = 60.0\ngoal_offset_m = [0.3, 0]\nat_goal = \"leave_at_once\"\n\n[view]\nwidth = 480\nheight = 270\n";

fn run_all(threads: &str, folder: &Path) -> Vec<(String, Vec<u8>)> {
    let scene = folder.join("crowd.toml");
    fs::write(&scene, CROWD.replace("CLIPS", text(&repository().join("assets/clips")))).unwrap();
    let output = folder.join("output");
    fbcrowd(&["run", text(&scene), "-o", text(&output), "--threads", threads]).expect_code(0);
    let exr = folder.join("exr");
    let recording = output.join("crowd.fbrec");
    let arguments = ["render", text(&recording), "-o", text(&exr), "--format", "exr", "--threads", threads];
    fbcrowd(&arguments).expect_code(0);
    let listed =
        |folder: PathBuf| files(&folder).into_iter().map(move |name| folder.join(name)).filter(|path| path.is_file());
    let all = listed(output.clone()).chain(listed(output.join("frames"))).chain(listed(exr));
    all.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(path).unwrap())).collect()
}

#[test]
fn all_outputs_are_the_same_for_any_threads() {
    let one = run_all("1", &folder("one_thread"));
    let two = run_all("2", &folder("two_threads"));
    assert!(one.iter().any(|(name, _)| name.ends_with(".exr")) && one.iter().any(|(name, _)| name.ends_with(".png")));
    assert_eq!(one.len(), two.len());
    for ((name, bytes), (same_name, same_bytes)) in one.iter().zip(&two) {
        assert_eq!(name, same_name);
        assert!(bytes == same_bytes, "{name} differs");
    }
}

#[test]
fn folder_and_order_of_clips_change_no_byte() {
    let here = folder("database_here");
    let there = folder("database_there");
    let clips = ["walk_080.bvh", "walk_110.bvh", "idle.bvh"];
    let copies: Vec<String> = clips
        .iter()
        .map(|clip| {
            let copy = there.join(clip);
            fs::copy(repository().join("assets/clips").join(clip), &copy).unwrap();
            text(&copy).to_owned()
        })
        .collect();
    let originals: Vec<String> = clips.iter().rev().map(|clip| format!("assets/clips/{clip}")).collect();
    let database = |clips: &[String], folder: &Path| fs::read(compile(clips, folder)).unwrap();
    assert!(database(&originals, &here) == database(&copies, &there));
}
