//! Ranks of neighbours, many at once, and the ten best of them.
//!
//! The loops over lanes have no branch, so the compiler makes vector instructions of them. A rank is a time in s, or a
//! squared distance in m²; it is infinite beyond the range.

use super::{APPROACH_MPS, NEIGHBOUR_COUNT, Query};

/// Agents ranked at once: a vector of the narrowest x86-64.
pub(super) const VECTOR: usize = 4;
/// The key of nobody: after every key of finite rank.
pub(super) const NOBODY: u64 = key(f32::INFINITY, 0);

/// Rank and index in one number, so that ties are broken by comparing once: ranks are not negative, and such floats
/// stand in the order of their bits.
pub(super) const fn key(rank: f32, agent: u32) -> u64 {
    ((rank.to_bits() as u64) << 32) | agent as u64
}

/// The rank of a key.
pub(super) const fn rank_of(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
}

/// Takes a key in where it belongs, if it does: each place keeps its own key, takes the new one, or its predecessor's.
pub(super) fn offer(keys: &mut [u64; NEIGHBOUR_COUNT], key: u64) {
    for place in (1..NEIGHBOUR_COUNT).rev() {
        keys[place] = keys[place - 1].max(keys[place].min(key));
    }
    keys[0] = keys[0].min(key);
}

/// Squared distances.
pub(super) fn by_distance(x_m: &[f32], y_m: &[f32], query: &Query, ranks: &mut [f32]) {
    for (rank, (x_m, y_m)) in ranks.iter_mut().zip(x_m.iter().zip(y_m)) {
        let (x_m, y_m) = (x_m - query.position_m.x, y_m - query.position_m.y);
        let squared = x_m * x_m + y_m * y_m;
        *rank = within(query, squared, squared);
    }
}

/// Distance / (closing speed + 1 m/s).
pub(super) fn by_approach(
    (x_m, y_m): (&[f32], &[f32]),
    (x_mps, y_mps): (&[f32], &[f32]),
    query: &Query,
    ranks: &mut [f32],
) {
    let velocities = x_mps.iter().zip(y_mps);
    for ((rank, (x_m, y_m)), (x_mps, y_mps)) in ranks.iter_mut().zip(x_m.iter().zip(y_m)).zip(velocities) {
        let (x_m, y_m) = (x_m - query.position_m.x, y_m - query.position_m.y);
        let (x_mps, y_mps) = (query.velocity_mps.x - x_mps, query.velocity_mps.y - y_mps);
        let squared = x_m * x_m + y_m * y_m;
        *rank = within(query, squared, approach_s(squared, x_m * x_mps + y_m * y_mps));
    }
}

fn within(query: &Query, distance_squared: f32, rank: f32) -> f32 {
    if distance_squared <= query.range_m * query.range_m { rank } else { f32::INFINITY }
}

/// Distance / (closing speed + 1 m/s), s, multiplied out so that nobody in the same place has a rank but 0: from the
/// square of the distance, and offset · velocity.
pub(super) fn approach_s(distance_squared: f32, closing: f32) -> f32 {
    let closing = if closing > 0.0 { closing } else { 0.0 };
    let across = closing + APPROACH_MPS * distance_squared.sqrt();
    distance_squared / if across > f32::MIN_POSITIVE { across } else { f32::MIN_POSITIVE }
}
