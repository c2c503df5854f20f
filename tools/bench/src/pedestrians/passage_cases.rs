//! Tests of the guideline about passages and large crowds: bottlenecks (12), a corner (15). World, metres, seconds.

use fbcrowd_sim::measures::WaitingCrowd;
use fbcrowd_sim::scenario::Scenario;
use glam::Vec2;

use crate::error::BenchError;
use crate::kit::report::Criterion;
use crate::kit::scenario_run::{ScenarioFile, ScenarioRun, scenario_file, seeded};
use crate::kit::statistics::{Spread, mean, spread_of};
use crate::pedestrians::case::{CaseFigure, CaseOutcome, OVERLAP_MAX_M, all_out_s, figure, overlap_m, passages};

/// Test 12: the scenes; each is simulated with all seeds.
const PASSAGES: [ScenarioFile; 6] = [
    scenario_file!("rimea/12_passage.toml"),
    scenario_file!("rimea/12_a_near_goal.toml"),
    scenario_file!("rimea/12_b_short_passage.toml"),
    scenario_file!("rimea/12_c_two_bottlenecks.toml"),
    scenario_file!("rimea/12_d_narrow.toml"),
    scenario_file!("rimea/12_d_wide.toml"),
];
/// Test 12: what distinguishes each scene.
const PASSAGE_NAMES: [&str; 6] = ["1 m × 5 m", "goal near", "0.2 m long", "second door", "0.8 m wide", "1.2 m wide"];
/// Test 12: seeds of each scene.
const PASSAGE_SEEDS: [u64; 3] = [1, 2, 3];
/// Test 12: number of agents.
const PASSAGE_AGENTS: f64 = 150.0;
/// Test 12: entrance of the passage, m.
const PASSAGE_M: Vec2 = Vec2::new(10.0, 5.0);
/// Test 12 c: entrance of the second door, m.
const DOOR_M: Vec2 = Vec2::new(25.0, 5.0);
/// Test 12 a: greatest difference of both flows, as a share: three times that of two seeds.
const GOAL_TOLERANCE: f64 = 0.1;
/// Test 12 c: greatest ratio of both flows. The flow of 150 agents ends with a difference of two walking times over three
/// minutes.
const FLOW_TOLERANCE: f64 = 1.01;
/// Test 12 c: least number of agents in a jam.
const JAM: f64 = 5.0;
/// Test 12 c: greatest number of agents that wait without a jam.
const NO_JAM: f64 = 1.0;

/// RiMEA 12: the scenes, each with all seeds.
pub(crate) fn passage_scenes() -> Result<Vec<Scenario>, BenchError> {
    let of_file = |file: &ScenarioFile| PASSAGE_SEEDS.map(|seed| seeded(*file, seed));
    PASSAGES.iter().flat_map(of_file).collect()
}

/// RiMEA 12.
pub(crate) fn passages_judged(runs: &[ScenarioRun]) -> CaseOutcome {
    let scenes: Vec<&[ScenarioRun]> = runs.chunks(PASSAGE_SEEDS.len()).collect();
    let flow = |run: &ScenarioRun| passages(run, "passage")?.flow_per_s;
    let flows: Vec<Option<Spread>> = scenes.iter().map(|runs| spread_of(runs, flow)).collect();
    let ratio = |of: usize, over: usize| Some(flows[of]?.mean / flows[over]?.mean);
    let [long, near, short, double, narrow, wide] = [0, 1, 2, 3, 4, 5];
    let second = |run: &ScenarioRun| Some(passages(run, "door")?.flow_per_s? / flow(run)?);
    let greatest_ratio = scenes[double].iter().filter_map(second).reduce(f64::max);
    let [before_first, before_second] = [PASSAGE_M, DOOR_M]
        .map(|door_m| mean(scenes[double].iter().map(|run| waiting(run, door_m)).collect::<Vec<f64>>().into_iter()));
    let deepest_m = runs.iter().filter_map(overlap_m).reduce(f64::max);
    let through = runs.iter().map(|run| run.measures.removed as f64).reduce(f64::min);
    let mut figures: Vec<CaseFigure> = Vec::new();
    for (name, flow) in PASSAGE_NAMES.iter().zip(&flows) {
        figures.push(figure(format!("{name}: agents per second, mean"), flow.map(|flow| flow.mean)));
        figures.push(figure(format!("{name}: agents per second, deviation"), flow.map(|flow| flow.deviation)));
    }
    figures.extend([
        figure("second door: agents that wait before the passage, mean", before_first),
        figure("second door: agents that wait before the door, mean", before_second),
    ]);
    CaseOutcome {
        figures,
        criteria: vec![
            Criterion::at_least("RiMEA 12: agents out, least of all runs", PASSAGE_AGENTS, through),
            Criterion::at_most("RiMEA 12: deepest overlap of discs, m", OVERLAP_MAX_M, deepest_m),
            Criterion::at_most(
                "RiMEA 12 a: flow to a near goal off that to a far one, share",
                GOAL_TOLERANCE,
                ratio(near, long).map(|ratio| (ratio - 1.0).abs()),
            ),
            Criterion::at_least("RiMEA 12 b: flow of 0.2 m over that of 5 m", 1.0, ratio(short, long)),
            Criterion::at_most("RiMEA 12 c: flow through the second over the first", FLOW_TOLERANCE, greatest_ratio),
            Criterion::at_least("RiMEA 12 c: agents that wait before the first", JAM, before_first),
            Criterion::at_most("RiMEA 12 c: agents that wait before the second", NO_JAM, before_second),
            Criterion::at_least("RiMEA 12 d: flow of 1.0 m over that of 0.8 m", 1.0, ratio(long, narrow)),
            Criterion::at_least("RiMEA 12 d: flow of 1.2 m over that of 1.0 m", 1.0, ratio(wide, long)),
        ],
    }
}

/// Mean number of agents that wait before a door, over the time in which agents pass the passage.
fn waiting(run: &ScenarioRun, door_m: Vec2) -> f64 {
    let mut crowd = WaitingCrowd::new(door_m, Vec2::NEG_X);
    let times_s = passages(run, "passage").map_or(&[][..], |passages| &passages.times_s);
    let passed = |at_s: &f64| times_s.first().is_some_and(|first| first <= at_s) && times_s.last() >= Some(at_s);
    for step in run.steps().filter(|step| passed(&step.end_s)) {
        crowd.push(&step.before_m, &step.after_m, run.scenario.dt_s);
    }
    crowd.shape().waiting
}

/// RiMEA 15; the runs are the corner, the corridor as long as its inner walls, and that as long as its outer ones.
pub(crate) fn corner_and_straights(runs: &[ScenarioRun]) -> CaseOutcome {
    let [corner_s, inner_s, outer_s] = [&runs[0], &runs[1], &runs[2]].map(all_out_s);
    let ratio = |over_s: Option<f64>| corner_s.zip(over_s).map(|(corner_s, over_s)| corner_s / over_s);
    let flow = |run: &ScenarioRun| passages(run, "end")?.flow_per_s;
    CaseOutcome {
        figures: vec![
            figure("80 m straight: time by which all are out, s", inner_s),
            figure("corner: time by which all are out, s", corner_s),
            figure("92 m straight: time by which all are out, s", outer_s),
            figure("80 m straight: agents per second", flow(&runs[1])),
            figure("corner: agents per second", flow(&runs[0])),
            figure("92 m straight: agents per second", flow(&runs[2])),
        ],
        criteria: vec![
            Criterion::at_least("RiMEA 15: time of the corner over 80 m straight", 1.0, ratio(inner_s)),
            Criterion::at_most("RiMEA 15: time of the corner over 92 m straight", 1.0, ratio(outer_s)),
        ],
    }
}
