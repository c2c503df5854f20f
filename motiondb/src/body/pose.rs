//! Poses and their forward kinematics.
//!
//! Two frames. The *root frame* sits on the ground under the ripple-free root trajectory, x along the facing, y to the
//! left, z up. The *world* is where roots move. A pose is relative to its root frame: the rest of the pelvis's motion
//! (sway, surge, bob, yaw) is part of the pose. Metres, radians.

use glam::{Quat, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use crate::body::skeleton::{JOINT_COUNT, Joint, Skeleton};

/// Position and facing of a body: the centre of its disc on the ground, and the direction in which it looks.
///
/// ```
/// use glam::{Vec2, Vec3};
/// use motiondb::Root;
///
/// // A body at (2, 1) that faces world y. One metre ahead of it is (2, 2).
/// let root = Root { position_m: Vec2::new(2.0, 1.0), facing_rad: std::f32::consts::FRAC_PI_2 };
/// assert!(root.to_world(Vec3::X).distance(Vec3::new(2.0, 2.0, 0.0)) < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Root {
    /// Centre of the body's disc on the ground, world, metres.
    pub position_m: Vec2,
    /// Facing, counter-clockwise from world x, radians.
    pub facing_rad: f32,
}

impl Root {
    /// Unit vector along the facing, world.
    pub fn forward(&self) -> Vec2 {
        let (sin, cos) = libm::sincosf(self.facing_rad);
        Vec2::new(cos, sin)
    }

    /// The root frame in the world; cheaper than [`Root::to_world`] for many points.
    pub fn frame(&self) -> RootFrame {
        RootFrame { position_m: self.position_m, forward: self.forward() }
    }

    /// A point of the root frame in the world, metres.
    pub fn to_world(&self, point_m: Vec3) -> Vec3 {
        self.frame().to_world(point_m)
    }
}

/// A root frame at a position in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootFrame {
    /// Origin of the frame on the ground, world, metres.
    pub position_m: Vec2,
    /// The frame's x axis, a unit vector in the world.
    pub forward: Vec2,
}

impl RootFrame {
    /// A point of the root frame in the world, metres.
    pub fn to_world(&self, point_m: Vec3) -> Vec3 {
        let ground_m = self.position_m + self.forward.rotate(point_m.truncate());
        ground_m.extend(point_m.z)
    }

    /// A point of the world in the root frame, metres.
    pub fn to_local(&self, point_m: Vec3) -> Vec3 {
        self.vector_to_local(point_m.truncate() - self.position_m).extend(point_m.z)
    }

    /// A horizontal vector of the world in the root frame, in its own unit.
    pub fn vector_to_local(&self, vector: Vec2) -> Vec2 {
        Vec2::new(self.forward.x, -self.forward.y).rotate(vector)
    }
}

/// A pose in its root frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Position of the pelvis joint in the root frame: forward, left, height above the ground, metres.
    pub pelvis_m: Vec3,
    /// Rotation of each joint relative to its parent. The pelvis's is relative to the root frame: it holds the yaw.
    pub rotations: [Quat; JOINT_COUNT],
}

/// Positions and orientations of all joints of a pose, in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joints {
    /// Position of each joint, metres.
    pub positions_m: [Vec3; JOINT_COUNT],
    /// Orientation of each joint relative to the rest pose.
    pub orientations: [Quat; JOINT_COUNT],
}

impl Joints {
    /// The joints of the same pose of a body that is `size` times as large ([`Skeleton::sized`]), about the root.
    pub fn sized(&self, size: f32) -> Self {
        Self { positions_m: self.positions_m.map(|position_m| size * position_m), orientations: self.orientations }
    }
}

impl Pose {
    /// The pose between two poses whose rotations share a hemisphere; `share` is 0 at this pose and 1 at the other.
    pub fn lerp(&self, other: &Self, share: f32) -> Self {
        let rotation =
            |joint: usize| (self.rotations[joint] * (1.0 - share) + other.rotations[joint] * share).normalize();
        Self { pelvis_m: self.pelvis_m.lerp(other.pelvis_m, share), rotations: std::array::from_fn(rotation) }
    }

    /// Positions and orientations of all joints in the root frame.
    ///
    /// ```
    /// use glam::{Quat, Vec3};
    /// use motiondb::{Foot, JOINT_COUNT, Joint, Pose, Skeleton};
    ///
    /// // A body whose left shank hangs 0.4 m below the left hip, which is at the pelvis.
    /// let mut offsets_m = [Vec3::ZERO; JOINT_COUNT];
    /// offsets_m[Joint::LeftShank.index()] = Vec3::new(0.0, 0.0, -0.4);
    /// let foot = Foot { heel_m: Vec3::ZERO, ball_m: Vec3::ZERO, toe_tip_m: Vec3::ZERO, measured_m: [Vec3::ZERO; 3] };
    /// let skeleton = Skeleton {
    ///     offsets_m,
    ///     segment_ends_m: offsets_m,
    ///     segment_radii_m: [0.05; JOINT_COUNT],
    ///     limits_rad: [[Vec3::splat(-3.0), Vec3::splat(3.0)]; JOINT_COUNT],
    ///     feet: [foot; 2],
    /// };
    ///
    /// // A flexed hip (−y) raises the knee to the front.
    /// let mut pose = Pose { pelvis_m: Vec3::new(0.0, 0.0, 0.9), rotations: [Quat::IDENTITY; JOINT_COUNT] };
    /// pose.rotations[Joint::LeftThigh.index()] = Quat::from_rotation_y(-90_f32.to_radians());
    /// let knee_m = pose.forward_kinematics(&skeleton).positions_m[Joint::LeftShank.index()];
    /// assert!(knee_m.distance(Vec3::new(0.4, 0.0, 0.9)) < 1e-6);
    /// ```
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

    /// Positions (m) and orientations, in the root frame, of the joints of one chain. The first joint is a child of the
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

    /// Flexion of a knee, radians: the twist of its shank about the body's left axis. Negative for a hyperextended
    /// knee.
    pub fn knee_flexion_rad(&self, side: usize) -> f32 {
        let shank = self.rotations[Joint::SHANKS[side].index()];
        let shank = if shank.w < 0.0 { -shank } else { shank };
        2.0 * libm::atan2f(shank.y, shank.w)
    }
}

impl Joints {
    /// A point at `offset_m` from a joint (in the joint's own axes), in the frame of the joints, metres.
    pub fn point_m(&self, joint: Joint, offset_m: Vec3) -> Vec3 {
        self.positions_m[joint.index()] + self.orientations[joint.index()] * offset_m
    }

    /// Heel, ball and toe tip on the sole of one foot, in the frame of the joints, metres.
    pub fn sole_points_m(&self, skeleton: &Skeleton, side: usize) -> [Vec3; 3] {
        let foot = &skeleton.feet[side];
        self.foot_points_m(side, [foot.heel_m, foot.ball_m, foot.toe_tip_m])
    }

    /// Heel, ball and toe tip of one foot as slide is measured at them, in the frame of the joints, metres.
    pub fn measured_points_m(&self, skeleton: &Skeleton, side: usize) -> [Vec3; 3] {
        self.foot_points_m(side, skeleton.feet[side].measured_m)
    }

    fn foot_points_m(&self, side: usize, [heel_m, ball_m, toe_tip_m]: [Vec3; 3]) -> [Vec3; 3] {
        let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
        [self.point_m(foot, heel_m), self.point_m(foot, ball_m), self.point_m(toe, toe_tip_m)]
    }
}
