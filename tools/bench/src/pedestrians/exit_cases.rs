//! Tests of the guideline about exits: fewer doors (9), assigned exits (10), choice of an exit (11). World, metres,
//! seconds.

use crate::kit::report::Criterion;
use crate::kit::scenario_run::ScenarioRun;
use crate::pedestrians::case::{CaseOutcome, OVERLAP_MAX_M, all_out_s, egress, figure, overlap_m, passages};

/// Test 10: the middle between both exits, m.
const MIDDLE_M: f32 = 9.0;
/// Test 10: rooms on each side of the corridor, with two agents each; the last room has one.
const ROOMS_A_SIDE: usize = 6;
/// Test 10: rooms on each side that are assigned to the main exit.
const ROOMS_TO_MAIN: usize = 4;
/// Test 11: least number of agents that take the other exit (RiMEA: "some"): one in twenty.
const OTHER_EXIT_MIN: f64 = 50.0;

/// RiMEA 9; the runs are those with four doors and with two.
pub(crate) fn fewer_exits(runs: &[ScenarioRun]) -> CaseOutcome {
    let [four_s, two_s] = [&runs[0], &runs[1]].map(all_out_s);
    let ratio = two_s.zip(four_s).map(|(two_s, four_s)| two_s / four_s);
    let deepest_m = runs.iter().filter_map(overlap_m).reduce(f64::max);
    let half_s = |run: &ScenarioRun| egress(run)?.percentile_50_s;
    CaseOutcome {
        figures: vec![
            figure("time by which half of the agents are out, four doors, s", half_s(&runs[0])),
            figure("time by which all are out, four doors, s", four_s),
            figure("time by which half of the agents are out, two doors, s", half_s(&runs[1])),
            figure("time by which all are out, two doors, s", two_s),
        ],
        criteria: vec![
            Criterion::at_least("RiMEA 9: agents out by four doors", 1000.0, runs[0].measures.removed as f64),
            Criterion::at_least("RiMEA 9: agents out by two doors", 1000.0, runs[1].measures.removed as f64),
            Criterion::at_least("RiMEA 9: time of two doors over that of four", 1.0, ratio),
            Criterion::at_most("RiMEA 9: deepest overlap of discs, m", OVERLAP_MAX_M, deepest_m),
        ],
    }
}

/// RiMEA 10.
pub(crate) fn assigned_exits(runs: &[ScenarioRun]) -> CaseOutcome {
    let run = &runs[0];
    let goes_to_main = |agent: usize| (agent / 2) % ROOMS_A_SIDE < ROOMS_TO_MAIN;
    let is_at_main = |agent: usize| run.tracks.agents[agent].positions_m.last().map(|end_m| end_m.x > MIDDLE_M);
    let to_main = (0..run.agent_count()).filter(|&agent| goes_to_main(agent)).count();
    let strayed = (0..run.agent_count()).filter(|&agent| is_at_main(agent) != Some(goes_to_main(agent))).count();
    CaseOutcome {
        figures: vec![
            figure("agents assigned to the main exit", to_main as f64),
            figure("agents assigned to the second exit", (run.agent_count() - to_main) as f64),
        ],
        criteria: vec![
            Criterion::at_least("RiMEA 10: agents out", 23.0, run.measures.removed as f64),
            Criterion::at_most("RiMEA 10: agents at the other exit", 0.0, strayed as f64),
        ],
    }
}

/// RiMEA 11.
pub(crate) fn exit_choice(runs: &[ScenarioRun]) -> CaseOutcome {
    let run = &runs[0];
    let [nearer, other] = ["nearer exit", "other exit"].map(|exit| passages(run, exit).map(|by| by.count as f64));
    CaseOutcome {
        figures: vec![
            figure("agents by the nearer exit", nearer),
            figure("agents by the other exit", other),
            figure("time by which all are out, s", all_out_s(run)),
        ],
        criteria: vec![
            Criterion::at_least("RiMEA 11: agents out", 1000.0, run.measures.removed as f64),
            Criterion::at_least("RiMEA 11: agents by the nearer exit", 501.0, nearer),
            Criterion::at_least("RiMEA 11: agents by the other exit", OTHER_EXIT_MIN, other),
        ],
    }
}
