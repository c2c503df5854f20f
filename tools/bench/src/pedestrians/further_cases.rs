//! Tests beside the guideline's: an agent overtakes another that stands, agents stop one behind the other, and a whole
//! scene is turned. World, metres, seconds.

use fbcrowd_sim::scenario::Scenario;
use glam::Vec2;

use crate::error::BenchError;
use crate::kit::report::Criterion;
use crate::kit::scenario_run::{self, ScenarioRun, scenario, scenario_file};
use crate::kit::statistics::spread;
use crate::pedestrians::case::{CaseOutcome, TOUCH_M, figure, overlap_m};

/// Overtaking: greatest length of the path, divided by the straight line. A body's width aside over 10 m makes 1.003, a
/// hesitation more.
const DETOUR: f64 = 1.05;
/// Overtaking: greatest distance by which the standing agent is pushed from its goal, m (`path.rs`).
const STANDS_M: f64 = 0.5;
/// A scene turned: time at which positions are compared, s. Later they differ: rounding of 1e−5 m at 2 s grows to 0.1 m
/// before 6 s with any turn.
const TURNED_AT_S: f64 = 2.0;
/// A scene turned: greatest distance of two positions at that time, m, in the median seed: in few the rounding has
/// grown beyond it.
const TURNED_M: f64 = 1e-3;
/// A scene turned: greatest difference of the mean times to goal, in standard errors of the difference between two runs
/// with the same seed. Of three such angles with six seeds, one is beyond it by chance once in 80 times.
const TURNED_STANDARD_ERRORS: f64 = 5.0;
/// A scene turned: the angles, the first of which leaves it as it is, degrees.
const TURNED_DEG: [f32; 4] = [0.0, 37.0, 90.0, 211.0];
/// A scene turned: number of seeds. After 6 s each angle is another sample of the same crowd, whose mean time to goal
/// varies by a hundredth.
const TURNED_SEEDS: u64 = 6;

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

/// The scene with each turn, for each seed.
pub(crate) fn turned_scenes() -> Result<Vec<Scenario>, BenchError> {
    let scenario = scenario(scenario_file!("crossing.toml"))?;
    let seeded = |seed| Scenario { seed, ..scenario.clone() };
    let turns = |scenario| TURNED_DEG.map(|turn_deg| scenario_run::turned(&scenario, turn_deg.to_radians()));
    Ok((1..=TURNED_SEEDS).map(seeded).flat_map(turns).collect())
}

/// A scene turned; of the runs of each seed, the first is the scene as it is.
pub(crate) fn turned(runs: &[ScenarioRun]) -> CaseOutcome {
    let (mut figures, mut criteria) = (Vec::new(), Vec::new());
    let arrived = runs.iter().map(|run| run.measures.arrived).min();
    criteria.push(Criterion::at_least("turned: arrived", 30.0, arrived.map(|arrived| arrived as f64)));
    let seeds = || runs.chunks_exact(TURNED_DEG.len());
    let (mut farthest_m, mut greatest) = (None, None);
    for (index, turn_deg) in TURNED_DEG.iter().enumerate().skip(1) {
        let offs_m = seeds().filter_map(|turns| off_m(&turns[0], &turns[index], *turn_deg));
        let off_m = motiondb::statistics::median(offs_m);
        let off = spread(seeds().filter_map(|turns| off_time(&turns[0], &turns[index])));
        let standard_errors = off.map(|off| off.mean.abs() / (off.deviation / (TURNED_SEEDS as f64).sqrt()));
        figures.push(figure(format!("farthest off after 2 s, turned by {turn_deg}°, m"), off_m));
        figures.push(figure(format!("mean time to goal off, turned by {turn_deg}°, share"), off.map(|off| off.mean)));
        figures.push(figure(format!("the same in standard errors, turned by {turn_deg}°"), standard_errors));
        (farthest_m, greatest) = (greater(farthest_m, off_m), greater(greatest, standard_errors));
    }
    criteria.push(Criterion::at_most("turned: farthest off after 2 s, m", TURNED_M, farthest_m));
    let name = "turned: mean time to goal off, standard errors";
    criteria.push(Criterion::at_most(name, TURNED_STANDARD_ERRORS, greatest));
    CaseOutcome { figures, criteria }
}

/// Greatest distance between the positions in a run and those in a run that is turned, after [`TURNED_AT_S`], m.
fn off_m(run: &ScenarioRun, turned: &ScenarioRun, turn_deg: f32) -> Option<f64> {
    let back = Vec2::from_angle(-turn_deg.to_radians());
    let frame = (TURNED_AT_S / run.dt_s()).round() as usize;
    let pairs = run.roots_m(frame).into_iter().zip(turned.roots_m(frame));
    pairs.map(|(one_m, other_m)| one_m.distance(back.rotate(other_m)).into()).reduce(f64::max)
}

/// Difference of the mean times to goal of two runs, as a share.
fn off_time(run: &ScenarioRun, turned: &ScenarioRun) -> Option<f64> {
    Some(turned.measures.mean_time_to_goal_s? / run.measures.mean_time_to_goal_s? - 1.0)
}

fn greater(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    [one, other].into_iter().flatten().reduce(f64::max)
}
