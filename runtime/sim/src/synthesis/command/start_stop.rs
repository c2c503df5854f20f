//! The feet of a body that starts to step: which of them makes the first step.
//!
//! Positions are those of the balls of the feet, relative to those of a standing body, metres.

use glam::Vec2;
use motiondb::body::Root;
use motiondb::motion::Parameters;

use crate::synthesis::Traits;
use crate::synthesis::blending::BlendDomain;
use crate::synthesis::pose::ContactState;

/// Phase of the first step before the swinging foot passes the other: the foot lifts there, and passes when stepping
/// has faded in.
const LIFT_OFF_PHASE: f32 = 0.15;
/// Lead of a foot, m, up to which it makes the first step to its own side.
const SIDE_LEAD_M: f32 = 0.1;

/// Phase of the first step; the phase of a standing body is free, since standing hardly moves. The foot that lifts is
/// the one that a settling step leaves (`SettlingStep::foot_to_lift`), the one further behind, or the one on the side of
/// the step; where none is, the body's first foot. So the other foot is under the body.
pub(crate) fn first_step_phase(
    command: Parameters,
    contact: &ContactState,
    root: &Root,
    domain: &BlendDomain,
    traits: &Traits,
) -> f32 {
    let Parameters { speed_mps, turn_rate_rad_s, strafe_mps } = command;
    let (direction, frame) = (Vec2::new(speed_mps, strafe_mps).normalize_or_zero(), root.frame());
    let ahead_m = contact.off_m(&frame, &domain.standing_balls_m).map(|off_m| off_m.dot(direction));
    let to_left = direction.y + turn_rate_rad_s / domain.turn_rate_max_rad_s;
    let left_is_behind = ahead_m[0] - ahead_m[1] < SIDE_LEAD_M * to_left + traits.first_foot_m;
    let lifts_left = contact.settling.foot_to_lift().map_or(left_is_behind, |side| side == 0);
    let passing_phase = if lifts_left { 1.0 } else { 0.5 };
    passing_phase - LIFT_OFF_PHASE
}

/// The foot that stays on the ground in a first step from a phase; 0 is the left one.
pub(crate) fn stance_foot(first_step_phase: f32) -> usize {
    usize::from(first_step_phase > 0.5)
}
