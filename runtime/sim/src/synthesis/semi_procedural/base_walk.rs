//! The base walk m_sp, taken apart for deformation (`FbCrowd` §5, after Juarez-Perez et al. 2014), and the parameters
//! that deformation reaches.
//!
//! The feet of m_sp become positions on the ground and times for which the root has carried them
//! ([`crate::synthesis::semi_procedural::foot_path`]). At other parameters the same positions are carried along the arc
//! of *those* parameters, for carried time / cadence. Planted feet then hold by construction, at any speed, direction
//! and turn, and the swing stretches with the stride. [`crate::synthesis::semi_procedural::deformation`] makes the
//! poses.
//!
//! Root frame (x forward, y left, z up); metres, seconds, radians. Pairs are `[left, right]`. `docs/tuning.md` holds
//! the measurements behind the constants.

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Foot, JOINT_COUNT, Joint};
use motiondb::motion::{MotionDb, PHASE_COUNT, Parameters, PhaseMap};

use crate::maths::angle::unit_vector;
use crate::synthesis::pose::lean::balance::lean_in_curve_rad;
use crate::synthesis::pose::upper_body::curve_look::curve_look_rad;
use crate::synthesis::semi_procedural::foot_path::{FootPathPoint, foot_path};
use crate::synthesis::semi_procedural::landing::Landing;

/// Weight of side speed against forward speed in the cadence: side-steps are short and quick. Bundled side-steps of
/// 0.35 and 0.6 m/s give 3.1 and 3.2.
const STRAFE_EFFORT: f32 = 3.2;
/// Weight of backward speed against forward speed in the cadence: backward strides are 0.7 of forward ones.
const BACKWARD_EFFORT: f32 = 1.4;
/// Forward speed per turn rate that takes as many steps, m. Bundled turns on the spot by 90 and 170 °/s give 1.0 and
/// 1.2; turns while walking give less.
const TURN_EFFORT_M: f32 = 1.0;
/// Least and greatest cadence, divided by that of m_sp: from a stroll's to a shuffle's.
pub(crate) const CADENCE_RANGE: [f32; 2] = [0.6, 2.2];
/// Greatest forward speed, divided by that of m_sp. People run from 2 m/s on (Hreljac 1993), 1.8 of a walk at 1.1 m/s.
const FORWARD_MAX: f32 = 1.8;
/// Greatest backward speed, divided by the speed of m_sp; `fbcrowd bench reach` measures what legs reach, which is
/// more.
const BACKWARD_MAX: f32 = 1.1;
/// Greatest side speed, divided by the speed of m_sp; `fbcrowd bench reach` measures what legs reach, which is more.
const STRAFE_MAX: f32 = 1.1;
/// Turn rate at which the greatest forward and backward speeds would shrink to 0, rad/s: the body leans into a turn,
/// and its feet stand outward.
const TURN_END_RAD_S: f32 = 6.9;
/// Turn rate at which the greatest side speed would shrink to 0, rad/s: legs spread for both, so it shrinks sooner.
const STRAFE_TURN_END_RAD_S: f32 = 4.8;
/// Greatest turn rate, rad/s: 170 °/s.
const TURN_MAX_RAD_S: f32 = 3.0;

/// Greatest lean of a body on an arc, rad (20°).
const LEAN_MAX_RAD: f32 = 0.35;

/// Row of the mid-stance of each foot.
const MID_STANCE_ROWS: [usize; 2] = [PHASE_COUNT / 2, 0];

/// The base walk, taken apart.
#[derive(Clone, Debug)]
pub struct BaseWalk {
    /// Index of m_sp in the database.
    pub example: usize,
    /// Parameters of m_sp.
    pub(crate) parameters: Parameters,
    /// Phase map of m_sp.
    pub(crate) phase_map: PhaseMap,
    /// Lean of m_sp to the left, rad; 0 where it walks straight on.
    pub(crate) lean_rad: f32,
    /// Look of the head of m_sp into its curve, rad.
    pub(crate) curve_look_rad: f32,
    /// Both feet at each stored phase, under a body that does not lean.
    pub(crate) feet: Vec<[FootPathPoint; 2]>,
    /// Phases of [strike, toe-off] of each foot.
    pub(crate) contact_phases: [[f32; 2]; 2],
    /// Landings in forward and in reversed time.
    pub(crate) landings: [Landing; 2],
    /// Phase after each mid-stance at which the hips are lowest.
    pub(crate) lowest_phase: f32,
    /// Mean height of the hips of a body that does not lean, m.
    pub(crate) mean_hips_m: f32,
    /// Greatest height of the hips, m.
    pub(crate) top_hips_m: f32,
    /// Displacement forward that brings the middle of each foot's sole under the hips at mid-stance, m: there it is in a
    /// body that stands, while a walk leans over its feet.
    pub(crate) to_standing_m: [f32; 2],
    /// Mean rotation of each joint over the cycle.
    pub(crate) mean_rotations: [Quat; JOINT_COUNT],
    /// Greatest difference between the carried times of both feet, s.
    pub(crate) carried_apart_s: f32,
    /// Least lateral distance between the positions of both feet, m.
    pub(crate) track_m: f32,
}

impl BaseWalk {
    /// Takes an example apart; `None` for one that stands or does not walk forward.
    pub fn new(db: &MotionDb, example: usize) -> Option<Self> {
        let m_sp = &db.examples[example];
        let key_times_s = m_sp.key_times_s.filter(|_| m_sp.parameters.speed_mps > 0.0)?;
        let (rows, mean) = (db.posed_rows(example), db.rows.mean_pose(example));
        let lean_rad = lean_rad(&m_sp.parameters);
        let lean = unit_vector(lean_rad);
        let mean_hips_m = mean.pelvis_m.z / lean.x;
        let [left, right] = [0, 1].map(|side| foot_path(m_sp, key_times_s, side, &rows));
        let upright = |foot: FootPathPoint| {
            let position_m = foot.position_m + Vec3::Y * (mean_hips_m * lean.y);
            FootPathPoint { position_m, ..foot }
        };
        let feet: Vec<[FootPathPoint; 2]> =
            left.into_iter().zip(right).map(|(left, right)| [left, right].map(upright)).collect();
        let greatest = |value: fn(&[FootPathPoint; 2]) -> f32| feet.iter().map(value).fold(f32::NEG_INFINITY, f32::max);
        let [right_off, right_strike, left_off, left_strike] = key_times_s.map(|time_s| m_sp.phase_map.phase(time_s));
        let landings = [
            Landing::new(&rows, &feet, [left_strike, right_strike], false),
            Landing::new(&rows, &feet, [left_off, right_off], true),
        ];
        Some(Self {
            example,
            parameters: m_sp.parameters,
            phase_map: m_sp.phase_map,
            lean_rad,
            curve_look_rad: curve_look_rad(&mean, m_sp.parameters.turn_rate_rad_s, &db.skeleton),
            mean_hips_m,
            top_hips_m: rows.iter().map(|joints| joints.positions_m[Joint::Pelvis.index()].z).fold(0.0, f32::max),
            to_standing_m: [0, 1].map(|side| {
                let foot = &feet[MID_STANCE_ROWS[side]][side];
                let Foot { heel_m, ball_m, .. } = db.skeleton.feet[side];
                -(foot.position_m + foot.orientation * (0.5 * (heel_m + ball_m))).x
            }),
            contact_phases: [[left_strike, left_off], [right_strike, right_off]],
            landings,
            lowest_phase: 0.5 * (landings[0].after_mid_stance + landings[1].after_mid_stance),
            mean_rotations: mean.rotations,
            carried_apart_s: greatest(|[left, right]| (left.carried_s - right.carried_s).abs()),
            track_m: -greatest(|[left, right]| right.position_m.y - left.position_m.y),
            feet,
        })
    }

    /// Cadence at some parameters, divided by that of m_sp.
    pub fn cadence(&self, parameters: Parameters) -> f32 {
        let Parameters { speed_mps, turn_rate_rad_s, strafe_mps } = parameters;
        let forward_mps = if speed_mps < 0.0 { BACKWARD_EFFORT * speed_mps } else { speed_mps };
        let effort_mps = Vec3::new(forward_mps, STRAFE_EFFORT * strafe_mps, TURN_EFFORT_M * turn_rate_rad_s).length();
        libm::sqrtf(effort_mps / self.parameters.speed_mps).clamp(CADENCE_RANGE[0], CADENCE_RANGE[1])
    }

    /// The nearest parameters to which m_sp is deformed: at each turn rate an ellipse of speeds.
    pub fn reachable(&self, query: Parameters) -> Parameters {
        let turn_rate_rad_s = query.turn_rate_rad_s.clamp(-TURN_MAX_RAD_S, TURN_MAX_RAD_S);
        let scaled_mps =
            |turn_end_rad_s: f32| self.parameters.speed_mps * (1.0 - turn_rate_rad_s.abs() / turn_end_rad_s);
        let along_max = if query.speed_mps < 0.0 { BACKWARD_MAX } else { FORWARD_MAX };
        let along_max_mps = along_max * scaled_mps(TURN_END_RAD_S);
        let strafe_max_mps = STRAFE_MAX * scaled_mps(STRAFE_TURN_END_RAD_S);
        let excess = Vec2::new(query.speed_mps / along_max_mps, query.strafe_mps / strafe_max_mps).length().max(1.0);
        Parameters { speed_mps: query.speed_mps / excess, turn_rate_rad_s, strafe_mps: query.strafe_mps / excess }
    }

    /// A foot at its mid-stance.
    pub(crate) fn mid_stance(&self, side: usize) -> &FootPathPoint {
        &self.feet[MID_STANCE_ROWS[side]][side]
    }
}

/// Lean of m_sp to the left at some parameters, rad.
pub(crate) fn lean_rad(parameters: &Parameters) -> f32 {
    let forward = Parameters { strafe_mps: 0.0, ..*parameters };
    lean_in_curve_rad(&forward).y.clamp(-LEAN_MAX_RAD, LEAN_MAX_RAD)
}
