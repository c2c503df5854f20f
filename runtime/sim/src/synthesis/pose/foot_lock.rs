//! Foot lock: a planted foot stays in position, rolls from heel over ball to toe, and is released softly.
//!
//! Weights by shares of time hold planted feet while the weights are constant. While they change, or where turning
//! examples blend, the foot of the pose drifts. A lock is the rigid motion from the pose's foot to the drawn one: a
//! horizontal shift c, a twist ψ about the vertical, and a lift.
//!
//! - *Planted*: c and ψ cancel the motion of the lowest sole point and the turning of the foot. The contact point
//!   rests; the foot still rolls, because the pose determines its pitch. In tight turns the foot pivots a little on its
//!   ball.
//! - *Swinging*: c and ψ decay, c to a shift that avoids walls, other bodies and the other leg
//!   ([`crate::synthesis::pose::foot_room`], [`crate::synthesis::pose::leg_clearance`]), by a critically damped filter
//!   of the third order that starts at their rates. Neither velocity nor acceleration of the foot jumps at toe-off.
//!
//! World frame, metres and radians. z is the height above the ground, equal in world and root frame.

use glam::{Quat, Vec2, Vec3};

use crate::maths::angle::{angle_between_rad, unit_vector, yaw};
use crate::maths::decay::soft_maximum;
use crate::synthesis::TimeStep;
use crate::synthesis::time_step::{LANDING_TIME_S, SoftSpring};

/// Clearance of a swinging foot in short steps and in walking, m: captured steps of 15 to 30 cm lift the sole by 16
/// to 23 mm; toes in walking clear 13 mm (Winter 1992). Blends with standing would drag the toes.
const CLEARANCES_M: [f32; 2] = [0.024, 0.013];
/// Speeds of the foot in the middle of such swings, m/s.
const CLEARANCE_SPEEDS_MPS: [f32; 2] = [1.0, 2.5];
/// Speed from which on a foot needs the whole clearance, m/s: a foot that leaves the ground begins slowly.
const LIFTED_SPEED_MPS: f32 = 0.5;
/// A foot that lands within this time needs no clearance, s.
pub(crate) const LANDING_AHEAD_S: f32 = 0.06;
/// Softness of the lift at the clearance, m: lifting has no edge.
const CLEARANCE_SOFTNESS_M: f32 = 0.002;
/// Greatest shift c, m: that of a step broken off half-way. Beyond it the foot slides.
const SHIFT_MAX_M: f32 = 0.45;
/// Distance of the toes from the axis of a twist, m.
const TOES_M: f32 = 0.25;
/// Twist up to which a foot stands well, inward or outward, rad: idles turn their feet by 7°, and each of these turns would
/// lift one (docs/tuning.md).
const TWIST_TOLERANCE_RAD: f32 = 0.17;
/// Greatest twist ψ, rad: people twist the stance foot, and pivot on it beyond about 45°.
const TWIST_MAX_RAD: f32 = std::f32::consts::FRAC_PI_4;

/// Turn rate of the body beyond which its planted feet pivot, rad/s, and the share of what is beyond by which they do:
/// flat feet of captures pivot by 1.5 to 8° a contact at 170 °/s.
const PIVOT_FROM_RAD_S: f32 = std::f32::consts::FRAC_PI_2;
const PIVOT_SHARE: f32 = 0.25;

/// A foot of the pose, in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PosedFoot {
    /// Position of the ankle, m.
    pub ankle_m: Vec3,
    /// Heel, ball and toe tip on the sole, m.
    pub sole_m: [Vec3; 3],
}

impl PosedFoot {
    /// Vector from heel to ball on the ground, m.
    fn heading_m(&self) -> Vec2 {
        (self.sole_m[1] - self.sole_m[0]).truncate()
    }

    /// Index and height of the lowest sole point, m.
    fn lowest(&self) -> (usize, f32) {
        let heights = self.sole_m.map(|point| point.z);
        (1..3).fold((0, heights[0]), |low, point| if heights[point] < low.1 { (point, heights[point]) } else { low })
    }
}

/// The lock of one foot, and the foot as it was after the last step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FootLock {
    /// Whether the foot is planted.
    planted: bool,
    /// Index of the lowest sole point of the pose's foot.
    lowest: usize,
    /// Shift c, m, its rate of change, m/s, and its acceleration, m/s².
    shift_m: [Vec2; 3],
    /// Twist ψ, rad, its rate of change, rad/s, and its acceleration, rad/s².
    twist_rad: [f32; 3],
    /// Velocity over the ground that is left of landing, m/s.
    landing_mps: Vec2,
    /// Lift, m, its rate of change, m/s, and its acceleration, m/s².
    lift_m: [f32; 3],
    /// Height of the lowest sole point of the pose's foot, m.
    height_m: f32,
    /// Ankle of the pose's foot on the ground, m.
    ankle_m: Vec2,
    /// Vector from heel to ball of the pose's foot, m.
    heading_m: Vec2,
    /// Heel, ball and toe tip of the drawn foot, m.
    sole_m: [Vec3; 3],
    /// Mean speed of the drawn foot over the ground, m/s.
    speed_mps: f32,
}

/// Rate at which the planted feet of a body pivot that turns at `turn_rate_rad_s`, rad/s.
pub(crate) fn pivot_rate_rad_s(turn_rate_rad_s: f32) -> f32 {
    PIVOT_SHARE * (turn_rate_rad_s.abs() - PIVOT_FROM_RAD_S).max(0.0).copysign(turn_rate_rad_s)
}

/// What a lock follows in a step beside the foot of the pose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Footing {
    /// Whether the foot is planted.
    pub planted: bool,
    /// Contact of the pose's foot [`LANDING_AHEAD_S`] later.
    pub contact_ahead: f32,
    /// Shift to which a swinging foot moves because something stands in its path, m.
    pub away_m: Vec2,
    /// Angle by which a planted foot pivots, rad.
    pub pivot_rad: f32,
    /// Whether a swinging foot makes a settling step.
    pub settles: bool,
}

/// Target of a locked foot, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LockedFoot {
    /// Position of the ankle, m.
    pub ankle_m: Vec3,
    /// Twist ψ about the vertical.
    pub twist: Quat,
    /// Whether the foot stood before and stands on.
    pub is_held: bool,
}

impl FootLock {
    /// The lock of a foot that stands where the pose has it.
    pub(crate) fn new(posed: &PosedFoot) -> Self {
        let (lowest, height_m) = posed.lowest();
        let (heading_m, ankle_m) = (posed.heading_m(), posed.ankle_m.truncate());
        Self { lowest, height_m, heading_m, ankle_m, sole_m: posed.sole_m, ..Self::default() }
    }

    /// Moves the lock by one step.
    pub(crate) fn step(&mut self, posed: &PosedFoot, footing: &Footing, step: &TimeStep) -> LockedFoot {
        let Footing { planted, contact_ahead, away_m, pivot_rad, settles } = *footing;
        let heading_m = posed.heading_m();
        let (lowest, height_m) = posed.lowest();
        // A foot lands within the step, where the pose has it now. The lock holds it from the next step on.
        let is_held = planted && self.planted;
        if is_held {
            self.hold(posed, lowest, [angle_between_rad(self.heading_m, heading_m), pivot_rad], step);
        } else {
            if settles {
                self.settle(posed, away_m, step);
            } else {
                self.release(away_m, &step.lock_release);
            }
            self.land(posed, lowest, step);
        }
        (self.planted, self.lowest, self.heading_m, self.ankle_m) =
            (planted, lowest, heading_m, posed.ankle_m.truncate());
        self.lift(height_m, contact_ahead, step);
        let ankle_m = posed.ankle_m + self.shift_m[0].extend(self.lift_m[0]);
        LockedFoot { ankle_m, twist: yaw(self.twist_rad[0]), is_held }
    }

    /// Displacement of the pose's ankle on the ground since the last step, m.
    pub(crate) fn posed_displacement_m(&self, posed: &PosedFoot) -> Vec2 {
        posed.ankle_m.truncate() - self.ankle_m
    }

    /// Shift c of a planted foot, m.
    pub(crate) fn planted_shift_m(&self) -> Option<Vec2> {
        self.planted.then_some(self.shift_m[0])
    }

    /// Way of the toes by which the foot is twisted beyond [`TWIST_TOLERANCE_RAD`], m.
    pub(crate) fn twisted_off_m(&self) -> f32 {
        TOES_M * (self.twist_rad[0].abs() - TWIST_TOLERANCE_RAD).max(0.0)
    }

    /// Position of the ball of the drawn foot, m.
    pub(crate) fn ball_m(&self) -> Vec3 {
        self.sole_m[1]
    }

    /// Whether the foot is planted.
    pub(crate) fn planted(&self) -> bool {
        self.planted
    }

    /// Records the sole as the leg could draw it, m.
    pub(crate) fn record_drawn(&mut self, sole_m: [Vec3; 3], step: &TimeStep) {
        let speed_mps = (sole_m[1] - self.sole_m[1]).truncate().length() / step.dt_s;
        self.speed_mps += (1.0 - step.foot_speed_left) * (speed_mps - self.speed_mps);
        self.sole_m = sole_m;
    }

    /// Cancels the turning of the foot but for its pivot, then the motion of its lowest point, which the twist moves about
    /// the ankle.
    fn hold(&mut self, posed: &PosedFoot, lowest: usize, [turned_rad, pivot_rad]: [f32; 2], step: &TimeStep) {
        let (before_m, before_rad) = (self.shift_m[0], self.twist_rad[0]);
        // On the heel a foot does not pivot.
        let pivot_rad = if lowest == 0 { 0.0 } else { pivot_rad };
        let twist_rad = (before_rad - turned_rad + pivot_rad).clamp(-TWIST_MAX_RAD, TWIST_MAX_RAD);
        self.twist_rad = [twist_rad, (twist_rad - before_rad) / step.dt_s, 0.0];
        let [landing_left, _] = step.landing_left;
        let slid_m = LANDING_TIME_S * (1.0 - landing_left) * self.landing_mps;
        self.landing_mps *= landing_left;
        let shift_m =
            (self.rest_position_m(lowest) + slid_m - self.twisted_m(posed, lowest)).clamp_length_max(SHIFT_MAX_M);
        self.shift_m = [shift_m, (shift_m - before_m) / step.dt_s, Vec2::ZERO];
    }

    /// Records the velocity of the foot for a landing: the share that is left if the foot landed half a step ago.
    fn land(&mut self, posed: &PosedFoot, lowest: usize, step: &TimeStep) {
        let moved_m = self.twisted_m(posed, lowest) + self.shift_m[0] - self.sole_m[lowest].truncate();
        self.landing_mps = step.landing_left[1] / step.dt_s * moved_m;
    }

    /// A point of the pose's sole, twisted about the ankle, m.
    fn twisted_m(&self, posed: &PosedFoot, point: usize) -> Vec2 {
        let (ankle_m, point_m) = (posed.ankle_m.truncate(), posed.sole_m[point].truncate());
        ankle_m + unit_vector(self.twist_rad[0]).rotate(point_m - ankle_m)
    }

    /// Position at which the sole point that is lowest now came to rest, m. If another point was lowest before, both
    /// touched the ground at the change: their distance on the ground is that on the sole.
    fn rest_position_m(&self, lowest: usize) -> Vec2 {
        let rested_m = self.sole_m[self.lowest];
        let along_m = self.sole_m[lowest] - rested_m;
        rested_m.truncate() + along_m.truncate().normalize_or_zero() * along_m.length()
    }

    /// Moves the foot by a filter to where the pose has it but for a shift, and its twist to none. The foot does not follow
    /// the pose: the filter starts from where the foot was on the ground and from its velocity there, which the shift, being
    /// relative to the pose, has only together with the pose's displacement.
    fn settle(&mut self, posed: &PosedFoot, shift_m: Vec2, step: &TimeStep) {
        let moved_m = self.posed_displacement_m(posed);
        self.shift_m[0] -= moved_m;
        self.shift_m[1] += moved_m / step.dt_s;
        self.release(shift_m, &step.settling);
        self.shift_m[1] -= moved_m / step.dt_s;
    }

    /// Lets the shift decay to another, and the twist to none, by a filter.
    fn release(&mut self, away_m: Vec2, filter: &SoftSpring) {
        filter.approach(&mut self.shift_m, away_m);
        self.twist_rad = filter.decayed(self.twist_rad);
    }

    /// Moves the lift towards its target: a planted sole settles on the ground, a swinging one keeps its clearance. No
    /// sole moves below the ground.
    fn lift(&mut self, height_m: f32, contact_ahead: f32, step: &TimeStep) {
        let [before_m, target_m] =
            [self.height_m, height_m].map(|height_m| self.target_lift_m(height_m, contact_ahead));
        let target_mps = (target_m - before_m) / step.dt_s;
        let [lift_m, lift_mps, lift_mps2] = self.lift_m;
        let [off_m, _, off_mps2] = step.foot_lift.decayed([lift_m - before_m, lift_mps - target_mps, lift_mps2]);
        let new_m = (target_m + off_m).max(-height_m);
        self.lift_m = [new_m, (new_m - lift_m) / step.dt_s, off_mps2];
        self.height_m = height_m;
    }

    /// Lift of a foot whose lowest point the pose has at `height_m`, m.
    fn target_lift_m(&self, height_m: f32, contact_ahead: f32) -> f32 {
        if self.planted {
            return -height_m;
        }
        let [slow_mps, quick_mps] = CLEARANCE_SPEEDS_MPS;
        let quickness = ((self.speed_mps - slow_mps) / (quick_mps - slow_mps)).clamp(0.0, 1.0);
        let whole_m = CLEARANCES_M[0] + quickness * (CLEARANCES_M[1] - CLEARANCES_M[0]);
        let clearance_m = whole_m * (1.0 - contact_ahead) * (self.speed_mps / LIFTED_SPEED_MPS).min(1.0);
        CLEARANCE_SOFTNESS_M * soft_maximum((clearance_m - height_m) / CLEARANCE_SOFTNESS_M)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pivot, degrees, and way of the ball, m, in 0.3 s of a body that turns on a foot with its heel at a height.
    fn pivot(turn_rate_deg_s: f32, heel_m: f32, dt_s: f32) -> [f32; 2] {
        let sole_m = [(-0.05, heel_m), (0.13, 0.0), (0.2, 0.0)].map(|(along_m, z)| Vec3::new(along_m, 0.0, z));
        let posed = PosedFoot { ankle_m: Vec3::new(0.0, 0.0, 0.07), sole_m };
        let (mut lock, step) = (FootLock { planted: true, ..FootLock::new(&posed) }, TimeStep::new(dt_s));
        let pivot_rad = dt_s * pivot_rate_rad_s(turn_rate_deg_s.to_radians());
        let footing = Footing { planted: true, contact_ahead: 1.0, pivot_rad, ..Footing::default() };
        for _ in 0..(0.3 / dt_s).round() as usize {
            let locked = lock.step(&posed, &footing, &step);
            lock.record_drawn(sole_m.map(|point_m| locked.ankle_m + locked.twist * (point_m - posed.ankle_m)), &step);
        }
        let heading_m = lock.sole_m[1] - lock.sole_m[0];
        [libm::atan2f(heading_m.y, heading_m.x).to_degrees(), lock.sole_m[1].distance(sole_m[1])]
    }

    #[test]
    fn a_foot_pivots_on_its_ball_in_tight_turns_alone() {
        for dt_s in [1.0 / 120.0, 1.0 / 60.0, 1.0 / 30.0] {
            let [pivot_deg, moved_m] = pivot(-170.0, 0.005, dt_s);
            assert!((pivot_deg + 6.0).abs() < 0.1 && moved_m < 1e-4, "dt {dt_s}: {pivot_deg}°, {moved_m} m");
            assert!(pivot(80.0, 0.005, dt_s).iter().chain(&pivot(170.0, 0.0, dt_s)).all(|off| off.abs() < 1e-3));
        }
    }
}
