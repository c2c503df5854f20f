//! A recording holds everything that the planner read: any step of it can be planned again with the same result.

mod clips;
mod common;

use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::planning::orca::HalfPlaneSource;
use fbcrowd_sim::planning::{PlanExplanation, Planner};
use fbcrowd_sim::recording::{Header, Recorder, Recording, Replay};
use fbcrowd_sim::scenario::{self, Scenario};
use fbcrowd_sim::simulation::Simulation;
use motiondb::motion::MotionDb;

/// Shift of the stance foot's half-plane by packed poses and times to landing, m/s: 0.1 mm at the sole, 0.1 s before
/// landing; measured: 0.3 mm/s.
const STANCE_TOLERANCE_MPS: f32 = 1e-3;

fn scenario(name: &str, planner: Planner, duration_s: f32) -> Scenario {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../assets/scenarios/{name}.toml"));
    let (scenario, _) = scenario::read(&file).unwrap();
    Scenario { planner, duration_s, ..scenario }
}

fn recorded(db: &Arc<MotionDb>, scenario: Scenario) -> Recording {
    let path = common::folder(&format!("replay_{}_{:?}_{}", scenario.name, scenario.planner, scenario.duration_s))
        .join("run.fbrec");
    let steps = (scenario.duration_s / scenario.dt_s) as usize;
    let mut simulation = Simulation::new(Arc::clone(db), &scenario);
    let mut recorder = Recorder::create(&path, &Header::new(db, 0, scenario)).unwrap();
    recorder.push(simulation.frames()).unwrap();
    for _ in 0..steps {
        simulation.step(&mut |_| {});
        recorder.push(simulation.frames()).unwrap();
    }
    recorder.finish().unwrap();
    Recording::open(&path).unwrap()
}

/// Plans every step again and compares: bit for bit, unless a stance foot limits the plan.
fn check(recording: &Recording) {
    let replay = Replay::new(recording);
    let Scenario { planner, params, name, .. } = &recording.header().scenario;
    for frame in 0..replay.step_count() {
        let step = replay.step(frame).unwrap();
        let world = step.world();
        for (agent, after) in step.after.iter().enumerate() {
            let explanation = PlanExplanation::new(*planner, &world, agent, params);
            let (plan, off_mps) = (explanation.plan, explanation.plan.velocity_mps.distance(after.planned_mps));
            assert!(off_mps <= tolerance_mps(&explanation), "{name}, frame {frame}, agent {agent}: {off_mps} m/s");
            assert_eq!(
                (plan.set, plan.strafing_s),
                (after.set, after.strafing_s),
                "{name}, frame {frame}, agent {agent}"
            );
        }
    }
}

/// 0 without a stance foot. At the corner of its line with another line, its shift moves the plan along the other line,
/// the more, the smaller the angle between them.
fn tolerance_mps(explanation: &PlanExplanation) -> f32 {
    let Some(stance) = explanation.half_planes.iter().find(|half_plane| half_plane.source == HalfPlaneSource::Stance)
    else {
        return 0.0;
    };
    let others = explanation
        .half_planes
        .iter()
        .filter(|other| other.source != HalfPlaneSource::Stance && explanation.binds(other));
    let sine = others.map(|other| other.direction.perp_dot(stance.direction).abs()).fold(1.0, f32::min);
    STANCE_TOLERANCE_MPS / sine
}

#[test]
fn every_step_of_a_recording_is_planned_again_alike() {
    let db = Arc::new(clips::bundled());
    for (name, planner, duration_s) in [
        ("antipodal", Planner::Mcn, 16.0),
        ("bottleneck", Planner::Mcn, 16.0),
        ("antipodal", Planner::Orca, 10.0),
        ("bottleneck", Planner::Orca, 10.0),
        ("bottleneck", Planner::SocialForce, 6.0),
    ] {
        check(&recorded(&db, scenario(name, planner, duration_s)));
    }
}

#[test]
fn every_step_with_bodies_from_motion_capture_is_planned_again() {
    let Some(db) = clips::marine("every_step_with_bodies_from_motion_capture_is_planned_again") else { return };
    check(&recorded(&Arc::new(db), scenario("antipodal", Planner::Mcn, 12.0)));
}
