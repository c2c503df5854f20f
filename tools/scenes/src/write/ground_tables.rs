//! The tables of walkable ground, obstacles, zones and measured areas.

use crate::scene::{Point, Scene, SceneMeasure};
use crate::write::words::{commented, list, packed, point, quoted, shape};

/// The tables `[[walkable]]`.
pub(crate) fn walkable(scene: &Scene) -> String {
    let mut text = String::new();
    for walkable in &scene.walkable {
        text += &commented("[[walkable]]", &walkable.origin);
        text += &polygon("polygon_m", &walkable.polygon_m);
        let holes: Vec<String> =
            walkable.holes_m.iter().map(|hole_m| format!("    [\n{}    ],\n", packed(&corners(hole_m), 8))).collect();
        if !holes.is_empty() {
            text += &format!("holes_m = [\n{}]\n", holes.concat());
        }
        text.push('\n');
    }
    text
}

/// The tables `[[obstacles]]`.
pub(crate) fn obstacles(scene: &Scene) -> String {
    let mut text = String::new();
    for obstacle in &scene.obstacles {
        text += &commented("[[obstacles]]", &obstacle.origin);
        if obstacle.is_enclosure {
            text += "kind = \"enclosure\"\n";
        }
        text += &polygon("polygon_m", &obstacle.polygon_m);
        text.push('\n');
    }
    text
}

/// The tables `[[zones]]`.
pub(crate) fn closed_zones(scene: &Scene) -> String {
    let mut text = String::new();
    for zone in &scene.closed_zones {
        text += &commented("[[zones]]", &zone.origin);
        text += &polygon("polygon_m", &zone.polygon_m);
        let states: Vec<String> = zone.states.iter().map(|name| quoted(name)).collect();
        text += &format!("closed_in = [{}]\n\n", states.join(", "));
    }
    text
}

/// The tables `[[measure]]`.
pub(crate) fn measures(scene: &Scene) -> String {
    let table = |measure: &SceneMeasure| {
        let head = commented("[[measure]]", &measure.origin);
        format!("{head}name = {}\n{}\n\n", quoted(&measure.name), shape(&measure.shape))
    };
    scene.measures.iter().map(table).collect()
}

fn polygon(key: &str, corners_m: &[Point]) -> String {
    list(key, &corners(corners_m))
}

fn corners(corners_m: &[Point]) -> Vec<String> {
    corners_m.iter().map(|&corner_m| point(corner_m)).collect()
}
