//! Time to collision of linearly moving discs (Karamouzas, Skinner, Guy 2014), with each other and with walls.
//!
//! World axes, metres and seconds. 0 where they overlap already, infinity where they never meet.

use glam::Vec2;

use crate::world::segment::nearest_on_segment;

/// Squared relative speed below which nothing approaches, (m/s)²: the limit of the authors' own code.
const SPEED_SQUARED_MIN: f32 = 1e-5;

/// When disc i meets disc j, s, given p_j − p_i, v_i − v_j and r_i + r_j. Has no branch, so that lanes vectorise.
#[inline]
pub(crate) fn disc_with_disc(offset_m: Vec2, relative_mps: Vec2, radius_m: f32) -> f32 {
    let gap = offset_m.length_squared() - radius_m * radius_m;
    let speed_squared = relative_mps.length_squared();
    let approach = relative_mps.dot(offset_m);
    let discriminant = discriminant(offset_m, relative_mps, radius_m);
    // (b − √D)/a, rearranged: the difference would cancel when the discs nearly touch.
    let time_s = gap / (approach + discriminant.sqrt());
    let meets = (approach > 0.0) & (discriminant > 0.0) & (speed_squared >= SPEED_SQUARED_MIN);
    let ahead_s = if meets { time_s } else { f32::INFINITY };
    if gap <= 0.0 { 0.0 } else { ahead_s }
}

/// D = b² − a c of the quadratic a t² − 2 b t + c = 0 for the time of contact, computed as r² v² − (v × p)². Near a
/// graze, where D is almost 0, b² and a c are a hundred times as great as these terms, and so is their rounding.
#[inline]
pub(crate) fn discriminant(offset_m: Vec2, relative_mps: Vec2, radius_m: f32) -> f32 {
    let miss = relative_mps.perp_dot(offset_m);
    radius_m * radius_m * relative_mps.length_squared() - miss * miss
}

/// When a disc meets a segment, s; `ends_m` are relative to the disc's centre.
///
/// The segment grown by the radius is a capsule: two discs and two straight sides.
pub(crate) fn disc_with_segment(ends_m: [Vec2; 2], velocity_mps: Vec2, radius_m: f32) -> f32 {
    let [from_m, to_m] = ends_m;
    if nearest_on_segment(Vec2::ZERO, from_m, to_m).length() <= radius_m {
        return 0.0;
    }
    let [at_from_s, at_to_s] = ends_m.map(|end_m| disc_with_disc(end_m, velocity_mps, radius_m));
    disc_with_side(ends_m, velocity_mps, radius_m).min(at_from_s).min(at_to_s)
}

/// When a disc meets the straight side of the capsule that faces it, s; infinite beyond the side's ends.
pub(crate) fn disc_with_side(ends_m: [Vec2; 2], velocity_mps: Vec2, radius_m: f32) -> f32 {
    let along = ends_m[1] - ends_m[0];
    let length_m = along.length();
    let normal = along.perp() / length_m;
    // Signed towards the wall's line, so both sides of a wall count alike.
    let towards = ends_m[0].dot(normal);
    let approach = velocity_mps.dot(normal) * towards.signum();
    if length_m <= 0.0 || approach <= 0.0 {
        return f32::INFINITY;
    }
    let time_s = (towards.abs() - radius_m) / approach;
    let share = (velocity_mps * time_s - ends_m[0]).dot(along) / (length_m * length_m);
    if time_s >= 0.0 && (0.0..=1.0).contains(&share) { time_s } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The first of many small steps at which a gap is closed, s.
    fn by_marching(velocity_mps: Vec2, gap_m: impl Fn(Vec2) -> f32) -> f32 {
        let times_s = (0..8000).map(|step| step as f32 * 1e-3);
        times_s.into_iter().find(|&time_s| gap_m(velocity_mps * time_s) <= 0.0).unwrap_or(f32::INFINITY)
    }

    fn check(exact_s: f32, marched_s: f32, closest_m: f32) {
        // A graze of less than a millimetre may fall on either side.
        let agree = (exact_s - marched_s).abs() < 4e-3 || (exact_s > 7.9 && marched_s.is_infinite());
        assert!(agree || closest_m.abs() < 1e-3, "{exact_s} {marched_s} {closest_m}");
    }

    fn closest_m(velocity_mps: Vec2, gap_m: impl Fn(Vec2) -> f32) -> f32 {
        (0..8000).map(|step| gap_m(velocity_mps * (step as f32 * 1e-3))).fold(f32::INFINITY, f32::min)
    }

    fn vector(bound: f32) -> impl Strategy<Value = Vec2> {
        (-bound..bound, -bound..bound).prop_map(Vec2::from)
    }

    proptest! {
        #[test]
        fn discs_meet_when_small_steps_show_it(offset in vector(5.0), velocity in vector(2.0), radius in 0.1f32..1.0) {
            let gap = |moved: Vec2| (offset - moved).length() - radius;
            check(disc_with_disc(offset, velocity, radius), by_marching(velocity, gap), closest_m(velocity, gap));
        }

        #[test]
        fn time_to_wall_agrees_with_small_steps(
            first in vector(4.0), second in vector(4.0), velocity in vector(2.0), radius in 0.1f32..1.0,
        ) {
            prop_assume!(first.distance(second) > 0.05);
            let gap = |moved: Vec2| nearest_on_segment(moved, first, second).distance(moved) - radius;
            let exact = disc_with_segment([first, second], velocity, radius);
            check(exact, by_marching(velocity, gap), closest_m(velocity, gap));
        }
    }
}
