//! Foot holding: a planted foot stays where it stands, rolls from heel over ball to toe, and is let go softly.
//!
//! Time-share weights hold planted feet while the shares rest; while they change, or where turning clips blend, the
//! pose's foot drifts. A foot's *hold* is the rigid motion (horizontal shift c, twist ψ about the vertical, lift) that
//! takes the pose's foot to the final one. While the foot is planted, c and ψ cancel the motion of the sole point that
//! is lowest now and the turning of the foot: the contact point rests, and the foot still rolls, since its pitch is
//! left to the pose. Off the ground c and ψ return to zero by a critically damped filter of the third order, which
//! starts at the speed they had: neither the foot's velocity nor its acceleration jumps at toe-off.
//!
//! World, metres and radians; z is the height over the ground, the same in world and root frame.

use glam::{Quat, Vec2, Vec3};

use crate::maths::angle::{direction, turned_rad, yaw};
use crate::maths::decay::soft_maximum;
use crate::synthesis::time_step::TimeStep;

/// Rate of the filter that lets a foot go, 1/s: of a hold, 2 % is left after 0.25 s, before the foot lands again.
pub(crate) const RELEASE_RATE_HZ: f32 = 30.0;
/// Rate of the filter by which a planted sole comes down to the ground and a swinging one rises to its clearance, 1/s.
pub(crate) const LIFT_RATE_HZ: f32 = 80.0;
/// Time constant, s, by which a foot comes to rest that lands while it still moves over the ground, as where the body
/// changes its speed: well within the tenth of a stance in which its sole rolls down. At once would jerk the knee.
pub(crate) const LANDING_TIME_S: f32 = 0.012;
/// Toe clearance of a swinging foot in walking, m (Winter 1992): blends with standing lower the swing, and would drag
/// the toes.
const CLEARANCE_M: f32 = 0.013;
/// A foot wants all of it from this speed on, m/s, and slower ones less: those that leave the ground begin slowly.
const CLEARANCE_SPEED_MPS: f32 = 1.0;
/// A foot that will land within this time wants none, s.
pub(crate) const LANDING_AHEAD_S: f32 = 0.06;
/// A foot this far above its clearance begins to be lifted, m, so that lifting has no edge.
const CLEARANCE_SOFTNESS_M: f32 = 0.002;
/// Time over which a foot's speed is averaged, s: it is constant between two rows of the database, and jumps at each.
pub(crate) const SPEED_TIME_S: f32 = 0.03;
/// Greatest shift of a foot against the pose's, m: that of a step broken off half-way; beyond it the foot slides.
const SHIFT_MAX_M: f32 = 0.35;
/// Greatest twist of a foot against the pose's: people twist the stance foot, and pivot on it beyond about 45°.
const TWIST_MAX_RAD: f32 = std::f32::consts::FRAC_PI_4;

/// A foot in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PosedFoot {
    /// The ankle.
    pub ankle_m: Vec3,
    /// Heel, ball and toe tip on the sole.
    pub sole_m: [Vec3; 3],
}

impl PosedFoot {
    /// From heel to ball on the ground.
    fn heading_m(&self) -> Vec2 {
        (self.sole_m[1] - self.sole_m[0]).truncate()
    }

    /// Index of the point that touches the ground, and its height.
    fn lowest(&self) -> (usize, f32) {
        let heights = self.sole_m.map(|point| point.z);
        (1..3).fold((0, heights[0]), |low, point| if heights[point] < low.1 { (point, heights[point]) } else { low })
    }
}

/// What takes the pose's foot to the final one, and what it needs to know of the step before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FootHold {
    planted: bool,
    /// The sole point that was lowest.
    lowest: usize,
    /// c, its rate and the rate of that, a second.
    shift_m: [Vec2; 3],
    /// ψ, likewise.
    twist_rad: [f32; 3],
    /// Speed over the ground that is left of landing.
    landing_mps: Vec2,
    /// Lift, likewise.
    lift_m: [f32; 3],
    /// Of the pose's foot in the step before.
    height_m: f32,
    heading_m: Vec2,
    sole_m: [Vec3; 3],
    speed_mps: f32,
}

/// Where the ankle shall be, in the world, and how far the foot is twisted about the vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldFoot {
    /// The ankle.
    pub ankle_m: Vec3,
    /// ψ.
    pub twist: Quat,
}

impl FootHold {
    /// A foot that stands as the pose has it.
    pub fn new(posed: &PosedFoot) -> Self {
        let (lowest, height_m) = posed.lowest();
        Self { lowest, height_m, heading_m: posed.heading_m(), sole_m: posed.sole_m, ..Self::default() }
    }

    /// Moves the hold by one step; `posed` is the foot of the blended pose, and `lands` its contact `LANDING_AHEAD_S`
    /// from now.
    pub fn step(&mut self, posed: &PosedFoot, planted: bool, lands: f32, step: &TimeStep) -> HeldFoot {
        let heading_m = posed.heading_m();
        let (lowest, height_m) = posed.lowest();
        // A foot lands where the pose has it now, somewhere within the step: only from then on it is held.
        if planted && self.planted {
            self.hold(posed, lowest, turned_rad(self.heading_m, heading_m), step);
        } else {
            self.release(step);
            self.land(posed, lowest, step);
        }
        (self.planted, self.lowest, self.heading_m) = (planted, lowest, heading_m);
        self.lift(height_m, lands, step);
        HeldFoot { ankle_m: posed.ankle_m + self.shift_m[0].extend(self.lift_m[0]), twist: yaw(self.twist_rad[0]) }
    }

    /// c of a planted foot.
    pub fn planted_shift_m(&self) -> Option<Vec2> {
        self.planted.then_some(self.shift_m[0])
    }

    /// The ball, in the world.
    pub fn ball_m(&self) -> Vec3 {
        self.sole_m[1]
    }

    /// On the ground.
    pub fn planted(&self) -> bool {
        self.planted
    }

    /// Takes note of the foot as the leg could place it.
    pub fn placed(&mut self, sole_m: [Vec3; 3], step: &TimeStep) {
        let speed_mps = (sole_m[1] - self.sole_m[1]).truncate().length() / step.dt_s;
        self.speed_mps += (1.0 - step.foot_speed) * (speed_mps - self.speed_mps);
        self.sole_m = sole_m;
    }

    /// Cancels the foot's turning, then the motion of its lowest point, which twists about the ankle.
    fn hold(&mut self, posed: &PosedFoot, lowest: usize, turned_rad: f32, step: &TimeStep) {
        let (before_m, before_rad) = (self.shift_m[0], self.twist_rad[0]);
        let twist_rad = (before_rad - turned_rad).clamp(-TWIST_MAX_RAD, TWIST_MAX_RAD);
        self.twist_rad = [twist_rad, (twist_rad - before_rad) / step.dt_s, 0.0];
        let [decay, _] = step.landing;
        let slipped_m = LANDING_TIME_S * (1.0 - decay) * self.landing_mps;
        self.landing_mps *= decay;
        let shift_m = (self.rests_m(lowest) + slipped_m - self.twisted_m(posed, lowest)).clamp_length_max(SHIFT_MAX_M);
        self.shift_m = [shift_m, (shift_m - before_m) / step.dt_s, Vec2::ZERO];
    }

    /// Notes how fast the foot moves, should it land: as much as is left of it where it landed half a step ago.
    fn land(&mut self, posed: &PosedFoot, lowest: usize, step: &TimeStep) {
        let moved_m = self.twisted_m(posed, lowest) + self.shift_m[0] - self.sole_m[lowest].truncate();
        self.landing_mps = step.landing[1] / step.dt_s * moved_m;
    }

    /// A point of the pose's sole, twisted about the ankle.
    fn twisted_m(&self, posed: &PosedFoot, point: usize) -> Vec2 {
        let (ankle_m, point_m) = (posed.ankle_m.truncate(), posed.sole_m[point].truncate());
        ankle_m + direction(self.twist_rad[0]).rotate(point_m - ankle_m)
    }

    /// Where a sole point that is lowest now came to rest. One that took over within the step did so while both touched
    /// the ground: it lies a sole's length from where the one before it rested.
    fn rests_m(&self, lowest: usize) -> Vec2 {
        let rested_m = self.sole_m[self.lowest];
        let along_m = self.sole_m[lowest] - rested_m;
        rested_m.truncate() + along_m.truncate().normalize_or_zero() * along_m.length()
    }

    /// Towards no shift and no twist.
    fn release(&mut self, step: &TimeStep) {
        self.shift_m = step.release.pass(self.shift_m);
        self.twist_rad = step.release.pass(self.twist_rad);
    }

    /// A planted sole settles on the ground, whatever the pose's height does, and a swinging one on the pose's height,
    /// or its clearance; none goes below the ground. What is off dies out likewise.
    fn lift(&mut self, height_m: f32, lands: f32, step: &TimeStep) {
        let [before_m, wanted_m] = [self.height_m, height_m].map(|height_m| self.wanted_lift_m(height_m, lands));
        let wanted_mps = (wanted_m - before_m) / step.dt_s;
        let [lifted_m, lifted_mps, lifted_mps2] = self.lift_m;
        let [off_m, _, off_mps2] = step.lift.pass([lifted_m - before_m, lifted_mps - wanted_mps, lifted_mps2]);
        let lift_m = (wanted_m + off_m).max(-height_m);
        self.lift_m = [lift_m, (lift_m - lifted_m) / step.dt_s, off_mps2];
        self.height_m = height_m;
    }

    fn wanted_lift_m(&self, height_m: f32, lands: f32) -> f32 {
        if self.planted {
            return -height_m;
        }
        let clearance_m = CLEARANCE_M * (1.0 - lands) * (self.speed_mps / CLEARANCE_SPEED_MPS).min(1.0);
        // A foot far above it wants none, and one far below is lifted by what it lacks.
        CLEARANCE_SOFTNESS_M * soft_maximum((clearance_m - height_m) / CLEARANCE_SOFTNESS_M)
    }
}
