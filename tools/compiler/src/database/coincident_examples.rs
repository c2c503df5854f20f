//! Coincident examples: examples that all but coincide in (v_f, ω_t, ω_s).
//!
//! Only one of them is a corner of the blend space; it is blended in place of the others. Distances in the blend space:
//! each axis divided by its range ([`BlendSpace::scaled`]).

use glam::Vec3;
use motiondb::blend_space::BlendSpace;
use motiondb::blend_space::triangulation::build;
use motiondb::diagnostic::{Diagnostic, Note};
use motiondb::motion::{Parameters, SourceRecord};

use crate::retarget::human_clip::HumanBody;
use crate::select::named_cycles::NamedCycle;

/// Mean distance of the joints from which on two cycles of equal parameters differ in manner, m.
const OTHER_MANNER_M: f64 = 0.06;

/// The blend space over the `parameters` of examples; of coincident examples the one with the fewest `flaws` is the
/// corner, not the first.
pub(crate) fn blend_space_of_best(parameters: &[Parameters], flaws: &[f64]) -> BlendSpace {
    let space = build(parameters);
    let pairs = coincident_pairs(parameters, &space);
    // The best example of each corner and those that coincide with it.
    let mut best: Vec<usize> = (0..parameters.len()).collect();
    for &[other, corner] in &pairs {
        if flaws[other] < flaws[best[corner]] {
            best[corner] = other;
        }
    }
    for &[other, corner] in &pairs {
        best[other] = best[corner];
    }
    if pairs.iter().all(|[_, corner]| best[*corner] == *corner) {
        return space;
    }
    // All of them have its parameters: else a corner could be the one that lies farther out by a hair.
    let of_best = build(&best.iter().map(|&example| parameters[example]).collect::<Vec<_>>());
    if of_best.dimension != space.dimension {
        return space; // only a hair made the set as wide as it is
    }
    let mut simplices: Vec<Vec<u32>> = of_best.simplices().map(|corners| best_corners(corners, &best)).collect();
    simplices.sort_unstable();
    BlendSpace { simplices: simplices.concat(), ..space }
}

/// Sorted indices of the examples that stand for some corners.
fn best_corners(corners: &[u32], best: &[usize]) -> Vec<u32> {
    let mut examples: Vec<u32> = corners.iter().map(|&corner| best[corner as usize] as u32).collect();
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
        let distance_m = unused.cycle.distance_m(&blended.cycle, body);
        let note = if distance_m > OTHER_MANNER_M {
            Note::CoincidentManners { example, blended: other, distance_cm: (100.0 * distance_m) as f32 }
        } else {
            Note::CoincidentExample { example, blended: other }
        };
        sources[unused.source as usize].diagnostics.push(Diagnostic::Note(note));
    }
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

    #[test]
    fn the_least_flawed_is_the_corner_also_where_others_lie_farther_out() {
        for off_mps in [-0.0015, -0.001, 0.0, 0.001, 0.0015] {
            let points = [[1.0 + off_mps, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.6, 0.5, 0.0]];
            for best in [0, 2] {
                let flaws: [f64; 4] = std::array::from_fn(|index| if index == best { 0.0 } else { 1.0 });
                let space = blend_space_of_best(&parameters(&points), &flaws);
                assert!(space.simplices.contains(&(best as u32)), "{off_mps} {best}: {:?}", space.simplices);
                assert!(!space.simplices.contains(&(2 - best as u32)), "{off_mps} {best}: {:?}", space.simplices);
            }
        }
    }
}
