//! The stance foot's half-plane: the swing foot must not land beyond the foot that carries the body (`FbCrowd` §4.2,
//! Eq. 6).
//!
//! The printed construction cannot hold (`paper/fbcrowd.md`, §4.2, **Erratum** and **Open**). What is limited here is
//! where the swing foot *lands*: until then it moves with the root, so v·n_b ≤ clearance / time to landing, where n_b
//! points outward, away from the swing side, and the clearance is the swing foot's distance from the stance foot's
//! line. n_b is first turned by the twist that the stance foot allows in place. World axes, metres, seconds.

use glam::Vec2;

use super::half_plane::{HalfPlane, Source};
use crate::plan::{Stance, StanceFoot};

/// A landing is never nearer than this, s; below it the bound says nothing that a body could still follow.
const TIME_TO_LANDING_MIN_S: f32 = 0.02;

/// C_bm; none while not exactly one foot carries the body.
pub fn half_plane(stance: &Stance, twist_rad: f32) -> Option<HalfPlane> {
    let foot = stance.foot?;
    let outward = outward(&foot)?;
    let clearance_m = (foot.ball_m - foot.swing_m).dot(outward).max(0.0);
    let speed_mps = clearance_m / foot.time_to_landing_s.max(TIME_TO_LANDING_MIN_S);
    let (sin, cos) = libm::sincosf(twist_rad * left_sign(&foot));
    let twisted = Vec2::new(cos, sin).rotate(outward);
    Some(HalfPlane::behind(speed_mps * twisted, twisted, Source::Stance))
}

/// n_b before the twist: left of a left foot, right of a right one; none for a foot without length.
fn outward(foot: &StanceFoot) -> Option<Vec2> {
    let along = (foot.toe_m - foot.heel_m).try_normalize()?;
    Some(left_sign(foot) * along.perp())
}

/// +1 for the left foot, −1 for the right one.
fn left_sign(foot: &StanceFoot) -> f32 {
    if foot.side == 0 { 1.0 } else { -1.0 }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A walker along +x on the left foot, swing foot passing.
    pub(in crate::mcn) fn on_left_foot() -> StanceFoot {
        StanceFoot {
            side: 0,
            heel_m: Vec2::new(-0.1, 0.06),
            ball_m: Vec2::new(0.05, 0.06),
            toe_m: Vec2::new(0.12, 0.06),
            swing_m: Vec2::new(0.0, -0.09),
            time_to_landing_s: 0.3,
        }
    }

    fn mirrored(foot: &StanceFoot) -> StanceFoot {
        let across = Vec2::new(1.0, -1.0);
        StanceFoot {
            side: 1 - foot.side,
            heel_m: foot.heel_m * across,
            ball_m: foot.ball_m * across,
            toe_m: foot.toe_m * across,
            swing_m: foot.swing_m * across,
            ..*foot
        }
    }

    fn check(foot: &StanceFoot, twist_rad: f32, velocity_mps: Vec2, permitted: bool) {
        for (foot, velocity_mps) in [(*foot, velocity_mps), (mirrored(foot), velocity_mps * Vec2::new(1.0, -1.0))] {
            let half_plane = half_plane(&Stance { foot: Some(foot) }, twist_rad).unwrap();
            assert_eq!(half_plane.violation_mps(velocity_mps) <= 1e-6, permitted, "{foot:?} {velocity_mps}");
        }
    }

    #[test]
    fn lets_the_normal_step_and_the_open_side_pass_on_both_feet() {
        for twist_rad in [0.0, 0.35] {
            check(&on_left_foot(), twist_rad, Vec2::new(1.4, 0.0), true);
            check(&on_left_foot(), twist_rad, Vec2::new(0.5, -1.5), true);
            check(&on_left_foot(), twist_rad, Vec2::ZERO, true);
        }
    }

    #[test]
    fn forbids_landing_beyond_the_stance_foot() {
        // 15 cm in 0.3 s.
        check(&on_left_foot(), 0.0, Vec2::new(1.0, 0.49), true);
        check(&on_left_foot(), 0.0, Vec2::new(1.0, 0.51), false);
        let late = StanceFoot { time_to_landing_s: 0.1, ..on_left_foot() };
        check(&late, 0.0, Vec2::new(1.0, 1.4), true);
    }

    #[test]
    fn the_twist_allows_more_to_a_walker_and_nothing_to_a_side_step() {
        check(&on_left_foot(), 0.35, Vec2::new(1.4, 0.8), true);
        check(&on_left_foot(), 0.35, Vec2::new(0.0, 0.6), false);
    }

    #[test]
    fn two_feet_or_none_limit_nothing() {
        assert!(half_plane(&Stance::default(), 0.3).is_none());
    }
}
