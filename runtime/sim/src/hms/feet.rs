//! Foot holding: a planted foot stays where it stands, rolls from heel over ball to toe, and is let go softly.
//!
//! Time-share weights hold planted feet while the shares rest; while they change, or where turning clips blend, the
//! pose's foot drifts. A foot's *hold* is the rigid motion (horizontal shift c, twist ψ about the vertical, lift) that
//! takes the pose's foot to the final one. While the foot is planted, c and ψ cancel the motion of the sole point that
//! is lowest now and the turning of the foot: the contact point rests, and the foot still rolls, since its pitch is
//! left to the pose. Off the ground c and ψ return to zero like a critically damped spring that starts at the speed
//! they had, so the foot's velocity does not jump at toe-off.
//!
//! World, metres and radians; z is the height over the ground, the same in world and root frame.

use glam::{Quat, Vec2, Vec3};

use crate::angle::wrap_rad;

/// Rate of the spring that lets a foot go, 1/s: of a hold, 4 % is left after 0.25 s, before the foot lands again.
const RELEASE_RATE_HZ: f32 = 20.0;
/// Rate at which a planted sole comes down to the ground and a lifted one gives up its lift, 1/s.
const LIFT_RATE_HZ: f32 = 20.0;
/// Toe clearance of a swinging foot (`motion.md` §5): blends with standing lower the swing, and would drag the toes …
const CLEARANCE_M: f32 = 0.013;
/// … in full from this speed, m/s; a foot that leaves or lands moves slowly.
const CLEARANCE_SPEED_MPS: f32 = 1.0;
/// Greatest shift: the leg of a step that is broken off half-way; beyond it the foot slides, metres.
const SHIFT_MAX_M: f32 = 0.35;
/// Greatest twist of a foot against the pose's: people twist the stance foot, and pivot on it beyond about 45°
/// (`motion.md` §2).
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
    /// Direction from heel to ball on the ground.
    fn heading_rad(&self) -> f32 {
        let along = self.sole_m[1] - self.sole_m[0];
        libm::atan2f(along.y, along.x)
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
    /// c.
    shift_m: Vec2,
    shift_mps: Vec2,
    /// ψ.
    twist_rad: f32,
    twist_rad_s: f32,
    lift_m: f32,
    heading_rad: f32,
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
        Self { heading_rad: posed.heading_rad(), sole_m: posed.sole_m, ..Self::default() }
    }

    /// Moves the hold by one step; `posed` is the foot of the blended pose.
    pub fn step(&mut self, posed: &PosedFoot, planted: bool, dt_s: f32) -> HeldFoot {
        let heading_rad = posed.heading_rad();
        let (lowest, height_m) = posed.lowest();
        self.planted = planted;
        if planted {
            self.hold(posed, lowest, wrap_rad(heading_rad - self.heading_rad), dt_s);
        } else {
            self.release(dt_s);
        }
        self.heading_rad = heading_rad;
        self.lift(height_m, planted, dt_s);
        HeldFoot {
            ankle_m: posed.ankle_m + self.shift_m.extend(self.lift_m),
            twist: Quat::from_rotation_z(self.twist_rad),
        }
    }

    /// c of a planted foot.
    pub fn planted_shift_m(&self) -> Option<Vec2> {
        self.planted.then_some(self.shift_m)
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
    pub fn placed(&mut self, sole_m: [Vec3; 3], dt_s: f32) {
        self.speed_mps = (sole_m[1] - self.sole_m[1]).truncate().length() / dt_s;
        self.sole_m = sole_m;
    }

    /// Cancels the foot's turning, then the motion of its lowest point, which twists about the ankle.
    fn hold(&mut self, posed: &PosedFoot, lowest: usize, turned_rad: f32, dt_s: f32) {
        let before = (self.shift_m, self.twist_rad);
        self.twist_rad = (self.twist_rad - turned_rad).clamp(-TWIST_MAX_RAD, TWIST_MAX_RAD);
        let (ankle_m, point_m) = (posed.ankle_m.truncate(), posed.sole_m[lowest].truncate());
        let unshifted_m = ankle_m + Vec2::from_angle(self.twist_rad).rotate(point_m - ankle_m);
        self.shift_m = (self.sole_m[lowest].truncate() - unshifted_m).clamp_length_max(SHIFT_MAX_M);
        self.shift_mps = (self.shift_m - before.0) / dt_s;
        self.twist_rad_s = (self.twist_rad - before.1) / dt_s;
    }

    /// The critically damped spring, exactly over a step.
    fn release(&mut self, dt_s: f32) {
        let decay = libm::expf(-RELEASE_RATE_HZ * dt_s);
        let pull_mps = self.shift_mps + RELEASE_RATE_HZ * self.shift_m;
        self.shift_m = decay * (self.shift_m + dt_s * pull_mps);
        self.shift_mps = decay * (self.shift_mps - RELEASE_RATE_HZ * dt_s * pull_mps);
        let pull_rad_s = self.twist_rad_s + RELEASE_RATE_HZ * self.twist_rad;
        self.twist_rad = decay * (self.twist_rad + dt_s * pull_rad_s);
        self.twist_rad_s = decay * (self.twist_rad_s - RELEASE_RATE_HZ * dt_s * pull_rad_s);
    }

    /// A planted sole settles on the ground, a swinging one on the pose's height; none goes below the ground or drags
    /// along it.
    fn lift(&mut self, height_m: f32, planted: bool, dt_s: f32) {
        let decay = libm::expf(-LIFT_RATE_HZ * dt_s);
        let gap_m = self.sole_m.iter().fold(f32::INFINITY, |low, point| low.min(point.z));
        let wanted_m = if planted { decay * gap_m - height_m } else { decay * self.lift_m };
        let clearance_m = if planted { 0.0 } else { CLEARANCE_M * (self.speed_mps / CLEARANCE_SPEED_MPS).min(1.0) };
        self.lift_m = wanted_m.max(clearance_m - height_m);
    }
}
