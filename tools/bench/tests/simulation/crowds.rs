//! Claims about the bodies of a crowd.

use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::scenario::{self, Scenario};
use fbcrowd_sim::simulation::Simulation;
use motiondb::motion::MotionDb;

use super::clips::{marine, recorded};

/// Acceleration of a lurch, m/s² (docs/measures.md).
const LURCH_MPS2: f32 = 18.0;
const DT_S: f32 = 1.0 / 60.0;
/// Duration of the simulation, s: agents come to the door, queue before it and pass it.
const DURATION_S: f32 = 25.0;

/// Height of the pelvis of each agent, m.
fn heights_m(simulation: &Simulation) -> Vec<f32> {
    simulation.frames().iter().map(|frame| frame.pose.pelvis_m.z).collect()
}

/// Greatest vertical acceleration of the pelvis of a body in `bottleneck.toml`, m/s².
fn greatest_mps2(db: MotionDb) -> f32 {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenarios/bottleneck.toml");
    let (scenario, _) = scenario::file::read(&file).unwrap();
    let mut simulation = Simulation::new(Arc::new(db), &Scenario { dt_s: DT_S, ..scenario });
    let (mut earlier_m, mut last_m) = (heights_m(&simulation), heights_m(&simulation));
    let mut greatest_m = 0.0_f32;
    for _ in 0..(DURATION_S / DT_S) as usize {
        simulation.step(&mut |_| {});
        let now_m = heights_m(&simulation);
        for ((now_m, last_m), earlier_m) in now_m.iter().zip(&last_m).zip(&earlier_m) {
            greatest_m = greatest_m.max((now_m - 2.0 * last_m + earlier_m).abs());
        }
        (earlier_m, last_m) = (last_m, now_m);
    }
    greatest_m / (DT_S * DT_S)
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn pelvises_of_other_peoples_clips_do_not_lurch() {
    for (set, db) in [("GAMES-105", recorded("games105")), ("Marine", marine())] {
        let greatest_mps2 = greatest_mps2(db);
        assert!(greatest_mps2 < LURCH_MPS2, "{set}: {greatest_mps2} m/s²");
    }
}
