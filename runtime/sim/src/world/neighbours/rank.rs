//! Ranks of neighbours, many at once, and the ten best of them.
//!
//! The loops over lanes have no branch, so the compiler makes vector instructions of them. Ranks are compared by their
//! squares, m², which are infinite beyond the range.

use glam::Vec2;

use crate::world::neighbours::{LATER_SQUARED_M2PS2, NEIGHBOUR_COUNT, Query};

/// Agents ranked at once: a vector of the narrowest x86-64.
pub(crate) const VECTOR: usize = 4;
/// The key of nobody: after every key of finite rank.
pub(crate) const NOBODY: u64 = key(f32::INFINITY, 0);

/// A rank's square and an index in one number, so that ties are broken by comparing once: squares are not negative, and
/// such floats stand in the order of their bits.
pub(crate) const fn key(squared: f32, agent: u32) -> u64 {
    ((squared.to_bits() as u64) << 32) | agent as u64
}

/// The square of a key's rank.
pub(crate) const fn squared_of(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
}

/// Takes a key in where it belongs, if it does: each place keeps its own key, takes the new one, or its predecessor's.
pub(crate) fn offer(keys: &mut [u64; NEIGHBOUR_COUNT], key: u64) {
    for place in (1..NEIGHBOUR_COUNT).rev() {
        keys[place] = keys[place - 1].max(keys[place].min(key));
    }
    keys[0] = keys[0].min(key);
}

/// Which of a vector's ranks are no worse, a bit each.
pub(crate) fn better(ranks: &[f32], worst: f32) -> u32 {
    ranks.iter().enumerate().fold(0, |better, (lane, &rank)| better | (u32::from(rank <= worst) << lane))
}

/// Of the distances.
pub(crate) fn by_distance(x_m: &[f32], y_m: &[f32], query: &Query, ranks: &mut [f32]) {
    for (rank, (x_m, y_m)) in ranks.iter_mut().zip(x_m.iter().zip(y_m)) {
        let (x_m, y_m) = (x_m - query.position_m.x, y_m - query.position_m.y);
        let squared = x_m * x_m + y_m * y_m;
        *rank = within(query, squared, squared);
    }
}

/// Of how near everybody comes within `ahead`.
pub(crate) fn by_approach(
    (x_m, y_m): (&[f32], &[f32]),
    (x_mps, y_mps): (&[f32], &[f32]),
    query: &Query,
    ahead_s: f32,
    ranks: &mut [f32],
) {
    let velocities = x_mps.iter().zip(y_mps);
    for ((rank, (x_m, y_m)), (x_mps, y_mps)) in ranks.iter_mut().zip(x_m.iter().zip(y_m)).zip(velocities) {
        let offset_m = Vec2::new(x_m - query.position_m.x, y_m - query.position_m.y);
        let velocity_mps = Vec2::new(query.velocity_mps.x - x_mps, query.velocity_mps.y - y_mps);
        *rank = within(query, offset_m.length_squared(), approach(offset_m, velocity_mps, ahead_s));
    }
}

fn within(query: &Query, distance_squared: f32, rank: f32) -> f32 {
    if distance_squared <= query.range_m * query.range_m { rank } else { f32::INFINITY }
}

/// The least of |p − t v|² + (c t)² within `ahead`.
pub(crate) fn approach(offset_m: Vec2, velocity_mps: Vec2, ahead_s: f32) -> f32 {
    let time_s = offset_m.dot(velocity_mps) / (velocity_mps.length_squared() + LATER_SQUARED_M2PS2);
    // Compared like this, each line is one vector instruction.
    let time_s = if time_s > 0.0 { time_s } else { 0.0 };
    let time_s = if time_s < ahead_s { time_s } else { ahead_s };
    (offset_m - time_s * velocity_mps).length_squared() + LATER_SQUARED_M2PS2 * time_s * time_s
}
