//! The direction of v_pref around a corner (docs/tuning.md, Routes). World, metres.
//!
//! An agent that aims at the corner itself turns late and comes near the wall. It anticipates the turn instead: the
//! direction to the corner, less half the direction to the point after it (dtCrowd of Detour: `calcSmoothSteerDirection`).
//! Both streams of a two-way corner want its inner corner, and lock; so an agent that turns left keeps off the inner
//! corner, on the right side of the passage.

use glam::Vec2;

use crate::world::obstacles::Obstacles;

/// Share of the direction after a corner by which the direction to it is reduced.
const ANTICIPATION: f32 = 0.5;
/// Width of the passage beside a corner that counts, m.
const PASSAGE_MAX_M: f32 = 3.0;
/// Share of that width by which an agent that turns left keeps off the corner.
const KEEP_RIGHT_SHARE: f32 = 0.35;

/// A corner of a route, and the point after it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RouteCorner {
    pub(crate) corner_m: Vec2,
    pub(crate) after_m: Vec2,
}

/// Unit direction of v_pref of an agent before a corner.
pub(crate) fn direction(position_m: Vec2, corner: RouteCorner, wall_radius_m: f32, obstacles: &Obstacles) -> Vec2 {
    let aim_m = corner.corner_m + keep_right_m(position_m, corner, wall_radius_m, obstacles);
    let [to_aim_m, to_after_m] = [aim_m - position_m, corner.after_m - position_m];
    let anticipating_m = to_aim_m - ANTICIPATION * to_aim_m.length() * to_after_m.normalize_or_zero();
    anticipating_m.try_normalize().unwrap_or_else(|| to_aim_m.normalize_or_zero())
}

/// Displacement from a left turn's corner to the right, m; zero at a right turn.
fn keep_right_m(position_m: Vec2, corner: RouteCorner, wall_radius_m: f32, obstacles: &Obstacles) -> Vec2 {
    let to = (corner.corner_m - position_m).normalize_or_zero();
    let onwards = (corner.after_m - corner.corner_m).normalize_or_zero();
    if to.perp_dot(onwards) <= 0.0 {
        return Vec2::ZERO;
    }
    let free_m = |right: Vec2| {
        let to_m = obstacles.clamp_path(corner.corner_m, corner.corner_m + PASSAGE_MAX_M * right, wall_radius_m);
        (to_m - corner.corner_m).dot(right).max(0.0)
    };
    // A door is narrow across the path beyond it, wherever an agent comes from.
    let across = [to, (to + onwards).normalize_or_zero(), onwards].map(|along| -along.perp());
    let width_m = across.into_iter().map(free_m).fold(PASSAGE_MAX_M, f32::min);
    KEEP_RIGHT_SHARE * width_m * across[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A corner of a corridor that turns left about (0, 0): from the south to the west. Width: 4 m, or `width_m`.
    fn turn(width_m: f32) -> Obstacles {
        let block =
            |low: [f32; 2], high: [f32; 2]| [low, [high[0], low[1]], high, [low[0], high[1]]].map(Vec2::from).to_vec();
        let outer = [block([width_m, -9.0], [width_m + 1.0, 9.0]), block([-9.0, width_m], [9.0, width_m + 1.0])];
        Obstacles::new(&[&[block([-9.0, -9.0], [0.0, 0.0])][..], &outer].concat())
    }

    fn direction_at(position_m: [f32; 2], after_m: [f32; 2], width_m: f32) -> Vec2 {
        let corner = RouteCorner { corner_m: Vec2::new(0.2, 0.2), after_m: Vec2::from(after_m) };
        direction(Vec2::from(position_m), corner, 0.2, &turn(width_m))
    }

    #[test]
    fn left_turns_keep_right_and_right_turns_do_not() {
        let left = direction_at([0.5, -5.0], [-5.0, 0.3], 4.0);
        let right = direction_at([-5.0, 0.5], [0.5, -5.0], 4.0);
        assert!(left.x > 0.3, "{left}");
        // A right turn still swings wide, as anticipation has it, but not beyond.
        assert!(right.y > 0.0 && right.y < left.x, "{right}");
    }

    #[test]
    fn narrow_passages_leave_no_room_to_keep_right() {
        let [wide, narrow] = [4.0, 0.6].map(|width_m| direction_at([0.3, -5.0], [-5.0, 0.3], width_m));
        assert!(wide.x > narrow.x + 0.1, "{wide} {narrow}");
    }

    #[test]
    fn at_the_corner_an_agent_turns() {
        let direction = direction_at([0.2, 0.1], [-5.0, 0.3], 0.6);
        assert!(direction.is_normalized());
    }
}
