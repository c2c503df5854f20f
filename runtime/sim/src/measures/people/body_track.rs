//! One body over time: what the measures of people need of each frame, taken from the final pose.
//!
//! World: metres, seconds, radians, x and y on the ground, z up. Pairs are `[left, right]`.

use std::f32::consts::TAU;
use std::ops::{Range, RangeInclusive};

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Joint, Joints, Skeleton};

use crate::maths::angle::{wrap_rad, yaw};
use crate::maths::segment_distance::distance_m;
use crate::measures::bone_capsule::bone;
use crate::planning::plan::PLANTED_CONTACT;
use crate::recording::frame::AgentFrame;
use crate::synthesis::Mode;

/// Half the interval over which a speed is taken, s: a fifth of a second evens out single frames, not steps.
const SPEED_SPAN_S: f64 = 0.1;
/// Interval over which an acceleration is taken, s: that of frames at 60 Hz.
const ACCELERATION_SPAN_S: f64 = 1.0 / 60.0;

/// A body in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodySample {
    /// Root on the ground, m.
    pub root_m: Vec2,
    /// Facing of hips and shoulders: the mean of their left-to-right unit vectors, turned by 90°, rad.
    pub facing_rad: f32,
    /// Direction in which the shoulders face: their left-to-right vector turned by 90°, rad.
    pub shoulders_rad: f32,
    /// v_pref, m/s.
    pub preferred_mps: Vec2,
    /// Gait phase φ, 0 to 1.
    pub phase: f32,
    /// Whether each foot is planted.
    pub planted: [bool; 2],
    /// Whether the pose is that of a recorded transition.
    pub in_transition: bool,
    /// Whether the agent has arrived.
    pub has_arrived: bool,
    /// Pelvis joint, m.
    pub pelvis_m: Vec3,
    /// Vector from the pelvis to the neck, m.
    pub trunk_m: Vec3,
    /// Orientation of the head.
    pub head: Quat,
    /// Rotation of each hand relative to its forearm.
    pub hands: [Quat; 2],
    /// Ball of each foot on the ground, m.
    pub balls_m: [Vec2; 2],
    /// Direction of each foot, from heel to ball, rad.
    pub feet_rad: [f32; 2],
    /// Difference in height of heel and ball of each foot, m.
    pub feet_tilt_m: [f32; 2],
    /// Height of the lowest of heel, ball and toe tip of each foot, m.
    pub lowest_sole_m: [f32; 2],
    /// Distance of the axes of the shanks, divided by the sum of their radii.
    pub shanks_apart: f32,
}

impl BodySample {
    /// A body of a recorded frame; the joints are in the root's frame.
    pub fn new(skeleton: &Skeleton, agent: &AgentFrame, joints: &Joints, has_arrived: bool) -> Self {
        let (frame, turn) = (agent.root.frame(), yaw(agent.root.facing_rad));
        let world_m = |joint: Joint| frame.to_world(joints.positions_m[joint.index()]);
        let across = |[left, right]: [Joint; 2]| (world_m(right) - world_m(left)).truncate().normalize_or_zero();
        let (hips, shoulders) = (across(Joint::THIGHS), across(Joint::UPPER_ARMS));
        let faced_rad = |across: Vec2| libm::atan2f(across.x, -across.y);
        let soles_m = [0, 1].map(|side| joints.sole_points_m(skeleton, side).map(|point_m| frame.to_world(point_m)));
        let along = soles_m.map(|[heel_m, ball_m, _]| ball_m - heel_m);
        let orientation = |joint: Joint| turn * joints.orientations[joint.index()];
        let pelvis_m = world_m(Joint::Pelvis);
        Self {
            root_m: agent.root.position_m,
            facing_rad: faced_rad(hips + shoulders),
            shoulders_rad: faced_rad(shoulders),
            preferred_mps: agent.preferred_mps,
            phase: agent.phase,
            planted: agent.contacts.map(|contact| contact >= PLANTED_CONTACT),
            in_transition: agent.mode == Mode::Transition,
            has_arrived,
            pelvis_m,
            trunk_m: world_m(Joint::Neck) - pelvis_m,
            head: orientation(Joint::Head),
            hands: [Joint::LeftHand, Joint::RightHand].map(|hand| agent.pose.rotations[hand.index()]),
            balls_m: soles_m.map(|[_, ball_m, _]| ball_m.truncate()),
            feet_rad: along.map(|along_m| libm::atan2f(along_m.y, along_m.x)),
            feet_tilt_m: along.map(|along_m| along_m.z),
            lowest_sole_m: soles_m.map(|points_m| points_m.iter().fold(f32::INFINITY, |low, point| low.min(point.z))),
            shanks_apart: shanks_apart(skeleton, joints),
        }
    }

    /// Whether both feet are planted.
    pub fn stands_on_both_feet(&self) -> bool {
        self.planted == [true; 2]
    }
}

/// Distance of the axes of the shanks, divided by the sum of their radii.
fn shanks_apart(skeleton: &Skeleton, joints: &Joints) -> f32 {
    let [left, right] = Joint::SHANKS.map(Joint::index);
    let radii_m = skeleton.segment_radii_m[left] + skeleton.segment_radii_m[right];
    distance_m(&bone(skeleton, joints, left), &bone(skeleton, joints, right)) / radii_m
}

/// Frames of one body at equal intervals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyTrack {
    /// Id of the agent; 0 of a body without one.
    pub agent: usize,
    /// Time step, s.
    pub dt_s: f64,
    /// Time of the first sample after the start of the recording, s.
    pub start_s: f64,
    /// One sample a frame, without gaps.
    pub samples: Vec<BodySample>,
}

impl BodyTrack {
    /// A body without frames.
    pub fn new(dt_s: f64, start_s: f64) -> Self {
        Self { agent: 0, dt_s, start_s, samples: Vec::new() }
    }

    /// Time of a sample after the start of the recording, s.
    pub fn time_s(&self, index: usize) -> f64 {
        self.start_s + index as f64 * self.dt_s
    }

    /// Frame of a sample in the recording.
    pub fn frame(&self, index: usize) -> usize {
        (self.start_s / self.dt_s).round() as usize + index
    }

    /// Number of samples in a duration, at least one.
    pub fn count(&self, duration_s: f64) -> usize {
        ((duration_s / self.dt_s).round() as usize).max(1)
    }

    /// Time before the arrival, minutes.
    pub fn minutes(&self) -> f64 {
        let under_way = self.samples.iter().filter(|sample| !sample.has_arrived).count();
        under_way as f64 * self.dt_s / 60.0
    }

    /// Velocity of the root at each sample over 0.2 s, m/s.
    pub fn velocities_mps(&self) -> Vec<Vec2> {
        self.velocities_of(|sample| sample.root_m)
    }

    /// Speed of the pelvis on the ground at each sample over 0.2 s, m/s: the same for a capture, which has no root.
    pub fn pelvis_speeds_mps(&self) -> Vec<f64> {
        let velocities = self.velocities_of(|sample| sample.pelvis_m.truncate());
        velocities.into_iter().map(|velocity_mps| f64::from(velocity_mps.length())).collect()
    }

    fn velocities_of(&self, position_m: impl Fn(&BodySample) -> Vec2) -> Vec<Vec2> {
        let (span, last) = (self.count(SPEED_SPAN_S), self.samples.len().saturating_sub(1));
        let velocity_mps = |index: usize| {
            let [from, to] = [index.saturating_sub(span), (index + span).min(last)];
            let moved_m = position_m(&self.samples[to]) - position_m(&self.samples[from]);
            moved_m / ((to - from).max(1) as f64 * self.dt_s) as f32
        };
        (0..self.samples.len()).map(velocity_mps).collect()
    }

    /// Facing at each sample without jumps of 2π, rad.
    pub fn facings_rad(&self) -> Vec<f64> {
        unwrapped(self.samples.iter().map(|sample| sample.facing_rad))
    }

    /// Number of samples over which accelerations are taken: 1/60 s, or one step where that is longer.
    pub fn acceleration_span(&self) -> usize {
        self.count(ACCELERATION_SPAN_S)
    }

    /// Maximal runs of samples for which a property holds.
    pub fn runs(&self, holds: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
        runs(self.samples.len(), holds)
    }
}

/// Maximal runs of indices for which a property holds.
pub(crate) fn runs(count: usize, holds: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for index in (0..count).filter(|&index| holds(index)) {
        match found.last_mut() {
            Some(last) if last.end == index => last.end += 1,
            _ => found.push(index..index + 1),
        }
    }
    found
}

/// First and last of the indices of each incident: indices that are at most `gap` apart belong to one.
pub(crate) fn spans(indices: impl Iterator<Item = usize>, gap: usize) -> Vec<RangeInclusive<usize>> {
    let mut found: Vec<RangeInclusive<usize>> = Vec::new();
    for index in indices {
        match found.last_mut() {
            Some(last) if index <= last.end() + gap => *last = *last.start()..=index,
            _ => found.push(index..=index),
        }
    }
    found
}

/// Angles without jumps of 2π, rad.
pub(crate) fn unwrapped(angles_rad: impl Iterator<Item = f32>) -> Vec<f64> {
    let mut continuous: Vec<f64> = Vec::new();
    let mut before_rad = 0.0;
    for angle_rad in angles_rad {
        let angle_rad = angle_rad.rem_euclid(TAU);
        let next_rad = match continuous.last() {
            Some(last_rad) => last_rad + f64::from(wrap_rad(angle_rad - before_rad)),
            None => f64::from(angle_rad),
        };
        continuous.push(next_rad);
        before_rad = angle_rad;
    }
    continuous
}

#[cfg(test)]
pub(crate) mod tests {
    use motiondb::body::Root;

    use super::*;
    use crate::test_db::test_db;

    /// A body that stands at the origin and faces x.
    pub(crate) fn standing() -> BodySample {
        let db = test_db();
        let agent = AgentFrame { pose: db.rows.pose(0, 0), ..AgentFrame::default() };
        BodySample::new(&db.skeleton, &agent, &agent.pose.forward_kinematics(&db.skeleton), false)
    }

    /// A track of a standing body in steps of 1/60 s, changed at each time (s).
    pub(crate) fn track(duration_s: f64, change: impl Fn(f64, &mut BodySample)) -> BodyTrack {
        let mut track = BodyTrack::new(1.0 / 60.0, 0.0);
        let standing = standing();
        for index in 0..track.count(duration_s) {
            let mut sample = standing;
            change(track.time_s(index), &mut sample);
            track.samples.push(sample);
        }
        track
    }

    #[test]
    fn samples_are_in_the_world() {
        let db = test_db();
        let root = Root { position_m: Vec2::new(3.0, -2.0), facing_rad: 2.0 };
        let agent = AgentFrame { root, pose: db.rows.pose(0, 0), contacts: [1.0, 0.2], ..AgentFrame::default() };
        let sample = BodySample::new(&db.skeleton, &agent, &agent.pose.forward_kinematics(&db.skeleton), true);
        assert!((sample.facing_rad - 2.0).abs() < 1e-5 && (sample.shoulders_rad - 2.0).abs() < 1e-5);
        assert!(sample.pelvis_m.truncate().distance(root.position_m) < 0.05);
        assert!(sample.lowest_sole_m.iter().all(|height_m| height_m.abs() < 1e-3));
        assert!(sample.feet_rad.iter().all(|foot_rad| (foot_rad - 2.0).abs() < 1e-3));
        assert_eq!((sample.planted, sample.has_arrived), ([true, false], true));
        // The ankles are 0.2 m apart, and the legs are parallel.
        let radii_m = Joint::SHANKS.map(|shank| db.skeleton.segment_radii_m[shank.index()]);
        assert!((sample.shanks_apart * (radii_m[0] + radii_m[1]) - 0.2).abs() < 0.01, "{}", sample.shanks_apart);
    }

    #[test]
    fn speeds_and_facings_follow_the_body() {
        let track = track(2.0, |time_s, sample| {
            sample.root_m.x = 1.2 * time_s as f32;
            sample.facing_rad = wrap_rad(3.0 * time_s as f32);
        });
        assert!(track.velocities_mps().iter().all(|velocity| velocity.distance(Vec2::new(1.2, 0.0)) < 1e-3));
        let facings_rad = track.facings_rad();
        assert!((facings_rad[119] - facings_rad[0] - 3.0 * 119.0 / 60.0).abs() < 1e-3);
    }

    #[test]
    fn near_runs_are_one_incident() {
        assert_eq!(runs(7, |index| index != 3 && index != 4), [0..3, 5..7]);
        assert_eq!(spans([1, 2, 3, 8, 9, 20].into_iter(), 5), [1..=9, 20..=20]);
        assert_eq!(spans(std::iter::empty(), 5), []);
    }
}
