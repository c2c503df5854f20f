//! Databases: damaged ones, which the checksum must reject, and forged ones, which the decoder or an invariant must.

use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use fbcrowd_sim::simulation::Simulation;
use glam::Vec2;
use motiondb::files::container::{self, HEADER_LENGTH};
use motiondb::files::database_file;
use motiondb::motion::MotionDb;
use motiondb::validate;

use crate::soak::draw::Draw;
use crate::soak::tally::CopyOutcome;

/// Simulated time steps: a second, about a stride.
const STEPS: usize = 30;
/// Length of skeleton, sources and examples of a small database, and of its sets and simplices, bytes.
const END_BYTES: usize = 4096;

/// Alters one byte or cuts the file.
pub(crate) fn damage(bytes: &[u8], draw: &mut Draw) -> CopyOutcome {
    let mut copy = bytes.to_vec();
    let position = draw.below(copy.len());
    if draw.flip() {
        copy.truncate(position);
    } else {
        copy[position] ^= 1 + draw.below(255) as u8;
    }
    match database_file::from_bytes(Path::new("damaged"), &copy) {
        Ok(_) => CopyOutcome::Harmful("is used, though damaged"),
        Err(_) => CopyOutcome::Rejected,
    }
}

/// Alters the payload and seals it again.
pub(crate) fn forge(bytes: &[u8], draw: &mut Draw) -> CopyOutcome {
    let mut payload = bytes[HEADER_LENGTH..].to_vec();
    let position = forged_position(payload.len(), draw);
    draw.edit_at(position).alter(&mut payload);
    let version = container::stated_version(bytes).unwrap_or(database_file::VERSION);
    let sealed = container::seal(database_file::MAGIC, version, &payload);
    let Ok((db, _)) = database_file::from_bytes(Path::new("forged"), &sealed) else {
        return CopyOutcome::Rejected;
    };
    if breaks_invariant(&db) {
        return CopyOutcome::Rejected;
    }
    moves_bodies(&Arc::new(db), &crossing())
}

/// A random position, every other time near an end, with all that is not rows of poses.
fn forged_position(limit: usize, draw: &mut Draw) -> usize {
    let (anywhere, near) = (draw.below(limit), draw.below(limit.min(END_BYTES)));
    match draw.below(4) {
        0 => near,
        1 => limit - 1 - near,
        _ => anywhere,
    }
}

/// Simulates bodies; their positions must stay finite.
pub(crate) fn moves_bodies(db: &Arc<MotionDb>, scenario: &Scenario) -> CopyOutcome {
    let mut simulation = Simulation::new(Arc::clone(db), scenario);
    (0..STEPS).for_each(|_| simulation.step(&mut |_| ()));
    let mut agents = simulation.frames().iter();
    if agents.all(|agent| agent.root.position_m.is_finite() && agent.pose.pelvis_m.is_finite()) {
        CopyOutcome::Used
    } else {
        CopyOutcome::Harmful("moves a body to no finite position")
    }
}

/// Four agents on the sides of a square, each with its goal on the opposite side.
pub(crate) fn crossing() -> Scenario {
    let agent = |position_m: Vec2| AgentSpec {
        position_m,
        facing_rad: (-position_m).to_angle(),
        goals_m: vec![-position_m],
        radius_m: 0.25,
        wall_radius_m: 0.2,
        preferred_speed_mps: 1.33,
        ..AgentSpec::default()
    };
    let agents = [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y].map(|side| agent(2.0 * side)).to_vec();
    Scenario { name: "crossing".to_owned(), duration_s: 1.0, ..Scenario::of(agents) }
}

/// A database that is used must keep every invariant of `fbcrowd validate`.
pub(crate) fn check_invariants(db: &MotionDb) -> CopyOutcome {
    match breaks_invariant(db) {
        true => CopyOutcome::Harmful("gives a database with a broken invariant"),
        false => CopyOutcome::Used,
    }
}

fn breaks_invariant(db: &MotionDb) -> bool {
    validate::validate(db).iter().any(|check| check.broken.is_some())
}
