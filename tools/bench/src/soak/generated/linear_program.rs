//! Random linear programs, and whether the solution of [`solve`] is as good as the best velocity of a grid.
//!
//! Sets of half-planes: feasible, infeasible, equal, opposite to each other, parallel except for rounding, through the
//! origin, or beyond any speed. The check uses no linear programming; it tries the velocities of a grid. World axes,
//! m/s.

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::planning::orca::{HalfPlane, HalfPlaneSource, Solution, solve, yielding};
use glam::Vec2;

/// The greatest speed of every program, m/s.
pub const SPEED_MAX_MPS: f32 = 2.0;
/// Most half-planes of a program.
const HALF_PLANES_MAX: u64 = 14;
/// Spacing of the grid, m/s.
const GRID_MPS: f32 = 0.05;
/// Rounding of a velocity, m/s.
const SLACK_MPS: f32 = 2e-3;

/// The fault of the solution of a random program; none where nothing is wrong.
pub fn fault(seed: u64, stream: u64) -> Option<&'static str> {
    let mut random = SplitMix64::new(seed, stream);
    let half_planes = half_planes(&mut random);
    let optimal_mps = vector(&mut random, 3.0);
    let firm = (random.next_u64() % (half_planes.len() as u64 + 1)) as usize;
    let solution = solve(&half_planes, firm, optimal_mps, SPEED_MAX_MPS, &mut Vec::new());
    fault_of(&half_planes, firm, optimal_mps, &solution)
}

/// The fault of a solution; none where nothing is wrong. The first `firm` half-planes never yield.
///
/// A valid solution keeps the half-planes that it claims to keep. Where it keeps all, no velocity of the grid that
/// keeps them is nearer to the optimal one. Otherwise no velocity of the grid violates those that yield, each by its
/// weight, less.
pub fn fault_of(
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
    grid().filter(|&candidate_mps| worst_mps(hard, candidate_mps) <= 0.0).find_map(|candidate_mps| match soft.first() {
        None => {
            let better_by_mps = velocity_mps.distance(optimal_mps) - candidate_mps.distance(optimal_mps);
            (better_by_mps > SLACK_MPS).then_some("misses a velocity nearer to the optimal one")
        }
        Some(_) if worst_mps(soft, candidate_mps) < -SLACK_MPS => Some("gives half-planes up that could be kept"),
        Some(_) => {
            let better_by_mps = worst_mps(soft, velocity_mps) - worst_mps(soft, candidate_mps);
            (better_by_mps > SLACK_MPS).then_some("misses a velocity that violates less")
        }
    })
}

/// Greatest weighted violation, m/s.
fn worst_mps(half_planes: &[HalfPlane], velocity_mps: Vec2) -> f32 {
    let weighted_mps = |half_plane: &HalfPlane| half_plane.weight * half_plane.violation_mps(velocity_mps);
    half_planes.iter().map(weighted_mps).fold(f32::NEG_INFINITY, f32::max)
}

/// Velocities up to the greatest speed.
fn grid() -> impl Iterator<Item = Vec2> {
    let steps = (SPEED_MAX_MPS / GRID_MPS) as i32;
    (-steps..=steps)
        .flat_map(move |x| (-steps..=steps).map(move |y| GRID_MPS * Vec2::new(x as f32, y as f32)))
        .filter(|velocity_mps| velocity_mps.length() <= SPEED_MAX_MPS)
}

/// Random half-planes.
fn half_planes(random: &mut SplitMix64) -> Vec<HalfPlane> {
    let count = 1 + random.next_u64() % HALF_PLANES_MAX;
    // Some sets are feasible, some are not.
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

/// The half-plane behind a line: at a distance from the origin, in a direction.
fn behind(angle_rad: f64, distance_mps: f32) -> HalfPlane {
    let (sin, cos) = libm::sincos(angle_rad);
    let outward = Vec2::new(cos as f32, sin as f32);
    HalfPlane::behind(distance_mps * outward, outward, HalfPlaneSource::Stance)
}

fn vector(random: &mut SplitMix64, range: f64) -> Vec2 {
    Vec2::new(random.within(range) as f32, random.within(range) as f32)
}
