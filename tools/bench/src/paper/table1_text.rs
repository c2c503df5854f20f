//! The text of `fbcrowd bench table1`, with the paper's values beside ours.

use crate::paper::table1_figures::{PlannerFigures, SceneFigures};

/// The paper's Table 1: scene, planner, C, A in m/s² (over all steps; it has no acceleration before arrival).
const PAPER: [(&str, &str, f64, f64); 9] = [
    ("cross2_30", "orca", 0.0566, 0.1542),
    ("cross2_30", "social_force", 0.1440, 0.1253),
    ("cross2_30", "mcn", 0.0496, 0.1135),
    ("bidir_53", "orca", 0.0491, 0.1901),
    ("bidir_53", "social_force", 0.0539, 0.1683),
    ("bidir_53", "mcn", 0.0722, 0.1121),
    ("cross4_100", "orca", 0.2027, 0.0532),
    ("cross4_100", "social_force", 0.3369, 0.0390),
    ("cross4_100", "mcn", 0.1791, 0.0387),
];

/// One table for each scene.
pub(crate) fn text(scenes: &[SceneFigures]) -> String {
    scenes.iter().map(table).collect()
}

fn table(scene: &SceneFigures) -> String {
    let seeds = scene.planners.first().map_or(0, |planner| planner.runs.len());
    let seeds = format!("{seeds} seed{}", if seeds == 1 { "" } else { "s" });
    let of_paper = PAPER.iter().any(|(of_scene, ..)| *of_scene == scene.scene);
    let head = format!(
        "{}: {} agents, {seeds}, mean ± deviation{}\n{:<26}{:<27}{:<25}{:<17}{:>8}{:>9}{:>15}{:>17}{:>9}\n",
        scene.scene,
        scene.agents,
        if of_paper { ", the paper's in brackets" } else { "" },
        "planner",
        "C",
        "A, m/s²",
        "before arrival",
        "arrive",
        "stalled",
        "to goal, s",
        "bodies, mm",
        "plan, µs",
    );
    let lines = scene.planners.iter().map(|planner| line(&scene.scene, planner));
    head + &lines.collect::<String>() + "\n"
}

fn line(scene: &str, planner: &PlannerFigures) -> String {
    let paper = PAPER.iter().find(|(of_scene, of_planner, ..)| (*of_scene, *of_planner) == (scene, planner.planner));
    let [paper_c, paper_a] = paper.map_or([String::new(), String::new()], |(.., collisions, acceleration)| {
        [collisions, acceleration].map(|value| format!("[{value:.4}]"))
    });
    let time = planner.mean_time_to_goal_s.zip(planner.mean_time_to_goal_s_sd);
    format!(
        "{:<26}{:<27}{:<25}{:<17}{:>8}{:>9}{:>15}{:>17}{:>9.2}\n",
        planner.planner,
        format!("{:.5} ± {:.5} {paper_c}", planner.collision_rate, planner.collision_rate_sd),
        format!("{:.3} ± {:.3} {paper_a}", planner.mean_acceleration_mps2, planner.mean_acceleration_mps2_sd),
        format!(
            "{:.3} ± {:.3}",
            planner.mean_acceleration_before_arrival_mps2, planner.mean_acceleration_before_arrival_mps2_sd
        ),
        format!("{:.1} %", 100.0 * planner.arrived_share),
        planner.stalled,
        time.map_or_else(|| "–".to_owned(), |(mean_s, deviation_s)| format!("{mean_s:.2} ± {deviation_s:.2}")),
        format!("{:.4} ± {:.4}", planner.body_penetration_mm, planner.body_penetration_mm_sd),
        planner.plan_microseconds_per_agent_step,
    )
}
