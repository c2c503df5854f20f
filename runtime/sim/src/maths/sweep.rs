//! Sweep: orders the members of a crowd along its longer side, so that each needs comparing only with those that begin
//! before it ends. World frame, metres.

use glam::Vec2;

/// Sorts indices by `begins_m` along the axis of the greater extent of the positions, and returns that axis: 0 for x, 1
/// for y. `begins_m` gives the least coordinate of an index on an axis, m.
pub(crate) fn sort_along_longer_side(
    order: &mut [usize],
    positions_m: impl Iterator<Item = Vec2>,
    begins_m: impl Fn(usize, usize) -> f64,
) -> usize {
    let start = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    let (low_m, high_m) =
        positions_m.fold(start, |(low_m, high_m), position_m| (low_m.min(position_m), high_m.max(position_m)));
    let axis = (high_m - low_m).max_position();
    order.sort_by(|&a, &b| begins_m(a, axis).total_cmp(&begins_m(b, axis)).then(a.cmp(&b)));
    axis
}
