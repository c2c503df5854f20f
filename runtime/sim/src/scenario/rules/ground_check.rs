//! The rules of the polygons of a scenario's ground: corners in range, simple, with an area. World, metres.

use glam::Vec2;

use crate::maths::polygon::{self_contact_m, signed_area_m2};
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::ranges::{check_points, within};
use crate::scenario::resolved::Scenario;

/// Greatest number of obstacles, enclosures among them.
pub(crate) const OBSTACLES_MAX: usize = 10_000;
/// Greatest number of doors: each asks in every step in which it closes whether an agent stands in it.
const DOORS_MAX: usize = 1_000;
/// Greatest number of corners of an obstacle: the test for self-intersection compares every pair of edges.
pub(crate) const OBSTACLE_CORNERS_MAX: usize = 1_000;
/// Greatest number of corners of all obstacles, enclosures and doors: 25 for each of the greatest number of obstacles.
/// Time and memory of the walkable ground grow with it.
pub(crate) const OBSTACLES_CORNERS_MAX: usize = 250_000;
/// Greatest number of corners of an outline or hole of walkable ground: plans of whole buildings have hundreds.
const WALKABLE_CORNERS_MAX: usize = 5_000;
/// Greatest number of corners of all walkable polygons.
pub(crate) const CORNERS_MAX: usize = 200_000;
/// Least area of a polygon, m²: thinner slivers have no inside.
const AREA_MIN_M2: f64 = 1e-4;
/// How to mend a polygon that crosses itself.
const IN_ORDER: &str = "list each corner once, in order around the polygon, and give walls a thickness";

/// Checks every polygon; their coordinates are in range.
///
/// # Errors
/// The first polygon that is not simple, or has too many corners.
pub(crate) fn check_ground(scenario: &Scenario) -> Result<(), ScenarioFault> {
    for (index, polygon_m) in scenario.obstacles_m.iter().enumerate() {
        check_polygon(&ScenarioPart::Obstacle(index), &format!("obstacle {index}"), polygon_m, OBSTACLE_CORNERS_MAX)?;
    }
    for (index, door) in scenario.doors.iter().enumerate() {
        check_polygon(&ScenarioPart::Door(index), "the door", &door.polygon_m, OBSTACLE_CORNERS_MAX)?;
    }
    for (index, polygon_m) in scenario.enclosures_m.iter().enumerate() {
        check_polygon(&ScenarioPart::Enclosure(index), &format!("enclosure {index}"), polygon_m, OBSTACLE_CORNERS_MAX)?;
    }
    for (index, polygon) in scenario.walkable_m.iter().enumerate() {
        let (part, name) = (ScenarioPart::Walkable(index), format!("walkable polygon {index}"));
        check_polygon(&part, &name, &polygon.outline_m, WALKABLE_CORNERS_MAX)?;
        for (hole, hole_m) in polygon.holes_m.iter().enumerate() {
            check_polygon(&part, &format!("hole {hole} of {name}"), hole_m, WALKABLE_CORNERS_MAX)?;
        }
    }
    Ok(())
}

/// Checks the number and the coordinates of all corners.
///
/// # Errors
/// The first number that is out of range.
pub(crate) fn check_ground_ranges(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let (obstacle, obstacles) = (&ScenarioPart::Obstacle(0), scenario.obstacles_m.len() + scenario.enclosures_m.len());
    within(obstacle, "the number of obstacles", obstacles, &(0..=OBSTACLES_MAX), "give fewer")?;
    for (index, polygon_m) in scenario.obstacles_m.iter().enumerate() {
        check_points(&ScenarioPart::Obstacle(index), polygon_m)?;
    }
    let (door, doors) = (&ScenarioPart::Door(0), scenario.doors.len());
    within(door, "the number of doors", doors, &(0..=DOORS_MAX), "give fewer")?;
    for (index, door) in scenario.doors.iter().enumerate() {
        let (part, signals) = (ScenarioPart::Door(index), scenario.behaviour.signals.len());
        check_points(&part, &door.polygon_m)?;
        if door.signal as usize >= signals {
            return part.fault("the door has a signal that there is not".into(), "name one of the signals");
        }
    }
    for (index, polygon_m) in scenario.enclosures_m.iter().enumerate() {
        check_points(&ScenarioPart::Enclosure(index), polygon_m)?;
    }
    let doors_m = scenario.doors.iter().map(|door| &door.polygon_m);
    let all_m = scenario.obstacles_m.iter().chain(&scenario.enclosures_m).chain(doors_m);
    let corners = all_m.map(Vec::len).sum();
    within(obstacle, "the number of corners of all obstacles", corners, &(0..=OBSTACLES_CORNERS_MAX), "give fewer")?;
    let mut corners = 0;
    for (index, polygon) in scenario.walkable_m.iter().enumerate() {
        let part = ScenarioPart::Walkable(index);
        let rings_m = || [&polygon.outline_m].into_iter().chain(&polygon.holes_m);
        rings_m().try_for_each(|ring_m| check_points(&part, ring_m))?;
        corners += rings_m().map(|ring_m| ring_m.len()).sum::<usize>();
        within(&part, "the number of corners of all walkable polygons", corners, &(0..=CORNERS_MAX), "give fewer")?;
    }
    Ok(())
}

fn check_polygon(part: &ScenarioPart, name: &str, polygon_m: &[Vec2], corners_max: usize) -> Result<(), ScenarioFault> {
    let wrong = |what: String, help| part.fault(format!("{name} {what}"), help);
    let corners = polygon_m.len();
    if !(3..=corners_max).contains(&corners) {
        let help = match corners_max {
            OBSTACLE_CORNERS_MAX => "give 3 to 1000 corners; do not repeat the first one at the end",
            _ => "give 3 to 5000 corners",
        };
        return wrong(format!("has {corners} corners"), help);
    }
    if let Some(at_m) = self_contact_m(polygon_m) {
        return wrong(format!("crosses or touches itself at [{:.2}, {:.2}]", at_m.x, at_m.y), IN_ORDER);
    }
    if signed_area_m2(polygon_m).abs() < AREA_MIN_M2 {
        return wrong("has no area".into(), "give walls a thickness");
    }
    Ok(())
}
