//! Claims about doors: a door is open to a planner and a body, or closed to all. World, metres.

use std::sync::Arc;

use glam::Vec2;

use crate::maths::random::SplitMix64;
use crate::planning::Planner;
use crate::scenario::{AgentSpec, Coupling, Scenario, WALL_RADIUS_M};
use crate::simulation::Simulation;
use crate::test_db::test_db;

/// Doors of a scene; each has one agent of its own.
const DOORS: usize = 93;
/// Distance between doors, m: agents at different doors do not see each other.
const APART_M: f32 = 25.0;
/// A film's time step, s.
const FILM_STEP_S: f32 = 1.0 / 30.0;
/// The time step of Table 1, s.
const TABLE_STEP_S: f32 = 0.1;
/// Half the length of the wall about a door, m.
const HALF_WALL_M: f32 = 9.0;
/// Depth of the closed room in which an agent starts, m: no route leads around the wall.
const ROOM_M: f32 = 4.0;

/// A door in a wall, and the agent before it.
#[derive(Clone, Debug)]
struct Door {
    middle_m: Vec2,
    /// Unit vector through the door.
    through: Vec2,
    /// The wall on both sides of the door, and the other walls of a room before it.
    walls_m: Vec<Vec<Vec2>>,
    agent: AgentSpec,
}

impl Door {
    /// A door of a width, and an agent that starts up to `aside_m` aside of it.
    fn new(index: usize, width_m: f32, aside_m: f64, random: &mut SplitMix64) -> Self {
        let middle_m = APART_M * Vec2::new((index % 10) as f32, (index / 10) as f32);
        let through = Vec2::from_angle(random.within(3.1) as f32);
        let at = |ahead_m: f32, left_m: f32| middle_m + through.rotate(Vec2::new(ahead_m, left_m));
        let (thick_m, half_m) = (0.02 + random.within(0.2).abs() as f32, 0.5 * width_m);
        let wall = |[back_m, ahead_m]: [f32; 2], [right_m, left_m]: [f32; 2]| {
            vec![at(back_m, right_m), at(ahead_m, right_m), at(ahead_m, left_m), at(back_m, left_m)]
        };
        let walls_m =
            vec![wall([-thick_m, thick_m], [half_m, HALF_WALL_M]), wall([-thick_m, thick_m], [-HALF_WALL_M, -half_m])];
        let position_m = at(-1.5 - random.within(0.5).abs() as f32, random.within(aside_m) as f32);
        let agent = AgentSpec {
            position_m,
            facing_rad: through.to_angle() + random.within(0.5) as f32,
            goals_m: vec![at(-thick_m - 0.5, 0.0), at(thick_m + 0.5, 0.0), at(3.5, 0.0)],
            radius_m: 0.25,
            wall_radius_m: WALL_RADIUS_M,
            preferred_speed_mps: 1.33 + random.within(0.3) as f32,
            ..AgentSpec::default()
        };
        Self { middle_m, through, walls_m, agent }
    }

    /// The same in a closed room, so that no route leads around the wall.
    fn in_a_room(mut self) -> Self {
        let at = |ahead_m: f32, left_m: f32| self.middle_m + self.through.rotate(Vec2::new(ahead_m, left_m));
        let wall = |[back_m, ahead_m]: [f32; 2], [right_m, left_m]: [f32; 2]| {
            vec![at(back_m, right_m), at(ahead_m, right_m), at(ahead_m, left_m), at(back_m, left_m)]
        };
        let others_m = [
            wall([-ROOM_M, 0.0], [HALF_WALL_M, HALF_WALL_M + 0.2]),
            wall([-ROOM_M, 0.0], [-HALF_WALL_M - 0.2, -HALF_WALL_M]),
            wall([-ROOM_M - 0.2, -ROOM_M], [-HALF_WALL_M - 0.2, HALF_WALL_M + 0.2]),
        ];
        self.walls_m.extend(others_m);
        self
    }

    fn is_behind(&self, position_m: Vec2) -> bool {
        (position_m - self.middle_m).dot(self.through) > 0.0
    }
}

/// The doors that agents pass within a duration.
fn passed(doors: &[Door], planner: Planner, coupling: Coupling, dt_s: f32, duration_s: f32) -> Vec<bool> {
    let scenario = Scenario {
        planner,
        coupling,
        dt_s,
        obstacles_m: doors.iter().flat_map(|door| door.walls_m.clone()).collect(),
        ..Scenario::of(doors.iter().map(|door| door.agent.clone()).collect())
    };
    let mut simulation = Simulation::new(Arc::new(test_db()), &scenario);
    let (mut passed, mut steps_left) = (vec![false; doors.len()], (duration_s / dt_s) as usize);
    while steps_left > 0 && passed.contains(&false) {
        simulation.step(&mut |_| {});
        for ((door, frame), passed) in doors.iter().zip(simulation.frames()).zip(&mut passed) {
            *passed |= door.is_behind(frame.root.position_m);
        }
        steps_left -= 1;
    }
    passed
}

/// Checks that agents of these planners, in steps of these durations, with every coupling, pass all doors of `scenes`
/// scenes within a duration, or none of them.
fn check(planners: &[(Planner, f32)], scenes: usize, mut door: impl FnMut(usize) -> Door, duration_s: f32, open: bool) {
    for &(planner, dt_s) in planners {
        for coupling in [Coupling::TwoWay, Coupling::Decoupled, Coupling::Discs] {
            for _ in 0..scenes {
                let doors: Vec<Door> = (0..DOORS).map(&mut door).collect();
                for (door, is_passed) in doors.iter().zip(passed(&doors, planner, coupling, dt_s, duration_s)) {
                    assert_eq!(is_passed, open, "{planner:?}, {coupling:?}, steps of {dt_s} s: {door:?}");
                }
            }
        }
    }
}

#[test]
fn no_body_passes_a_door_that_is_too_narrow() {
    let mut random = SplitMix64::new(7, 0);
    let narrow = |index| {
        let width_m = 2.0 * WALL_RADIUS_M * (1.0 - 0.6 * random.within(1.0).abs() as f32);
        Door::new(index, width_m, 1.0, &mut random).in_a_room()
    };
    let planners = [Planner::Mcn, Planner::Orca, Planner::SocialForce];
    let planners = planners.map(|planner| [(planner, FILM_STEP_S), (planner, TABLE_STEP_S)]);
    // 3 · 2 · 3 · 6 · 93 = 10,044 doors.
    check(planners.as_flattened(), 6, narrow, 12.0, false);
}

/// Not with social forces, nor with MCN in coarse steps: with 5 cm to spare some of their agents waver before the door
/// (docs/tuning.md).
#[test]
fn a_single_body_passes_every_wider_door() {
    let mut random = SplitMix64::new(8, 0);
    let wide = |index| Door::new(index, 2.0 * WALL_RADIUS_M + 0.05, 0.5, &mut random);
    check(
        &[(Planner::Mcn, FILM_STEP_S), (Planner::Orca, FILM_STEP_S), (Planner::Orca, TABLE_STEP_S)],
        4,
        wide,
        60.0,
        true,
    );
}
