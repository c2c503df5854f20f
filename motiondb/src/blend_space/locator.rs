//! Shares of examples at a requested point: those of the simplex that holds it, or of the hull's nearest point
//! (`FbCrowd` §5).
//!
//! Enters: (v_f, ω_t, ω_s), m/s and rad/s. Leaves: at most four examples and their shares. Distances are those of the
//! blend space's metric ([`crate::blend_space::space`]).
//!
//! 1. A grid of cells gives the few simplices that may hold the point. One that holds it gives its barycentric shares.
//! 2. If none holds it, the point is outside: a tree over the hull's surface finds the nearest point of the hull.
//!
//! A set with fewer dimensions than axes fills no volume: it is all surface. Shares are continuous in the point, also
//! across the hull. A query allocates nothing.

use glam::{DVec3, Vec3};

use crate::blend_space::hull_surface::HullSurface;
use crate::blend_space::lattice::{FLAT_SHARE, LEAST_RANGES};
use crate::blend_space::simplex::Simplex;
use crate::blend_space::simplex_grid::SimplexGrid;
use crate::blend_space::space::{BlendSpace, Shares};
use crate::motion::parameters::Parameters;

/// Greatest error of the parameters that shares reach, inside the hull, as a share of each axis's range.
const REACHED_SHARE: f32 = 5e-4;

/// Finds the shares of a requested point; built once for a loaded database.
#[derive(Clone, Debug)]
pub struct Locator {
    metric_scale: DVec3,
    /// Parameters of the examples, by index.
    parameters: Vec<Parameters>,
    /// Along each axis, how far the reached parameters may be off a requested point that lies inside the hull.
    reach_tolerance: Vec3,
    /// Simplices that fill volume, without slivers.
    simplices: Vec<Simplex>,
    grid: SimplexGrid,
    surface: HullSurface,
}

impl Locator {
    /// A locator over a blend space; `parameters` are those of the examples, by index.
    pub fn new(space: &BlendSpace, parameters: &[Parameters]) -> Self {
        let metric_scale = space.metric_scale();
        let points: Vec<DVec3> = parameters.iter().map(|at| at.to_vec3().as_dvec3() * metric_scale).collect();
        let simplices = space.simplices().map(|corners| Simplex::new(corners, &points));
        let simplices: Vec<Simplex> = simplices.filter(|simplex| !simplex.is_sliver()).collect();
        let (simplices, surface) = if fills_its_axes(space) {
            let boundary = boundary(&simplices, &points);
            (simplices, boundary)
        } else {
            (Vec::new(), simplices)
        };
        Self {
            metric_scale,
            parameters: parameters.to_vec(),
            reach_tolerance: reach_tolerance(space),
            grid: SimplexGrid::new(&simplices),
            simplices,
            surface: HullSurface::new(surface),
        }
    }

    /// Shares at a point; outside the hull, those of the hull's nearest point. A point that is not finite has the first
    /// example alone.
    pub fn locate(&self, query: Parameters) -> Shares {
        let point = query.to_vec3().as_dvec3() * self.metric_scale;
        let mut near = self.grid.near(point).iter();
        let holding = near.find_map(|&number| self.simplices[number as usize].shares_within(point));
        holding.unwrap_or_else(|| self.surface.nearest(point).shares())
    }

    /// Shares at a point inside the hull; `None` outside it.
    pub fn locate_inside(&self, query: Parameters) -> Option<Shares> {
        let shares = self.locate(query);
        let terms = shares.examples.into_iter().zip(shares.shares);
        let reached: Vec3 = terms.map(|(example, share)| share * self.parameters[example as usize].to_vec3()).sum();
        (reached - query.to_vec3()).abs().cmple(self.reach_tolerance).all().then_some(shares)
    }
}

/// Whether the examples span as many dimensions as there are axes with a range.
fn fills_its_axes(space: &BlendSpace) -> bool {
    space.axis_ranges.iter().filter(|range| **range > 0.0).count() == space.dimension as usize
}

/// How far off the reached parameters may be along each axis, m/s, rad/s, m/s: gait noise along a dropped axis, and
/// along every axis of a flat set.
fn reach_tolerance(space: &BlendSpace) -> Vec3 {
    let share = if fills_its_axes(space) { REACHED_SHARE } else { FLAT_SHARE };
    Vec3::from_array(std::array::from_fn(|axis| match space.axis_ranges[axis] {
        0.0 => LEAST_RANGES[axis],
        range => share * range,
    }))
}

/// Facets that belong to one simplex only.
fn boundary(simplices: &[Simplex], points: &[DVec3]) -> Vec<Simplex> {
    let mut facets: Vec<Vec<u32>> = simplices.iter().flat_map(Simplex::facets).collect();
    facets.sort_unstable();
    let alone = facets.chunk_by(|a, b| a == b).filter(|same| same.len() == 1);
    let facets = alone.map(|same| Simplex::new(&same[0], points));
    facets.filter(|facet| !facet.is_sliver()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn parameters(points: &[[f32; 3]]) -> Vec<Parameters> {
        points.iter().map(|&at| Parameters::from_vec3(Vec3::from(at))).collect()
    }

    fn reached(shares: &Shares, parameters: &[Parameters]) -> Vec3 {
        (0..4).map(|k| parameters[shares.examples[k] as usize].to_vec3() * shares.shares[k]).sum()
    }

    fn locate(locator: &Locator, query: [f32; 3]) -> Shares {
        locator.locate(Parameters::from_vec3(Vec3::from(query)))
    }

    /// A box of eight examples, cut into six tetrahedra around its main diagonal.
    fn box_of_eight() -> (Locator, Vec<Parameters>) {
        let corner = |k: u32| [(k & 1) as f32 * 2.0, (k >> 1 & 1) as f32, (k >> 2 & 1) as f32 * 0.5];
        let paths = [[1, 3], [1, 5], [2, 3], [2, 6], [4, 5], [4, 6]];
        let simplices = paths.iter().flat_map(|&[a, b]| [0, a, b, 7]).collect();
        let space = BlendSpace { dimension: 3, axis_ranges: [2.0, 1.0, 0.5], simplices, covered_share: 1.0 };
        let parameters = parameters(&(0..8).map(corner).collect::<Vec<_>>());
        (Locator::new(&space, &parameters), parameters)
    }

    proptest! {
        #[test]
        fn shares_reach_the_query_or_the_nearest_point(
            x in -2.0f32..4.0, y in -1.0f32..2.0, z in -0.5f32..1.0,
        ) {
            let (locator, parameters) = box_of_eight();
            let shares = locate(&locator, [x, y, z]);
            let nearest = Vec3::new(x.clamp(0.0, 2.0), y.clamp(0.0, 1.0), z.clamp(0.0, 0.5));
            prop_assert!((shares.shares.iter().sum::<f32>() - 1.0).abs() < 1e-6);
            prop_assert!(shares.shares.iter().all(|share| (0.0..=1.0).contains(share)));
            prop_assert!(reached(&shares, &parameters).distance(nearest) < 1e-6, "{shares:?}");
            let (query, outside) = (Vec3::new(x, y, z), Vec3::new(x, y, z).distance(nearest));
            let is_inside = locator.locate_inside(Parameters::from_vec3(query)).is_some();
            prop_assert!((outside > 0.0 || is_inside) && (outside < 2e-3 || !is_inside), "{outside}");
        }
    }

    #[test]
    fn flat_sets_give_their_nearest_point() {
        let point = BlendSpace { dimension: 0, axis_ranges: [0.0; 3], simplices: vec![0], covered_share: 1.0 };
        let alone = locate(&Locator::new(&point, &parameters(&[[1.1, 0.0, 0.0]])), [3.0, 0.0, 0.0]);
        assert_eq!((alone.examples[0], alone.shares[0]), (0, 1.0));

        let line =
            BlendSpace { dimension: 1, axis_ranges: [2.0, 0.0, 0.0], simplices: vec![0, 1, 1, 2], covered_share: 1.0 };
        let locator = Locator::new(&line, &parameters(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]));
        let middle = locate(&locator, [1.25, 3.0, -1.0]);
        assert_eq!(middle.examples[..2], [1, 2]);
        assert!((middle.shares[0] - 0.75).abs() < 1e-6);
        assert_eq!(locate(&locator, [9.0, 0.0, 0.0]).examples[0], 2);
    }

    #[test]
    fn an_example_alone_makes_its_own_parameters() {
        let (locator, parameters) = box_of_eight();
        for (index, &at) in parameters.iter().enumerate() {
            let shares = locator.locate(at);
            let own = shares.examples.iter().zip(shares.shares).find(|&(&example, _)| example == index as u32);
            assert!(own.is_some_and(|(_, share)| share > 0.999_999), "{shares:?}");
        }
    }

    #[test]
    fn shares_are_finite_for_any_request() {
        let (locator, _) = box_of_eight();
        for wild in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, f32::MIN_POSITIVE] {
            for query in [[wild, 0.0, 0.0], [0.0, wild, wild], [wild; 3]] {
                let sum: f32 = locate(&locator, query).shares.iter().sum();
                assert!((sum - 1.0).abs() < 1e-6, "{query:?}");
            }
        }
        let point = BlendSpace { dimension: 0, axis_ranges: [0.0; 3], simplices: vec![0], covered_share: 1.0 };
        let alone = Locator::new(&point, &parameters(&[[1.1, 0.0, 0.0]]));
        let askew =
            BlendSpace { dimension: 1, axis_ranges: [1.0, 1.0, 0.0], simplices: vec![0, 1], covered_share: 1.0 };
        let segment = Locator::new(&askew, &parameters(&[[0.0; 3], [1.0, 1.0, 0.0]]));
        for wild in [f32::NAN, f32::INFINITY, f32::MAX] {
            assert_eq!(locate(&alone, [wild, 0.0, wild]).shares, [1.0, 0.0, 0.0, 0.0], "{wild}");
            assert!((locate(&segment, [wild, 0.0, wild]).shares.iter().sum::<f32>() - 1.0).abs() < 1e-6, "{wild}");
        }
        let nothing = Locator::new(&BlendSpace::default(), &[]);
        assert_eq!(locate(&nothing, [0.0; 3]).shares, [1.0, 0.0, 0.0, 0.0]);
    }
}
