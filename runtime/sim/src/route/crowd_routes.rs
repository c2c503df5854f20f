//! Routes of all agents around walls: what is made once for a scene, and the next corner of an agent. World, metres.
//!
//! Agents with one wall radius share a mesh. Agents with one waypoint share a field, which answers from everywhere;
//! a waypoint of few agents is searched for each of them, and searched again when the next corner is out of sight.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, Vec2};

use crate::behaviour::{Area, GoalRef};
use crate::route::field::{RouteField, RouteGoal, RoutePosition, RouteStep, shortest_route};
use crate::route::mesh::{RouteError, RouteMesh};
use crate::route::standing_position::StandingPosition;
use crate::scenario::places::state_zones::StateZones;
use crate::scenario::{AgentSpec, Scenario, WALL_RADIUS_M};

/// Agents from which on a waypoint has a field.
const SHARED_MIN: usize = 4;
/// Greatest number of fields; the waypoints that most agents share have them. A field of a town takes 3 MB.
const FIELDS_MAX: usize = 64;
/// Memory of the fields of areas from which on further areas have none, bytes.
const AREA_FIELDS_MAX_BYTES: usize = 256 << 20;
/// Step of wall radii that share a mesh, m; radii are rounded up.
const RADIUS_STEP_M: f32 = 0.05;
/// Distance within which a corner of an own route is passed, m.
const PASSED_M: f32 = 0.01;
/// Distance of a waypoint from the mesh at which agents come near it, m: an arrival.
const BESIDE_M: f32 = 0.5;
/// Distance that routes keep from walls beyond the wall radius, where there is room, m (docs/tuning.md).
const CLEARANCE_M: f64 = 0.15;

/// Meshes and fields of a scene with walls.
#[derive(Clone, Debug, Default)]
pub struct CrowdRoutes {
    /// Number that tells these routes from those with other doors closed; 0 with all doors open.
    id: u32,
    /// Mesh of each class of agents.
    meshes: Vec<(MeshClass, RouteMesh)>,
    fields: Vec<RouteField>,
    /// Index of the field of a waypoint, by class and coordinates.
    field_of: BTreeMap<WaypointKey, usize>,
    /// Index of the field of an area of a goal, by class.
    area_field_of: BTreeMap<(MeshClass, GoalRef), usize>,
    /// Areas of goals that lie wholly in zones that agents do not enter, by bits.
    barred: BTreeSet<(u32, GoalRef)>,
}

/// Agents that share a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct MeshClass {
    /// Number of steps up to the wall radius.
    steps: u32,
    /// Zones that the agents do not enter, by bits.
    pub(crate) closed_zones: u32,
}

/// Class, and the bits of the coordinates.
type WaypointKey = (MeshClass, [u32; 2]);

/// What an agent remembers of its route.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RouteMemory {
    /// The routes to which the memory belongs, by id.
    of: u32,
    position: RoutePosition,
    /// Its own route, where its waypoint has no field.
    own: Option<OwnRoute>,
    /// The closed door on its route, where no route leads through the doors that are open.
    pub(crate) door: Option<Box<DoorAhead>>,
}

/// A closed door before which an agent waits, and its route there: as with all doors open.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct DoorAhead {
    pub(crate) memory: RouteMemory,
    /// Free path until the door, m; set by each query of the route.
    pub(crate) free_m: Option<f32>,
    /// Where the agent stands, or will stand, before the door; none before it brakes.
    pub(crate) standing: Option<StandingPosition>,
}

/// A route to a waypoint of few agents.
#[derive(Clone, Debug, PartialEq)]
struct OwnRoute {
    to_m: Vec2,
    /// Corners that lie ahead and the end, the next one last.
    corners_m: Vec<Vec2>,
}

/// The end of a route that is not a waypoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RouteEnd {
    /// The position, m.
    pub position_m: Vec2,
    /// The area of a goal in which it lies; none of a position alone.
    pub area: Option<GoalRef>,
}

/// The next part of an agent's route.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NextCorner {
    /// Length of the route to the waypoint, m.
    pub distance_m: f32,
    /// The next corner, or the waypoint, m.
    pub corner_m: Vec2,
    /// The point after it, m; none where `corner_m` is the waypoint.
    pub after_m: Option<Vec2>,
    /// The nearest point of the mesh, m, where the agent is nearer to a wall than the mesh.
    pub entry_m: Option<Vec2>,
}

impl NextCorner {
    fn of(step: RouteStep) -> Self {
        let RouteStep { distance_m, next_m, after_m, entry_m, .. } = step;
        Self { distance_m, corner_m: next_m, after_m, entry_m }
    }
}

impl CrowdRoutes {
    /// Routes for the agents and sources of a scenario, around its walls; all doors are open. A scenario without agents
    /// has the mesh of an agent by default.
    ///
    /// # Errors
    /// If a coordinate is out of range.
    pub fn new(scenario: &Scenario) -> Result<Self, RouteError> {
        Self::with_closed(scenario, &[], 0)
    }

    /// As [`new`](Self::new), with the doors that are closed, by index. The id is that of no other routes.
    pub(crate) fn with_closed(scenario: &Scenario, closed: &[bool], id: u32) -> Result<Self, RouteError> {
        let mut routes = Self { id, ..Self::default() };
        if scenario.is_open() {
            return Ok(routes);
        }
        let (points_m, one_way) = (scenario.points_m(), scenario.one_way_zones());
        let mut shared: BTreeMap<WaypointKey, usize> = BTreeMap::new();
        let state_zones = StateZones::new(scenario);
        let agents = scenario.agents.iter().map(|agent| ((agent.wall_radius_m, agent.closed_zones), &agent.goals_m, 1));
        // The agents of a source share its waypoints.
        let sources = scenario.sources.iter().flat_map(|source| {
            let sets = source.closed_zone_sets().into_iter();
            sets.map(move |set| ((source.wall_radius_m, set), &source.goals_m, SHARED_MIN))
        });
        let no_goals = Vec::new();
        let plan = scenario.is_plan().then_some(((WALL_RADIUS_M, 0), &no_goals, 0));
        let in_states = agents.chain(sources).chain(plan).flat_map(|((wall_radius_m, own), goals_m, count)| {
            let sets = state_zones.route_sets(own).into_iter();
            sets.map(move |set| (MeshClass::new(wall_radius_m, set), goals_m, count))
        });
        for (class, goals_m, count) in in_states {
            if routes.mesh(class).is_none() {
                let obstacles_m = scenario.solids_m(closed, class.closed_zones);
                let ground = scenario.ground(&obstacles_m, &points_m, &one_way);
                let mesh = RouteMesh::new(&ground, class.radius_m())?.with_clearance(CLEARANCE_M);
                routes.meshes.push((class, mesh.with_one_way(&one_way)?));
            }
            for &goal_m in goals_m {
                *shared.entry(key(class, goal_m)).or_default() += count;
            }
        }
        let mut most: Vec<(usize, WaypointKey)> = shared.into_iter().map(|(key, agents)| (agents, key)).collect();
        most.retain(|(agents, _)| *agents >= SHARED_MIN);
        most.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        for (_, waypoint) in most.into_iter().take(FIELDS_MAX) {
            let (class, bits) = waypoint;
            let Some(mesh) = routes.mesh(class) else { continue };
            let field = RouteField::new(mesh, RouteGoal::Points(vec![Vec2::from(bits.map(f32::from_bits))]));
            routes.field_of.insert(waypoint, routes.fields.len());
            routes.fields.push(field);
        }
        routes.add_area_fields(scenario);
        Ok(routes)
    }

    /// Adds a field for each area of the goals of the behaviour, as many as memory allows.
    fn add_area_fields(&mut self, scenario: &Scenario) {
        let areas = scenario.behaviour.goals.iter().enumerate().flat_map(|(set, goals)| {
            let at = move |area: usize| GoalRef { set: set as u32, area: area as u32 };
            goals.areas.iter().enumerate().map(move |(area, goal)| (at(area), &goal.area))
        });
        let mut bytes = 0;
        for (at, area) in areas {
            for (class, mesh) in &self.meshes {
                if scenario.is_barred(area, class.closed_zones) {
                    self.barred.insert((class.closed_zones, at));
                    continue;
                }
                if bytes > AREA_FIELDS_MAX_BYTES {
                    return;
                }
                let field = RouteField::new(mesh, route_goal(area));
                bytes += field.bytes();
                self.area_field_of.insert((*class, at), self.fields.len());
                self.fields.push(field);
            }
        }
    }

    /// Length of the route from a position to an area of a goal, m; none where no route leads there, or it lies wholly in
    /// zones that the agents do not enter. Straight where
    /// there are no walls, or the area has no field.
    pub(crate) fn to_area_m(&self, class: MeshClass, from_m: Vec2, at: GoalRef, area: &Area) -> Option<f32> {
        if self.barred.contains(&(class.closed_zones, at)) {
            return None;
        }
        match (self.mesh(class), self.area_field_of.get(&(class, at))) {
            (Some(mesh), Some(&field)) => {
                let step = self.fields[field].step(mesh, from_m, &mut RoutePosition::default())?;
                Some(step.distance_m)
            }
            _ => Some(area.distance_m(from_m)),
        }
    }

    /// As [`Self::next`], to an end that is not a waypoint: by the field of its area up to where the area is in sight,
    /// then by a route of the agent's own.
    pub(crate) fn next_to_end(
        &self,
        class: MeshClass,
        from_m: Vec2,
        end: &RouteEnd,
        memory: &mut RouteMemory,
    ) -> Option<NextCorner> {
        let mesh = self.mesh(class)?;
        memory.belong_to(self.id);
        if let Some(&field) = end.area.and_then(|area| self.area_field_of.get(&(class, area))) {
            let step = self.fields[field].step(mesh, from_m, &mut memory.position)?;
            if step.after_m.is_some() {
                return Some(NextCorner::of(step));
            }
        }
        memory.next_of_own(mesh, from_m, end.position_m)
    }

    /// The next corner of an agent's route from a position to a waypoint; none where no route leads there, or there are
    /// no walls.
    pub fn next(&self, agent: &AgentSpec, from_m: Vec2, to_m: Vec2, memory: &mut RouteMemory) -> Option<NextCorner> {
        let class = MeshClass::of(agent);
        let mesh = self.mesh(class)?;
        memory.belong_to(self.id);
        let Some(&field) = self.field_of.get(&key(class, to_m)) else {
            return memory.next_of_own(mesh, from_m, to_m);
        };
        let step = self.fields[field].step(mesh, from_m, &mut memory.position)?;
        // From the mesh beside a waypoint that lies off it, no corner is left.
        let is_beside = |after_m: &Vec2| *after_m == to_m && step.next_m.distance(to_m) < BESIDE_M;
        let after_m = step.after_m.filter(|after_m| !is_beside(after_m));
        Some(NextCorner { after_m, ..NextCorner::of(step) })
    }

    /// The mesh of each class of wall radii, with the radius that it keeps from walls, m.
    pub fn meshes(&self) -> impl Iterator<Item = (f32, &RouteMesh)> {
        self.meshes.iter().map(|(class, mesh)| (class.radius_m(), mesh))
    }

    /// The route of an agent from its start along all its waypoints, m; none where no route leads to one of them. On
    /// open ground the route is straight.
    pub fn route_m(&self, agent: &AgentSpec) -> Option<Vec<Vec2>> {
        let mut route_m = vec![agent.position_m];
        for &goal_m in &agent.goals_m {
            let from_m = *route_m.last()?;
            match self.mesh(MeshClass::of(agent)) {
                Some(mesh) => route_m.extend(shortest_route(mesh, from_m, goal_m)?.corners_m),
                None => route_m.push(goal_m),
            }
        }
        Some(route_m)
    }

    /// Size in memory, bytes.
    pub fn bytes(&self) -> usize {
        let meshes: usize = self.meshes.iter().map(|(_, mesh)| mesh.bytes()).sum();
        meshes + self.fields.iter().map(RouteField::bytes).sum::<usize>()
    }

    fn mesh(&self, class: MeshClass) -> Option<&RouteMesh> {
        self.meshes.iter().find(|(of, _)| *of == class).map(|(_, mesh)| mesh)
    }
}

impl RouteMemory {
    /// Forgets what belongs to other routes.
    fn belong_to(&mut self, id: u32) {
        if self.of != id {
            (self.of, self.position, self.own) = (id, RoutePosition::default(), None);
        }
    }

    fn next_of_own(&mut self, mesh: &RouteMesh, from_m: Vec2, to_m: Vec2) -> Option<NextCorner> {
        let (at, entry_m) = self.position.find(mesh, DVec2::from(from_m))?;
        let sees = |point_m: Vec2| mesh.is_straight_free(at, DVec2::from(point_m));
        let is_known = self
            .own
            .as_ref()
            .is_some_and(|own| own.to_m == to_m && own.corners_m.last().is_some_and(|&next_m| sees(next_m)));
        if !is_known {
            let mut corners_m = shortest_route(mesh, from_m, to_m)?.corners_m;
            corners_m.reverse();
            self.own = Some(OwnRoute { to_m, corners_m });
        }
        let corners_m = &mut self.own.as_mut()?.corners_m;
        // A corner is passed once the one after it is in sight.
        while let [.., after_m, corner_m] = corners_m[..]
            && (corner_m.distance(from_m) < PASSED_M || sees(after_m))
        {
            corners_m.pop();
        }
        let mut ahead = corners_m.iter().rev();
        let corner_m = *ahead.next()?;
        let after_m = ahead.next().copied();
        let onwards = corners_m.windows(2).map(|ends_m| ends_m[0].distance(ends_m[1]));
        let distance_m = from_m.distance(corner_m) + onwards.sum::<f32>();
        Some(NextCorner { distance_m, corner_m, after_m, entry_m: entry_m.map(DVec2::as_vec2) })
    }
}

fn route_goal(area: &Area) -> RouteGoal {
    match area {
        Area::Disc { centre_m, radius_m: 0.0 } => RouteGoal::Points(vec![*centre_m]),
        Area::Disc { centre_m, radius_m } => RouteGoal::Disc { centre_m: *centre_m, radius_m: *radius_m },
        Area::Polygon(corners_m) => RouteGoal::Polygon(corners_m.clone()),
    }
}

impl MeshClass {
    /// The class of agents with a wall radius that do not enter some zones, by bits.
    pub(crate) fn new(wall_radius_m: f32, closed_zones: u32) -> Self {
        // Without the tolerance 0.2 m would be more than four steps of 0.05 m.
        Self { steps: (wall_radius_m / RADIUS_STEP_M - 1e-3).ceil() as u32, closed_zones }
    }

    /// The class of an agent.
    pub(crate) fn of(agent: &AgentSpec) -> Self {
        Self::new(agent.wall_radius_m, agent.closed_zones)
    }

    /// The wall radius for which the mesh of the class is made, m.
    pub(crate) fn radius_m(self) -> f32 {
        self.steps as f32 * RADIUS_STEP_M
    }
}

fn key(class: MeshClass, waypoint_m: Vec2) -> WaypointKey {
    (class, waypoint_m.to_array().map(f32::to_bits))
}
