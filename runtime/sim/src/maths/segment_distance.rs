//! The least distance between two segments: the kernel of [`body_penetration`](crate::measures::body_penetration).
//!
//! The nearest points of two segments are
//!
//! 1. both inside their segments: they are the nearest points of the two lines, which are not parallel; or
//! 2. an end of one segment and its nearest point on the other, in four cases; parallel segments need no more.
//!
//! Every candidate is a distance between points of the segments, so the least is right even where rounding spoils a
//! candidate (near-parallel lines, segments of no length). Metres.

use glam::Vec3;

/// Squared sine of the angle below which two lines count as parallel; then the ends decide, which for segments of 1 m
/// is off by less than 0.01 mm.
const PARALLEL_SINE_SQUARED: f32 = 1e-6;

/// A segment; both ends may be one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment {
    /// First end, m.
    pub from_m: Vec3,
    /// Second end, m.
    pub to_m: Vec3,
}

/// The least distance between two segments, m.
pub(crate) fn distance_m(a: &Segment, b: &Segment) -> f32 {
    let ends = [
        b.squared_to(a.from_m),
        b.squared_to(a.to_m),
        a.squared_to(b.from_m),
        a.squared_to(b.to_m),
        between_lines_squared(a, b),
    ];
    libm::sqrtf(ends.into_iter().fold(f32::INFINITY, f32::min))
}

impl Segment {
    fn along_m(&self) -> Vec3 {
        self.to_m - self.from_m
    }

    /// Case 2: squared distance to a point, m².
    fn squared_to(&self, point_m: Vec3) -> f32 {
        let (along_m, offset_m) = (self.along_m(), point_m - self.from_m);
        let share = offset_m.dot(along_m) / along_m.length_squared().max(f32::MIN_POSITIVE);
        (offset_m - share.clamp(0.0, 1.0) * along_m).length_squared()
    }
}

/// Case 1: squared distance of the lines if their nearest points lie within both segments, otherwise infinity, m².
fn between_lines_squared(a: &Segment, b: &Segment) -> f32 {
    let (along_a_m, along_b_m, offset_m) = (a.along_m(), b.along_m(), b.from_m - a.from_m);
    let (aa, ab, bb) = (along_a_m.length_squared(), along_a_m.dot(along_b_m), along_b_m.length_squared());
    let determinant = along_a_m.cross(along_b_m).length_squared();
    if determinant <= PARALLEL_SINE_SQUARED * aa * bb {
        return f32::INFINITY;
    }
    let (ao, bo) = (along_a_m.dot(offset_m), along_b_m.dot(offset_m));
    let share_a = (ao * bb - bo * ab) / determinant;
    let share_b = (ao * ab - bo * aa) / determinant;
    let within = (0.0..=1.0).contains(&share_a) && (0.0..=1.0).contains(&share_b);
    if within { (offset_m + share_b * along_b_m - share_a * along_a_m).length_squared() } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn segment(from_m: [f32; 3], to_m: [f32; 3]) -> Segment {
        Segment { from_m: from_m.into(), to_m: to_m.into() }
    }

    fn check(a: Segment, b: Segment, expected_m: f32) {
        for (a, b) in [(a, b), (b, a), (reversed(a), b), (a, reversed(b))] {
            let found_m = distance_m(&a, &b);
            assert!((found_m - expected_m).abs() < 1e-5, "{found_m}, not {expected_m}");
        }
    }

    fn reversed(segment: Segment) -> Segment {
        Segment { from_m: segment.to_m, to_m: segment.from_m }
    }

    #[test]
    fn every_case_gives_its_distance() {
        let along_x = segment([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        check(along_x, segment([0.0, -1.0, 0.3], [0.0, 1.0, 0.3]), 0.3); // both inside
        check(along_x, segment([0.0, 0.2, 0.0], [0.0, 1.0, 0.0]), 0.2); // an end over the inside
        check(along_x, segment([4.0, 4.0, 0.0], [9.0, 4.0, 1.0]), 5.0); // two ends
        check(along_x, segment([0.5, 0.4, 0.0], [3.0, 0.4, 0.0]), 0.4); // parallel, side by side
        check(along_x, segment([2.0, 0.0, 0.0], [3.0, 0.0, 0.0]), 1.0); // in one line
        check(along_x, segment([0.0, 0.7, 0.0], [0.0, 0.7, 0.0]), 0.7); // a point
        check(along_x, along_x, 0.0);
    }

    /// The least distance among 3 × 41 × 41 pairs of points, ever denser about the nearest: slightly above the least.
    fn sampled_m(a: &Segment, b: &Segment) -> f32 {
        let (mut centre, mut reach, mut least_m) = ([0.5, 0.5], 0.5, f32::INFINITY);
        for _ in 0..3 {
            let share = |centre: f32, step: i32| (centre + reach * step as f32 / 20.0).clamp(0.0, 1.0);
            let start = centre;
            for (i, j) in (-20..=20).flat_map(|i| (-20..=20).map(move |j| (i, j))) {
                let shares = [share(start[0], i), share(start[1], j)];
                let [on_a_m, on_b_m] = [(a, shares[0]), (b, shares[1])].map(|(s, share)| s.from_m.lerp(s.to_m, share));
                if on_a_m.distance(on_b_m) < least_m {
                    (least_m, centre) = (on_a_m.distance(on_b_m), shares);
                }
            }
            reach *= 0.1;
        }
        least_m
    }

    fn point() -> impl Strategy<Value = Vec3> {
        proptest::array::uniform3(-1.0_f32..1.0).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn no_pair_of_points_is_nearer(a in (point(), point()), b in (point(), point()), shrink in 0.0_f32..1.0) {
            // One segment shrinks to a point, the other becomes parallel: the cases in which rounding matters.
            let a = Segment { from_m: a.0, to_m: a.0.lerp(a.1, shrink * shrink) };
            for b in [Segment { from_m: b.0, to_m: b.1 }, Segment { from_m: b.0, to_m: b.0 + a.along_m() + 1e-3 * b.1 }] {
                let (found_m, sampled_m) = (distance_m(&a, &b), sampled_m(&a, &b));
                prop_assert!(found_m <= sampled_m + 1e-5 && found_m >= sampled_m - 2e-3, "{found_m} against {sampled_m}");
            }
        }
    }
}
