//! Limits of scenario files that a scene may exceed: it is refused before anything is written.

use std::path::Path;

use crate::error::SceneError;
use crate::scene::Scene;

/// Greatest number of corners of all walkable polygons.
const WALKABLE_CORNERS_MAX: usize = 200_000;
/// Greatest number of obstacles.
const OBSTACLES_MAX: usize = 10_000;
/// Greatest number of corners of an obstacle.
const OBSTACLE_CORNERS_MAX: usize = 1_000;
/// Greatest number of corners of all obstacles.
const OBSTACLES_CORNERS_MAX: usize = 250_000;

/// Checks that a scenario file can hold the ground of a scene.
pub(crate) fn check_limits(scene: &Scene, path: &Path) -> Result<(), SceneError> {
    let rings = scene.walkable.iter().flat_map(|walkable| walkable.holes_m.iter().chain([&walkable.polygon_m]));
    let corners = rings.map(Vec::len).sum::<usize>();
    let of_obstacles = scene.obstacles.iter().map(|obstacle| obstacle.polygon_m.len()).sum::<usize>();
    let counts = [
        ("the walkable polygons have", corners, "corners", WALKABLE_CORNERS_MAX),
        ("the scene has", scene.obstacles.len(), "obstacles", OBSTACLES_MAX),
        ("the obstacles have", of_obstacles, "corners", OBSTACLES_CORNERS_MAX),
    ];
    let too_large = |what: String| SceneError::TooLarge { path: path.to_owned(), what };
    if let Some((of, count, unit, most)) = counts.into_iter().find(|(_, count, _, most)| count > most) {
        return Err(too_large(format!("{of} {count} {unit}; a scenario takes {most}")));
    }
    let is_long = |count: &usize| *count > OBSTACLE_CORNERS_MAX;
    match scene.obstacles.iter().map(|obstacle| obstacle.polygon_m.len()).find(is_long) {
        None => Ok(()),
        Some(count) => {
            Err(too_large(format!("an obstacle has {count} corners; a scenario takes {OBSTACLE_CORNERS_MAX}")))
        }
    }
}
