//! From a plan to the parameters asked of the blend space: (v, o_d) → (v_f, ω_t, ω_s) → shares (`FbCrowd` §5, "query point").
//!
//! With α the angle from the facing to the wanted one, and (a, b) the planned velocity along and left of the *wanted* facing,
//!
//!     ω_t = α / T_turn,   (v_f, ω_s) = (a, b)·max(0, cos α)
//!
//! A plan whose facing follows its velocity has b = 0 and becomes a turning clip, at the speed that brings the body where the plan wants
//! it (going on at full speed while it faces elsewhere leads away); one that holds the facing has α = 0 and becomes a side-step or a step
//! back. To ask for the planned velocity exactly while turning, side-stepping a·sin α, is worse in every way: it lies so far outside
//! the examples that the nearest point of their hull hardly turns. The root then moves from what it does towards what is asked at limited
//! accelerations, straight through the space of parameters: the body passes the examples between.
//!
//! A body that stands does not creep: mixing a little step into idle lifts no foot. It stands, or it takes at least the steps that a
//! mix with [`IDLE_SHARE_MAX`] of standing has.

use glam::Vec2;
use motiondb::blend_space::{Locator, Shares};
use motiondb::motion_db::MotionDb;
use motiondb::parameters::Parameters;

use super::params::HmsParams;
use crate::angle::wrap_rad;
use crate::plan::Plan;

/// Greatest share of standing examples in a body that steps: with more, the blended contact of a swinging foot would not fall below ½.
const IDLE_SHARE_MAX: f32 = 0.35;
/// A standing body starts where the asked parameters hold less standing than this …
const START_IDLE_SHARE: f32 = 0.8;
/// … and a stepping one stops where they hold more than this. A planner that approaches its preferred velocity from the present one keeps
/// asking for some 0.45 of the least steps' 0.65: a body that is to stop must take that, an idle share of 0.71, for standing …
const STOP_IDLE_SHARE: f32 = 0.65;
/// … but either lasts for this long, about a step, s, for the planner goes on to speak of the velocity before …
const GAIT_TIME_S: f32 = 0.4;
/// … unless it is asked to stand in earnest.
const HALT_IDLE_SHARE: f32 = 0.95;
/// A plan slower than this does not turn the body, for the direction of next to nothing is no direction …
const TURN_SPEED_MIN_MPS: f32 = 0.1;
/// … and one faster than this turns it at any rate.
const TURN_SPEED_FULL_MPS: f32 = 0.2;

/// Whether a body stands or steps, and for how long, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gait {
    /// Both feet on the ground.
    Standing(f32),
    /// One foot after the other.
    Stepping(f32),
}

impl Gait {
    /// Follows what is asked, with hysteresis.
    fn followed(self, idle_share: f32, dt_s: f32) -> Self {
        match self {
            Self::Standing(for_s) if for_s >= GAIT_TIME_S && idle_share < START_IDLE_SHARE => Self::Stepping(dt_s),
            Self::Stepping(for_s) if for_s >= GAIT_TIME_S && idle_share > STOP_IDLE_SHARE => Self::Standing(dt_s),
            Self::Stepping(_) if idle_share > HALT_IDLE_SHARE => Self::Standing(dt_s),
            Self::Standing(for_s) => Self::Standing(for_s + dt_s),
            Self::Stepping(for_s) => Self::Stepping(for_s + dt_s),
        }
    }
}

/// The blend space of a database, ready for queries.
#[derive(Clone, Debug)]
pub struct Space {
    locator: Locator,
    stands: Vec<bool>,
    turn_rate_max_rad_s: f32,
    speed_max_mps: f32,
}

impl Space {
    /// Of one database.
    pub fn new(db: &MotionDb) -> Self {
        let points: Vec<Parameters> = db.examples.iter().map(|example| example.parameters).collect();
        let greatest = |of: fn(&Parameters) -> f32| points.iter().map(of).fold(0.0, f32::max);
        Self {
            locator: Locator::new(&db.blend_space, &points),
            stands: db.examples.iter().map(|example| example.key_times_s.is_none()).collect(),
            turn_rate_max_rad_s: greatest(|point| point.turn_rate_rad_s.abs()),
            speed_max_mps: greatest(|point| Vec2::new(point.speed_mps, point.strafe_mps).length()),
        }
    }

    /// Shares at a point, or at the nearest one that the database has.
    pub fn locate(&self, parameters: Parameters) -> Shares {
        self.locator.locate(parameters)
    }

    /// Shares of standing still, or of whatever the database has that is slowest.
    pub fn standing(&self) -> Shares {
        self.locate(Parameters::default())
    }

    /// Share of examples that stand.
    fn idle_share(&self, shares: &Shares) -> f32 {
        let entries = shares.examples.into_iter().zip(shares.shares);
        entries.filter(|entry| self.stands[entry.0 as usize]).map(|entry| entry.1).sum()
    }
}

/// What a plan asks of a body that faces `facing_rad`; anything not finite asks to stand.
pub fn asked(plan: &Plan, facing_rad: f32, space: &Space, params: &HmsParams) -> Parameters {
    if !(plan.velocity_mps.is_finite() && plan.facing_rad.is_finite()) {
        return Parameters::default();
    }
    let turn_rad = wrap_rad(plan.facing_rad - facing_rad);
    let velocity_mps = plan.velocity_mps.clamp_length_max(space.speed_max_mps);
    let wanted_mps = Vec2::from_angle(-plan.facing_rad).rotate(velocity_mps) * libm::cosf(turn_rad).max(0.0);
    let going = (velocity_mps.length() - TURN_SPEED_MIN_MPS) / (TURN_SPEED_FULL_MPS - TURN_SPEED_MIN_MPS);
    let turn_rate_max_rad_s = going.clamp(0.0, 1.0) * space.turn_rate_max_rad_s;
    let turn_rate_rad_s = (turn_rad / params.turn_time_s).clamp(-turn_rate_max_rad_s, turn_rate_max_rad_s);
    Parameters { speed_mps: wanted_mps.x, turn_rate_rad_s, strafe_mps: wanted_mps.y }
}

/// What the database can do of what is asked, as parameters inside its hull; none of it while the body stands.
pub fn realisable(asked: Parameters, space: &Space, db: &MotionDb, gait: &mut Gait, dt_s: f32) -> Parameters {
    let shares = space.locate(asked);
    let idle = space.idle_share(&shares);
    *gait = gait.followed(idle, dt_s);
    if matches!(gait, Gait::Standing(_)) {
        return parameters_of(&space.standing(), db);
    }
    // Standing lies at the origin: scaling by this leaves that share of it.
    let scale = if idle > IDLE_SHARE_MAX { (1.0 - IDLE_SHARE_MAX) / (1.0 - idle) } else { 1.0 };
    Parameters::from_vec3(scale * parameters_of(&shares, db).to_vec3())
}

/// Shares of the point on the straight way from `now` to `goal` that a body may reach in one step.
pub fn step_towards(now: Parameters, goal: Parameters, space: &Space, params: &HmsParams, dt_s: f32) -> Shares {
    let change = goal.to_vec3() - now.to_vec3();
    let speed_change_mps = Vec2::new(change.x, change.z).length();
    let within = |change: f32, change_max: f32| if change <= change_max { 1.0 } else { change_max / change };
    let fraction = within(speed_change_mps, params.acceleration_max_mps2 * dt_s)
        .min(within(change.y.abs(), params.turn_acceleration_max_rad_s2 * dt_s));
    space.locate(Parameters::from_vec3(now.to_vec3() + fraction * change))
}

fn parameters_of(shares: &Shares, db: &MotionDb) -> Parameters {
    let terms = shares.examples.into_iter().zip(shares.shares);
    Parameters::from_vec3(
        terms.map(|(example, share)| share * db.examples[example as usize].parameters.to_vec3()).sum(),
    )
}
