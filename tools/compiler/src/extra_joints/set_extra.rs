//! Extra joints of clips → those of a set, and their rotations in the rows of its examples and the frames of its actions.
//!
//! A set has every extra joint that one of its clips has, on both sides. A clip without the joint holds the mean over
//! the others. Rotations lie in the hemispheres of the first row, as those of the roles do. f64 in, f32 out.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use motiondb::body::{EXTRA_JOINTS_MAX, ExtraJoint};
use motiondb::motion::{ExtraBone, ExtraMotion};
use motiondb::statistics::mean;

use crate::action::joined_action::JoinedAction;
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::mirrored::mirrored_rotation;
use crate::extra_joints::clip_extra::ClipExtra;
use crate::ground::pose_mean::mean_rotation;
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::select::named_cycles::NamedCycle;

/// The extra joints of a set, each with its mean over the clips, on the target body.
pub(crate) struct SetExtra {
    joints: Vec<ClipExtra>,
}

impl SetExtra {
    /// The extra joints of the clips that may give an example or a transition.
    pub(crate) fn of(clips: &[HumanClip], analyzed: &[AnalyzedClip], body: &HumanBody) -> Self {
        let mut of_joints: BTreeMap<ExtraJoint, Vec<ClipExtra>> = BTreeMap::new();
        let used = clips.iter().zip(analyzed).filter(|(_, found)| found.gives_motion());
        for (clip, _) in used {
            let growth = body.leg_length_m() / clip.body.leg_length_m();
            for extra in &clip.extra {
                let extra = ClipExtra { offset_m: growth * extra.offset_m, ..*extra };
                of_joints.entry(extra.joint).or_default().push(extra);
            }
        }
        let means: Vec<ClipExtra> = of_joints.into_values().filter_map(|found| mean_of_clips(&found)).collect();
        let lacks = |joint: ExtraJoint| means.iter().all(|extra| extra.joint != joint);
        let other_sides = means.iter().filter(|extra| lacks(extra.joint.mirrored())).map(mirrored_extra);
        let mut joints: Vec<ClipExtra> = other_sides.chain(means.iter().copied()).collect();
        joints.sort_by_key(|extra| extra.joint);
        joints.truncate(EXTRA_JOINTS_MAX);
        Self { joints }
    }

    /// The motion of the extra joints in some cycles and actions that are made of some clips.
    pub(crate) fn motion(&self, cycles: &[NamedCycle], actions: &[JoinedAction], clips: &[HumanClip]) -> ExtraMotion {
        let Some(first) = cycles.first().filter(|_| !self.joints.is_empty()) else { return ExtraMotion::default() };
        let rotations =
            |source: u32, mirrored: bool, own: &[DQuat]| self.rotations(&clips[source as usize].extra, mirrored, own);
        let reference = rotations(first.source, first.mirrored, &first.cycle.rows[0].extra);
        let stored = |rotations: Vec<DQuat>| {
            let aligned = rotations.into_iter().zip(&reference);
            aligned.map(|(turn, like)| (if turn.dot(*like) < 0.0 { -turn } else { turn }).as_quat()).collect::<Vec<_>>()
        };
        let of_cycle = |named: &NamedCycle| {
            let rows = named.cycle.rows.iter();
            rows.flat_map(|row| stored(rotations(named.source, named.mirrored, &row.extra))).collect::<Vec<_>>()
        };
        let of_action = |action: &JoinedAction| {
            let frames = action.frames.iter();
            frames.flat_map(|frame| stored(rotations(action.source, action.mirrored, &frame.pose.extra))).collect()
        };
        let bone = |extra: &ClipExtra| ExtraBone { joint: extra.joint, offset_m: extra.offset_m.as_vec3() };
        ExtraMotion {
            bones: self.joints.iter().map(bone).collect(),
            rotations: cycles.iter().flat_map(of_cycle).collect(),
            actions: actions.iter().map(of_action).collect(),
        }
    }

    /// Rotations of all joints of the set in a pose that has those of a clip.
    fn rotations(&self, clip: &[ClipExtra], mirrored: bool, own: &[DQuat]) -> Vec<DQuat> {
        let rotation = |extra: &ClipExtra| {
            let joint = if mirrored { extra.joint.mirrored() } else { extra.joint };
            clip.iter().position(|own| own.joint == joint).map_or(extra.mean, |position| own[position])
        };
        self.joints.iter().map(rotation).collect()
    }
}

/// The mean of a joint over the clips that have it.
fn mean_of_clips(found: &[ClipExtra]) -> Option<ClipExtra> {
    let joint = found.first()?.joint;
    let mean_turn = mean_rotation(found.iter().map(|extra| (1.0, extra.mean)));
    Some(ClipExtra { joint, offset_m: mean(found.iter().map(|extra| extra.offset_m))?, mean: mean_turn })
}

/// The same joint of the other side.
fn mirrored_extra(extra: &ClipExtra) -> ClipExtra {
    ClipExtra {
        joint: extra.joint.mirrored(),
        offset_m: extra.offset_m * DVec3::new(1.0, -1.0, 1.0),
        mean: mirrored_rotation(extra.mean),
    }
}
