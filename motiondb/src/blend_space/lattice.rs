//! The examples' parameters as whole numbers: on them every geometric predicate is exact.
//!
//! Enters: (v_f, ω_t, ω_s) of each example. Leaves: points of a lattice. Each axis is divided by its range over the
//! examples and rounded to 2⁻²⁰ of it. `triangulation` builds the simplices on these points, and `tiling` proves them
//! there, both without rounding or tolerance.
//!
//! An axis without range is dropped. A set that is flat within gait noise counts as flat: it is projected along the
//! axis nearest to its normal.

use glam::DVec3;

use crate::motion::parameters::Parameters;

/// Lattice steps in an axis's range: finer than `f32` far from 0. Determinants of four lifted points stay below 2¹²⁷.
const STEPS: f64 = (1 << 20) as f64;
/// Least range that an axis must have, m/s, rad/s (3 °/s), m/s: below is gait noise, which the compiler's snapping sets
/// to 0.
pub(crate) const LEAST_RANGES: [f32; 3] = [0.05, 0.0524, 0.1];
/// Greatest thickness of a flat set, as a share of an axis's range: a few centimetres per second.
pub(crate) const FLAT_SHARE: f32 = 0.02;
/// Distance up to which two examples coincide, lattice steps: 2⁻⁹ of a range. Between them a blend would jump, so only
/// one is a corner; the other may lie this far outside the hull of the corners.
pub(crate) const COINCIDENT_STEPS: f64 = STEPS / 512.0;

/// A point of the lattice. Coordinates beyond the dimension are 0.
pub(crate) type LatticePoint = [i64; 3];

/// The examples of a blend space, on the lattice.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lattice {
    /// Number of dimensions that the examples span: 0 (one point) to 3.
    pub(crate) dimension: usize,
    /// Range of each axis over the examples, m/s, rad/s, m/s; 0 for a dropped axis.
    pub(crate) axis_ranges: [f32; 3],
    /// Each example in the axes that span the set: `dimension` coordinates from 0 to about 2²⁰.
    pub(crate) points: Vec<LatticePoint>,
    /// Squared distance of each example from the axes' least values, over all three axes.
    pub(crate) lifts: Vec<i64>,
    /// `dimension + 1` examples that span the set: a simplex with volume, as large as a greedy choice finds.
    pub(crate) span: Vec<usize>,
}

impl Lattice {
    /// The lattice of the examples' parameters; `None` without examples, or if a parameter is not finite or far too
    /// large.
    pub(crate) fn new(parameters: &[Parameters]) -> Option<Self> {
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
        let projected = |point: &[i64; 3]| std::array::from_fn(|k| axes.get(k).map_or(0, |&axis| point[axis]));
        Some(Self {
            dimension: axes.len(),
            axis_ranges,
            points: all.iter().map(projected).collect(),
            lifts: all.iter().map(|point| point.iter().map(|x| x * x).sum()).collect(),
            span,
        })
    }
}

/// Range of each axis over the examples, 0 within noise; `None` if a range or a parameter is not finite.
fn axis_ranges(parameters: &[Parameters]) -> Option<[f32; 3]> {
    let points = || parameters.iter().map(|at| at.to_vec3());
    let ranges = points().reduce(|a, b| a.max(b))? - points().reduce(|a, b| a.min(b))?;
    let kept = |axis: usize| if ranges[axis] >= LEAST_RANGES[axis] { ranges[axis] } else { 0.0 };
    (points().all(|point| point.is_finite()) && ranges.is_finite()).then(|| std::array::from_fn(kept))
}

/// A simplex of points that spans the set except for noise, and orthonormal directions of its span. Each point is the
/// farthest from the span of those before it.
fn spanning_simplex(points: &[[i64; 3]]) -> (Vec<usize>, Vec<DVec3>) {
    let offset = |index: usize| DVec3::from_array(std::array::from_fn(|k| (points[index][k] - points[0][k]) as f64));
    let (mut span, mut directions) = (vec![0], Vec::<DVec3>::new());
    while directions.len() < 3 {
        let off_span = |index| directions.iter().fold(offset(index), |off, along| off.reject_from_normalized(*along));
        // Reversed: `max_by` returns the last of equals, and here the first must win.
        let offs = (0..points.len()).rev().map(|index| (index, off_span(index)));
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

/// The axes, ascending, onto which a set with these orthonormal directions is projected: as many as there are
/// directions.
fn spanning_axes(directions: &[DVec3]) -> Vec<usize> {
    let steepest = |of: DVec3| (0..3).max_by(|&a, &b| of[a].abs().total_cmp(&of[b].abs()));
    match *directions {
        [] => Vec::new(),
        [along] => steepest(along).into_iter().collect(),
        [a, b] => (0..3).filter(|&axis| Some(axis) != steepest(a.cross(b))).collect(),
        _ => vec![0, 1, 2],
    }
}

/// Signed length, twice the area or six times the volume of a simplex of one to four corners: positive if they turn
/// counter-clockwise. Missing edges are unit vectors of the further axes, so one formula serves all dimensions.
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
    fn noise_spans_no_dimension() {
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
    fn parameters_that_are_not_finite_have_no_lattice() {
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
