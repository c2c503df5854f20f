//! What posing needs of a mesh: where the soles are, how high the hips stand over them, and how thick the limbs are.
//!
//! Body axes, metres; heights are relative to the origin of the bind space.

use glam::DVec3;
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::character::CharacterFoot;

use crate::character::body_mesh::BodyMesh;
use crate::character::joint_roles::SlotMap;

/// Distance of the ball from the ankle where there is no toe joint, divided by that of the toe tip.
const BALL_SHARE: f64 = 0.65;
/// Least share of a foot's weights that its toe joint has; a joint with less only marks the tip.
const TOE_WEIGHT_MIN: f64 = 0.02;
/// Least distance of the toe joint from the ankle, divided by that of the toe tip.
const TOE_AHEAD_MIN: f64 = 0.1;
/// Length of a foot without vertices, divided by the leg's.
const FOOT_LENGTH: f64 = 0.2;
/// Share of a segment's vertices that lie within its radius.
const RADIUS_SHARE: f64 = 0.5;

/// A mesh on its joints.
pub(crate) struct MeshOnJoints<'a> {
    pub mesh: &'a BodyMesh,
    /// Position of each slot's node.
    pub positions_m: &'a [DVec3],
    /// Role that each slot moves with.
    pub leaders: &'a [Option<Joint>],
}

impl MeshOnJoints<'_> {
    /// Position of a role's joint.
    fn role_m(&self, slots: &SlotMap, role: Joint) -> Option<DVec3> {
        slots[role.index()].map(|slot| self.positions_m[slot])
    }

    /// The role that moves a vertex most.
    fn role_of(&self, vertex: usize) -> Joint {
        self.leaders[self.mesh.weights[vertex][0].0].unwrap_or(Joint::Pelvis)
    }

    /// Removes toe roles from joints that move no part of the foot, or lie under the ankle.
    pub(crate) fn remove_idle_toes(&self, slots: &mut SlotMap) {
        let mut is_used = [0, 1].map(|side| {
            let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
            let (mut of_foot, mut of_toe) = (0.0, 0.0);
            for &(slot, weight) in self.mesh.weights.as_flattened() {
                match self.leaders[slot] {
                    Some(role) if role == foot => of_foot += f64::from(weight),
                    Some(role) if role == toe => of_toe += f64::from(weight),
                    _ => (),
                }
            }
            of_toe > TOE_WEIGHT_MIN * (of_foot + of_toe)
        });
        for (side, is_used) in is_used.iter_mut().enumerate() {
            let (Some(ankle_m), Some(toe_m)) =
                (self.role_m(slots, Joint::FEET[side]), self.role_m(slots, Joint::TOES[side]))
            else {
                continue;
            };
            let tip_m = self.foot_vertices(side).map(|point_m| (point_m - ankle_m).x).fold(0.0, f64::max);
            *is_used &= (toe_m - ankle_m).with_z(0.0).length() > TOE_AHEAD_MIN * tip_m;
        }
        // Both feet roll alike.
        if is_used != [true; 2] {
            Joint::TOES.into_iter().for_each(|toe| slots[toe.index()] = None);
        }
    }

    /// Positions of the vertices that foot and toes of a side move.
    fn foot_vertices(&self, side: usize) -> impl Iterator<Item = DVec3> + '_ {
        let of_foot = [Joint::FEET[side], Joint::TOES[side]];
        let positions_m = self.mesh.positions_m.iter().enumerate();
        positions_m
            .filter(move |(vertex, _)| of_foot.contains(&self.role_of(*vertex)))
            .map(|(_, position_m)| *position_m)
    }

    /// The soles of both feet.
    pub(crate) fn feet(&self, slots: &SlotMap) -> [[DVec3; 3]; 2] {
        [0, 1].map(|side| self.foot(slots, side))
    }

    /// Heel, ball and toe tip on the line through the ankle along the foot, at the height of the sole.
    fn foot(&self, slots: &SlotMap, side: usize) -> [DVec3; 3] {
        let role_m = |role| self.role_m(slots, role);
        let [hip_m, ankle_m] = [Joint::THIGHS[side], Joint::FEET[side]].map(|role| role_m(role).unwrap_or_default());
        let leg_m = hip_m.distance(ankle_m);
        let to_toe_m = role_m(Joint::TOES[side]).map(|toe_m| (toe_m - ankle_m).with_z(0.0));
        let direction = to_toe_m.and_then(DVec3::try_normalize).unwrap_or_else(|| self.foot_direction(side, ankle_m));
        let along = |point_m: DVec3| (point_m - ankle_m).dot(direction);
        let (mut rear_m, mut front_m, mut sole_m) = (f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY);
        for point_m in self.foot_vertices(side) {
            rear_m = rear_m.min(along(point_m));
            front_m = front_m.max(along(point_m));
            sole_m = sole_m.min(point_m.z);
        }
        if rear_m >= front_m {
            // The legs end in a robe, or at the ankles.
            (rear_m, front_m) = (-0.25 * FOOT_LENGTH * leg_m, 0.75 * FOOT_LENGTH * leg_m);
            sole_m = self.mesh.positions_m.iter().map(|point_m| point_m.z).fold(ankle_m.z, f64::min);
        }
        let front_m = front_m.max(0.01 * leg_m);
        let ball_m = to_toe_m.map_or(BALL_SHARE * front_m, |to_toe_m| to_toe_m.length().min(front_m));
        [rear_m.min(0.0), ball_m, front_m].map(|along_m| (ankle_m + along_m * direction).with_z(sole_m))
    }

    /// Direction of a foot without toe joint: from the ankle to the middle of its front half; forward where it has none.
    fn foot_direction(&self, side: usize, ankle_m: DVec3) -> DVec3 {
        let front_m = self.foot_vertices(side).map(|point_m| point_m - ankle_m).filter(|point_m| point_m.x > 0.0);
        let sum_m = front_m.fold(DVec3::ZERO, |sum_m, point_m| sum_m + point_m.x * point_m.with_z(0.0));
        sum_m.try_normalize().unwrap_or(DVec3::X)
    }

    /// Height of the hip joints over the soles.
    pub(crate) fn hips_over_soles_m(&self, slots: &SlotMap, sole_m: f64) -> f64 {
        let heights = Joint::THIGHS.map(|thigh| self.role_m(slots, thigh).unwrap_or_default().z - sole_m);
        0.5 * (heights[0] + heights[1])
    }

    /// Thigh plus shank, mean of both sides.
    pub(crate) fn leg_length_m(&self, slots: &SlotMap) -> f64 {
        let leg_m = |side: usize| {
            let [hip_m, knee_m, ankle_m] = [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]]
                .map(|role| self.role_m(slots, role).unwrap_or_default());
            hip_m.distance(knee_m) + knee_m.distance(ankle_m)
        };
        0.5 * (leg_m(0) + leg_m(1))
    }

    /// Radius of each role's segment: the median distance of its vertices from the line to the next joint.
    pub(crate) fn segment_radii_m(&self, slots: &SlotMap) -> [f64; JOINT_COUNT] {
        let mut distances_m: [Vec<f64>; JOINT_COUNT] = std::array::from_fn(|_| Vec::new());
        let ends_m = Joint::ALL.map(|role| self.segment_end_m(slots, role));
        for (vertex, point_m) in self.mesh.positions_m.iter().enumerate() {
            let role = self.role_of(vertex);
            if let Some(start_m) = self.role_m(slots, role) {
                distances_m[role.index()].push(distance_m(*point_m, start_m, ends_m[role.index()]));
            }
        }
        distances_m.map(|mut distances_m| {
            distances_m.sort_by(f64::total_cmp);
            distances_m.get((RADIUS_SHARE * distances_m.len() as f64) as usize).copied().unwrap_or(0.0)
        })
    }

    /// The nearest joint of a role below; of a last one the middle of its vertices.
    fn segment_end_m(&self, slots: &SlotMap, role: Joint) -> DVec3 {
        let below = Joint::ALL.into_iter().filter(|below| below.parent() == Some(role));
        if let Some(end_m) = below.filter_map(|below| self.role_m(slots, below)).next() {
            return end_m;
        }
        let own = (0..self.mesh.positions_m.len()).filter(|&vertex| self.role_of(vertex) == role);
        let (sum_m, count) =
            own.fold((DVec3::ZERO, 0), |(sum_m, count), vertex| (sum_m + self.mesh.positions_m[vertex], count + 1));
        sum_m / f64::from(count.max(1))
    }

    /// Radius of the disc around trunk and arms: half the distance of the shoulders, plus an upper arm's radius.
    pub(crate) fn radius_m(&self, slots: &SlotMap, radii_m: &[f64; JOINT_COUNT]) -> f64 {
        let [left_m, right_m] = Joint::UPPER_ARMS.map(|arm| self.role_m(slots, arm).unwrap_or_default());
        0.5 * (left_m - right_m).with_z(0.0).length() + radii_m[Joint::LeftUpperArm.index()]
    }
}

/// Distance of a point from a segment.
fn distance_m(point_m: DVec3, start_m: DVec3, end_m: DVec3) -> f64 {
    let segment_m = end_m - start_m;
    let share = (point_m - start_m).dot(segment_m) / segment_m.length_squared().max(1e-24);
    point_m.distance(start_m + share.clamp(0.0, 1.0) * segment_m)
}

/// Points of a foot, moved by `origin_m`, as a character holds them.
pub(crate) fn foot([heel_m, ball_m, toe_tip_m]: [DVec3; 3], origin_m: DVec3) -> CharacterFoot {
    let moved = |point_m: DVec3| (point_m - origin_m).as_vec3();
    CharacterFoot { heel_m: moved(heel_m), ball_m: moved(ball_m), toe_tip_m: moved(toe_tip_m) }
}
