//! Poses of successive frames in the world: their own, or those of another clip at other positions. Metres.

use glam::DVec3;

use crate::retarget::human_clip::HumanPose;

/// Poses of successive frames.
#[derive(Clone, Debug)]
pub(crate) enum GroundedPoses<'a> {
    /// Poses of their own.
    Own(Vec<HumanPose>),
    /// The poses of a clip at other positions.
    Moved {
        poses: &'a [HumanPose],
        /// World position of the pelvis in each frame, m.
        pelvis_m: Vec<DVec3>,
    },
}

impl GroundedPoses<'_> {
    /// Number of poses.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Own(poses) => poses.len(),
            Self::Moved { pelvis_m, .. } => pelvis_m.len(),
        }
    }

    /// The pose of a frame.
    pub(crate) fn pose(&self, frame: usize) -> HumanPose {
        match self {
            Self::Own(poses) => poses[frame].clone(),
            Self::Moved { poses, pelvis_m } => {
                HumanPose { pelvis_m: pelvis_m[frame], rotations: poses[frame].rotations }
            }
        }
    }

    /// Position of the pelvis in each frame, m.
    pub(crate) fn pelvis_mut(&mut self) -> impl Iterator<Item = &mut DVec3> {
        let (own, moved) = match self {
            Self::Own(poses) => (&mut poses[..], &mut [][..]),
            Self::Moved { pelvis_m, .. } => (&mut [][..], &mut pelvis_m[..]),
        };
        own.iter_mut().map(|pose| &mut pose.pelvis_m).chain(moved)
    }
}
