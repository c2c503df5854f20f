//! Points and segments on the ground: the nearest point, and the side of a line. Any axes, metres.

use glam::{DVec2, Vec2};

/// The point of a segment that is nearest to a position. A segment without length is a point.
pub(crate) fn nearest_on_segment(position_m: Vec2, from_m: Vec2, to_m: Vec2) -> Vec2 {
    let along = to_m - from_m;
    let share = (position_m - from_m).dot(along) / along.length_squared().max(f32::MIN_POSITIVE);
    from_m + share.clamp(0.0, 1.0) * along
}

/// Positive where a point lies left of the line through two others, in m². Computed in f64, where its sign is exact
/// enough to trust.
pub(crate) fn side_of_line(from_m: Vec2, to_m: Vec2, point_m: Vec2) -> f64 {
    let [from_m, to_m, point_m] = [from_m, to_m, point_m].map(DVec2::from);
    (to_m - from_m).perp_dot(point_m - from_m)
}
