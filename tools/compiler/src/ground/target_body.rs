//! The body that all examples of a database share.
//!
//! One performer keeps its proportions. For several, the median is used, bone by bone, each performer once, left and
//! right alike, so that mirrored cycles fit (definition "Target skeleton" of `docs/definitions.md`). Rest pose and frames
//! are those of [`motiondb::body::Skeleton`]: metres.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use glam::DVec3;
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::statistics::median;

use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::rig::rig_head::Rig;

/// Thigh plus shank of adults, small woman to tall man, m. Other bodies are toys or giants and do not count.
const HUMAN_LEG_M: std::ops::RangeInclusive<f64> = 0.65..=1.05;

/// Number of clips, the longest, that show the bones of a performer: a run of a second alone shows no flat foot. So most
/// clips that come, go or change leave the body of a large library as it is.
const CLIPS_OF_PERFORMER: usize = 5;

/// The plane y = 0 as a mirror.
const MIRROR: DVec3 = DVec3::new(1.0, -1.0, 1.0);

/// The body of the clip that a manifest chose, else the median of the human-sized performers, else of all; `None`
/// without clips. The clips are in the order of a database.
pub(crate) fn target_body(clips: &[HumanClip]) -> Option<HumanBody> {
    let is_human = |clip: &&HumanClip| HUMAN_LEG_M.contains(&clip.body.leg_length_m());
    let clips_of = |counts: &dyn Fn(&&HumanClip) -> bool| -> Vec<&HumanClip> { clips.iter().filter(counts).collect() };
    let candidates = [clips_of(&|clip| clip.choices.is_target_skeleton), clips_of(&is_human), clips_of(&|_| true)];
    let counted = candidates.into_iter().find(|clips| !clips.is_empty())?;
    let performers = performers(&counted);
    Some(median_body(&performers.iter().collect::<Vec<&HumanBody>>()))
}

/// The body of each performer, as its longest clips show it. Clips of one rig have one performer.
fn performers(clips: &[&HumanClip]) -> Vec<HumanBody> {
    let mut of_rigs: BTreeMap<&Rig, Vec<&HumanClip>> = BTreeMap::new();
    let mut bodies = Vec::new();
    for clip in clips {
        match &clip.rig_head {
            Some(head) => of_rigs.entry(&head.rig).or_default().push(clip),
            None => bodies.push(clip.body.clone()),
        }
    }
    for mut clips in of_rigs.into_values() {
        clips.sort_by_key(|clip| Reverse(clip.frame_count()));
        clips.truncate(CLIPS_OF_PERFORMER);
        bodies.push(median_body(&clips.iter().map(|clip| &clip.body).collect::<Vec<&HumanBody>>()));
    }
    bodies
}

/// The median of at least one body, left and right alike.
fn median_body(bodies: &[&HumanBody]) -> HumanBody {
    let offsets_m = symmetric(&std::array::from_fn(|joint| median_vector(bodies, |body| body.offsets_m[joint])));
    let segment_ends_m =
        symmetric(&std::array::from_fn(|joint| median_vector(bodies, |body| body.segment_ends_m[joint])));
    let soles_m = median_feet(bodies, |body| body.soles_m);
    // All feet are measured alike: on the sole where every clip shows it, else at the joints of the clips that do not.
    let at_joints: Vec<&HumanBody> = bodies.iter().copied().filter(|body| body.measured_m != body.soles_m).collect();
    let measured_m = if at_joints.is_empty() { soles_m } else { median_feet(&at_joints, |body| body.measured_m) };
    let shows_toe_ends = [0, 1].map(|side| bodies.iter().all(|body| body.shows_toe_ends[side]));
    HumanBody { offsets_m, segment_ends_m, soles_m, measured_m, shows_toe_ends }
}

/// Median of each component of a vector.
fn median_vector(bodies: &[&HumanBody], vector: impl Fn(&HumanBody) -> DVec3) -> DVec3 {
    let component = |axis: usize| median(bodies.iter().map(|body| vector(body)[axis]));
    DVec3::from_array([0, 1, 2].map(|axis| component(axis).expect("there is at least one body")))
}

/// Each vector averaged with its mirror image.
fn symmetric(vectors: &[DVec3; JOINT_COUNT]) -> [DVec3; JOINT_COUNT] {
    std::array::from_fn(|index| 0.5 * (vectors[index] + MIRROR * vectors[Joint::ALL[index].mirrored().index()]))
}

/// Median points of both feet, each averaged with its mirror image.
fn median_feet(bodies: &[&HumanBody], points: impl Fn(&HumanBody) -> [[DVec3; 3]; 2]) -> [[DVec3; 3]; 2] {
    let median = |side: usize, point: usize| median_vector(bodies, |body| points(body)[side][point]);
    [0, 1].map(|side| [0, 1, 2].map(|point| 0.5 * (median(side, point) + MIRROR * median(1 - side, point))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::rig_head::RigHead;
    use crate::synthetic::{self, SyntheticWalk};

    #[test]
    fn one_performer_keeps_its_bones() {
        let clips = [synthetic::walk("a", SyntheticWalk::default()), synthetic::idle("b", 1.0)];
        assert_eq!(target_body(&clips), Some(clips[0].body.clone()));
        assert_eq!(target_body(&[]), None);
    }

    /// Clips of performers, each of a size (m of leg over .84) and with a number of clips, the first one the longest.
    fn clips_of(performers: &[(f64, usize)]) -> Vec<HumanClip> {
        let clip = |size: f64, index: usize| {
            let duration_s = 1.0 / (1 + index) as f64;
            let mut clip = synthetic::walk("walk", SyntheticWalk { size, duration_s, ..SyntheticWalk::default() });
            let rig = Rig { names: vec![format!("{size}")], lengths: Vec::new() };
            clip.rig_head =
                Some(RigHead { rig, offset: glam::DQuat::IDENTITY, rest_offset: None, rest_up: String::new() });
            // Each clip shows its performer's bones a little otherwise.
            clip.body.offsets_m.iter_mut().for_each(|offset_m| *offset_m *= 1.0 + 1e-4 * index as f64);
            clip
        };
        performers.iter().flat_map(|&(size, count)| (0..count).map(move |index| clip(size, index))).collect()
    }

    #[test]
    fn each_performer_counts_once_by_its_longest_clips() {
        let leg_m = |clips: &[HumanClip]| target_body(clips).unwrap().leg_length_m();
        let few = clips_of(&[(1.0, 1), (1.1, 1), (0.9, 9)]);
        assert!((leg_m(&few) - 0.84).abs() < 1e-9);
        let many = clips_of(&[(1.0, 6)]);
        assert!((leg_m(&many) - 0.84 * 1.0002).abs() < 1e-9);
        assert_eq!(target_body(&many), target_body(&clips_of(&[(1.0, 60)])));
        assert_eq!(target_body(&many), target_body(&clips_of(&[(1.0, 61)])));
    }

    #[test]
    fn giants_and_toys_do_not_count() {
        let clips = [1.0, 1.1, 0.9, 3.0, 0.3]
            .map(|size| synthetic::walk("walk", SyntheticWalk { size, duration_s: 0.1, ..SyntheticWalk::default() }));
        let leg_m = |clips: &[HumanClip]| target_body(clips).unwrap().leg_length_m();
        assert!((leg_m(&clips) - 0.84).abs() < 1e-9);
        assert!((leg_m(&clips[3..4]) - 2.52).abs() < 1e-9);
    }
}
