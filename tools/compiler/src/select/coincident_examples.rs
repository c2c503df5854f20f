//! Examples that all but coincide in (v_f, ω_t, ω_s): one of them is a corner of the blend space and is played in the
//! others' place.

use glam::Vec3;
use motiondb::blend_space::BlendSpace;
use motiondb::blend_space::triangulation::build;
use motiondb::motion::Parameters;

/// The simplices over the `parameters` of examples; of twins the one with the fewest `flaws` is the corner, not the
/// first.
pub(crate) fn build_of_best(parameters: &[Parameters], flaws: &[f64]) -> BlendSpace {
    let space = build(parameters);
    let mut order: Vec<usize> = (0..parameters.len()).collect();
    for [twin, corner] in twins(parameters, &space) {
        if flaws[twin] < flaws[order[corner]] {
            order.swap(twin, corner);
        }
    }
    if order.is_sorted() {
        return space;
    }
    // The better takes the other's place while the set is triangulated.
    let best = build(&order.iter().map(|&example| parameters[example]).collect::<Vec<_>>());
    let mut simplices: Vec<Vec<u32>> = best.simplices().map(|corners| in_place(corners, &order)).collect();
    simplices.sort_unstable();
    BlendSpace { simplices: simplices.concat(), ..best }
}

/// Corners by the examples that stand in their places.
fn in_place(corners: &[u32], order: &[usize]) -> Vec<u32> {
    let mut examples: Vec<u32> = corners.iter().map(|&corner| order[corner as usize] as u32).collect();
    examples.sort_unstable();
    examples
}

/// Examples that are no corner, each with the corner that is played in its place.
pub(crate) fn twins(parameters: &[Parameters], space: &BlendSpace) -> Vec<[usize; 2]> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters(points: &[[f32; 3]]) -> Vec<Parameters> {
        points.iter().map(|&point| Parameters::from_vec3(Vec3::from(point))).collect()
    }

    #[test]
    fn of_twins_one_is_a_corner_and_the_other_is_told() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.001, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]];
        let parameters = parameters(&points);
        let space = build(&parameters);
        assert_eq!(space.simplices.len(), 3);
        assert_eq!(twins(&parameters, &space), [[1, 2], [4, 0]]);
    }

    #[test]
    fn of_twins_the_one_with_the_fewest_flaws_is_the_corner() {
        let points =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
        let parameters = parameters(&points);
        let best = build_of_best(&parameters, &[0.5, 0.1, 0.2, 0.1, 0.4, 0.3]);
        assert_eq!(best.simplices, [1, 3, 5]);
        assert_eq!(twins(&parameters, &best), [[0, 5], [2, 1], [4, 5]]);
        assert_eq!(build_of_best(&parameters, &[0.0; 6]), build(&parameters));
    }
}
