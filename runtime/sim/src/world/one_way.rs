//! A one-way zone: a rectangle through which agents only move along its heading. World, metres.
//!
//! Two sides of the rectangle lie along the heading: routes cross neither. Routes enter over the *entry*, the side
//! behind, and leave over the *exit*, the side ahead. Within, no displacement has a part against the heading.

use glam::{DVec2, Vec2};

/// Cosine of the greatest angle between the heading and a side of the rectangle, 5°: the zone takes the side's direction.
const ALONG_COS: f32 = 0.996_194_7;
/// Distance by which four corners may miss those of a rectangle, m.
const RECTANGLE_M: f32 = 0.01;
/// Width of a chevron in a picture, m.
const CHEVRON_M: f32 = 0.9;
/// Greatest number of chevrons along and across a zone.
const CHEVRONS_MAX: u32 = 40;
/// Corners of a chevron: forward in its lengths, left in halves of its width.
const CHEVRON: [[f32; 2]; 6] = [[0.6, 0.0], [-0.4, 1.0], [-0.75, 1.0], [0.25, 0.0], [-0.75, -1.0], [-0.4, -1.0]];

/// A one-way zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneWayZone {
    /// Corners, counter-clockwise: right end of the entry, right and left end of the exit, left end of the entry, m.
    pub corners_m: [Vec2; 4],
    /// Unit vector from the entry to the exit.
    pub heading: Vec2,
}

impl OneWayZone {
    /// The zone within an outline that runs counter-clockwise; none if that is no rectangle with two sides along the
    /// heading.
    pub fn new(outline_m: &[Vec2], heading_rad: f32) -> Option<Self> {
        let corners_m: [Vec2; 4] = outline_m.try_into().ok()?;
        let (sin, cos) = libm::sincosf(heading_rad);
        let along = |first: &usize| (corners_m[(first + 1) % 4] - corners_m[*first]).normalize_or_zero();
        let first = (0..4).find(|first| along(first).dot(Vec2::new(cos, sin)) > ALONG_COS)?;
        let [a_m, b_m, c_m, d_m] = [0, 1, 2, 3].map(|next| corners_m[(first + next) % 4]);
        let heading = along(&first);
        let skew_m = [(a_m + c_m - b_m - d_m).length(), (c_m - b_m).dot(heading).abs(), (d_m - a_m).dot(heading).abs()];
        let is_rectangle = skew_m.into_iter().all(|skew_m| skew_m <= RECTANGLE_M);
        is_rectangle.then_some(Self { corners_m: [a_m, b_m, c_m, d_m], heading })
    }

    /// The sides along the heading, the right one first, m.
    pub fn sides_m(&self) -> [[Vec2; 2]; 2] {
        let [a_m, b_m, c_m, d_m] = self.corners_m;
        [[a_m, b_m], [c_m, d_m]]
    }

    /// The entry and the exit, each from right to left, m.
    pub fn gates_m(&self) -> [[Vec2; 2]; 2] {
        let [a_m, b_m, c_m, d_m] = self.corners_m;
        [[a_m, d_m], [b_m, c_m]]
    }

    /// Whether two zones share more than a margin of 1 cm: no line along a side separates them.
    pub fn overlaps(&self, other: &Self) -> bool {
        let axes = [self.heading, self.heading.perp(), other.heading, other.heading.perp()];
        axes.into_iter().all(|axis| {
            let extent_m = |zone: &Self| {
                let along_m = zone.corners_m.map(|corner_m| corner_m.dot(axis));
                along_m
                    .into_iter()
                    .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
            };
            let ([low_m, high_m], [other_low_m, other_high_m]) = (extent_m(self), extent_m(other));
            high_m.min(other_high_m) - low_m.max(other_low_m) > RECTANGLE_M
        })
    }

    /// Whether a straight line leads through the zone against its heading, by more than a margin of [`RECTANGLE_M`].
    pub(crate) fn is_against(&self, from_m: Vec2, to_m: Vec2) -> bool {
        let along_m = to_m - from_m;
        let (mut first, mut last) = (0.0_f32, 1.0_f32);
        for corner in 0..4 {
            let side_m = self.corners_m[(corner + 1) % 4] - self.corners_m[corner];
            let inward = side_m.perp().normalize_or_zero();
            let (offset_m, change_m) = (inward.dot(from_m - self.corners_m[corner]), inward.dot(along_m));
            if change_m > 0.0 {
                first = first.max(-offset_m / change_m);
            } else if change_m < 0.0 {
                last = last.min(-offset_m / change_m);
            } else if offset_m <= 0.0 {
                return false;
            }
        }
        (last - first) * along_m.dot(-self.heading) > RECTANGLE_M
    }

    /// Chevrons that show the heading, for pictures: their corners, m.
    pub fn chevrons_m(&self) -> Vec<[Vec2; 6]> {
        let [a_m, b_m, _, d_m] = self.corners_m;
        let (along_m, across_m) = (a_m.distance(b_m), a_m.distance(d_m));
        let half_m = 0.5 * CHEVRON_M.min(0.6 * across_m);
        let count_on = |length_m: f32| ((length_m / (2.0 * CHEVRON_M.max(1.5 * half_m))) as u32).clamp(1, CHEVRONS_MAX);
        let (columns, rows) = (count_on(along_m), count_on(across_m));
        let share = |index: u32, count: u32| (index as f32 + 0.5) / count as f32;
        let middles_m = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (row, column)))
            .map(|(row, column)| a_m + share(column, columns) * (b_m - a_m) + share(row, rows) * (d_m - a_m));
        let length_m = half_m.min(0.4 * along_m);
        let corner = |middle_m: Vec2, [forward, left]: [f32; 2]| {
            middle_m + length_m * forward * self.heading + half_m * left * self.heading.perp()
        };
        middles_m.map(|middle_m| CHEVRON.map(|at| corner(middle_m, at))).collect()
    }

    /// Whether a position lies in the zone.
    pub fn holds(&self, position_m: Vec2) -> bool {
        self.holds_exactly(DVec2::from(position_m))
    }

    /// As [`holds`](Self::holds), in f64.
    pub(crate) fn holds_exactly(&self, position_m: DVec2) -> bool {
        let [a_m, b_m, c_m, d_m] = self.corners_m.map(DVec2::from);
        let is_left = |from_m: DVec2, to_m: DVec2| (to_m - from_m).perp_dot(position_m - from_m) >= 0.0;
        is_left(a_m, b_m) && is_left(b_m, c_m) && is_left(c_m, d_m) && is_left(d_m, a_m)
    }
}

/// The velocity without its parts against the headings of the zones that hold a position, m/s.
pub(crate) fn not_against_mps(zones: &[OneWayZone], position_m: Vec2, velocity_mps: Vec2) -> Vec2 {
    zones
        .iter()
        .filter(|zone| zone.holds(position_m))
        .fold(velocity_mps, |velocity_mps, zone| velocity_mps - velocity_mps.dot(zone.heading).min(0.0) * zone.heading)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(turn_rad: f32) -> Vec<Vec2> {
        let corners_m = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]];
        corners_m.map(|corner_m| Vec2::from_angle(turn_rad).rotate(Vec2::from(corner_m))).to_vec()
    }

    #[test]
    fn a_heading_along_a_side_gives_entry_and_exit() {
        for (turn_rad, heading_rad) in [(0.0, 0.0), (0.0, std::f32::consts::PI), (0.3, 0.35), (-2.0, -2.0)] {
            let zone = OneWayZone::new(&rectangle(turn_rad), heading_rad).expect("along a side");
            assert!(zone.heading.dot(Vec2::from_angle(heading_rad)) > ALONG_COS);
            let [entry_m, exit_m] = zone.gates_m().map(|[right_m, left_m]| right_m.midpoint(left_m));
            assert!((exit_m - entry_m - 4.0 * zone.heading).length() < 1e-4);
            assert!(zone.holds(entry_m.midpoint(exit_m)) && !zone.holds(exit_m + 0.1 * zone.heading));
        }
    }

    #[test]
    fn slanted_headings_and_other_shapes_are_no_zones() {
        assert_eq!(OneWayZone::new(&rectangle(0.0), 0.7), None);
        assert_eq!(OneWayZone::new(&rectangle(0.0)[..3], 0.0), None);
        let mut skewed = rectangle(0.0);
        skewed[2].x += 0.1;
        assert_eq!(OneWayZone::new(&skewed, 0.0), None);
    }

    #[test]
    fn velocities_against_the_heading_slide_along_the_zone() {
        let zone = OneWayZone::new(&rectangle(0.0), 0.0).expect("a rectangle");
        let at = |position_m: [f32; 2], velocity_mps: [f32; 2]| {
            not_against_mps(&[zone], Vec2::from(position_m), Vec2::from(velocity_mps)).to_array()
        };
        assert_eq!(at([1.0, 1.0], [-1.0, 0.5]), [0.0, 0.5]);
        assert_eq!(at([1.0, 1.0], [1.0, 0.5]), [1.0, 0.5]);
        assert_eq!(at([-1.0, 1.0], [-1.0, 0.5]), [-1.0, 0.5]);
    }
}
