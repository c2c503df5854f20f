//! Databases: damaged, which the checksum must catch, and forged, which decoding and every invariant must.

use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use fbcrowd_sim::simulation::Simulation;
use glam::Vec2;
use motiondb::files::container::{self, HEADER_LENGTH};
use motiondb::files::database_file;
use motiondb::motion::MotionDb;
use motiondb::validate;

use crate::cmd::bench::soak::{Draw, Fate};

/// Steps for which bodies are simulated: a second, about a stride.
const STEPS: usize = 30;
/// Skeleton, sources and examples of a small database are as long as this, sets and simplices too.
const END_BYTES: usize = 4096;

/// Alters one byte or cuts the file.
pub(super) fn damage(bytes: &[u8], draw: &mut Draw) -> Fate {
    let mut copy = bytes.to_vec();
    let place = draw.below(copy.len());
    if draw.flip() {
        copy.truncate(place);
    } else {
        copy[place] ^= 1 + draw.below(255) as u8;
    }
    match database_file::from_bytes(Path::new("damaged"), &copy) {
        Ok(_) => Fate::Harmful("is used, though damaged"),
        Err(_) => Fate::Refused,
    }
}

/// Alters the payload and seals it anew.
pub(super) fn forge(bytes: &[u8], draw: &mut Draw) -> Fate {
    let mut payload = bytes[HEADER_LENGTH..].to_vec();
    let place = forged_place(payload.len(), draw);
    draw.edit_at(place).alter(&mut payload);
    let sealed = container::seal(database_file::MAGIC, database_file::VERSION, &payload);
    let Ok((db, _)) = database_file::from_bytes(Path::new("forged"), &sealed) else {
        return Fate::Refused;
    };
    if validate::validate(&db).iter().any(|check| check.broken.is_some()) {
        return Fate::Refused;
    }
    moves_bodies(&Arc::new(db), &crossing())
}

/// Anywhere; every other time near an end, where all stands that is not rows of poses.
fn forged_place(limit: usize, draw: &mut Draw) -> usize {
    let (anywhere, near) = (draw.below(limit), draw.below(limit.min(END_BYTES)));
    match draw.below(4) {
        0 => near,
        1 => limit - 1 - near,
        _ => anywhere,
    }
}

/// Whether bodies stay somewhere.
pub(super) fn moves_bodies(db: &Arc<MotionDb>, scenario: &Scenario) -> Fate {
    let mut simulation = Simulation::new(Arc::clone(db), scenario);
    (0..STEPS).for_each(|_| simulation.step(&mut |_| ()));
    let mut agents = simulation.frames().iter();
    if agents.all(|agent| agent.root.position_m.is_finite() && agent.pose.pelvis_m.is_finite()) {
        Fate::Used
    } else {
        Fate::Harmful("moves a body to nowhere")
    }
}

/// Four bodies on the sides of a square, each with its goal on the other side.
pub(super) fn crossing() -> Scenario {
    let agent = |position_m: Vec2| AgentSpec {
        position_m,
        facing_rad: (-position_m).to_angle(),
        goals_m: vec![-position_m],
        radius_m: 0.25,
        preferred_speed_mps: 1.33,
    };
    let agents = [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y].map(|side| agent(2.0 * side)).to_vec();
    Scenario { name: "crossing".to_owned(), duration_s: 1.0, ..Scenario::of(agents) }
}
