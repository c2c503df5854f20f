//! Simulates a scenario with full bodies and prints where the joints of its first agent are, once a second.
//!
//! A database must be compiled first:
//!
//! ```text
//! fbcrowd compile assets/clips -o motion.fbdb
//! cargo run --release -p fbcrowd-sim --example simulate_and_read_joints -- motion.fbdb assets/scenarios/antipodal.toml
//! ```
//!
//! Both arguments are optional; these are the defaults. Positions are in the world, metres.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;

use fbcrowd_sim::{Simulation, scenario};
use motiondb::body::Joint;
use motiondb::files::database_file;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let database = arguments.next().unwrap_or_else(|| "motion.fbdb".into());
    let scenario = arguments.next().unwrap_or_else(|| "assets/scenarios/antipodal.toml".into());

    let (db, _checksum) = database_file::load(&database)?;
    // The second value is the motion that the scenario names; here the database replaces it.
    let (scenario, _motion) = scenario::read(&scenario)?;
    let skeleton = db.skeleton.clone();
    let mut simulation = Simulation::new(Arc::new(db), &scenario);

    let steps_per_s = (1.0 / scenario.dt_s).round() as usize;
    for step in 1..=(scenario.duration_s / scenario.dt_s) as usize {
        simulation.step(&mut |_stage| {});
        if step % steps_per_s == 0 {
            let agent = &simulation.frames()[0];
            let joints = agent.pose.forward_kinematics(&skeleton);
            let position_m = |joint: Joint| agent.root.to_world(joints.positions_m[joint.index()]);
            let [head_m, left_m, right_m] = [Joint::Head, Joint::LeftFoot, Joint::RightFoot].map(position_m);
            println!(
                "{:5.1} s: head {head_m:.2}, left foot {left_m:.2}, right foot {right_m:.2}",
                step as f32 * scenario.dt_s
            );
        }
    }
    Ok(())
}
