//! A checked BVH as the text that `bvh_anim` reads: joints `j0`, `j1` … and an End Site on every leaf.
//!
//! End sites of the file are left out: the clip keeps them as joints of its own.

use std::fmt::Write as _;

use crate::read::bvh::hierarchy::CheckedJoint;
use crate::read::bvh::motion_section::MotionSection;
use crate::read::bvh::prepass::CheckedBvh;

impl CheckedBvh {
    /// The canonical text with at most `frames` frames. Joint `j<N>` is the N-th of `joints`.
    pub(crate) fn text(&self, frames: usize) -> String {
        let MotionSection { frame_time_s, row_count, .. } = &self.motion;
        let frames = frames.min(*row_count);
        let mut text = canonical_hierarchy(&self.joints);
        let _ = write!(text, "MOTION\nFrames: {frames}\nFrame Time: {frame_time_s}\n");
        for row in self.motion.rows().take(frames) {
            for value in row {
                let _ = write!(text, "{value} ");
            }
            text.push('\n');
        }
        text
    }
}

fn canonical_hierarchy(joints: &[CheckedJoint]) -> String {
    let mut text = String::from("HIERARCHY\n");
    let mut open: Vec<usize> = Vec::new();
    let mut is_leaf = vec![true; joints.len()];
    for joint in joints.iter().filter(|joint| !joint.is_end) {
        joint.parent.into_iter().for_each(|parent| is_leaf[parent] = false);
    }
    for (index, joint) in joints.iter().enumerate().filter(|(_, joint)| !joint.is_end) {
        while open.last().copied() != joint.parent {
            close(&mut text, open.pop().is_some_and(|joint| is_leaf[joint]));
        }
        let keyword = if joint.parent.is_none() { "ROOT" } else { "JOINT" };
        let _ =
            writeln!(text, "{keyword} j{index}\n{{\nOFFSET {} {} {}", joint.offset.x, joint.offset.y, joint.offset.z);
        let _ = writeln!(text, "CHANNELS {} {}", joint.channels.len(), joint.channels.join(" "));
        open.push(index);
    }
    while let Some(joint) = open.pop() {
        close(&mut text, is_leaf[joint]);
    }
    text
}

/// Closes a joint. A leaf gets the End Site without which `bvh_anim` drops it.
fn close(text: &mut String, is_leaf: bool) {
    if is_leaf {
        text.push_str("End Site\n{\nOFFSET 0 0 0\n}\n");
    }
    text.push_str("}\n");
}
