//! Coincident examples: examples that all but coincide in (v_f, ω_t, ω_s).
//!
//! Only one of them is a corner of the blend space; it is blended in place of the others. Distances in the blend space:
//! each axis divided by its range ([`BlendSpace::scaled`]).

use glam::Vec3;
use motiondb::blend_space::BlendSpace;
use motiondb::blend_space::triangulation::build;
use motiondb::diagnostic::{Diagnostic, Note};
use motiondb::motion::{Parameters, SourceRecord};
use motiondb::statistics::mean;

use crate::cycle::gait_cycle::GaitCycle;
use crate::retarget::human_clip::{HumanBody, HumanPose};
use crate::select::named_cycles::NamedCycle;

/// Mean distance of the joints from which on two cycles of equal parameters differ in manner, m.
const OTHER_MANNER_M: f64 = 0.06;

/// The blend space over the `parameters` of examples; of coincident examples the one with the fewest `flaws` is the
/// corner, not the first.
pub(crate) fn blend_space_of_best(parameters: &[Parameters], flaws: &[f64]) -> BlendSpace {
    let space = build(parameters);
    let mut order: Vec<usize> = (0..parameters.len()).collect();
    for [other, corner] in coincident_pairs(parameters, &space) {
        if flaws[other] < flaws[order[corner]] {
            order.swap(other, corner);
        }
    }
    if order.is_sorted() {
        return space;
    }
    // For the triangulation the better example takes the index of the other.
    let best = build(&order.iter().map(|&example| parameters[example]).collect::<Vec<_>>());
    let mut simplices: Vec<Vec<u32>> = best.simplices().map(|corners| original_indices(corners, &order)).collect();
    simplices.sort_unstable();
    BlendSpace { simplices: simplices.concat(), ..best }
}

/// Sorted indices of the examples that stand at some corners of a reordered set.
fn original_indices(corners: &[u32], order: &[usize]) -> Vec<u32> {
    let mut examples: Vec<u32> = corners.iter().map(|&corner| order[corner as usize] as u32).collect();
    examples.sort_unstable();
    examples
}

/// Every example that is not a corner, with the nearest corner, which is blended in its place.
pub(crate) fn coincident_pairs(parameters: &[Parameters], space: &BlendSpace) -> Vec<[usize; 2]> {
    let scaled = |index: usize| -> Vec3 { space.scaled(parameters[index]) };
    let mut is_corner = vec![false; parameters.len()];
    space.simplices.iter().for_each(|&corner| is_corner[corner as usize] = true);
    let nearest = |index: usize| {
        let distance = |corner: usize| scaled(corner).distance_squared(scaled(index));
        let corners = (0..parameters.len()).filter(|&corner| is_corner[corner]);
        corners.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).map(|corner| [index, corner])
    };
    (0..parameters.len()).filter(|&index| !is_corner[index]).filter_map(nearest).collect()
}

/// Adds a note to the source of each recorded example that another one is blended for: whether both move alike, by the
/// mean distance of their joints.
pub(crate) fn note_coincident(
    pairs: &[[usize; 2]],
    cycles: &[NamedCycle],
    body: &HumanBody,
    sources: &mut [SourceRecord],
) {
    let pairs = pairs.iter().map(|pair| pair.map(|index| &cycles[index]));
    for [unused, blended] in pairs.filter(|[unused, _]| !unused.mirrored) {
        let (example, other) = (unused.name.clone(), blended.name.clone());
        let distance_m = distance_m(&unused.cycle, &blended.cycle, body);
        let note = if distance_m > OTHER_MANNER_M {
            Note::CoincidentManners { example, blended: other, distance_cm: (100.0 * distance_m) as f32 }
        } else {
            Note::CoincidentExample { example, blended: other }
        };
        sources[unused.source as usize].diagnostics.push(Diagnostic::Note(note));
    }
}

/// Mean distance of the joints of two cycles at equal phases, m.
fn distance_m(one: &GaitCycle, other: &GaitCycle, body: &HumanBody) -> f64 {
    let joints = |pose: &HumanPose| pose.forward_kinematics(body);
    let distances = one.rows.iter().zip(&other.rows).map(|(a, b)| joints(a).mean_distance_m(&joints(b)));
    mean(distances).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters(points: &[[f32; 3]]) -> Vec<Parameters> {
        points.iter().map(|&point| Parameters::from_vec3(Vec3::from(point))).collect()
    }

    #[test]
    fn of_coincident_examples_one_is_a_corner() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.001, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]];
        let parameters = parameters(&points);
        let space = build(&parameters);
        assert_eq!(space.simplices.len(), 3);
        assert_eq!(coincident_pairs(&parameters, &space), [[1, 2], [4, 0]]);
    }

    #[test]
    fn the_least_flawed_of_coincident_examples_is_the_corner() {
        let points =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
        let parameters = parameters(&points);
        let best = blend_space_of_best(&parameters, &[0.5, 0.1, 0.2, 0.1, 0.4, 0.3]);
        assert_eq!(best.simplices, [1, 3, 5]);
        assert_eq!(coincident_pairs(&parameters, &best), [[0, 5], [2, 1], [4, 5]]);
        assert_eq!(blend_space_of_best(&parameters, &[0.0; 6]), build(&parameters));
    }
}
