//! The frame of reference of a figure: joints at rest, and sizes relative to the body for which sections are stated.
//! Metres.

use glam::Vec3;
use motiondb::body::{Joint, Pose, Side, Skeleton};

use crate::figure::style::Sex;

/// Height of the crown of the reference body, m.
const REFERENCE_M: f32 = 1.775;

/// How fine surfaces are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Fineness {
    /// For bodies of about 50 to 110 pixels.
    Coarse,
    /// For bodies of up to 300 pixels.
    Middle,
    /// For bodies of any height.
    Fine,
}

impl Fineness {
    pub(crate) const ALL: [Self; 3] = [Self::Coarse, Self::Middle, Self::Fine];

    /// Number of points of a section; `least` for the coarsest.
    pub(crate) fn points(self, least: u32) -> u32 {
        least * [2, 3, 5][self as usize] / 2
    }
}

/// Joints at rest and sizes of a body.
#[derive(Clone, Debug)]
pub(crate) struct Build {
    pub(crate) sex: Sex,
    pub(crate) fineness: Fineness,
    /// Size relative to the reference body.
    pub(crate) scale: f32,
    /// Positions of the joints at rest.
    pub(crate) rest: Vec<Vec3>,
    pub(crate) skeleton: Skeleton,
}

impl Build {
    pub(crate) fn new(skeleton: &Skeleton, sex: Sex, fineness: Fineness) -> Self {
        let rest = rest_positions(skeleton);
        let head = Joint::Head.index();
        let scale = (rest[head].z + skeleton.segment_ends_m[head].z) / REFERENCE_M;
        Self { sex, fineness, scale, rest, skeleton: skeleton.clone() }
    }

    pub(crate) fn joint(&self, joint: Joint) -> Vec3 {
        self.rest[joint.index()]
    }

    /// A value for each sex.
    pub(crate) fn by_sex(&self, male: f32, female: f32) -> f32 {
        match self.sex {
            Sex::Male => male,
            Sex::Female => female,
        }
    }
}

/// Positions of the joints in the rest pose, m.
pub(crate) fn rest_positions(skeleton: &Skeleton) -> Vec<Vec3> {
    let pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [glam::Quat::IDENTITY; motiondb::JOINT_COUNT] };
    pose.forward_kinematics(skeleton).positions_m.to_vec()
}

/// Upper arm, forearm and hand of a side.
pub(crate) fn arm(side: Side) -> [Joint; 3] {
    match side {
        Side::Left => [Joint::LeftUpperArm, Joint::LeftForearm, Joint::LeftHand],
        Side::Right => [Joint::RightUpperArm, Joint::RightForearm, Joint::RightHand],
    }
}
