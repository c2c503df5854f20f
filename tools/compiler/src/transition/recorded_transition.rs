//! Movement → RecordedTransition: the cut whose ends fit the examples best, its frames at 60 Hz and its root; or nothing
//! where no cut fits.
//!
//! World frame of the clip in, root frame out; times in frames of the clip; metres, seconds, radians.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use motiondb::motion::{ACTION_RATE_HZ, ActionKind, PHASE_COUNT};
use motiondb::quality::planted_feet::PLANTED_CONTACT;

use crate::action::cut_action::sample_frames;
use crate::action::joined_action::JoinedFrame;
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::mean_stride::contact;
use crate::cycle::mirrored::mirrored_pose;
use crate::gait::foot_stance::depth_s;
use crate::gait::movements::{BESIDE_S, Movement, MovementKind, VELOCITY_SPAN_S};
use crate::ground::root_arc::{Rates, relative_to};
use crate::ground::rotations::ground_rotation;
use crate::retarget::human_clip::{HumanBody, HumanPose};
use crate::transition::example_rows::{ExampleRows, RowMatch};
use crate::transition::joint_state::{JointState, Placement};
use crate::transition::root_path::{PathEnd, root_path};

/// Greatest distance of a pose at rest from that of the standing example, m.
const REST_MAX_M: f64 = 0.15;
/// The same where the clip cuts the rest: little more than between two takes of one idle.
const CUT_MAX_M: f64 = 0.06;
/// Greatest distance, in pose and velocity, of a foot strike from the example that it meets, m.
const STRIKE_MAX_M: f64 = 0.15;
/// A longer cut is used only where it fits so much better.
const SHORTER_COUNTS: f64 = 1.25;
/// Distance that counts as none beside others, m.
const SAME_FIT_M: f64 = 0.005;
/// Least turn of a turn on the spot and of a pivot, rad: 45°.
const TURN_MIN_RAD: f64 = PI / 4.0;
/// Greatest displacement of a turn on the spot, leg lengths.
const TURN_DISPLACEMENT_MAX_LEGS: f64 = 0.9;
/// Least and greatest displacement of a step, leg lengths.
const STEP_LEGS: [f64; 2] = [0.12, 1.5];
/// Greatest turn of a step, rad: 30°.
const STEP_TURN_MAX_RAD: f64 = PI / 6.0;
/// Greatest horizontal distance of the pelvis from its root, leg lengths.
const PELVIS_ASIDE_MAX_LEGS: f64 = 0.5;
/// Greatest difference of the root's velocity at an end from that of the example, m/s.
const VELOCITY_MAX_MPS: f64 = 0.08;
/// The same of the turn rate, rad/s.
const TURN_RATE_MAX_RAD_S: f64 = 0.2;
/// Greatest rotation of a joint from one frame to the next, rad; a database accepts a little more.
const JUMP_MAX_RAD: f64 = 0.9;
/// Greatest displacement of the pelvis from one frame to the next, m; a database accepts a little more.
const JUMP_MAX_M: f64 = 0.14;

/// A transition, before the set decides which ones it keeps.
#[derive(Clone, Debug)]
pub(crate) struct RecordedTransition {
    /// What the body does.
    pub(crate) kind: ActionKind,
    /// Index of the clip.
    pub(crate) source: usize,
    /// A manifest states that the clip shows it.
    pub(crate) is_stated: bool,
    /// First and last frame of the clip.
    pub(crate) cut: [f64; 2],
    /// Left and right are exchanged.
    pub(crate) mirrored: bool,
    /// Where it meets the examples.
    pub(crate) ends: [RowMatch; 2],
    /// Foot that leaves the ground first, `[left, right]`.
    pub(crate) first_foot: usize,
    /// Frames, uniform in time.
    pub(crate) frames: Vec<JoinedFrame>,
}

impl RecordedTransition {
    /// Displacement of the root in its first frame, m, and its turn, rad.
    pub(crate) fn travel(&self) -> Placement {
        self.frames.last().map_or((DVec2::ZERO, 0.0), |frame| frame.root)
    }

    /// Distance of both ends from the examples, m.
    pub(crate) fn flaws_m(&self) -> f64 {
        self.ends.iter().map(|end| end.distance_m).sum()
    }

    /// Phase of the example at each end.
    pub(crate) fn phases(&self) -> [f64; 2] {
        self.ends.map(|end| end.row as f64 / PHASE_COUNT as f64)
    }
}

/// A clip, or its mirror image, as transitions are made from it.
pub(crate) struct TransitionClip<'a> {
    /// Index of the clip.
    pub(crate) index: usize,
    /// The clip on the target body.
    pub(crate) found: &'a AnalyzedClip,
    /// Left and right are exchanged.
    pub(crate) mirrored: bool,
    /// The kind of transition that a manifest states; its ends then need not be like the examples.
    pub(crate) stated: Option<ActionKind>,
}

impl TransitionClip<'_> {
    fn pose(&self, frame: f64, body: &HumanBody) -> HumanPose {
        let pose = self.found.grounded.pose_at(frame, body);
        if self.mirrored { mirrored_pose(&pose) } else { pose }
    }

    /// Contact of each foot, `[left, right]`.
    fn contacts(&self, frame: f64) -> [f64; 2] {
        let rate_hz = self.found.grounded.frame_rate_hz;
        let [left, right] = self.found.stances.each_ref().map(|stances| contact(depth_s(stances, frame, rate_hz)));
        if self.mirrored { [right, left] } else { [left, right] }
    }

    /// The joints at a frame; at an end of the clip the velocities are those just inside.
    fn state(&self, frame: f64, body: &HumanBody) -> JointState {
        let searched = self.found.searched_frames();
        let positions_m = |frame: f64| self.pose(frame, body).forward_kinematics(body).positions_m;
        let half = VELOCITY_SPAN_S * self.found.grounded.frame_rate_hz;
        let (before, after) =
            ((frame - half).max(searched.start as f64), (frame + half).min((searched.end - 1) as f64));
        let span_s = (after - before) / self.found.grounded.frame_rate_hz;
        JointState::between(&positions_m(before), positions_m(frame), &positions_m(after), span_s)
    }

    /// The joints a quarter of a stride outside an end of a cut, and the time from there, s; `None` beyond the clip.
    fn state_beside(&self, cut: [f64; 2], end: usize, body: &HumanBody) -> Option<(f64, JointState)> {
        let time_s = if end == 0 { -BESIDE_S } else { BESIDE_S };
        let frame = cut[end] + time_s * self.found.grounded.frame_rate_hz;
        let searched = self.found.searched_frames();
        (searched.start as f64..=(searched.end - 1) as f64).contains(&frame).then(|| (time_s, self.state(frame, body)))
    }

    /// The foot that leaves the ground first after a frame, `[left, right]`.
    fn first_foot(&self, frame: f64) -> usize {
        let off = |side: usize| {
            let offs = self.found.stances[side].iter().map(|stance| stance.off_frame);
            offs.filter(|off| *off > frame).fold(f64::INFINITY, f64::min)
        };
        usize::from((off(1) < off(0)) != self.mirrored)
    }
}

/// The transition of a movement; `None` where no cut fits the examples, or the body does something else.
pub(crate) fn recorded_transition(
    clip: &TransitionClip,
    movement: &Movement,
    rows: &ExampleRows,
    body: &HumanBody,
) -> Option<RecordedTransition> {
    // Several cuts share an end.
    let mut known: [Vec<(f64, Option<RowMatch>)>; 2] = [Vec::new(), Vec::new()];
    let mut matched = |cut: [f64; 2], end: usize| match known[end].iter().find(|(frame, _)| *frame == cut[end]) {
        Some((_, found)) => *found,
        None => {
            let found = end_match(clip, movement, cut, end, rows, body);
            known[end].push((cut[end], found));
            found
        }
    };
    let fitting: Vec<([f64; 2], [RowMatch; 2])> =
        movement.cuts.iter().filter_map(|&cut| Some((cut, [matched(cut, 0)?, matched(cut, 1)?]))).collect();
    let flaws_m = |ends: &[RowMatch; 2]| ends[0].distance_m + ends[1].distance_m;
    let least_m = fitting.iter().map(|(_, ends)| flaws_m(ends)).fold(f64::INFINITY, f64::min);
    let (cut, ends) = fitting.into_iter().find(|(_, ends)| flaws_m(ends) <= SHORTER_COUNTS * least_m + SAME_FIT_M)?;
    let frames = frames(clip, cut, &ends, body);
    let turns = frames.last().is_some_and(|frame| frame.root.1.abs() >= TURN_MIN_RAD);
    let kind = movement.kind.action(turns);
    let found = RecordedTransition {
        kind,
        source: clip.index,
        is_stated: clip.stated.is_some(),
        cut,
        mirrored: clip.mirrored,
        ends,
        first_foot: clip.first_foot(cut[0]),
        frames,
    };
    (is_sound(&found, movement.kind, body) && !jumps(&found.frames, rows)).then_some(found)
}

/// Where an end of a cut meets the examples, if it fits.
fn end_match(
    clip: &TransitionClip,
    movement: &Movement,
    cut: [f64; 2],
    end: usize,
    rows: &ExampleRows,
    body: &HumanBody,
) -> Option<RowMatch> {
    let state = clip.state(cut[end], body);
    if !movement.kind.stands()[end] {
        let limit_m = if clip.stated.is_some() { f64::INFINITY } else { STRIKE_MAX_M };
        return rows.nearest_stepping(&state, clip.state_beside(cut, end, body).as_ref(), limit_m);
    }
    let limit_m = match (clip.stated, movement.is_cut[end]) {
        (Some(_), _) => f64::INFINITY,
        (None, true) => CUT_MAX_M,
        (None, false) => REST_MAX_M,
    };
    let stands = clip.contacts(cut[end]).iter().all(|contact| *contact >= PLANTED_CONTACT);
    rows.nearest_standing(&state).filter(|found| stands && found.pose_m <= limit_m)
}

/// The frames of a cut about its root.
fn frames(clip: &TransitionClip, cut: [f64; 2], ends: &[RowMatch; 2], body: &HumanBody) -> Vec<JoinedFrame> {
    let times: Vec<f64> = sample_frames(cut, clip.found.grounded.frame_rate_hz).collect();
    let poses: Vec<HumanPose> = times.iter().map(|&frame| clip.pose(frame, body)).collect();
    let followed = body_path(&poses, ends[0].root.1, body);
    let duration_s = (times.len() - 1) as f64 / f64::from(ACTION_RATE_HZ);
    let last_facing_rad = followed[followed.len() - 1].1;
    let mut path_ends = ends.map(|end| PathEnd { root: end.root, rates: end.rates });
    path_ends[1].root.1 = near_angle(ends[1].root.1, last_facing_rad);
    let path = root_path(&path_ends, &followed, duration_s);
    let (start_m, start_rad) = path[0];
    let from_start = |(position_m, facing_rad): Placement| {
        (ground_rotation(-start_rad) * (position_m - start_m), facing_rad - start_rad)
    };
    let frame = |((pose, time), root): ((&HumanPose, &f64), &Placement)| JoinedFrame {
        pose: relative_to(*root, pose),
        contacts: clip.contacts(*time),
        root: from_start(*root),
    };
    poses.iter().zip(&times).zip(&path).map(frame).collect()
}

/// Midpoint of the hips and facing of each pose; the facing has no jump of 2π and begins near an angle.
fn body_path(poses: &[HumanPose], begin_rad: f64, body: &HumanBody) -> Vec<Placement> {
    let mut before_rad = begin_rad;
    let of_pose = |pose: &HumanPose| {
        let joints = pose.forward_kinematics(body);
        before_rad = near_angle(joints.facing_rad(), before_rad);
        (joints.hips_m().truncate(), before_rad)
    };
    poses.iter().map(of_pose).collect()
}

/// The angle of the same direction that is nearest to another one, rad.
fn near_angle(angle_rad: f64, other_rad: f64) -> f64 {
    angle_rad + TAU * libm::round((other_rad - angle_rad) / TAU)
}

/// Whether a transition is what its kind says, and plays as a database requires.
fn is_sound(found: &RecordedTransition, movement: MovementKind, body: &HumanBody) -> bool {
    let leg_m = body.leg_length_m();
    let (displacement_m, turn_rad) = found.travel();
    let legs = displacement_m.length() / leg_m;
    let is_its_kind = match found.kind {
        ActionKind::Turn => legs <= TURN_DISPLACEMENT_MAX_LEGS,
        ActionKind::Step => (STEP_LEGS[0]..=STEP_LEGS[1]).contains(&legs) && turn_rad.abs() <= STEP_TURN_MAX_RAD,
        ActionKind::Pivot => turn_rad.abs() >= TURN_MIN_RAD,
        ActionKind::Idle | ActionKind::Start | ActionKind::Stop => true,
    };
    let is_near = |pelvis_m: DVec3| pelvis_m.truncate().length() <= PELVIS_ASIDE_MAX_LEGS * leg_m;
    is_its_kind
        && found.frames.len() > 2
        && found.frames.iter().all(|frame| is_near(frame.pose.pelvis_m))
        && meets(&found.frames[..2], &found.ends[0].rates)
        && meets(&found.frames[found.frames.len() - 2..], &found.ends[1].rates)
        && movement.stands().iter().zip(&found.ends).all(|(stands, end)| *stands == (end.rates == Rates::default()))
}

/// Whether a joint or the pelvis jumps from one frame to the next, as the database stores them.
fn jumps(frames: &[JoinedFrame], rows: &ExampleRows) -> bool {
    let least_dot = libm::cos(0.5 * JUMP_MAX_RAD);
    frames.windows(2).any(|pair| {
        let [from, to] = [&pair[0].pose, &pair[1].pose];
        let rotations = rows.stored_rotations(from).into_iter().zip(rows.stored_rotations(to));
        from.pelvis_m.distance(to.pelvis_m) > JUMP_MAX_M
            || rotations.into_iter().any(|(from, to)| from.dot(to) < least_dot)
    })
}

/// Whether the root moves from one frame to the next at the rates of an example.
fn meets(pair: &[JoinedFrame], rates: &Rates) -> bool {
    let ((from_m, from_rad), (to_m, to_rad)) = (pair[0].root, pair[1].root);
    let rate_hz = f64::from(ACTION_RATE_HZ);
    let velocity_mps = ground_rotation(-0.5 * (from_rad + to_rad)) * (to_m - from_m) * rate_hz;
    velocity_mps.distance(DVec2::new(rates.speed_mps, rates.strafe_mps)) <= VELOCITY_MAX_MPS
        && ((to_rad - from_rad) * rate_hz - rates.turn_rate_rad_s).abs() <= TURN_RATE_MAX_RAD_S
}
