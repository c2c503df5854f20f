//! Routes through doors: through those whose signals are green, and as with all doors open, for agents that wait. A door
//! counts as closed here as soon as its signal is red. World, metres.

use glam::Vec2;

use crate::route::crowd_routes::{CrowdRoutes, NextCorner, RouteMemory};
use crate::route::mesh::RouteError;
use crate::scenario::Scenario;
use crate::world::obstacles::Obstacles;

/// Greatest number of sets of closed doors whose routes are kept.
const SETS_MAX: usize = 8;
/// Distance along a route within which closed doors count, m: farther than an agent brakes.
const AHEAD_M: f32 = 4.0;

/// The routes of each set of closed doors that occurred lately.
#[derive(Clone, Debug, Default)]
pub(crate) struct DoorRoutes {
    all_open: CrowdRoutes,
    kept: Vec<ClosedSet>,
    /// Index in `kept` of the present set; none where all doors are open.
    present: Option<usize>,
    /// Number of sets that were made.
    made: u32,
    /// Number of changes of the present set.
    changes: u64,
    /// Why the routes of a set could not be made, the first time.
    error: Option<RouteError>,
}

/// The routes while a set of doors is closed.
#[derive(Clone, Debug)]
struct ClosedSet {
    closed: Vec<bool>,
    routes: CrowdRoutes,
    /// The last change to this set.
    used: u64,
}

/// What routes read of closed doors.
#[derive(Clone, Copy, Debug)]
pub struct ClosedDoors<'a> {
    /// The routes as with all doors open.
    pub open_routes: &'a CrowdRoutes,
    /// The closed doors alone.
    pub leaves: &'a Obstacles,
}

impl DoorRoutes {
    /// Routes with all doors open.
    ///
    /// # Errors
    /// Where the walls give no mesh.
    pub(crate) fn new(scenario: &Scenario) -> Result<Self, RouteError> {
        Ok(Self { all_open: CrowdRoutes::new(scenario)?, ..Self::default() })
    }

    /// The routes through the doors that are open now.
    pub(crate) fn present(&self) -> &CrowdRoutes {
        self.present.map_or(&self.all_open, |set| &self.kept[set].routes)
    }

    /// The routes as with all doors open.
    pub(crate) fn all_open(&self) -> &CrowdRoutes {
        &self.all_open
    }

    /// Why agents have no routes around doors that closed: they take those with all doors open, and wait.
    pub(crate) fn error(&self) -> Option<&RouteError> {
        self.error.as_ref()
    }

    /// Takes the routes while these doors are closed, by index; makes them where they are not kept. The set that was
    /// not present for the longest time makes room.
    pub(crate) fn close(&mut self, scenario: &Scenario, closed: &[bool]) {
        self.changes += 1;
        if !closed.contains(&true) {
            self.present = None;
            return;
        }
        let known = self.kept.iter().position(|set| set.closed == closed);
        let index = known.unwrap_or_else(|| self.make(scenario, closed));
        self.kept[index].used = self.changes;
        self.present = Some(index);
    }

    /// Makes the routes of a set. Returns its index.
    fn make(&mut self, scenario: &Scenario, closed: &[bool]) -> usize {
        self.made += 1;
        let routes = CrowdRoutes::with_closed(scenario, closed, self.made).unwrap_or_else(|error| {
            self.error.get_or_insert(error);
            self.all_open.clone()
        });
        let set = ClosedSet { closed: closed.to_vec(), routes, used: 0 };
        if self.kept.len() < SETS_MAX {
            self.kept.push(set);
            return self.kept.len() - 1;
        }
        let oldest = (0..SETS_MAX).min_by_key(|&index| self.kept[index].used).unwrap_or_default();
        self.kept[oldest] = set;
        oldest
    }
}

impl ClosedDoors<'_> {
    /// The next corner of an agent whose goal the open doors do not lead to: on the route with all doors open. Notes
    /// how far the agent can walk along it.
    pub(crate) fn next_before_door(
        &self,
        [position_m, goal_m]: [Vec2; 2],
        wall_radius_m: f32,
        memory: &mut RouteMemory,
        query: impl Fn(&CrowdRoutes, &mut RouteMemory) -> Option<NextCorner>,
    ) -> Option<NextCorner> {
        let door = memory.door.get_or_insert_default();
        let next = query(self.open_routes, &mut door.memory);
        let corner_m = next.map_or(goal_m, |next| next.corner_m);
        let points_m = [position_m, corner_m, next.and_then(|next| next.after_m).unwrap_or(corner_m)];
        door.free_m = Some(self.free_m(points_m, wall_radius_m));
        next
    }

    /// Free path of a disc along two stretches of a route until it meets a closed door, m; infinite where it meets none
    /// within [`AHEAD_M`].
    fn free_m(&self, [from_m, corner_m, after_m]: [Vec2; 3], wall_radius_m: f32) -> f32 {
        let mut walked_m = 0.0;
        for [from_m, to_m] in [[from_m, corner_m], [corner_m, after_m]] {
            let end_m = from_m + (to_m - from_m).clamp_length_max((AHEAD_M - walked_m).max(0.0));
            let length_m = from_m.distance(end_m);
            if length_m > 0.0 {
                let free_m = self.leaves.free_length_m(from_m, end_m, wall_radius_m);
                if free_m < length_m {
                    return walked_m + free_m;
                }
                walked_m += length_m;
            }
        }
        f32::INFINITY
    }
}
