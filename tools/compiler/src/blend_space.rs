//! Exact simplices over the examples' parameters (`FbCrowd` §5; `definitions.md`, "Axes").
//!
//! Delaunay in one to three dimensions: points are quantised to whole numbers and lifted to h = |x|²·2²⁰ + noise, noise
//! one of 2¹⁶ numbers drawn from the point's index; a simplex belongs where its lifted plane lies below all other
//! points. In whole numbers of 128 bits every decision is exact; the noise breaks the ties of grids and circles, so the
//! simplices of any set fit together without gap or overlap. The *upper* hull of the same lifted points fills the same
//! convex hull with other simplices: the two volumes must agree.

use glam::Vec3;
use motiondb::blend_space::BlendSpace;
use motiondb::motion_db::MotionExample;

/// Whole numbers to an axis's range: 0.1 % of a range is below what a gait repeats.
const STEPS: f64 = 1024.0;
/// An axis whose values differ by less has no range: rounding, not motion (m/s, rad/s).
const LEAST_RANGE: f32 = 1e-3;
/// |x|² is lifted this far above the noise.
const LIFT: i128 = 1 << 20;

/// A quantised point, its lift last.
type Lifted = [i128; 4];

/// Triangulates the examples' parameters in as many dimensions as they span; coincident examples keep the first.
pub fn build(examples: &[MotionExample]) -> BlendSpace {
    let parameters: Vec<Vec3> = examples.iter().map(|example| example.parameters.to_vec3()).collect();
    let axis_ranges = axis_ranges(&parameters);
    let (indices, points) = quantised(&parameters, axis_ranges);
    let axes = spanning_axes(&points);
    let lifted: Vec<Lifted> = points.iter().zip(&indices).map(|(point, &index)| lift(point, &axes, index)).collect();
    let lower = lifted_hull(&lifted, axes.len(), -1);
    let upper = lifted_hull(&lifted, axes.len(), 1);
    BlendSpace {
        dimension: axes.len() as u32,
        axis_ranges,
        simplices: lower.iter().flatten().map(|&corner| indices[corner]).collect(),
        covered_share: (volume(&lower, &lifted, axes.len()) / volume(&upper, &lifted, axes.len())) as f32,
    }
}

fn axis_ranges(parameters: &[Vec3]) -> [f32; 3] {
    let least = parameters.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let greatest = parameters.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    (greatest - least).to_array().map(|range| if range >= LEAST_RANGE { range } else { 0.0 })
}

/// Distinct points in whole numbers and the example each stands for.
fn quantised(parameters: &[Vec3], ranges: [f32; 3]) -> (Vec<u32>, Vec<[i128; 3]>) {
    let (mut indices, mut points) = (Vec::new(), Vec::<[i128; 3]>::new());
    for (index, parameters) in parameters.iter().enumerate() {
        let axis = |k: usize| match ranges[k] {
            0.0 => 0,
            range => libm::round(f64::from(parameters[k]) / f64::from(range) * STEPS) as i128,
        };
        let point = [axis(0), axis(1), axis(2)];
        if !points.contains(&point) {
            indices.push(index as u32);
            points.push(point);
        }
    }
    (indices, points)
}

/// Axes onto which the points project without losing a dimension: as many as the points span.
fn spanning_axes(points: &[[i128; 3]]) -> Vec<usize> {
    const CANDIDATES: [&[usize]; 7] = [&[0, 1, 2], &[0, 1], &[0, 2], &[1, 2], &[0], &[1], &[2]];
    let spans = |axes: &&&[usize]| simplex_among(points, axes).is_some();
    CANDIDATES.iter().find(spans).map_or_else(Vec::new, |axes| axes.to_vec())
}

/// Some points that span the axes, found greedily: one more each time the rank grows.
fn simplex_among(points: &[[i128; 3]], axes: &[usize]) -> Option<Vec<usize>> {
    let mut corners = vec![0];
    for candidate in 1..points.len() {
        let edges: Vec<[i128; 3]> = corners[1..]
            .iter()
            .chain([&candidate])
            .map(|&corner: &usize| {
                std::array::from_fn(|k| axes.get(k).map_or(0, |&axis| points[corner][axis] - points[0][axis]))
            })
            .collect();
        if independent(&edges) {
            corners.push(candidate);
        }
        if corners.len() == axes.len() + 1 {
            return Some(corners);
        }
    }
    None
}

fn independent(edges: &[[i128; 3]]) -> bool {
    match edges {
        [a] => a.iter().any(|&x| x != 0),
        [a, b] => cross(a, b).iter().any(|&x| x != 0),
        [a, b, c] => dot(&cross(a, b), c) != 0,
        _ => false,
    }
}

fn cross(a: &[i128; 3], b: &[i128; 3]) -> [i128; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &[i128; 3], b: &[i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The point in its spanning axes (the others 0), with its height as last coordinate.
fn lift(point: &[i128; 3], axes: &[usize], index: u32) -> Lifted {
    let [x, y, z] = std::array::from_fn(|k| axes.get(k).map_or(0, |&axis| point[axis]));
    [x, y, z, (x * x + y * y + z * z) * LIFT + noise(index)]
}

/// One of 2¹⁶ numbers (the 32-bit finaliser of MurmurHash3). A linear hash would leave every parallelogram of a grid
/// tied.
fn noise(index: u32) -> i128 {
    let mut bits = index.wrapping_add(1);
    bits = (bits ^ (bits >> 16)).wrapping_mul(0x85eb_ca6b);
    bits = (bits ^ (bits >> 13)).wrapping_mul(0xc2b2_ae35);
    i128::from((bits ^ (bits >> 16)) & 0xffff)
}

/// Sets of `dimension + 1` points whose lifted plane has all other points on one side: −1 none below it, 1 none above.
fn lifted_hull(points: &[Lifted], dimension: usize, side: i128) -> Vec<Vec<usize>> {
    if dimension == 0 {
        return vec![vec![0]];
    }
    let mut simplices = Vec::new();
    let mut corners: Vec<usize> = (0..=dimension).collect();
    loop {
        if supports(points, &corners, side) {
            simplices.push(corners.clone());
        }
        if !next_combination(&mut corners, points.len()) {
            return simplices;
        }
    }
}

/// The next ascending choice of indices below `count`.
fn next_combination(corners: &mut [usize], count: usize) -> bool {
    let chosen = corners.len();
    let Some(place) = (0..chosen).rev().find(|&place| corners[place] < count - chosen + place) else { return false };
    corners[place] += 1;
    for later in place + 1..chosen {
        corners[later] = corners[later - 1] + 1;
    }
    true
}

/// Whether no other point lies beyond the plane through the corners, seen along h.
fn supports(points: &[Lifted], corners: &[usize], side: i128) -> bool {
    let normal = plane_normal(points, corners);
    if normal[3] == 0 {
        return false; // the corners have no volume
    }
    let origin = &points[corners[0]];
    let height = |point: &Lifted| (0..4).map(|k| normal[k] * (point[k] - origin[k])).sum::<i128>() * normal[3].signum();
    points.iter().enumerate().all(|(index, point)| height(point) * side < 0 || corners.contains(&index))
}

/// Normal of the hyperplane through the corners; axes beyond the dimension are padded with unit edges, so that one
/// formula serves all.
fn plane_normal(points: &[Lifted], corners: &[usize]) -> [i128; 4] {
    let mut edges: [Lifted; 3] = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]];
    for (edge, &corner) in edges.iter_mut().zip(&corners[1..]) {
        *edge = std::array::from_fn(|axis| points[corner][axis] - points[corners[0]][axis]);
    }
    let minor = |a: usize, b: usize, c: usize| {
        let column = |axis: usize| [edges[0][axis], edges[1][axis], edges[2][axis]];
        dot(&column(a), &cross(&column(b), &column(c)))
    };
    [-minor(1, 2, 3), minor(0, 2, 3), -minor(0, 1, 3), minor(0, 1, 2)]
}

/// Sum of the simplices' volumes, in steps.
fn volume(simplices: &[Vec<usize>], points: &[Lifted], dimension: usize) -> f64 {
    if dimension == 0 {
        return 1.0;
    }
    // The last component of a simplex's plane is the determinant of its edges in the ground axes.
    simplices.iter().map(|corners| plane_normal(points, corners)[3].abs() as f64).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use motiondb::blend_space::Locator;
    use motiondb::parameters::Parameters;
    use motiondb::phase_map::PhaseMap;
    use proptest::prelude::*;

    fn example(point: [f32; 3]) -> MotionExample {
        MotionExample {
            name: String::new(),
            source: 0,
            window_s: [0.0, 1.0],
            mirrored: false,
            parameters: Parameters::from_vec3(Vec3::from(point)),
            phase_map: PhaseMap { period_s: 1.0, left_share: 0.5 },
            key_times_s: None,
            planted_slide_cm_s: 0.0,
            planted_share: 0.0,
        }
    }

    /// Every random mixture of examples must be located inside a simplex that reaches it.
    fn check_covers(points: &[[f32; 3]], dimension: u32) {
        let examples: Vec<MotionExample> = points.iter().map(|&point| example(point)).collect();
        let space = build(&examples);
        assert_eq!(space.dimension, dimension, "{points:?}");
        assert!((space.covered_share - 1.0).abs() < 1e-6, "{}", space.covered_share);
        let parameters: Vec<Parameters> = examples.iter().map(|example| example.parameters).collect();
        let locator = Locator::new(&space, &parameters);
        for start in 0..points.len() {
            let mixture = (0..points.len()).map(|k| (k, ((k * 7 + start * 13) % 11) as f32)).collect::<Vec<_>>();
            let sum: f32 = mixture.iter().map(|(_, weight)| weight).sum::<f32>().max(1.0);
            let query: Vec3 = mixture.iter().map(|&(k, weight)| Vec3::from(points[k]) * (weight / sum)).sum();
            let shares = locator.locate(Parameters::from_vec3(query));
            let reached: Vec3 =
                (0..4).map(|k| parameters[shares.examples[k] as usize].to_vec3() * shares.shares[k]).sum();
            let ranges = Vec3::from(space.axis_ranges).max(Vec3::splat(1e-3));
            assert!(((reached - query) / ranges).length() < 4e-3, "{query} became {reached}");
        }
    }

    #[test]
    fn grids_circles_and_repeats_are_covered_without_gap_or_overlap() {
        let grid = |nx: u32, ny: u32, nz: u32| {
            (0..nx * ny * nz).map(|k| [(k % nx) as f32, (k / nx % ny) as f32, (k / nx / ny) as f32]).collect::<Vec<_>>()
        };
        check_covers(&grid(3, 3, 3), 3);
        check_covers(&grid(5, 4, 1), 2);
        check_covers(&grid(6, 1, 1), 1);
        check_covers(&grid(1, 4, 1), 1);
        check_covers(&[[1.0, 2.0, 3.0]; 3], 0);
        let circle = (0..12).map(|k| (k as f32).to_radians() * 30.0).map(|angle| [angle.cos(), 0.0, angle.sin()]);
        check_covers(&circle.collect::<Vec<_>>(), 2);
        // A plane that no pair of axes holds: tilted in all three.
        let tilted = grid(3, 3, 1).into_iter().map(|[x, y, _]| [x, y, x + y]);
        check_covers(&tilted.collect::<Vec<_>>(), 2);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn any_set_of_points_is_covered(points in prop::collection::vec([-3i8..4, -3i8..4, -3i8..4], 5..14)) {
            let points: Vec<[f32; 3]> = points.iter().map(|point| point.map(f32::from)).collect();
            let space = build(&points.iter().map(|&point| example(point)).collect::<Vec<_>>());
            check_covers(&points, space.dimension);
        }
    }
}
