//! Checks from the stored data alone that the simplices of a blend space tile the convex hull of its examples
//! (`FbCrowd` §5): they are disjoint, leave no gap, and their volumes sum to the hull's.
//!
//! Points are integers on the `lattice`, so all arithmetic is exact. The steps are the same in one to three dimensions:
//!
//! 1. Every simplex has volume.
//! 2. A facet belongs to two simplices on opposite sides of it, or to one: then it is a boundary facet.
//! 3. No example lies beyond a boundary facet.
//! 4. A point of the first simplex lies in no other.
//!
//! By 3, boundary facets lie on the hull. By 2, crossing any other facet leaves one simplex and enters one, so the
//! number of simplices that hold a point is the same everywhere inside the hull. By 4 it is one.

use crate::blend_space::lattice::{COINCIDENT_STEPS, Lattice, LatticePoint, signed_volume};
use crate::blend_space::space::{BlendSpace, MAX_CORNERS};
use crate::motion::parameters::Parameters;

/// Relative tolerance of the stored ranges: the rounding of `f32`.
const RANGE_TOLERANCE: f32 = 1e-5;
/// Tolerance of `covered_share`: a quotient of volumes in `f64`, stored as `f32`.
const COVERED_TOLERANCE: f32 = 1e-6;

/// The fault of a blend space, as a text for people; `None` if its simplices tile the hull of the examples'
/// `parameters`.
pub(crate) fn tiling_fault(space: &BlendSpace, parameters: &[Parameters]) -> Option<String> {
    check_tiling(space, parameters).err()
}

/// Result of a check: an error is the fault, as a text for people.
type CheckResult = Result<(), String>;

fn check_tiling(space: &BlendSpace, parameters: &[Parameters]) -> CheckResult {
    let lattice = Lattice::new(parameters).ok_or("there are no examples, or their parameters are not finite")?;
    spans_the_examples(space, &lattice)?;
    indices_are_in_range(space, parameters.len())?;
    simplices_have_volume(space, &lattice)?;
    let boundary = boundary_facets(space, &lattice)?;
    boundary_is_convex(space, &boundary, &lattice)?;
    covers_once(space, &lattice)?;
    ensure((space.covered_share - 1.0).abs() <= COVERED_TOLERANCE, || {
        format!("the simplices cover the hull, but a covered share of {} is stored", space.covered_share)
    })
}

fn ensure(holds: bool, fault: impl FnOnce() -> String) -> CheckResult {
    if holds { Ok(()) } else { Err(fault()) }
}

fn spans_the_examples(space: &BlendSpace, lattice: &Lattice) -> CheckResult {
    ensure(space.dimension as usize == lattice.dimension, || {
        format!("{} dimensions are stored, but the examples span {}", space.dimension, lattice.dimension)
    })?;
    let mut pairs = space.axis_ranges.iter().zip(&lattice.axis_ranges);
    ensure(pairs.all(|(stored, found)| (stored - found).abs() <= RANGE_TOLERANCE * found), || {
        format!("axis ranges {:?} are stored, but the examples have {:?}", space.axis_ranges, lattice.axis_ranges)
    })
}

fn indices_are_in_range(space: &BlendSpace, examples: usize) -> CheckResult {
    let (count, corners) = (space.simplices.len(), space.dimension as usize + 1);
    ensure(count > 0 && count.is_multiple_of(corners), || {
        format!("{count} corners are stored, which is not a multiple of {corners}")
    })?;
    match space.simplices.iter().find(|&&index| index as usize >= examples) {
        Some(index) => Err(format!("a corner refers to example {index}, but the database has {examples} examples")),
        None => Ok(()),
    }
}

/// Step 1: every simplex has volume.
fn simplices_have_volume(space: &BlendSpace, lattice: &Lattice) -> CheckResult {
    let flat = space.simplices().find(|corners| oriented(corners, &lattice.points) == 0);
    ensure(flat.is_none(), || format!("the simplex of examples {:?} has no volume", flat.unwrap_or_default()))
}

/// Signed volume of the simplex of some examples.
fn oriented(corners: &[u32], points: &[LatticePoint]) -> i128 {
    let mut at = [[0; 3]; MAX_CORNERS];
    at.iter_mut().zip(corners).for_each(|(at, &corner)| *at = points[corner as usize]);
    signed_volume(&at[..corners.len()])
}

/// A facet of one simplex.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Facet {
    /// Examples at the corners, sorted.
    corners: Vec<u32>,
    /// Side of the facet on which the simplex lies: 1 or −1.
    side: i128,
}

impl Facet {
    /// Signed distance of a point from the facet, positive on the simplex's side, multiplied by the facet's size, which
    /// keeps it an integer.
    fn height(&self, point: LatticePoint, lattice: &Lattice) -> i128 {
        let mut at = [point; MAX_CORNERS];
        at.iter_mut().zip(&self.corners).for_each(|(at, &corner)| *at = lattice.points[corner as usize]);
        self.side * signed_volume(&at[..lattice.dimension + 1])
    }

    /// Signed distance of a point from the facet, positive on the simplex's side, lattice steps. Heights are linear in
    /// the point, so one step along each axis gives the facet's size.
    fn height_steps(&self, point: LatticePoint, lattice: &Lattice) -> f64 {
        let rise = |axis: usize| {
            let mut next = point;
            next[axis] += 1;
            (self.height(next, lattice) - self.height(point, lattice)) as f64
        };
        let size = (0..lattice.dimension).map(|axis| rise(axis) * rise(axis)).sum::<f64>().sqrt();
        self.height(point, lattice) as f64 / size
    }
}

/// Step 2: facets that belong to one simplex only; an error if simplices overlap at a facet.
fn boundary_facets(space: &BlendSpace, lattice: &Lattice) -> Result<Vec<Facet>, String> {
    let mut facets: Vec<Facet> = space.simplices().flat_map(|corners| facets_of(corners, lattice)).collect();
    facets.sort_unstable();
    let mut boundary = Vec::new();
    for same in facets.chunk_by(|a, b| a.corners == b.corners) {
        match same {
            [alone] => boundary.push(alone.clone()),
            [one, other] if one.side != other.side => {}
            _ => {
                let corners = &same[0].corners;
                return Err(format!("simplices overlap at the facet of examples {corners:?}"));
            }
        }
    }
    Ok(boundary)
}

fn facets_of(corners: &[u32], lattice: &Lattice) -> impl Iterator<Item = Facet> {
    corners.iter().map(|left_out| {
        let mut facet =
            Facet { corners: corners.iter().copied().filter(|corner| corner != left_out).collect(), side: 1 };
        facet.corners.sort_unstable();
        facet.side = facet.height(lattice.points[*left_out as usize], lattice).signum();
        facet
    })
}

/// Step 3: no example lies beyond a boundary facet. An example that is not a corner coincides with a corner within
/// [`COINCIDENT_STEPS`], so it may lie outside by that distance.
fn boundary_is_convex(space: &BlendSpace, boundary: &[Facet], lattice: &Lattice) -> CheckResult {
    let mut is_corner = vec![false; lattice.points.len()];
    space.simplices.iter().for_each(|&corner| is_corner[corner as usize] = true);
    for facet in boundary {
        let outside = |&index: &usize| {
            let point = lattice.points[index];
            let beyond = facet.height(point, lattice) < 0;
            beyond && (is_corner[index] || facet.height_steps(point, lattice) < -COINCIDENT_STEPS)
        };
        let outside = (0..lattice.points.len()).find(outside);
        ensure(outside.is_none(), || {
            let index = outside.unwrap_or_default();
            format!("example {index} lies outside, beyond the facet of examples {:?}", facet.corners)
        })?;
    }
    Ok(())
}

/// Step 4: the centre of the first simplex lies in no other. All points are multiplied by the number of corners, so
/// that the centre is on the lattice.
fn covers_once(space: &BlendSpace, lattice: &Lattice) -> CheckResult {
    let count = lattice.dimension as i64 + 1;
    let enlarged: Vec<LatticePoint> = lattice.points.iter().map(|point| point.map(|x| x * count)).collect();
    let first = &space.simplices[..count as usize];
    let corners = first.iter().map(|&corner| lattice.points[corner as usize]);
    let centre = corners.fold([0; 3], |sum: LatticePoint, point| std::array::from_fn(|axis| sum[axis] + point[axis]));
    let second = space.simplices().skip(1).find(|corners| holds(corners, &enlarged, centre));
    ensure(second.is_none(), || {
        format!("the simplices of examples {first:?} and {:?} overlap", second.unwrap_or_default())
    })
}

/// Whether a simplex or its boundary holds a point: seen from each facet, it lies on the side of the opposite corner.
fn holds(corners: &[u32], points: &[LatticePoint], point: LatticePoint) -> bool {
    let mut at = [[0; 3]; MAX_CORNERS];
    at.iter_mut().zip(corners).for_each(|(at, &corner)| *at = points[corner as usize]);
    let volume = signed_volume(&at[..corners.len()]);
    (0..corners.len()).all(|k| {
        let mut replaced = at;
        replaced[k] = point;
        signed_volume(&replaced[..corners.len()]) * volume.signum() >= 0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use proptest::prelude::*;

    /// A grid of boxes with a count along each axis, each cut into simplices around its main diagonal (Kuhn 1960).
    fn boxes(counts: &[u32], parameters_at: impl Fn([u32; 3]) -> [f32; 3]) -> (BlendSpace, Vec<Parameters>) {
        let side = |axis: usize| counts.get(axis).map_or(1, |count| count + 1);
        let index = |[x, y, z]: [u32; 3]| x + side(0) * (y + side(1) * z);
        let at = |index: u32| [index % side(0), index / side(0) % side(1), index / side(0) / side(1)];
        let parameters: Vec<Parameters> = (0..side(0) * side(1) * side(2))
            .map(|index| Parameters::from_vec3(Vec3::from(parameters_at(at(index)))))
            .collect();
        let paths: &[&[usize]] = match counts.len() {
            1 => &[&[0]],
            2 => &[&[0, 1], &[1, 0]],
            _ => &[&[0, 1, 2], &[0, 2, 1], &[1, 0, 2], &[1, 2, 0], &[2, 0, 1], &[2, 1, 0]],
        };
        let mut simplices = Vec::new();
        let is_box = |at: &[u32; 3]| (0..counts.len()).all(|axis| at[axis] < counts[axis]);
        for start in (0..parameters.len() as u32).map(at).filter(is_box) {
            for path in paths {
                let mut corner = start;
                simplices.push(index(corner));
                for &axis in *path {
                    corner[axis] += 1;
                    simplices.push(index(corner));
                }
            }
        }
        let axis_ranges = Lattice::new(&parameters).unwrap().axis_ranges;
        let space = BlendSpace { dimension: counts.len() as u32, axis_ranges, simplices, covered_share: 1.0 };
        (space, parameters)
    }

    fn grid(counts: &[u32]) -> (BlendSpace, Vec<Parameters>) {
        boxes(counts, |at| at.map(|x| x as f32 * 0.7))
    }

    #[test]
    fn boxes_in_every_dimension_are_tiled() {
        for counts in [&[1][..], &[5], &[1, 1], &[4, 3], &[1, 1, 1], &[3, 2, 4]] {
            let (space, parameters) = grid(counts);
            assert_eq!(tiling_fault(&space, &parameters), None, "{counts:?}");
        }
        let point = BlendSpace { dimension: 0, axis_ranges: [0.0; 3], simplices: vec![1], covered_share: 1.0 };
        assert_eq!(tiling_fault(&point, &[Parameters::default(); 2]), None);
        assert!(tiling_fault(&BlendSpace { simplices: vec![0, 1], ..point }, &[Parameters::default(); 2]).is_some());
    }

    #[test]
    fn dropped_doubled_and_swapped_simplices_are_found() {
        for counts in [&[3][..], &[2, 3], &[2, 1, 2]] {
            let (space, parameters) = grid(counts);
            let corners = counts.len() + 1;
            for start in (0..space.simplices.len()).step_by(corners) {
                let mut dropped = space.clone();
                let simplex: Vec<u32> = dropped.simplices.drain(start..start + corners).collect();
                assert!(tiling_fault(&dropped, &parameters).is_some(), "{simplex:?} dropped");
                let mut doubled = space.clone();
                doubled.simplices.extend(&simplex);
                assert!(tiling_fault(&doubled, &parameters).is_some(), "{simplex:?} doubled");
            }
            for index in 0..space.simplices.len() {
                for other in (0..parameters.len() as u32).filter(|&other| other != space.simplices[index]) {
                    let mut swapped = space.clone();
                    swapped.simplices[index] = other;
                    assert!(tiling_fault(&swapped, &parameters).is_some(), "{other} at {index}");
                }
            }
        }
    }

    #[test]
    fn a_point_moved_through_a_neighbouring_simplex_is_found() {
        let (space, parameters) = grid(&[2, 2, 2]);
        for index in 0..parameters.len() {
            let mut moved = parameters.clone();
            moved[index].speed_mps += if parameters[index].speed_mps > 1.0 { -0.9 } else { 0.9 };
            assert!(tiling_fault(&space, &moved).is_some(), "{index}");
        }
    }

    /// All facets match and lie on the hull, but the cube is filled twice: around the tetrahedron of its even corners,
    /// and around that of its odd ones.
    #[test]
    fn a_second_cover_with_other_facets_is_found() {
        let (mut space, parameters) = grid(&[1, 1, 1]);
        let even = [[0, 3, 5, 6], [1, 0, 3, 5], [2, 0, 3, 6], [4, 0, 5, 6], [7, 3, 5, 6]];
        let odd = even.map(|simplex| simplex.map(|corner: u32| 7 - corner));
        space.simplices = even.concat();
        assert_eq!(tiling_fault(&space, &parameters), None);
        space.simplices.extend(odd.concat());
        assert!(tiling_fault(&space, &parameters).is_some_and(|fault| fault.contains("overlap")));
    }

    #[test]
    fn wrong_ranges_dimensions_and_shares_are_found() {
        let (space, parameters) = grid(&[2, 2]);
        let check = |spoil: fn(&mut BlendSpace)| {
            let mut spoilt = space.clone();
            spoil(&mut spoilt);
            assert!(tiling_fault(&spoilt, &parameters).is_some(), "{spoilt:?}");
        };
        check(|space| space.axis_ranges[0] *= 1.01);
        check(|space| space.axis_ranges[2] = 1.0);
        check(|space| space.axis_ranges[1] = f32::NAN);
        check(|space| space.dimension = 1);
        check(|space| space.dimension = u32::MAX);
        check(|space| space.covered_share = 0.999);
        check(|space| space.covered_share = f32::NAN);
        check(|space| space.simplices.push(0));
        check(|space| space.simplices[4] = u32::MAX);
        check(|space| space.simplices.clear());
        assert!(tiling_fault(&space, &[]).is_some());
        let mut nameless = parameters.clone();
        nameless[3].strafe_mps = f32::NAN;
        assert!(tiling_fault(&space, &nameless).is_some());
    }

    proptest! {
        #[test]
        fn no_stored_data_panics(
            points in prop::collection::vec(prop::array::uniform3(prop::num::f32::ANY), 0..6),
            simplices in prop::collection::vec(0u32..7, 0..20),
            dimension in 0u32..6,
            axis_ranges in prop::array::uniform3(prop::num::f32::ANY),
        ) {
            let parameters: Vec<Parameters> = points.into_iter().map(|at| Parameters::from_vec3(Vec3::from(at))).collect();
            let mut space = BlendSpace { dimension, axis_ranges, simplices, covered_share: 1.0 };
            tiling_fault(&space, &parameters);
            if let Some(lattice) = Lattice::new(&parameters) {
                (space.dimension, space.axis_ranges) = (lattice.dimension as u32, lattice.axis_ranges);
                tiling_fault(&space, &parameters);
            }
        }
    }
}
