//! `fbcrowd bench table1 --discs`: our baselines against their published implementations. Without bodies, our ORCA and
//! social forces must reproduce RVO2 and the power law, measured under the same protocol
//! (`assets/scenarios/table1/README.md`): until all agents are within 0.5 m of their goals at the same time, or for 60
//! s. (Until each agent has been there once, RVO2's accelerations differ: late agents push those away that stand near
//! their goals.)

use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_sim::scenario::Coupling;
use motiondb::motion::MotionDb;

use crate::error::BenchError;
use crate::kit::planner_comparison::{ComparedPlanner, ORCA, Protocol, SOCIAL_FORCE, compare};
use crate::kit::report::{BenchReport, Criterion};
use crate::kit::scenes::{self, Scene};
use crate::paper::table1_figures::{Details, PlannerFigures, SceneFigures, figures};

/// The baselines.
const BASELINES: [ComparedPlanner; 2] = [ORCA, SOCIAL_FORCE];
/// Half of the last of C's four published decimals.
const LAST_DECIMAL: f64 = 0.5e-4;

/// Published values of one planner in one scene, each a mean and a standard deviation over seeds 1 to 5.
struct Published {
    scene: &'static str,
    planner: &'static str,
    collision_rate: [f64; 2],
    acceleration_mps2: [f64; 2],
}

const fn published(
    scene: &'static str,
    planner: &'static str,
    collision_rate: [f64; 2],
    acceleration_mps2: [f64; 2],
) -> Published {
    Published { scene, planner, collision_rate, acceleration_mps2 }
}

/// Values of the published code: RVO2 (van den Berg et al. 2011), and the power law (Karamouzas, Skinner, Guy 2014) by
/// explicit Euler steps of dt.
const PUBLISHED: [Published; 6] = [
    published("cross2_30", "orca", [0.0, 0.0], [0.31, 0.13]),
    published("bidir_53", "orca", [0.0, 0.0], [0.35, 0.10]),
    published("cross4_100", "orca", [0.0005, 0.0002], [0.36, 0.04]),
    published("cross2_30", "social_force", [0.0004, 0.0004], [1.75, 0.16]),
    published("bidir_53", "social_force", [0.0015, 0.0011], [3.25, 0.31]),
    published("cross4_100", "social_force", [0.0041, 0.0010], [4.16, 0.27]),
];

/// Runs the published scenes and compares the values.
pub(crate) fn run(
    db: &Arc<MotionDb>,
    seeds: &[u64],
    protocol: Protocol,
    observer: &Observer,
) -> Result<BenchReport<Details>, BenchError> {
    let is_published = |scene: &Scene| PUBLISHED.iter().any(|published| published.scene == scene.name);
    let scenes: Vec<Scene> = scenes::bundled(seeds)?.into_iter().filter(is_published).collect();
    let protocol = Protocol { coupling: Coupling::Discs, until_all_are_at_goals: true, ..protocol };
    let runs = compare(db, &scenes, &BASELINES, &protocol, observer)?;
    let details = Details { scenes: figures(&scenes, &BASELINES, &runs) };
    let criteria = PUBLISHED.iter().flat_map(|published| criteria(&details, published)).collect();
    Ok(BenchReport { text: text(&details), details, goals: Vec::new(), criteria })
}

/// Our values; none where the scene was not run.
fn ours<'a>(details: &'a Details, published: &Published) -> Option<&'a PlannerFigures> {
    let scene = details.scenes.iter().find(|scene| scene.scene == published.scene)?;
    scene.planners.iter().find(|planner| planner.planner == published.planner)
}

/// Our means must lie within one published standard deviation.
fn criteria(details: &Details, published: &Published) -> [Criterion; 2] {
    let Published { scene, planner, collision_rate: [c, c_spread], acceleration_mps2: [a, a_spread] } = published;
    let ours = ours(details, published);
    let off = |value: fn(&PlannerFigures) -> f64, mean: f64| ours.map(|ours| (value(ours) - mean).abs());
    [
        Criterion::at_most(
            format!("{scene}: C of {planner} off the published {c:.4}"),
            c_spread.max(LAST_DECIMAL),
            off(|ours| ours.collision_rate, *c),
        ),
        Criterion::at_most(
            format!("{scene}: A of {planner} off the published {a:.2} m/s²"),
            *a_spread,
            off(|ours| ours.mean_acceleration_mps2, *a),
        ),
    ]
}

fn text(details: &Details) -> String {
    let head = format!(
        "{:<12}{:<14}{:<22}{:<20}{:<17}{:<17}{:>8}{:>12}\n",
        "scene", "planner", "C", "published", "A, m/s²", "published", "arrive", "to goal, s"
    );
    let lines = details.scenes.iter().flat_map(|scene| scene.planners.iter().map(|planner| line(scene, planner)));
    head + &lines.collect::<String>() + "\n"
}

fn line(scene: &SceneFigures, planner: &PlannerFigures) -> String {
    let theirs =
        PUBLISHED.iter().find(|theirs| (theirs.scene, theirs.planner) == (scene.scene.as_str(), planner.planner));
    let [their_c, their_a] = theirs.map_or([[0.0; 2]; 2], |theirs| [theirs.collision_rate, theirs.acceleration_mps2]);
    format!(
        "{:<12}{:<14}{:<22}{:<20}{:<17}{:<17}{:>8}{:>12}\n",
        scene.scene,
        planner.planner,
        format!("{:.5} ± {:.5}", planner.collision_rate, planner.collision_rate_sd),
        format!("{:.4} ± {:.4}", their_c[0], their_c[1]),
        format!("{:.3} ± {:.3}", planner.mean_acceleration_mps2, planner.mean_acceleration_mps2_sd),
        format!("{:.2} ± {:.2}", their_a[0], their_a[1]),
        format!("{:.1} %", 100.0 * planner.arrived_share),
        planner.mean_time_to_goal_s.map_or_else(|| "–".to_owned(), |time_s| format!("{time_s:.2}")),
    )
}
