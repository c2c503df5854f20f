//! A synthetic walker for unit tests: exact steps on an arc, so that the result of every stage is known beforehand.
//!
//! World frame: metres, seconds, radians, Z up.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::num::NonZeroUsize;

use glam::{DQuat, DVec2, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::{MotionDb, MotionExample, SourceRecord};

use crate::cycle::gait_cycle::GaitCycle;
use crate::cycle::mean_stride::mean_stride;
use crate::gait::stride::Stride;
use crate::gait::windows::{WindowGait, analyze_gait};
use crate::ground::leg_ik;
use crate::ground::root_arc::{Rates, RootArc};
use crate::ground::root_motion::grounded_clip;
use crate::ground::rotations::ground_rotation;
use crate::retarget::human_clip::{Choices, HumanBody, HumanClip, HumanPose};
use crate::{Options, compile};

/// Height of the ankle above the sole, m.
const ANKLE_M: f64 = 0.09;
/// Share of the period that each foot of an ordinary walk is planted.
const PLANTED_SHARE: f64 = 0.6;

/// The plan of a synthetic walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SyntheticWalk {
    /// Rates of the root.
    pub(crate) rates: Rates,
    /// Duration of a stride, s.
    pub(crate) period_s: f64,
    /// Share of the period from right to left mid-stance.
    pub(crate) left_share: f64,
    /// Share of the period that each foot is planted.
    pub(crate) planted_share: f64,
    /// Duration of the clip, s.
    pub(crate) duration_s: f64,
    /// Frames per second.
    pub(crate) frame_rate_hz: f64,
    /// Scale of the body and of the swing; 1 is a leg of 0.84 m. The rates do not scale.
    pub(crate) size: f64,
}

impl Default for SyntheticWalk {
    fn default() -> Self {
        Self::at(1.2, 0.0, 0.0)
    }
}

impl SyntheticWalk {
    /// Four seconds at 60 frames per second, at these rates.
    pub(crate) fn at(speed_mps: f64, turn_rate_rad_s: f64, strafe_mps: f64) -> Self {
        let rates = Rates { speed_mps, turn_rate_rad_s, strafe_mps };
        let planted_share = PLANTED_SHARE;
        Self { rates, period_s: 1.1, left_share: 0.5, planted_share, duration_s: 4.0, frame_rate_hz: 60.0, size: 1.0 }
    }
}

/// A body with legs of 0.84 m, times `size`.
pub(crate) fn body(size: f64) -> HumanBody {
    let mut offsets_m = [DVec3::ZERO; JOINT_COUNT];
    let mut set = |joint: Joint, x: f64, y: f64, z: f64| {
        offsets_m[joint.index()] = size * DVec3::new(x, y, z);
        offsets_m[joint.mirrored().index()] = size * DVec3::new(x, if joint.mirrored() == joint { y } else { -y }, z);
    };
    for spine in [Joint::SpineLower, Joint::SpineMiddle, Joint::SpineUpper, Joint::Neck, Joint::Head] {
        set(spine, 0.0, 0.0, 0.12);
    }
    set(Joint::LeftClavicle, 0.0, 0.05, 0.1);
    set(Joint::LeftUpperArm, 0.0, 0.13, 0.0);
    set(Joint::LeftForearm, 0.0, 0.28, 0.0);
    set(Joint::LeftHand, 0.0, 0.25, 0.0);
    set(Joint::LeftThigh, 0.0, 0.09, 0.0);
    set(Joint::LeftShank, 0.0, 0.0, -0.42);
    set(Joint::LeftFoot, 0.0, 0.0, -0.42);
    set(Joint::LeftToe, 0.13, 0.0, -0.06);
    let mut segment_ends_m = [DVec3::new(0.0, 0.0, 0.1) * size; JOINT_COUNT];
    let sole = [DVec3::new(-0.05, 0.0, -ANKLE_M), DVec3::new(0.13, 0.0, -ANKLE_M), DVec3::new(0.07, 0.0, -0.03)];
    for toe in Joint::TOES {
        segment_ends_m[toe.index()] = DVec3::new(0.07, 0.0, 0.0) * size;
    }
    let soles_m = [sole.map(|point| point * size); 2];
    HumanBody { offsets_m, segment_ends_m, soles_m, measured_m: soles_m, shows_toe_ends: [true; 2] }
}

/// The clip of a walk; its phase 0 is at 0.37 of a period.
pub(crate) fn walk(name: &str, walk: SyntheticWalk) -> HumanClip {
    let body = body(walk.size);
    let arc = RootArc { start_m: DVec2::new(2.0, -1.0), facing_rad: 0.4, rates: walk.rates };
    let frames = (walk.duration_s * walk.frame_rate_hz) as usize + 1;
    let poses = (0..frames).map(|frame| pose(&walk, &body, &arc, frame as f64 / walk.frame_rate_hz)).collect();
    clip(name, body, poses, walk.frame_rate_hz)
}

/// A body that stands and breathes.
pub(crate) fn idle(name: &str, duration_s: f64) -> HumanClip {
    let still = SyntheticWalk::at(0.0, 0.0, 0.0);
    let arc = RootArc::default();
    let body = body(1.0);
    let frames = (duration_s * 60.0) as usize + 1;
    let poses = (0..frames)
        .map(|frame| {
            let mut pose = pose(&still, &body, &arc, -0.37 * still.period_s);
            pose.rotations[Joint::SpineUpper.index()] = DQuat::from_rotation_y(0.02 * libm::sin(frame as f64 / 31.0));
            for side in 0..2 {
                leg_ik::place_ankle(&mut pose, &body, side, DVec3::new(0.0, 0.09 - 0.18 * side as f64, ANKLE_M));
            }
            pose
        })
        .collect();
    clip(name, body, poses, 60.0)
}

/// A body that stands and sways with a period, s.
pub(crate) fn swaying(name: &str, duration_s: f64, period_s: f64) -> HumanClip {
    let mut clip = idle(name, duration_s);
    for (frame, pose) in clip.frames.iter_mut().enumerate() {
        let angle_rad = 0.03 * libm::sin(TAU * frame as f64 / (60.0 * period_s));
        pose.rotations[Joint::SpineMiddle.index()] = DQuat::from_rotation_x(angle_rad);
    }
    clip
}

/// A body on a given path of the root (position, m, and facing, rad, by time, s), 60 frames per second. Each foot stands
/// on the print that the root has at the middle of each of its stances, `[left, right]`, s; it swings for 0.4 s half-way
/// between two of them.
pub(crate) fn steps(
    name: &str,
    duration_s: f64,
    root: impl Fn(f64) -> (DVec2, f64),
    mid_stances_s: [&[f64]; 2],
) -> HumanClip {
    let body = body(1.0);
    let frame = |frame: usize| {
        let time_s = frame as f64 / 60.0;
        let (root_m, facing_rad) = root(time_s);
        let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
        rotations[0] = DQuat::from_rotation_z(facing_rad);
        rotations[Joint::LeftUpperArm.index()] = DQuat::from_rotation_x(-FRAC_PI_2 + 0.1);
        rotations[Joint::RightUpperArm.index()] = DQuat::from_rotation_x(FRAC_PI_2 - 0.1);
        let mut pose = HumanPose { pelvis_m: root_m.extend(0.8), rotations, extra: Box::default() };
        for (side, mids_s) in mid_stances_s.iter().enumerate() {
            let begun = mids_s.partition_point(|mid_s| *mid_s <= time_s).max(1);
            let (before_s, after_s) = (mids_s[begun - 1], mids_s[begun.min(mids_s.len() - 1)]);
            let swing = ((time_s - 0.5 * (before_s + after_s)) / 0.4 + 0.5).clamp(0.0, 1.0);
            let print = |mid_s: f64| {
                let (root_m, facing_rad) = root(mid_s);
                (root_m + ground_rotation(facing_rad) * DVec2::new(0.0, 0.09 - 0.18 * side as f64), facing_rad)
            };
            let ((from_m, from_rad), (to_m, to_rad)) = (print(before_s), print(after_s));
            let share = 0.5 - 0.5 * libm::cos(PI * swing);
            let ankle_m = from_m.lerp(to_m, share).extend(ANKLE_M + 0.1 * libm::sin(PI * swing));
            let turn = DQuat::from_rotation_z(from_rad + share * (to_rad - from_rad));
            leg_ik::place_foot(&mut pose, &body, side, ankle_m, turn);
        }
        pose
    };
    let poses = (0..=(duration_s * 60.0) as usize).map(frame).collect();
    clip(name, body.clone(), poses, 60.0)
}

/// One performance of several clips: each begins at the position and the facing at which the one before ends.
pub(crate) fn performance(name: &str, parts: &[HumanClip]) -> HumanClip {
    let mut frames: Vec<HumanPose> = Vec::new();
    for part in parts {
        let first = part.frames[0].forward_kinematics(&part.body);
        let last = frames.last().unwrap_or(&part.frames[0]).forward_kinematics(&part.body);
        let turn = DQuat::from_rotation_z(last.facing_rad() - first.facing_rad());
        let moved = |point_m: DVec3| last.hips_m().with_z(0.0) + turn * (point_m - first.hips_m().with_z(0.0));
        frames.extend(part.frames.iter().map(|pose| {
            let mut pose = pose.clone();
            pose.pelvis_m = moved(pose.pelvis_m);
            pose.rotations[0] = turn * pose.rotations[0];
            pose
        }));
    }
    clip(name, parts[0].body.clone(), frames, parts[0].frame_rate_hz)
}

fn clip(name: &str, body: HumanBody, frames: Vec<HumanPose>, frame_rate_hz: f64) -> HumanClip {
    let source = SourceRecord {
        file: format!("{name}.bvh"),
        clip: String::new(),
        speed_mps: 0.0,
        turn_rate_rad_s: 0.0,
        strafe_mps: 0.0,
        up_axis: "+Z".into(),
        metres_per_unit: 1.0,
        frame_rate_hz: frame_rate_hz as f32,
        diagnostics: Vec::new(),
    };
    HumanClip {
        name: name.into(),
        source,
        first_frame: 0,
        frame_rate_hz,
        body,
        extra: Vec::new(),
        frames,
        in_place_mps: None,
        low_parts: Vec::new(),
        spread_parts: Vec::new(),
        seems_to_crawl: false,
        jumps: Vec::new(),
        unfit: None,
        rig_head: None,
        choices: Choices::default(),
        style: String::new(),
        stored: None,
    }
}

fn pose(walk: &SyntheticWalk, body: &HumanBody, arc: &RootArc, time_s: f64) -> HumanPose {
    let (root_m, facing_rad) = arc.at(time_s);
    let cycles = time_s / walk.period_s - 0.37;
    let sway = DVec2::new(0.01 * libm::sin(2.0 * TAU * cycles), -0.02 * libm::cos(TAU * cycles)) * walk.size;
    let height_m = walk.size * (0.80 + 0.01 * libm::cos(2.0 * TAU * cycles));
    let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
    rotations[0] = DQuat::from_rotation_z(facing_rad + 0.05 * libm::sin(TAU * cycles));
    rotations[Joint::LeftUpperArm.index()] = DQuat::from_rotation_x(-FRAC_PI_2 + 0.1);
    rotations[Joint::RightUpperArm.index()] = DQuat::from_rotation_x(FRAC_PI_2 - 0.1);
    let pelvis_m = (root_m + ground_rotation(facing_rad) * sway).extend(height_m);
    let mut pose = HumanPose { pelvis_m, rotations, extra: Box::default() };
    for (side, first_mid_stance) in [(0, walk.left_share), (1, 0.0)] {
        place_foot(&mut pose, walk, body, arc, side, cycles - first_mid_stance);
    }
    pose
}

/// Puts a foot on its footprint, or between two of them; `cycles` counts from one of its mid-stances.
fn place_foot(pose: &mut HumanPose, walk: &SyntheticWalk, body: &HumanBody, arc: &RootArc, side: usize, cycles: f64) {
    let stance = libm::floor(cycles + 0.5);
    let from_mid = cycles - stance;
    let swing = ((from_mid.abs() - 0.5 * walk.planted_share) / (1.0 - walk.planted_share)).max(0.0) * from_mid.signum();
    let first_mid_stance = if side == 0 { walk.left_share } else { 0.0 };
    let print = |stance: f64| {
        let (root_m, facing) = arc.at((stance + first_mid_stance + 0.37) * walk.period_s);
        (root_m + ground_rotation(facing) * DVec2::new(0.0, walk.size * (0.09 - 0.18 * side as f64)), facing)
    };
    let ((here_m, here_rad), (there_m, there_rad)) = (print(stance), print(stance + swing.signum()));
    // Half a swing on either side of mid-swing, which both halves share; with the cosine it leaves and lands at rest.
    let share = 0.5 - 0.5 * libm::cos(PI * swing.abs());
    let lift_m = walk.size * 0.1 * libm::sin(PI * swing.abs());
    let ankle_m = here_m.lerp(there_m, share).extend(walk.size * ANKLE_M + lift_m);
    let facing_rad = here_rad + share * (there_rad - here_rad);
    leg_ik::place_foot(pose, body, side, ankle_m, DQuat::from_rotation_z(facing_rad));
}

/// The mean stride of a clip on its own body.
pub(crate) fn cycle_of(clip: &HumanClip) -> GaitCycle {
    let grounded = grounded_clip(clip, &clip.body);
    let analysis = analyze_gait(&grounded, &clip.body, &[]);
    let first = &analysis.windows.unwrap()[0];
    let WindowGait::Steps(strides) = &first.gait else { panic!("{first:?}") };
    mean_stride(&grounded, &clip.body, &analysis.stances[first.reading], strides)
}

/// The strides of a clip's longest window.
pub(crate) fn strides_of(clip: &HumanClip) -> Vec<Stride> {
    let first = analyze_gait(&grounded_clip(clip, &clip.body), &clip.body, &[]).windows.unwrap().swap_remove(0);
    let WindowGait::Steps(strides) = first.gait else { panic!("{first:?}") };
    strides
}

/// The database of clips, with at most so many recorded examples; 0 keeps all.
pub(crate) fn database_of(clips: Vec<HumanClip>, max_examples: usize) -> MotionDb {
    let options = Options { max_examples: NonZeroUsize::new(max_examples), ..Options::default() };
    compile(clips, &options, &|_| ()).unwrap()
}

/// The examples of a database that are not mirrors.
pub(crate) fn recorded(db: &MotionDb) -> Vec<&MotionExample> {
    db.examples.iter().filter(|example| !example.mirrored).collect()
}
