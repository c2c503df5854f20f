//! A posed body and its forward kinematics.
//!
//! Two frames: the *root frame* sits on the ground under the ripple-free root trajectory, x along the facing; the
//! *world* is where roots move. A pose is relative to its root; all that is left of the pelvis's path (sway, surge,
//! bob, yaw) is in the pose.

use glam::{Quat, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use crate::body::skeleton::{JOINT_COUNT, Joint, Skeleton};

/// Where a body stands: its disc's centre and its facing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Root {
    /// On the ground, world, metres.
    pub position_m: Vec2,
    /// Counter-clockwise from world x, radians.
    pub facing_rad: f32,
}

impl Root {
    /// Unit vector along the facing.
    pub fn forward(&self) -> Vec2 {
        let (sin, cos) = libm::sincosf(self.facing_rad);
        Vec2::new(cos, sin)
    }

    /// Its frame, for many points.
    pub fn frame(&self) -> RootFrame {
        RootFrame { position_m: self.position_m, forward: self.forward() }
    }

    /// A point of the root frame in the world.
    pub fn to_world(&self, point_m: Vec3) -> Vec3 {
        self.frame().to_world(point_m)
    }
}

/// The root frame in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootFrame {
    /// Its origin on the ground, world, metres.
    pub position_m: Vec2,
    /// Its x axis, a unit vector.
    pub forward: Vec2,
}

impl RootFrame {
    /// A point of the root frame in the world.
    pub fn to_world(&self, point_m: Vec3) -> Vec3 {
        let ground_m = self.position_m + self.forward.rotate(point_m.truncate());
        ground_m.extend(point_m.z)
    }

    /// A point of the world in the root frame.
    pub fn to_local(&self, point_m: Vec3) -> Vec3 {
        let back = Vec2::new(self.forward.x, -self.forward.y);
        back.rotate(point_m.truncate() - self.position_m).extend(point_m.z)
    }
}

/// A pose in its root's frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// The pelvis joint in the root frame: forward, left, height over the ground, metres.
    pub pelvis_m: Vec3,
    /// Rotation of each joint against its parent's; the pelvis's against the root frame, so it carries the pelvis's
    /// yaw.
    pub rotations: [Quat; JOINT_COUNT],
}

/// Position and orientation of every joint in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joints {
    /// Metres.
    pub positions_m: [Vec3; JOINT_COUNT],
    /// Against the rest pose.
    pub orientations: [Quat; JOINT_COUNT],
}

impl Pose {
    /// Every joint in the root frame.
    pub fn forward_kinematics(&self, skeleton: &Skeleton) -> Joints {
        let mut joints = Joints { positions_m: [self.pelvis_m; JOINT_COUNT], orientations: self.rotations };
        for joint in &Joint::ALL[1..] {
            let index = joint.index();
            let Some(parent) = joint.parent().map(Joint::index) else { continue };
            let posed_parent = (joints.positions_m[parent], joints.orientations[parent]);
            (joints.positions_m[index], joints.orientations[index]) = self.posed_child(skeleton, index, posed_parent);
        }
        joints
    }

    /// Positions (m) and orientations, in the root frame, of the joints of one chain: the first is a child of the
    /// pelvis, each other one a child of the joint before it. `chain` holds indices.
    pub fn chain<const N: usize>(&self, skeleton: &Skeleton, chain: [usize; N]) -> [(Vec3, Quat); N] {
        let mut posed = (self.pelvis_m, self.rotations[Joint::Pelvis.index()]);
        chain.map(|index| {
            posed = self.posed_child(skeleton, index, posed);
            posed
        })
    }

    #[inline]
    fn posed_child(&self, skeleton: &Skeleton, index: usize, (parent_m, parent): (Vec3, Quat)) -> (Vec3, Quat) {
        (parent_m + parent * skeleton.offsets_m[index], parent * self.rotations[index])
    }

    /// How far a knee is flexed, the twist of its shank about its left axis: negative where it is hyperextended, rad.
    pub fn knee_flexion_rad(&self, side: usize) -> f32 {
        let shank = self.rotations[Joint::SHANKS[side].index()];
        let shank = if shank.w < 0.0 { -shank } else { shank };
        2.0 * libm::atan2f(shank.y, shank.w)
    }
}

impl Joints {
    /// A point given relative to a joint, in the frame of the joints.
    pub fn point_m(&self, joint: Joint, offset_m: Vec3) -> Vec3 {
        self.positions_m[joint.index()] + self.orientations[joint.index()] * offset_m
    }

    /// Heel, ball and toe tip on the sole of one foot.
    pub fn sole_points_m(&self, skeleton: &Skeleton, side: usize) -> [Vec3; 3] {
        let foot = &skeleton.feet[side];
        self.foot_points_m(side, [foot.heel_m, foot.ball_m, foot.toe_tip_m])
    }

    /// The points of one foot at which its slide is measured.
    pub fn measured_points_m(&self, skeleton: &Skeleton, side: usize) -> [Vec3; 3] {
        self.foot_points_m(side, skeleton.feet[side].measured_m)
    }

    fn foot_points_m(&self, side: usize, [heel_m, ball_m, toe_tip_m]: [Vec3; 3]) -> [Vec3; 3] {
        let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
        [self.point_m(foot, heel_m), self.point_m(foot, ball_m), self.point_m(toe, toe_tip_m)]
    }
}
