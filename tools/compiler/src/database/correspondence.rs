//! Which cycle becomes m_sp (`FbCrowd` §5, which leaves it open). m_mb and the correspondence times T follow from it
//! ([`motiondb::motion::Correspondence`]).

use motiondb::motion::{Correspondence, MotionDb};
use motiondb::velocity_sets::velocity_hull::{HOLDING_TURN_MAX_RAD_S, TURNING_STRAFE_MAX_MPS};

use crate::ground::arc::Rates;

/// m_sp is the straight walk nearest this speed, at which people walk unhurried, m/s.
const SEMI_PROCEDURAL_MPS: f64 = 1.2;

/// m_sp among cycles that step: of the straight walks the one nearest 1.2 m/s, of all where none is straight.
pub(crate) fn semi_procedural(stepping: &[Rates]) -> Option<usize> {
    let bent = |found: &Rates| {
        found.turn_rate_rad_s.abs() > f64::from(HOLDING_TURN_MAX_RAD_S)
            || found.strafe_mps.abs() > f64::from(TURNING_STRAFE_MAX_MPS)
    };
    let off = |found: &Rates| (found.speed_mps - SEMI_PROCEDURAL_MPS).abs();
    (0..stepping.len()).min_by(|&a, &b| {
        let (a, b) = (&stepping[a], &stepping[b]);
        bent(a).cmp(&bent(b)).then(off(a).total_cmp(&off(b)))
    })
}

/// m_sp, m_mb and T; none with fewer than two cycles that step. `chosen` is m_sp where it need not be found.
pub fn find(db: &MotionDb, chosen: Option<usize>) -> Option<Correspondence> {
    let stepping: Vec<usize> =
        (0..db.examples.len()).filter(|&index| db.examples[index].key_times_s.is_some()).collect();
    let rates: Vec<Rates> = stepping.iter().map(|&index| rates(db, index)).collect();
    let sp = chosen.or_else(|| Some(stepping[semi_procedural(&rates)?]))?;
    Correspondence::of(db, sp)
}

fn rates(db: &MotionDb, example: usize) -> Rates {
    let found = db.examples[example].parameters;
    Rates {
        speed_mps: f64::from(found.speed_mps),
        turn_rate_rad_s: f64::from(found.turn_rate_rad_s),
        strafe_mps: f64::from(found.strafe_mps),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_straight_walk_nearest_its_speed_is_deformed() {
        let rates = |speed_mps, turn_rate_rad_s| Rates { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 };
        let (run, bend, walk) = (rates(3.0, 0.0), rates(1.2, 0.5), rates(1.0, 0.0));
        assert_eq!(semi_procedural(&[run, bend, walk]), Some(2));
        assert_eq!(semi_procedural(&[]), None);
    }
}
