//! Goals that agents reach only against the direction of one-way zones, found before a simulation. World, metres.

use glam::{DVec2, Vec2};

use crate::route::crowd_routes::MeshClass;
use crate::route::field::shortest_route;
use crate::route::mesh::RouteMesh;
use crate::scenario::{AgentSpec, Scenario, ScenarioFault, ScenarioPart};

/// Greatest number of routes that are searched through one-way zones with walls in them, or from and to their inside.
pub(crate) const SEARCHES_MAX: usize = 500;

/// Checks that one-way zones let an agent pass from its start to its first goal, and from goal to goal.
///
/// # Errors
/// The first goal to which no route leads on.
pub(crate) fn check_directions(
    part: &ScenarioPart,
    name: &str,
    agent: &AgentSpec,
    mesh: &RouteMesh,
    scenario: &Scenario,
    searches: &mut usize,
) -> Result<(), ScenarioFault> {
    if mesh.gates.is_none() {
        return Ok(());
    }
    let starts_m = std::iter::once(&agent.position_m).chain(&agent.goals_m);
    for (&from_m, &goal_m) in starts_m.zip(&agent.goals_m) {
        if is_way_on(mesh, from_m, goal_m, searches) {
            continue;
        }
        let [x, y] = goal_m.to_array();
        let zone = zone_against(scenario, MeshClass::of(agent), from_m, goal_m);
        let zone = zone.map_or_else(|| "a one-way zone".to_owned(), |zone| format!("the one-way zone {zone}"));
        return part.fault(
            format!("{name} reaches the goal [{x}, {y}] only against the direction of {zone}"),
            "move the goal, turn `one_way_deg`, or leave another way round the zone",
        );
    }
    Ok(())
}

/// Whether a route leads on through one-way zones. Where both ends lie outside all zones and no walls stand in these,
/// their gates decide; else a route is searched, for as many pairs as there are `searches`.
fn is_way_on(mesh: &RouteMesh, from_m: Vec2, to_m: Vec2, searches: &mut usize) -> bool {
    let [from, to] = [from_m, to_m].map(|at_m| mesh.nearest(DVec2::from(at_m), None, None));
    let (Some(from), Some(to), Some(gates)) = (from, to, mesh.gates.as_ref()) else { return true };
    if !mesh.leads(from.triangle, to.triangle) {
        return false;
    }
    let is_within = [from, to].iter().any(|at| gates.zone(at.triangle).is_some());
    if *searches == 0 || !(is_within || gates.have_corners) {
        return true;
    }
    *searches -= 1;
    shortest_route(mesh, from_m, to_m).is_some()
}

/// Index of the zone through which the shortest route without directions leads the wrong way.
pub(crate) fn zone_against(scenario: &Scenario, class: MeshClass, from_m: Vec2, to_m: Vec2) -> Option<usize> {
    let (points_m, one_way) = (scenario.points_m(), scenario.one_way_zones());
    let obstacles_m = scenario.solids_m(&[], class.closed_zones);
    let mesh = RouteMesh::new(&scenario.ground(&obstacles_m, &points_m, &one_way), class.radius_m()).ok()?;
    let corners_m = shortest_route(&mesh, from_m, to_m)?.corners_m;
    let mut stretches = std::iter::once(&from_m).chain(&corners_m).zip(&corners_m);
    stretches.find_map(|(&from_m, &to_m)| {
        let zones = scenario.zones.iter().enumerate();
        let mut against = zones.filter(|(_, zone)| zone.one_way().is_some_and(|zone| zone.is_against(from_m, to_m)));
        against.next().map(|(index, _)| index)
    })
}
