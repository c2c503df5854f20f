//! The velocity nearest to v_op inside all half-planes, or the one that violates them least (`FbCrowd` App. 9.3, 9.4).
//!
//! The first half-planes are *firm*: they yield only where they exclude each other. The **2D program** (van den Berg et
//! al. 2011) is incremental: it adds one half-plane after the other and, where that cuts off the optimum so far, moves
//! the optimum to the new line. The line at which it fails ends the longest feasible prefix. The firm half-planes of
//! that prefix stay hard. The **3D program** minimises the greatest *weighted* violation of the half-planes that yield:
//!
//! 1. of the agents, where all firm half-planes are in the prefix;
//! 2. of the firm ones from the failure on, where they are infeasible among themselves; agents then do not count.
//!
//! `FbCrowd` §4.4 wants the order of agents to matter, which it does not in the minimax of van den Berg et al. Here
//! weights make it matter, and they change smoothly (docs/tuning.md compares the longest prefix).
//!
//! World axes, m/s, within a disc of the greatest speed, which bounds the programs and nothing else.

use std::ops::Range;

use glam::Vec2;

use crate::planning::orca::half_plane::HalfPlane;

/// Cross product of two directions below which lines count as parallel: RVO2's own limit, far above f32 rounding.
const PARALLEL: f32 = 1e-5;

/// Overlap below which parallel lines that exclude each other count as touching, m/s: what a tilt that counts as
/// parallel amounts to at a run.
const TOUCHING_MPS: f32 = 8.0 * PARALLEL;

/// The result of the programs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// v_i, m/s.
    pub velocity_mps: Vec2,
    /// Number of half-planes, from the first, that are satisfied for certain: all where the 2D program succeeded.
    pub satisfied_count: usize,
}

/// The objective of a program on a line.
#[derive(Clone, Copy)]
enum Objective {
    /// The point nearest to a velocity.
    Nearest(Vec2),
    /// The point furthest along a direction.
    Furthest(Vec2),
}

/// Eq. 14: argmin ‖v − v_op‖ over the half-planes, of which the first `firm_count` are firm. `projected` is working
/// memory.
pub(crate) fn solve(
    half_planes: &[HalfPlane],
    firm_count: usize,
    optimal_mps: Vec2,
    speed_max_mps: f32,
    projected: &mut Vec<HalfPlane>,
) -> Solution {
    let nearest = optimal_mps.clamp_length_max(speed_max_mps);
    match incremental(half_planes, nearest, Objective::Nearest(optimal_mps), speed_max_mps) {
        Ok(velocity_mps) => Solution { velocity_mps, satisfied_count: half_planes.len() },
        Err((prefix, start_mps)) => {
            let hard_count = prefix.min(firm_count);
            let weighed = &half_planes[..yielding(half_planes.len(), firm_count, hard_count).end];
            let velocity_mps = least_violation(weighed, hard_count, start_mps, speed_max_mps, projected);
            Solution { velocity_mps, satisfied_count: hard_count }
        }
    }
}

/// Which of `count` half-planes share the violation where only the first `satisfied_count` are kept.
pub(crate) fn yielding(count: usize, firm_count: usize, satisfied_count: usize) -> Range<usize> {
    satisfied_count..if satisfied_count < firm_count { firm_count } else { count }
}

/// The 2D program: the optimum; on failure, the length of the longest feasible prefix and its optimum.
fn incremental(
    half_planes: &[HalfPlane],
    start_mps: Vec2,
    objective: Objective,
    speed_max_mps: f32,
) -> Result<Vec2, (usize, Vec2)> {
    let mut best_mps = start_mps;
    for (index, half_plane) in half_planes.iter().enumerate() {
        if half_plane.violation_mps(best_mps) > 0.0 {
            best_mps = on_line(half_plane, &half_planes[..index], objective, speed_max_mps).ok_or((index, best_mps))?;
        }
    }
    Ok(best_mps)
}

/// The 1D program: the best point of a line within the disc and the half-planes before it; none where they leave
/// nothing of the line.
fn on_line(line: &HalfPlane, earlier: &[HalfPlane], objective: Objective, speed_max_mps: f32) -> Option<Vec2> {
    // Measured from the line's point nearest to rest. From a point far off, rounding would lead beyond the greatest
    // speed.
    let across = line.direction.perp();
    let offset_mps = across.dot(line.point_mps);
    let foot_mps = offset_mps * across;
    let half_chord_mps = half_chord(offset_mps, speed_max_mps)?;
    let mut stretch = Stretch { least_mps: -half_chord_mps, most_mps: half_chord_mps };
    for other in earlier {
        let slope = line.direction.perp_dot(other.direction);
        let reach_mps = other.direction.perp_dot(foot_mps - other.point_mps);
        stretch = stretch.cut(slope, reach_mps)?;
    }
    let Stretch { least_mps, most_mps } = stretch;
    let along_mps = match objective {
        Objective::Nearest(target_mps) => line.direction.dot(target_mps).clamp(least_mps, most_mps),
        Objective::Furthest(direction) if direction.dot(line.direction) > 0.0 => most_mps,
        Objective::Furthest(_) => least_mps,
    };
    Some(foot_mps + along_mps * line.direction)
}

/// The feasible stretch of a line: bounds along its direction, m/s.
#[derive(Clone, Copy)]
struct Stretch {
    least_mps: f32,
    most_mps: f32,
}

impl Stretch {
    /// The stretch inside one more half-plane, whose line crosses at a slope (the sine of the angle) and leaves `reach`
    /// at the foot; none where it is empty. Cases:
    ///
    /// 1. parallel lines: all or nothing; a tolerance keeps a set without width, whose two sides coincide, feasible;
    /// 2. a slope to the left: a bound from above;
    /// 3. a slope to the right: a bound from below;
    /// 4. the bounds cross: a point is left where rounding alone made them cross.
    #[inline]
    fn cut(mut self, slope: f32, reach_mps: f32) -> Option<Self> {
        if slope.abs() <= PARALLEL {
            return if reach_mps < -TOUCHING_MPS { None } else { Some(self) }; // case 1
        }
        // Divides only where a bound tightens.
        if slope > 0.0 {
            if reach_mps < self.most_mps * slope {
                self.most_mps = reach_mps / slope; // case 2
            }
        } else if reach_mps < self.least_mps * slope {
            self.least_mps = reach_mps / slope; // case 3
        }
        if self.least_mps > self.most_mps {
            // Case 4. Bounds of nearly parallel lines are quotients of roundings, so the violation decides.
            if (self.least_mps - self.most_mps) * slope.abs() > TOUCHING_MPS {
                return None;
            }
            let kept_mps = if slope > 0.0 { self.least_mps } else { self.most_mps };
            self = Self { least_mps: kept_mps, most_mps: kept_mps };
        }
        Some(self)
    }
}

/// Half the length of a line inside the disc of the greatest speed, m/s; the line passes rest at `offset_mps`. None
/// where it misses the disc.
fn half_chord(offset_mps: f32, speed_max_mps: f32) -> Option<f32> {
    let squared = (speed_max_mps - offset_mps) * (speed_max_mps + offset_mps);
    (squared >= 0.0).then(|| squared.sqrt())
}

/// The 3D program: the velocity that keeps the first `hard_count` half-planes and whose greatest weighted violation of
/// the others is least.
fn least_violation(
    half_planes: &[HalfPlane],
    hard_count: usize,
    start_mps: Vec2,
    speed_max_mps: f32,
    projected: &mut Vec<HalfPlane>,
) -> Vec2 {
    let mut best_mps = start_mps;
    let mut violation = 0.0;
    for index in hard_count..half_planes.len() {
        let worst = &half_planes[index];
        if worst.weight * worst.violation_mps(best_mps) <= violation {
            continue;
        }
        // Where the violation of `worst` is the greatest, the bisector with every earlier soft line bounds the
        // velocity.
        projected.clear();
        projected.extend_from_slice(&half_planes[..hard_count]);
        projected.extend(half_planes[hard_count..index].iter().filter_map(|other| bisector(worst, other)));
        let inward = worst.direction.perp();
        let furthest = incremental(projected, inward * speed_max_mps, Objective::Furthest(inward), speed_max_mps);
        // Infeasible by rounding alone: the last result is then as good as any.
        best_mps = furthest.unwrap_or(best_mps);
        violation = worst.weight * worst.violation_mps(best_mps);
    }
    best_mps
}

/// The velocities that violate `other`, by weight, no more than `worst`: det(d_o − d_w, v) >= det(d_o, p_o) −
/// det(d_w, p_w), each d times its weight. None where weighted directions are equal: one is violated more everywhere.
fn bisector(worst: &HalfPlane, other: &HalfPlane) -> Option<HalfPlane> {
    let [of_worst, of_other] = [worst, other].map(|line| line.weight * line.direction);
    let across = of_other - of_worst;
    let length = across.length();
    if length <= PARALLEL {
        return None;
    }
    let direction = across / length;
    let offset_mps = of_other.perp_dot(other.point_mps) - of_worst.perp_dot(worst.point_mps);
    Some(HalfPlane::new(offset_mps / length * direction.perp(), direction, other.source))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::planning::orca::half_plane::HalfPlaneSource;
    use crate::wild::program::{SPEED_MAX_MPS, judged};

    fn half_planes(counts: std::ops::Range<usize>) -> impl Strategy<Value = Vec<HalfPlane>> {
        let one = (0.0f32..std::f32::consts::TAU, -0.6f32..1.5, 0.2f32..3.0);
        let one = one.prop_map(|(angle, distance_mps, weight)| {
            let (sin, cos) = libm::sincosf(angle);
            let outward = Vec2::new(cos, sin);
            HalfPlane { weight, ..HalfPlane::behind(distance_mps * outward, outward, HalfPlaneSource::Stance) }
        });
        proptest::collection::vec(one, counts)
    }

    fn check(half_planes: &[HalfPlane], firm_count: usize, optimal_mps: Vec2) {
        let solution = solve(half_planes, firm_count, optimal_mps, SPEED_MAX_MPS, &mut Vec::new());
        assert!(solution.satisfied_count == half_planes.len() || solution.satisfied_count <= firm_count);
        assert_eq!(judged(half_planes, firm_count, optimal_mps, &solution), None, "{solution:?}");
    }

    fn optimal() -> impl Strategy<Value = Vec2> {
        (-2.5f32..2.5, -2.5f32..2.5).prop_map(Vec2::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        #[test]
        fn no_velocity_tried_is_better(
            half_planes in half_planes(1..12), firm in 0usize..6, optimal in optimal(),
        ) {
            check(&half_planes, firm.min(half_planes.len()), optimal);
        }

        #[test]
        fn no_velocity_tried_violates_less_in_a_tight_crowd(
            mut half_planes in half_planes(4..9), firm in 0usize..4, optimal in optimal(),
        ) {
            for half_plane in &mut half_planes {
                half_plane.point_mps += 0.8 * half_plane.direction.perp();
            }
            check(&half_planes, firm, optimal);
        }
    }

    #[test]
    fn agents_do_not_count_where_firm_half_planes_are_infeasible() {
        let behind = |outward: Vec2, reach_mps: f32, source| HalfPlane::behind(reach_mps * outward, outward, source);
        // The wall requires 0.2 m/s backward, the hull at least 0.1 m/s forward.
        let wall = behind(Vec2::X, -0.2, HalfPlaneSource::Obstacle(0));
        let hull = [(-Vec2::X, -0.1), (Vec2::Y, 0.5), (-Vec2::Y, 0.5)];
        let hull = hull.map(|(outward, reach_mps)| behind(outward, reach_mps, HalfPlaneSource::TurningHull));
        let firm = [wall, hull[0], hull[1], hull[2]];
        let solved = |half_planes: &[HalfPlane]| solve(half_planes, 4, Vec2::ZERO, SPEED_MAX_MPS, &mut Vec::new());
        for away in [Vec2::X, -Vec2::X, Vec2::Y] {
            let agent = HalfPlane { weight: 100.0, ..behind(-away, -1.5, HalfPlaneSource::Agent(0)) };
            let crowded = [firm.as_slice(), &[agent]].concat();
            assert_eq!(solved(&crowded), solved(&firm));
            check(&crowded, 4, Vec2::ZERO);
        }
    }

    #[test]
    fn without_half_planes_the_optimum_stays() {
        let solution = solve(&[], 0, Vec2::new(0.3, -1.2), SPEED_MAX_MPS, &mut Vec::new());
        assert_eq!(solution, Solution { velocity_mps: Vec2::new(0.3, -1.2), satisfied_count: 0 });
    }

    #[test]
    fn the_heavier_of_two_agents_yields_less_and_walls_never() {
        let [ahead, back] =
            [1.0, -1.0].map(|x| HalfPlane::behind(x * Vec2::X, -x * Vec2::X, HalfPlaneSource::Agent(0)));
        let aside = HalfPlane::behind(0.5 * Vec2::Y, -Vec2::Y, HalfPlaneSource::Obstacle(0));
        for (weight, x_mps) in [(1.0, 0.0), (3.0, 0.5)] {
            for half_planes in
                [[aside, HalfPlane { weight, ..ahead }, back], [aside, back, HalfPlane { weight, ..ahead }]]
            {
                let solution = solve(&half_planes, 1, Vec2::ZERO, SPEED_MAX_MPS, &mut Vec::new());
                assert_eq!(solution.satisfied_count, 1);
                let Vec2 { x, y } = solution.velocity_mps;
                assert!((x - x_mps).abs() < 1e-4 && y >= 0.5 - 1e-4, "{solution:?}");
            }
        }
    }
}
