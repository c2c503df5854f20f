//! A recording holds all input of the planner: any step of it can be planned again, with the same result.

use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::planning::mcn::TIME_TO_LANDING_MIN_S;
use fbcrowd_sim::planning::orca::HalfPlaneSource;
use fbcrowd_sim::planning::{PlanExplanation, Planner, Stance};
use fbcrowd_sim::recording::Replay;
use fbcrowd_sim::recording::{Header, Recorder, Recording};
use fbcrowd_sim::scenario::{self, Scenario};
use fbcrowd_sim::simulation::Simulation;
use motiondb::files::SourceText;
use motiondb::motion::MotionDb;

use super::clips::{bundled, marine};

/// How far the packing of poses may shift the clearance of the stance foot's half-plane, m.
const CLEARANCE_TOLERANCE_M: f32 = 1e-4;

fn scenario(name: &str, planner: Planner, duration_s: f32) -> Scenario {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../assets/scenarios/{name}.toml"));
    let (scenario, _) = scenario::file::read(&file).unwrap();
    Scenario { planner, duration_s, ..scenario }
}

/// The crossing with bodies of many sizes.
fn with_children(mut scenario: Scenario) -> Scenario {
    scenario.name = "children".into();
    for (index, agent) in scenario.agents.iter_mut().enumerate() {
        agent.stature = 0.5 + 0.05 * (index % 14) as f32;
    }
    scenario
}

fn recorded(db: &Arc<MotionDb>, scenario: Scenario) -> Recording {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join(format!("replay_{}_{:?}_{}.fbrec", scenario.name, scenario.planner, scenario.duration_s));
    let steps = (scenario.duration_s / scenario.dt_s) as usize;
    let mut simulation = Simulation::new(Arc::clone(db), &scenario);
    let mut recorder = Recorder::create(&path, &Header::new(db, 0, scenario)).unwrap();
    recorder.push(simulation.frames()).unwrap();
    for _ in 0..steps {
        simulation.step(&mut |_| {});
        recorder.push(simulation.frames()).unwrap();
    }
    recorder.finish(simulation.population()).unwrap();
    Recording::open(&path).unwrap()
}

/// Every plan of a recording is planned again: bit for bit, unless a stance foot limits it.
fn check(recording: &Recording) {
    let replay = Replay::new(recording);
    let Scenario { planner, params, name, .. } = &recording.header().scenario;
    for frame in 0..replay.step_count() {
        let step = replay.step(frame).unwrap();
        let world = step.world();
        for (agent, after) in step.after.iter().enumerate() {
            let reasons = PlanExplanation::new(*planner, &world, agent, params);
            let (plan, off_mps) = (reasons.plan, reasons.plan.velocity_mps.distance(after.planned_mps));
            let tolerance_mps = tolerance_mps(&reasons, &world.stances[agent]);
            assert!(
                off_mps <= tolerance_mps,
                "{name}, frame {frame}, agent {agent}: {off_mps} m/s, {tolerance_mps} allowed"
            );
            // A velocity that is off may lie on the other side of the limit of a set.
            let is_equal = (plan.set, plan.strafing_s) == (after.set, after.strafing_s);
            assert!(is_equal || off_mps > 0.0, "{name}, frame {frame}, agent {agent}: {:?}, {:?}", plan.set, after.set);
        }
    }
}

/// Greatest difference of a plan, m/s: 0 without a stance foot. The half-plane of that foot lets the swing foot move by its
/// clearance until it lands. Its line shifts its corner with another line along that line, the more the nearer their
/// directions are.
fn tolerance_mps(reasons: &PlanExplanation, stance: &Stance) -> f32 {
    let half_plane = reasons.half_planes.iter().find(|half_plane| half_plane.source == HalfPlaneSource::Stance);
    let (Some(foot), Some(stance)) = (stance.foot, half_plane) else { return 0.0 };
    let others =
        reasons.half_planes.iter().filter(|other| other.source != HalfPlaneSource::Stance && reasons.binds(other));
    let sine = others.map(|other| other.direction.perp_dot(stance.direction).abs()).fold(1.0, f32::min);
    CLEARANCE_TOLERANCE_M / (foot.time_to_landing_s.max(TIME_TO_LANDING_MIN_S) * sine)
}

#[test]
fn every_recorded_step_is_planned_again_alike() {
    let db = Arc::new(bundled());
    for (name, planner, duration_s) in [
        ("antipodal", Planner::Mcn, 16.0),
        ("bottleneck", Planner::Mcn, 16.0),
        ("antipodal", Planner::Orca, 10.0),
        ("bottleneck", Planner::Orca, 10.0),
        ("bottleneck", Planner::SocialForce, 6.0),
        ("two_exits", Planner::Mcn, 20.0),
        ("signal_crossing", Planner::Mcn, 30.0),
    ] {
        let recording = recorded(&db, scenario(name, planner, duration_s));
        let leaves = ["two_exits", "signal_crossing"].contains(&name);
        assert_eq!(recording.population().agents.iter().any(|life| life.removed.is_some()), leaves);
        check(&recording);
    }
}

#[test]
fn bodies_of_many_sizes_are_planned_again_alike() {
    check(&recorded(&Arc::new(bundled()), with_children(scenario("crossing", Planner::Mcn, 14.0))));
}

#[test]
fn radii_and_teleports_of_states_are_planned_again_alike() {
    const CHANGES: &str = "
        duration_s = 16
        [goals.ends]
        choose = 'farthest'
        areas = [{ circle_m = [-5, 0, 1] }, { circle_m = [5, 0, 1] }]
        [states.walk]
        go = 'ends'
        set = { speed_factor = { uniform = [0.7, 1.2] }, radius_m = { uniform = [0.15, 0.3] } }
        then = [{ when = { reached_m = 0 }, to = 'jump' }, { when = { after_s = 6 }, to = 'walk' }]
        [states.jump]
        stand = { facing_deg = 90 }
        set = { teleport = { rect_m = [-3, 3, 3, 6] } }
        then = [{ when = { after_s = 1 }, to = 'walk' }]
        [[agents]]
        grid = { columns = 5, rows = 4, spacing_m = 0.9 }
        state = 'walk'
    ";
    let source = SourceText { path: "changes.toml".into(), text: CHANGES.to_owned() };
    let (scenario, _) = scenario::parse(&source).unwrap();
    let recording = recorded(&Arc::new(bundled()), scenario);
    let agents = &recording.population().agents;
    assert!(agents.iter().any(|life| !life.teleports.is_empty()) && agents.iter().all(|life| !life.radii_m.is_empty()));
    check(&recording);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn every_recorded_step_of_real_clips_is_planned_again() {
    check(&recorded(&Arc::new(marine()), scenario("antipodal", Planner::Mcn, 12.0)));
}
