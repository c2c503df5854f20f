//! Walls as solids: obstacles and closed doors raised from the ground, enclosures as low fences. World, metres.

use earcut::Earcut;
use fbcrowd_sim::Population;
use fbcrowd_sim::maths::polygon;
use fbcrowd_sim::scenario::Scenario;
use glam::{Vec2, Vec3};

use crate::raster::palette::{OBSTACLE, OBSTACLE_RIM, Rgb, decode_srgb};
use crate::visibility::{Meshes, Owner};

/// Height of an obstacle without one, m: no head shows above it.
const OBSTACLE_M: f32 = 2.4;
/// Height of a door, m.
const DOOR_M: f32 = 2.1;
/// Height of an enclosure, m: a fence.
const FENCE_M: f32 = 1.05;
/// Light that walls reflect, of their colour in the top view.
const WALL_SHARE: f32 = 0.80;
/// Material of walls.
const WALL: Owner = Owner::SCENE;

/// The solids of a scene that never change.
pub(crate) fn still_blocks(scenario: &Scenario) -> Meshes {
    let mut meshes = Meshes::default();
    for (corners_m, height_m) in obstacles(scenario) {
        append_block(&mut meshes, corners_m, height_m, OBSTACLE);
    }
    for corners_m in &scenario.enclosures_m {
        append_walls(&mut meshes, corners_m, FENCE_M, OBSTACLE_RIM);
    }
    meshes
}

/// What is solid at a point, in words: the ground or an obstacle; none in the open.
pub(crate) fn solid_at(scenario: &Scenario, point_m: Vec3) -> Option<&'static str> {
    if point_m.z < 0.0 {
        return Some("under the ground");
    }
    let holds = |(corners_m, height_m): (&[Vec2], f32)| {
        point_m.z < height_m && polygon::contains(corners_m, point_m.truncate())
    };
    obstacles(scenario).any(holds).then_some("inside an obstacle")
}

/// Corners and height of each obstacle, m.
fn obstacles(scenario: &Scenario) -> impl Iterator<Item = (&[Vec2], f32)> {
    let heights_m = scenario.obstacle_heights_m.iter().copied().chain(std::iter::repeat(None));
    let obstacles = scenario.obstacles_m.iter().zip(heights_m);
    obstacles.map(|(corners_m, height_m)| (&corners_m[..], height_m.unwrap_or(OBSTACLE_M)))
}

/// Corners and height of all that hides bodies, m: obstacles, doors, fences.
pub(crate) fn solids(scenario: &Scenario) -> impl Iterator<Item = (&[Vec2], f32)> {
    let doors = scenario.doors.iter().map(|door| (&door.polygon_m[..], DOOR_M));
    let fences = scenario.enclosures_m.iter().map(|corners_m| (&corners_m[..], FENCE_M));
    obstacles(scenario).chain(doors).chain(fences)
}

/// Appends the doors that are closed in a frame of the recording.
pub(crate) fn append_doors(meshes: &mut Meshes, scenario: &Scenario, population: &Population, frame: u32) {
    for (door, phases) in scenario.doors.iter().zip(&population.doors) {
        if phases.is_closed(frame) {
            append_block(meshes, &door.polygon_m, DOOR_M, OBSTACLE);
        }
    }
}

fn append_block(meshes: &mut Meshes, corners_m: &[Vec2], height_m: f32, colour: Rgb) {
    append_walls(meshes, corners_m, height_m, colour);
    let mut triangles: Vec<u32> = Vec::new();
    Earcut::new().earcut(corners_m.iter().map(|corner_m| corner_m.to_array()), &[], &mut triangles);
    let positions_m: Vec<Vec3> = corners_m.iter().map(|corner_m| corner_m.extend(height_m)).collect();
    let light = vec![WALL_SHARE * colour.map(decode_srgb); positions_m.len()];
    let normals = vec![Vec3::Z; positions_m.len()];
    meshes.append(&positions_m, &normals, &light, triangles.as_chunks().0, WALL);
}

fn append_walls(meshes: &mut Meshes, corners_m: &[Vec2], height_m: f32, colour: Rgb) {
    let light = WALL_SHARE * colour.map(decode_srgb);
    for (index, from) in corners_m.iter().enumerate() {
        let to = corners_m[(index + 1) % corners_m.len()];
        let normal = -(to - from).perp().normalize_or_zero().extend(0.0);
        let positions_m = [from.extend(0.0), to.extend(0.0), to.extend(height_m), from.extend(height_m)];
        meshes.append(&positions_m, &[normal; 4], &[light; 4], &[[0, 1, 2], [0, 2, 3]], WALL);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_solid_inside_an_obstacle_and_under_the_ground() {
        let mut scenario = Scenario::of(Vec::new());
        scenario.obstacles_m.push([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]].map(Vec2::from).to_vec());
        scenario.obstacle_heights_m = vec![Some(1.0)];
        let at = |x: f32, y: f32, z: f32| solid_at(&scenario, Vec3::new(x, y, z));
        assert_eq!(at(0.5, 0.5, 0.9), Some("inside an obstacle"));
        assert_eq!([at(0.5, 0.5, 1.1), at(1.5, 1.5, 0.9)], [None; 2]);
        assert_eq!(at(5.0, 5.0, -0.1), Some("under the ground"));
    }

    #[test]
    fn a_block_has_a_wall_for_each_edge_and_a_lid() {
        let mut scenario = Scenario::of(Vec::new());
        // Not convex: an L.
        let corners_m = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]].map(Vec2::from);
        scenario.obstacles_m.push(corners_m.to_vec());
        let meshes = still_blocks(&scenario);
        assert_eq!(meshes.triangles.len(), 6 * 2 + 4);
        let area_m2 = |triangle: usize| {
            let [a, b, c] = meshes.corners_m(triangle);
            0.5 * (b - a).cross(c - a).length()
        };
        let lid_m2: f32 = (12..16).map(area_m2).sum();
        assert!((lid_m2 - 3.0).abs() < 1e-5, "{lid_m2}");
        // Walls face outward.
        assert_eq!(meshes.normals[0], Vec3::NEG_Y);
    }
}
