//! What bodies are asked to do while their quality is measured (`fbcrowd bench quality`): steady walks, and changes.
//!
//! An errand is a row of legs, each asked until a time. It begins with standing, which each body cuts short by a part
//! of a step more than the one before, so that the changes to come meet every phase of the cycle. Metres, seconds,
//! radians.

use std::f32::consts::{FRAC_PI_2, PI};

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::HmsParams;
use fbcrowd_sim::synthesis::command::plan_requesting;
use glam::Vec2;
use motiondb::body::Root;
use motiondb::motion::{MotionDb, Parameters};

/// A steady walk is given this long to become steady …
const SETTLING_S: f32 = 4.0;
/// … and is then measured for this long, some eight steps.
const MEASURED_S: f32 = 4.0;
/// Every errand begins with standing, for so long, s: more than a stride.
const STANDING_S: f32 = 1.4;
/// Each leg between two changes: long enough to finish the change, and for the next to find a walking body.
const LEG_S: f32 = 2.5;
/// Changes of the random walk, and how long each leg of it lasts at least and at most.
const RANDOM_LEGS: usize = 24;
const RANDOM_LEG_S: [f32; 2] = [0.4, 2.4];
/// Seed of the random walk.
const SEED: u64 = 6;

/// What a body is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Ask {
    Stand,
    /// To walk at these parameters, whatever comes of its facing.
    Walk(Parameters),
    /// To walk in a direction of the world at a speed, its facing following.
    Towards {
        angle_rad: f32,
        speed_mps: f32,
    },
}

/// Asked until a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    pub(super) ask: Ask,
    pub(super) until_s: f32,
}

/// A row of legs.
#[derive(Clone, Debug)]
pub(super) struct Errand {
    pub(super) name: &'static str,
    /// Measured over its last leg once that is steady; otherwise over every leg from its change on.
    pub(super) steady: bool,
    pub(super) legs: Vec<Leg>,
}

impl Ask {
    /// As a plan for a body at `root`. What is asked is exact in the body's frame: a blending body turns its velocity
    /// to the wanted facing, semi-procedural locomotion does not.
    pub(super) fn plan(self, root: &Root, turns_velocity: bool, params: &HmsParams) -> Plan {
        match self {
            Self::Stand => Plan { facing_rad: root.facing_rad, ..Plan::default() },
            Self::Towards { angle_rad, speed_mps } => {
                Plan { velocity_mps: Vec2::from_angle(angle_rad) * speed_mps, facing_rad: angle_rad, ..Plan::default() }
            }
            Self::Walk(parameters) if turns_velocity => plan_requesting(parameters, root, params),
            Self::Walk(parameters) => {
                let local_mps = Vec2::new(parameters.speed_mps, parameters.strafe_mps);
                let velocity_mps = Vec2::from_angle(root.facing_rad).rotate(local_mps);
                Plan { velocity_mps, ..plan_requesting(parameters, root, params) }
            }
        }
    }
}

impl Errand {
    /// The leg at a time, for a body whose first leg is so much shorter.
    pub(super) fn ask(&self, time_s: f32, early_s: f32) -> Ask {
        let until_s = |index: usize| self.legs[index].until_s - if index == 0 { early_s } else { 0.0 };
        let leg = (0..self.legs.len()).find(|&leg| time_s < until_s(leg));
        leg.map_or(Ask::Stand, |leg| self.legs[leg].ask)
    }

    /// Of all legs.
    pub(super) fn seconds(&self) -> f32 {
        self.legs.last().map_or(0.0, |leg| leg.until_s)
    }

    /// The stretches of time that are measured one by one, from and to.
    pub(super) fn measured_s(&self) -> Vec<[f32; 2]> {
        if self.steady {
            return vec![[self.seconds() - MEASURED_S, self.seconds()]];
        }
        self.legs.windows(2).map(|legs| [legs[0].until_s, legs[1].until_s]).collect()
    }
}

/// The steady walks, then the changes.
pub(super) fn errands(db: &MotionDb) -> Vec<Errand> {
    let steady = [
        ("straight, slow", [0.5, 0.0, 0.0]),
        ("straight", [1.1, 0.0, 0.0]),
        ("straight, fast", [1.6, 0.0, 0.0]),
        ("jog", [2.4, 0.0, 0.0]),
        ("curved", [0.9, 30.0, 0.0]),
        ("curved, tight", [0.5, -80.0, 0.0]),
        ("side-step", [0.0, 0.0, 0.3]),
        ("side-step, fast", [0.4, 0.0, -0.8]),
        ("backward", [-0.5, 0.0, 0.0]),
    ];
    let steady = steady.map(|(name, [speed_mps, turn_rate_deg_s, strafe_mps])| {
        let parameters = Parameters { speed_mps, turn_rate_rad_s: turn_rate_deg_s.to_radians(), strafe_mps };
        let legs = timed([(Ask::Stand, STANDING_S), (Ask::Walk(parameters), SETTLING_S + MEASURED_S)]);
        Errand { name, steady: true, legs }
    });
    steady.into_iter().chain([starts_and_stops(), turns(), sidewards(), random_walk(db)]).collect()
}

/// Legs of so many seconds, one after the other.
fn timed(legs: impl IntoIterator<Item = (Ask, f32)>) -> Vec<Leg> {
    let mut until_s = 0.0;
    let leg = |(ask, seconds)| {
        until_s += seconds;
        Leg { ask, until_s }
    };
    legs.into_iter().map(leg).collect()
}

fn starts_and_stops() -> Errand {
    let walks = [0.7, 1.3, 1.8].map(|speed_mps| Ask::Towards { angle_rad: 0.0, speed_mps });
    let legs = walks.into_iter().flat_map(|walk| [(Ask::Stand, LEG_S), (walk, LEG_S)]);
    Errand { name: "start and stop", steady: false, legs: timed(legs.chain([(Ask::Stand, LEG_S)])) }
}

fn turns() -> Errand {
    let ways = [(0.0, 1.3), (FRAC_PI_2, 1.3), (-0.7, 1.3), (PI - 0.7, 0.9), (0.3, 1.6)];
    let legs = ways.map(|(angle_rad, speed_mps)| (Ask::Towards { angle_rad, speed_mps }, LEG_S));
    Errand { name: "turns", steady: false, legs: timed([(Ask::Stand, STANDING_S)].into_iter().chain(legs)) }
}

/// From walking ahead to the side, back, and to the other side.
fn sidewards() -> Errand {
    let ways = [[1.2, 0.0], [0.0, 0.3], [0.8, 0.0], [-0.5, 0.0], [0.0, -0.3], [0.0, 0.3], [1.2, 0.0]];
    let legs = ways
        .map(|[speed_mps, strafe_mps]| (Ask::Walk(Parameters { speed_mps, turn_rate_rad_s: 0.0, strafe_mps }), LEG_S));
    Errand { name: "sidewards", steady: false, legs: timed([(Ask::Stand, STANDING_S)].into_iter().chain(legs)) }
}

/// From one random mean of three examples to the next.
fn random_walk(db: &MotionDb) -> Errand {
    let mut random = SplitMix64::new(SEED, 0);
    let mut share = || 0.5 * (random.within(1.0) as f32 + 1.0);
    let legs = (0..RANDOM_LEGS).map(|_| {
        let examples = [0; 3].map(|_| (share() * db.examples.len() as f32) as usize);
        let shares = [0; 3].map(|_| share());
        let terms = examples.iter().zip(shares).map(|(&index, share)| share * db.examples[index].parameters.to_vec3());
        let mean = terms.sum::<glam::Vec3>() / shares.iter().sum::<f32>().max(f32::MIN_POSITIVE);
        let seconds = RANDOM_LEG_S[0] + share() * (RANDOM_LEG_S[1] - RANDOM_LEG_S[0]);
        (Ask::Walk(Parameters::from_vec3(mean)), seconds)
    });
    let legs: Vec<(Ask, f32)> = [(Ask::Stand, STANDING_S)].into_iter().chain(legs).collect();
    Errand { name: "random walk", steady: false, legs: timed(legs) }
}
