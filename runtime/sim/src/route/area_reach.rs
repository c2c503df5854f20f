//! Areas that walls make useless, found before a simulation: goals without a route, ground apart from all walls to which
//! a state moves agents, sources in walls or off the walkable ground. World, metres.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, Vec2};

use crate::behaviour::{Area, Movement};
use crate::route::arrival::ARRIVAL_M;
use crate::route::crowd_routes::MeshClass;
use crate::route::mesh::RouteMesh;
use crate::route::mesh::gates::Gates;
use crate::route::one_way_reach::zone_against;
use crate::scenario::places::state_zones::StateZones;
use crate::scenario::{Scenario, ScenarioFault, ScenarioPart, WALL_RADIUS_M};
use crate::world::obstacles::Obstacles;

/// Rows and columns of the positions that are tried in an area.
const LATTICE: u16 = 16;
/// Overlap of a disc and a wall that is taken for rounding, m: the grid of walkable ground.
const TOUCH_M: f32 = 2e-3;
/// Distance from the mesh within which a position counts as on it, m: the step of the classes of wall radii.
const BESIDE_M: f64 = 0.05;

/// Checks the areas of sources, teleports and goals; `meshes` are those of all agents, by class.
///
/// # Errors
/// The first area that is of no use.
pub(crate) fn check_areas(
    scenario: &Scenario,
    walls: &Obstacles,
    meshes: &[(MeshClass, RouteMesh)],
) -> Result<(), ScenarioFault> {
    for index in 0..scenario.sources.len() {
        if source_starts_m(scenario, index, walls).next().is_none() {
            let message = format!("source {index} has no free ground: it lies in a wall or off the walkable ground");
            return ScenarioPart::Source(index)
                .fault(message, "move it until it is at least `wall_radius_m` from walls");
        }
    }
    for (index, state) in scenario.behaviour.states.iter().enumerate() {
        if state.settings.teleport.as_ref().is_some_and(|area| clear_m(area, WALL_RADIUS_M, walls).next().is_none()) {
            let message = format!("the area to which state `{}` teleports lies in walls", state.name);
            return ScenarioPart::State(index).fault(message, "move it to free ground");
        }
    }
    check_goals(scenario, walls, meshes)
}

/// Checks that an agent with states can reach each area of the goals that states go to.
fn check_goals(scenario: &Scenario, walls: &Obstacles, meshes: &[(MeshClass, RouteMesh)]) -> Result<(), ScenarioFault> {
    let starts = starts(scenario, walls, meshes);
    let sets: BTreeSet<usize> = scenario
        .behaviour
        .states
        .iter()
        .filter_map(|state| match state.movement {
            Movement::Goals { set, .. } => Some(set),
            _ => None,
        })
        .collect();
    let is_reached_by = |start: &AreaStart, at_m: Vec2, is_way_on: bool| {
        let mesh = &meshes[start.mesh].1;
        let from = mesh.nearest(DVec2::from(at_m), Some(mesh.parts[start.triangle as usize]), None);
        from.is_some_and(|from| {
            let beside_m = from.point_m.distance(DVec2::from(at_m));
            let is_near = beside_m < BESIDE_M || beside_m < ARRIVAL_M && walls.is_free(from.point_m.as_vec2(), at_m);
            let is_led = || mesh.leads(start.triangle, from.triangle) && !is_behind(mesh, start, from.triangle, at_m);
            is_near && (!is_way_on || is_led())
        })
    };
    let is_reached = |at_m: Vec2| starts.iter().any(|start| is_reached_by(start, at_m, true));
    for &index in sets.iter().filter(|_| !starts.is_empty()) {
        let set = &scenario.behaviour.goals[index];
        if let Some(goal) = set.areas.iter().find(|goal| !goal.area.lattice_m(LATTICE).any(is_reached)) {
            let [x, y] = goal.area.centre_m().to_array();
            let against = starts.iter().find(|start| is_reached_by(start, goal.area.centre_m(), false));
            if let Some(start) = against {
                let zone = zone_against(scenario, meshes[start.mesh].0, start.at_m, goal.area.centre_m());
                let zone = zone.map_or_else(|| "a one-way zone".to_owned(), |zone| format!("the one-way zone {zone}"));
                let set = &set.name;
                let message = format!("agents reach the area of goals `{set}` at [{x}, {y}] only against {zone}");
                let help = "move it, turn `one_way_deg`, or leave another way round the zone";
                return ScenarioPart::Goals(index).fault(message, help);
            }
            let message = format!("no route leads an agent to the area of goals `{}` at [{x}, {y}]", set.name);
            let help = "move it to ground that agents can reach, or widen a passage";
            return ScenarioPart::Goals(index).fault(message, help);
        }
    }
    Ok(())
}

/// Whether a position lies behind a start in the same one-way zone, out of reach, and no route leads around into the zone.
fn is_behind(mesh: &RouteMesh, start: &AreaStart, triangle: u32, at_m: Vec2) -> bool {
    mesh.gates.as_ref().is_some_and(|gates| {
        let cell = mesh.cell(triangle);
        cell == mesh.cell(start.triangle)
            && gates.zone(triangle).is_some_and(|zone| ahead_m(gates, zone, start.at_m, at_m) < -ARRIVAL_M)
            && !gates.leads_back(cell)
    })
}

fn ahead_m(gates: &Gates, zone: u32, from_m: Vec2, to_m: Vec2) -> f64 {
    gates.ahead_m(zone, DVec2::from(from_m), DVec2::from(to_m))
}

/// A position at which agents with states begin, one for each mesh and each part of it from which routes are alike. In
/// a one-way zone it is the one furthest behind, from which agents reach whatever they reach from the others.
struct AreaStart {
    /// Index of the mesh.
    mesh: usize,
    triangle: u32,
    at_m: Vec2,
}

fn starts(scenario: &Scenario, walls: &Obstacles, meshes: &[(MeshClass, RouteMesh)]) -> Vec<AreaStart> {
    let mut starts: BTreeMap<(usize, u32), AreaStart> = BTreeMap::new();
    let mut add = |mesh: usize, at_m: Vec2| {
        if let Some(at) = meshes[mesh].1.nearest(DVec2::from(at_m), None, None) {
            let of = &meshes[mesh].1;
            let start = starts.entry((mesh, of.cell(at.triangle)));
            let start = start.or_insert(AreaStart { mesh, triangle: at.triangle, at_m });
            let zone = of.gates.as_ref().and_then(|gates| Some((gates, gates.zone(at.triangle)?)));
            if zone.is_some_and(|(gates, zone)| ahead_m(gates, zone, start.at_m, at_m) < 0.0) {
                (start.triangle, start.at_m) = (at.triangle, at_m);
            }
        }
    };
    let mesh_of = |class: MeshClass| meshes.iter().position(|(of, _)| *of == class);
    let state_zones = StateZones::new(scenario);
    for agent in scenario.agents.iter().filter(|agent| agent.state != 0) {
        let sets = state_zones.route_sets(agent.closed_zones).into_iter();
        let classes = sets.map(|set| MeshClass::new(agent.wall_radius_m, set));
        classes.filter_map(mesh_of).for_each(|mesh| add(mesh, agent.position_m));
    }
    for (index, source) in scenario.sources.iter().enumerate().filter(|(_, source)| source.state != 0) {
        let class = |closed_zones| MeshClass::new(source.wall_radius_m, closed_zones);
        let sets = source.closed_zone_sets().into_iter().flat_map(|own| state_zones.route_sets(own));
        for mesh in sets.filter_map(|set| mesh_of(class(set))) {
            source_starts_m(scenario, index, walls).for_each(|at_m| add(mesh, at_m));
        }
    }
    for area in scenario.behaviour.states.iter().filter_map(|state| state.settings.teleport.as_ref()) {
        (0..meshes.len()).for_each(|mesh| clear_m(area, WALL_RADIUS_M, walls).for_each(|at_m| add(mesh, at_m)));
    }
    starts.into_values().collect()
}

/// Positions in a source's area at which agents can appear, m.
fn source_starts_m<'a>(scenario: &Scenario, index: usize, walls: &'a Obstacles) -> impl Iterator<Item = Vec2> + 'a {
    let source = &scenario.sources[index];
    let area = source.area.clone().unwrap_or_else(|| Area::rectangle(source.low_m, source.high_m));
    clear_m(&area, source.wall_radius_m, walls)
}

/// Positions in an area at which a disc overlaps no wall, m.
fn clear_m<'a>(area: &Area, radius_m: f32, walls: &'a Obstacles) -> impl Iterator<Item = Vec2> + use<'a> {
    let positions_m: Vec<Vec2> = area.lattice_m(LATTICE).collect();
    positions_m.into_iter().filter(move |&at_m| walls.depth_m(at_m, radius_m) <= TOUCH_M)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use motiondb::files::SourceText;

    use crate::scenario::parse;

    #[test]
    fn areas_that_no_agent_can_use_are_errors_at_their_table() {
        const ROOM: &str = "[[walkable]]\npolygon_m = [[-5, -5], [15, -5], [15, 5], [-5, 5]]\n\
            [[obstacles]]\nkind = 'enclosure'\npolygon_m = [[8, -2], [12, -2], [12, 2], [8, 2]]\n";
        let check = |goal: &str, set: &str, source: &str, line_and_part: Option<(usize, &str)>| {
            let text = format!(
                "duration_s = 5\n[goals.till]\nqueue = true\nareas = [{{ point_m = [3, 0] }}, {{ {goal} }}]\n\
                 [states.queue]\ngo = 'till'\n{set}\n[[agents]]\nat_m = [0, 0]\nstate = 'queue'\n\
                 [[sources]]\n{source}\nrate_per_s = 1\nstate = 'queue'\n{ROOM}"
            );
            let found = parse(&SourceText { path: PathBuf::from("x.toml"), text });
            match (found, line_and_part) {
                (Ok(_), None) => {}
                (Err(error), Some((line, part))) => {
                    let message = error.to_string();
                    assert!(message.contains(part) && message.contains(&format!(":{line}:")), "{message}");
                }
                (found, _) => panic!("{goal} {set} {source}: {:?}", found.map(|_| ())),
            }
        };
        let (near, here) = ("point_m = [4, 0]", "at_m = [0, 3]");
        check(near, "", here, None);
        check("rect_m = [5, 4.9, 6, 5]", "", here, None);
        for goal in ["point_m = [10, 0]", "point_m = [8.4, 0]", "circle_m = [0, 30, 2]", "rect_m = [20, 0, 30, 1]"] {
            check(goal, "", here, Some((2, "no route leads an agent to the area of goals `till`")));
        }
        check("point_m = [10, 0]", "set = { teleport = { point_m = [11, 0] } }", here, None);
        check(near, "set = { teleport = { rect_m = [30, 0, 33, 3] } }", here, Some((5, "`queue` teleports")));
        check(near, "", "rect_m = [30, 0, 33, 3]", Some((11, "source 0 has no free ground")));
    }
}
