//! The room that a character's trunk takes: arms that hang beside the skeleton's trunk would pass through a wider one.
//!
//! The trunk between shoulders and hanging hands is an elliptic cylinder about the pelvis. An arm whose hand is inside it
//! is turned outward at the shoulder, about the trunk's forward axis. Bind space, metres.

use glam::{Quat, Vec2, Vec3};

use crate::body::{Joint, Side};
use crate::character::model::Character;

/// Roles that move the trunk.
const TRUNK: [Joint; 4] = [Joint::Pelvis, Joint::SpineLower, Joint::SpineMiddle, Joint::SpineUpper];
/// Shares of an arm's length below the shoulders between which the trunk is measured.
const HEIGHTS: [f32; 2] = [0.3, 1.1];
/// Share of the depth ahead and behind within which the breadth is measured.
const MIDDLE: f32 = 0.5;
/// Middle of a hand beyond the wrist, of the forearm's length.
const HAND: f32 = 0.35;
/// Height of a shoulder above a point of its arm from which on the arm begins to hang, of the arm's length; it hangs from
/// twice as much on.
const HANGING: f32 = 0.2;
/// Square of the distance from the ellipse's front or back, of its depth, from which on arms turn fully.
const EDGE: f32 = 0.25;
/// Greatest angle by which an arm is turned, rad.
const TURN_MAX_RAD: f32 = 1.0;

/// The ellipse that keeps the middle lines of arms outside the trunk.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TrunkRoom {
    /// Half axes behind and ahead of the pelvis.
    depths_m: [f32; 2],
    /// Half axis to each side.
    breadth_m: f32,
    /// Position of the pelvis along the body.
    middle_m: f32,
    /// Length of an arm from shoulder to wrist.
    arm_m: f32,
}

impl TrunkRoom {
    /// The room of a character whose joints move with `leaders`; none where no mesh shows a trunk.
    pub(crate) fn of(character: &Character, leaders: &[Joint]) -> Self {
        let at_m = |role: Joint| character.role_position_m(role).unwrap_or_default();
        let [shoulder_m, elbow_m, wrist_m] = [Joint::LeftUpperArm, Joint::LeftForearm, Joint::LeftHand].map(at_m);
        let arm_m = shoulder_m.distance(elbow_m) + elbow_m.distance(wrist_m);
        let middle_m = at_m(Joint::Pelvis).x;
        let mesh = &character.mesh;
        let is_between = |point_m: &Vec3| (HEIGHTS[0]..HEIGHTS[1]).contains(&((shoulder_m.z - point_m.z) / arm_m));
        let trunk_m: Vec<Vec2> = (0..mesh.positions_m.len())
            .filter(|vertex| TRUNK.contains(&leaders[usize::from(mesh.joints[*vertex][0])]))
            .map(|vertex| mesh.positions_m[vertex])
            .filter(is_between)
            .map(|point_m| Vec2::new(point_m.x - middle_m, point_m.y))
            .collect();
        let depths_m = [-1.0, 1.0].map(|sign| trunk_m.iter().map(|point_m| sign * point_m.x).fold(0.0, f32::max));
        let is_in_middle = |point_m: &&Vec2| point_m.x > -MIDDLE * depths_m[0] && point_m.x < MIDDLE * depths_m[1];
        let breadth_m = trunk_m.iter().filter(is_in_middle).map(|point_m| point_m.y.abs()).fold(0.0, f32::max);
        let radius_m = character.segment_radii_m[Joint::LeftForearm.index()];
        let with_arm = |half_m: f32| if half_m > 0.0 { half_m + radius_m } else { 0.0 };
        Self { depths_m: depths_m.map(with_arm), breadth_m: with_arm(breadth_m), middle_m, arm_m }
    }

    /// The angle by which an arm is to turn outward, rad: `arm_m` are its shoulder, elbow and wrist, with y to its own side.
    pub(crate) fn turn_rad(&self, [shoulder_m, elbow_m, wrist_m]: [Vec3; 3]) -> f32 {
        let hand_m = wrist_m + HAND * (wrist_m - elbow_m);
        let (drop_m, ahead_m) = (shoulder_m.z - hand_m.z, hand_m.x - self.middle_m);
        let share = ahead_m / self.depths_m[usize::from(ahead_m > 0.0)];
        let inside = (1.0 - share * share).max(0.0);
        let outside_m = self.breadth_m * inside.sqrt();
        // Arms that are raised, or cross before the trunk, turn less.
        let turned = (drop_m / (HANGING * self.arm_m) - 1.0).min(inside / EDGE).clamp(0.0, 1.0);
        let radius_m = Vec2::new(drop_m, hand_m.y - shoulder_m.y).length().max(1e-6);
        let angle_rad = |aside_m: f32| libm::asinf(((aside_m - shoulder_m.y) / radius_m).clamp(-1.0, 1.0));
        turned * (angle_rad(outside_m) - angle_rad(hand_m.y)).clamp(0.0, TURN_MAX_RAD)
    }
}

/// The rotation that turns the arm of a side outward about an axis that points forward.
pub(crate) fn outward(forward: Vec3, turn_rad: f32, side: usize) -> Quat {
    Quat::from_axis_angle(forward, Side::BOTH[side].sign() * turn_rad)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: TrunkRoom = TrunkRoom { depths_m: [0.2, 0.2], breadth_m: 0.4, middle_m: 0.0, arm_m: 0.6 };

    /// An arm from a shoulder 0.2 m aside and 1.2 m high, whose hand is 0.6 m below and as far ahead and aside.
    fn arm_m(ahead_m: f32, aside_m: f32) -> [Vec3; 3] {
        let shoulder_m = Vec3::new(0.0, 0.2, 1.2);
        let hand_m = shoulder_m + Vec3::new(ahead_m, aside_m, -0.6);
        let wrist_m = shoulder_m.lerp(hand_m, 1.0 / (1.0 + 0.5 * HAND));
        [shoulder_m, shoulder_m.midpoint(wrist_m), wrist_m]
    }

    #[test]
    fn an_arm_in_the_trunk_turns_to_its_side() {
        let turn_rad = ROOM.turn_rad(arm_m(0.0, 0.0));
        let [shoulder_m, elbow_m, wrist_m] = arm_m(0.0, 0.0);
        let turned = |point_m: Vec3| shoulder_m + outward(Vec3::X, turn_rad, 0) * (point_m - shoulder_m);
        let again_rad = ROOM.turn_rad([shoulder_m, turned(elbow_m), turned(wrist_m)]);
        assert!(turn_rad > 0.3 && again_rad < 0.05, "{turn_rad}, {again_rad}");
        assert_eq!(outward(Vec3::X, 0.3, 1), outward(Vec3::X, -0.3, 0));
    }

    #[test]
    fn an_arm_outside_the_trunk_stays() {
        assert_eq!(ROOM.turn_rad(arm_m(0.0, 0.5)), 0.0);
        // Before it, and raised.
        let [shoulder_m, _, wrist_m] = arm_m(0.5, 0.0);
        assert_eq!(ROOM.turn_rad([shoulder_m, wrist_m, wrist_m]), 0.0);
        let raised_m = [Vec3::new(0.0, 0.2, 1.2), Vec3::new(0.0, 0.3, 1.3), Vec3::new(0.0, 0.3, 1.5)];
        assert_eq!(ROOM.turn_rad(raised_m), 0.0);
        assert_eq!(TrunkRoom::default().turn_rad(arm_m(0.0, -0.5)), 0.0);
    }

    #[test]
    fn the_turn_has_no_jump() {
        let turns: Vec<f32> = (0..200_u16).map(|at| ROOM.turn_rad(arm_m(0.005 * f32::from(at) - 0.5, -0.1))).collect();
        assert!(turns.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.06), "{turns:?}");
    }
}
