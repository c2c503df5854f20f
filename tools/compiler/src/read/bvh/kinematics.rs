//! Channels and numbers of a BVH → global positions and orientations of its joints, frame by frame.
//!
//! Position channels may replace OFFSET (Bandai, LaFAN1) or be relative to it (iClone). For the joints that carry the
//! whole body, from the root to the first fork, the two differ by a constant displacement of everything, which
//! grounding removes later. For other joints the mean of the channels decides: near OFFSET they replace it, near zero
//! they are relative.

use std::path::Path;

use bvh_anim::{Axis, Bvh, Channel};
use glam::{DQuat, DVec3};

use crate::read::bvh::hierarchy::CheckedJoint;
use crate::read::bvh::motion_section::MotionSection;
use crate::read::bvh::prepass::CheckedBvh;
use crate::read::source_clip::{SourceClip, SourceJoint};
use crate::read::source_motion::{FramePoser, JointPoses, SourceMotion};

/// How one joint moves in its parent's frame.
struct JointMotion {
    /// OFFSET, source units.
    offset: DVec3,
    channels: Vec<ChannelColumn>,
    /// Whether position channels are added to the offset instead of replacing it.
    is_relative: bool,
    /// Whether the joint is an end site.
    is_end: bool,
}

/// One channel, and the column of a row that holds its values.
struct ChannelColumn {
    column: usize,
    is_position: bool,
    /// 0 for x, 1 for y, 2 for z.
    axis: usize,
}

/// The motion of a checked BVH; `bvh` gives the channels of its joints.
pub(crate) fn source_motion(file: &Path, checked: CheckedBvh, bvh: &Bvh) -> SourceMotion<'static> {
    let motions = joint_motions(&checked, bvh);
    let CheckedBvh { joints, motion, diagnostics } = checked;
    let parents = joints.iter().map(|joint| joint.parent).collect();
    let head = SourceClip {
        file: file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        clip: String::new(),
        joints: joints.into_iter().map(source_joint).collect(),
        first_frame: 0,
        frame_rate_hz: 1.0 / motion.frame_time_s,
        positions: Vec::new(),
        oriented: 0,
        orientations: Vec::new(),
        up_axis: None,
        metres_per_unit: None,
        diagnostics,
    };
    SourceMotion::new(head, motion.row_count, RowPoser { motions, parents, motion })
}

/// Poses rows of numbers.
struct RowPoser {
    motions: Vec<JointMotion>,
    /// Parent of each joint.
    parents: Vec<Option<usize>>,
    motion: MotionSection,
}

impl FramePoser for RowPoser {
    fn pose(&mut self, frame: usize, is_needed: &[bool], poses: &mut JointPoses) {
        let row = self.motion.row(frame);
        for joint in (0..self.motions.len()).filter(|&joint| is_needed[joint]) {
            let (offset, rotation) = self.motions[joint].local(row);
            let (position, orientation) = match self.parents[joint] {
                Some(parent) => {
                    let turn = poses.orientations[parent];
                    let is_end = self.motions[joint].is_end;
                    (poses.positions[parent] + turn * offset, if is_end { turn } else { turn * rotation })
                }
                None => (offset, rotation),
            };
            poses.positions[joint] = position;
            poses.orientations[joint] = orientation.normalize();
        }
    }

    /// The zero pose: each joint at its OFFSET, without rotations.
    fn pose_at_rest(&mut self, poses: &mut JointPoses) {
        for (joint, motion) in self.motions.iter().enumerate() {
            let parent_position = self.parents[joint].map_or(DVec3::ZERO, |parent| poses.positions[parent]);
            poses.positions[joint] = parent_position + motion.offset;
            poses.orientations[joint] = DQuat::IDENTITY;
        }
    }

    fn free_before(&mut self, frame: usize) {
        self.motion.free_before(frame);
    }
}

fn source_joint(joint: CheckedJoint) -> SourceJoint {
    SourceJoint { name: joint.name, parent: joint.parent, is_end: joint.is_end }
}

impl JointMotion {
    /// Translation (source units) and rotation in the parent's frame.
    fn local(&self, row: &[f64]) -> (DVec3, DQuat) {
        let (mut offset, mut rotation) = (self.offset, DQuat::IDENTITY);
        for channel in &self.channels {
            let value = row[channel.column];
            if channel.is_position {
                offset[channel.axis] = if self.is_relative { self.offset[channel.axis] + value } else { value };
            } else {
                rotation *= DQuat::from_axis_angle(DVec3::AXES[channel.axis], value.to_radians());
            }
        }
        (offset, rotation)
    }
}

fn channel_column(channel: &Channel) -> ChannelColumn {
    let axis = match channel.channel_type().axis() {
        Axis::X => 0,
        Axis::Y => 1,
        Axis::Z => 2,
    };
    ChannelColumn { column: channel.motion_index(), is_position: channel.channel_type().is_position(), axis }
}

fn joint_motions(checked: &CheckedBvh, bvh: &Bvh) -> Vec<JointMotion> {
    let mut channels_of_joints =
        bvh.joints().map(|joint| joint.data().channels().iter().map(channel_column).collect::<Vec<ChannelColumn>>());
    let carriers = carrier_count(&checked.joints);
    let motion = |(index, joint): (usize, &CheckedJoint)| {
        let channels = if joint.is_end { Vec::new() } else { channels_of_joints.next().unwrap_or_default() };
        let is_relative = index >= carriers && is_relative(joint.offset, &channels, &checked.motion);
        JointMotion { offset: joint.offset, channels, is_relative, is_end: joint.is_end }
    };
    checked.joints.iter().enumerate().map(motion).collect()
}

/// Number of joints from the root to the first fork: each of them carries the whole body.
fn carrier_count(joints: &[CheckedJoint]) -> usize {
    let children = |parent: usize| joints.iter().filter(|joint| joint.parent == Some(parent)).count();
    1 + (0..joints.len()).take_while(|&joint| children(joint) == 1).count()
}

/// Whether the mean of the position channels is nearer to zero than to the offset.
fn is_relative(offset: DVec3, channels: &[ChannelColumn], motion: &MotionSection) -> bool {
    let mut mean = offset;
    for channel in channels.iter().filter(|channel| channel.is_position) {
        mean[channel.axis] = motion.rows().map(|row| row[channel.column]).sum::<f64>() / motion.row_count as f64;
    }
    mean.length() < (mean - offset).length()
}
