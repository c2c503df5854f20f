//! What the bench of people simulates with one database, at 60 steps a second.
//!
//! - Crowds: the antipodal circle, two crossing streams, a door of 1.2 m, and two scenes of Table 1.
//! - Doors: the door of 1.2 m with other seeds. What is deepest or rare at one door varies by a half from seed to seed.
//! - Starts: the crossing with other seeds, up to 8 s.
//! - Lanes: thirty agents, each alone in its lane, start at one time, walk 12 m, stop and stand; their starts also with
//!   other seeds.
//! - Turns: single bodies that turn in place at 170 °/s.
//! - Gaps: an agent passes between two walls, or between two agents that stand.
//!
//! World, metres, seconds.

use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_sim::measures::people::{
    BodySample, BodyTrack, PeopleMeasures, PeopleMeasuring, PeopleTally, SoleSlide, shoulder_turn_deg,
};
use fbcrowd_sim::measures::{Measures, Measuring};
use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::scenario::{AgentSpec, Coupling, Scenario, WALL_RADIUS_M};
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::synthesis::command::plan_requesting;
use fbcrowd_sim::synthesis::{HmsParams, SynthesisContext};
use glam::Vec2;
use motiondb::body::{Joint, Skeleton};
use motiondb::motion::{MotionDb, Parameters};

use crate::error::BenchError;
use crate::kit::scenario_run::{ScenarioFile, scenario, scenario_file, seeded, step_count};
use crate::kit::scenes;
use crate::kit::threads::run_each_on_one_thread;

/// Time step, s.
const STEP_S: f32 = 1.0 / 60.0;
/// Seeds of the starts.
const START_SEEDS: std::ops::RangeInclusive<u64> = 1..=20;
/// Duration of the starts, s: the last time at which the phase order is taken, and a tenth.
const START_S: f32 = 8.1;
/// Scenario files of the crowds.
const FILES: [ScenarioFile; 2] = [scenario_file!("crossing.toml"), scenario_file!("bottleneck.toml")];
/// The two streams that cross.
const CROSSING: ScenarioFile = FILES[0];
/// The door.
const DOOR: ScenarioFile = FILES[1];
/// Seeds of the doors.
const DOOR_SEEDS: std::ops::RangeInclusive<u64> = 2..=5;
/// Names of the antipodal circle and of the crowds of Table 1, and their durations, s.
const TABLE1: [(&str, f32); 3] = [("circle_17", 18.0), ("bidir_53", 60.0), ("cross4_100", 60.0)];
/// Number of lanes, their distance (m), the distance that agents walk (m), and the duration (s).
const LANES: (usize, f32, f32, f32) = (30, 5.0, 12.0, 30.0);
/// Time for which agents in lanes stand before they start, s.
const STAND_S: f32 = 0.5;
/// Turn rate of bodies that turn in place, rad/s: 170 °/s.
const TURN_RAD_S: f32 = 170.0 * std::f32::consts::PI / 180.0;
/// Duration of a turn in place, s.
const TURN_S: f32 = 6.0;
/// Widths of the gaps, divided by the breadth of the shoulders.
const GAPS: [f32; 2] = [1.0, 1.5];
/// Preferred speed, m/s.
const SPEED_MPS: f32 = 1.33;

/// A crowd, and what was measured of it.
pub(crate) struct CrowdRun {
    /// Name of the scene.
    pub(crate) name: String,
    /// Measures of people.
    pub(crate) people: PeopleMeasures,
    /// Measures of the recording.
    pub(crate) measures: Measures,
    tracks: Vec<BodyTrack>,
}

/// What was measured with one database.
pub(crate) struct PeopleRuns {
    /// The crowds.
    pub(crate) crowds: Vec<CrowdRun>,
    /// All crowds together.
    pub(crate) pooled: PeopleMeasures,
    /// The doors, a run for each seed.
    pub(crate) doors: Vec<CrowdRun>,
    /// The starts, a run for each seed.
    pub(crate) starts: Vec<PeopleMeasures>,
    /// The starts in lanes, a run for each seed.
    pub(crate) lane_starts: Vec<PeopleMeasures>,
    /// The lanes.
    pub(crate) lanes: PeopleMeasures,
    /// The turns in place.
    pub(crate) turns: PeopleMeasures,
    /// Turn of the shoulders between walls and between agents, `[1.0, 1.5]` shoulder breadths wide, degrees; none where
    /// the agent does not pass.
    pub(crate) shoulders_deg: [[Option<f64>; 2]; 2],
}

/// Simulates everything with one database. `prepare` changes each scenario before it runs.
pub(crate) fn run(
    db: &Arc<MotionDb>,
    prepare: fn(&mut Scenario),
    observer: &Observer,
) -> Result<PeopleRuns, BenchError> {
    let breadth_m = shoulder_breadth_m(&db.skeleton);
    let doors = DOOR_SEEDS.map(|seed| seeded(DOOR, seed)).collect::<Result<_, _>>()?;
    let starts = START_SEEDS.map(|seed| Ok(Scenario { duration_s: START_S, ..seeded(CROSSING, seed)? }));
    let starts = starts.collect::<Result<_, BenchError>>()?;
    let lane_starts = START_SEEDS.map(|seed| Scenario { seed, duration_s: START_S, ..lanes() }).collect();
    let gaps = [wall_gap, agent_gap].into_iter().flat_map(|gap| GAPS.map(|width| gap(breadth_m, width * breadth_m)));
    let groups: [Vec<Scenario>; 6] = [crowds()?, doors, starts, lane_starts, vec![lanes()], gaps.collect()];
    let counts = groups.each_ref().map(Vec::len);
    let scenarios: Vec<Scenario> = groups.into_iter().flatten().map(|scenario| prepared(scenario, prepare)).collect();
    let mut runs =
        run_each_on_one_thread(scenarios.len(), observer, |index| simulate(db, &scenarios[index]))?.into_iter();
    let [crowds, doors, starts, lane_starts, lanes, gaps] =
        counts.map(|count| runs.by_ref().take(count).collect::<Vec<CrowdRun>>());
    let mut pooled = PeopleTally::default();
    crowds.iter().flat_map(|run| &run.tracks).for_each(|track| pooled.add(track));
    let people = |runs: Vec<CrowdRun>| runs.into_iter().map(|run| run.people);
    let turn_deg = |kind: usize| {
        [0, 1].map(|which| {
            let half_m = 0.5 * GAPS[which] * breadth_m;
            let ends_m = [Vec2::new(0.0, -half_m), Vec2::new(0.0, half_m)];
            shoulder_turn_deg(&gaps[kind * GAPS.len() + which].tracks[0], ends_m)
        })
    };
    Ok(PeopleRuns {
        pooled: pooled.finish(SoleSlide::default()),
        crowds,
        doors,
        starts: people(starts).collect(),
        lane_starts: people(lane_starts).collect(),
        lanes: people(lanes).next().unwrap_or_default(),
        turns: turns(db),
        shoulders_deg: [0, 1].map(turn_deg),
    })
}

impl PeopleRuns {
    /// The crowd of a name.
    pub(crate) fn crowd(&self, name: &str) -> Option<&CrowdRun> {
        self.crowds.iter().find(|run| run.name == name)
    }
}

/// A scenario in steps of 1/60 s, changed by `prepare`.
fn prepared(scenario: Scenario, prepare: fn(&mut Scenario)) -> Scenario {
    let mut scenario = Scenario { dt_s: STEP_S, ..scenario };
    prepare(&mut scenario);
    scenario
}

fn crowds() -> Result<Vec<Scenario>, BenchError> {
    let mut crowds = FILES.into_iter().map(scenario).collect::<Result<Vec<Scenario>, BenchError>>()?;
    for scene in scenes::bundled(&[1])? {
        if let Some((_, duration_s)) = TABLE1.into_iter().find(|(name, _)| *name == scene.name) {
            let scenario = scene.scenario(Planner::default(), Coupling::default(), Params::default());
            crowds.push(Scenario { duration_s, ..scenario });
        }
    }
    Ok(crowds)
}

fn agent(from_m: Vec2, to_m: Vec2) -> AgentSpec {
    AgentSpec {
        position_m: from_m,
        facing_rad: libm::atan2f(to_m.y - from_m.y, to_m.x - from_m.x),
        goals_m: vec![to_m],
        preferred_speed_mps: SPEED_MPS,
        ..AgentSpec::default()
    }
}

fn lanes() -> Scenario {
    let (count, apart_m, length_m, duration_s) = LANES;
    let lane = |index: usize| {
        let left_m = apart_m * index as f32;
        let agent = agent(Vec2::new(0.0, left_m), Vec2::new(length_m, left_m));
        AgentSpec { pre_movement_s: STAND_S, ..agent }
    };
    Scenario { name: "lanes".to_owned(), duration_s, ..Scenario::of((0..count).map(lane).collect()) }
}

/// An agent that passes a gap between two walls.
fn wall_gap(_: f32, width_m: f32) -> Scenario {
    let wall = |side: f32| {
        let [near_m, far_m] = [0.5 * width_m, 4.0].map(|left_m| side * left_m);
        let [low_m, high_m] = [near_m.min(far_m), near_m.max(far_m)];
        [(-0.1, low_m), (0.1, low_m), (0.1, high_m), (-0.1, high_m)].map(Vec2::from).to_vec()
    };
    let walls = vec![wall(1.0), wall(-1.0)];
    Scenario { duration_s: 12.0, obstacles_m: walls, ..Scenario::of(vec![agent(-3.0 * Vec2::X, 3.0 * Vec2::X)]) }
}

/// An agent that passes a gap between two agents that stand, with a wall beyond each.
fn agent_gap(breadth_m: f32, width_m: f32) -> Scenario {
    let beside_m = 0.5 * (width_m + breadth_m);
    let standing = |side: f32| {
        let at_m = Vec2::new(0.0, side * beside_m);
        AgentSpec { goals_m: vec![at_m], facing_rad: std::f32::consts::PI, ..agent(at_m, at_m) }
    };
    let beyond = wall_gap(breadth_m, width_m + 2.0 * breadth_m + 2.0 * WALL_RADIUS_M);
    let agents = vec![agent(-3.0 * Vec2::X, 3.0 * Vec2::X), standing(1.0), standing(-1.0)];
    Scenario { duration_s: 20.0, obstacles_m: beyond.obstacles_m, ..Scenario::of(agents) }
}

/// Breadth of the shoulders: between the shoulder joints, and the girth of both upper arms, m.
fn shoulder_breadth_m(skeleton: &Skeleton) -> f32 {
    let to_joint_m = |side: usize| {
        let arm = Joint::UPPER_ARMS[side];
        let clavicle_m = arm.parent().map_or(Vec2::ZERO, |joint| skeleton.offsets_m[joint.index()].truncate());
        clavicle_m.y.abs() + skeleton.offsets_m[arm.index()].y.abs() + skeleton.segment_radii_m[arm.index()]
    };
    to_joint_m(0) + to_joint_m(1)
}

fn simulate(db: &Arc<MotionDb>, scenario: &Scenario) -> CrowdRun {
    let mut simulation = Simulation::new(Arc::clone(db), scenario);
    let (skeleton, population) = (&db.skeleton, simulation.population());
    let mut measuring = Measuring::new(skeleton, scenario, population, simulation.frames());
    let mut people = PeopleMeasuring::new(skeleton, scenario, population, simulation.frames());
    for _ in 0..step_count(scenario) {
        simulation.step(&mut |_| {});
        measuring.push(simulation.population(), simulation.frames());
        people.push(simulation.population(), simulation.frames());
    }
    CrowdRun {
        name: scenario.name.clone(),
        tracks: people.tracks().cloned().collect(),
        people: people.finish(),
        measures: measuring.finish(simulation.population()),
    }
}

/// Bodies that turn in place to either side.
fn turns(db: &Arc<MotionDb>) -> PeopleMeasures {
    let context = SynthesisContext::new(Arc::clone(db), HmsParams::default());
    let mut tally = PeopleTally::default();
    for turn_rate_rad_s in [TURN_RAD_S, -TURN_RAD_S] {
        let requested = Parameters { turn_rate_rad_s, ..Parameters::default() };
        let plan = |_: f32, root: &_| plan_requesting(requested, root, &context.params);
        let samples = context.walk_alone(0.0, TURN_S, STEP_S, plan, |body, output| {
            let mut frame = AgentFrame { root: body.root, phase: body.motion.phase, ..AgentFrame::default() };
            frame.show(output);
            BodySample::new(&db.skeleton, &frame, &frame.pose.forward_kinematics(&db.skeleton), false)
        });
        tally.add(&BodyTrack { samples, ..BodyTrack::new(f64::from(STEP_S), 0.0) });
    }
    tally.finish(SoleSlide::default())
}
