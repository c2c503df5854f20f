//! The foot on the ground: it rolls over heel, flat sole and toes; the point that bears weight never moves.
//!
//! Two cases, by the pitch of the sole (toes up positive):
//! - toes up: the foot turns about the heel point of the sole;
//! - heel up: the foot turns about the toe joint, the toe segment about the toes' tip. While the toes lie flat the toe
//!   joint rests, as the metatarsophalangeal joint does.
//!
//! Foot frame: x towards the toes, z up, origin on the ground under the ankle of the flat foot; metres.

use glam::{DVec2, DVec3};

use crate::body::skeleton::{ANKLE_HEIGHT_M, BALL_X_M, HEEL_X_M, TOE_JOINT_HEIGHT_M, TOE_TIP_X_M};
use crate::motion::footprint::Footprint;
use crate::plan::gait_plan::FootRoll;

/// Duration before toe-off in which the toes themselves roll, share of the stride.
const TOE_ROLL_SHARE: f64 = 0.09;

/// Position and angles of a foot, in the root frame (x forward, y left, z up).
#[derive(Clone, Copy, Debug)]
pub(crate) struct FootPlacement {
    /// Position of the ankle, m.
    pub(crate) ankle_m: DVec3,
    /// Direction of the toes against the root's heading, rad; positive to the left.
    pub(crate) yaw_rad: f64,
    /// Pitch of the sole, rad; positive with the toes up.
    pub(crate) pitch_rad: f64,
    /// Roll of the sole, rad; positive with the left side up, 0 on the ground.
    pub(crate) roll_rad: f64,
    /// Bend of the toes against the foot, rad; positive upward.
    pub(crate) toe_bend_rad: f64,
}

impl FootRoll {
    /// Pitch of the sole at a leg phase in stance, rad.
    fn pitch_rad(&self, p: f64, toe_off: f64) -> f64 {
        let landing = (1.0 - p / self.flat_from).max(0.0);
        let rising = ((p - self.heel_off) / (toe_off - self.heel_off)).max(0.0);
        self.strike_pitch_rad * landing * landing + self.toe_off_pitch_rad * libm::pow(rising, self.heel_rise_power)
    }

    /// Pitch of the toes against the ground, rad: that of the foot when the toes are up, their own when the heel is up.
    fn toe_pitch_rad(&self, p: f64, toe_off: f64) -> f64 {
        let pitch_rad = self.pitch_rad(p, toe_off);
        let rolling = (1.0 - (toe_off - p) / TOE_ROLL_SHARE).max(0.0);
        if pitch_rad < 0.0 { self.toe_off_toe_pitch_rad * rolling * rolling } else { pitch_rad }
    }

    /// Position of the ankle in the foot frame, m.
    fn ankle_m(&self, p: f64, toe_off: f64) -> DVec2 {
        rolled_ankle_m(self.pitch_rad(p, toe_off), self.toe_pitch_rad(p, toe_off))
    }

    /// Displacement of the ankle forward by the roll, m.
    pub(crate) fn advance_m(&self, p: f64, toe_off: f64) -> f64 {
        self.ankle_m(p, toe_off).x
    }

    /// The foot on its footprint at leg phase `p` in [0, toe-off].
    pub(crate) fn standing(&self, print: &Footprint, p: f64, toe_off: f64) -> FootPlacement {
        let ankle = self.ankle_m(p, toe_off);
        let (sin, cos) = libm::sincos(print.yaw_rad);
        let ground_m = print.ground_m + DVec2::new(cos, sin) * ankle.x;
        let pitch_rad = self.pitch_rad(p, toe_off);
        FootPlacement {
            ankle_m: ground_m.extend(ankle.y),
            yaw_rad: print.yaw_rad,
            pitch_rad,
            roll_rad: 0.0,
            toe_bend_rad: self.toe_pitch_rad(p, toe_off) - pitch_rad,
        }
    }
}

/// Position of the ankle in the foot frame, m; the two cases of the file's head.
fn rolled_ankle_m(pitch_rad: f64, toe_pitch_rad: f64) -> DVec2 {
    if pitch_rad >= 0.0 {
        let heel = DVec2::new(HEEL_X_M, 0.0);
        heel + turned(DVec2::new(-HEEL_X_M, ANKLE_HEIGHT_M), pitch_rad)
    } else {
        let tip = DVec2::new(TOE_TIP_X_M, 0.0);
        let toe_joint = tip + turned(DVec2::new(BALL_X_M - TOE_TIP_X_M, TOE_JOINT_HEIGHT_M), toe_pitch_rad);
        toe_joint + turned(DVec2::new(-BALL_X_M, ANKLE_HEIGHT_M - TOE_JOINT_HEIGHT_M), pitch_rad)
    }
}

impl FootPlacement {
    /// Heights of heel, ball and toe tip on the sole, m.
    pub(crate) fn sole_heights_m(&self) -> [f64; 3] {
        let under_ankle = |x: f64, z: f64| self.ankle_m.z + turned(DVec2::new(x, z), self.pitch_rad).y;
        let toe = DVec2::new(TOE_TIP_X_M - BALL_X_M, -TOE_JOINT_HEIGHT_M);
        let toe_joint = under_ankle(BALL_X_M, TOE_JOINT_HEIGHT_M - ANKLE_HEIGHT_M);
        [
            under_ankle(HEEL_X_M, -ANKLE_HEIGHT_M),
            under_ankle(BALL_X_M, -ANKLE_HEIGHT_M),
            toe_joint + turned(toe, self.pitch_rad + self.toe_bend_rad).y,
        ]
    }
}

/// A point turned by `pitch_rad`, toes up.
fn turned(point: DVec2, pitch_rad: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(pitch_rad);
    DVec2::new(cos, sin).rotate(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_sole_point_is_on_the_ground() {
        let degrees = |d: f64| d.to_radians();
        let roll = FootRoll {
            strike_pitch_rad: degrees(18.0),
            flat_from: 0.12,
            heel_off: 0.3,
            heel_rise_power: 2.8,
            toe_off_pitch_rad: degrees(-58.0),
            toe_off_toe_pitch_rad: degrees(-20.0),
        };
        let print = Footprint { ground_m: DVec2::ZERO, yaw_rad: 0.0 };
        for step in 0..=62 {
            let heights_m = roll.standing(&print, f64::from(step) / 100.0, 0.62).sole_heights_m();
            let lowest_m = heights_m.into_iter().fold(f64::INFINITY, f64::min);
            assert!(lowest_m.abs() < 1e-12, "{step} {heights_m:?}");
        }
    }
}
