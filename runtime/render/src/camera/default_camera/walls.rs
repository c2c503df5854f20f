//! Walls as edges with a height: what holds an eye, and what hides bodies from it. World, metres.

use fbcrowd_sim::maths::polygon;
use fbcrowd_sim::scenario::Scenario;
use glam::{Vec2, Vec3};

use crate::camera::blocks::solids;
use crate::camera::default_camera::wall_grid::{WallEdge, WallGrid};

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
pub(super) struct Walls<'a> {
    solids: Vec<Wall<'a>>,
    edges: WallGrid,
    highest_m: f32,
}

impl<'a> Walls<'a> {
    pub(super) fn new(scenario: &'a Scenario) -> Self {
        let wall = |(corners_m, height_m): (&'a [Vec2], f32)| {
            let low_m = corners_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
            let high_m = corners_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
            Wall { corners_m, height_m, low_m, high_m }
        };
        let solids: Vec<Wall> = solids(scenario).map(wall).collect();
        let mut wall_edges = Vec::new();
        for Wall { corners_m, height_m, .. } in &solids {
            wall_edges.extend(edges(corners_m).map(|ends_m| WallEdge { ends_m, height_m: *height_m }));
        }
        let highest_m = solids.iter().map(|wall| wall.height_m).fold(0.0, f32::max);
        Self { solids, edges: WallGrid::new(wall_edges), highest_m }
    }

    /// Whether a point is in a wall or close to one.
    pub(super) fn hold(&self, point_m: Vec3) -> bool {
        self.solids.iter().any(|wall| wall.holds(point_m))
    }

    /// Whether the line between two places of an eye passes through a wall or close to one.
    pub(super) fn block(&self, from_m: Vec3, to_m: Vec3) -> bool {
        let steps = (from_m.distance(to_m) / GAP_M).ceil();
        (0..=steps as u32).any(|step| self.hold(from_m.lerp(to_m, step as f32 / steps.max(1.0))))
    }

    /// Height over a point on the ground from which on walls do not hide it from an eye, m; from 0 to `most_m`.
    pub(super) fn seen_from_m(&self, eye_m: Vec3, at_m: Vec2, most_m: f32) -> f32 {
        if self.solids.is_empty() {
            return 0.0;
        }
        let from_m = eye_m.truncate();
        // Nearer to the eye, the line of sight to the ground is above all walls.
        let under_walls = (self.highest_m / eye_m.z.max(self.highest_m)).max(1e-3);
        let start_m = at_m.lerp(from_m, under_walls);
        let ray = at_m - from_m;
        let mut hidden_m = 0.0_f32;
        for wall in self.edges.along([at_m, start_m]) {
            let [from, to] = wall.ends_m;
            let (side_from, side_to) = (ray.perp_dot(from - from_m), ray.perp_dot(to - from_m));
            let edge = to - from;
            let (side_eye, side_at) = (edge.perp_dot(from_m - from), edge.perp_dot(at_m - from));
            if side_from * side_to < 0.0 && side_eye * side_at < 0.0 {
                // The line over the top of the wall, a share of its length away.
                let share = side_eye / (side_eye - side_at);
                hidden_m = hidden_m.max(eye_m.z + (wall.height_m - eye_m.z) / share);
                if hidden_m >= most_m {
                    return most_m;
                }
            }
        }
        hidden_m
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
}

fn edges(corners_m: &[Vec2]) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    (0..corners_m.len()).map(|index| [corners_m[index], corners_m[(index + 1) % corners_m.len()]])
}
