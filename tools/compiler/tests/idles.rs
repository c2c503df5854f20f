//! Claims about clips that stand.

use std::fs;
use std::path::Path;

use motiondb::motion::ActionKind;
use motiondb_compiler::{HumanClip, Options, compile, import_bytes, import_file};

const CLIPS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");

/// The bundled idle with other rows of channels.
fn idle_with(change: impl FnOnce(Vec<&str>) -> Vec<String>) -> HumanClip {
    let text = fs::read_to_string(Path::new(CLIPS).join("idle.bvh")).unwrap();
    let (head, rows) = text.split_once("Frame Time:").unwrap();
    let (skeleton, _) = head.split_once("Frames:").unwrap();
    let (frame_time, rows) = rows.split_once('\n').unwrap();
    let rows = change(rows.lines().collect());
    let changed = format!("{skeleton}Frames: {}\nFrame Time:{frame_time}\n{}\n", rows.len(), rows.join("\n"));
    import_bytes(Path::new("idle.bvh"), changed.as_bytes()).unwrap().remove(0).outcome.unwrap()
}

/// The bundled idle, cut after so many frames.
fn idle(frames: usize) -> HumanClip {
    idle_with(|rows| rows.into_iter().take(frames).map(str::to_owned).collect())
}

/// The bundled idle with noise of up to `noise_deg` on every rotation.
fn noisy_idle(noise_deg: f64) -> HumanClip {
    let mut state = 1_u32;
    let mut noise = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        noise_deg * (2.0 * f64::from(state >> 8) / f64::from(1 << 24) - 1.0)
    };
    // The first three channels are the position of the root.
    let mut noisy = |(channel, value): (usize, &str)| {
        let value: f64 = value.parse().unwrap();
        (if channel < 3 { value } else { value + noise() }).to_string()
    };
    let mut row = |row: &str| row.split_whitespace().enumerate().map(&mut noisy).collect::<Vec<_>>().join(" ");
    idle_with(|rows| rows.into_iter().map(&mut row).collect())
}

#[test]
fn an_idle_closes_wherever_it_is_cut() {
    let walk = import_file(&Path::new(CLIPS).join("walk_110.bvh")).unwrap().remove(0).outcome.unwrap();
    for frames in [50, 60, 70, 80, 90, 100, 110, 120] {
        let db = compile(vec![walk.clone(), idle(frames)], &Options::default(), &|_| ());
        assert!(db.is_ok(), "{frames} frames: {:?}", db.err());
    }
}

#[test]
fn the_noise_of_a_capture_is_no_movement() {
    let walk = import_file(&Path::new(CLIPS).join("walk_110.bvh")).unwrap().remove(0).outcome.unwrap();
    for noise_deg in [0.1, 0.3] {
        let db = compile(vec![walk.clone(), noisy_idle(noise_deg)], &Options::default(), &|_| ()).unwrap();
        assert_eq!(db.actions.len(), 1, "{noise_deg}°: {:?}", db.sources);
        assert_eq!(db.actions[0].kind, ActionKind::Idle);
    }
}
