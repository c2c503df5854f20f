//! Walls as edges with a height: what holds an eye, and what hides bodies from it. World, metres.

use fbcrowd_sim::maths::polygon;
use fbcrowd_sim::scenario::Scenario;
use glam::{Vec2, Vec3};

use crate::camera::blocks::solids;

/// Least distance of an eye from walls, m.
const GAP_M: f32 = 0.5;

/// An obstacle, a door or a fence.
struct Wall<'a> {
    corners_m: &'a [Vec2],
    height_m: f32,
    /// Least and greatest coordinates.
    low_m: Vec2,
    high_m: Vec2,
}

/// All walls of a scene.
pub(super) struct Walls<'a>(Vec<Wall<'a>>);

impl<'a> Walls<'a> {
    pub(super) fn new(scenario: &'a Scenario) -> Self {
        let wall = |(corners_m, height_m): (&'a [Vec2], f32)| {
            let low_m = corners_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
            let high_m = corners_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
            Wall { corners_m, height_m, low_m, high_m }
        };
        Self(solids(scenario).map(wall).collect())
    }

    /// Whether a point is in a wall or close to one.
    pub(super) fn hold(&self, point_m: Vec3) -> bool {
        self.0.iter().any(|wall| wall.holds(point_m))
    }

    /// Whether the line between two places of an eye passes through a wall or close to one.
    pub(super) fn block(&self, from_m: Vec3, to_m: Vec3) -> bool {
        let steps = (from_m.distance(to_m) / GAP_M).ceil();
        (0..=steps as u32).any(|step| self.hold(from_m.lerp(to_m, step as f32 / steps.max(1.0))))
    }

    /// Whether a wall is between two points.
    pub(super) fn hide(&self, eye_m: Vec3, at_m: Vec3) -> bool {
        self.0.iter().any(|wall| wall.hides(eye_m, at_m))
    }
}

impl Wall<'_> {
    fn holds(&self, point_m: Vec3) -> bool {
        let on_ground_m = point_m.truncate();
        let is_near = |[from, to]: [Vec2; 2]| {
            let edge = to - from;
            let share = ((on_ground_m - from).dot(edge) / edge.length_squared().max(1e-9)).clamp(0.0, 1.0);
            on_ground_m.distance(from + share * edge) < GAP_M
        };
        let is_apart = on_ground_m.cmplt(self.low_m - GAP_M).any() || on_ground_m.cmpgt(self.high_m + GAP_M).any();
        !is_apart
            && point_m.z < self.height_m + GAP_M
            && (polygon::contains(self.corners_m, on_ground_m) || edges(self.corners_m).any(is_near))
    }

    /// Whether the segment between two points passes through an edge below its top.
    fn hides(&self, eye_m: Vec3, at_m: Vec3) -> bool {
        let (from_m, to_m) = (eye_m.truncate(), at_m.truncate());
        let is_apart = from_m.max(to_m).cmplt(self.low_m).any() || from_m.min(to_m).cmpgt(self.high_m).any();
        let ray = to_m - from_m;
        let crosses = |[from, to]: [Vec2; 2]| {
            let (side_from, side_to) = (ray.perp_dot(from - from_m), ray.perp_dot(to - from_m));
            let edge = to - from;
            let (side_eye, side_at) = (edge.perp_dot(from_m - from), edge.perp_dot(to_m - from));
            let share = side_eye / (side_eye - side_at);
            side_from * side_to < 0.0
                && side_eye * side_at < 0.0
                && eye_m.z + share * (at_m.z - eye_m.z) < self.height_m
        };
        !is_apart && edges(self.corners_m).any(crosses)
    }
}

fn edges(corners_m: &[Vec2]) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    (0..corners_m.len()).map(|index| [corners_m[index], corners_m[(index + 1) % corners_m.len()]])
}
