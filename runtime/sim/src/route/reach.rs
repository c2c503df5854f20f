//! What walls keep agents from, found before a simulation: goals without a route, and passages that are too narrow.
//!
//! An agent can reach a goal if the part of the mesh in which it starts comes within an arrival's distance of it. The
//! mesh keeps the wall radius alone here; clearance opens and closes nothing. World, metres.

use glam::{DVec2, Vec2};

use crate::route::area_reach::check_areas;
use crate::route::arrival::ARRIVAL_M;
use crate::route::crowd_routes::MeshClass;
use crate::route::mesh::{ClosedPassage, RouteMesh, closed_passages};
use crate::route::one_way_reach::{SEARCHES_MAX, check_directions};
use crate::scenario::places::state_zones::StateZones;
use crate::scenario::{AgentSpec, Scenario, ScenarioFault, ScenarioPart, SourceSpec, WALL_RADIUS_M};
use crate::world::obstacles::Obstacles;

/// Overlap of a start and a wall that is taken for rounding, m: the grid of walkable ground.
const TOUCH_M: f32 = 2e-3;
/// Distance from the mesh from which a start counts as off it, m: two steps of the classes of wall radii.
const OFF_MESH_M: f64 = 0.1;

/// The passages of a scene that are closed to agents of a wall radius.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedToAgents {
    /// The wall radius, m.
    pub wall_radius_m: f32,
    /// The passages: those that separate first, the widest first.
    pub passages: Vec<ClosedPassage>,
}

/// Checks that every agent starts on free ground, and that routes lead to its goals and to the areas of all goals.
///
/// # Errors
/// The first agent or source without a start or a route.
pub(crate) fn check_reach(scenario: &Scenario) -> Result<(), ScenarioFault> {
    if scenario.is_open() {
        return Ok(());
    }
    let (walls, points_m) = (scenario.walls(), scenario.points_m());
    let mut searches = SEARCHES_MAX;
    let mut meshes: Vec<(MeshClass, RouteMesh)> = Vec::new();
    let agents = scenario.agents.iter().enumerate().map(|(index, agent)| (ScenarioPart::Journey(index), agent.clone()));
    let state_zones = StateZones::new(scenario);
    let sources = scenario.sources.iter().enumerate().flat_map(|(index, source)| {
        let agent = source.agent(source.middle_m());
        let of_set = move |closed_zones| (ScenarioPart::Source(index), AgentSpec { closed_zones, ..agent.clone() });
        source.closed_zone_sets().into_iter().map(of_set)
    });
    for (part, agent) in agents.chain(sources) {
        let class = MeshClass::of(&agent);
        if !meshes.iter().any(|(of, _)| *of == class) {
            meshes.push((class, mesh(scenario, &points_m, class)?));
        }
        let mesh = meshes.iter().find(|(of, _)| *of == class).map(|(_, mesh)| mesh);
        let Some(mesh) = mesh else { continue };
        check_start(&part, &agent, &walls)?;
        check_goals(&part, &agent, mesh, scenario)?;
        for closed_zones in state_zones.route_sets(agent.closed_zones) {
            let class = MeshClass::new(agent.wall_radius_m, closed_zones);
            if !meshes.iter().any(|(of, _)| *of == class) {
                meshes.push((class, self::mesh(scenario, &points_m, class)?));
            }
        }
        let mesh = meshes.iter().find(|(of, _)| *of == class).map(|(_, mesh)| mesh);
        let Some(mesh) = mesh else { continue };
        check_directions(&part, &name(&part), &agent, mesh, scenario, &mut searches)?;
    }
    check_areas(scenario, &walls, &meshes)
}

/// The passages that are closed, for every class of wall radii among the agents, or for that of an agent by default
/// where there are no agents; none without walls.
pub fn closed_to_agents(scenario: &Scenario) -> Vec<ClosedToAgents> {
    let state_zones = StateZones::new(scenario);
    let of_source = |source: &SourceSpec| {
        source.closed_zone_sets().into_iter().map(|set| (source.wall_radius_m, set)).collect::<Vec<_>>()
    };
    let of_agents = scenario.agents.iter().map(|agent| (agent.wall_radius_m, agent.closed_zones));
    let of_plan = scenario.is_plan().then_some((WALL_RADIUS_M, 0));
    let found = of_agents.chain(scenario.sources.iter().flat_map(of_source)).chain(of_plan);
    let in_states = |(wall_radius_m, own): (f32, u32)| {
        state_zones.route_sets(own).into_iter().map(move |set| MeshClass::new(wall_radius_m, set)).collect::<Vec<_>>()
    };
    let mut classes: Vec<MeshClass> = if scenario.is_open() { Vec::new() } else { found.flat_map(in_states).collect() };
    classes.sort_unstable();
    classes.dedup();
    let closed =
        |class: MeshClass| ClosedToAgents { wall_radius_m: class.radius_m(), passages: closed(scenario, class) };
    classes.into_iter().map(closed).filter(|closed| !closed.passages.is_empty()).collect()
}

fn closed(scenario: &Scenario, class: MeshClass) -> Vec<ClosedPassage> {
    let (points_m, one_way) = (scenario.points_m(), scenario.one_way_zones());
    let Ok(mesh) = mesh(scenario, &points_m, class) else { return Vec::new() };
    let obstacles_m = scenario.solids_m(&[], class.closed_zones);
    closed_passages(&scenario.ground(&obstacles_m, &points_m, &one_way), class.radius_m(), &mesh).unwrap_or_default()
}

fn mesh(scenario: &Scenario, points_m: &[Vec2], class: MeshClass) -> Result<RouteMesh, ScenarioFault> {
    let obstacles_m = scenario.solids_m(&[], class.closed_zones);
    let one_way = scenario.one_way_zones();
    RouteMesh::new(&scenario.ground(&obstacles_m, points_m, &one_way), class.radius_m())
        .and_then(|mesh| mesh.with_one_way(&one_way))
        .or_else(|error| ScenarioPart::Obstacle(0).fault(error.to_string(), "look for walls that nearly touch"))
}

/// Obstacles are checked one by one before; here enclosures and the edge of walkable ground count too.
fn check_start(part: &ScenarioPart, agent: &AgentSpec, walls: &Obstacles) -> Result<(), ScenarioFault> {
    let [x, y] = agent.position_m.to_array();
    let is_at_source = matches!(part, ScenarioPart::Source(_));
    if is_at_source || walls.depth_m(agent.position_m, agent.wall_radius_m) <= TOUCH_M {
        return Ok(());
    }
    part.fault(
        format!("{} starts at [{x}, {y}], in a wall or off the walkable ground", name(part)),
        "move it until it is at least `wall_radius_m` from every wall",
    )
}

fn check_goals(
    part: &ScenarioPart,
    agent: &AgentSpec,
    mesh: &RouteMesh,
    scenario: &Scenario,
) -> Result<(), ScenarioFault> {
    let off_m = |point_m: Vec2, part: Option<u32>| {
        let at = mesh.nearest(DVec2::from(point_m), part, None)?;
        Some((mesh.parts[at.triangle as usize], at.point_m.distance(DVec2::from(point_m))))
    };
    let Some((start, start_off_m)) = off_m(agent.position_m, None) else { return Ok(()) };
    if start_off_m > OFF_MESH_M {
        return Ok(());
    }
    for &goal_m in &agent.goals_m {
        let is_near = |part| off_m(goal_m, part).is_some_and(|(_, off_m)| off_m < ARRIVAL_M);
        let ([x, y], name) = (goal_m.to_array(), name(part));
        if !is_near(None) {
            let message = format!("the goal [{x}, {y}] of {name} lies inside a wall or off the walkable ground");
            return part.fault(message, "move the goal to free ground");
        }
        if !is_near(Some(start)) {
            let closed = closed(scenario, MeshClass::of(agent)).into_iter().find(|passage| passage.separates);
            let widest = closed.map_or_else(String::new, |ClosedPassage { at_m, width_m, .. }| {
                format!("; the widest closed passage is {width_m:.2} m wide, at [{:.2}, {:.2}]", at_m.x, at_m.y)
            });
            return part.fault(
                format!("no route leads {name} to the goal [{x}, {y}]{widest}"),
                "move the goal, or give a passage more than twice `wall_radius_m` of width",
            );
        }
    }
    Ok(())
}

fn name(part: &ScenarioPart) -> String {
    match part {
        ScenarioPart::Source(index) => format!("source {index}"),
        ScenarioPart::Journey(index) => format!("agent {index}"),
        _ => "an agent".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::behaviour::Area;
    use crate::scenario::places::zone_spec::ZoneSpec;

    fn block(low: [f32; 2], high: [f32; 2]) -> Vec<Vec2> {
        [low, [high[0], low[1]], high, [low[0], high[1]]].map(Vec2::from).to_vec()
    }

    /// An agent at the origin with a goal, and the walls of a room about the goal with a door.
    fn room(goal_m: [f32; 2], door_m: f32) -> Scenario {
        let obstacles_m = vec![
            block([5.0, -2.0], [5.2, -0.5 * door_m]),
            block([5.0, 0.5 * door_m], [5.2, 2.0]),
            block([5.0, 2.0], [9.2, 2.2]),
            block([5.0, -2.2], [9.2, -2.0]),
            block([9.0, -2.2], [9.2, 2.2]),
        ];
        let agent = AgentSpec { goals_m: vec![Vec2::from(goal_m)], ..AgentSpec::default() };
        Scenario { obstacles_m, ..Scenario::of(vec![agent]) }
    }

    fn message(scenario: &Scenario) -> Option<String> {
        check_reach(scenario).err().map(|fault| fault.message)
    }

    #[test]
    fn goals_behind_narrow_doors_are_unreachable() {
        assert_eq!(message(&room([7.0, 0.0], 0.5)), None);
        let closed = message(&room([7.0, 0.0], 0.3)).unwrap_or_default();
        assert!(closed.contains("to the goal [7, 0]; the widest closed passage is 0.30 m wide, at [5."), "{closed}");
        let passages = closed_to_agents(&room([7.0, 0.0], 0.3));
        assert!(passages.len() == 1 && passages[0].passages[0].separates, "{passages:?}");
        assert!(closed_to_agents(&room([7.0, 0.0], 0.5)).is_empty());
    }

    /// A corridor of 20 × 4 m with one-way zones, as x from, x to, and degrees.
    fn corridor(from_m: [f32; 2], goals_m: &[[f32; 2]], zones: &[[f32; 3]]) -> Scenario {
        let agent = AgentSpec {
            position_m: Vec2::from(from_m),
            goals_m: goals_m.iter().copied().map(Vec2::from).collect(),
            ..AgentSpec::default()
        };
        let zone = |&[from, to, one_way_deg]: &[f32; 3]| ZoneSpec {
            area: Area::rectangle(Vec2::new(from, 0.0), Vec2::new(to, 4.0)),
            speed_factor: 1.0,
            is_closed: false,
            closed_in: Vec::new(),
            one_way_deg: Some(one_way_deg),
        };
        let enclosures_m = vec![block([0.0, 0.0], [20.0, 4.0])];
        Scenario { enclosures_m, zones: zones.iter().map(zone).collect(), ..Scenario::of(vec![agent]) }
    }

    #[test]
    fn goals_against_a_one_way_zone_are_unreachable() {
        let check = |from_m, goals_m: &[[f32; 2]], zones: &[[f32; 3]], expected: Option<&str>| {
            let found = message(&corridor(from_m, goals_m, zones));
            let is_expected = match (&found, expected) {
                (Some(found), Some(expected)) => found.contains(expected),
                (found, expected) => found.is_none() && expected.is_none(),
            };
            assert!(is_expected, "{from_m:?} {goals_m:?} {zones:?}: {found:?}");
        };
        let (left, right) = ([2.0, 2.0], [18.0, 2.0]);
        let zone = [[8.0, 12.0, 0.0]];
        check(left, &[right], &zone, None);
        check(right, &[left], &zone, Some("the goal [2, 2] only against the direction of the one-way zone 0"));
        check(left, &[right, left], &zone, Some("the goal [2, 2] only against"));
        check(left, &[right], &[[3.0, 5.0, 0.0], [8.0, 12.0, 180.0]], Some("the one-way zone 1"));
        // Within the zone.
        check([9.0, 2.0], &[[11.0, 1.0]], &zone, None);
        check([11.0, 2.0], &[[9.0, 1.0]], &zone, Some("the goal [9, 1] only against"));
        check([11.0, 2.0], &[right], &zone, None);
        check([11.0, 2.0], &[left], &zone, Some("one-way zone 0"));
        check(left, &[[11.0, 2.0]], &zone, None);
        check(right, &[[11.0, 2.0]], &zone, Some("one-way zone 0"));
    }

    #[test]
    fn goals_deep_in_walls_are_found() {
        let mut scenario = room([20.0, 0.0], 1.0);
        scenario.obstacles_m.push(block([18.0, -2.0], [22.0, 2.0]));
        assert!(message(&scenario).unwrap_or_default().contains("lies inside a wall"));
        // An arrival's distance from free ground is near enough.
        scenario.agents[0].goals_m[0].x = 18.0;
        assert_eq!(message(&scenario), None);
    }

    #[test]
    fn starts_off_the_walkable_ground_are_found() {
        let mut scenario = room([3.0, 0.0], 1.0);
        scenario.obstacles_m.clear();
        scenario.enclosures_m = vec![block([-1.0, -1.0], [4.0, 1.0])];
        assert_eq!(message(&scenario), None);
        scenario.agents[0].position_m = Vec2::new(-0.95, 0.0);
        assert!(message(&scenario).unwrap_or_default().contains("in a wall"));
        scenario.agents[0].position_m = Vec2::new(-3.0, 0.0);
        assert!(message(&scenario).unwrap_or_default().contains("no route leads agent 0"));
    }
}
