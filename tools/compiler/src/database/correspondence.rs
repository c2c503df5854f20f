//! m_sp, m_mb and the correspondence times T of a database (`FbCrowd` §5 and App. 10).
//!
//! The paper leaves the choice of m_sp open: [`crate::select::base_walk`]. m_mb and T follow from m_sp
//! ([`motiondb::motion::Correspondence`]).

use motiondb::motion::{Correspondence, MotionDb};

use crate::ground::root_arc::Rates;
use crate::select::base_walk::base_walk;

/// The correspondence of a database; `None` with fewer than two examples that step.
///
/// `chosen` is the index of m_sp; without it the straight walk nearest 1.2 m/s is taken.
pub fn find_correspondence(db: &MotionDb, chosen: Option<usize>) -> Option<Correspondence> {
    let stepping: Vec<usize> =
        (0..db.examples.len()).filter(|&index| db.examples[index].key_times_s.is_some()).collect();
    let rates: Vec<Rates> = stepping.iter().map(|&index| rates(db, index)).collect();
    let sp = chosen.or_else(|| Some(stepping[base_walk(&rates)?]))?;
    Correspondence::of(db, sp)
}

fn rates(db: &MotionDb, example: usize) -> Rates {
    let parameters = db.examples[example].parameters;
    Rates {
        speed_mps: f64::from(parameters.speed_mps),
        turn_rate_rad_s: f64::from(parameters.turn_rate_rad_s),
        strafe_mps: f64::from(parameters.strafe_mps),
    }
}
