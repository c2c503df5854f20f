//! Correspondence times T between m_sp and m_mb (`FbCrowd` §5, Eq. 10): where the two cycles' poses are most alike.
//!
//! Poses are compared by joint places and velocities in the root frame, at all pairs of stored phases. The pairs of T
//! are the local minima of that distance below a threshold, thinned to be monotone in both cycles, with at least one in
//! each step of m_sp.

use glam::DVec3;
use motiondb::correspondence::{Correspondence, VELOCITY_WEIGHT_S};
use motiondb::motion_db::{MotionExample, PHASE_COUNT};
use motiondb::velocity_hull::{HOLDING_TURN_MAX_RAD_S, TURNING_STRAFE_MAX_MPS};

use crate::arc::Rates;
use crate::cycle::GaitCycle;
use crate::human_clip::HumanBody;

/// m_sp is the straight walk nearest this speed (`definitions.md`), m/s.
const SEMI_PROCEDURAL_MPS: f64 = 1.2;
/// A minimum counts up to this multiple of the least distance of all.
const THRESHOLD_RATIO: f64 = 1.5;
/// Cycles share their phases; poses further apart than this share of a cycle are alike by accident (left for right).
const PHASE_OFFSET_MAX: isize = PHASE_COUNT as isize / 8;

/// m_sp among cycles that step: of the straight walks the one nearest 1.2 m/s, of all where none is straight.
pub fn semi_procedural(stepping: &[Rates]) -> Option<usize> {
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

/// m_sp, m_mb and T; none with fewer than two cycles that step. `axis_ranges` are the blend space's; `chosen` is m_sp
/// where it need not be found.
pub fn build(
    examples: &[MotionExample],
    cycles: &[GaitCycle],
    body: &HumanBody,
    axis_ranges: [f32; 3],
    chosen: Option<usize>,
) -> Option<Correspondence> {
    let stepping: Vec<usize> = (0..examples.len()).filter(|index| cycles[*index].steps).collect();
    let rates: Vec<Rates> = stepping.iter().map(|&index| cycles[index].rates).collect();
    let sp = chosen.or_else(|| Some(stepping[semi_procedural(&rates)?]))?;
    let distance = |example: &MotionExample| {
        let off = (example.parameters.to_vec3() - examples[sp].parameters.to_vec3()).to_array();
        let scaled = off.iter().zip(axis_ranges).map(|(off, range)| if range > 0.0 { off / range } else { 0.0 });
        scaled.map(|off| off * off).sum::<f32>()
    };
    let others = stepping.iter().copied().filter(|index| *index != sp);
    let mb = others.min_by(|&a, &b| distance(&examples[a]).total_cmp(&distance(&examples[b])))?;
    let pairs = thin(minima(&Features::of(&cycles[sp], body), &Features::of(&cycles[mb], body)));
    let time_s = |example: usize, row: usize| cycles[example].row_time_s(row as isize) as f32;
    let pairs_s = pairs.iter().map(|pair| [time_s(sp, pair.sp), time_s(mb, pair.mb_row())]).collect();
    Some(Correspondence { semi_procedural: sp as u32, blending: mb as u32, pairs_s })
}

/// Joint places and weighted velocities of each row, metres.
struct Features {
    rows: Vec<Vec<DVec3>>,
}

impl Features {
    fn of(cycle: &GaitCycle, body: &HumanBody) -> Self {
        let places: Vec<_> = cycle.rows.iter().map(|row| row.forward_kinematics(body).positions_m).collect();
        let row = |row: isize| {
            let (before, after) = (&places[GaitCycle::wrap(row - 1)], &places[GaitCycle::wrap(row + 1)]);
            let weight = VELOCITY_WEIGHT_S / (cycle.row_time_s(row + 1) - cycle.row_time_s(row - 1));
            let velocities = after.iter().zip(before).map(|(after, before)| (*after - *before) * weight);
            places[GaitCycle::wrap(row)].iter().copied().chain(velocities).collect()
        };
        Self { rows: (0..PHASE_COUNT as isize).map(row).collect() }
    }

    fn distance(&self, row: usize, other: &Self, other_row: usize) -> f64 {
        self.rows[row].iter().zip(&other.rows[other_row]).map(|(a, b)| a.distance_squared(*b)).sum()
    }
}

/// A pair of rows, m_mb's counted from m_sp's so that both run on over phase 0.
#[derive(Clone, Copy, Debug)]
struct Pair {
    sp: usize,
    offset: isize,
    distance: f64,
}

impl Pair {
    fn mb_row(&self) -> usize {
        GaitCycle::wrap(self.sp as isize + self.offset)
    }
}

/// Local minima of the distance below the threshold, and the best pair of a step that has none; in order of m_sp.
fn minima(sp: &Features, mb: &Features) -> Vec<Pair> {
    let distance = |row: isize, offset: isize| sp.distance(GaitCycle::wrap(row), mb, GaitCycle::wrap(row + offset));
    let candidate = |row: usize| {
        let offsets = -PHASE_OFFSET_MAX..=PHASE_OFFSET_MAX;
        let pairs = offsets.map(|offset| Pair { sp: row, offset, distance: distance(row as isize, offset) });
        pairs.min_by(|a, b| a.distance.total_cmp(&b.distance)).expect("the range of offsets is not empty")
    };
    let nearest: Vec<Pair> = (0..PHASE_COUNT).map(candidate).collect();
    let best = |rows: std::ops::Range<usize>| {
        nearest[rows].iter().copied().min_by(|a, b| a.distance.total_cmp(&b.distance)).expect("a step has rows")
    };
    let threshold = THRESHOLD_RATIO * best(0..PHASE_COUNT).distance;
    let lowest_around = |pair: &Pair| {
        let around = |row: isize| nearest[GaitCycle::wrap(row)].distance;
        pair.distance <= around(pair.sp as isize - 1) && pair.distance < around(pair.sp as isize + 1)
    };
    let mut found: Vec<Pair> =
        nearest.iter().copied().filter(|pair| pair.distance <= threshold && lowest_around(pair)).collect();
    for step in [0..PHASE_COUNT / 2, PHASE_COUNT / 2..PHASE_COUNT] {
        if !found.iter().any(|pair| step.contains(&pair.sp)) {
            found.push(best(step));
        }
    }
    found.sort_by_key(|pair| pair.sp);
    found
}

/// Drops the worse of two neighbours until m_mb's rows rise with m_sp's all the way round.
fn thin(mut pairs: Vec<Pair>) -> Vec<Pair> {
    let unrolled = |pairs: &[Pair], k: usize| {
        let pair = pairs[k % pairs.len()];
        (pair.sp as isize + pair.offset) + (PHASE_COUNT * (k / pairs.len())) as isize
    };
    while pairs.len() > 1 {
        let clash = (0..pairs.len()).find(|&k| unrolled(&pairs, k + 1) <= unrolled(&pairs, k));
        let Some(k) = clash else { break };
        let next = (k + 1) % pairs.len();
        pairs.remove(if pairs[next].distance > pairs[k].distance { next } else { k });
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, Walk, body, cycle_of};

    fn cycle(speed_mps: f64, period_s: f64) -> GaitCycle {
        let rates = Rates { speed_mps, ..Rates::default() };
        cycle_of(&synthetic::walk("walk", Walk { rates, period_s, ..Walk::default() }))
    }

    #[test]
    fn a_cycle_corresponds_to_itself_at_equal_times() {
        let features = Features::of(&cycle(1.0, 1.1), &body(1.0));
        let pairs = thin(minima(&features, &features));
        assert!(pairs.iter().all(|pair| pair.offset == 0 && pair.distance == 0.0), "{pairs:?}");
    }

    #[test]
    fn pairs_of_two_walks_rise_in_both_and_serve_both_steps() {
        let pairs =
            thin(minima(&Features::of(&cycle(1.0, 1.1), &body(1.0)), &Features::of(&cycle(0.7, 1.4), &body(1.0))));
        for step in [0..PHASE_COUNT / 2, PHASE_COUNT / 2..PHASE_COUNT] {
            assert!(pairs.iter().any(|pair| step.contains(&pair.sp)), "{pairs:?}");
        }
        for pair in pairs.windows(2) {
            assert!(
                pair[0].sp < pair[1].sp && pair[0].sp as isize + pair[0].offset < pair[1].sp as isize + pair[1].offset
            );
        }
    }

    #[test]
    fn the_straight_walk_nearest_its_speed_is_deformed() {
        let rates = |speed_mps, turn_rate_rad_s| Rates { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 };
        let (run, bend, walk) = (rates(3.0, 0.0), rates(1.2, 0.5), rates(1.0, 0.0));
        assert_eq!(semi_procedural(&[run, bend, walk]), Some(2));
        assert_eq!(semi_procedural(&[]), None);
    }
}
