//! Tests beside the guideline's: an agent overtakes another that stands, agents stop one behind the other, and a whole
//! scene is turned. World, metres, seconds.

use fbcrowd_sim::scenario::Scenario;
use glam::Vec2;

use crate::error::BenchError;
use crate::kit::report::Criterion;
use crate::kit::scenario_run::{self, ScenarioRun, scenario, scenario_file};
use crate::pedestrians::case::{CaseOutcome, TOUCH_M, figure, overlap_m};

/// Overtaking: greatest length of the path, divided by the straight line. A body's width aside over 10 m makes 1.003, a
/// hesitation more.
const DETOUR: f64 = 1.05;
/// Overtaking: greatest distance by which the standing agent is pushed from its goal, m (`path.rs`).
const STANDS_M: f64 = 0.5;
/// A scene turned: time at which positions are compared, s. Later they differ: rounding of 1e−5 m at 2 s grows to 0.1 m
/// before 6 s with any turn.
const TURNED_AT_S: f64 = 2.0;
/// A scene turned: greatest distance of two positions at that time, m.
const TURNED_M: f64 = 1e-3;
/// A scene turned: greatest difference of the mean times to goal, as a share.
const TURNED_TIME: f64 = 0.01;
/// A scene turned: the angles, the first of which leaves it as it is, degrees.
const TURNED_DEG: [f32; 4] = [0.0, 37.0, 90.0, 211.0];

/// One agent overtakes another that stands.
pub(crate) fn overtaking(runs: &[ScenarioRun]) -> CaseOutcome {
    let run = &runs[0];
    let (mut walked_m, mut pushed_m) = (0.0, 0.0_f64);
    let stood_m = run.scenario.agents[1].position_m;
    for step in run.steps() {
        walked_m += f64::from(step.before_m[0].distance(step.after_m[0]));
        pushed_m = pushed_m.max(step.after_m[1].distance(stood_m).into());
    }
    let ends_m = [0, run.tracks.frame_count - 1].map(|frame| run.roots_m(frame)[0]);
    let detour = walked_m / f64::from(ends_m[0].distance(ends_m[1]));
    CaseOutcome {
        figures: vec![
            figure("path over the straight line", detour),
            figure("the standing agent is pushed by, m", pushed_m),
            figure("least distance of the two, m", run.measures.minimum_separation_m),
        ],
        criteria: vec![
            Criterion::at_least("overtaking: arrived", 2.0, run.measures.arrived as f64),
            Criterion::at_most("overtaking: overlap of discs, m", TOUCH_M, overlap_m(run)),
            Criterion::at_most("overtaking: path over the straight line", DETOUR, detour),
            Criterion::at_most("overtaking: the standing agent is pushed by, m", STANDS_M, pushed_m),
        ],
    }
}

/// Agents stop one behind the other.
pub(crate) fn queue(runs: &[ScenarioRun]) -> CaseOutcome {
    let measures = &runs[0].measures;
    CaseOutcome {
        figures: vec![figure("least distance of any two, m", measures.minimum_separation_m)],
        criteria: vec![
            Criterion::at_least("queue: arrived", measures.agents as f64, measures.arrived as f64),
            Criterion::at_most("queue: overlap of discs, m", TOUCH_M, overlap_m(&runs[0])),
        ],
    }
}

/// The scene with each turn.
pub(crate) fn turned_scenes() -> Result<Vec<Scenario>, BenchError> {
    let scenario = scenario(scenario_file!("crossing.toml"))?;
    Ok(TURNED_DEG.map(|turn_deg| scenario_run::turned(&scenario, turn_deg.to_radians())).to_vec())
}

/// A scene turned; the first run is the scene as it is.
pub(crate) fn turned(runs: &[ScenarioRun]) -> CaseOutcome {
    let positions_m = |(run, turn_deg): (&ScenarioRun, &f32)| -> Vec<Vec2> {
        let back = Vec2::from_angle(-turn_deg.to_radians());
        let frame = (TURNED_AT_S / run.dt_s()).round() as usize;
        run.roots_m(frame).iter().map(|root_m| back.rotate(*root_m)).collect()
    };
    let all_m: Vec<Vec<Vec2>> = runs.iter().zip(&TURNED_DEG).map(positions_m).collect();
    let off_m = |positions_m: &Vec<Vec2>| {
        all_m[0].iter().zip(positions_m).map(|(one_m, other_m)| one_m.distance(*other_m)).reduce(f32::max)
    };
    let offs_m = || all_m.iter().skip(1).filter_map(off_m).map(f64::from);
    let arrived = runs.iter().map(|run| run.measures.arrived).min();
    let times_s: Option<Vec<f64>> = runs.iter().map(|run| run.measures.mean_time_to_goal_s).collect();
    let times_s = times_s.unwrap_or_default();
    let off_time = times_s.iter().map(|time_s| (time_s / times_s[0] - 1.0).abs()).reduce(f64::max);
    let of_turns = TURNED_DEG.iter().zip(&times_s);
    let named_times =
        of_turns.map(|(turn, &time_s)| figure(format!("mean time to goal, turned by {turn}°, s"), time_s));
    let named_offs = TURNED_DEG[1..].iter().zip(offs_m());
    let named_offs =
        named_offs.map(|(turn, off_m)| figure(format!("farthest off after 2 s, turned by {turn}°, m"), off_m));
    CaseOutcome {
        figures: named_offs.chain(named_times).collect(),
        criteria: vec![
            Criterion::at_most("turned: farthest off after 2 s, m", TURNED_M, offs_m().reduce(f64::max)),
            Criterion::at_least("turned: arrived", 30.0, arrived.map(|arrived| arrived as f64)),
            Criterion::at_most("turned: mean time to goal off, share", TURNED_TIME, off_time),
        ],
    }
}
