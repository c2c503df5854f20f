//! The gap that an agent passes: the width between what stands nearest on its left and on its right.
//!
//! People turn their shoulders in gaps below 1.3 times their breadth (Warren and Whang 1987, *J. Exp. Psychol.: Hum.
//! Percept. Perform.* 13, 371–383). The planner knows walls and agents near by; the synthesis turns the shoulders.
//!
//! Only what lies in a strip counts, from a little behind the agent to a step ahead. World axes, relative to the
//! agent's centre, metres.

use glam::Vec2;

use crate::planning::surroundings::Surroundings;
use crate::planning::world_view::WorldView;

/// Ends of the strip along the direction of travel, m.
const STRIP_M: [f32; 2] = [-0.2, 0.5];
/// Least speed at which an agent passes walls and other agents, m/s. For those that walk side by side, and in queues, the
/// elbow room counts.
const SPEED_MIN_MPS: f32 = 0.4;
/// Greatest distance to either side, m: wider gaps turn no shoulders.
const ASIDE_MAX_M: f32 = 0.8;

/// Distances of what is nearest on the left and on the right of an agent that is to walk at a velocity, m; none where a
/// side is free.
pub(crate) fn gap_m(
    world: &WorldView,
    agent: usize,
    velocity_mps: Vec2,
    surroundings: &Surroundings,
) -> Option<[f32; 2]> {
    let ahead = (velocity_mps.length() >= SPEED_MIN_MPS).then(|| velocity_mps.normalize_or_zero())?;
    let mut sides_m = [ASIDE_MAX_M; 2];
    let mut narrow = |nearest_m: Vec2| {
        let side = usize::from(nearest_m.y < 0.0);
        sides_m[side] = sides_m[side].min(nearest_m.y.abs());
    };
    let local_m = |offset_m: Vec2| Vec2::new(ahead.dot(offset_m), ahead.perp_dot(offset_m));
    for near in &surroundings.edges {
        let edge_m = world.edge_m(agent, near.edge).map(local_m);
        in_strip_m(edge_m).into_iter().flatten().for_each(&mut narrow);
    }
    for neighbour in surroundings.neighbours.as_slice() {
        let centre_m = local_m(neighbour.offset_m);
        let radius_m = world.radii_m[neighbour.agent as usize];
        let passes = ahead.dot(neighbour.relative_mps) >= SPEED_MIN_MPS;
        if passes && (STRIP_M[0]..=STRIP_M[1]).contains(&centre_m.x) {
            narrow(Vec2::new(centre_m.x, centre_m.y.signum() * (centre_m.y.abs() - radius_m).max(0.0)));
        }
    }
    sides_m.iter().all(|side_m| *side_m < ASIDE_MAX_M).then_some(sides_m)
}

/// The ends of the part of an edge in the strip; none where no part is. An edge that crosses the path ahead bounds no
/// gap.
fn in_strip_m([from_m, to_m]: [Vec2; 2]) -> Option<[Vec2; 2]> {
    let along_m = to_m - from_m;
    let at = |x_m: f32| if along_m.x == 0.0 { 0.0 } else { ((x_m - from_m.x) / along_m.x).clamp(0.0, 1.0) };
    let ends_m = STRIP_M.map(|x_m| from_m + at(x_m) * along_m);
    let ends_m = if along_m.x == 0.0 { [from_m, to_m] } else { ends_m };
    let inside = |point_m: &Vec2| (STRIP_M[0] - 1e-4..=STRIP_M[1] + 1e-4).contains(&point_m.x);
    (ends_m.iter().all(inside) && ends_m[0].y * ends_m[1].y > 0.0).then_some(ends_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearest_m(edge_m: [[f32; 2]; 2]) -> Option<f32> {
        let ends_m = in_strip_m(edge_m.map(Vec2::from))?;
        Some(ends_m[0].y.abs().min(ends_m[1].y.abs()))
    }

    #[test]
    fn edges_count_in_the_strip_alone() {
        let close = |found: Option<f32>, expected_m: f32| (found.unwrap() - expected_m).abs() < 1e-5;
        assert!(close(nearest_m([[-5.0, 0.3], [5.0, 0.3]]), 0.3), "a wall along the path");
        assert!(close(nearest_m([[0.4, 0.25], [0.4, 4.0]]), 0.25), "the end of a wall across");
        assert!(close(nearest_m([[4.0, -0.25], [-4.0, -4.25]]), 2.0), "a wall that nears");
        assert_eq!(nearest_m([[0.6, 0.25], [0.6, 4.0]]), None, "too far ahead");
        assert_eq!(nearest_m([[0.4, -1.0], [0.4, 4.0]]), None, "a wall in the path");
    }
}
