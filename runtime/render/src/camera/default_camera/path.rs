//! The path of a camera that moves with the crowd: at each moment one of the candidates, so that the sum of the logarithms
//! of their scores, less what turning about the crowd costs, is greatest (dynamic programming, Viterbi 1967).

use crate::camera::default_camera::candidates::Candidate;
use crate::camera::default_camera::crowd::CrowdMoment;

/// Logarithm of the score that a turn by one radian costs.
const TURN_COST: f32 = 0.6;
/// Greatest speed of the eye against the middle of the crowd, m/s: a brisk crane.
const SPEED_MPS: f64 = 2.5;

/// Index of the candidate at each moment, and the mean of the logarithms less costs. `logarithms` holds the scores of all
/// candidates of each moment.
pub(super) fn best_path(
    candidates: &[Candidate],
    moments: &[CrowdMoment],
    logarithms: &[Vec<f32>],
) -> (Vec<usize>, f32) {
    let Some(mut sums) = logarithms.first().cloned() else { return (Vec::new(), 0.0) };
    // The candidate before each, of each moment after the first.
    let mut befores: Vec<Vec<usize>> = Vec::new();
    for (moments, of_moment) in moments.windows(2).zip(&logarithms[1..]) {
        let reach_m = (SPEED_MPS * (moments[1].time_s - moments[0].time_s)) as f32;
        let before = |to: usize| {
            let sum = |from: usize| {
                let (from_m, to_m) = (candidates[from].offset_m, candidates[to].offset_m);
                let way_m = from_m.distance(to_m);
                let cost = TURN_COST * way_m / (0.5 * (from_m.length() + to_m.length()));
                if way_m > reach_m { f32::NEG_INFINITY } else { sums[from] - cost }
            };
            (0..candidates.len())
                .map(|from| (from, sum(from)))
                .fold((to, sums[to]), |best, next| if next.1 > best.1 { next } else { best })
        };
        let bests: Vec<(usize, f32)> = (0..candidates.len()).map(before).collect();
        sums = bests.iter().zip(of_moment).map(|((_, sum), logarithm)| sum + logarithm).collect();
        befores.push(bests.into_iter().map(|(from, _)| from).collect());
    }
    let mut at = (1..sums.len()).fold(0, |best, at| if sums[at] > sums[best] { at } else { best });
    let mean = sums[at] / logarithms.len() as f32;
    let mut path = vec![at];
    for before in befores.iter().rev() {
        at = before[at];
        path.push(at);
    }
    path.reverse();
    (path, mean)
}
