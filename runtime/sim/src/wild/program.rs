//! Linear programs that no crowd would pose, for tests and `bench soak`: does `solve` find what trying finds?
//!
//! Sets of half-planes drawn at random: feasible, infeasible, all alike, opposite to each other, parallel but for
//! rounding, through the origin, or beyond any speed. The judge knows nothing of linear programs; it tries the
//! velocities of a grid. World axes, m/s.

use glam::Vec2;

use crate::maths::random::SplitMix64;
use crate::planning::orca::half_plane::{HalfPlane, HalfPlaneSource};
use crate::planning::orca::linear_program::{Solution, solve, yielding};

/// The greatest speed of every program, m/s.
pub(crate) const SPEED_MAX_MPS: f32 = 2.0;
const HALF_PLANES_MAX: u64 = 14;
/// Spacing of the velocities that are tried, m/s.
const GRID_MPS: f32 = 0.05;
/// By so much may a velocity tried seem better, or one found seem wrong, by rounding, m/s.
const SLACK_MPS: f32 = 2e-3;

/// What is wrong with the solution of the seed's program; none where all is well.
pub fn fault(seed: u64, stream: u64) -> Option<&'static str> {
    let mut random = SplitMix64::new(seed, stream);
    let half_planes = drawn(&mut random);
    let optimal_mps = vector(&mut random, 3.0);
    let firm = (random.next_u64() % (half_planes.len() as u64 + 1)) as usize;
    let solution = solve(&half_planes, firm, optimal_mps, SPEED_MAX_MPS, &mut Vec::new());
    judged(&half_planes, firm, optimal_mps, &solution)
}

/// The solution of the 2D program is no worse than any velocity tried; where it finds none, there is none; the solution
/// then keeps what it claims to keep, and violates what yields, each by its weight, no more than any velocity that
/// keeps it.
pub(crate) fn judged(
    half_planes: &[HalfPlane],
    firm: usize,
    optimal_mps: Vec2,
    solution: &Solution,
) -> Option<&'static str> {
    let Solution { velocity_mps, satisfied_count: satisfied } = *solution;
    let hard = &half_planes[..satisfied];
    let soft = &half_planes[yielding(half_planes.len(), firm, satisfied)];
    if !velocity_mps.is_finite() || velocity_mps.length() > SPEED_MAX_MPS + SLACK_MPS {
        return Some("finds a velocity beyond the greatest speed");
    }
    if worst_mps(hard, velocity_mps) > SLACK_MPS {
        return Some("breaks a half-plane that it claims to keep");
    }
    grid().filter(|&tried_mps| worst_mps(hard, tried_mps) <= 0.0).find_map(|tried_mps| match soft.first() {
        None => {
            let better_by_mps = velocity_mps.distance(optimal_mps) - tried_mps.distance(optimal_mps);
            (better_by_mps > SLACK_MPS).then_some("misses a velocity nearer to the best")
        }
        Some(_) if worst_mps(soft, tried_mps) < -SLACK_MPS => Some("gives half-planes up that could be kept"),
        Some(_) => {
            let better_by_mps = worst_mps(soft, velocity_mps) - worst_mps(soft, tried_mps);
            (better_by_mps > SLACK_MPS).then_some("misses a velocity that violates less")
        }
    })
}

/// The greatest violation.
fn worst_mps(half_planes: &[HalfPlane], velocity_mps: Vec2) -> f32 {
    let weighed_mps = |half_plane: &HalfPlane| half_plane.weight * half_plane.violation_mps(velocity_mps);
    half_planes.iter().map(weighed_mps).fold(f32::NEG_INFINITY, f32::max)
}

fn grid() -> impl Iterator<Item = Vec2> {
    let steps = (SPEED_MAX_MPS / GRID_MPS) as i32;
    (-steps..=steps)
        .flat_map(move |x| (-steps..=steps).map(move |y| GRID_MPS * Vec2::new(x as f32, y as f32)))
        .filter(|velocity_mps| velocity_mps.length() <= SPEED_MAX_MPS)
}

fn drawn(random: &mut SplitMix64) -> Vec<HalfPlane> {
    let count = 1 + random.next_u64() % HALF_PLANES_MAX;
    // Some sets leave much room, some none.
    let middle_mps = random.within(1.0) as f32;
    let mut half_planes: Vec<HalfPlane> = Vec::new();
    for _ in 0..count {
        let angle_rad = random.within(std::f64::consts::PI);
        let fresh = behind(angle_rad, middle_mps + random.within(1.0) as f32);
        let last = half_planes.last().copied().unwrap_or(fresh);
        let tilt_rad = f64::from(last.direction.to_angle()) - std::f64::consts::FRAC_PI_2;
        let reach_mps = -last.direction.perp_dot(last.point_mps);
        half_planes.push(match random.next_u64() % 10 {
            0 => last,
            1 => HalfPlane { direction: -last.direction, ..last },
            2 => behind(tilt_rad + random.within(1e-5), reach_mps + random.within(1e-3) as f32),
            3 => behind(tilt_rad + std::f64::consts::PI + random.within(1e-5), -reach_mps + random.within(0.1) as f32),
            4 => behind(angle_rad, 0.0),
            5 => behind(angle_rad, 10.0 * random.within(1.0) as f32),
            _ => fresh,
        });
    }
    half_planes
}

/// What lies before a line at a distance from the origin, in a direction, is forbidden.
fn behind(angle_rad: f64, distance_mps: f32) -> HalfPlane {
    let (sin, cos) = libm::sincos(angle_rad);
    let outward = Vec2::new(cos as f32, sin as f32);
    HalfPlane::behind(distance_mps * outward, outward, HalfPlaneSource::Stance)
}

fn vector(random: &mut SplitMix64, range: f64) -> Vec2 {
    Vec2::new(random.within(range) as f32, random.within(range) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_velocity_tried_is_better_than_the_one_found() {
        for seed in 0..6000 {
            assert_eq!(fault(seed, 0), None, "seed {seed}");
        }
    }

    #[test]
    fn wrong_solutions_are_found_out() {
        let half_planes = [behind(0.0, 0.5)];
        let judged = |x, satisfied| {
            let solution = Solution { velocity_mps: Vec2::new(x, 0.0), satisfied_count: satisfied };
            judged(&half_planes, 0, Vec2::X, &solution).is_some()
        };
        assert!(!judged(0.5, 1) && judged(0.6, 1) && judged(0.3, 1) && judged(0.5, 0));
    }
}
