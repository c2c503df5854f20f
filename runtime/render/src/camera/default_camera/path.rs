//! The path of a camera that moves with the crowd: at each moment one of the candidates, so that the sum of the logarithms
//! of their scores, less what turning about the crowd costs, is greatest (dynamic programming, Viterbi 1967). It passes no
//! wall in a straight line from moment to moment where there is another path.

use rayon::prelude::*;

use crate::camera::default_camera::candidates::Candidate;
use crate::camera::default_camera::crowd::CrowdMoment;
use crate::camera::default_camera::walls::Walls;

/// Logarithm of the score that a turn by one radian costs.
const TURN_COST: f32 = 0.6;
/// Logarithm of the score that a wall on the path costs.
const WALL_COST: f32 = 10.0;
/// Greatest speed of the eye against the middle of the crowd, m/s: a brisk crane.
const SPEED_MPS: f64 = 2.5;

/// Index of the candidate at each moment. `logarithms` holds the scores of all candidates of each moment.
pub(super) fn best_path(
    candidates: &[Candidate],
    moments: &[CrowdMoment],
    logarithms: &[Vec<f32>],
    walls: &Walls,
) -> Vec<usize> {
    let Some(mut sums) = logarithms.first().cloned() else { return Vec::new() };
    // The candidate before each, of each moment after the first.
    let mut befores: Vec<Vec<usize>> = Vec::new();
    for (moments, of_moment) in moments.windows(2).zip(&logarithms[1..]) {
        let reach_m = (SPEED_MPS * (moments[1].time_s - moments[0].time_s)) as f32;
        let before = |to: usize| {
            let sum = |from: usize| {
                let [a, b] = [from, to].map(|at| &candidates[at]);
                let way_m = a.offset_m.distance(b.offset_m);
                let cost = TURN_COST * way_m / a.distance_m.midpoint(b.distance_m);
                if way_m > reach_m { f32::NEG_INFINITY } else { sums[from] - cost }
            };
            let eye_m = |moment: usize, at: usize| moments[moment].centre_m.extend(0.0) + candidates[at].offset_m;
            let is_walled = |from: usize| walls.block(eye_m(0, from), eye_m(1, to));
            best_before(&(0..candidates.len()).map(sum).collect::<Vec<f32>>(), is_walled)
        };
        let bests: Vec<(usize, f32)> = (0..candidates.len()).into_par_iter().map(before).collect();
        sums = bests.iter().zip(of_moment).map(|((_, sum), logarithm)| sum + logarithm).collect();
        befores.push(bests.into_iter().map(|(from, _)| from).collect());
    }
    let mut at = greatest(&sums);
    let mut path = vec![at];
    for before in befores.iter().rev() {
        at = before[at];
        path.push(at);
    }
    path.reverse();
    path
}

/// The index with the greatest sum, less what a wall costs, and this sum. Few are tested against walls: the first without
/// one decides.
fn best_before(sums: &[f32], is_walled: impl Fn(usize) -> bool) -> (usize, f32) {
    let mut sums = sums.to_vec();
    let mut walled = (0, f32::NEG_INFINITY);
    loop {
        let at = greatest(&sums);
        if sums[at] <= walled.1 {
            return walled;
        }
        if !is_walled(at) {
            return (at, sums[at]);
        }
        if sums[at] - WALL_COST > walled.1 {
            walled = (at, sums[at] - WALL_COST);
        }
        sums[at] = f32::NEG_INFINITY;
    }
}

/// Index of the greatest value, the first of equals.
pub(super) fn greatest(values: &[f32]) -> usize {
    (1..values.len()).fold(0, |best, at| if values[at] > values[best] { at } else { best })
}
