//! Exact Delaunay triangulation of the examples' parameters (`FbCrowd` §5), in one to three dimensions.
//!
//! Enters: (v_f, ω_t, ω_s) of each example. Leaves: the blend space. Points are inserted one after the other (Bowyer
//! 1981, Watson 1981). Lifted to h = |x|², the simplices are the lower facets of the points' hull. A new point p
//! replaces the simplices whose lifted plane lies above it:
//!
//! ```text
//! h(p) < Σ u_k h(x_k),   u_k = V_k / V: shares of p among the corners x_k of a simplex of volume V
//! ```
//!
//! Outside the hull, each of its facets forms a simplex with a point at infinity. All arithmetic is in whole numbers on
//! the `lattice`, hence exact. Ties (grids, circles) are broken as if each point were lifted infinitesimally more than
//! the points after it (Edelsbrunner and Mücke 1990), so the simplices of any set fit together without gap or overlap.

use std::cmp::Ordering;

use crate::blend_space::lattice::{COINCIDENT_STEPS, Lattice, LatticePoint, signed_volume};
use crate::blend_space::space::{BlendSpace, MAX_CORNERS};
use crate::motion::parameters::Parameters;

/// Index of the point at infinity among the corners of a simplex.
const INFINITY: usize = usize::MAX;

/// The blend space of the examples' `parameters`, in as many dimensions as they span. One of several coincident
/// examples is a corner. Without examples, or if a parameter is not finite, there are no simplices.
pub fn build(parameters: &[Parameters]) -> BlendSpace {
    let Some(lattice) = Lattice::new(parameters) else { return BlendSpace::default() };
    let triangulation = Triangulation::new(&lattice);
    BlendSpace {
        dimension: lattice.dimension as u32,
        axis_ranges: lattice.axis_ranges,
        simplices: triangulation.simplices_of_examples().concat(),
        covered_share: triangulation.covered_share(),
    }
}

/// A point that becomes a corner.
struct Site {
    example: u32,
    point: LatticePoint,
    /// h(x): squared distance from the axes' least values.
    lift: i64,
}

/// A simplex of positive volume: `dimension + 1` indices of sites, the rest 0. One may be [`INFINITY`]: a point beyond
/// the facet of the others makes the volume positive there.
type SiteSimplex = [usize; MAX_CORNERS];

/// A triangulation of the sites inserted so far.
struct Triangulation {
    dimension: usize,
    /// Sites in the order of insertion; the first `dimension + 1` span the set.
    sites: Vec<Site>,
    simplices: Vec<SiteSimplex>,
}

impl Triangulation {
    fn new(lattice: &Lattice) -> Self {
        let sites = sites(lattice);
        let mut triangulation = Self { dimension: lattice.dimension, sites, simplices: Vec::new() };
        triangulation.simplices = triangulation.first_simplices();
        for site in lattice.dimension + 1..triangulation.sites.len() {
            triangulation.insert(site);
        }
        triangulation
    }

    fn corners(&self) -> std::ops::RangeInclusive<usize> {
        0..=self.dimension
    }

    /// The simplex of the first sites, and the simplices at infinity around it.
    fn first_simplices(&self) -> Vec<SiteSimplex> {
        let mut first: SiteSimplex = [0; MAX_CORNERS];
        first.iter_mut().zip(self.corners()).for_each(|(corner, site)| *corner = site);
        if self.dimension == 0 {
            return vec![first];
        }
        if self.volume(&first) < 0 {
            first.swap(0, 1);
        }
        let beyond = |k: usize| {
            let mut outer = with(&first, k, INFINITY);
            outer.swap(0, 1); // The first simplex lies on the other side.
            outer
        };
        std::iter::once(first).chain(self.corners().map(beyond)).collect()
    }

    /// Replaces all simplices in conflict with the site by new ones around it.
    fn insert(&mut self, site: usize) {
        let simplices = std::mem::take(&mut self.simplices);
        let (removed, kept): (Vec<SiteSimplex>, Vec<SiteSimplex>) =
            simplices.into_iter().partition(|simplex| self.is_in_conflict(simplex, site));
        let rebuilt = |simplex: &SiteSimplex| self.corners().map(|k| with(simplex, k, site)).collect::<Vec<_>>();
        let mut new: Vec<SiteSimplex> = removed.iter().flat_map(rebuilt).collect();
        // A facet between two removed simplices is inside the cavity: it occurs twice, and is dropped.
        new.sort_unstable_by_key(sorted);
        self.simplices = kept;
        self.simplices.extend(new.chunk_by(|a, b| sorted(a) == sorted(b)).filter(|same| same.len() == 1).flatten());
    }

    /// Whether the site lies below the simplex's lifted plane. The plane of a simplex at infinity is vertical over its
    /// facet: in conflict are all sites beyond the facet, and, of those in the facet's plane, the ones below the lifted
    /// facet. For these, any site off that plane serves as last corner: it has no share.
    fn is_in_conflict(&self, simplex: &SiteSimplex, site: usize) -> bool {
        let Some(k) = self.corners().find(|&k| simplex[k] == INFINITY) else { return self.is_below(simplex, site) };
        match self.volume(&with(simplex, k, site)).cmp(&0) {
            Ordering::Greater => true,
            Ordering::Less => false,
            Ordering::Equal => {
                let mut off_plane = self.corners().map(|other| with(simplex, k, other));
                off_plane.find(|finite| self.volume(finite) != 0).is_some_and(|finite| self.is_below(&finite, site))
            }
        }
    }

    /// Whether h(p) < Σ u_k h(x_k) for the site p and the corners x_k of a finite simplex.
    fn is_below(&self, simplex: &SiteSimplex, site: usize) -> bool {
        let sign = self.volume(simplex).signum();
        let shares = self.corners().map(|k| (simplex[k], sign * self.volume(&with(simplex, k, site))));
        // Both sides are multiplied by the volume V, the sum of the unscaled shares V_k.
        let rise = |(corner, share): (usize, i128)| share * i128::from(self.sites[corner].lift - self.sites[site].lift);
        match shares.clone().map(rise).sum::<i128>().cmp(&0) {
            Ordering::Greater => true,
            Ordering::Less => false,
            // A tie: the earliest site is lifted most, a corner with a share or the point itself.
            Ordering::Equal => {
                let earliest = shares.filter(|&(_, share)| share != 0).min();
                earliest.is_some_and(|(corner, share)| corner < site && share > 0)
            }
        }
    }

    fn volume(&self, simplex: &SiteSimplex) -> i128 {
        let mut points = [[0; 3]; MAX_CORNERS];
        points.iter_mut().zip(&simplex[self.corners()]).for_each(|(point, &site)| *point = self.sites[site].point);
        signed_volume(&points[self.corners()])
    }

    fn is_finite(&self, simplex: &SiteSimplex) -> bool {
        !simplex[self.corners()].contains(&INFINITY)
    }

    /// Examples at the corners of each finite simplex, sorted.
    fn simplices_of_examples(&self) -> Vec<Vec<u32>> {
        let finite = self.simplices.iter().filter(|simplex| self.is_finite(simplex));
        let examples = |simplex: &SiteSimplex| {
            let mut examples: Vec<u32> = simplex[self.corners()].iter().map(|&site| self.sites[site].example).collect();
            examples.sort_unstable();
            examples
        };
        let mut simplices: Vec<Vec<u32>> = finite.map(examples).collect();
        simplices.sort_unstable();
        simplices
    }

    /// Volume of the finite simplices, divided by the volume of the hull, which the facets at infinity span with the
    /// first site.
    fn covered_share(&self) -> f32 {
        let (finite, infinite): (Vec<&SiteSimplex>, Vec<&SiteSimplex>) =
            self.simplices.iter().partition(|simplex| self.is_finite(simplex));
        let to_first = |simplex: &&SiteSimplex| simplex.map(|corner| if corner == INFINITY { 0 } else { corner });
        let covered: i128 = finite.iter().map(|simplex| self.volume(simplex)).sum();
        let hull: i128 = infinite.iter().map(|simplex| -self.volume(&to_first(simplex))).sum();
        if infinite.is_empty() { 1.0 } else { (covered as f64 / hull as f64) as f32 }
    }
}

/// The points that span the set, then all others that do not coincide with an earlier one.
fn sites(lattice: &Lattice) -> Vec<Site> {
    let mut sites = Vec::<Site>::new();
    for example in lattice.span.iter().copied().chain(0..lattice.points.len()) {
        let site = Site { example: example as u32, point: lattice.points[example], lift: lattice.lifts[example] };
        if sites.iter().all(|other| distance_steps(&site.point, &other.point) > COINCIDENT_STEPS) {
            sites.push(site);
        }
    }
    sites
}

fn distance_steps(a: &LatticePoint, b: &LatticePoint) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) as f64).map(|x| x * x).sum::<f64>().sqrt()
}

/// The simplex with its corner k replaced.
fn with(simplex: &SiteSimplex, k: usize, corner: usize) -> SiteSimplex {
    let mut changed = *simplex;
    changed[k] = corner;
    changed
}

fn sorted(simplex: &SiteSimplex) -> SiteSimplex {
    let mut sorted = *simplex;
    sorted.sort_unstable();
    sorted
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::blend_space::locator::Locator;
    use crate::blend_space::tiling::tiling_fault;

    fn parameters(points: &[[f32; 3]]) -> Vec<Parameters> {
        points.iter().map(|&point| Parameters::from_vec3(Vec3::from(point))).collect()
    }

    fn built(points: &[[f32; 3]]) -> (BlendSpace, Vec<Parameters>) {
        let parameters = parameters(points);
        (build(&parameters), parameters)
    }

    /// Checks that the simplices tile the hull, no site lies below a lifted plane, and mixtures of examples are
    /// reached.
    fn check(points: &[[f32; 3]], dimension: u32) {
        let (space, parameters) = built(points);
        assert_eq!(space.dimension, dimension, "{points:?}");
        assert_eq!(tiling_fault(&space, &parameters), None, "{points:?}");
        let triangulation = Triangulation::new(&Lattice::new(&parameters).unwrap());
        for simplex in triangulation.simplices.iter().filter(|simplex| triangulation.is_finite(simplex)) {
            let below = |&site: &usize| !simplex.contains(&site) && triangulation.is_below(simplex, site);
            assert_eq!((0..triangulation.sites.len()).find(below), None, "{points:?}");
        }
        check_mixtures(&space, &parameters);
    }

    fn check_mixtures(space: &BlendSpace, parameters: &[Parameters]) {
        let locator = Locator::new(space, parameters);
        for start in 0..parameters.len() {
            let weight = |k: usize| ((k * 7 + start * 13) % 11) as f32 + 0.1;
            let sum: f32 = (0..parameters.len()).map(weight).sum();
            let query: Vec3 = (0..parameters.len()).map(|k| parameters[k].to_vec3() * (weight(k) / sum)).sum();
            let shares = locator.locate(Parameters::from_vec3(query));
            let reached: Vec3 =
                (0..4).map(|k| parameters[shares.examples[k] as usize].to_vec3() * shares.shares[k]).sum();
            // A flat set may be as thick as noise.
            let tolerance = if space.dimension < 3 { 0.03 } else { 3e-3 };
            let ranges = Vec3::from(space.axis_ranges.map(|range| if range > 0.0 { range } else { 1.0 }));
            assert!(((reached - query) / ranges).length() < tolerance, "{query} became {reached}");
        }
    }

    fn grid(nx: u32, ny: u32, nz: u32) -> Vec<[f32; 3]> {
        (0..nx * ny * nz).map(|k| [(k % nx) as f32, (k / nx % ny) as f32, (k / nx / ny) as f32]).collect()
    }

    /// Pseudo-random numbers in [0, 1).
    fn random(count: usize) -> Vec<[f32; 3]> {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        (0..count).map(|_| [next(), next(), next()]).collect()
    }

    #[test]
    fn grids_circles_and_repeats_are_tiled() {
        check(&grid(4, 4, 4), 3);
        check(&grid(5, 4, 1), 2);
        check(&grid(6, 1, 1), 1);
        check(&grid(1, 4, 1), 1);
        check(&[[1.0, 2.0, 3.0]; 3], 0);
        let circle =
            (0..12).map(|k| (k as f32).to_radians() * 30.0).map(|angle| [libm::cosf(angle), 0.0, libm::sinf(angle)]);
        check(&circle.collect::<Vec<_>>(), 2);
        // A plane that is tilted against all three axes.
        let tilted = grid(3, 3, 1).into_iter().map(|[x, y, _]| [x, y, x + y]);
        check(&tilted.collect::<Vec<_>>(), 2);
        // A layer of needles, and a box far from 0.
        let layer = grid(6, 6, 2).into_iter().map(|[x, y, z]| [x, 0.1 * y, 0.3 * z]);
        check(&layer.collect::<Vec<_>>(), 3);
        check(&grid(3, 3, 3).into_iter().map(|at| at.map(|x| 1000.0 + x)).collect::<Vec<_>>(), 3);
    }

    #[test]
    fn strafes_within_noise_leave_a_flat_set() {
        let walks =
            grid(3, 3, 1).into_iter().enumerate().map(|(k, [x, y, _])| [x, y, 0.02 * libm::sinf(k as f32 * 0.7)]);
        check(&walks.collect::<Vec<_>>(), 2);
    }

    #[test]
    fn parameters_that_are_not_finite_have_no_simplices() {
        assert_eq!(built(&[[0.0, f32::NAN, 1.0], [1.0, 2.0, 3.0]]).0, BlendSpace::default());
        assert_eq!(built(&[]).0, BlendSpace::default());
    }

    #[test]
    fn three_hundred_examples_are_tiled() {
        check(&random(300), 3);
        // Mirrored, and dense at walking speed.
        let walks = random(150).into_iter().map(|[x, y, z]| [1.0 + 0.3 * x * x, y * y * y, 0.3 * z * z * z]);
        let both = walks.flat_map(|[x, y, z]| [[x, y, z], [x, -y, -z]]);
        check(&both.collect::<Vec<_>>(), 3);
    }

    #[test]
    fn dropped_simplices_and_swapped_corners_break_the_tiling() {
        let (space, parameters) = built(&random(12));
        for start in (0..space.simplices.len()).step_by(4) {
            let mut dropped = space.clone();
            dropped.simplices.drain(start..start + 4);
            assert!(tiling_fault(&dropped, &parameters).is_some(), "{start}");
        }
        for index in 0..space.simplices.len() {
            let mut swapped = space.clone();
            swapped.simplices[index] = (swapped.simplices[index] + 1) % 12;
            assert!(tiling_fault(&swapped, &parameters).is_some(), "{index}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]
        #[test]
        fn any_set_of_points_is_tiled(points in prop::collection::vec([-3i8..4, -3i8..4, -3i8..4], 1..30)) {
            let points: Vec<[f32; 3]> = points.iter().map(|point| point.map(f32::from)).collect();
            check(&points, built(&points).0.dimension);
        }
    }
}
