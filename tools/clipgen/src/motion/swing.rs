//! The foot in the air: from its position and velocity at toe-off to those at the strike.
//!
//! 1. Five coordinates (ankle x, y, z, yaw, pitch) follow cubic Hermite curves that meet position and velocity of both
//!    contacts; the bend of the toes too, with a rest in between.
//! 2. The published swing, less its own Hermite curve, is added. That shape vanishes with its slope at both ends:
//!    contacts stay exact, and the fold of the knee, the clearance of the toes and the dorsiflexion of the foot are
//!    human.
//! 3. The clearance that is still missing is added as a hump.
//!
//! Root frame: x forward, y left, z up, metres, radians; s is the share of the swing.

use glam::DVec3;

use crate::body::skeleton::TOE_TIP_X_M;
use crate::motion::foot_roll::FootPlacement;
use crate::motion::steps::PlannedStance;
use crate::plan::GaitPlan;

/// Least clearance of the sole in mid-swing, m: human toes pass 1.3 cm over the ground.
const CLEARANCE_M: f64 = 0.013;
/// Share of the added lift of the toes that comes from the ankle; the rest comes from knee and hip.
const TOE_UP_SHARE: f64 = 0.6;
/// Least clearance of a runner's sole, m: the toes still point down as the shank swings through.
const RUNNING_CLEARANCE_M: f64 = 0.03;
/// Shares of the swing from and to which [`RUNNING_CLEARANCE_M`] holds.
const RUNNING_CLEAR_FROM_TO: [f64; 2] = [0.25, 0.80];
/// Share of a turn's bank that a foot takes at mid-swing, when it hangs from its shank.
const SWING_BANK_SHARE: f64 = 0.7;
/// Share of the swing until which the toes spring back after toe-off.
const TOES_BACK_AT: f64 = 0.5;
/// Bend of the toes upward at that time, rad: 10°. Human toes are 25° up at the strike (Perry, *Gait Analysis*, ch. 4).
const TOES_UP_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// Step of one-sided slopes, share of the stride.
const SLOPE_STEP: f64 = 1e-4;

/// Speed of the ankle just before the strike, forward and down, shares of the walking speed: at 1.4 m/s the heel
/// arrives, the foot's own turn included, at about 0.4 and 0.3 m/s.
const WALKING_IMPACT_SHARES: [f64; 2] = [0.16, 0.12];
/// The same for running feet, which still swing at the strike: some 1 m/s forward and 0.7 m/s down at 3 m/s.
const RUNNING_IMPACT_SHARES: [f64; 2] = [0.34, 0.24];
/// Rate of the pitch just before the strike, share of the rate just after it; the published pitch hardly changes there.
const IMPACT_PITCH_SHARE: f64 = 0.15;

/// Ankle x, y, z (m), yaw, pitch, toe bend (rad).
type FootCoordinates = [f64; 6];
/// Index of the toe bend in [`FootCoordinates`].
const TOES: usize = 5;

/// One swing of a leg.
#[derive(Clone, Debug)]
pub(crate) struct FootSwing {
    /// Leg phase at which the swing begins.
    toe_off: f64,
    /// Curve between both contacts, [`FootCoordinates`].
    feet: Hermite<6>,
    /// The same of the published swing: ankle x and z, pitch.
    published: Hermite<3>,
    /// Height of the added hump, m.
    hump_m: f64,
}

impl FootSwing {
    /// The swing between two stances of a leg; `hip_height_m` is a function of the leg phase since the first strike.
    pub(crate) fn between(from: &PlannedStance, to: &PlannedStance, hip_height_m: &dyn Fn(f64) -> f64) -> Self {
        let gait = from.steps.gait;
        let [leaving, arriving] = [from, to].map(|stance| |p: f64| coordinates(&stance.foot(p)));
        let published = |p: f64| published_coordinates(gait, p, hip_height_m);
        let mut swing = Self {
            toe_off: gait.toe_off,
            feet: Hermite {
                ends: [leaving(gait.toe_off), arriving(0.0)],
                slopes: [
                    slope(&leaving, gait.toe_off, gait.toe_off - SLOPE_STEP, gait),
                    slope(&arriving, SLOPE_STEP, 0.0, gait),
                ],
            },
            published: Hermite {
                ends: [published(gait.toe_off), published(1.0)],
                slopes: [
                    slope(&published, gait.toe_off + SLOPE_STEP, gait.toe_off, gait),
                    slope(&published, 1.0, 1.0 - SLOPE_STEP, gait),
                ],
            },
            hump_m: gait.lift_m * (1.0 - gait.style_share),
        };
        swing.arrive_with_impact(gait);
        swing.hump_m += swing.missing_clearance_m(gait, hip_height_m) + to.lift_m();
        swing
    }

    /// The foot at leg phase `p` in [toe-off, 1].
    pub(crate) fn foot(&self, gait: &GaitPlan, p: f64, hip_height_m: &dyn Fn(f64) -> f64) -> FootPlacement {
        let s = (p - self.toe_off) / (1.0 - self.toe_off);
        let [mut x, y, mut z, yaw_rad, mut pitch_rad, _] = self.feet.at(s);
        let toe_bend_rad = self.feet.resting_between(gait.style_share * TOES_UP_RAD, TOES, s);
        let shape = published_coordinates(gait, p, hip_height_m);
        let chord = self.published.at(s);
        x += gait.style_share * (shape[0] - chord[0]);
        let lift_m = self.hump_m * hump(gait, s);
        z += gait.style_share * (shape[1] - chord[1]) + (1.0 - gait.style_share * TOE_UP_SHARE) * lift_m;
        pitch_rad += gait.style_share * (shape[2] - chord[2] + TOE_UP_SHARE * lift_m / TOE_TIP_X_M);
        let roll_rad = -SWING_BANK_SHARE * gait.upper_body.bank_rad * 4.0 * s * (1.0 - s);
        FootPlacement { ankle_m: DVec3::new(x, y, z), yaw_rad, pitch_rad, roll_rad, toe_bend_rad }
    }

    /// Makes the strike an impact: until then the foot moves on forward and down, and its sole does not slap down yet.
    fn arrive_with_impact(&mut self, gait: &GaitPlan) {
        let swing_m = gait.style_share * gait.root.pace_mps() * (1.0 - self.toe_off) * gait.period_s();
        let [forward_share, down_share] = if gait.running { RUNNING_IMPACT_SHARES } else { WALKING_IMPACT_SHARES };
        let arrival = &mut self.feet.slopes[1];
        arrival[0] += forward_share * swing_m;
        arrival[2] -= down_share * swing_m;
        arrival[4] *= IMPACT_PITCH_SHARE;
    }

    /// Height of the hump with which the sole clears the ground, m.
    fn missing_clearance_m(&self, gait: &GaitPlan, hip_height_m: &dyn Fn(f64) -> f64) -> f64 {
        let missing_at = |step: u32| {
            let s = f64::from(step) / 100.0;
            let foot = self.foot(gait, self.toe_off + s * (1.0 - self.toe_off), hip_height_m);
            let lowest_m = foot.sole_heights_m().into_iter().fold(f64::INFINITY, f64::min);
            (required_clearance_m(gait, s) - lowest_m) / hump(gait, s)
        };
        (5..=95).map(missing_at).fold(0.0, f64::max)
    }
}

/// Cubic Hermite curves over s in [0, 1].
#[derive(Clone, Debug)]
struct Hermite<const N: usize> {
    /// Values at both ends.
    ends: [[f64; N]; 2],
    /// Slopes at both ends, per unit of s.
    slopes: [[f64; N]; 2],
}

impl<const N: usize> Hermite<N> {
    fn at(&self, s: f64) -> [f64; N] {
        let rest = 1.0 - s;
        let [start, end] = [(1.0 + 2.0 * s) * rest * rest, s * s * (3.0 - 2.0 * s)];
        let [leave, arrive] = [s * rest * rest, -s * s * rest];
        std::array::from_fn(|i| {
            start * self.ends[0][i] + end * self.ends[1][i] + leave * self.slopes[0][i] + arrive * self.slopes[1][i]
        })
    }
}

impl Hermite<6> {
    /// One coordinate that passes through `resting`, with slope 0, at [`TOES_BACK_AT`].
    fn resting_between(&self, resting: f64, i: usize, s: f64) -> f64 {
        let (end, length, since) = match s < TOES_BACK_AT {
            true => (0, TOES_BACK_AT, s),
            false => (1, 1.0 - TOES_BACK_AT, 1.0 - s),
        };
        let (u, rest) = (since / length, 1.0 - since / length);
        let outward_slope = if end == 0 { self.slopes[0][i] } else { -self.slopes[1][i] };
        let leaving = rest * rest * ((1.0 + 2.0 * u) * self.ends[end][i] + u * length * outward_slope);
        leaving + u * u * (3.0 - 2.0 * u) * resting
    }
}

/// Slope between two phases, per swing.
fn slope<const N: usize>(of: &dyn Fn(f64) -> [f64; N], late: f64, early: f64, gait: &GaitPlan) -> [f64; N] {
    let (late_values, early_values) = (of(late), of(early));
    std::array::from_fn(|i| (late_values[i] - early_values[i]) * (1.0 - gait.toe_off) / (late - early))
}

fn coordinates(foot: &FootPlacement) -> FootCoordinates {
    [foot.ankle_m.x, foot.ankle_m.y, foot.ankle_m.z, foot.yaw_rad, foot.pitch_rad, foot.toe_bend_rad]
}

/// Ankle x and z (m) and pitch of the sole (rad) of the published curves, from the hip down.
fn published_coordinates(gait: &GaitPlan, p: f64, hip_height_m: &dyn Fn(f64) -> f64) -> [f64; 3] {
    let flexion = gait.style.flexion(p, gait.toe_off);
    let [x, z] = flexion.ankle_from_hip_m();
    [x, hip_height_m(p) + z, flexion.foot_pitch_rad()]
}

/// Clearance of the sole that a swing must have, m: near its ends it only needs to stay over the ground.
fn required_clearance_m(gait: &GaitPlan, s: f64) -> f64 {
    let [from, to] = RUNNING_CLEAR_FROM_TO;
    match gait.running {
        true if (from..=to).contains(&s) => RUNNING_CLEARANCE_M,
        false if (0.25..=0.75).contains(&s) => CLEARANCE_M * hump(gait, s),
        _ => 0.0,
    }
}

/// The shape of added lift: 1 at its greatest, 0 with zero slope at both ends. Walking toes need most at s = 0.4 (later
/// they are up by themselves), running toes at 0.6.
fn hump(gait: &GaitPlan, s: f64) -> f64 {
    let (s, rest) = if gait.running { (1.0 - s, s) } else { (s, 1.0 - s) };
    s * s * rest * rest * rest / (0.4 * 0.4 * 0.6 * 0.6 * 0.6)
}
