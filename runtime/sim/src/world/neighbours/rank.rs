//! Ranks of neighbours, several at once, and the ten best of them.
//!
//! A neighbour ranks the better, the nearer it comes within the ranking horizon T if both agents keep their velocities;
//! to come later costs a little:
//!
//! ```text
//! rank² = min { |p − t v|² + (c t)² : 0 <= t <= T }      p = p_j − p_i,  v = v_i − v_j
//! ```
//!
//! T = 0 ranks by distance. Loops over agents have no branch, so the compiler turns them into vector instructions.
//! Ranks are compared by their squares, m², which are infinite beyond the range. World axes, metres, seconds.

use glam::Vec2;

use crate::world::neighbours::neighbour::{NEIGHBOUR_COUNT, NeighbourQuery};

/// Agents ranked at once: a vector of the narrowest x86-64.
pub(crate) const VECTOR: usize = 4;
/// c²: cost of coming later, m²/s². With it the benches `table1`, `rimea` and `emergence` meet every criterion; others
/// of eight values from 0.12 to 0.36 miss one.
pub(crate) const LATER_SQUARED_M2PS2: f32 = 0.14;
/// The key of an empty slot: after every key of finite rank.
pub(crate) const NO_KEY: u64 = key(f32::INFINITY, 0);

/// A rank's square and an agent's index as one number, which orders by rank, then by index. Squares are not negative,
/// and such floats have the order of their bits.
pub(crate) const fn key(squared: f32, agent: u32) -> u64 {
    ((squared.to_bits() as u64) << 32) | agent as u64
}

/// The square of a key's rank, m².
pub(crate) const fn squared_of(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
}

/// Inserts a key into the sorted best keys, or drops it: each slot keeps its key, takes the new one, or its
/// predecessor's.
pub(crate) fn insert(keys: &mut [u64; NEIGHBOUR_COUNT], key: u64) {
    for slot in (1..NEIGHBOUR_COUNT).rev() {
        keys[slot] = keys[slot - 1].max(keys[slot].min(key));
    }
    keys[0] = keys[0].min(key);
}

/// Which ranks of a vector are no worse than the worst, one bit each.
pub(crate) fn better(ranks: &[f32], worst: f32) -> u32 {
    ranks.iter().enumerate().fold(0, |better, (lane, &rank)| better | (u32::from(rank <= worst) << lane))
}

/// Squared ranks by distance, T = 0.
pub(crate) fn by_distance(x_m: &[f32], y_m: &[f32], query: &NeighbourQuery, ranks: &mut [f32]) {
    for (rank, (x_m, y_m)) in ranks.iter_mut().zip(x_m.iter().zip(y_m)) {
        let (x_m, y_m) = (x_m - query.position_m.x, y_m - query.position_m.y);
        let squared = x_m * x_m + y_m * y_m;
        *rank = within_range(query, squared, squared);
    }
}

/// Squared ranks by approach within `horizon_s`.
pub(crate) fn by_approach(
    (x_m, y_m): (&[f32], &[f32]),
    (x_mps, y_mps): (&[f32], &[f32]),
    query: &NeighbourQuery,
    horizon_s: f32,
    ranks: &mut [f32],
) {
    let velocities = x_mps.iter().zip(y_mps);
    for ((rank, (x_m, y_m)), (x_mps, y_mps)) in ranks.iter_mut().zip(x_m.iter().zip(y_m)).zip(velocities) {
        let offset_m = Vec2::new(x_m - query.position_m.x, y_m - query.position_m.y);
        let relative_mps = Vec2::new(query.velocity_mps.x - x_mps, query.velocity_mps.y - y_mps);
        *rank = within_range(query, offset_m.length_squared(), squared_rank(offset_m, relative_mps, horizon_s));
    }
}

fn within_range(query: &NeighbourQuery, distance_squared: f32, rank: f32) -> f32 {
    if distance_squared <= query.range_m * query.range_m { rank } else { f32::INFINITY }
}

/// min |p − t v|² + (c t)² within `horizon_s`, m².
pub(crate) fn squared_rank(offset_m: Vec2, relative_mps: Vec2, horizon_s: f32) -> f32 {
    let time_s = offset_m.dot(relative_mps) / (relative_mps.length_squared() + LATER_SQUARED_M2PS2);
    // As comparisons, each line is one vector instruction.
    let time_s = if time_s > 0.0 { time_s } else { 0.0 };
    let time_s = if time_s < horizon_s { time_s } else { horizon_s };
    (offset_m - time_s * relative_mps).length_squared() + LATER_SQUARED_M2PS2 * time_s * time_s
}
