//! The examples' parameters as whole numbers, where every question of side is decided exactly.
//!
//! Each axis of (v_f, ω_t, ω_s) is divided by its range over the examples and rounded to 2⁻²⁰ of it. The compiler
//! builds its simplices on these points, and [`crate::blend_space::tiling`] proves them there: no rounding, no tolerance. An axis
//! without range is dropped; a set that lies flat within a gait's noise counts as flat, and is seen along the axis that
//! it leans on least, so that points off the flat stand in it.

use glam::DVec3;

use crate::motion::parameters::Parameters;

/// Whole numbers to an axis's range: finer than an `f32` far from 0. Determinants of four lifted points stay below
/// 2¹²⁷.
const STEPS: f64 = (1 << 20) as f64;
/// Differences below these are no range: what the compiler's snapping takes for a gait's noise, m/s, rad/s (3 °/s),
/// m/s.
pub(crate) const LEAST_RANGES: [f32; 3] = [0.05, 0.0524, 0.1];
/// A set that is nowhere thicker than this part of an axis's range is flat: some centimetres a second.
pub(crate) const FLAT_SHARE: f32 = 0.02;
/// Examples nearer than 2⁻⁹ of a range are twins: one is a corner for both, for between them a blend would jump. So an
/// example that is no corner may lie this far outside the hull of the corners.
pub(crate) const TWIN_STEPS: f64 = STEPS / 512.0;

/// A point in whole numbers; coordinates beyond the dimension are 0.
pub type LatticePoint = [i64; 3];

/// The examples of a blend space on the lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// 0 (one point) to 3.
    pub dimension: usize,
    /// As in [`crate::blend_space::space::BlendSpace`].
    pub axis_ranges: [f32; 3],
    /// Of each example, in the axes that span the set: `dimension` coordinates from 0 to about 2²⁰.
    pub points: Vec<LatticePoint>,
    /// Squared distance of each example from the axes' least values, over all three axes.
    pub lifts: Vec<i64>,
    /// `dimension + 1` examples that span the set: a simplex with volume, as large as a greedy choice finds.
    pub span: Vec<usize>,
}

impl Lattice {
    /// None where a parameter is not finite, or out of all bounds.
    pub fn new(parameters: &[Parameters]) -> Option<Self> {
        let least = parameters.iter().map(|at| at.to_vec3()).reduce(|a, b| a.min(b))?;
        let axis_ranges = axis_ranges(parameters)?;
        let whole = |at: &Parameters| -> [i64; 3] {
            std::array::from_fn(|axis| match axis_ranges[axis] {
                0.0 => 0,
                range => {
                    let above = f64::from(at.to_vec3()[axis]) - f64::from(least[axis]);
                    libm::round(above / f64::from(range) * STEPS) as i64
                }
            })
        };
        let all: Vec<[i64; 3]> = parameters.iter().map(whole).collect();
        let (span, directions) = spanning_simplex(&all);
        let axes = spanning_axes(&directions);
        let seen = |point: &[i64; 3]| std::array::from_fn(|k| axes.get(k).map_or(0, |&axis| point[axis]));
        Some(Self {
            dimension: axes.len(),
            axis_ranges,
            points: all.iter().map(seen).collect(),
            lifts: all.iter().map(|point| point.iter().map(|x| x * x).sum()).collect(),
            span,
        })
    }
}

/// Range of each axis over the examples, 0 where it is no more than noise; none where it is not finite.
fn axis_ranges(parameters: &[Parameters]) -> Option<[f32; 3]> {
    let points = || parameters.iter().map(|at| at.to_vec3());
    let ranges = points().reduce(|a, b| a.max(b))? - points().reduce(|a, b| a.min(b))?;
    let kept = |axis: usize| if ranges[axis] >= LEAST_RANGES[axis] { ranges[axis] } else { 0.0 };
    (points().all(|point| point.is_finite()) && ranges.is_finite()).then(|| std::array::from_fn(kept))
}

/// Points that hold all others between them but for noise, each the farthest from the flat of those before it, and
/// orthonormal directions of that flat.
fn spanning_simplex(points: &[[i64; 3]]) -> (Vec<usize>, Vec<DVec3>) {
    let offset = |index: usize| DVec3::from_array(std::array::from_fn(|k| (points[index][k] - points[0][k]) as f64));
    let (mut span, mut directions) = (vec![0], Vec::<DVec3>::new());
    while directions.len() < 3 {
        let off_flat = |index| directions.iter().fold(offset(index), |off, along| off.reject_from_normalized(*along));
        // Backwards, for of equals the last is taken.
        let offs = (0..points.len()).rev().map(|index| (index, off_flat(index)));
        match offs.max_by(|(_, a), (_, b)| a.length_squared().total_cmp(&b.length_squared())) {
            Some((index, off)) if off.length() > STEPS * f64::from(FLAT_SHARE) => {
                span.push(index);
                directions.push(off.normalize());
            }
            _ => break,
        }
    }
    (span, directions)
}

/// As many axes as there are orthonormal directions, ascending: the flat of the directions is seen along those that it
/// leans on least.
fn spanning_axes(directions: &[DVec3]) -> Vec<usize> {
    let steepest = |of: DVec3| (0..3).max_by(|&a, &b| of[a].abs().total_cmp(&of[b].abs()));
    match *directions {
        [] => Vec::new(),
        [along] => steepest(along).into_iter().collect(),
        [a, b] => (0..3).filter(|&axis| Some(axis) != steepest(a.cross(b))).collect(),
        _ => vec![0, 1, 2],
    }
}

/// Length, twice the area or six times the volume of a simplex of one to four corners, signed: positive where they turn
/// counter-clockwise. Axes beyond its dimension count as unit edges, so that one formula serves all.
pub(crate) fn signed_volume(corners: &[LatticePoint]) -> i128 {
    let mut edges: [LatticePoint; 3] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    for (edge, corner) in edges.iter_mut().zip(&corners[1..]) {
        *edge = std::array::from_fn(|axis| corner[axis] - corners[0][axis]);
    }
    let [a, b, c] = edges;
    let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    normal.iter().zip(&c).map(|(&n, &x)| i128::from(n) * i128::from(x)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn dimension(points: &[[f32; 3]]) -> usize {
        let parameters: Vec<Parameters> = points.iter().map(|&at| Parameters::from_vec3(Vec3::from(at))).collect();
        Lattice::new(&parameters).unwrap().dimension
    }

    #[test]
    fn noise_spans_no_dimension_along_any_direction() {
        assert_eq!(dimension(&[[1.0, 2.0, 3.0]; 3]), 0);
        assert_eq!(dimension(&[[1.0, 0.0, 0.0], [1.04, 0.05, 0.09]]), 0);
        assert_eq!(dimension(&[[0.0, 0.0, 0.0], [1.0, 1.0, 0.3], [2.0, 2.02, 0.61], [3.0, 2.99, 0.9]]), 1);
        let tilted = |k: usize| [(k % 3) as f32, (k / 3) as f32, 0.7 * (k % 3) as f32 + 0.4 * (k / 3) as f32];
        let noisy = |k: usize| tilted(k).map(|x| x + 0.01 * libm::sinf(7.0 * k as f32 + x));
        assert_eq!(dimension(&(0..9).map(noisy).collect::<Vec<_>>()), 2);
        let bent = |k: usize| [tilted(k)[0], tilted(k)[1], tilted(k)[2] + if k == 4 { 0.5 } else { 0.0 }];
        assert_eq!(dimension(&(0..9).map(bent).collect::<Vec<_>>()), 3);
    }

    #[test]
    fn what_is_not_finite_has_no_lattice() {
        for wrong in [f32::NAN, f32::INFINITY] {
            let parameters = [0.0, wrong].map(|speed_mps| Parameters { speed_mps, ..Parameters::default() });
            assert_eq!(Lattice::new(&parameters), None);
        }
        let huge = [f32::MAX, f32::MIN].map(|speed_mps| Parameters { speed_mps, ..Parameters::default() });
        assert_eq!(Lattice::new(&huge), None);
        assert_eq!(Lattice::new(&[]), None);
    }

    #[test]
    fn volumes_are_signed_in_every_dimension() {
        let corner = |x, y, z| [x, y, z];
        assert_eq!(signed_volume(&[corner(5, 0, 0)]), 1);
        assert_eq!(signed_volume(&[corner(5, 0, 0), corner(2, 0, 0)]), -3);
        assert_eq!(signed_volume(&[corner(0, 0, 0), corner(2, 0, 0), corner(0, 3, 0)]), 6);
        assert_eq!(signed_volume(&[corner(0, 0, 0), corner(0, 3, 0), corner(2, 0, 0), corner(9, 9, 4)]), -24);
    }
}
