//! Simplices in (v_f, ω_t, ω_s) and the shares of examples at a query (`FbCrowd` §5; `definitions.md`, "Blend").
//!
//! Distances are taken after dividing each axis by its range over the examples. Sets of fewer dimensions (only straight
//! walks, say) are simplices of fewer corners in the same three axes; one projection formula, the pseudo-inverse of the
//! edge matrix, serves them all.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::parameters::Parameters;

/// Most corners of a simplex.
pub const MAX_CORNERS: usize = 4;
/// A share this far below zero is rounding, not outside.
const INSIDE_TOLERANCE: f32 = 1e-5;
/// A simplex with an edge this many times longer than its height is a sliver that rounding left of nothing. It is no
/// place to blend in; the gap that it leaves is thinner than what the compiler's quantisation moves a point.
const SLIVER: f32 = 1e4;

/// A triangulation of the examples' parameters in as many dimensions as they span.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlendSpace {
    /// 0 (one point) to 3.
    pub dimension: u32,
    /// Range of each axis over the examples, the metric's unit; 0 where an axis has no range and is dropped.
    pub axis_ranges: [f32; 3],
    /// Indices of examples, `dimension + 1` to a simplex.
    pub simplices: Vec<u32>,
    /// Volume of the simplices over the volume of the examples' convex hull.
    pub covered_share: f32,
}

/// Shares of up to four examples; they sum to 1, unused entries are (0, 0).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares {
    /// Indices of examples.
    pub examples: [u32; MAX_CORNERS],
    /// Their shares of time, each in [0, 1].
    pub shares: [f32; MAX_CORNERS],
}

impl BlendSpace {
    /// Corners of each simplex.
    pub fn simplices(&self) -> impl Iterator<Item = &[u32]> {
        self.simplices.chunks_exact(self.dimension as usize + 1)
    }

    /// A point in the metric's axes.
    pub fn scaled(&self, parameters: Parameters) -> Vec3 {
        let scale = |range: f32| if range > 0.0 { 1.0 / range } else { 0.0 };
        parameters.to_vec3() * Vec3::from(self.axis_ranges.map(scale))
    }
}

/// Finds the simplex of a query; made once a database is loaded.
#[derive(Clone, Debug)]
pub struct Locator {
    space: BlendSpace,
    points: Vec<Vec3>,
    simplices: Vec<Simplex>,
    boundary: Vec<Simplex>,
}

/// Corners, and the rows that turn an offset from the first into the shares of the others.
#[derive(Clone, Copy, Debug)]
struct Simplex {
    corners: [u32; MAX_CORNERS],
    count: usize,
    origin: Vec3,
    rows: [Vec3; 3],
    /// Of a ball that holds it, so that a search for the nearest can pass it by.
    centre: Vec3,
    radius: f32,
}

impl Locator {
    /// `parameters` are those of the database's examples, by index.
    pub fn new(space: &BlendSpace, parameters: &[Parameters]) -> Self {
        let points: Vec<Vec3> = parameters.iter().map(|&example| space.scaled(example)).collect();
        let simplices = space.simplices().map(|corners| Simplex::new(corners, &points));
        let simplices = simplices.filter(|simplex| !simplex.is_sliver(&points)).collect();
        let boundary = boundary_facets(space).iter().map(|facet| Simplex::new(facet, &points)).collect();
        Self { space: space.clone(), points, simplices, boundary }
    }

    /// Shares at a query; outside the hull, those of its nearest point.
    pub fn locate(&self, query: Parameters) -> Shares {
        let point = self.space.scaled(query);
        let mut best = (f32::NEG_INFINITY, [0.0; MAX_CORNERS], None);
        for simplex in &self.simplices {
            let shares = simplex.shares(point);
            let least = shares[..simplex.count].iter().fold(f32::INFINITY, |least, &share| least.min(share));
            if least > best.0 {
                best = (least, shares, Some(simplex));
            }
            if least >= 0.0 {
                break;
            }
        }
        match best {
            (least, shares, Some(simplex)) if least >= -INSIDE_TOLERANCE => simplex.normalised(shares),
            (_, _, nearly) => self.nearest(point, nearly),
        }
    }

    /// Shares at the nearest point of the hull's boundary, or of the simplex that nearly holds the point where a
    /// sliver's gap does.
    fn nearest(&self, point: Vec3, nearly: Option<&Simplex>) -> Shares {
        let mut nearest = (f32::INFINITY, Shares { shares: [1.0, 0.0, 0.0, 0.0], ..Shares::default() });
        for facet in self.boundary.iter().chain(nearly) {
            let nearest_possible = (point.distance(facet.centre) - facet.radius).max(0.0);
            if nearest_possible * nearest_possible > nearest.0 {
                continue;
            }
            let candidate = nearest_on_facet(point, &facet.corners[..facet.count], &self.points);
            if candidate.0 < nearest.0 {
                nearest = candidate;
            }
        }
        nearest.1
    }
}

impl Simplex {
    fn new(corners: &[u32], points: &[Vec3]) -> Self {
        let corner = |k: usize| points[corners[k] as usize];
        let origin = corner(0);
        let count = corners.len();
        let mut edges = [Vec3::ZERO; 3];
        (1..count).for_each(|k| edges[k - 1] = corner(k) - origin);
        let mut padded = [0; MAX_CORNERS];
        padded[..count].copy_from_slice(corners);
        let centre = (0..count).map(corner).sum::<Vec3>() / count as f32;
        let radius = (0..count).map(|k| corner(k).distance(centre)).fold(0.0, f32::max);
        Self { corners: padded, count, origin, rows: dual_edges(&edges[..count - 1]), centre, radius }
    }

    fn is_sliver(&self, points: &[Vec3]) -> bool {
        let edge = |k: usize| points[self.corners[k] as usize] - self.origin;
        !(1..self.count).all(|k| self.rows[k - 1].length() * edge(k).length() < SLIVER)
    }

    /// Barycentric coordinates of the point's projection onto the simplex's own plane, line or space.
    fn shares(&self, point: Vec3) -> [f32; MAX_CORNERS] {
        let offset = point - self.origin;
        let [b, c, d] = self.rows.map(|row| row.dot(offset));
        [1.0 - b - c - d, b, c, d]
    }

    fn normalised(&self, shares: [f32; MAX_CORNERS]) -> Shares {
        let clamped = shares.map(|share| share.max(0.0));
        let sum: f32 = clamped.iter().sum();
        Shares { examples: self.corners, shares: clamped.map(|share| share / sum) }
    }
}

/// The dual basis of up to three edges: row k gives 1 on edge k and 0 on the others (rows of (EᵀE)⁻¹Eᵀ).
fn dual_edges(edges: &[Vec3]) -> [Vec3; 3] {
    match *edges {
        [a] => [a / a.length_squared(), Vec3::ZERO, Vec3::ZERO],
        [a, b] => {
            let normal = a.cross(b);
            let scale = 1.0 / normal.length_squared();
            [b.cross(normal) * scale, normal.cross(a) * scale, Vec3::ZERO]
        }
        [a, b, c] => {
            let scale = 1.0 / a.dot(b.cross(c));
            [b.cross(c) * scale, c.cross(a) * scale, a.cross(b) * scale]
        }
        _ => [Vec3::ZERO; 3],
    }
}

/// Facets that belong to one simplex only, sorted; of a single point, the point.
fn boundary_facets(space: &BlendSpace) -> Vec<Vec<u32>> {
    if space.dimension == 0 {
        return space.simplices().map(<[u32]>::to_vec).collect();
    }
    let mut facets: Vec<Vec<u32>> = Vec::new();
    for simplex in space.simplices() {
        for left_out in 0..simplex.len() {
            let mut facet: Vec<u32> = (0..simplex.len()).filter(|&k| k != left_out).map(|k| simplex[k]).collect();
            facet.sort_unstable();
            facets.push(facet);
        }
    }
    facets.sort_unstable();
    facets.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0].clone()).collect()
}

/// Squared distance and shares of the facet's point nearest to `point`: inside the facet, or on one of its own facets.
fn nearest_on_facet(point: Vec3, corners: &[u32], points: &[Vec3]) -> (f32, Shares) {
    let simplex = Simplex::new(corners, points);
    let shares = simplex.shares(point);
    if shares[..corners.len()].iter().all(|&share| share >= 0.0) {
        let found = simplex.normalised(shares);
        let foot: Vec3 = (0..corners.len()).map(|k| points[corners[k] as usize] * found.shares[k]).sum();
        return (foot.distance_squared(point), found);
    }
    let mut nearest = (f32::INFINITY, Shares::default());
    for left_out in 0..corners.len() {
        let mut rest = [0; MAX_CORNERS];
        let kept = (0..corners.len()).filter(|&k| k != left_out);
        kept.zip(&mut rest).for_each(|(k, slot)| *slot = corners[k]);
        let candidate = nearest_on_facet(point, &rest[..corners.len() - 1], points);
        if candidate.0 < nearest.0 {
            nearest = candidate;
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A cube of eight examples cut into six tetrahedra around its main diagonal.
    fn cube() -> (BlendSpace, Vec<Parameters>) {
        let corner = |k: u32| Parameters {
            speed_mps: (k & 1) as f32 * 2.0,
            turn_rate_rad_s: (k >> 1 & 1) as f32,
            strafe_mps: (k >> 2 & 1) as f32 * 0.5,
        };
        let paths = [[1, 3], [1, 5], [2, 3], [2, 6], [4, 5], [4, 6]];
        let simplices = paths.iter().flat_map(|&[a, b]| [0, a, b, 7]).collect();
        let space = BlendSpace { dimension: 3, axis_ranges: [2.0, 1.0, 0.5], simplices, covered_share: 1.0 };
        (space, (0..8).map(corner).collect())
    }

    fn reached(shares: &Shares, parameters: &[Parameters]) -> Vec3 {
        (0..MAX_CORNERS).map(|k| parameters[shares.examples[k] as usize].to_vec3() * shares.shares[k]).sum()
    }

    proptest! {
        #[test]
        fn inside_the_hull_shares_reach_the_query_and_outside_its_nearest_point(
            x in -2.0f32..4.0, y in -1.0f32..2.0, z in -0.5f32..1.0,
        ) {
            let (space, parameters) = cube();
            let shares = Locator::new(&space, &parameters).locate(Parameters::from_vec3(Vec3::new(x, y, z)));
            let nearest = Vec3::new(x.clamp(0.0, 2.0), y.clamp(0.0, 1.0), z.clamp(0.0, 0.5));
            prop_assert!((shares.shares.iter().sum::<f32>() - 1.0).abs() < 1e-5);
            // Squared distances that differ by less than their rounding are one: up to √(3·2⁻²³) of a range.
            prop_assert!(reached(&shares, &parameters).distance(nearest) < 2e-3, "{shares:?}");
        }
    }

    #[test]
    fn flat_and_tiny_sets_answer_with_their_nearest_point() {
        let walk = |speed_mps| Parameters { speed_mps, ..Parameters::default() };
        let point = BlendSpace { dimension: 0, axis_ranges: [0.0; 3], simplices: vec![0], covered_share: 1.0 };
        let alone = Locator::new(&point, &[walk(1.1)]).locate(walk(3.0));
        assert_eq!((alone.examples[0], alone.shares[0]), (0, 1.0));

        let line =
            BlendSpace { dimension: 1, axis_ranges: [2.0, 0.0, 0.0], simplices: vec![0, 1, 1, 2], covered_share: 1.0 };
        let locator = Locator::new(&line, &[walk(0.0), walk(1.0), walk(2.0)]);
        let middle = locator.locate(Parameters { speed_mps: 1.25, turn_rate_rad_s: 3.0, strafe_mps: -1.0 });
        assert_eq!(middle.examples[..2], [1, 2]);
        assert!((middle.shares[0] - 0.75).abs() < 1e-6);
        assert_eq!(locator.locate(walk(9.0)).examples[0], 2);
    }
}
