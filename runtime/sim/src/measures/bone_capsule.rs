//! The capsules of a body, one per bone, and the boxes about them. Metres, in the frame of the joints that are given.

use glam::Vec3;
use motiondb::body::{Joints, Skeleton};

use crate::maths::segment_distance::Segment;

/// The capsule of one bone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoneCapsule {
    pub(crate) bone: Segment,
    pub(crate) radius_m: f32,
    pub(crate) bounds: Bounds,
}

/// A box along the axes about a capsule or a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) low_m: Vec3,
    pub(crate) high_m: Vec3,
}

/// The bone of a joint, in the frame of the joints.
pub(crate) fn bone(skeleton: &Skeleton, joints: &Joints, joint: usize) -> Segment {
    let from_m = joints.positions_m[joint];
    Segment { from_m, to_m: from_m + joints.orientations[joint] * skeleton.segment_ends_m[joint] }
}

impl BoneCapsule {
    pub(crate) fn new(bone: Segment, radius_m: f32) -> Self {
        let [low_m, high_m] = [bone.from_m.min(bone.to_m) - radius_m, bone.from_m.max(bone.to_m) + radius_m];
        Self { bone, radius_m, bounds: Bounds { low_m, high_m } }
    }

    pub(crate) fn shifted(&self, offset_m: Vec3) -> Self {
        let bone = Segment { from_m: self.bone.from_m + offset_m, to_m: self.bone.to_m + offset_m };
        Self { bone, radius_m: self.radius_m, bounds: self.bounds.shifted(offset_m) }
    }
}

impl Bounds {
    /// The box about nothing.
    pub(crate) const EMPTY: Self = Self { low_m: Vec3::INFINITY, high_m: Vec3::NEG_INFINITY };

    /// The box about both.
    pub(crate) fn with(self, other: Self) -> Self {
        Self { low_m: self.low_m.min(other.low_m), high_m: self.high_m.max(other.high_m) }
    }

    pub(crate) fn shifted(self, offset_m: Vec3) -> Self {
        Self { low_m: self.low_m + offset_m, high_m: self.high_m + offset_m }
    }

    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.low_m.cmplt(other.high_m).all() && other.low_m.cmplt(self.high_m).all()
    }
}
