//! Half-planes that keep two moving discs from meeting within the time horizon (`FbCrowd` §4.4, Eq. 12; van den Berg et
//! al. 2011).
//!
//! The velocity obstacle of j for i within τ is a cone of relative velocities, truncated by a *cut-off* disc of radius
//! r/τ about p/τ (p = p_j − p_i, r = r_i + r_j). u is the least change of the relative velocity that leaves it; each
//! agent takes its share of u. Three cases, by the boundary that is nearest to the relative velocity:
//!
//! 1. overlap: the cut-off disc of the time within which the discs are to part;
//! 2. the cut-off disc, where the relative velocity lies before the disc's tangent points;
//! 3. the left or the right leg of the cone.
//!
//! World axes, m and m/s.

use glam::Vec2;

use crate::planning::orca::half_plane::{HalfPlane, HalfPlaneSource};
use crate::world::neighbours::neighbour::Neighbour;
use crate::world::neighbours::neighbour_lanes::{Lanes, NeighbourLanes};

/// Share of u for two identical agents (reciprocal avoidance).
pub(crate) const EQUAL_SHARE: f32 = 0.5;
/// Greatest difference from the equal share: more against a neighbour from the left, less against one from the right.
const YIELD_TO_LEFT: f32 = 0.2;
/// Sum of both speeds below which no agent counts as coming from a side, m/s.
const SPEEDS_MIN_MPS: f32 = 0.1;

/// The shares of u that agent i takes, ½ on average: more against a neighbour that comes from its left, as in a
/// roundabout where agents keep right.
///
/// The shares of both agents add up to 1, so together they avoid each other. With ½ each, agents that meet at a centre
/// from all sides brake alike until they stand. The sine of the angle between p and v_i + v_j changes its sign when i
/// and j are exchanged.
pub(crate) fn shares(own_mps: Vec2, neighbours: &NeighbourLanes) -> Lanes {
    let own_speed_mps = own_mps.length_squared().sqrt();
    std::array::from_fn(|lane| {
        let offset_m = neighbours.offset_m(lane);
        let other_mps = own_mps - neighbours.relative_mps(lane);
        let speeds_mps = own_speed_mps + other_mps.length_squared().sqrt();
        let from_right = offset_m.perp_dot(own_mps + other_mps);
        let scale = offset_m.length_squared().sqrt() * speeds_mps.max(SPEEDS_MIN_MPS);
        EQUAL_SHARE - YIELD_TO_LEFT * from_right / scale.max(f32::MIN_POSITIVE)
    })
}

/// C_ij: the velocities of agent i, at `own_mps` now, that take a share of avoiding agent j for `horizon_s`;
/// of parting from it within `parting_s` where they overlap.
// Inlined: a returned half-plane is written in parts and read at once, which stalls for 3 to 5 % of planning.
#[inline(always)]
pub(crate) fn agent_half_plane(
    own_mps: Vec2,
    other: &Neighbour,
    share: f32,
    horizon_s: f32,
    parting_s: f32,
) -> HalfPlane {
    let Neighbour { offset_m, relative_mps, radius_m, .. } = *other;
    let (direction, change_mps) = if offset_m.length_squared() <= radius_m * radius_m {
        leave_cut_off(offset_m, relative_mps, radius_m, parting_s) // case 1
    } else if is_before_cut_off(offset_m, relative_mps, radius_m, horizon_s) {
        leave_cut_off(offset_m, relative_mps, radius_m, horizon_s) // case 2
    } else {
        leave_leg(offset_m, relative_mps, radius_m, horizon_s) // case 3
    };
    HalfPlane::new(own_mps + share * change_mps, direction, HalfPlaneSource::Agent(other.agent))
}

/// Whether the front of the cut-off disc, between its two tangent points, is nearest to the relative velocity.
fn is_before_cut_off(offset_m: Vec2, relative_mps: Vec2, radius_m: f32, horizon_s: f32) -> bool {
    let from_centre = relative_mps - offset_m / horizon_s;
    let along = from_centre.dot(offset_m);
    along < 0.0 && along * along > radius_m * radius_m * from_centre.length_squared()
}

/// Cases 1 and 2: direction of the line and u, out of the cut-off disc of a time.
fn leave_cut_off(offset_m: Vec2, relative_mps: Vec2, radius_m: f32, time_s: f32) -> (Vec2, Vec2) {
    let from_centre = relative_mps - offset_m / time_s;
    let distance = from_centre.length_squared().sqrt();
    // Two discs at one position with one velocity have no direction to part in; any fixed one serves.
    let outward = if distance > 0.0 { from_centre / distance } else { Vec2::X };
    (-outward.perp(), (radius_m / time_s - distance) * outward)
}

/// Case 3: direction of the line and u, out over the leg on the relative velocity's side.
fn leave_leg(offset_m: Vec2, relative_mps: Vec2, radius_m: f32, horizon_s: f32) -> (Vec2, Vec2) {
    let passes_left = offset_m.perp_dot(relative_mps - offset_m / horizon_s) > 0.0;
    let direction = if passes_left { tangent(offset_m, radius_m) } else { -tangent(offset_m, -radius_m) };
    (direction, relative_mps.dot(direction) * direction - relative_mps)
}

/// Unit direction from the origin along the left tangent of a disc; along the right one for a negative radius. The disc
/// must not contain the origin.
pub(crate) fn tangent(centre_m: Vec2, radius_m: f32) -> Vec2 {
    let distance_squared = centre_m.length_squared();
    let leg_m = (distance_squared - radius_m * radius_m).max(0.0).sqrt();
    Vec2::new(leg_m, radius_m).rotate(centre_m) / distance_squared
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::world::disc::Disc;
    use crate::world::time_to_collision::disc_with_disc;

    const HORIZON_S: f32 = 4.0;
    const PARTING_S: f32 = 0.1;

    fn vector(bound: f32) -> impl Strategy<Value = Vec2> {
        (-bound..bound, -bound..bound).prop_map(Vec2::from)
    }

    fn disc() -> impl Strategy<Value = Disc> {
        (vector(3.0), vector(1.5), 0.15f32..0.5).prop_map(|(position_m, velocity_mps, radius_m)| Disc {
            position_m,
            velocity_mps,
            radius_m,
        })
    }

    fn as_neighbour(own: &Disc, other: &Disc) -> Neighbour {
        let offset_m = other.position_m - own.position_m;
        let relative_mps = own.velocity_mps - other.velocity_mps;
        let radius_m = own.radius_m + other.radius_m;
        Neighbour {
            agent: 0,
            offset_m,
            relative_mps,
            radius_m,
            distance_m: offset_m.length(),
            time_to_collision_s: disc_with_disc(offset_m, relative_mps, radius_m),
        }
    }

    fn share(own: &Disc, other: &Disc) -> f32 {
        let (neighbour, mut lanes) = (as_neighbour(own, other), NeighbourLanes::default());
        lanes.set(0, neighbour.offset_m, neighbour.relative_mps, neighbour.radius_m);
        shares(own.velocity_mps, &lanes)[0]
    }

    fn both_half_planes(own: &Disc, other: &Disc) -> [HalfPlane; 2] {
        [(own, other), (other, own)]
            .map(|(a, b)| agent_half_plane(a.velocity_mps, &as_neighbour(a, b), share(a, b), HORIZON_S, PARTING_S))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn discs_that_keep_their_half_planes_do_not_meet(
            own in disc(), other in disc(), first in vector(2.0), second in vector(2.0),
        ) {
            let radius_m = own.radius_m + other.radius_m;
            let offset_m = other.position_m - own.position_m;
            if offset_m.length() < radius_m + 0.01 {
                return Ok(());
            }
            // A velocity outside is moved to the boundary, where the claim is sharpest.
            let kept = |half_plane: &HalfPlane, velocity_mps: Vec2| {
                velocity_mps + half_plane.violation_mps(velocity_mps).max(0.0) * half_plane.direction.perp()
            };
            let [of_own, of_other] = both_half_planes(&own, &other);
            let (first, second) = (kept(&of_own, first), kept(&of_other, second));
            let met_s = disc_with_disc(offset_m, first - second, radius_m - 2e-3);
            prop_assert!(met_s > HORIZON_S - 1e-2, "{met_s}");
        }

        #[test]
        fn the_change_is_the_least_that_avoids_contact(own in disc(), other in disc()) {
            let radius_m = own.radius_m + other.radius_m;
            let offset_m = other.position_m - own.position_m;
            let velocity_mps = own.velocity_mps - other.velocity_mps;
            let met_s = disc_with_disc(offset_m, velocity_mps, radius_m);
            if met_s <= 0.0 || met_s >= HORIZON_S {
                return Ok(());
            }
            let half_plane = agent_half_plane(own.velocity_mps, &as_neighbour(&own, &other), 1.0, HORIZON_S, PARTING_S);
            let change_mps = half_plane.violation_mps(own.velocity_mps);
            for step in 0..360 {
                let (sin, cos) = libm::sincosf((step as f32).to_radians());
                let less_mps = velocity_mps + 0.99 * change_mps * Vec2::new(cos, sin);
                prop_assert!(disc_with_disc(offset_m, less_mps, radius_m + 1e-3) < HORIZON_S + 2e-2);
            }
        }

        #[test]
        fn shares_add_up_to_one(own in disc(), other in disc()) {
            let [first, second] = [(&own, &other), (&other, &own)].map(|(a, b)| share(a, b));
            prop_assert!((first + second - 1.0).abs() < 1e-5 && (0.29..0.71).contains(&first));
        }

        #[test]
        fn overlapping_discs_part_in_time(own in disc(), direction in vector(1.0), depth in 0.05f32..0.95) {
            let reach_m = (own.radius_m + 0.3) * depth;
            let other = Disc {
                position_m: own.position_m + reach_m * direction.normalize_or(Vec2::X),
                velocity_mps: Vec2::ZERO,
                radius_m: 0.3,
            };
            let [first, second] = both_half_planes(&own, &other).map(|half_plane| half_plane.point_mps);
            let parted_m = (other.position_m - own.position_m - PARTING_S * (first - second)).length();
            prop_assert!(parted_m > own.radius_m + 0.3 - 1e-3, "{parted_m}");
        }
    }

    #[test]
    fn an_agent_yields_more_to_one_from_the_left() {
        let own = Disc { position_m: Vec2::ZERO, velocity_mps: Vec2::X, radius_m: 0.25 };
        let from_left = Disc { position_m: Vec2::new(2.0, 2.0), velocity_mps: -Vec2::Y, radius_m: 0.25 };
        assert!(share(&own, &from_left) > 0.6 && share(&from_left, &own) < 0.4);
    }
}
