//! Poses of successive frames in the world: their own, or those of another clip at other positions. Metres.

use std::ops::Range;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::retarget::human_clip::HumanPose;

/// Poses of successive frames.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) enum GroundedPoses<'a> {
    /// Poses of their own.
    Own(Vec<HumanPose>),
    /// Some poses of a clip; the others are freed.
    Parts(PartsOfPoses),
    /// The poses of a clip at other positions. Not stored, so it comes last: other variants keep their numbers.
    #[serde(skip)]
    Moved {
        poses: &'a [HumanPose],
        /// World position of the pelvis in each frame, m.
        pelvis_m: Vec<DVec3>,
    },
}

/// Some poses of a clip, with the frame numbers of the whole.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct PartsOfPoses {
    /// Number of frames of the whole.
    count: usize,
    /// First frame of each part, and its poses, in order of time.
    parts: Vec<(usize, Vec<HumanPose>)>,
}

impl GroundedPoses<'_> {
    /// Number of poses.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Own(poses) => poses.len(),
            Self::Moved { pelvis_m, .. } => pelvis_m.len(),
            Self::Parts(kept) => kept.count,
        }
    }

    /// The pose of a frame.
    pub(crate) fn pose(&self, frame: usize) -> HumanPose {
        match self {
            Self::Own(poses) => poses[frame].clone(),
            Self::Moved { poses, pelvis_m } => HumanPose { pelvis_m: pelvis_m[frame], ..poses[frame].clone() },
            Self::Parts(kept) => kept.pose(frame),
        }
    }

    /// Frees the poses outside some ranges of frames, which are in order and disjoint; none of them may be read afterwards.
    /// Poses of another clip stay.
    pub(crate) fn keep(&mut self, ranges: &[Range<usize>]) {
        if let Self::Own(poses) = self {
            let part = |range: &Range<usize>| (range.start, poses[range.clone()].to_vec());
            *self = Self::Parts(PartsOfPoses { count: poses.len(), parts: ranges.iter().map(part).collect() });
        }
    }

    /// Every pose of its own.
    pub(crate) fn own_mut(&mut self) -> impl Iterator<Item = &mut HumanPose> {
        let (own, parts) = match self {
            Self::Own(poses) => (&mut poses[..], &mut [][..]),
            Self::Moved { .. } => (&mut [][..], &mut [][..]),
            Self::Parts(kept) => (&mut [][..], &mut kept.parts[..]),
        };
        own.iter_mut().chain(parts.iter_mut().flat_map(|(_, poses)| poses))
    }

    /// Position of the pelvis in each frame that has a pose, m.
    pub(crate) fn pelvis_mut(&mut self) -> impl Iterator<Item = &mut DVec3> {
        let (own, moved, parts) = match self {
            Self::Own(poses) => (&mut poses[..], &mut [][..], &mut [][..]),
            Self::Moved { pelvis_m, .. } => (&mut [][..], &mut pelvis_m[..], &mut [][..]),
            Self::Parts(kept) => (&mut [][..], &mut [][..], &mut kept.parts[..]),
        };
        let own = own.iter_mut().chain(parts.iter_mut().flat_map(|(_, poses)| poses));
        own.map(|pose| &mut pose.pelvis_m).chain(moved)
    }
}

impl PartsOfPoses {
    /// The pose of a frame; of a frame that is freed the nearest one before it, else the first that is left.
    ///
    /// # Panics
    /// If no pose is left.
    fn pose(&self, frame: usize) -> HumanPose {
        let part = self.parts.partition_point(|(first, _)| *first <= frame).saturating_sub(1);
        let (first, poses) = &self.parts[part];
        debug_assert!((*first..first + poses.len()).contains(&frame), "frame {frame} is freed");
        poses[frame.saturating_sub(*first).min(poses.len() - 1)].clone()
    }
}
