//! Clips whose travel is removed walk in place at the speed at which they travelled: bundled ones of every gait, and
//! walks, runs, side-steps and turns of others, at several frame rates.

use fbcrowd_bench::compiler::ground_truth::GroundTruth;
use glam::DVec3;
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb_compiler::read::SourceClip;
use motiondb_compiler::retarget::{SourceParameters, source_parameters, units};
use motiondb_compiler::rig::{Roles, find_roles};

use super::ground_truth::{locomotion, source};
use super::support::{bundled_folder, mocap};

/// Straight clips of every gait: name, v_f and ω_s in m/s (`assets/clips/README.md`).
const STRAIGHT: [(&str, [f64; 2]); 10] = [
    ("walk_050", [0.5, 0.0]),
    ("walk_080", [0.8, 0.0]),
    ("walk_110", [1.1, 0.0]),
    ("walk_180", [1.8, 0.0]),
    ("jog_240", [2.4, 0.0]),
    ("run_350", [3.5, 0.0]),
    ("side_060_left", [0.0, 0.6]),
    ("shuffle_120_left", [0.0, 1.2]),
    ("diagonal_080_040_left", [0.8, 0.4]),
    ("backward_110", [-1.1, 0.0]),
];

/// How the travel is removed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Removed {
    /// In every frame, as game engines hold a root.
    Always,
    /// By the straight line from start to end: hips surge and sway as before.
    Straight,
}

fn hips(clip: &SourceClip, roles: &Roles, frame: usize) -> DVec3 {
    0.5 * Joint::THIGHS.map(|hip| clip.position(frame, roles.required(hip))).iter().sum::<DVec3>()
}

/// Removes the travel from the first to the last frame.
fn stay_in_place(clip: &mut SourceClip, roles: &Roles, removed: Removed) {
    let (last, count) = (clip.frame_count() - 1, clip.joints.len());
    let first_m = hips(clip, roles, 0);
    let travel_m = hips(clip, roles, last) - first_m;
    for frame in 0..=last {
        let removed_m = match removed {
            Removed::Always => hips(clip, roles, frame) - first_m,
            Removed::Straight => travel_m * (frame as f64 / last as f64),
        };
        clip.positions[frame * count..][..count].iter_mut().for_each(|position| *position -= removed_m.with_z(0.0));
    }
}

/// The same motion at another frame rate.
fn sampled(clip: &SourceClip, frame_rate_hz: f64) -> SourceClip {
    let (last, count) = (clip.frame_count() - 1, clip.joints.len());
    let frames = 1 + (last as f64 * frame_rate_hz / clip.frame_rate_hz + 1e-9) as usize;
    let mut other = SourceClip { frame_rate_hz, positions: Vec::new(), orientations: Vec::new(), ..clip.clone() };
    for frame in 0..frames {
        let at = frame as f64 * clip.frame_rate_hz / frame_rate_hz;
        let (before, after) = (at as usize, (at as usize + 1).min(last));
        for joint in 0..count {
            other.positions.push(clip.position(before, joint).lerp(clip.position(after, joint), at - before as f64));
            other.orientations.push(clip.orientation(before, joint));
        }
    }
    other
}

#[test]
fn bundled_clips_in_place_keep_their_speed() {
    let mut bad = Vec::new();
    for (name, wanted) in STRAIGHT {
        let clip = source(&bundled_folder().join(format!("{name}.bvh")), "");
        let roles = find_roles(&clip, &[None; JOINT_COUNT]).unwrap();
        let (mut clip, _) = units::to_metres_z_up(clip, &roles);
        stay_in_place(&mut clip, &roles, Removed::Straight);
        let whole = source_parameters(&clip, &roles);
        let found = [whole.speed_mps, whole.strafe_mps];
        let off = (0..2).map(|axis| (found[axis] - wanted[axis]).abs()).fold(0.0, f64::max);
        let limit = 0.03 * libm::hypot(wanted[0], wanted[1]);
        if !whole.is_in_place || off > limit {
            bad.push(format!("{name}: {found:.3?}, not {wanted:?}"));
        }
    }
    assert!(bad.is_empty(), "{}", bad.join("\n"));
}

/// Whether a clip has one speed: no starts, stops, single steps, and no capture of many speeds, whose mean is the speed
/// of none of its feet.
fn is_steady(row: &GroundTruth) -> bool {
    const UNSTEADY: [&str; 8] = ["_To", "_Step", "Turn90", "Turn180", "Turn360", "ezgi", "pfnn", "lafan1"];
    let [forward_mps, _, left_mps] = row.measured;
    row.duration_s >= 1.0
        && libm::hypot(forward_mps, left_mps) > 0.4
        && !UNSTEADY.iter().any(|part| row.file.contains(part))
}

/// Parameters of a clip in metres without its travel, at another frame rate.
fn measured_in_place(clip: &SourceClip, roles: &Roles, frame_rate_hz: f64, removed: Removed) -> SourceParameters {
    let mut clip = sampled(clip, frame_rate_hz);
    stay_in_place(&mut clip, roles, removed);
    source_parameters(&clip, roles)
}

/// The parameters before the removal of the travel are the truth. Of 384 cases 41 are off, 37 of them with hips held in
/// every frame. Those lose their surge, and in the stances of runs hips are slower than between them: five runs of
/// Bandai and CMU's 002_03 are 8 to 13 % too slow (25 cases, three rates of each or more; the limit is 9 %), six walks
/// 8 to 12 % (11 cases, four of them of 007_04). In uneven clips one foot counts more than the other: angry_13, a run
/// of 1.2 s, goes
/// 0.4 m/s aside (4 cases), Marine's Run and RunCircle 0.12 to 0.13 m/s where 0.12 is the limit.
#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn real_gaits_in_place_keep_their_speed() {
    const IN_PLACE_TIMES: f64 = 3.0;
    const SHARE_MIN: f64 = 0.875;
    let folder = mocap();
    let (mut cases, mut bad) = (0, Vec::new());
    for row in locomotion(&folder).iter().filter(|row| is_steady(row)) {
        let clip = source(&folder.join(&row.file), &row.clip);
        let roles = find_roles(&clip, &[None; JOINT_COUNT]).unwrap();
        let (mut clip, _) = units::to_metres_z_up(clip, &roles);
        clip.keep_frames(1..clip.frame_count()); // some begin with a separate pose
        let wanted = source_parameters(&clip, &roles);
        let is_straight = row.measured[1].abs() < 8.0;
        for removed in [Removed::Always, Removed::Straight]
            .into_iter()
            .filter(|removed| is_straight || *removed == Removed::Always)
        {
            for frame_rate_hz in [24.0, 30.0, 60.0, 120.0] {
                let found = measured_in_place(&clip, &roles, frame_rate_hz, removed);
                let limits = [(0.03 * wanted.speed_mps.abs()).max(0.03), 0.04].map(|limit| IN_PLACE_TIMES * limit);
                let off = [found.speed_mps - wanted.speed_mps, found.strafe_mps - wanted.strafe_mps];
                cases += 1;
                if !found.is_in_place || (0..2).any(|axis| off[axis].abs() > limits[axis]) {
                    let name = row.file.rsplit('/').next().unwrap();
                    bad.push(format!("{name} at {frame_rate_hz} Hz, {removed:?}: off by {off:.2?} of {wanted:.2?}"));
                }
            }
        }
    }
    println!("{} of {cases} off:\n{}", bad.len(), bad.join("\n"));
    assert!(cases > 200 && bad.len() as f64 <= (1.0 - SHARE_MIN) * f64::from(cases), "{} of {cases}", bad.len());
}
