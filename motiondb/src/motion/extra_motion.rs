//! Motion of the extra joints: rotations beside those of the 22 roles, for the rows of all examples and for the frames of
//! all actions.
//!
//! A set keeps every extra joint that one of its clips has. A clip without the joint holds the joint's mean over the
//! others. Metres, radians; the rest pose is that of [`crate::body::extra_joint`].

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::body::extra_joint::ExtraJoint;
use crate::motion::phase_map::PHASE_COUNT;

/// An extra joint of a set, and its bone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExtraBone {
    /// The joint.
    pub joint: ExtraJoint,
    /// Position of the joint relative to its parent, in the parent's rest axes, metres.
    pub offset_m: Vec3,
}

/// Motion of the extra joints of a database; empty where no clip has such joints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ExtraMotion {
    /// The extra joints, in order.
    pub bones: Vec<ExtraBone>,
    /// Rotations relative to the parent, row by row, as [`Rows::rotations`](crate::motion::Rows::rotations).
    pub rotations: Vec<Quat>,
    /// Rotations in each action, frame by frame, in the order of the actions.
    pub actions: Vec<Vec<Quat>>,
}

impl ExtraMotion {
    /// Whether no clip has extra joints.
    pub fn is_empty(&self) -> bool {
        self.bones.is_empty()
    }

    /// Rotations of one row of an example.
    pub fn row(&self, example: usize, phase: usize) -> &[Quat] {
        let count = self.bones.len();
        &self.rotations[(example * PHASE_COUNT + phase) * count..][..count]
    }

    /// Rotations of one frame of an action.
    pub fn frame(&self, action: usize, frame: usize) -> &[Quat] {
        if self.is_empty() {
            return &[];
        }
        let count = self.bones.len();
        &self.actions[action][frame * count..][..count]
    }

    /// Weighted sums of rows and frames, normalised, in place of `rotations`. The weights must sum to 1.
    ///
    /// ```
    /// use glam::{Quat, Vec3};
    /// use motiondb::body::{ExtraJoint, Side};
    /// use motiondb::motion::{ExtraBone, ExtraMotion};
    ///
    /// let knuckle = ExtraBone { joint: ExtraJoint::finger(Side::Left, 1, 0), offset_m: Vec3::Y * 0.09 };
    /// let extra = ExtraMotion { bones: vec![knuckle], ..ExtraMotion::default() };
    /// let [open, curled] = [0.0, 0.6].map(|angle_rad| [Quat::from_rotation_x(angle_rad)]);
    /// let mut half = Vec::new();
    /// extra.blend([(&open[..], 0.5), (&curled[..], 0.5)], &mut half);
    /// assert!(half[0].abs_diff_eq(Quat::from_rotation_x(0.3), 1e-6));
    /// ```
    pub fn blend<'a>(&self, weighted: impl IntoIterator<Item = (&'a [Quat], f32)>, rotations: &mut Vec<Quat>) {
        rotations.clear();
        rotations.resize(self.bones.len(), Quat::from_xyzw(0.0, 0.0, 0.0, 0.0));
        for (row, weight) in weighted {
            rotations.iter_mut().zip(row).for_each(|(sum, rotation)| *sum += *rotation * weight);
        }
        // All rows share a hemisphere, so no sum is near zero.
        rotations.iter_mut().for_each(|rotation| *rotation = rotation.normalize());
    }

    /// Position of a joint among those of the set; `None` where the set lacks it.
    pub fn position(&self, joint: ExtraJoint) -> Option<usize> {
        self.bones.binary_search_by_key(&joint, |bone| bone.joint).ok()
    }
}
