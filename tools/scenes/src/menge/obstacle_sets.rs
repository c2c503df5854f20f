//! Sets of obstacles: polygons, or the boundary of a navigation mesh. World, metres.

use crate::error::SceneError;
use crate::geometry::polygon::{CORNERS_MAX, is_simple, signed_area_m2, without_repeats};
use crate::geometry::rings::with_holes;
use crate::geometry::walls::of_line;
use crate::menge::files::ProjectFiles;
use crate::menge::nav_mesh::NavMesh;
use crate::menge::profiles::Profiles;
use crate::menge::xml::Element;
use crate::scene::{Point, Scene, SceneObstacle};

/// Least area of an obstacle, m²; that of scenario files.
const AREA_MIN_M2: f64 = 1e-4;

/// Reads one set into the scene.
pub(crate) fn read_obstacle_set(
    files: &mut ProjectFiles,
    set: &Element<'_>,
    profiles: &Profiles,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    let (shown, line) = (&set.file.shown, set.line());
    let class = set.count("class")?.unwrap_or(1);
    match profiles.see(class) {
        [false, _] if scene.agent_count() > 0 => {
            let what = format!("no agent sees the obstacles of class {class}; they are left out");
            scene.notes.add(shown, line, what, false);
            return Ok(());
        }
        [true, false] => {
            let what = format!("only some agents see the obstacles of class {class}; here all agents do");
            scene.notes.add(shown, line, what, true);
        }
        _ => {}
    }
    match set.kind() {
        "explicit" => set.named("Obstacle").try_for_each(|obstacle| read_obstacle(&obstacle, scene)),
        "nav_mesh" => {
            let text = files.text(set, "file_name")?;
            let mesh = NavMesh::parse(&text)?;
            let origin = files.shown(&text.path);
            scene.walkable.extend(with_holes(mesh.outlines_m(), &origin));
            let walls_m = mesh.walls_m();
            if !walls_m.is_empty() {
                scene.notes.add(&origin, 0, "walls within the mesh become 2 cm thick", false);
            }
            for polygon_m in walls_m.iter().flat_map(|ends_m| of_line(ends_m, false)) {
                scene.obstacles.push(SceneObstacle { polygon_m, is_enclosure: false, origin: origin.clone() });
            }
            Ok(())
        }
        kind => {
            scene.notes.add(shown, line, format!("the obstacle set \"{kind}\" is unknown and left out"), true);
            Ok(())
        }
    }
}

fn read_obstacle(obstacle: &Element<'_>, scene: &mut Scene) -> Result<(), SceneError> {
    let vertices = obstacle.named("Vertex").take(CORNERS_MAX + 1);
    let corners_m: Vec<Point> = vertices.map(|vertex| vertex.point("p_x", "p_y")).collect::<Result<_, _>>()?;
    if corners_m.len() > CORNERS_MAX {
        let message = format!("the obstacle has more than {CORNERS_MAX} corners");
        return Err(obstacle.fault(message, "simplify it"));
    }
    let (shown, line, origin) = (&obstacle.file.shown, obstacle.line(), obstacle.origin());
    let corners_m = without_repeats(&corners_m);
    let mut add = |polygon_m: Vec<Point>, is_enclosure: bool| {
        scene.obstacles.push(SceneObstacle { polygon_m, is_enclosure, origin: origin.clone() });
    };
    let is_closed = obstacle.flag("closed", false)?;
    let area_m2 = signed_area_m2(&corners_m);
    if is_closed && is_simple(&corners_m) && area_m2.abs() >= AREA_MIN_M2 {
        add(corners_m, area_m2 < 0.0);
        return Ok(());
    }
    let walls_m = of_line(&corners_m, is_closed);
    if walls_m.is_empty() {
        scene.notes.add(shown, line, "an obstacle without extent is left out", false);
        return Ok(());
    }
    walls_m.into_iter().for_each(|wall_m| add(wall_m, false));
    let what = match is_closed {
        false => "an open obstacle becomes walls 2 cm thick",
        true => "an obstacle that crosses or touches itself becomes walls 2 cm thick along its edges",
    };
    scene.notes.add(shown, line, what, is_closed);
    Ok(())
}
