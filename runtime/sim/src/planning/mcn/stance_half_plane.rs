//! C_bm, the half-plane of the stance foot: the swing foot must not land beyond the foot that carries the body
//! (`FbCrowd` §4.2, Eq. 6).
//!
//! The printed construction cannot hold: Eqs. 7 and 8 put the stance foot's line outside the disc by a factor k = 1,
//! but the foot is under the body, and where it is ahead any k brakes the walk. Here the constraint is on the position
//! where the swing foot *lands*. Until then the foot moves with the root, so v·n_b ≤ clearance / time to landing. n_b
//! points outward, away from the swing side; the clearance is the swing foot's distance from the stance foot's line.
//! n_b is first turned by the twist that the stance foot allows in place. The paper's radial form (Eqs. 7, 8) stays for
//! comparison. World axes, metres, seconds; points relative to the root.

use glam::Vec2;

use crate::planning::orca::half_plane::{HalfPlane, HalfPlaneSource};
use crate::planning::plan::{Stance, StanceFoot};
use crate::world::segment::nearest_on_segment;

/// Least time to landing, s: below it a body cannot follow the bound any more.
pub const TIME_TO_LANDING_MIN_S: f32 = 0.02;

/// Halvings that find k: to a ten-thousandth of its range.
const RADIAL_HALVINGS: u32 = 14;

/// C_bm; none unless exactly one foot carries the body. `twist_rad` is the greatest twist of that foot.
pub fn stance_half_plane(stance: &Stance, twist_rad: f32) -> Option<HalfPlane> {
    let foot = stance.foot?;
    let (sin, cos) = libm::sincosf(twist_rad * left_sign(&foot));
    let outward = Vec2::new(cos, sin).rotate(outward(&foot)?);
    let clearance_m = (foot.ball_m - foot.swing_m).dot(outward).max(0.0);
    let speed_mps = clearance_m / foot.time_to_landing_s.max(TIME_TO_LANDING_MIN_S);
    Some(HalfPlane::behind(speed_mps * outward, outward, HalfPlaneSource::Stance)) // Eq. 6
}

/// Eqs. 7, 8: the segment from k·St_h to k·St_h + St_o, with the least k for which it lies outside the disc; relative
/// to the disc's centre, m.
pub(crate) fn radial_segment_m(stance: &Stance, radius_m: f32) -> Option<[Vec2; 2]> {
    let foot = stance.foot?;
    let along_m = foot.toe_m - foot.heel_m; // St_o
    let segment_m = |scale: f32| [scale * foot.heel_m, scale * foot.heel_m + along_m]; // Eqs. 7, 8
    // The segment's distance from the centre is a convex function of k that begins at 0, so it grows.
    let (mut inside, mut outside) = (0.0, (radius_m + along_m.length()) / foot.heel_m.length());
    if !f32::is_finite(outside) {
        return None;
    }
    for _ in 0..RADIAL_HALVINGS {
        let middle = 0.5 * (inside + outside);
        let [from_m, to_m] = segment_m(middle);
        let clear = nearest_on_segment(Vec2::ZERO, from_m, to_m).length() > radius_m;
        *(if clear { &mut outside } else { &mut inside }) = middle;
    }
    Some(segment_m(outside))
}

/// n_b before the twist: to the left of a left foot, to the right of a right one; none for a foot without length.
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

    /// An agent that walks along +x on its left foot, the swing foot passing.
    pub(in crate::planning::mcn) fn on_left_foot() -> StanceFoot {
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
            let half_plane = stance_half_plane(&Stance { foot: Some(foot) }, twist_rad).unwrap();
            assert_eq!(half_plane.violation_mps(velocity_mps) <= 1e-6, permitted, "{foot:?} {velocity_mps}");
        }
    }

    #[test]
    fn permits_the_normal_step_and_the_open_side() {
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
    fn the_twist_permits_more_ahead_but_no_side_step() {
        check(&on_left_foot(), 0.35, Vec2::new(1.4, 0.8), true);
        check(&on_left_foot(), 0.35, Vec2::new(0.0, 0.6), false);
    }

    #[test]
    fn the_radial_segment_lies_just_outside_the_disc() {
        for heel_x in [-0.3, -0.1, 0.0, 0.2] {
            let mut foot = on_left_foot();
            let shift_m = Vec2::new(heel_x - foot.heel_m.x, 0.0);
            (foot.heel_m, foot.toe_m) = (foot.heel_m + shift_m, foot.toe_m + shift_m);
            let [from_m, to_m] = radial_segment_m(&Stance { foot: Some(foot) }, 0.25).unwrap();
            let distance_m = nearest_on_segment(Vec2::ZERO, from_m, to_m).length();
            assert!((0.25..0.251).contains(&distance_m), "{distance_m}");
            assert!((to_m - from_m).distance(foot.toe_m - foot.heel_m) < 1e-5);
            assert!(from_m.perp_dot(foot.heel_m).abs() < 1e-5);
        }
        assert!(radial_segment_m(&Stance::default(), 0.25).is_none());
    }

    #[test]
    fn two_feet_or_none_give_no_half_plane() {
        assert!(stance_half_plane(&Stance::default(), 0.3).is_none());
    }
}
