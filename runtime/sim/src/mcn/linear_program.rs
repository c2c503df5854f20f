//! The velocity nearest to the adapted preference inside all half-planes, or the one that fails them least (`FbCrowd`
//! App. 9.3, 9.4).
//!
//! The first `firm` half-planes must not yield, the others may. The **2D program** (van den Berg et al. 2011) is
//! incremental: it adds one half-plane after the other and, where the optimum so far is cut off, moves it to the new
//! line. The line at which it fails ends the longest feasible prefix. The firm ones of that prefix stay hard, and the
//! **3D program** minimises the greatest *weighted* violation of those that must yield: of the agents, or, where the
//! firm ones are infeasible among themselves, of the firm ones from the failure on, against which no agent is weighed.
//!
//! In the plain minimax of van den Berg et al. the order of agents does not act, which `FbCrowd` §4.4 wants. To keep
//! the longest prefix hard and relax the rest makes it act, but the velocity jumps whenever the prefix changes by one
//! (through bodies, in the four-way crossing, a fifth more acceleration and twice the overlap); weights that change
//! smoothly make it act smoothly.
//!
//! World axes, m/s. Within a disc of `speed_max`, which bounds the programs and nothing else.

use std::ops::Range;

use glam::Vec2;

use super::half_plane::HalfPlane;

/// Lines whose directions' cross product is below this count as parallel; RVO2's own limit, far above f32 rounding.
const PARALLEL: f32 = 1e-5;

/// Parallel lines that leave no room between them, but by less than this, count as touching, m/s: so much may a tilt
/// that counts as parallel make up at a run.
const TOUCHING_MPS: f32 = 8.0 * PARALLEL;

/// What the programs found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// v_i, m/s.
    pub velocity_mps: Vec2,
    /// How many of the half-planes, from the first, are satisfied for certain: all of them where the 2D program
    /// succeeded.
    pub satisfied: usize,
}

/// What a line's one-dimensional program looks for.
#[derive(Clone, Copy)]
enum Objective {
    /// The point nearest to a velocity.
    Nearest(Vec2),
    /// The point furthest along a direction.
    Furthest(Vec2),
}

/// Eq. 14: argmin ‖v − v_op‖ over the half-planes; where they are infeasible, all but the first `firm` yield, and the
/// last of those only where they exclude each other.
///
/// `projected` is working memory.
pub fn solve(
    half_planes: &[HalfPlane],
    firm: usize,
    optimal_mps: Vec2,
    speed_max_mps: f32,
    projected: &mut Vec<HalfPlane>,
) -> Solution {
    let nearest = optimal_mps.clamp_length_max(speed_max_mps);
    match incremental(half_planes, nearest, Objective::Nearest(optimal_mps), speed_max_mps) {
        Ok(velocity_mps) => Solution { velocity_mps, satisfied: half_planes.len() },
        Err((prefix, start_mps)) => {
            let hard = prefix.min(firm);
            let weighed = &half_planes[..yielding(half_planes.len(), firm, hard).end];
            let velocity_mps = least_violation(weighed, hard, start_mps, speed_max_mps, projected);
            Solution { velocity_mps, satisfied: hard }
        }
    }
}

/// Which of `count` half-planes share the violation where only the first `satisfied` are kept.
pub fn yielding(count: usize, firm: usize, satisfied: usize) -> Range<usize> {
    satisfied..if satisfied < firm { firm } else { count }
}

/// The 2D program. On failure, the length of the longest feasible prefix and its optimum.
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

/// The 1D program: the objective's best point of a line, within the disc and the half-planes before it.
fn on_line(line: &HalfPlane, earlier: &[HalfPlane], objective: Objective, speed_max_mps: f32) -> Option<Vec2> {
    // From the line's point nearest to rest, however far off the point that it is given by: else rounding would lead
    // beyond the greatest speed.
    let across = line.direction.perp();
    let offset_mps = across.dot(line.point_mps);
    let foot_mps = offset_mps * across;
    let mut most = half_chord(offset_mps, speed_max_mps)?;
    let mut least = -most;
    for other in earlier {
        let slope = line.direction.perp_dot(other.direction);
        let reach = other.direction.perp_dot(foot_mps - other.point_mps);
        if slope.abs() <= PARALLEL {
            // The tolerance keeps a set without width, whose two sides coincide, from being lost to rounding.
            if reach < -TOUCHING_MPS {
                return None;
            }
        } else if slope > 0.0 {
            // A quotient only where it tightens the stretch.
            if reach < most * slope {
                most = reach / slope;
            }
        } else if reach < least * slope {
            least = reach / slope;
        }
        // The bounds of lines that are nearly parallel are quotients of roundings: a stretch is empty where the line
        // that empties it would be violated by more than that.
        if least > most {
            if (least - most) * slope.abs() > TOUCHING_MPS {
                return None;
            }
            let kept = if slope > 0.0 { least } else { most };
            (least, most) = (kept, kept);
        }
    }
    let along = match objective {
        Objective::Nearest(target_mps) => line.direction.dot(target_mps).clamp(least, most),
        Objective::Furthest(direction) if direction.dot(line.direction) > 0.0 => most,
        Objective::Furthest(_) => least,
    };
    Some(foot_mps + along * line.direction)
}

/// Half of the stretch of a line inside the disc of `speed_max`; the line passes rest at a distance.
fn half_chord(offset_mps: f32, speed_max_mps: f32) -> Option<f32> {
    let squared = (speed_max_mps - offset_mps) * (speed_max_mps + offset_mps);
    (squared >= 0.0).then(|| squared.sqrt())
}

/// The 3D program: with the first `hard` half-planes kept, the velocity whose greatest weighted violation of the others
/// is least.
fn least_violation(
    half_planes: &[HalfPlane],
    hard: usize,
    start_mps: Vec2,
    speed_max_mps: f32,
    projected: &mut Vec<HalfPlane>,
) -> Vec2 {
    let mut best_mps = start_mps;
    let mut violation = 0.0;
    for index in hard..half_planes.len() {
        let worst = &half_planes[index];
        if worst.weight * worst.violation_mps(best_mps) <= violation {
            continue;
        }
        // Where `worst` is the greatest violation, every earlier soft line bounds the velocity by the bisector of both.
        projected.clear();
        projected.extend_from_slice(&half_planes[..hard]);
        projected.extend(half_planes[hard..index].iter().filter_map(|other| bisector(worst, other)));
        let inward = worst.direction.perp();
        let furthest = incremental(projected, inward * speed_max_mps, Objective::Furthest(inward), speed_max_mps);
        // Infeasible only by rounding: the last result is then as good as any.
        best_mps = furthest.unwrap_or(best_mps);
        violation = worst.weight * worst.violation_mps(best_mps);
    }
    best_mps
}

/// Where `other` is violated, by weight, no more than `worst`: det(d_o − d_w, v) >= det(d_o, p_o) − det(d_w, p_w), each
/// d times its weight. None where the lines run alike and one is violated more everywhere.
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
    use super::*;
    use crate::mcn::half_plane::Source;

    const SPEED_MAX_MPS: f32 = 2.0;

    #[test]
    fn agents_are_not_weighed_against_firm_ones_that_exclude_each_other() {
        let behind = |outward: Vec2, reach_mps: f32, source| HalfPlane::behind(reach_mps * outward, outward, source);
        // The wall wants 0.2 m/s back, the hull at least 0.1 m/s ahead.
        let wall = behind(Vec2::X, -0.2, Source::Obstacle(0));
        let hull = [(-Vec2::X, -0.1), (Vec2::Y, 0.5), (-Vec2::Y, 0.5)];
        let hull = hull.map(|(outward, reach_mps)| behind(outward, reach_mps, Source::TurningHull));
        let firm = [wall, hull[0], hull[1], hull[2]];
        let solved = |half_planes: &[HalfPlane]| solve(half_planes, 4, Vec2::ZERO, SPEED_MAX_MPS, &mut Vec::new());
        for away in [Vec2::X, -Vec2::X, Vec2::Y] {
            let agent = HalfPlane { weight: 100.0, ..behind(-away, -1.5, Source::Agent(0)) };
            let crowded = [firm.as_slice(), &[agent]].concat();
            assert_eq!(solved(&crowded), solved(&firm));
        }
    }

    #[test]
    fn projects_nothing_without_half_planes() {
        let solution = solve(&[], 0, Vec2::new(0.3, -1.2), SPEED_MAX_MPS, &mut Vec::new());
        assert_eq!(solution, Solution { velocity_mps: Vec2::new(0.3, -1.2), satisfied: 0 });
    }

    #[test]
    fn of_two_that_exclude_each_other_the_heavier_yields_less_and_the_firm_not_at_all() {
        let [ahead, back] = [1.0, -1.0].map(|x| HalfPlane::behind(x * Vec2::X, -x * Vec2::X, Source::Agent(0)));
        let aside = HalfPlane::behind(0.5 * Vec2::Y, -Vec2::Y, Source::Obstacle(0));
        for (weight, x_mps) in [(1.0, 0.0), (3.0, 0.5)] {
            for half_planes in
                [[aside, HalfPlane { weight, ..ahead }, back], [aside, back, HalfPlane { weight, ..ahead }]]
            {
                let solution = solve(&half_planes, 1, Vec2::ZERO, SPEED_MAX_MPS, &mut Vec::new());
                assert_eq!(solution.satisfied, 1);
                let Vec2 { x, y } = solution.velocity_mps;
                assert!((x - x_mps).abs() < 1e-4 && y >= 0.5 - 1e-4, "{solution:?}");
            }
        }
    }
}
