//! The plan of one steady gait: everything that the generator needs to make its cycle.
//!
//! Phases and durations are shares of the stride, from the heel strike of a leg. Angles in radians, lengths in metres.

use crate::plan::published_curves::PublishedGait;
use crate::plan::root_motion::RootMotion;

/// Frame rate of every clip, frames per second.
pub(crate) const FRAME_RATE_HZ: f64 = 30.0;
/// Height times the tangent of the lean by which the feet of a turning body go outward, m: .92 m of the hips, less what
/// the trunk banks over them. At 0.56 m no ankle everts beyond its 20° (AAOS 1965), even in the tightest jog.
const LEAN_ARM_M: f64 = 0.56;

/// The plan of one steady gait.
#[derive(Clone, Debug)]
pub(crate) struct GaitPlan {
    /// Constant rates of the root.
    pub(crate) root: RootMotion,
    /// Duration of a stride, frames; need not be whole.
    pub(crate) stride_frames: f64,
    /// Toe-off, share of the stride from the strike.
    pub(crate) toe_off: f64,
    /// Published curves that the gait follows.
    pub(crate) style: PublishedGait,
    /// Share of their published swing that the feet follow: 1 forward, 0 for gaits without published curves.
    pub(crate) style_share: f64,
    /// Lift of a foot that does not follow the published swing, m.
    pub(crate) lift_m: f64,
    /// Distance of the ankle from the root's path at mid-stance, m.
    pub(crate) half_width_m: f64,
    /// Direction of the toes outward, rad.
    pub(crate) toe_out_rad: f64,
    /// Flexion that every knee keeps, rad: the hips are so low that no knee needs to straighten more.
    pub(crate) least_knee_rad: f64,
    /// Motion of a foot on the ground.
    pub(crate) roll: FootRoll,
    /// The gait has a flight phase, in which the hips fall freely.
    pub(crate) running: bool,
    /// Phase at which pelvis and chest are turned farthest, the striking side's hip ahead, from that strike.
    pub(crate) yaw_peak: f64,
    /// Motion of the pelvis about its path.
    pub(crate) pelvis: PelvisAmplitudes,
    /// Motion of trunk, head and arms.
    pub(crate) upper_body: UpperBodyAmplitudes,
}

/// Pitch of the sole through stance, rad; positive with the toes up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FootRoll {
    /// Pitch at the strike.
    pub(crate) strike_pitch_rad: f64,
    /// Phase from which the sole is flat.
    pub(crate) flat_from: f64,
    /// Phase at which the heel begins to rise.
    pub(crate) heel_off: f64,
    /// Power of time by which the heel rises: late and fast (published free walk: −15° at 50 %, −55° at toe-off).
    pub(crate) heel_rise_power: f64,
    /// Pitch at toe-off; negative.
    pub(crate) toe_off_pitch_rad: f64,
    /// Pitch of the toes themselves at toe-off; negative.
    pub(crate) toe_off_toe_pitch_rad: f64,
}

/// Amplitudes of the pelvis's motion about its path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PelvisAmplitudes {
    /// Sway towards the stance foot, m.
    pub(crate) sway_m: f64,
    /// Surge ahead and behind, twice a stride, m.
    pub(crate) surge_m: f64,
    /// Scale of the published obliquity, rad (free class ±4.1°).
    pub(crate) list_rad: f64,
    /// Scale of the published rotation, rad (free class ±4.4°).
    pub(crate) rotation_rad: f64,
}

/// Means and amplitudes of trunk, head and arms, rad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UpperBodyAmplitudes {
    /// Lean of the trunk, forward.
    pub(crate) lean_rad: f64,
    /// Bank into the turn, from the centripetal acceleration; positive to the left.
    pub(crate) bank_rad: f64,
    /// Lag of the trunk behind a side-step, as the leading foot lands; positive with the left side up.
    pub(crate) side_lag_rad: f64,
    /// Yaw of the head into the direction of travel; positive to the left.
    pub(crate) look_rad: f64,
    /// Yaw of the chest against the pelvis's.
    pub(crate) chest_yaw_rad: f64,
    /// Mean flexion of the shoulder.
    pub(crate) arm_mean_rad: f64,
    /// Amplitude of the arm swing, half of its arc.
    pub(crate) arm_swing_rad: f64,
    /// Angle of the arms out from the body.
    pub(crate) arm_out_rad: f64,
    /// Mean bend of the elbow.
    pub(crate) elbow_rad: f64,
    /// Amplitude of the elbow's bend.
    pub(crate) elbow_swing_rad: f64,
}

impl GaitPlan {
    /// Duration of a stride, s.
    pub(crate) fn period_s(&self) -> f64 {
        self.stride_frames / FRAME_RATE_HZ
    }

    /// Mid-stance, share of the stride from the strike.
    pub(crate) fn mid_stance(&self) -> f64 {
        0.5 * self.toe_off
    }

    /// Displacement of the footprints outward of the root's path in a turn, m; positive to the left.
    pub(crate) fn footprint_shift_m(&self) -> f64 {
        -LEAN_ARM_M * libm::tan(self.upper_body.bank_rad)
    }
}
