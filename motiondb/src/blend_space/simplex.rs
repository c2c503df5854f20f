//! A simplex of one to four corners: barycentric shares of a point, and the point nearest to a query. All points are in
//! the metric of the blend space.
//!
//! The offset of a point from the first corner gives the shares of the others by the dual basis of the edges: the rows
//! of the pseudo-inverse (EᵀE)⁻¹Eᵀ. One formula serves tetrahedra, triangles, segments and points. If a share is
//! negative, the nearest point lies on the facet opposite to such a corner.

use glam::DVec3;

use crate::blend_space::space::{MAX_CORNERS, Shares};

/// Edge over height from which a simplex is a sliver: `f64` then gives only rounding, and the gap is negligible.
const SLIVER: f64 = 1e9;
/// Greatest negative share that counts as inside: more than the rounding of `f64` in the thinnest simplex.
const INSIDE_TOLERANCE: f64 = 1e-6;

/// A simplex between examples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simplex {
    /// Index of the example at each corner.
    examples: [u32; MAX_CORNERS],
    /// Corners, in the metric.
    corners: [DVec3; MAX_CORNERS],
    /// Number of corners.
    count: usize,
    /// Dual basis of the edges: times the offset from the first corner, the shares of the other corners.
    rows: [DVec3; 3],
}

/// The nearest point that a search has found so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestPoint {
    /// Squared distance from the query, in the metric.
    pub(crate) distance_squared: f64,
    /// The point, in the metric; NaN before the first is found.
    pub(crate) point: DVec3,
    examples: [u32; MAX_CORNERS],
    shares: [f64; MAX_CORNERS],
}

impl Simplex {
    /// The simplex of some examples; `points` are those of all examples, in the metric.
    pub(crate) fn new(examples: &[u32], points: &[DVec3]) -> Self {
        let mut simplex = Self {
            examples: [0; MAX_CORNERS],
            corners: [DVec3::ZERO; MAX_CORNERS],
            count: examples.len(),
            rows: [DVec3::ZERO; 3],
        };
        for (k, &example) in examples.iter().enumerate() {
            simplex.examples[k] = example;
            simplex.corners[k] = points[example as usize];
        }
        simplex.rows = dual_edges(&simplex);
        simplex
    }

    fn edge(&self, k: usize) -> DVec3 {
        self.corners[k] - self.corners[0]
    }

    /// Whether an edge is [`SLIVER`] times longer than the height over it, or a coordinate is not finite.
    pub(crate) fn is_sliver(&self) -> bool {
        !(1..self.count).all(|k| self.rows[k - 1].length() * self.edge(k).length() < SLIVER)
    }

    /// Least and greatest coordinates.
    pub(crate) fn bounds(&self) -> [DVec3; 2] {
        let corners = || self.corners[..self.count].iter().copied();
        [corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max)]
    }

    /// The facet opposite to a corner.
    fn facet(&self, left_out: usize) -> Self {
        let mut facet = *self;
        facet.count -= 1;
        for k in left_out..facet.count {
            facet.examples[k] = self.examples[k + 1];
            facet.corners[k] = self.corners[k + 1];
        }
        facet.rows = dual_edges(&facet);
        facet
    }

    /// Least share at a box's centre. `None` for a box outside the simplex: a share is negative in all of the box.
    pub(crate) fn depth_in_box(&self, centre: DVec3, half: DVec3) -> Option<f64> {
        let shares = self.shares(centre);
        let first = -(self.rows[0] + self.rows[1] + self.rows[2]);
        let slopes = [first, self.rows[0], self.rows[1], self.rows[2]];
        let reaches = (0..self.count).all(|k| shares[k] + slopes[k].abs().dot(half) >= -INSIDE_TOLERANCE);
        reaches.then(|| shares[..self.count].iter().copied().fold(f64::INFINITY, f64::min))
    }

    /// Shares at a point inside the simplex; `None` outside it.
    pub(crate) fn shares_within(&self, point: DVec3) -> Option<Shares> {
        let shares = self.shares(point);
        let within = shares[..self.count].iter().all(|&share| share >= -INSIDE_TOLERANCE);
        within.then(|| {
            let clamped = shares.map(|share| share.max(0.0));
            let sum: f64 = clamped.iter().sum();
            Shares { examples: self.examples, shares: clamped.map(|share| (share * sum.recip()) as f32) }
        })
    }

    /// Examples at the corners of each facet, sorted; a point has no facets.
    pub(crate) fn facets(&self) -> impl Iterator<Item = Vec<u32>> {
        let mut sorted = self.examples[..self.count].to_vec();
        sorted.sort_unstable();
        let facets = if self.count > 1 { self.count } else { 0 };
        (0..facets).map(move |left_out| [&sorted[..left_out], &sorted[left_out + 1..]].concat())
    }

    /// Replaces `nearest` if a point of the simplex is nearer to `query`.
    pub(crate) fn approach(&self, query: DVec3, nearest: &mut NearestPoint) {
        let towards = query - nearest.point;
        if self.corners[..self.count].iter().all(|&corner| (corner - nearest.point).dot(towards) <= 0.0) {
            return; // Seen from the query, the whole simplex lies behind the nearest point.
        }
        let shares = self.shares(query);
        let point: DVec3 = (0..self.count).map(|k| self.corners[k] * shares[k]).sum();
        let distance_squared = point.distance_squared(query);
        if distance_squared >= nearest.distance_squared {
            return; // The simplex's whole plane is farther.
        }
        let mut beyond = (0..self.count).filter(|&k| shares[k] < 0.0).peekable();
        if beyond.peek().is_none() {
            *nearest = NearestPoint { distance_squared, point, examples: self.examples, shares };
        }
        beyond.for_each(|k| self.facet(k).approach(query, nearest));
    }

    /// Barycentric coordinates of the point's projection onto the simplex's own space, plane or line.
    fn shares(&self, point: DVec3) -> [f64; MAX_CORNERS] {
        let offset = point - self.corners[0];
        let [b, c, d] = self.rows.map(|row| row.dot(offset));
        [1.0 - b - c - d, b, c, d]
    }
}

impl NearestPoint {
    /// Before the first point is found: the first example, infinitely far.
    pub(crate) const NONE: Self = Self {
        distance_squared: f64::INFINITY,
        point: DVec3::NAN,
        examples: [0; MAX_CORNERS],
        shares: [1.0, 0.0, 0.0, 0.0],
    };

    /// Shares of the examples at the point.
    pub(crate) fn shares(&self) -> Shares {
        let mut examples = self.examples;
        let shares = self.shares.map(|share| share as f32);
        (0..MAX_CORNERS).filter(|&k| shares[k] == 0.0).for_each(|k| examples[k] = 0);
        Shares { examples, shares }
    }
}

/// Dual basis of up to three edges: row k times edge k is 1, times the other edges 0.
fn dual_edges(simplex: &Simplex) -> [DVec3; 3] {
    let [a, b, c] = [1, 2, 3].map(|k| simplex.edge(k));
    match simplex.count {
        2 => [a / a.length_squared(), DVec3::ZERO, DVec3::ZERO],
        3 => {
            let normal = a.cross(b);
            let scale = normal.length_squared().recip();
            [b.cross(normal) * scale, normal.cross(a) * scale, DVec3::ZERO]
        }
        4 => {
            let scale = a.dot(b.cross(c)).recip();
            [b.cross(c) * scale, c.cross(a) * scale, a.cross(b) * scale]
        }
        _ => [DVec3::ZERO; 3],
    }
}

/// Arbitrary simplices of `count` corners each among some points: they may intersect or coincide.
#[cfg(test)]
pub(crate) fn soup(points: &[[i8; 3]], corners: &[[usize; 4]], count: usize) -> Vec<Simplex> {
    let points: Vec<DVec3> = points.iter().map(|at| DVec3::from_array(at.map(f64::from))).collect();
    let examples = |corners: &[usize; 4]| corners[..count].iter().map(|k| (k % points.len()) as u32).collect();
    let simplices = corners.iter().map(|corners| -> Vec<u32> { examples(corners) });
    simplices.map(|corners| Simplex::new(&corners, &points)).filter(|simplex| !simplex.is_sliver()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// x is the nearest point of a convex set to p where no corner c lies further towards p: (p − x)·(c − x) ≤ 0.
        #[test]
        fn no_point_of_a_simplex_is_nearer(
            corners in prop::collection::vec(prop::array::uniform3(-3i8..4), 1..5),
            query in prop::array::uniform3(-9.0f64..9.0),
        ) {
            let points: Vec<DVec3> = corners.iter().map(|at| DVec3::from_array(at.map(f64::from))).collect();
            let simplex = Simplex::new(&(0..points.len() as u32).collect::<Vec<_>>(), &points);
            prop_assume!(!simplex.is_sliver());
            let point = DVec3::from_array(query);
            let mut nearest = NearestPoint::NONE;
            simplex.approach(point, &mut nearest);
            let shares = nearest.shares();
            let found: DVec3 = (0..4).map(|k| points[shares.examples[k] as usize] * f64::from(shares.shares[k])).sum();
            prop_assert!((found.distance(point) - nearest.distance_squared.sqrt()).abs() < 1e-5);
            prop_assert!(points.iter().all(|&corner| (point - found).dot(corner - found) < 1e-4));
        }
    }
}
