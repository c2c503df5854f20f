//! Two people in one skeleton: a duet written under one root.
//!
//! Where the hierarchy first forks, the branches of one person's body are legs and a trunk, none of which is a body by
//! itself; the branches of a duet are.

use motiondb::body::JOINT_COUNT;

use crate::error::Refusal;
use crate::read::source_clip::{SourceClip, SourceJoint};
use crate::rig::roles::find_by_names;

/// Legs and arms of three joints each, and what they hang from.
const BODY_JOINTS_MIN: usize = 13;

/// Refuses a clip in which several branches of the first fork are bodies by themselves.
pub(crate) fn refuse(clip: &SourceClip) -> Result<(), Refusal> {
    if clip.joints.len() < 2 * BODY_JOINTS_MIN {
        return Ok(());
    }
    let branches = first_fork(clip).into_iter().map(|child| below(clip, child));
    let large: Vec<Vec<usize>> = branches.filter(|branch| branch.len() >= BODY_JOINTS_MIN).collect();
    if large.len() < 2 {
        return Ok(());
    }
    let is_body = |branch: &&Vec<usize>| find_by_names(&part(clip, branch), &[None; JOINT_COUNT]).is_ok();
    let name = |branch: &Vec<usize>| clip.joints[branch[0]].name.clone();
    match large.iter().filter(is_body).map(name).collect::<Vec<String>>().as_slice() {
        [first, second, ..] => Err(Refusal::TwoBodies { first: first.clone(), second: second.clone() }),
        _ => Ok(()),
    }
}

/// The roots where there are several, else the children of the first joint that has several.
fn first_fork(clip: &SourceClip) -> Vec<usize> {
    let mut branches: Vec<usize> =
        (0..clip.joints.len()).filter(|&joint| clip.joints[joint].parent.is_none()).collect();
    while let [only] = branches[..] {
        branches = (0..clip.joints.len()).filter(|&joint| clip.joints[joint].parent == Some(only)).collect();
    }
    branches
}

/// A joint and everything below it, in order.
fn below(clip: &SourceClip, top: usize) -> Vec<usize> {
    let mut is_below = vec![false; clip.joints.len()];
    is_below[top] = true;
    for joint in top + 1..clip.joints.len() {
        is_below[joint] = clip.joints[joint].parent.is_some_and(|parent| is_below[parent]);
    }
    (0..clip.joints.len()).filter(|&joint| is_below[joint]).collect()
}

/// A clip of some of its joints; parents that are left out are none.
fn part(clip: &SourceClip, joints: &[usize]) -> SourceClip {
    let frames = 0..clip.frame_count();
    let joint = |&index: &usize| {
        let parent = clip.joints[index].parent.and_then(|parent| joints.binary_search(&parent).ok());
        SourceJoint { parent, ..clip.joints[index].clone() }
    };
    SourceClip {
        joints: joints.iter().map(joint).collect(),
        positions: frames
            .clone()
            .flat_map(|frame| joints.iter().map(move |&index| clip.position(frame, index)))
            .collect(),
        orientations: frames
            .flat_map(|frame| joints.iter().map(move |&index| clip.orientation(frame, index)))
            .collect(),
        ..without_motion(clip)
    }
}

/// A clip whose joints have no names.
pub(crate) fn nameless(clip: &SourceClip) -> SourceClip {
    let mut clip = clip.clone();
    clip.joints.iter_mut().for_each(|joint| joint.name.clear());
    clip
}

fn without_motion(clip: &SourceClip) -> SourceClip {
    SourceClip {
        file: clip.file.clone(),
        clip: clip.clip.clone(),
        joints: Vec::new(),
        positions: Vec::new(),
        orientations: Vec::new(),
        diagnostics: Vec::new(),
        ..*clip
    }
}
