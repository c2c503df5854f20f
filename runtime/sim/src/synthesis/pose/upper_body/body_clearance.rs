//! Body clearance: the upper body leans away from walls and other bodies, and its arms come in. `FbCrowd` does not have
//! it.
//!
//! The trunk tilts about the foot of the spine as far as brings both shoulders within the elbow room
//! ([`crate::planning::elbow_room`]), and no farther than people lean; the head keeps its orientation. Then each arm
//! turns as a whole about its shoulder as far as brings elbow, wrist and finger tips within the room, and no farther
//! than under the shoulder. Between two sides that leave too little room it comes to rest nearer to the first, so that
//! walls, which come last, are kept to. All turns follow by a filter of the third order: neither rate nor acceleration
//! of an arm jumps, and what passes quickly is touched for a moment. Root, pelvis and legs do not depend on it.
//!
//! Frame of the drawn body (x forward, y left, z up), metres, radians.

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Joint, Pose, Skeleton};

use crate::maths::angle::rotation;
use crate::planning::elbow_room::{ElbowRoom, RoomSide, SIDES_MAX};
use crate::synthesis::TimeStep;
use crate::synthesis::pose::lean::incline::tilt_trunk;

/// Greatest tilt of the trunk, rad (9°).
const TILT_MAX_RAD: f32 = 0.16;
/// Overlap with the border of the room from which on a body yields by the whole of it in a round, m. It begins to yield
/// as far before the border, so that it moves without a jerk.
const SOFT_M: f32 = 0.06;
/// Rounds in which a turn yields to all sides, one after the other: to yield to one may lead beyond another. Beside a
/// single side a body at the border comes in by 3 cm so, instead of 1.5.
const ROUNDS: usize = 4;
/// Turn below which a body without walls and bodies near by is left unchanged, rad; likewise its rates.
const STILL_RAD: f32 = 1e-4;
/// The joints from the foot of the spine to each hand, `[left, right]`.
const ARMS: [[Joint; 7]; 2] = [
    [
        Joint::SpineLower,
        Joint::SpineMiddle,
        Joint::SpineUpper,
        Joint::LeftClavicle,
        Joint::LeftUpperArm,
        Joint::LeftForearm,
        Joint::LeftHand,
    ],
    [
        Joint::SpineLower,
        Joint::SpineMiddle,
        Joint::SpineUpper,
        Joint::RightClavicle,
        Joint::RightUpperArm,
        Joint::RightForearm,
        Joint::RightHand,
    ],
];

/// How a body keeps clear.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BodyClearance {
    /// Turn of the trunk, a vector along its axis, rad, its rate of change, rad/s, and its acceleration, rad/s².
    trunk_rad: [Vec3; 3],
    /// The same of the arms, `[left, right]`.
    arms_rad: [[Vec3; 3]; 2],
}

/// A point of the body, and the radius of the body about it, m.
#[derive(Clone, Copy, Debug)]
struct RoundPoint {
    centre_m: Vec3,
    radius_m: f32,
}

/// An arm of a pose.
#[derive(Clone, Copy, Debug)]
struct PosedArm {
    /// The foot of the spine, m.
    spine_m: Vec3,
    /// The shoulder joint, as thick as the upper arm, or as what carries it.
    shoulder: RoundPoint,
    /// Orientation of what carries the upper arm.
    carrier: Quat,
    /// Elbow, wrist and finger tips.
    points: [RoundPoint; 3],
}

impl BodyClearance {
    /// Brings the upper body of a pose within the room over one step.
    pub(crate) fn bring_in(&mut self, pose: &mut Pose, room: &ElbowRoom, skeleton: &Skeleton, step: &TimeStep) {
        let is_still = |turn: &[Vec3; 3]| turn.iter().all(|value| value.length_squared() < STILL_RAD * STILL_RAD);
        if room.sides().is_empty() && is_still(&self.trunk_rad) && self.arms_rad.iter().all(is_still) {
            *self = Self::default();
            return;
        }
        let arms = ARMS.map(|arm| PosedArm::of(pose, arm.map(Joint::index), skeleton));
        let spine_m = arms[0].spine_m;
        let target_rad = turn_rad(spine_m, arms.map(|arm| arm.shoulder), room).clamp_length_max(TILT_MAX_RAD);
        step.clearance.approach(&mut self.trunk_rad, target_rad);
        let trunk_rad = self.trunk_rad[0];
        // The axis is z × tilt.
        tilt_trunk(pose, Vec2::new(trunk_rad.y, -trunk_rad.x));
        let tilt = rotation(trunk_rad);
        for (side, arm) in arms.into_iter().enumerate() {
            let arm = arm.tilted(tilt);
            let target_rad = turn_rad(arm.shoulder.centre_m, arm.points, room);
            step.clearance.approach(&mut self.arms_rad[side], target_rad);
            let turn = rotation(self.arms_rad[side][0]);
            let rotated = &mut pose.rotations[Joint::UPPER_ARMS[side].index()];
            *rotated = (arm.carrier.conjugate() * turn * arm.carrier * *rotated).normalize();
        }
    }
}

impl PosedArm {
    /// The arm of a pose, given the indices of its joints from the foot of the spine on.
    fn of(pose: &Pose, joints: [usize; 7], skeleton: &Skeleton) -> Self {
        let posed = pose.chain(skeleton, joints);
        let radius_m = |at: usize| skeleton.segment_radii_m[joints[at]];
        let shoulder = RoundPoint { centre_m: posed[4].0, radius_m: radius_m(3).max(radius_m(4)) };
        let points = [4, 5, 6].map(|at| {
            let (joint_m, orientation) = posed[at];
            let centre_m = joint_m + orientation * skeleton.segment_ends_m[joints[at]];
            RoundPoint { centre_m, radius_m: radius_m(at) }
        });
        Self { spine_m: posed[0].0, shoulder, carrier: posed[3].1, points }
    }

    /// The arm after the trunk has tilted.
    fn tilted(self, tilt: Quat) -> Self {
        let moved =
            |point: RoundPoint| RoundPoint { centre_m: self.spine_m + tilt * (point.centre_m - self.spine_m), ..point };
        Self { shoulder: moved(self.shoulder), carrier: tilt * self.carrier, points: self.points.map(moved), ..self }
    }
}

/// The turn about a joint that brings points within the room, a vector along its horizontal axis, rad.
fn turn_rad<const N: usize>(joint_m: Vec3, points: [RoundPoint; N], room: &ElbowRoom) -> Vec3 {
    let mut turn_rad = Vec3::ZERO;
    let mut yielded_rad = [0.0_f32; SIDES_MAX];
    for index in (0..ROUNDS).flat_map(|_| 0..room.sides().len()) {
        let (side, yielded_rad) = (&room.sides()[index], &mut yielded_rad[index]);
        let (towards, turn) = (side.towards.extend(0.0), rotation(turn_rad));
        let mut greatest_rad = 0.0_f32;
        for RoundPoint { centre_m, radius_m } in points {
            let arm_m = centre_m - joint_m;
            let offset_m = turn * arm_m;
            let yielded_m = yielded_m(side, (joint_m + offset_m).truncate(), radius_m);
            let angle_rad = back_rad(towards.dot(offset_m), offset_m.z, yielded_m);
            // From one side all points turn in one sense, over the joint or under it; a point that another one has
            // brought past the joint does not count.
            let turns_so = angle_rad * *yielded_rad >= 0.0 && offset_m.z * arm_m.z >= 0.0;
            if turns_so && angle_rad.abs() > greatest_rad.abs() {
                greatest_rad = angle_rad;
            }
        }
        *yielded_rad += greatest_rad;
        turn_rad += greatest_rad * towards.cross(Vec3::Z);
    }
    turn_rad
}

/// Distance by which a point with a radius should come in from a side, m.
fn yielded_m(side: &RoomSide, point_m: Vec2, radius_m: f32) -> f32 {
    let over_m = side.towards.dot(point_m) + radius_m - side.distance_m;
    let begun_m = (over_m + SOFT_M).clamp(0.0, 2.0 * SOFT_M);
    begun_m * begun_m / (4.0 * SOFT_M) + (over_m - SOFT_M).max(0.0)
}

/// Angle by which a point turns back over or under a joint so that it comes in by `yielded_m`, rad, given how far out
/// from the joint and how high above it the point is, m. It is negative below the joint.
fn back_rad(out_m: f32, up_m: f32, yielded_m: f32) -> f32 {
    if yielded_m <= 0.0 || out_m <= 0.0 {
        return 0.0;
    }
    let in_m = (out_m - yielded_m).max(0.0);
    let angle_rad = libm::atan2f(out_m, up_m.abs()) - libm::asinf(in_m / Vec2::new(out_m, up_m).length());
    angle_rad.copysign(up_m)
}

#[cfg(test)]
mod tests {
    use motiondb::body::Joints;

    use super::*;
    use crate::test_db::test_db;

    /// The room that ends at a distance to the left, m.
    fn left_m(distance_m: f32) -> ElbowRoom {
        ElbowRoom::ending_at([distance_m * Vec2::Y])
    }

    /// A pose whose arms hang a little out, before and after a second in a room.
    fn brought_in(room: &ElbowRoom) -> [Joints; 2] {
        let (db, step) = (test_db(), TimeStep::new(1.0 / 60.0));
        let mut before = db.rows.pose(2, 10);
        for (arm, sign) in ARMS.into_iter().zip([1.0, -1.0]) {
            before.rotations[arm[4].index()] = Quat::from_rotation_x(-1.2 * sign);
            before.rotations[arm[5].index()] = Quat::IDENTITY;
        }
        let (mut clearance, mut after) = (BodyClearance::default(), before);
        for _ in 0..60 {
            after = before;
            clearance.bring_in(&mut after, room, &db.skeleton, &step);
        }
        [before, after].map(|pose| pose.forward_kinematics(&db.skeleton))
    }

    /// Greatest distance to the left of a point of the left forearm or hand with its radius, m.
    fn reach_m(joints: &Joints) -> f32 {
        let skeleton = test_db().skeleton;
        let reaches_m = ARMS[0][5..].iter().map(|joint| {
            let joint = joint.index();
            let end_m = joints.positions_m[joint] + joints.orientations[joint] * skeleton.segment_ends_m[joint];
            end_m.y + skeleton.segment_radii_m[joint]
        });
        reaches_m.fold(0.0, f32::max)
    }

    #[test]
    fn a_body_yields_gradually_by_the_whole_overlap() {
        let side = left_m(0.3).sides()[0];
        let yielded_m = |over_m: f32| yielded_m(&side, Vec2::new(1.0, 0.25 + over_m), 0.05);
        assert_eq!(yielded_m(-SOFT_M), 0.0);
        assert!([1.0, 2.0].into_iter().all(|over| (yielded_m(over * SOFT_M) - over * SOFT_M).abs() < 1e-6));
        let slopes: Vec<f32> = (-12..24)
            .map(|step| 0.1 * SOFT_M * step as f32)
            .map(|over_m| (yielded_m(over_m + 1e-3) - yielded_m(over_m)) / 1e-3)
            .collect();
        assert!(slopes.is_sorted_by(|a, b| (-1e-3..0.1).contains(&(b - a))), "{slopes:?}");
    }

    #[test]
    fn an_arm_comes_in_and_the_rest_stays() {
        let free_m = reach_m(&brought_in(&ElbowRoom::default())[0]);
        let [before, after] = brought_in(&left_m(free_m - 0.05));
        assert!(reach_m(&after) < free_m - 0.04, "{} of {free_m}", reach_m(&after));
        let others = (0..before.positions_m.len()).filter(|joint| !ARMS[0][4..].contains(&Joint::ALL[*joint]));
        for joint in others {
            let moved_m = before.positions_m[joint].distance(after.positions_m[joint]);
            assert!(moved_m < 1e-5, "{:?}: {moved_m}", Joint::ALL[joint]);
        }
    }

    #[test]
    fn the_trunk_leans_no_farther_than_people_and_the_head_stays_level() {
        let [before, after] = brought_in(&left_m(0.05));
        let [spine, arm, head] = [Joint::SpineLower, Joint::LeftUpperArm, Joint::Head].map(Joint::index);
        let up = |joints: &Joints| joints.orientations[spine];
        let turned_rad = up(&before).angle_between(up(&after));
        assert!((turned_rad - TILT_MAX_RAD).abs() < 1e-3, "{turned_rad}");
        assert!(before.orientations[head].angle_between(after.orientations[head]) < 1e-3);
        let wrist = Joint::LeftHand.index();
        let hangs_m = after.positions_m[wrist].y - after.positions_m[arm].y;
        assert!((-1e-3..0.1).contains(&hangs_m), "no farther than under the shoulder: {hangs_m}");
        let legs = Joint::LeftThigh.index()..;
        assert_eq!(before.positions_m[legs.clone()], after.positions_m[legs]);
    }

    #[test]
    fn a_wide_room_changes_no_bit() {
        let [before, after] = brought_in(&ElbowRoom::default());
        assert_eq!(before, after);
    }

    #[test]
    fn a_body_that_was_brought_in_returns() {
        let (db, step) = (test_db(), TimeStep::new(1.0 / 60.0));
        let (before, mut clearance) = (db.rows.pose(2, 10), BodyClearance::default());
        clearance.bring_in(&mut before.clone(), &left_m(0.1), &db.skeleton, &step);
        assert_ne!(clearance, BodyClearance::default());
        (0..60).for_each(|_| clearance.bring_in(&mut before.clone(), &ElbowRoom::default(), &db.skeleton, &step));
        assert_eq!(clearance, BodyClearance::default());
    }
}
