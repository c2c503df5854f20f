//! Tests of what the bundled clips claim, measured on their own skeleton.
//!
//! Measures are those of the compiler: facing from hips and shoulders; slide of the lowest sole point over the middle
//! 80 % of each contact. A foot is planted where that point is within 2.5 cm of the ground and slower than 0.25 m/s
//! plus 15 % of the body's speed. World frame: metres, Z up.

use glam::{DVec2, DVec3};

use crate::body::ClipPose;
use crate::body::rotation::wrapped;
use crate::body::skeleton::{ARMS, FEET, JOINT_COUNT, SHANKS, THIGHS, TOES};
use crate::catalogue::{ClipRecipe, PlannedClip, planned_clips};
use crate::generate;
use crate::plan::{FRAME_RATE_HZ, StrideVariation};

/// Speed below which feet count as planted for longer, m/s: they move slowly before a strike and after a toe-off.
const SLOW_MPS: f64 = 0.9;
/// Greatest planted share below that speed: 68 % of Schwartz's very slow walkers, and a frame, 2 % of the cycle.
const SLOW_SHARE_MAX: f64 = 0.70;

/// Joint positions of every frame, m.
type JointFrames = Vec<[DVec3; JOINT_COUNT]>;

fn frames(clip: &PlannedClip) -> JointFrames {
    clip.poses().iter().map(ClipPose::positions_m).collect()
}

fn is_running(clip: &PlannedClip) -> bool {
    matches!(&clip.recipe, ClipRecipe::Steps { gait, .. } if gait.running)
}

/// Fails unless every clip meets a claim; lists the others.
#[track_caller]
fn check_each(claim: impl Fn(&PlannedClip, &JointFrames) -> Result<(), String>) {
    let broken: Vec<String> = planned_clips()
        .iter()
        .filter_map(|clip| claim(clip, &frames(clip)).err().map(|error| format!("{}: {error}", clip.name)))
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

fn within(what: &str, value: f64, range: std::ops::RangeInclusive<f64>) -> Result<(), String> {
    if range.contains(&value) { Ok(()) } else { Err(format!("{what} {value:.4} outside {range:?}")) }
}

fn facing(joints: &[DVec3; JOINT_COUNT]) -> DVec2 {
    let across = |pair: [usize; 2]| (joints[pair[1]] - joints[pair[0]]).normalize();
    let right = across(THIGHS) + across(ARMS);
    DVec2::new(-right.y, right.x).normalize()
}

fn sole_points(joints: &[DVec3; JOINT_COUNT], side: usize) -> [DVec3; 3] {
    [TOES[side] + 1, TOES[side] + 2, TOES[side] + 3].map(|index| joints[index])
}

fn knee_flexion_deg(joints: &[DVec3; JOINT_COUNT], side: usize) -> f64 {
    let thigh = joints[SHANKS[side]] - joints[THIGHS[side]];
    let shank = joints[FEET[side]] - joints[SHANKS[side]];
    libm::acos((thigh.normalize().dot(shank.normalize())).clamp(-1.0, 1.0)).to_degrees()
}

/// Mean slide in cm/s and planted share of one foot.
fn slide_and_share(frames: &JointFrames, side: usize, pace_mps: f64) -> (f64, f64) {
    let last = frames.len() - 1;
    let lowest_and_speed = |i: usize| {
        let points = sole_points(&frames[i], side);
        let k = (0..3).min_by(|a, b| points[*a].z.total_cmp(&points[*b].z)).unwrap();
        let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
        let moved_m = (sole_points(&frames[after], side)[k] - sole_points(&frames[before], side)[k]).truncate();
        (points[k].z, moved_m.length() * FRAME_RATE_HZ / (after - before) as f64)
    };
    let feet: Vec<(f64, f64)> = (0..frames.len()).map(lowest_and_speed).collect();
    let planted: Vec<bool> = feet.iter().map(|(z, speed)| *z < 0.025 && *speed < 0.25 + 0.15 * pace_mps).collect();
    let (mut sum, mut count, mut start) = (0.0, 0, 0);
    while start < planted.len() {
        let length = planted[start..].iter().take_while(|planted| **planted).count();
        let margin = (length as f64 * 0.1).round() as usize;
        if length >= 3 {
            for (_, speed) in &feet[start + margin..start + length - margin] {
                sum += speed * 100.0;
                count += 1;
            }
        }
        start += length.max(1);
    }
    let share = planted.iter().filter(|planted| **planted).count() as f64 / planted.len() as f64;
    (sum / f64::from(count), share)
}

#[test]
fn committed_clips_are_what_the_generator_writes() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips");
    let files = generate();
    for file in &files {
        let committed = std::fs::read(folder.join(&file.name)).unwrap_or_default();
        assert!(committed == file.bytes, "{} differs: run `fbcrowd clips --out assets/clips`", file.name);
    }
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), files.len(), "a file that the generator does not write");
    assert!(files.iter().map(|file| file.bytes.len()).sum::<usize>() < 5_000_000);
}

#[test]
fn clips_move_as_their_names_claim() {
    check_each(|clip, frames| {
        let hips = |joints: &[DVec3; JOINT_COUNT]| (0.5 * (joints[THIGHS[0]] + joints[THIGHS[1]])).truncate();
        let (mut velocity, count) = (DVec2::ZERO, (frames.len() - 1) as f64);
        for pair in frames.windows(2) {
            let ahead = (facing(&pair[0]) + facing(&pair[1])).normalize();
            let step = (hips(&pair[1]) - hips(&pair[0])) * FRAME_RATE_HZ / count;
            velocity += DVec2::new(step.dot(ahead), ahead.perp_dot(step));
        }
        let turned: f64 = frames.windows(2).map(|pair| facing(&pair[0]).angle_to(facing(&pair[1]))).sum();
        let turn_deg_s = (turned * FRAME_RATE_HZ / count).to_degrees();
        let off = |claim: f64, least: f64| (0.01 * claim.abs()).max(least);
        let around = |claim: f64, least: f64| claim - off(claim, least)..=claim + off(claim, least);
        within("v_f", velocity.x, around(clip.motion.speed_mps, 0.01))?;
        within("ω_s", velocity.y, around(clip.motion.strafe_mps, 0.01))?;
        within("ω_t", turn_deg_s, around(clip.motion.turn_rate_rad_s.to_degrees(), 0.5))
    });
}

#[test]
fn planted_feet_stand_still_as_long_as_human_ones() {
    check_each(|clip, frames| {
        for side in 0..2 {
            let (slide_cm_s, share) = slide_and_share(frames, side, clip.motion.pace_mps());
            let (slide_bar, shares) = match (&clip.recipe, is_running(clip)) {
                (ClipRecipe::Idle(_), _) => (0.1, 1.0..=1.0),
                (_, true) => (3.0, 0.28..=0.45),
                (_, false) if clip.motion.pace_mps() < SLOW_MPS => (1.0, 0.45..=SLOW_SHARE_MAX),
                (_, false) => (1.0, 0.45..=0.65),
            };
            within("slide", slide_cm_s, 0.0..=slide_bar)?;
            within("planted share", share, shares)?;
        }
        Ok(())
    });
}

#[test]
fn no_sole_goes_through_the_floor() {
    check_each(|_, frames| {
        let soles = frames.iter().flat_map(|joints| [sole_points(joints, 0), sole_points(joints, 1)].concat());
        within("lowest sole point", soles.map(|point| point.z).fold(f64::INFINITY, f64::min), -0.005..=0.005)
    });
}

#[test]
fn knees_stay_within_the_human_range() {
    check_each(|_, frames| {
        for joints in frames {
            for side in 0..2 {
                within("knee flexion", knee_flexion_deg(joints, side), 1.0..=130.0)?;
            }
        }
        Ok(())
    });
}

#[test]
fn the_leg_that_bears_the_weight_is_straight_under_the_higher_hip() {
    for (name, bearing) in [("idle_on_left_leg", 0), ("idle_on_right_leg", 1)] {
        let clips = planned_clips();
        let clip = clips.iter().find(|clip| clip.name == name).unwrap();
        for joints in &frames(clip) {
            let knees_deg = [bearing, 1 - bearing].map(|side| knee_flexion_deg(joints, side));
            assert!(knees_deg[0] < 8.0 && knees_deg[1] > 14.0, "{name}: {knees_deg:?}");
            let [hips_m, ankles_m] = [THIGHS, FEET].map(|pair| [bearing, 1 - bearing].map(|side| joints[pair[side]]));
            assert!(hips_m[0].z > hips_m[1].z + 0.004, "{name}: {hips_m:?}");
            let to_ankles_m = ankles_m.map(|ankle_m| (ankle_m.y - 0.5 * (hips_m[0].y + hips_m[1].y)).abs());
            assert!(to_ankles_m[0] < 0.6 * to_ankles_m[1], "{name}: {to_ankles_m:?}");
        }
    }
}

#[test]
fn the_last_frame_is_the_first_one_moved_on() {
    check_each(|clip, frames| {
        let (first, last) = (frames[0], frames[frames.len() - 1]);
        let turn = facing(&first).angle_to(facing(&last));
        let (sin, cos) = libm::sincos(turn);
        for index in 0..JOINT_COUNT {
            let [from, to] = [first, last].map(|joints| joints[index] - joints[0]);
            let expected = DVec2::new(cos, sin).rotate(from.truncate()).extend(from.z);
            within(clip.name, expected.distance(to), 0.0..=1e-6)?;
        }
        let durations_s = if matches!(clip.recipe, ClipRecipe::Idle(_)) { 11.0..=15.0 } else { 1.0..=6.0 };
        within("duration", (frames.len() - 1) as f64 / FRAME_RATE_HZ, durations_s)
    });
}

#[test]
fn no_joint_pops_between_frames() {
    // A pop is a change of velocity within one frame. A struck heel changes a foot's by some 1.5 m/s in walking, 4 m/s
    // in running.
    check_each(|clip, frames| {
        let bar_mps = if is_running(clip) { 6.0 } else { 3.5 };
        for triple in frames.windows(3) {
            for ((before, now), after) in triple[0].iter().zip(&triple[1]).zip(&triple[2]) {
                let change = (after - 2.0 * now + before) * FRAME_RATE_HZ;
                within("velocity change", change.length(), 0.0..=bar_mps)?;
            }
        }
        Ok(())
    });
}

#[test]
fn straight_walks_keep_adult_cadence_and_stride() {
    // (speed m/s, cadence steps/min, stride m) of men slow, men or women normal, men or women fast: 18–29 years, ±1 SD.
    let bands = [
        (0.85..=1.20, 86.0..=101.0, 1.18..=1.48),
        (1.20..=1.65, 99.0..=124.0, 1.31..=1.66),
        (1.65..=2.25, 118.0..=156.0, 1.56..=1.98),
    ];
    for clip in planned_clips().iter().filter(|clip| clip.name.starts_with("walk_")) {
        let (cadence, step_m) = clip.cadence_and_step_m().unwrap();
        for (_, cadences, strides) in bands.iter().filter(|band| band.0.contains(&clip.motion.speed_mps)) {
            assert!(
                cadences.contains(&cadence) && strides.contains(&(2.0 * step_m)),
                "{} {cadence} {step_m}",
                clip.name
            );
        }
    }
}

#[test]
fn walking_joints_follow_published_curves_within_five_degrees() {
    for clip in planned_clips().iter().filter(|clip| clip.name.starts_with("walk_")) {
        let ClipRecipe::Steps { gait, strides, .. } = &clip.recipe else { panic!("{} does not step", clip.name) };
        let variation = StrideVariation::of_clip(clip.name, *strides);
        let frames = frames(clip);
        let strides = &frames[1..];
        let mut squares = [0.0; 3];
        for (frame, joints) in strides.iter().enumerate() {
            let p = wrapped(gait.yaw_peak + variation.strides_after((frame + 1) as f64 / gait.stride_frames));
            let published = gait.style.flexion(p, gait.toe_off);
            let pitch_deg = |from: usize, to: usize| {
                let bone = joints[to] - joints[from];
                libm::atan2(bone.truncate().dot(facing(joints)), -bone.z).to_degrees()
            };
            let [thigh, shank] = [pitch_deg(THIGHS[0], SHANKS[0]), pitch_deg(SHANKS[0], FEET[0])];
            let sole = pitch_deg(TOES[0] + 2, TOES[0] + 3) - 90.0;
            let errors =
                [thigh - published.thigh_deg, thigh - shank - published.knee_deg, sole - shank - published.ankle_deg];
            squares.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error / strides.len() as f64);
        }
        let rms_deg = squares.map(libm::sqrt);
        assert!(rms_deg.iter().all(|rms| *rms < 5.0), "{}: hip, knee, ankle {rms_deg:.1?}", clip.name);
    }
}

#[test]
fn slow_side_steps_nearly_stop_with_the_feet_together() {
    let clips = planned_clips();
    let clip = clips.iter().find(|clip| clip.name == "side_035_left").unwrap();
    let frames = frames(clip);
    let slowest = frames
        .windows(2)
        .map(|pair| ((pair[1][0] - pair[0][0]).y * FRAME_RATE_HZ, (pair[1][FEET[0]] - pair[1][FEET[1]]).y))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let (speed_mps, apart_m) = slowest.unwrap();
    assert!(speed_mps < 0.3 * clip.motion.strafe_mps && apart_m < 0.3, "{speed_mps} {apart_m}");
}

#[test]
fn the_generator_is_deterministic() {
    assert!(generate() == generate());
}
