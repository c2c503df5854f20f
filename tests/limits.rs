//! Limits of the built binary: large and wrong inputs end early, in little memory, with an exit code and a message.

#![cfg(target_os = "linux")]

mod support;

use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

use support::{WALK, compile, fbcrowd, folder, repository, scenario, text};

/// Address space of a command beside its data, MB: code, stacks, and the room that the allocator reserves for threads.
const OVERHEAD_MB: usize = 350;

/// Runs the built binary with two threads in so much address space, MB, and checks exit code and message.
#[track_caller]
fn check_within(megabytes: usize, arguments: &[&str], code: i32, words: &str) {
    let line = format!("ulimit -v {}; exec \"$BIN\" \"$@\" --threads 2", megabytes * 1000);
    let output = Command::new("sh")
        .args(["-c", &line, "sh"])
        .args(arguments)
        .env("BIN", env!("CARGO_BIN_EXE_fbcrowd"))
        .current_dir(repository())
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}\n{stderr}");
    assert!(stderr.contains(words), "{arguments:?}: `{words}` is missing from\n{stderr}");
}

/// A loop of so many frames: the rows of the bundled walk again and again.
fn long_loop(path: &Path, frames: usize) {
    let walk = fs::read_to_string(repository().join(WALK)).unwrap();
    let (hierarchy, motion) = walk.split_once("MOTION").unwrap();
    let mut lines = motion.trim().lines();
    let (_, time) = (lines.next(), lines.next().unwrap());
    let rows: Vec<&str> = lines.collect();
    let mut file = BufWriter::new(File::create(path).unwrap());
    writeln!(file, "{hierarchy}MOTION\nFrames: {frames}\n{time}").unwrap();
    for frame in 0..frames - 1 {
        writeln!(file, "{}", rows[frame % rows.len()]).unwrap();
    }
    writeln!(file, "{}", rows[0]).unwrap();
}

/// Appends zeros that take no room on the disk.
fn lengthen(path: &Path, bytes: u64) {
    File::options().append(true).create(true).open(path).unwrap().set_len(bytes).unwrap();
}

#[test]
fn a_terabyte_of_zeros_is_refused() {
    let folder = folder("zeros");
    let of_kind = |name: &str| {
        let path = folder.join(name);
        lengthen(&path, 1 << 40);
        text(&path).to_owned()
    };
    let output = folder.join("out.fbdb");
    let output = text(&output);
    check_within(600, &["simulate", &of_kind("scene.toml"), "-o", output], 2, "longer than 16 MiB");
    check_within(600, &["compile", &of_kind("manifest.toml"), "-o", output], 2, "longer than 16 MiB");
    check_within(600, &["compile", &of_kind("walk.bvh"), "-o", output], 2, "longer than");
    check_within(600, &["compile", &of_kind("walk.glb"), "-o", output], 2, "zero byte");
    check_within(600, &["compile", &of_kind("walk.gltf"), "-o", output], 2, "zero byte");
    check_within(600, &["validate", &of_kind("motion.fbdb")], 2, "magic number");
    check_within(600, &["measure", &of_kind("scene.fbrec")], 2, "not an FbCrowd recording");
}

#[test]
fn padding_of_a_glb_is_not_read() {
    let folder = folder("padded_glb");
    let clip = folder.join("walk.glb");
    fs::copy(repository().join("assets/clips/walk_140.glb"), &clip).unwrap();
    lengthen(&clip, 3 << 30);
    check_within(600, &["compile", text(&clip), "-o", text(&folder.join("motion.fbdb"))], 0, "");
}

#[test]
fn a_large_bvh_takes_three_times_its_size() {
    let folder = folder("large_bvh");
    let clip = folder.join("walk.bvh");
    long_loop(&clip, 80_000);
    let megabytes = fs::metadata(&clip).unwrap().len() as usize / 1_000_000;
    assert!(megabytes > 40, "{megabytes} MB");
    let output = folder.join("motion.fbdb");
    check_within(OVERHEAD_MB + 3 * megabytes, &["compile", text(&clip), "-o", text(&output)], 0, "");
}

#[test]
fn a_large_frame_takes_little_memory() {
    let folder = folder("large_frame");
    compile(&[WALK.to_owned()], &folder);
    let head = "duration_s = 0.1\ndatabase = \"motion.fbdb\"\nagents = { at_m = [0, 0], goals_m = [[2, 0]] }\n";
    let scene = scenario(&folder, &format!("{head}[view]\nwidth = 7680\nheight = 4320\n"));
    let (recording, frames) = (folder.join("scene.fbrec"), folder.join("frames"));
    fbcrowd(&["simulate", &scene, "-o", text(&recording)]).expect_code(0);
    let render = ["render", text(&recording), "-o", text(&frames), "--frames", "1001", "--format"];
    for format in ["png", "exr"] {
        check_within(700, &[&render[..], &[format]].concat(), 0, "");
    }
    check_within(300, &[&render[..], &["png"]].concat(), 3, "MiB of memory");
}

#[test]
fn a_crowd_beyond_the_memory_ends_with_code_3() {
    let folder = folder("large_crowd");
    compile(&[WALK.to_owned()], &folder);
    let grid = "[[agents]]\ngrid = { columns = 1000, rows = 500, spacing_m = 1 }\ngoal_offset_m = [1, 0]\n";
    let scene = scenario(&folder, &format!("duration_s = 0.1\ndatabase = \"motion.fbdb\"\n{grid}"));
    let output = folder.join("scene.fbrec");
    check_within(1000, &["simulate", &scene, "-o", text(&output)], 3, "500000 agents need");
    assert!(!output.exists());
}

#[test]
fn a_disk_that_fails_ends_with_code_3() {
    let folder = folder("failing_disk");
    // The system answers every attempt to read this file with an input/output error.
    let failing = "/proc/self/mem";
    let output = folder.join("out.fbdb");
    let clip = folder.join("walk.bvh");
    symlink(failing, &clip).unwrap();
    fbcrowd(&["compile", WALK, text(&clip), "-o", text(&output)])
        .expect_code(3)
        .says(&["walk.bvh", "No output is complete"]);
    fbcrowd(&["validate", failing]).expect_code(3);
    fbcrowd(&["simulate", failing, "-o", text(&output)]).expect_code(3);
    fbcrowd(&["validate", text(&folder)]).expect_code(2);
    assert!(!output.exists());
}

#[test]
fn outputs_of_benches_are_checked_first() {
    let folder = folder("bench_outputs");
    let taken = folder.join("taken");
    fs::write(&taken, "").unwrap();
    let beyond = taken.join("plots");
    for bench in ["figure7", "course", "figure6"] {
        fbcrowd(&["bench", bench, "-o", text(&folder)]).expect_code(2).says(&["not a regular file"]);
    }
    for bench in ["table1", "rimea", "emergence"] {
        fbcrowd(&["bench", bench, "--plots", text(&beyond)]).expect_code(2).says(&["taken"]);
    }
    fbcrowd(&["bench", "table1", "--trajectories", text(&beyond)]).expect_code(2).says(&["taken"]);
}
