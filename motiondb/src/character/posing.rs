//! The pose of a canonical body → the transforms of a character's joints.
//!
//! 1. The orientation of each role is the canonical one times the fit's constant rotation.
//! 2. The middle of the hips lies where the canonical body's does; other positions follow along *anatomical* parents,
//!    not the file's: thighs may hang from a root beside the hips, feet from a control bone. Arms turn outward where
//!    they would pass through a trunk that is wider than the skeleton's.
//! 3. A leg's inverse kinematics puts the ball of the foot on the sole where the canonical body's is. A foot without
//!    toes turns about its tip instead while the heel rises, by a smaller angle, so that the ankle rises as high. A foot
//!    whose ball is above its heel turns about the heel.
//! 4. Each foot is raised or lowered so that the lowest point of its sole is as high as that of the canonical foot.
//!    A shift along and across the planted foot, whose axes rest meanwhile, keeps the ankle of a flat foot under the
//!    knee although the foot's length is the character's own, and the feet as far apart as its hips.
//! 5. The hips sink where a planted leg would not reach the ground.
//!
//! Joints without a role keep their bind place under the role above them; `extra_posing` turns fingers, toes and twist bones.
//! Root frame, metres, until the last step.

use glam::{Quat, Vec3};

use crate::body::two_bone_reach::{EXTENSION_MAX, TwoBones, reach};
use crate::body::{JOINT_COUNT, Joint, Joints, RootFrame, Side, Skeleton};
use crate::character::fit::CharacterFit;
use crate::character::model::CharacterFoot;
use crate::character::trunk_room::outward;

/// Height of a foot's lowest point above the ground at which the hips do not sink for it any more, m.
const LIFTED_M: f32 = 0.05;
/// Height of a foot's ball above its heel from which it stands on the heel alone, m: the length of a character's foot is
/// its own, so it can hold only one of both points where the body's is.
const ON_HEEL_M: f32 = 0.02;
/// Greatest distance by which the hips sink, divided by their height.
const SINK_MAX: f32 = 0.1;

/// Rotation, scale and translation from bind space to the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointTransform {
    /// Rotation.
    pub rotation: Quat,
    /// Factor of lengths.
    pub scale: f32,
    /// Translation, m.
    pub translation_m: Vec3,
}

impl JointTransform {
    /// A point of bind space in the world, m.
    pub fn point_m(&self, bind_m: Vec3) -> Vec3 {
        self.translation_m + self.rotation * (self.scale * bind_m)
    }
}

/// Positions and rotations from bind of all roles, root frame, m. Roles without a joint are left as they are.
struct PosedRoles {
    positions_m: [Vec3; JOINT_COUNT],
    rotations: [Quat; JOINT_COUNT],
}

/// Where the foot of a leg is to stand.
struct FootTarget {
    ankle_m: Vec3,
    /// Distance from hip to ankle that the leg can have at most, m.
    reach_m: f32,
    /// Share of the foot's stand on the ground: 1 on it, 0 from [`LIFTED_M`] on.
    planted: f32,
}

impl CharacterFit<'_> {
    /// Transforms of all joints, from bind space to the world; `joints` are those of the canonical body in its root
    /// frame, `frame` is the root's.
    pub fn pose(&self, skeleton: &Skeleton, joints: &Joints, frame: RootFrame, transforms: &mut Vec<JointTransform>) {
        let mut posed = self.oriented(joints);
        self.place(&mut posed, joints);
        self.clear_trunk(&mut posed);
        let targets = [0, 1].map(|side| self.foot_target(&posed, skeleton, joints, side));
        self.sink(&mut posed, &targets);
        for (side, target) in targets.iter().enumerate() {
            self.reach(&mut posed, side, target.ankle_m);
        }
        let facing = facing(frame);
        let of_role = Joint::ALL.map(|role| self.transform(&posed, role, facing, frame));
        transforms.clear();
        transforms.extend(self.leaders.iter().map(|leader| of_role[leader.index()]));
    }

    /// Step 1.
    fn oriented(&self, joints: &Joints) -> PosedRoles {
        let mut rotations = joints.orientations;
        for (rotation, turn) in rotations.iter_mut().zip(&self.turns) {
            *rotation *= *turn;
        }
        for side in 0..2 {
            if !self.character.has_toe(side) {
                rotations[Joint::FEET[side].index()] = self.stiff_foot(joints, side);
            }
        }
        PosedRoles { positions_m: [Vec3::ZERO; JOINT_COUNT], rotations }
    }

    /// Orientation of a foot without toes: it bends as far from the canonical toes as raises its ankle as high.
    fn stiff_foot(&self, joints: &Joints, side: usize) -> Quat {
        let [foot, toe] = [Joint::FEET[side], Joint::TOES[side]].map(|joint| joints.orientations[joint.index()]);
        let CharacterFoot { ball_m, toe_tip_m, .. } = self.character.feet[side];
        let ankle_m = self.bind_m(Joint::FEET[side]);
        let [to_ball_m, to_tip_m] = [ball_m, toe_tip_m].map(|point_m| (point_m - ankle_m).with_z(0.0).length());
        let share = if to_tip_m > 0.0 { (to_ball_m / to_tip_m).min(1.0) } else { 1.0 };
        let bend = toe.conjugate() * foot;
        let bend = if bend.w < 0.0 { -bend } else { bend };
        toe * Quat::IDENTITY.lerp(bend, share) * self.turns[Joint::FEET[side].index()]
    }

    /// Step 2.
    fn place(&self, posed: &mut PosedRoles, joints: &Joints) {
        let pelvis = Joint::Pelvis.index();
        let hips_m = Joint::THIGHS.map(|thigh| joints.positions_m[thigh.index()]);
        let own_hips_m = Joint::THIGHS.map(|thigh| self.bind_m(thigh));
        let from_pelvis_m = 0.5 * (own_hips_m[0] + own_hips_m[1]) - self.bind_m(Joint::Pelvis);
        posed.positions_m[pelvis] =
            0.5 * (hips_m[0] + hips_m[1]) - posed.rotations[pelvis] * (self.scale * from_pelvis_m);
        Joint::ALL[1..].iter().for_each(|role| self.place_below_its_parent(posed, *role));
    }

    fn place_below_its_parent(&self, posed: &mut PosedRoles, role: Joint) {
        if let (Some(_), Some(above)) = (self.character.joint(role), self.character.role_above(role)) {
            let bone_m = self.scale * (self.bind_m(role) - self.bind_m(above));
            posed.positions_m[role.index()] =
                posed.positions_m[above.index()] + posed.rotations[above.index()] * bone_m;
        }
    }

    /// Step 2, of the arms.
    fn clear_trunk(&self, posed: &mut PosedRoles) {
        let pelvis = Joint::Pelvis.index();
        let (upright, middle_m) = (posed.rotations[pelvis], posed.positions_m[pelvis]);
        let to_bind =
            |position_m: Vec3| upright.conjugate() * (position_m - middle_m) / self.scale + self.bind_m(Joint::Pelvis);
        for (side, first) in Joint::UPPER_ARMS.into_iter().enumerate() {
            let arm = [0, 1, 2].map(|bone| Joint::ALL[first.index() + bone]);
            let to_side = Vec3::new(1.0, Side::BOTH[side].sign(), 1.0);
            let arm_m = arm.map(|role| to_side * to_bind(posed.positions_m[role.index()]));
            let turn_rad = self.trunk_room.turn_rad(arm_m);
            if turn_rad > 0.0 {
                let turn = outward(upright * Vec3::X, turn_rad, side);
                arm.into_iter().for_each(|role| {
                    posed.rotations[role.index()] = turn * posed.rotations[role.index()];
                });
                arm[1..].iter().for_each(|role| self.place_below_its_parent(posed, *role));
            }
        }
    }

    /// Steps 3 and 4: where the ankle is to be.
    fn foot_target(&self, posed: &PosedRoles, skeleton: &Skeleton, joints: &Joints, side: usize) -> FootTarget {
        let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
        let CharacterFoot { heel_m, ball_m, toe_tip_m } = self.character.feet[side];
        let ankle_m = self.bind_m(foot);
        let turned = |rotation: Quat, from_m: Vec3, to_m: Vec3| rotation * (self.scale * (to_m - from_m));
        let rotation = posed.rotations[foot.index()];
        let toe_rotation = joints.orientations[toe.index()] * self.turns[foot.index()];
        let soles_m = joints.sole_points_m(skeleton, side);
        let on_ball_m = if self.character.has_toe(side) {
            soles_m[1] - turned(rotation, ankle_m, ball_m)
        } else {
            soles_m[1] + turned(toe_rotation, ball_m, toe_tip_m) - turned(rotation, ankle_m, toe_tip_m)
        };
        let tip_m = match self.character.role_position_m(toe) {
            Some(toe_m) => turned(rotation, ankle_m, toe_m) + turned(toe_rotation, toe_m, toe_tip_m),
            None => turned(rotation, ankle_m, toe_tip_m),
        };
        let own_m = [turned(rotation, ankle_m, heel_m), turned(rotation, ankle_m, ball_m), tip_m];
        let [heel_shift_m, ball_shift_m] = self.stance_shifts_m(skeleton, joints.orientations[toe.index()], side);
        let on_heel_m = soles_m[0] - own_m[0] + heel_shift_m;
        let on_heel = ((soles_m[1].z - soles_m[0].z) / ON_HEEL_M).clamp(0.0, 1.0);
        let mut target_m = (on_ball_m + ball_shift_m).lerp(on_heel_m, on_heel);
        let lowest_m = own_m
            .map(|point_m| point_m.z)
            .into_iter()
            .chain(self.outline_heights_m(rotation, toe_rotation, side))
            .fold(f32::INFINITY, f32::min);
        let height_m = soles_m.map(|point_m| point_m.z).into_iter().fold(f32::INFINITY, f32::min);
        target_m.z = height_m - lowest_m;
        FootTarget {
            ankle_m: target_m,
            reach_m: EXTENSION_MAX * self.leg_lengths_m(side).into_iter().sum::<f32>(),
            planted: (1.0 - height_m / LIFTED_M).clamp(0.0, 1.0),
        }
    }

    /// Heights of the outline of a sole above the ankle of a foot and toes with rotations from bind, m.
    fn outline_heights_m(&self, foot: Quat, toe: Quat, side: usize) -> impl Iterator<Item = f32> {
        let ankle_m = self.bind_m(Joint::FEET[side]);
        let toe_m = self.character.role_position_m(Joint::TOES[side]).unwrap_or(ankle_m);
        let above_m = move |rotation: Quat, from_m: Vec3, to_m: Vec3| (rotation * (self.scale * (to_m - from_m))).z;
        let [of_foot_m, of_toe_m] = &self.soles_m[side];
        let on_foot = of_foot_m.iter().map(move |point_m| above_m(foot, ankle_m, *point_m));
        let on_toe = of_toe_m.iter().map(move |point_m| above_m(foot, ankle_m, toe_m) + above_m(toe, toe_m, *point_m));
        on_foot.chain(on_toe)
    }

    /// Displacements of a foot's heel and ball from the canonical ones along and across its planted direction, m: so that
    /// the ankles of flat feet agree along it, and the feet stand as far apart as the hips.
    fn stance_shifts_m(&self, skeleton: &Skeleton, toe: Quat, side: usize) -> [Vec3; 2] {
        let CharacterFoot { heel_m, ball_m, .. } = self.character.feet[side];
        let flat = |point_m: Vec3| (point_m - self.bind_m(Joint::FEET[side])).with_z(0.0);
        let [own_heel_m, own_ball_m] = [heel_m, ball_m].map(flat);
        let canonical = &skeleton.feet[side];
        let to_ball_m = canonical.ball_m.with_z(0.0);
        // Along the foot; heels lie behind the ankle.
        let own_behind_m = own_heel_m.dot(own_ball_m.normalize_or_zero());
        let behind_m = canonical.heel_m.dot(to_ball_m.normalize_or_zero());
        let ahead = (toe * to_ball_m).with_z(0.0).normalize_or_zero();
        let left = (toe * Vec3::Y).with_z(0.0).normalize_or_zero();
        let farther_m = [self.scale * own_behind_m - behind_m, self.scale * own_ball_m.length() - to_ball_m.length()];
        farther_m.map(|farther_m| farther_m * ahead + self.wider_m[side] * left)
    }

    /// Step 5.
    fn sink(&self, posed: &mut PosedRoles, targets: &[FootTarget; 2]) {
        let mut sink_m = 0.0_f32;
        for (target, thigh) in targets.iter().zip(Joint::THIGHS) {
            let to_hip_m = posed.positions_m[thigh.index()] - target.ankle_m;
            let height_m =
                libm::sqrtf((target.reach_m * target.reach_m - to_hip_m.truncate().length_squared()).max(0.0));
            sink_m = sink_m.max(target.planted * (to_hip_m.z - height_m));
        }
        let sink_m = sink_m.min(SINK_MAX * self.hips_over_soles_m);
        posed.positions_m.iter_mut().for_each(|position_m| position_m.z -= sink_m);
    }

    fn reach(&self, posed: &mut PosedRoles, side: usize, ankle_m: Vec3) {
        let roles = [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]].map(Joint::index);
        let [thigh, shank, _] = roles;
        let leg = TwoBones {
            positions_m: roles.map(|role| posed.positions_m[role]),
            // Knees bend forward of the body: the constant rotation is no part of that.
            orientations: [thigh, shank].map(|role| posed.rotations[role] * self.turns[role].conjugate()),
            lengths_m: self.leg_lengths_m(side),
        };
        let reached = reach(&leg, ankle_m);
        for (role, orientation) in [thigh, shank].into_iter().zip(reached) {
            posed.rotations[role] = orientation * self.turns[role];
        }
        let below = [Joint::SHANKS[side], Joint::FEET[side], Joint::TOES[side]];
        below.into_iter().for_each(|role| self.place_below_its_parent(posed, role));
    }

    /// Lengths of thigh and shank, scaled, m.
    fn leg_lengths_m(&self, side: usize) -> [f32; 2] {
        let [hip_m, knee_m, ankle_m] =
            [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]].map(|role| self.bind_m(role));
        [hip_m.distance(knee_m), knee_m.distance(ankle_m)].map(|length_m| self.scale * length_m)
    }

    /// Position of a role's joint in bind space, m.
    fn bind_m(&self, role: Joint) -> Vec3 {
        self.character.role_position_m(role).unwrap_or_default()
    }

    fn transform(&self, posed: &PosedRoles, role: Joint, facing: Quat, frame: RootFrame) -> JointTransform {
        let rotation = (facing * posed.rotations[role.index()]).normalize();
        let position_m = frame.to_world(posed.positions_m[role.index()]);
        let translation_m = position_m - rotation * (self.scale * self.bind_m(role));
        JointTransform { rotation, scale: self.scale, translation_m }
    }
}

/// Rotation of a root frame about the vertical.
fn facing(frame: RootFrame) -> Quat {
    Quat::from_rotation_z(libm::atan2f(frame.forward.y, frame.forward.x))
}
