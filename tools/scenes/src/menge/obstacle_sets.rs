//! Sets of obstacles: polygons, or the boundary of a navigation mesh; and the states in which agents see them. World,
//! metres.

use crate::error::SceneError;
use crate::geometry::polygon::{CORNERS_MAX, is_simple, signed_area_m2, without_repeats};
use crate::geometry::rings::with_holes;
use crate::geometry::walls::of_line;
use crate::menge::actions::ProfilesByState;
use crate::menge::files::ProjectFiles;
use crate::menge::nav_mesh::NavMesh;
use crate::menge::profiles::{ExplicitSet, Profiles};
use crate::menge::transitions::States;
use crate::menge::xml::Element;
use crate::scene::{ClosedZone, Point, Scene, SceneObstacle};

/// Least area of an obstacle, m²; that of scenario files.
const AREA_MIN_M2: f64 = 1e-4;

/// Greatest number of zones that are closed in states; that of scenario files.
const CLOSED_MAX: usize = 32;

/// Reads one set into the scene.
pub(crate) fn read_obstacle_set(
    files: &mut ProjectFiles,
    set: &Element<'_>,
    profiles: &mut Profiles,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    let (shown, line) = (&set.file.shown, set.line());
    let class = set.count("class")?.unwrap_or(1);
    if set.kind() == "explicit" {
        let first = scene.obstacles.len();
        set.named("Obstacle").try_for_each(|obstacle| read_obstacle(&obstacle, scene))?;
        let obstacles = first..scene.obstacles.len();
        profiles.sets.push(ExplicitSet { class, obstacles, origin: (shown.clone(), line) });
        return Ok(());
    }
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

/// Decides what becomes of each set of polygons, by the states in which agents see it:
///
/// 1. in none: it is left out;
/// 2. in all: its polygons are obstacles, where only some agents see it too;
/// 3. in some: its solid polygons are zones that are closed in these states.
pub(crate) fn settle_sets(
    profiles: &Profiles,
    elements: &States<'_>,
    by_state: &ProfilesByState<'_>,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    let masks = masks_by_state(elements, by_state, scene)?;
    let mut kept = vec![true; scene.obstacles.len()];
    for ExplicitSet { class, obstacles, origin: (shown, line) } in &profiles.sets {
        let sees = |mask: &u64| mask & class != 0;
        let seeing: Vec<&(String, Vec<u64>)> = masks.iter().filter(|(_, masks)| masks.iter().any(sees)).collect();
        if masks.is_empty() {
            continue;
        }
        if seeing.is_empty() {
            let what = format!("no agent sees the obstacles of class {class}; they are left out");
            scene.notes.add(shown, *line, what, false);
            kept[obstacles.clone()].fill(false);
            continue;
        }
        if seeing.iter().any(|(_, masks)| !masks.iter().all(sees)) {
            let what = format!("only some agents see the obstacles of class {class}; here all agents do");
            scene.notes.add(shown, *line, what, true);
        }
        if seeing.len() < masks.len() {
            let states: Vec<String> = seeing.iter().map(|(state, _)| state.clone()).collect();
            close_in(&states, obstacles.clone(), (shown, *line), &mut kept, scene);
        }
    }
    let mut kept = kept.into_iter();
    scene.obstacles.retain(|_| kept.next().unwrap_or(true));
    Ok(())
}

/// Makes zones of the obstacles of a set that agents see in some states only.
fn close_in(
    states: &[String],
    obstacles: std::ops::Range<usize>,
    (shown, line): (&str, usize),
    kept: &mut [bool],
    scene: &mut Scene,
) {
    let solid: Vec<usize> = obstacles.clone().filter(|&index| !scene.obstacles[index].is_enclosure).collect();
    if scene.closed_zones.len() + solid.len() > CLOSED_MAX {
        let what = format!(
            "a scenario closes at most {CLOSED_MAX} zones in states; agents see these obstacles in all states here"
        );
        return scene.notes.add(shown, line, what, true);
    }
    if solid.len() < obstacles.len() {
        scene.notes.add(shown, line, "agents see the walls around them in all states here", true);
    }
    for index in solid {
        kept[index] = false;
        let SceneObstacle { polygon_m, origin, .. } = scene.obstacles[index].clone();
        scene.closed_zones.push(ClosedZone { polygon_m, states: states.to_vec(), origin });
    }
}

/// For each state that agents get into, the masks of the sets that they see there.
fn masks_by_state(
    elements: &States<'_>,
    by_state: &ProfilesByState<'_>,
    scene: &mut Scene,
) -> Result<Vec<(String, Vec<u64>)>, SceneError> {
    let Scene { states, notes, .. } = scene;
    let mut found = Vec::new();
    for state in states {
        let Some(profiles) = by_state.get(&state.name).filter(|profiles| !profiles.is_empty()) else { continue };
        let mut masks: Vec<u64> = profiles.iter().map(|profile| profile.obstacle_mask).collect();
        let actions = elements.get(state.name.as_str()).map(|element| element.named("Action"));
        for action in actions.into_iter().flatten() {
            let change: fn(u64, u64) -> u64 = match action.kind() {
                "set_obstacle" => |_, operand| operand,
                "add_obstacle" => |mask, operand| mask | operand,
                "remove_obstacle" => |mask, operand| mask & !operand,
                _ => continue,
            };
            let operand = action.count("operand")?;
            let operand =
                operand.ok_or_else(|| action.fault("the action has no `operand`", "write `operand=\"1\"`"))?;
            masks.iter_mut().for_each(|mask| *mask = change(*mask, operand));
            if !action.flag("exit_reset", true)? {
                let what = "a change of the obstacles that agents see ends with the state here";
                notes.add(&action.file.shown, action.line(), what, true);
            }
        }
        found.push((state.name.clone(), masks));
    }
    Ok(found)
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
