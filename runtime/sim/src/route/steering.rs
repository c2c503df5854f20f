//! The direction of v_pref, and of the facing, around a corner (docs/tuning.md, Routes). World, metres.
//!
//! An agent that aims at the corner itself turns late and comes near the wall. It anticipates the turn instead: the
//! direction to the corner, less half the direction to the point after it (dtCrowd of Detour: `calcSmoothSteerDirection`).
//! Both streams of a two-way corner want its inner corner, and lock; so an agent that turns left keeps off the inner
//! corner, on the right side of the passage.
//!
//! An agent that the crowd holds too near to a wall goes back off it, but faces along its route.

use glam::Vec2;

use crate::route::crowd_routes::NextCorner;
use crate::route::params::KeepSide;
use crate::world::obstacles::Obstacles;

/// Share of the direction after a corner by which the direction to it is reduced.
const ANTICIPATION: f32 = 0.5;
/// Width of the passage beside a corner that counts, m.
const PASSAGE_MAX_M: f32 = 3.0;
/// Share of that width by which an agent that turns left keeps off the corner.
const KEEP_RIGHT_SHARE: f32 = 0.35;

/// Distance along the route against which the distance from the mesh counts, for an agent that is too near to a wall,
/// m: as far from the mesh as this, the agent returns to it at 45°.
const RETURN_M: f32 = 0.1;
/// Distance from a waypoint in sight within which the mesh does not count, m: waypoints may lie beside it.
const NEAR_M: f32 = 1.0;

/// Where an agent goes and what it faces, as unit vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Heading {
    /// Direction of v_pref.
    pub(crate) direction: Vec2,
    /// Direction of the route, which the agent faces.
    pub(crate) facing: Vec2,
}

/// The heading of an agent around walls; none where its waypoint is in sight.
///
/// 1. On the mesh: before a corner, the anticipated turn.
/// 2. Off the mesh, too near to a wall: as from the nearest point of the mesh, and back to that point.
pub(crate) fn heading(
    position_m: Vec2,
    next: &NextCorner,
    keep: KeepSide,
    wall_radius_m: f32,
    obstacles: &Obstacles,
) -> Option<Heading> {
    let from_m = next.entry_m.unwrap_or(position_m);
    let facing = match next.after_m {
        Some(after_m) => {
            turning(from_m, RouteCorner { corner_m: next.corner_m, after_m }, keep, wall_radius_m, obstacles)
        }
        None if next.entry_m.is_none() || next.distance_m < NEAR_M => return None,
        None => (next.corner_m - from_m).normalize_or_zero(),
    };
    let direction = (RETURN_M * facing + (from_m - position_m)).normalize_or(facing);
    Some(Heading { direction, facing })
}

/// Distance from a corner within which an agent turns along the route beyond, m: one that a crowd holds beside the
/// corner would otherwise turn back to it.
const ROUNDED_M: f32 = 0.3;
/// Shares of the displacement to the right that are tried until the aim is in sight.
const SHARES: [f32; 3] = [1.0, 0.5, 0.25];

/// Greatest angle between the direction before a corner and the direction to it, rad: 45°. Agents that a crowd holds
/// beside a corner would otherwise turn back from it.
const SWING_MAX_RAD: f32 = 0.785;

/// A corner of a route, and the point after it.
#[derive(Clone, Copy, Debug)]
struct RouteCorner {
    corner_m: Vec2,
    after_m: Vec2,
}

/// Unit direction of v_pref of an agent before a corner.
fn turning(position_m: Vec2, corner: RouteCorner, keep: KeepSide, wall_radius_m: f32, obstacles: &Obstacles) -> Vec2 {
    let aim_m = corner.corner_m + keep_side_m(position_m, corner, keep, wall_radius_m, obstacles);
    let [to_aim_m, to_after_m] = [aim_m - position_m, corner.after_m - position_m];
    let anticipating_m = to_aim_m - ANTICIPATION * to_aim_m.length() * to_after_m.normalize_or_zero();
    let before = anticipating_m.try_normalize().unwrap_or_else(|| to_aim_m.normalize_or_zero());
    let direct = (corner.corner_m - position_m).normalize_or(before);
    let swing_rad = libm::atan2f(direct.perp_dot(before), direct.dot(before)).clamp(-SWING_MAX_RAD, SWING_MAX_RAD);
    let (sin, cos) = libm::sincosf(swing_rad);
    let before = Vec2::new(cos, sin).rotate(direct);
    let near = 1.0 - (corner.corner_m.distance(position_m) / ROUNDED_M).min(1.0);
    let onwards = (corner.after_m - corner.corner_m).normalize_or(before);
    before.lerp(onwards, near).normalize_or(onwards)
}

/// Displacement from the corner of a turn to the left to the right side, m, or the mirror image of it; zero at other
/// turns. The aim stays in sight.
fn keep_side_m(
    position_m: Vec2,
    corner: RouteCorner,
    keep: KeepSide,
    wall_radius_m: f32,
    obstacles: &Obstacles,
) -> Vec2 {
    let to = (corner.corner_m - position_m).normalize_or_zero();
    let onwards = (corner.after_m - corner.corner_m).normalize_or_zero();
    let right = match keep {
        KeepSide::Right => 1.0,
        KeepSide::Left => -1.0,
        KeepSide::None => return Vec2::ZERO,
    };
    if right * to.perp_dot(onwards) <= 0.0 {
        return Vec2::ZERO;
    }
    let free_m =
        |right: Vec2| obstacles.free_length_m(corner.corner_m, corner.corner_m + PASSAGE_MAX_M * right, wall_radius_m);
    // A door is narrow across the path beyond it, wherever an agent comes from.
    let across = [to, (to + onwards).normalize_or_zero(), onwards].map(|along| -right * along.perp());
    let width_m = across.into_iter().map(free_m).fold(PASSAGE_MAX_M, f32::min);
    let mut displacements_m = SHARES.into_iter().map(|share| share * KEEP_RIGHT_SHARE * width_m * across[1]);
    let in_sight = |aside_m: &Vec2| obstacles.is_free(position_m, corner.corner_m + *aside_m);
    displacements_m.find(in_sight).unwrap_or_default()
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
        direction_keeping(KeepSide::Right, position_m, after_m, width_m)
    }

    fn direction_keeping(keep: KeepSide, position_m: [f32; 2], after_m: [f32; 2], width_m: f32) -> Vec2 {
        let corner = RouteCorner { corner_m: Vec2::new(0.2, 0.2), after_m: Vec2::from(after_m) };
        turning(Vec2::from(position_m), corner, keep, 0.2, &turn(width_m))
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
    fn agents_keep_on_the_side_that_is_set() {
        let at = |keep| direction_keeping(keep, [0.5, -5.0], [-5.0, 0.3], 4.0).x;
        assert!(at(KeepSide::Right) > at(KeepSide::None) + 0.1);
        assert_eq!(at(KeepSide::Left), at(KeepSide::None));
    }

    #[test]
    fn narrow_passages_leave_no_room_to_keep_right() {
        let [wide, narrow] = [4.0, 0.6].map(|width_m| direction_at([0.3, -5.0], [-5.0, 0.3], width_m));
        assert!(wide.x > narrow.x + 0.1, "{wide} {narrow}");
    }

    #[test]
    fn beside_a_corner_an_agent_does_not_turn_back() {
        for position_m in [[0.25, -0.3], [0.4, -0.1], [0.6, 0.0]] {
            let to = (Vec2::new(0.2, 0.2) - Vec2::from(position_m)).normalize();
            let direction = direction_at(position_m, [-5.0, 0.3], 4.0);
            assert!(direction.dot(to) > 0.7, "{position_m:?}: {direction}");
        }
    }

    #[test]
    fn at_the_corner_an_agent_turns() {
        let direction = direction_at([0.2, 0.1], [-5.0, 0.3], 0.6);
        assert!(direction.is_normalized());
    }
}
