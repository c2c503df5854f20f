//! Sets of clips that lack motions that a crowd needs: their walk alone makes them valid databases, with which agents
//! arrive.

use std::sync::Arc;

use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::synthesis::library::{augmented, deformed_walk};
use glam::Vec2;
use motiondb::motion::MotionDb;
use motiondb::quality::coverage::{GapKind, coverage};
use motiondb::validate::first_broken;

use super::clips::{bundled, bundled_alone, bundled_without, recorded};

/// Agents on a circle, each with the opposite point as its goal.
const AGENTS: usize = 8;
/// Radius of the circle, m.
const RADIUS_M: f32 = 4.0;
/// Duration of the simulation, s.
const DURATION_S: f32 = 30.0;
const DT_S: f32 = 1.0 / 30.0;
/// Greatest distance of an agent from its goal on arrival, m.
const ARRIVED_M: f32 = 0.5;

fn antipodal() -> Scenario {
    let agent = |index: usize| {
        let angle_rad = std::f32::consts::TAU * index as f32 / AGENTS as f32;
        let position_m = RADIUS_M * Vec2::from_angle(angle_rad);
        AgentSpec {
            position_m,
            // To the right of the goal: all agents begin with a turn.
            facing_rad: angle_rad + 0.5 * std::f32::consts::PI,
            goals_m: vec![-position_m],
            radius_m: 0.25,
            wall_radius_m: 0.2,
            preferred_speed_mps: 1.3,
            ..AgentSpec::default()
        }
    };
    Scenario { duration_s: DURATION_S, dt_s: DT_S, ..Scenario::of((0..AGENTS).map(agent).collect()) }
}

/// Number of agents that arrive.
fn arrived(db: Arc<MotionDb>) -> usize {
    let scenario = antipodal();
    let mut simulation = Simulation::new(db, &scenario);
    let mut arrived = [false; AGENTS];
    for _ in 0..(DURATION_S / DT_S) as usize {
        simulation.step(&mut |_| {});
        for ((arrived, frame), agent) in arrived.iter_mut().zip(simulation.frames()).zip(&scenario.agents) {
            *arrived |= frame.root.position_m.distance(agent.goals_m[0]) < ARRIVED_M;
        }
    }
    arrived.into_iter().filter(|&arrived| arrived).count()
}

/// With names in order: in memory, examples need not be sorted by name.
fn sorted_by_name(db: &MotionDb) -> MotionDb {
    let mut db = db.clone();
    for (index, example) in db.examples.iter_mut().enumerate() {
        example.name = format!("{index:03}");
    }
    db
}

fn check(db: MotionDb) {
    let db = Arc::new(db);
    let complete = augmented(Arc::clone(&db));
    let (walk, count) = deformed_walk(&db, &complete).unwrap();
    assert_eq!(first_broken(&sorted_by_name(&complete)), None, "{walk}");
    let lacking: Vec<GapKind> = coverage(&complete).into_iter().map(|thin| thin.kind).collect();
    let needed =
        [GapKind::Standing, GapKind::Walking, GapKind::WalkingTurns, GapKind::TurningInPlace, GapKind::SideSteps];
    assert!(needed.iter().all(|lack| !lacking.contains(lack)), "{walk}, {count} times: {lacking:?}");
    assert_eq!(complete.rows.rotations[..db.rows.rotations.len()], db.rows.rotations, "{walk}");
    assert_eq!(arrived(Arc::clone(&db)), AGENTS, "{walk}");
}

#[test]
fn one_walk_is_enough_for_a_crowd() {
    check(bundled_alone("walk_110.bvh"));
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn real_clips_without_enough_motions_are_completed() {
    for path in ["cmu_cgspeed", "cmu_iclone", "games105", "lafan1_skeleton", "pfnn", "gltf/Soldier.glb"] {
        check(recorded(path));
    }
}

#[test]
fn a_set_that_lacks_only_steps_back_gets_them() {
    let db = Arc::new(bundled_without("backward"));
    let complete = augmented(Arc::clone(&db));
    let least_mps = |db: &MotionDb| db.velocity_hull.holding_mps.iter().map(|corner| corner.x).fold(0.0, f32::min);
    assert!(least_mps(&db) > -0.05 && least_mps(&complete) < -0.3, "{} m/s", least_mps(&complete));
    assert_eq!(deformed_walk(&db, &complete).map(|(_, count)| count), Some(1));
}

#[test]
fn a_complete_set_stays_as_it_is() {
    let db = Arc::new(bundled());
    assert!(Arc::ptr_eq(&db, &augmented(Arc::clone(&db))) && deformed_walk(&db, &db).is_none());
}
