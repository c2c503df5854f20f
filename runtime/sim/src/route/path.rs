//! v_pref and facing along an agent's waypoints (`FbCrowd` §3): the route, stage 1 of a step.
//!
//! An agent walks to its next waypoint by the shortest route at its preferred speed, turns towards the one after as it
//! comes near, brakes evenly before the last one and stays there. Crowds push: an agent pushed past a waypoint goes on,
//! and an agent pushed behind a wall takes the shortest route from there. World, metres, seconds.

use glam::Vec2;

use crate::route::braking::{Braking, braking_speed_mps, coasted_m};
use crate::route::crowd_routes::{CrowdRoutes, MeshClass, NextCorner, RouteEnd, RouteMemory};
use crate::route::door_routes::ClosedDoors;
use crate::route::params::KeepSide;
use crate::route::rounded_waypoint::RoundedWaypoint;
use crate::route::standing_position::StandingPosition;
use crate::route::steering::{self, Heading};
use crate::scenario::AgentSpec;
use crate::world::obstacles::Obstacles;

/// Distance within which the last goal is reached, m, beside the distance that the body coasts: half a step.
const GOAL_RADIUS_M: f32 = 0.2;
/// Distance beyond which an agent that was pushed away walks to its last goal again, m. At 0.4 m bodies of slow
/// databases, whose least step is long, shuffle about their goals endlessly.
const GOAL_LEFT_RADIUS_M: f32 = 0.6;
/// Distance from the mesh of routes from which an agent leans on a wall and does not rest, m.
const LEANS_M: f32 = 0.03;
/// Distance from the mesh within which a goal lies on it, m: rounding.
const ON_MESH_M: f32 = 1e-3;
/// How far an agent has come along its waypoints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathProgress {
    /// Index of the waypoint to which it walks.
    pub next: u32,
    /// Whether it has reached the last one and stays there.
    pub arrived: bool,
    /// Where it stands, or will stand, at its last goal or behind others that have taken it; none before it brakes.
    pub standing: Option<StandingPosition>,
}

impl PathProgress {
    /// Whether the agent stands behind others that have taken its last goal.
    pub(crate) fn stands_behind(&self) -> bool {
        self.standing.is_some_and(StandingPosition::is_taken)
    }

    /// Whether the agent walks to its last waypoint.
    pub(crate) fn is_at_last(&self, agent: &AgentSpec) -> bool {
        self.next as usize + 1 == agent.goals_m.len()
    }

    /// Passes the waypoints that lie behind the agent's present position. Returns whether the next one is the last.
    pub fn pass(&mut self, agent: &AgentSpec, position_m: Vec2) -> bool {
        let last = agent.goals_m.len().saturating_sub(1);
        while (self.next as usize) < last && RoundedWaypoint::new(agent, self.next as usize).is_passed(position_m) {
            self.next += 1;
        }
        self.next as usize == last
    }
}

/// What the route of an agent depends on, apart from its specification.
#[derive(Clone, Copy, Debug)]
pub struct RouteView<'a> {
    /// Routes around the walls, through the doors that are open.
    pub routes: &'a CrowdRoutes,
    /// The doors that are closed; none where all are open.
    pub doors: Option<ClosedDoors<'a>>,
    /// The walls.
    pub obstacles: &'a Obstacles,
    /// The side on which agents keep at corners.
    pub keep: KeepSide,
    /// How agents slow down before their last goals.
    pub braking: Braking,
    /// Velocity that the agent keeps until it responds to a new v_pref, world, m/s: that of its body; 0 of a disc.
    pub coasting_mps: Vec2,
}

impl RouteView<'_> {
    /// The next corner on the way to a goal: through doors that are open, or else up to a closed one.
    fn next(
        &self,
        [position_m, goal_m]: [Vec2; 2],
        wall_radius_m: f32,
        memory: &mut RouteMemory,
        query: impl Fn(&CrowdRoutes, &mut RouteMemory) -> Option<NextCorner>,
    ) -> Option<NextCorner> {
        let next = query(self.routes, memory);
        match self.doors {
            Some(doors) if next.is_none() => doors.next_before_door([position_m, goal_m], wall_radius_m, memory, query),
            _ => {
                memory.door = None;
                next
            }
        }
    }
}

/// An agent that walks to a goal that is not a waypoint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walker {
    /// Its position, m.
    pub(crate) position_m: Vec2,
    /// Its preferred speed, m/s.
    pub(crate) speed_mps: f32,
    /// Radius of the disc that walls hold, m.
    pub(crate) wall_radius_m: f32,
    /// Agents that share its mesh.
    pub(crate) class: MeshClass,
}

/// The motion that an agent prefers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PreferredMotion {
    /// v_pref, m/s.
    pub velocity_mps: Vec2,
    /// Angle from v_pref to the direction of the route, which the agent faces, counter-clockwise, rad: 0, except
    /// rounding, unless the agent goes back off a wall.
    pub facing_offset_rad: f32,
}

impl PreferredMotion {
    /// The motion of an agent that faces where it goes, given v_pref, m/s.
    pub fn ahead(velocity_mps: Vec2) -> Self {
        Self { velocity_mps, facing_offset_rad: 0.0 }
    }

    fn along(heading: Heading, speed_mps: f32) -> Self {
        let Heading { direction, facing } = heading;
        let facing_offset_rad = libm::atan2f(direction.perp_dot(facing), direction.dot(facing));
        Self { velocity_mps: direction * speed_mps, facing_offset_rad }
    }
}

/// The motion that an agent prefers at a position. Cases, in order:
///
/// 1. no goals, or the last one reached: stay;
/// 2. a wall before the next waypoint: around it (`steering`);
/// 3. before a waypoint that is not the last: towards it, rounding it, or braking where the turn is too sharp;
/// 4. before the last: towards it, braking.
pub fn preferred_motion(
    agent: &AgentSpec,
    position_m: Vec2,
    view: &RouteView,
    progress: &mut PathProgress,
    memory: &mut RouteMemory,
) -> PreferredMotion {
    if agent.goals_m.is_empty() {
        return PreferredMotion::default();
    }
    let to_last = progress.pass(agent, position_m);
    let next = progress.next as usize;
    let (goal_m, speed_mps, wall_radius_m) = (agent.goals_m[next], agent.preferred_speed_mps, agent.wall_radius_m);
    let query = |routes: &CrowdRoutes, memory: &mut RouteMemory| routes.next(agent, position_m, goal_m, memory);
    let corner = view.next([position_m, goal_m], wall_radius_m, memory, query);
    let stretch = Stretch { position_m, goal_m, corner, speed_mps, wall_radius_m };
    progress.arrived = to_last && stretch.has_arrived(progress.arrived, view);
    if let Some(motion) = stretch.around_walls(view) {
        return motion;
    }
    if !to_last {
        let waypoint = RoundedWaypoint::new(agent, next);
        let speed_mps = if waypoint.is_rounded() { speed_mps } else { stretch.speed_before_turn_mps(view) };
        return PreferredMotion::ahead(waypoint.direction(position_m, view.coasting_mps) * speed_mps);
    }
    stretch.to_goal(view, progress.arrived)
}

/// The motion towards a goal that is not a waypoint, around walls; `arrived` states whether the agent stands there.
pub(crate) fn motion_towards(
    agent: &Walker,
    goal: &RouteEnd,
    view: &RouteView,
    arrived: &mut bool,
    memory: &mut RouteMemory,
) -> PreferredMotion {
    let &Walker { position_m, speed_mps, wall_radius_m, class } = agent;
    let goal_m = goal.position_m;
    let query = |routes: &CrowdRoutes, memory: &mut RouteMemory| routes.next_to_end(class, position_m, goal, memory);
    let corner = view.next([position_m, goal_m], wall_radius_m, memory, query);
    let stretch = Stretch { position_m, goal_m, corner, speed_mps, wall_radius_m };
    *arrived = stretch.has_arrived(*arrived, view);
    stretch.around_walls(view).unwrap_or_else(|| stretch.to_goal(view, *arrived))
}

/// What is left of an agent's path to its next goal.
struct Stretch {
    position_m: Vec2,
    goal_m: Vec2,
    /// The next corner, or where the goal is in sight none or the goal.
    corner: Option<NextCorner>,
    /// Preferred speed, m/s.
    speed_mps: f32,
    /// Radius of the disc that walls hold, m.
    wall_radius_m: f32,
}

impl Stretch {
    /// Whether the agent stands at its goal or comes to rest there, with no wall before it, and not much nearer to a
    /// wall than the goal. `arrived` states whether it had arrived before.
    fn has_arrived(&self, arrived: bool, view: &RouteView) -> bool {
        let comes_m = || (GOAL_RADIUS_M + self.coast_m(view)).min(GOAL_LEFT_RADIUS_M);
        let radius_m = if arrived { GOAL_LEFT_RADIUS_M } else { comes_m() };
        let can_rest = |corner: &NextCorner| corner.after_m.is_none() && !self.leans_on_wall(corner);
        self.corner.as_ref().is_none_or(can_rest) && self.goal_m.distance(self.position_m) < radius_m
    }

    /// Whether the agent near its goal is much nearer to a wall than its goal is.
    fn leans_on_wall(&self, corner: &NextCorner) -> bool {
        let off_mesh_m = corner.entry_m.map_or(0.0, |entry_m| entry_m.distance(self.position_m));
        let is_goal_on_mesh = corner.corner_m.distance(self.goal_m) < ON_MESH_M;
        is_goal_on_mesh && off_mesh_m > LEANS_M
    }

    /// Distance that the agent coasts towards the goal, m; 0 where it does not rest there.
    fn coast_m(&self, view: &RouteView) -> f32 {
        let rests = view.braking == Braking::Evenly;
        if rests { coasted_m(view.coasting_mps, (self.goal_m - self.position_m).normalize_or_zero()) } else { 0.0 }
    }

    /// The motion around the walls before the goal; none where it is in sight.
    fn around_walls(&self, view: &RouteView) -> Option<PreferredMotion> {
        let corner = self.corner.as_ref()?;
        let heading = steering::heading(self.position_m, corner, view.keep, self.wall_radius_m, view.obstacles)?;
        Some(PreferredMotion::along(heading, self.speed_mps))
    }

    /// The speed towards a waypoint at which the agent turns too sharply to round it, m/s: a body brakes. It does not
    /// rest, so what it coasts does not count.
    fn speed_before_turn_mps(&self, view: &RouteView) -> f32 {
        match view.braking {
            Braking::Evenly | Braking::Not => {
                braking_speed_mps(self.goal_m.distance(self.position_m)).min(self.speed_mps)
            }
            Braking::Within(_) => self.speed_mps,
        }
    }

    /// The motion towards the last goal in sight.
    fn to_goal(&self, view: &RouteView, arrived: bool) -> PreferredMotion {
        let to_goal_m = self.goal_m - self.position_m;
        let speed_mps = match view.braking {
            Braking::Evenly if arrived => 0.0,
            Braking::Evenly => braking_speed_mps((to_goal_m.length() - self.coast_m(view)).max(0.0)),
            Braking::Within(time_s) => to_goal_m.length() / time_s,
            Braking::Not => self.speed_mps,
        };
        PreferredMotion::ahead(to_goal_m.normalize_or_zero() * speed_mps.min(self.speed_mps))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::route::braking::{BRAKING_MPS2, COAST_S};
    use crate::route::rounded_waypoint::WAYPOINT_RADIUS_M;
    use crate::scenario::Scenario;

    const DT_S: f32 = 1.0 / 30.0;

    fn agent(goals_m: &[Vec2]) -> AgentSpec {
        AgentSpec {
            position_m: Vec2::ZERO,
            facing_rad: 0.0,
            goals_m: goals_m.to_vec(),
            radius_m: 0.25,
            wall_radius_m: 0.2,
            preferred_speed_mps: 1.3,
            ..AgentSpec::default()
        }
    }

    /// The view of an agent that brakes evenly.
    fn view<'a>(routes: &'a CrowdRoutes, obstacles: &'a Obstacles, coasting_mps: Vec2) -> RouteView<'a> {
        RouteView { routes, doors: None, obstacles, keep: KeepSide::Right, braking: Braking::Evenly, coasting_mps }
    }

    /// v_pref on open ground, braking evenly.
    fn on_open_ground_mps(agent: &AgentSpec, position_m: Vec2, progress: &mut PathProgress) -> Vec2 {
        coasting_on_open_ground_mps(agent, position_m, Vec2::ZERO, progress)
    }

    fn coasting_on_open_ground_mps(
        agent: &AgentSpec,
        position_m: Vec2,
        coasting_mps: Vec2,
        progress: &mut PathProgress,
    ) -> Vec2 {
        let (routes, obstacles) = (CrowdRoutes::default(), Obstacles::default());
        let view = view(&routes, &obstacles, coasting_mps);
        preferred_motion(agent, position_m, &view, progress, &mut RouteMemory::default()).velocity_mps
    }

    /// v_pref at each step of a disc that follows it for a time, the least distance from its first waypoint, and its
    /// progress.
    fn walk(agent: &AgentSpec, time_s: f32) -> (Vec<Vec2>, f32, PathProgress) {
        let (mut position_m, mut progress, mut nearest_m) = (agent.position_m, PathProgress::default(), f32::INFINITY);
        let mut step = || {
            let preferred_mps = on_open_ground_mps(agent, position_m, &mut progress);
            position_m += preferred_mps * DT_S;
            nearest_m = nearest_m.min(position_m.distance(agent.goals_m[0]));
            preferred_mps
        };
        let preferred_mps = (0..(time_s / DT_S) as usize).map(|_| step()).collect();
        (preferred_mps, nearest_m, progress)
    }

    #[test]
    fn waypoints_are_rounded_in_order() {
        for turn_deg in [0.0_f32, 45.0, -90.0, 118.0] {
            let after_m = Vec2::new(3.0, 0.0) + 4.0 * Vec2::from_angle(turn_deg.to_radians());
            let (preferred_mps, nearest_m, progress) = walk(&agent(&[Vec2::new(3.0, 0.0), after_m]), 10.0);
            assert!(nearest_m < 0.6 && progress.arrived, "{turn_deg}° {nearest_m} m");
            for pair in preferred_mps.windows(2).take_while(|pair| pair[1] != Vec2::ZERO) {
                assert!(pair[0].angle_to(pair[1]).abs() < 0.3, "{turn_deg}° {pair:?}");
            }
        }
    }

    #[test]
    fn an_agent_that_starts_on_a_waypoint_goes_on() {
        let (_, _, progress) = walk(&agent(&[Vec2::ZERO, Vec2::ZERO, Vec2::new(5.0, 0.0)]), 10.0);
        assert!(progress.arrived);
    }

    #[test]
    fn a_sharp_turn_is_made_at_the_waypoint() {
        let (preferred_mps, nearest_m, progress) = walk(&agent(&[Vec2::new(3.0, 0.0), Vec2::new(-2.0, 0.3)]), 10.0);
        assert!(nearest_m < WAYPOINT_RADIUS_M && progress.arrived);
        assert!(preferred_mps.iter().all(|preferred_mps| preferred_mps.y.abs() < 0.2));
    }

    #[test]
    fn bodies_brake_before_a_sharp_turn_alone() {
        let speed_mps = |after_m: Vec2| {
            let agent = agent(&[Vec2::new(3.0, 0.0), after_m]);
            on_open_ground_mps(&agent, Vec2::new(2.4, 0.0), &mut PathProgress::default()).length()
        };
        let [sharp_mps, right_mps] = [Vec2::new(-2.0, 0.3), Vec2::new(3.0, 4.0)].map(speed_mps);
        assert!(sharp_mps < 1.0 && (right_mps - 1.3).abs() < 1e-5, "{sharp_mps} {right_mps}");
    }

    #[test]
    fn speed_falls_evenly_before_the_goal() {
        let agent = agent(&[Vec2::new(5.0, 0.0)]);
        let (mut position_m, mut progress, mut speed_mps, dt_s) = (Vec2::ZERO, PathProgress::default(), 1.3, 0.01);
        while !progress.arrived {
            let next_mps = on_open_ground_mps(&agent, position_m, &mut progress).length();
            assert!(progress.arrived || speed_mps - next_mps <= 1.02 * BRAKING_MPS2 * dt_s, "{speed_mps} {next_mps}");
            position_m.x += next_mps * dt_s;
            speed_mps = next_mps;
        }
    }

    #[test]
    fn a_body_that_coasts_brakes_and_arrives_earlier() {
        let agent = agent(&[Vec2::new(5.0, 0.0)]);
        let moved = |left_m: f32, velocity_mps: Vec2, arrived: bool| {
            let (position_m, mut progress) =
                (Vec2::new(5.0 - left_m, 0.0), PathProgress { arrived, ..Default::default() });
            (coasting_on_open_ground_mps(&agent, position_m, velocity_mps, &mut progress).x, progress.arrived)
        };
        let coast_m = COAST_S * 1.25;
        let along = |left_m: f32| moved(left_m, Vec2::new(1.25, 0.6), false);
        for aside in [Vec2::ZERO, Vec2::Y, -Vec2::X] {
            assert!((along(0.9).0 - moved(0.9 - coast_m, aside, false).0).abs() < 1e-5);
            assert!(moved(GOAL_RADIUS_M - 0.01, aside, false).1 && !moved(GOAL_RADIUS_M + 0.01, aside, false).1);
        }
        assert!(along(GOAL_RADIUS_M + coast_m - 0.01).1 && !along(GOAL_RADIUS_M + coast_m + 0.01).1);
        let runs = |arrived: bool| moved(GOAL_LEFT_RADIUS_M + 0.05, 4.0 * Vec2::X, arrived).1;
        assert!(!runs(false) && !runs(true));
    }

    #[test]
    fn an_agent_without_goals_stays() {
        let mut progress = PathProgress::default();
        let preferred_mps = on_open_ground_mps(&agent(&[]), Vec2::ONE, &mut progress);
        assert_eq!(preferred_mps, Vec2::ZERO);
    }

    #[test]
    fn waypoint_is_passed_beside_not_before() {
        let agent = agent(&[Vec2::new(11.0, 1.0), Vec2::new(11.0, 12.0)]);
        for (position_m, next) in
            [([10.8, 1.8], 1), ([11.8, 1.3], 1), ([10.2, 1.3], 0), ([10.2, 2.2], 0), ([1.0, 3.0], 0)]
        {
            let mut progress = PathProgress::default();
            on_open_ground_mps(&agent, Vec2::from(position_m), &mut progress);
            assert_eq!(progress.next, next, "{position_m:?}");
        }
    }

    #[test]
    fn agent_behind_door_post_returns_to_door() {
        let post_m = [(0.0, 0.5), (0.4, 0.5), (0.4, 5.0), (0.0, 5.0)].map(Vec2::from).to_vec();
        let agent = agent(&[Vec2::new(-0.4, 0.0), Vec2::new(60.0, 0.0)]);
        let obstacles = Obstacles::new(std::slice::from_ref(&post_m));
        let routes =
            CrowdRoutes::new(&Scenario { obstacles_m: vec![post_m], ..Scenario::of(vec![agent.clone()]) }).unwrap();
        let view = view(&routes, &obstacles, Vec2::ZERO);
        let mut progress = PathProgress { next: 1, ..Default::default() };
        let mut motion = |x_m, y_m| {
            let motion =
                preferred_motion(&agent, Vec2::new(x_m, y_m), &view, &mut progress, &mut RouteMemory::default());
            let direction = motion.velocity_mps.normalize();
            (direction, Vec2::from_angle(motion.facing_offset_rad).rotate(direction))
        };
        let (before, facing) = motion(-0.5, 1.5);
        assert!(before.y < -0.5 && facing == before, "{before} {facing}");
        assert!(motion(-0.5, 0.1).0.x > 0.99 && motion(0.75, 1.5).0.x > 0.99);
        // Too near to the post it goes back off it, but faces along its route.
        let (beside, facing) = motion(-0.2, 1.5);
        assert!(beside.y > -0.4 && facing.y < -0.7, "{beside} {facing}");
    }
}
