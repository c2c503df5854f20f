//! Two bodies in one skeleton: files with two characters under one root.
//!
//! At the first fork of a hierarchy, the branches of one body are legs and a trunk; none of them is a body by itself.
//! In a file with two characters, two branches are.

use motiondb::body::JOINT_COUNT;

use crate::error::RejectionReason;
use crate::read::source_clip::{KeptJoints, SourceClip};
use crate::rig::role_search;

/// Least number of joints of a body: two legs and two arms of three joints each, and one from which they hang.
const BODY_JOINTS_MIN: usize = 13;

/// Checks that at most one branch of the first fork is a body by itself.
///
/// # Errors
/// [`RejectionReason::TwoBodies`].
pub(crate) fn check_is_one_body(clip: &SourceClip) -> Result<(), RejectionReason> {
    if clip.joints.len() < 2 * BODY_JOINTS_MIN {
        return Ok(());
    }
    let branches = first_fork(clip).into_iter().map(|child| subtree(clip, child));
    let large: Vec<Vec<usize>> = branches.filter(|branch| branch.len() >= BODY_JOINTS_MIN).collect();
    if large.len() < 2 {
        return Ok(());
    }
    let is_body = |branch: &&Vec<usize>| role_search::search(&part(clip, branch), &[None; JOINT_COUNT]).is_ok();
    let name = |branch: &Vec<usize>| clip.joints[branch[0]].name.clone();
    match large.iter().filter(is_body).map(name).collect::<Vec<String>>().as_slice() {
        [first, second, ..] => Err(RejectionReason::TwoBodies { first: first.clone(), second: second.clone() }),
        _ => Ok(()),
    }
}

/// The roots, if there are several; else the children of the first joint that has several.
fn first_fork(clip: &SourceClip) -> Vec<usize> {
    let mut branches: Vec<usize> =
        (0..clip.joints.len()).filter(|&joint| clip.joints[joint].parent.is_none()).collect();
    while let [only] = branches[..] {
        branches = (0..clip.joints.len()).filter(|&joint| clip.joints[joint].parent == Some(only)).collect();
    }
    branches
}

/// A joint and all its descendants, in the clip's order.
fn subtree(clip: &SourceClip, top: usize) -> Vec<usize> {
    let mut is_below = vec![false; clip.joints.len()];
    is_below[top] = true;
    for joint in top + 1..clip.joints.len() {
        is_below[joint] = clip.joints[joint].parent.is_some_and(|parent| is_below[parent]);
    }
    (0..clip.joints.len()).filter(|&joint| is_below[joint]).collect()
}

/// The clip of some joints only. A joint whose parent is left out becomes a root.
fn part(clip: &SourceClip, joints: &[usize]) -> SourceClip {
    let mut part = SourceClip { diagnostics: Vec::new(), ..clip.clone() };
    part.keep_joints(&KeptJoints { oriented: joints.to_vec(), points: Vec::new() });
    part
}
