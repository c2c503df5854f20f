//! A recording holds all that the planner went by: any step of it can be planned again, with the same outcome.

mod clips;
mod common;

use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::planning::orca::Source;
use fbcrowd_sim::planning::{Planner, Reasons};
use fbcrowd_sim::recording::{Header, Recorder, Recording, Replay};
use fbcrowd_sim::scenario::{self, Scenario};
use fbcrowd_sim::simulation::Simulation;
use motiondb::motion::MotionDb;

/// How far the packing of poses and times to landing may shift the stance foot's half-plane, m/s: 0.1 mm at the sole,
/// 0.1 s before landing. Measured: 0.3 mm/s.
const STANCE_TOLERANCE_MPS: f32 = 1e-3;

fn scenario(name: &str, planner: Planner, duration_s: f32) -> Scenario {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../assets/scenarios/{name}.toml"));
    let (scenario, _) = scenario::file::read(&file).unwrap();
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

/// Every plan of a recording comes out again: bit for bit, unless a body on one foot has its stance to go by.
fn check(recording: &Recording) {
    let replay = Replay::new(recording);
    let Scenario { planner, params, name, .. } = &recording.header().scenario;
    for frame in 0..replay.step_count() {
        let step = replay.step(frame).unwrap();
        let world = step.world();
        for (agent, after) in step.after.iter().enumerate() {
            let reasons = Reasons::new(*planner, &world, agent, params);
            let (plan, off_mps) = (reasons.plan, reasons.plan.velocity_mps.distance(after.planned_mps));
            assert!(off_mps <= tolerance_mps(&reasons), "{name}, frame {frame}, agent {agent}: {off_mps} m/s");
            assert_eq!(
                (plan.set, plan.strafing_s),
                (after.set, after.strafing_s),
                "{name}, frame {frame}, agent {agent}"
            );
        }
    }
}

/// None without a stance foot; in the corner of its line with another, which it shifts along that other, the more the
/// nearer their directions are.
fn tolerance_mps(reasons: &Reasons) -> f32 {
    let Some(stance) = reasons.half_planes.iter().find(|half_plane| half_plane.source == Source::Stance) else {
        return 0.0;
    };
    let others = reasons.half_planes.iter().filter(|other| other.source != Source::Stance && reasons.binds(other));
    let sine = others.map(|other| other.direction.perp_dot(stance.direction).abs()).fold(1.0, f32::min);
    STANCE_TOLERANCE_MPS / sine
}

#[test]
fn every_step_of_a_recording_is_planned_again_with_the_same_outcome() {
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
fn so_it_is_with_bodies_from_motion_capture() {
    let Some(db) = clips::marine("so_it_is_with_bodies_from_motion_capture") else { return };
    check(&recorded(&Arc::new(db), scenario("antipodal", Planner::Mcn, 12.0)));
}
