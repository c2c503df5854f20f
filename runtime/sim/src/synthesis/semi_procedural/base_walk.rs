//! Semi-procedural locomotion (`FbCrowd` §5, after Juarez-Perez et al. 2014): one cycle, m_sp, deformed so that the
//! body walks at any nearby (v_f, ω_t, ω_s) exactly.
//!
//! The feet of m_sp are taken apart into places on the ground and times for which the root has carried them
//! ([`crate::synthesis::semi_procedural::foot_path`]). To walk otherwise, the same places are carried along the arc of *those* parameters, for
//! since / cadence: planted feet hold by construction, whatever the speed, direction and turn, and the swing stretches
//! with the stride. Here m_sp is taken apart, and what of it can be reached is told; [`crate::synthesis::semi_procedural::deformation`] walks.
//!
//! Root frame: x forward, y left, z up, metres; seconds; radians.

use glam::{Quat, Vec2, Vec3};
use motiondb::body::JOINT_COUNT;
use motiondb::motion::{MotionDb, PHASE_COUNT, Parameters, PhaseMap};

use crate::synthesis::semi_procedural::foot_path::{Foothold, foot_path};
use crate::synthesis::semi_procedural::landing::Landing;

/// Side-steps are short and quick: a m/s aside counts this much more towards the cadence than one ahead. The bundled
/// side-steps of 0.35 and 0.6 m/s, 99 and 132 steps a minute, say 3.1 and 3.2.
const ASIDE: f32 = 3.2;
/// Backward strides are 0.7 of forward ones, at the same cadence.
const BACKWARD: f32 = 1.4;
/// Turning on the spot at 1 rad/s takes the steps of a walk at this speed, m: the bundled turns of 90 and 170 °/s, 119
/// and 178 steps a minute, say 1.0 and 1.2; turns in walking less.
const TURNING_M: f32 = 1.0;
/// Cadence over that of m_sp: from a stroll's to a shuffle's.
pub(crate) const CADENCE: [f32; 2] = [0.6, 2.2];
/// Greatest speeds ahead, back and aside, over that of m_sp; `fbcrowd bench reach` measures where legs would cross,
/// over-stretch or crouch, which is further out in every direction. Ahead, of a walk of 1.1 m/s: people run from 2 m/s
/// on (Hreljac 1993).
const AHEAD_MAX: f32 = 1.8;
const BACKWARD_MAX: f32 = 1.1;
const ASIDE_MAX: f32 = 1.1;
/// The body leans into a turn, and its feet stand outward: the greatest speeds ahead and back shrink with the turn
/// rate, and would be none at this one, rad/s. A walk of 1.2 m/s then all but takes bends of 2.5 m/s², 119 °/s, its
/// facing lagging behind its way by a third of a radian.
const TURN_END_RAD_S: f32 = 6.9;
/// Who steps aside in a turn spreads its legs for both: speeds aside shrink sooner. `fbcrowd bench reach` holds it
/// against what the legs can do …
const TURN_ASIDE_END_RAD_S: f32 = 4.8;
/// … and it turns no faster than this, rad/s: 170 °/s.
const TURN_MAX_RAD_S: f32 = 3.0;

/// m_sp, taken apart.
#[derive(Clone, Debug)]
pub struct SemiProcedural {
    /// Index of m_sp.
    pub example: usize,
    /// Its own.
    pub(crate) parameters: Parameters,
    pub(crate) phase_map: PhaseMap,
    /// Of each row, `[left, right]`.
    pub(crate) feet: Vec<[Foothold; 2]>,
    /// Phases at which each foot lands and leaves.
    pub(crate) contacts: [[f32; 2]; 2],
    /// In forward and in reversed time.
    pub(crate) landings: [Landing; 2],
    /// How long after each mid-stance hips are lowest, in phases.
    pub(crate) lowest: f32,
    /// Mean height of the hips, m.
    pub(crate) hips_m: f32,
    /// Mean of each joint over the cycle.
    pub(crate) mean: [Quat; JOINT_COUNT],
    /// Greatest difference between the times since of both feet, s.
    pub(crate) apart_s: f32,
    /// Least distance between the places of both feet, m.
    pub(crate) track_m: f32,
}

impl SemiProcedural {
    /// Takes an example apart; none for one that stands or does not walk ahead.
    pub fn new(db: &MotionDb, example: usize) -> Option<Self> {
        let found = &db.examples[example];
        let key_times_s = found.key_times_s.filter(|_| found.parameters.speed_mps > 0.0)?;
        let (rows, mean) = (db.posed_rows(example), db.rows.mean_pose(example));
        let [left, right] = [0, 1].map(|side| foot_path(found, key_times_s, side, &rows));
        let feet: Vec<[Foothold; 2]> = left.into_iter().zip(right).map(|(left, right)| [left, right]).collect();
        let greatest = |value: fn(&[Foothold; 2]) -> f32| feet.iter().map(value).fold(f32::NEG_INFINITY, f32::max);
        let [right_off, right_strike, left_off, left_strike] = key_times_s.map(|time_s| found.phase_map.phase(time_s));
        let contacts = [[left_strike, left_off], [right_strike, right_off]];
        let landings = [
            Landing::new(&rows, &feet, [left_strike, right_strike], false),
            Landing::new(&rows, &feet, [left_off, right_off], true),
        ];
        Some(Self {
            example,
            parameters: found.parameters,
            phase_map: found.phase_map,
            hips_m: mean.pelvis_m.z,
            contacts,
            landings,
            lowest: 0.5 * (landings[0].after_mid_stance + landings[1].after_mid_stance),
            mean: mean.rotations,
            apart_s: greatest(|[left, right]| (left.since_s - right.since_s).abs()),
            track_m: -greatest(|[left, right]| right.place_m.y - left.place_m.y),
            feet,
        })
    }

    /// Cadence for some parameters, over that of m_sp.
    pub fn cadence(&self, parameters: Parameters) -> f32 {
        let Parameters { speed_mps, turn_rate_rad_s, strafe_mps } = parameters;
        let ahead_mps = if speed_mps < 0.0 { BACKWARD * speed_mps } else { speed_mps };
        let effort_mps = Vec3::new(ahead_mps, ASIDE * strafe_mps, TURNING_M * turn_rate_rad_s).length();
        libm::sqrtf(effort_mps / self.parameters.speed_mps).clamp(CADENCE[0], CADENCE[1])
    }

    /// The nearest parameters that m_sp is deformed to: an ellipse of speeds, the smaller the faster it turns.
    pub fn reachable(&self, parameters: Parameters) -> Parameters {
        let turn_rate_rad_s = parameters.turn_rate_rad_s.clamp(-TURN_MAX_RAD_S, TURN_MAX_RAD_S);
        let scaled_mps =
            |turn_end_rad_s: f32| self.parameters.speed_mps * (1.0 - turn_rate_rad_s.abs() / turn_end_rad_s);
        let ahead = if parameters.speed_mps < 0.0 { BACKWARD_MAX } else { AHEAD_MAX };
        let end_mps = ahead * scaled_mps(TURN_END_RAD_S);
        let aside_end_mps = ASIDE_MAX * scaled_mps(TURN_ASIDE_END_RAD_S);
        let reach = Vec2::new(parameters.speed_mps / end_mps, parameters.strafe_mps / aside_end_mps).length().max(1.0);
        Parameters {
            speed_mps: parameters.speed_mps / reach,
            turn_rate_rad_s,
            strafe_mps: parameters.strafe_mps / reach,
        }
    }

    /// A foot at its mid-stance.
    pub(crate) fn resting(&self, side: usize) -> &Foothold {
        &self.feet[if side == 0 { PHASE_COUNT / 2 } else { 0 }][side]
    }
}
