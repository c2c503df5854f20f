//! Shoulders in a gap: how far they are turned from the direction of travel where a body passes.
//!
//! Pedestrians turn their shoulders in apertures narrower than 1.3 times their breadth (Warren and Whang 1987, *J. Exp.
//! Psychol.: Hum. Percept. Perform.* 13, 371–383). Degrees, metres.

use glam::Vec2;

use crate::maths::angle::wrap_rad;
use crate::measures::people::body_track::BodyTrack;

/// Distance of the root from the line through the gap within which the shoulders count, m.
const NEAR_M: f32 = 0.15;

/// Greatest angle between the direction in which the shoulders face and a crossing of the gap, degrees, while the root
/// is within 15 cm of the segment between the two ends of the gap; none of a body that does not pass.
pub fn shoulder_turn_deg(track: &BodyTrack, ends_m: [Vec2; 2]) -> Option<f64> {
    let along_m = ends_m[1] - ends_m[0];
    let across = along_m.perp().normalize_or_zero();
    let inside =
        |position_m: Vec2| (0.0..=1.0).contains(&((position_m - ends_m[0]).dot(along_m) / along_m.length_squared()));
    let beyond_m = |position_m: Vec2| (position_m - ends_m[0]).dot(across);
    let crossing = track.samples.windows(2).find(|pair| {
        let [before_m, after_m] = [pair[0].root_m, pair[1].root_m];
        (beyond_m(before_m) < 0.0) != (beyond_m(after_m) < 0.0) && inside(after_m)
    })?;
    let forward = if beyond_m(crossing[1].root_m) >= 0.0 { across } else { -across };
    let travel_rad = libm::atan2f(forward.y, forward.x);
    let near = |position_m: Vec2| inside(position_m) && beyond_m(position_m).abs() < NEAR_M;
    let turns_rad = track.samples.iter().filter(|sample| near(sample.root_m));
    let turn_rad = turns_rad.map(|sample| wrap_rad(sample.shoulders_rad - travel_rad).abs()).reduce(f32::max)?;
    Some(f64::from(turn_rad).to_degrees())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    #[test]
    fn the_turn_in_the_gap_counts_alone() {
        // Along y through a gap at y = 1; the shoulders turn by 0.5 rad within 10 cm of it, by 1 rad a metre before.
        let walk = track(3.0, |time_s, sample| {
            sample.root_m = Vec2::new(0.0, time_s as f32);
            let turned_rad = if (sample.root_m.y - 1.0).abs() < 0.1 { 0.5 } else { f32::from(u8::from(time_s < 0.3)) };
            sample.shoulders_rad = std::f32::consts::FRAC_PI_2 + turned_rad;
        });
        let gap_m = [Vec2::new(-0.3, 1.0), Vec2::new(0.3, 1.0)];
        let found = shoulder_turn_deg(&walk, gap_m).unwrap();
        assert!((found - 0.5_f64.to_degrees()).abs() < 1e-3, "{found}");
        assert_eq!(shoulder_turn_deg(&walk, [Vec2::new(1.0, 1.0), Vec2::new(2.0, 1.0)]), None);
        let backward = [gap_m[1], gap_m[0]];
        assert_eq!(shoulder_turn_deg(&walk, backward), Some(found));
    }
}
