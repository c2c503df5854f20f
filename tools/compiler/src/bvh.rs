//! BVH → [`SourceClip`]: the hierarchy through `bvh_anim`, the numbers as they were checked, the forward kinematics
//! here.
//!
//! A joint's frame is its parent's, translated by OFFSET (or by its position channels), then rotated by its rotation
//! channels in the order in which the file lists them. Angles in degrees.
//!
//! Position channels may replace OFFSET (Bandai, LaFAN1) or be relative to it (iClone). On the joints that carry the
//! whole body (from the root down to the first fork) the two differ by a constant displacement of everything, which
//! levelling on the ground removes later; on bones the channel's mean decides: near OFFSET it replaces, near zero it
//! adds.

mod hierarchy;
pub(crate) mod prepass;

use std::path::Path;

use bvh_anim::{Axis, Bvh, Channel};
use glam::{DQuat, DVec3};

use self::hierarchy::CheckedJoint;
use self::prepass::{CheckedBvh, Motion};
use crate::error::ImportError;
use crate::source_clip::{SourceClip, SourceJoint};

/// Reads the one clip of a BVH file from its bytes; `file` is for names and messages.
///
/// # Errors
/// [`ImportError::Bvh`] with the line that is malformed.
pub fn read(file: &Path, bytes: &[u8]) -> Result<SourceClip, ImportError> {
    let checked = prepass::check(bytes).map_err(|flaw| ImportError::Bvh {
        file: file.to_owned(),
        line: flaw.line,
        problem: flaw.problem,
        remedy: flaw.remedy,
    })?;
    let bvh = bvh_anim::from_str(&checked.text(0)).map_err(|error| ImportError::Bvh {
        file: file.to_owned(),
        line: 1,
        problem: error.to_string(),
        remedy: "export the clip again",
    })?;
    Ok(posed(file, checked, &bvh))
}

/// The text that `bvh_anim` can read, with all frames; none where the file is no BVH.
pub fn canonical_text(bytes: &[u8]) -> Option<String> {
    prepass::check(bytes).ok().map(|checked| checked.text(usize::MAX))
}

fn posed(file: &Path, checked: CheckedBvh, bvh: &Bvh) -> SourceClip {
    let Motion { frame_time_s, values, rows } = &checked.motion;
    let frames = values.chunks(values.len() / rows);
    let movers = movers(&checked, bvh);
    let mut positions = Vec::with_capacity(rows * movers.len());
    let mut orientations: Vec<DQuat> = Vec::with_capacity(rows * movers.len());
    for frame in frames {
        let start = positions.len();
        for (mover, joint) in movers.iter().zip(&checked.joints) {
            let (offset, rotation) = mover.local(frame);
            let (position, orientation) = match joint.parent.map(|parent| start + parent) {
                Some(parent) => {
                    let turn = orientations[parent];
                    (positions[parent] + turn * offset, if joint.is_end { turn } else { turn * rotation })
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
        frame_rate_hz: 1.0 / frame_time_s,
        positions,
        orientations,
        up_axis: None,
        metres_per_unit: None,
        warnings: checked.warnings,
    }
}

fn source_joint(joint: &CheckedJoint) -> SourceJoint {
    SourceJoint { name: joint.name.clone(), parent: joint.parent, is_end: joint.is_end }
}

/// How one joint moves within its parent's frame.
struct Mover {
    offset: DVec3,
    steps: Vec<Step>,
    /// Position channels add to the offset instead of replacing it.
    relative: bool,
}

/// What one channel does.
struct Step {
    /// In its row.
    column: usize,
    is_position: bool,
    axis: usize,
}

impl Mover {
    fn local(&self, row: &[f64]) -> (DVec3, DQuat) {
        let (mut offset, mut rotation) = (self.offset, DQuat::IDENTITY);
        for step in &self.steps {
            let value = row[step.column];
            if step.is_position {
                offset[step.axis] = if self.relative { self.offset[step.axis] + value } else { value };
            } else {
                rotation *= DQuat::from_axis_angle(DVec3::AXES[step.axis], value.to_radians());
            }
        }
        (offset, rotation)
    }
}

fn step(channel: &Channel) -> Step {
    let axis = match channel.channel_type().axis() {
        Axis::X => 0,
        Axis::Y => 1,
        Axis::Z => 2,
    };
    Step { column: channel.motion_index(), is_position: channel.channel_type().is_position(), axis }
}

fn movers(checked: &CheckedBvh, bvh: &Bvh) -> Vec<Mover> {
    let mut read = bvh.joints().map(|joint| joint.data().channels().iter().map(step).collect::<Vec<Step>>());
    let carriers = carriers(&checked.joints);
    let mover = |(index, joint): (usize, &CheckedJoint)| {
        let steps = if joint.is_end { Vec::new() } else { read.next().unwrap_or_default() };
        let relative = index >= carriers && is_relative(joint.offset, &steps, &checked.motion);
        Mover { offset: joint.offset, steps, relative }
    };
    checked.joints.iter().enumerate().map(mover).collect()
}

/// The joints from the root down to the first fork: all of the body hangs from each.
fn carriers(joints: &[CheckedJoint]) -> usize {
    let children = |parent: usize| joints.iter().filter(|joint| joint.parent == Some(parent)).count();
    1 + (0..joints.len()).take_while(|&joint| children(joint) == 1).count()
}

fn is_relative(offset: DVec3, steps: &[Step], motion: &Motion) -> bool {
    let mut mean = offset;
    for step in steps.iter().filter(|step| step.is_position) {
        let column = motion.values.iter().skip(step.column).step_by(motion.values.len() / motion.rows);
        mean[step.axis] = column.sum::<f64>() / motion.rows as f64;
    }
    mean.length() < (mean - offset).length()
}
