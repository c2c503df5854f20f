//! The base walk m_sp: the one example that semi-procedural locomotion deforms (`FbCrowd` §5, which leaves the choice
//! open; definition "m_sp" of `docs/definitions.md`).

use motiondb::velocity_sets::velocity_hull::{HOLDING_TURN_MAX_RAD_S, TURNING_STRAFE_MAX_MPS};

use crate::ground::root_arc::Rates;

/// Speed of an unhurried human walk, m/s; m_sp is the straight walk nearest to it.
const BASE_WALK_MPS: f64 = 1.2;

/// Index of m_sp among cycles that step: the straight walk nearest 1.2 m/s, the nearest of all where none is straight.
pub(crate) fn base_walk(stepping: &[Rates]) -> Option<usize> {
    let is_bent = |rates: &Rates| {
        rates.turn_rate_rad_s.abs() > f64::from(HOLDING_TURN_MAX_RAD_S)
            || rates.strafe_mps.abs() > f64::from(TURNING_STRAFE_MAX_MPS)
    };
    let distance_mps = |rates: &Rates| (rates.speed_mps - BASE_WALK_MPS).abs();
    (0..stepping.len()).min_by(|&a, &b| {
        let (a, b) = (&stepping[a], &stepping[b]);
        is_bent(a).cmp(&is_bent(b)).then(distance_mps(a).total_cmp(&distance_mps(b)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base_walk_is_nearest_straight_walk() {
        let rates = |speed_mps, turn_rate_rad_s| Rates { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 };
        let (run, bend, walk) = (rates(3.0, 0.0), rates(1.2, 0.5), rates(1.0, 0.0));
        assert_eq!(base_walk(&[run, bend, walk]), Some(2));
        assert_eq!(base_walk(&[]), None);
    }
}
