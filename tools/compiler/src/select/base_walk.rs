//! The base walk m_sp: the one example that semi-procedural locomotion deforms (`FbCrowd` §5, which leaves the choice
//! open; definition "m_sp" of `docs/definitions.md`).

use motiondb::velocity_sets::velocity_hull::goes_straight;

use crate::ground::root_arc::Rates;

/// Speed of an unhurried human walk, m/s; m_sp is the straight walk nearest to it.
const BASE_WALK_MPS: f64 = 1.2;

/// Speed that makes a walk as unlike m_sp as a turn rate does, divided by that rate, m.
const TURN_RADIUS_M: f64 = 1.0;

/// A cycle that steps, as far as it matters for the choice of m_sp.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaseWalkCandidate {
    /// Rates of its root.
    pub(crate) rates: Rates,
    /// The body is upright.
    pub(crate) is_upright: bool,
    /// Feet or frame time deserve a warning.
    pub(crate) is_doubtful: bool,
    /// The body runs.
    pub(crate) is_run: bool,
    /// Its posture penalty, m/s ([`crate::select::posture_penalty`]).
    pub(crate) posture_penalty_mps: f64,
}

/// Index of m_sp among cycles that step. Each criterion counts only where a cycle meets it:
/// 1. upright;
/// 2. straight;
/// 3. clean feet, at a frame time without doubt;
/// 4. no run;
/// 5. least difference from 1.2 m/s, plus the posture penalty. Where none is straight, the rates of the root are to be
///    nearest to those of a straight walk: a body leans in a circle, and turns its head.
pub(crate) fn base_walk(stepping: &[BaseWalkCandidate]) -> Option<usize> {
    let faults = |walk: &BaseWalkCandidate| {
        [!walk.is_upright, !goes_straight(&walk.rates.to_parameters()), walk.is_doubtful, walk.is_run]
    };
    let distance = |walk: &BaseWalkCandidate| {
        let Rates { speed_mps, turn_rate_rad_s, strafe_mps } = walk.rates;
        let off_mps = speed_mps - BASE_WALK_MPS;
        if goes_straight(&walk.rates.to_parameters()) {
            return off_mps.abs() + walk.posture_penalty_mps;
        }
        let turn_mps = TURN_RADIUS_M * turn_rate_rad_s;
        libm::sqrt(off_mps * off_mps + turn_mps * turn_mps + strafe_mps * strafe_mps) + walk.posture_penalty_mps
    };
    (0..stepping.len()).min_by(|&a, &b| {
        let (a, b) = (&stepping[a], &stepping[b]);
        faults(a).cmp(&faults(b)).then(distance(a).total_cmp(&distance(b)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(speed_mps: f64, turn_rate_rad_s: f64) -> BaseWalkCandidate {
        let rates = Rates { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 };
        BaseWalkCandidate { rates, is_upright: true, is_doubtful: false, is_run: false, posture_penalty_mps: 0.0 }
    }

    #[test]
    fn base_walk_is_nearest_straight_walk() {
        assert_eq!(base_walk(&[candidate(3.0, 0.0), candidate(1.2, 0.5), candidate(1.0, 0.0)]), Some(2));
        assert_eq!(base_walk(&[]), None);
    }

    #[test]
    fn of_circles_the_widest_is_the_base_walk() {
        assert_eq!(base_walk(&[candidate(1.2, 2.2), candidate(1.6, 0.25), candidate(1.3, -1.5)]), Some(1));
    }

    #[test]
    fn upright_walks_with_clean_feet_are_preferred() {
        let (run, walk) = (candidate(3.0, 0.0), candidate(1.2, 0.0));
        let crawl = BaseWalkCandidate { is_upright: false, ..walk };
        let sliding = BaseWalkCandidate { is_doubtful: true, ..walk };
        assert_eq!(base_walk(&[crawl, run]), Some(1));
        assert_eq!(base_walk(&[sliding, run]), Some(1));
        assert_eq!(base_walk(&[crawl, sliding]), Some(1));
        assert_eq!(base_walk(&[crawl]), Some(0));
    }

    #[test]
    fn bent_walks_and_runs_give_way() {
        let (stroll, walk) = (candidate(0.7, 0.0), candidate(1.2, 0.0));
        let slow_jog = BaseWalkCandidate { is_run: true, ..walk };
        assert_eq!(base_walk(&[slow_jog, stroll]), Some(1));
        let stalk = BaseWalkCandidate { posture_penalty_mps: 0.6, ..walk };
        assert_eq!(base_walk(&[stalk, stroll]), Some(1));
        assert_eq!(base_walk(&[stalk, stroll, walk]), Some(2));
        assert_eq!(base_walk(&[candidate(0.3, 0.0), stalk]), Some(1));
    }
}
