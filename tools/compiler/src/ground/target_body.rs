//! The body that all examples of a database share.
//!
//! One performer keeps its proportions. For several, the median is used, bone by bone, left and right alike, so that
//! mirrored cycles fit (definition "Target skeleton" of `docs/definitions.md`). Rest pose and frames are those of
//! [`motiondb::body::Skeleton`]: metres.

use glam::DVec3;
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::statistics::median;

use crate::retarget::human_clip::{HumanBody, HumanClip};

/// Thigh plus shank of adults, small woman to tall man, m. Other bodies are toys or giants and do not count.
const HUMAN_LEG_M: std::ops::RangeInclusive<f64> = 0.65..=1.05;

/// The plane y = 0 as a mirror.
const MIRROR: DVec3 = DVec3::new(1.0, -1.0, 1.0);

/// The body of the clip that a manifest chose, else the median of the human-sized performers, else of all; `None`
/// without clips.
pub(crate) fn target_body(clips: &[HumanClip]) -> Option<HumanBody> {
    let is_human = |clip: &&HumanClip| HUMAN_LEG_M.contains(&clip.body.leg_length_m());
    let bodies_of = |counts: &dyn Fn(&&HumanClip) -> bool| -> Vec<&HumanBody> {
        clips.iter().filter(counts).map(|clip| &clip.body).collect()
    };
    let candidates = [bodies_of(&|clip| clip.choices.is_target_skeleton), bodies_of(&is_human), bodies_of(&|_| true)];
    candidates.into_iter().find(|bodies| !bodies.is_empty()).map(|bodies| median_body(&bodies))
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
    HumanBody { offsets_m, segment_ends_m, soles_m, measured_m }
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
    use crate::synthetic::{self, SyntheticWalk};

    #[test]
    fn one_performer_keeps_its_bones() {
        let clips = [synthetic::walk("a", SyntheticWalk::default()), synthetic::idle("b", 1.0)];
        assert_eq!(target_body(&clips), Some(clips[0].body.clone()));
        assert_eq!(target_body(&[]), None);
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
