//! Who may touch whom, by sweeping along a crowd's longer side: sorted by where each begins there, nobody need look
//! beyond those who begin before he ends. So thousands are quick to compare, in a square or in line. World, metres.

use glam::Vec2;

/// Sorts indices by where each begins along the axis on which the places are farther apart, 0 for x and 1 for y, and
/// tells that axis; `begins_m` is given an index and the axis.
pub(crate) fn sort_along_longer_side(
    order: &mut [usize],
    places_m: impl Iterator<Item = Vec2>,
    begins_m: impl Fn(usize, usize) -> f64,
) -> usize {
    let start = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    let (low_m, high_m) = places_m.fold(start, |(low_m, high_m), place_m| (low_m.min(place_m), high_m.max(place_m)));
    let axis = (high_m - low_m).max_position();
    order.sort_by(|&a, &b| begins_m(a, axis).total_cmp(&begins_m(b, axis)).then(a.cmp(&b)));
    axis
}
