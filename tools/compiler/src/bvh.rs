//! BVH → [`SourceClip`]: the values through `bvh_anim`, the forward kinematics here.
//!
//! A joint's frame is its parent's, translated by OFFSET (or by its position channels), then rotated by its rotation channels in the
//! order in which the file lists them. Angles in degrees.
//!
//! Position channels may replace OFFSET (Bandai, LaFAN1) or be relative to it (iClone). On the joints that carry the whole body (from
//! the root down to the first fork) the two differ by a constant displacement of everything, which levelling on the ground removes later;
//! on bones the channel's mean decides: near OFFSET it replaces, near zero it adds.

use std::path::Path;

use bvh_anim::{Axis, Bvh, Channel, Frame};
use glam::{DQuat, DVec3};

use crate::bvh_prepass::{self, CheckedBvh, CheckedJoint};
use crate::error::ImportError;
use crate::source_clip::{SourceClip, SourceJoint};

/// Reads the one clip of a BVH file from its bytes; `file` is for names and messages.
///
/// # Errors
/// [`ImportError::Bvh`] with the line that is malformed.
pub fn read(file: &Path, bytes: &[u8]) -> Result<SourceClip, ImportError> {
    let checked = bvh_prepass::check(bytes).map_err(|flaw| ImportError::Bvh {
        file: file.to_owned(),
        line: flaw.line,
        problem: flaw.problem,
        remedy: flaw.remedy,
    })?;
    let bvh = bvh_anim::from_str(&checked.text).map_err(|error| ImportError::Bvh {
        file: file.to_owned(),
        line: 1,
        problem: error.to_string(),
        remedy: "export the clip again",
    })?;
    Ok(posed(file, &checked, &bvh))
}

fn posed(file: &Path, checked: &CheckedBvh, bvh: &Bvh) -> SourceClip {
    // Once: each look-up by number in `bvh_anim` walks over all frames before it.
    let frames: Vec<&Frame> = bvh.frames().collect();
    let movers = movers(checked, bvh, &frames);
    let mut positions = Vec::with_capacity(frames.len() * movers.len());
    let mut orientations = Vec::with_capacity(frames.len() * movers.len());
    for frame in frames {
        let start = positions.len();
        for (mover, joint) in movers.iter().zip(&checked.joints) {
            let (offset, rotation) = mover.local(frame);
            let (position, orientation) = match joint.parent {
                Some(parent) => {
                    let turn: DQuat = orientations[start + parent];
                    (positions[start + parent] + turn * offset, turn * rotation)
                }
                None => (offset, rotation),
            };
            positions.push(position);
            orientations.push(orientation.normalize());
        }
    }
    SourceClip {
        file: file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        clip: String::new(),
        joints: checked.joints.iter().map(source_joint).collect(),
        first_frame: 0,
        frame_rate_hz: 1.0 / bvh.frame_time().as_secs_f64().max(1e-6),
        positions,
        orientations,
        up_axis: None,
        metres_per_unit: None,
        warnings: checked.warnings.clone(),
    }
}

fn source_joint(joint: &CheckedJoint) -> SourceJoint {
    SourceJoint { name: joint.name.clone(), parent: joint.parent, is_end: joint.is_end }
}

/// How one joint moves within its parent's frame.
struct Mover {
    offset: DVec3,
    channels: Vec<Channel>,
    /// Position channels add to the offset instead of replacing it.
    relative: bool,
}

impl Mover {
    fn local(&self, frame: &Frame) -> (DVec3, DQuat) {
        let (mut offset, mut rotation) = (self.offset, DQuat::IDENTITY);
        for channel in &self.channels {
            let value = f64::from(frame[channel]);
            let axis = axis_index(channel);
            if channel.channel_type().is_position() {
                offset[axis] = if self.relative { self.offset[axis] + value } else { value };
            } else {
                rotation *= DQuat::from_axis_angle(DVec3::AXES[axis], value.to_radians());
            }
        }
        (offset, rotation)
    }
}

fn axis_index(channel: &Channel) -> usize {
    match channel.channel_type().axis() {
        Axis::X => 0,
        Axis::Y => 1,
        Axis::Z => 2,
    }
}

fn movers(checked: &CheckedBvh, bvh: &Bvh, frames: &[&Frame]) -> Vec<Mover> {
    let joints: Vec<_> = bvh.joints().collect();
    let mut read = joints.iter().map(|joint| joint.data().channels().to_vec());
    let carriers = carriers(&checked.joints);
    let mover = |(index, joint): (usize, &CheckedJoint)| {
        let channels = if joint.is_end { Vec::new() } else { read.next().unwrap_or_default() };
        let relative = index >= carriers && is_relative(joint.offset, &channels, frames);
        Mover { offset: joint.offset, channels, relative }
    };
    checked.joints.iter().enumerate().map(mover).collect()
}

/// The joints from the root down to the first fork: all of the body hangs from each.
fn carriers(joints: &[CheckedJoint]) -> usize {
    let children = |parent: usize| joints.iter().filter(|joint| joint.parent == Some(parent)).count();
    1 + (0..joints.len()).take_while(|&joint| children(joint) == 1).count()
}

fn is_relative(offset: DVec3, channels: &[Channel], frames: &[&Frame]) -> bool {
    let mut mean = offset;
    for channel in channels.iter().filter(|channel| channel.channel_type().is_position()) {
        let sum: f64 = frames.iter().map(|frame| f64::from(frame[channel])).sum();
        mean[axis_index(channel)] = sum / frames.len() as f64;
    }
    mean.length() < (mean - offset).length()
}
