//! Standing or stepping: a body does not creep.
//!
//! Mixing a little step into idle lifts no foot: by the blended contact Σ w·c both feet stay planted as long as
//! standing has the greater share. So a body stands, or it takes at least the steps of a mix with [`IDLE_SHARE_MAX`] of
//! standing; and it does not freeze in mid-stride, but takes such small steps until its feet are under it. Slower
//! still, it takes those least steps in less than their own time, down to `PACE_MIN`.

use glam::Vec2;
use motiondb::blend_space::Shares;
use motiondb::motion::Parameters;

use crate::synthesis::blending::blend_space::{Nearest, Space};

/// Greatest share of standing examples in a body that steps: with more, the blended contact of a swinging foot would
/// not fall below ½.
pub(crate) const IDLE_SHARE_MAX: f32 = 0.35;
/// Slowest that the least steps are taken: a cadence of half a stroll's.
pub(crate) const PACE_MIN: f32 = 0.3;
/// A standing body starts where the asked parameters hold less standing than this …
pub const START_IDLE_SHARE: f32 = 0.8;
/// … and a stepping one stops where they hold more than this: the slowest steps, 1 − `PACE_MIN`·(1 −
/// [`IDLE_SHARE_MAX`]) = 0.805, lie between the two.
const STOP_IDLE_SHARE: f32 = 0.82;
/// A set without slow walks mixes its fast ones with so much standing that nobody would ever start: shares count as if
/// the slowest walk made no more than this, m/s.
const SLOWEST_MPS: f32 = 1.3;
/// Standing and stepping last for this long, about a step, s, since a planner that leads on from the present velocity
/// asks for it a while longer …
const GAIT_TIME_S: f32 = 0.4;
/// … but who is asked for more standing than this stops at once: not even a direction is left to step in.
const HALT_IDLE_SHARE: f32 = 0.95;
/// Who will be asked to step after this time, if what is asked goes on to change as it does, passes by rest on its way
/// to go elsewhere, s: from one side-step to the other at 2.5 m/s² that takes so long.
pub(crate) const PASSING_TIME_S: f32 = 0.2;
/// To stop, a body takes small steps until its feet are under it, for this long at most, s.
const GATHERING_TIME_S: f32 = 1.2;
/// Meanwhile it makes for this share of its present velocity, or for the least steps where those are more.
const SLOWING: f32 = 0.25;

/// Whether a body stands or steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gait {
    /// Both feet on the ground; otherwise one after the other.
    pub stands: bool,
    /// For how long, s.
    since_s: f32,
    /// How long it has been stepping though asked to stand, s.
    gathering_s: f32,
}

impl Gait {
    /// At the start: standing, ready to go.
    pub const STANDING: Self = Self { stands: true, since_s: GAIT_TIME_S, gathering_s: 0.0 };

    /// Follows `nearest`, what the database has of what is asked, with hysteresis; `feet_gathered` tells whether the
    /// body could stand as its feet are. Returns whether it now starts to step.
    pub fn follow(&mut self, nearest: &Nearest, feet_gathered: impl FnOnce() -> bool, dt_s: f32) -> bool {
        let idle_share = nearest.idle_share.min(slow_share(nearest.parameters));
        let lasted = self.since_s >= GAIT_TIME_S;
        let stop = !self.stands && (lasted && idle_share > STOP_IDLE_SHARE || idle_share > HALT_IDLE_SHARE);
        let start = self.stands && lasted && idle_share < START_IDLE_SHARE;
        self.gathering_s = if stop { self.gathering_s + dt_s } else { 0.0 };
        if start || self.gathering_s > GATHERING_TIME_S || stop && feet_gathered() {
            *self = Self { stands: !self.stands, since_s: 0.0, gathering_s: 0.0 };
        }
        self.since_s += dt_s;
        start
    }

    /// What the database has nearest to what is asked of the body; where that is rest on the way to go elsewhere, to
    /// `ahead`, what will be asked after `PASSING_TIME_S`.
    pub fn nearest(&self, asked: Parameters, ahead: Parameters, space: &Space) -> Nearest {
        let nearest = space.nearest(asked);
        let passes = !self.stands && nearest.idle_share > STOP_IDLE_SHARE && slow_share(ahead) < STOP_IDLE_SHARE;
        if passes { space.nearest(ahead) } else { nearest }
    }

    /// Whether the body is to stand as soon as its feet are under it.
    fn gathers(&self) -> bool {
        self.gathering_s > 0.0
    }
}

/// The share of standing that a speed counts as, at least.
fn slow_share(parameters: Parameters) -> f32 {
    1.0 - Vec2::new(parameters.speed_mps, parameters.strafe_mps).length() / SLOWEST_MPS
}

/// The parameters to make for: `nearest`, what the database has of what is asked, at steps no smaller than the least;
/// none where the body stands. `now`, what it does, gives the direction where it gathers its feet.
pub(crate) fn goal(nearest: Nearest, now: Parameters, gait: Gait, space: &Space) -> Parameters {
    if gait.stands {
        return space.standing.parameters;
    }
    let slowing = || space.nearest(Parameters::from_vec3(SLOWING * now.to_vec3()));
    let goal = if nearest.idle_share > HALT_IDLE_SHARE { slowing() } else { nearest };
    let slowest = if gait.gathers() { 1.0 } else { PACE_MIN };
    // Standing lies at the origin: scaling by this leaves that share of it.
    let stepping_share = (1.0 - goal.idle_share).max(1.0 - HALT_IDLE_SHARE);
    let scale = (slowest * (1.0 - IDLE_SHARE_MAX) / stepping_share).max(1.0);
    Parameters::from_vec3(scale * goal.parameters.to_vec3())
}

/// What to play for parameters that the database has: shares, and their pace.
pub(crate) fn steps(nearest: &Nearest, gait: Gait, space: &Space) -> (Shares, f32) {
    let stepping_share = 1.0 - nearest.idle_share;
    if gait.stands || stepping_share >= 1.0 - IDLE_SHARE_MAX || stepping_share <= 0.0 {
        return (nearest.shares, 1.0);
    }
    let pace = stepping_share / (1.0 - IDLE_SHARE_MAX);
    (space.locate(Parameters::from_vec3(nearest.parameters.to_vec3() / pace)), pace.max(PACE_MIN))
}
