//! Correspondence times T between two examples (`FbCrowd` §5, Eq. 10): times at which synthesis may switch from one to
//! the other.
//!
//! Enters: the pose distances D of all pairs of stored phases ([`crate::motion::pose_distance`]): a torus, since both
//! cycles are closed. Leaves: pairs of times, monotone and cyclic in both.
//!
//! 1. Candidates are the local minima of D (no neighbour among eight is lower) up to [`THRESHOLD_RATIO`] times the
//!    least D of all.
//! 2. A step is half a cycle, from one mid-stance to the other. For each step of one and each step of the other, the
//!    most alike poses are a candidate too: a substitute, used only where a step has no minimum. A standing body has no
//!    steps; its half-cycles count as steps.
//! 3. Among all cyclic chains of candidates in which every step has a pair, the best has the most minima, then the
//!    fewest substitutes, then the least sum of D.
//!
//! The table from B to A is the table from A to B with exchanged columns.

use crate::motion::motion_db::{Correspondence, MotionDb, PHASE_COUNT};
use crate::motion::pose_distance::{Distances, distances_m};

/// Greatest D of a minimum that counts, as a multiple of the least D of all.
pub const THRESHOLD_RATIO: f32 = 1.5;

impl Correspondence {
    /// The correspondence of the given m_sp: m_mb and T. `None` if no other example steps.
    pub fn of(db: &MotionDb, semi_procedural: usize) -> Option<Self> {
        let point = |example: usize| db.blend_space.scaled(db.examples[example].parameters);
        let distance = |example: &usize| point(*example).distance_squared(point(semi_procedural));
        let stepping = (0..db.examples.len()).filter(|&example| db.examples[example].key_times_s.is_some());
        let others = stepping.filter(|&example| example != semi_procedural);
        let blending = others.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let pairs_s = pose_pairs(db, semi_procedural, blending).iter().map(|pair| pair.times_s).collect();
        Some(Self { semi_procedural: semi_procedural as u32, blending: blending as u32, pairs_s })
    }
}

/// Two poses that are alike, one of each of two examples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosePair {
    /// Time of the pose in each cycle, seconds from its phase 0.
    pub times_s: [f32; 2],
    /// D: distance of the poses, metres.
    pub distance_m: f32,
}

/// T between two examples, in order of the first one's times.
pub fn pose_pairs(db: &MotionDb, from: usize, to: usize) -> Vec<PosePair> {
    if from > to {
        let mut pairs = pose_pairs(db, to, from);
        for pair in &mut pairs {
            pair.times_s.reverse();
        }
        pairs.sort_by(|a, b| a.times_s[0].total_cmp(&b.times_s[0]));
        return pairs;
    }
    let distances_m = distances_m(db, from, to);
    let time_s = |example: usize, row: usize| db.examples[example].phase_map.time_s(row as f32 / PHASE_COUNT as f32);
    let pair = |RowPair { rows: [row, other_row], distance_m }: RowPair| PosePair {
        times_s: [time_s(from, row), time_s(to, other_row)],
        distance_m,
    };
    best_row_pairs(&distances_m).into_iter().map(pair).collect()
}

/// A pair of stored phases: a cell of the torus.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RowPair {
    rows: [usize; 2],
    distance_m: f32,
}

impl RowPair {
    fn at(rows: [usize; 2], distances_m: &Distances) -> Self {
        Self { rows, distance_m: distances_m[rows[0]][rows[1]] }
    }
}

/// T as rows: the best of all chains, in order of the first example's rows.
fn best_row_pairs(distances_m: &Distances) -> Vec<RowPair> {
    let minima = minima(distances_m);
    let substitutes = substitutes(distances_m).into_iter().filter(|pair| !minima.contains(pair));
    let candidates: Vec<Candidate> = minima
        .iter()
        .map(|&pair| Candidate { pair, is_minimum: true })
        .chain(substitutes.map(|pair| Candidate { pair, is_minimum: false }))
        .collect();
    let mut best: Option<PairChain> = None;
    for &first in &candidates {
        let chain = best_chain_from(first, &candidates);
        if let Some(chain) = chain.filter(|chain| best.as_ref().is_none_or(|best| chain.is_better(best))) {
            best = Some(chain);
        }
    }
    let mut pairs = best.map_or_else(Vec::new, |chain| chain.pairs);
    pairs.sort_by_key(|pair| pair.rows);
    pairs
}

/// Local minima up to the threshold. If neighbours are equal, the first counts.
fn minima(distances_m: &Distances) -> Vec<RowPair> {
    let least_m = distances_m.iter().flatten().copied().fold(f32::INFINITY, f32::min);
    let rows = (0..PHASE_COUNT).flat_map(|row| (0..PHASE_COUNT).map(move |other_row| [row, other_row]));
    let pairs = rows.map(|rows| RowPair::at(rows, distances_m));
    let is_minimum = |pair: &RowPair| {
        neighbours(pair.rows).all(|[row, other_row]| {
            let neighbour_m = distances_m[row][other_row];
            pair.distance_m < neighbour_m || (pair.distance_m == neighbour_m && pair.rows < [row, other_row])
        })
    };
    pairs.filter(|pair| pair.distance_m <= THRESHOLD_RATIO * least_m && is_minimum(pair)).collect()
}

/// The eight neighbours of a pair of rows on the torus.
fn neighbours([row, other_row]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    let steps = [PHASE_COUNT - 1, 0, 1];
    let all = steps.into_iter().flat_map(move |down| steps.map(|across| [down, across]));
    all.filter(|shift| *shift != [0, 0])
        .map(move |[down, across]| [(row + down) % PHASE_COUNT, (other_row + across) % PHASE_COUNT])
}

/// The most alike poses of each step of one example and each step of the other.
fn substitutes(distances_m: &Distances) -> Vec<RowPair> {
    const HALF: usize = PHASE_COUNT / 2;
    let blocks = [0, HALF].into_iter().flat_map(|first| [0, HALF].map(|other_first| [first, other_first]));
    let best = |[first, other_first]: [usize; 2]| {
        let pairs = (first..first + HALF)
            .flat_map(|row| (other_first..other_first + HALF).map(move |other_row| [row, other_row]))
            .map(|rows| RowPair::at(rows, distances_m));
        pairs.min_by(|a, b| a.distance_m.total_cmp(&b.distance_m)).expect("a step has rows")
    };
    blocks.map(best).collect()
}

/// A pair that a chain may hold.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    pair: RowPair,
    is_minimum: bool,
}

/// Pairs whose rows rise in both cycles.
#[derive(Clone, Debug)]
struct PairChain {
    pairs: Vec<RowPair>,
    /// Number of pairs that are minima.
    minima: usize,
    /// Sum of the distances, metres.
    sum_m: f32,
    /// Steps that have a pair: one bit for each half of each cycle.
    steps: usize,
}

/// Value of [`PairChain::steps`] in which both halves of both cycles have a pair.
const ALL_STEPS: usize = 0b1111;

impl PairChain {
    fn with(&self, next: &Candidate) -> Self {
        let [half, other_half] = next.pair.rows.map(|row| usize::from(row >= PHASE_COUNT / 2));
        let mut chain = self.clone();
        chain.pairs.push(next.pair);
        chain.minima += usize::from(next.is_minimum);
        chain.sum_m += next.pair.distance_m;
        chain.steps |= 0b01 << half | 0b0100 << other_half;
        chain
    }

    /// Whether it has more minima, else fewer substitutes, else a lower sum of distances.
    fn is_better(&self, other: &Self) -> bool {
        let lengths = |chain: &Self| (chain.minima, std::cmp::Reverse(chain.pairs.len()));
        lengths(self).cmp(&lengths(other)).then(other.sum_m.total_cmp(&self.sum_m)).is_gt()
    }
}

/// The best chain that starts at a candidate, runs once around both cycles and has a pair for every step; `None` if
/// there is none. Method: longest rising subsequence, rows counted from the first pair, one best chain per set of
/// steps.
fn best_chain_from(first: Candidate, candidates: &[Candidate]) -> Option<PairChain> {
    let from_first = |pair: &RowPair| {
        let offset = |axis: usize| (pair.rows[axis] + PHASE_COUNT - first.pair.rows[axis]) % PHASE_COUNT;
        [offset(0), offset(1)]
    };
    let mut later: Vec<([usize; 2], &Candidate)> =
        candidates.iter().map(|candidate| (from_first(&candidate.pair), candidate)).collect();
    later.retain(|([row, other_row], _)| *row > 0 && *other_row > 0);
    later.sort_by_key(|(offsets, _)| *offsets);
    let start = PairChain { pairs: Vec::new(), minima: 0, sum_m: 0.0, steps: 0 }.with(&first);
    let mut ends: Vec<([usize; 2], Vec<PairChain>)> = vec![([0, 0], vec![start])];
    for (offsets, candidate) in later {
        let mut best: Vec<PairChain> = Vec::new();
        let before = ends.iter().filter(|(end, _)| end[0] < offsets[0] && end[1] < offsets[1]);
        for chain in before.flat_map(|(_, chains)| chains).map(|chain| chain.with(candidate)) {
            match best.iter_mut().find(|other| other.steps == chain.steps) {
                Some(other) if chain.is_better(other) => *other = chain,
                Some(_) => {}
                None => best.push(chain),
            }
        }
        ends.push((offsets, best));
    }
    let complete = ends.into_iter().flat_map(|(_, chains)| chains).filter(|chain| chain.steps == ALL_STEPS);
    complete.reduce(|best, chain| if chain.is_better(&best) { chain } else { best })
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use super::*;
    use proptest::prelude::*;

    /// A torus of hills: waves of a few periods, each with a size, periods around both cycles, and phases.
    fn hills(waves: &[(f32, [u8; 2], [f32; 2])]) -> Distances {
        let height = |row: usize, other_row: usize| {
            let wave = |&(size, periods, shifts): &(f32, [u8; 2], [f32; 2])| {
                let angle = |axis: usize, row: usize| {
                    TAU * (f32::from(periods[axis]) * row as f32 / PHASE_COUNT as f32 + shifts[axis])
                };
                size * (libm::cosf(angle(0, row)) * libm::cosf(angle(1, other_row)))
            };
            4.0 + waves.iter().map(wave).sum::<f32>()
        };
        (0..PHASE_COUNT).map(|row| std::array::from_fn(|other_row| height(row, other_row))).collect()
    }

    /// Whether pairs, in order of their rows, rise in both cycles and run around each once.
    fn is_cyclic(pairs: &[RowPair]) -> bool {
        let rows_passed = |axis: usize| -> usize {
            let nexts = pairs.iter().cycle().skip(1);
            // From a pair to itself is once around.
            let step = |(a, b): (&RowPair, &RowPair)| (b.rows[axis] + PHASE_COUNT - a.rows[axis] - 1) % PHASE_COUNT + 1;
            pairs.iter().zip(nexts).map(step).sum()
        };
        rows_passed(0) == PHASE_COUNT && rows_passed(1) == PHASE_COUNT
    }

    fn serves_every_step(pairs: &[RowPair]) -> bool {
        let serves = |axis: usize, late: bool| pairs.iter().any(|pair| (pair.rows[axis] >= PHASE_COUNT / 2) == late);
        [0, 1].iter().all(|&axis| serves(axis, false) && serves(axis, true))
    }

    /// The most minima in any set of minima and substitutes that is cyclic and serves every step; all sets are tried.
    fn most_minima(minima: &[RowPair], substitutes: &[RowPair]) -> usize {
        let all: Vec<RowPair> = minima.iter().chain(substitutes).copied().collect();
        let chosen = |set: usize| {
            let mut pairs: Vec<RowPair> =
                (0..all.len()).filter(|bit| set >> bit & 1 == 1).map(|bit| all[bit]).collect();
            pairs.sort_by_key(|pair| pair.rows);
            pairs
        };
        let sets = (1usize..1 << all.len()).filter(|set| {
            let pairs = chosen(*set);
            is_cyclic(&pairs) && serves_every_step(&pairs)
        });
        sets.map(|set| (set & ((1 << minima.len()) - 1)).count_ones() as usize).max().unwrap()
    }

    fn wave() -> impl Strategy<Value = (f32, [u8; 2], [f32; 2])> {
        (0.2f32..1.0, [0u8..4, 0u8..4], [0.0f32..1.0, 0.0f32..1.0])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn minima_have_no_lower_neighbour(
            waves in prop::collection::vec(wave(), 1..5),
        ) {
            let hills = hills(&waves);
            let least = hills.iter().flatten().copied().fold(f32::INFINITY, f32::min);
            let found = minima(&hills);
            for row in 0..PHASE_COUNT {
                for other_row in 0..PHASE_COUNT {
                    let around = |down: usize, aside: usize| {
                        hills[(row + PHASE_COUNT - 1 + down) % PHASE_COUNT][(other_row + PHASE_COUNT - 1 + aside) % PHASE_COUNT]
                    };
                    let here = around(1, 1);
                    let lower = (0..9).filter(|k| *k != 4 && around(k / 3, k % 3) <= here).count();
                    let is_strict = lower == 0 && here <= THRESHOLD_RATIO * least;
                    prop_assert!(!is_strict || found.iter().any(|pair| pair.rows == [row, other_row]));
                }
            }
            prop_assert!(found.iter().all(|pair| pair.distance_m <= THRESHOLD_RATIO * least));
        }

        #[test]
        fn pairs_are_cyclic_and_keep_the_most_minima(waves in prop::collection::vec(wave(), 1..5)) {
            let hills = hills(&waves);
            let found = best_row_pairs(&hills);
            prop_assert!(is_cyclic(&found) && serves_every_step(&found), "{found:?}");
            let minima = minima(&hills);
            prop_assume!(minima.len() < 9);
            let others: Vec<RowPair> = substitutes(&hills).into_iter().filter(|pair| !minima.contains(pair)).collect();
            let kept = found.iter().filter(|pair| minima.contains(pair)).count();
            prop_assert_eq!(kept, most_minima(&minima, &others), "{:?} of {:?}", found, minima);
        }

        #[test]
        fn exchanging_the_cycles_exchanges_the_columns(waves in prop::collection::vec(wave(), 2..5)) {
            let hills = hills(&waves);
            let exchanged: Distances =
                (0..PHASE_COUNT).map(|row| std::array::from_fn(|other_row| hills[other_row][row])).collect();
            let sum = |pairs: &[RowPair]| pairs.iter().map(|pair| pair.distance_m).sum::<f32>();
            let (one, other) = (best_row_pairs(&hills), best_row_pairs(&exchanged));
            prop_assert_eq!(one.len(), other.len());
            prop_assert!((sum(&one) - sum(&other)).abs() < 1e-3);
        }
    }

    #[test]
    fn a_cycle_corresponds_to_itself_at_equal_times() {
        let apart =
            |row: usize, other_row: usize| libm::cosf(TAU * (row as f32 - other_row as f32) / PHASE_COUNT as f32);
        let ring: Distances =
            (0..PHASE_COUNT).map(|row| std::array::from_fn(|other_row| 1.0 - apart(row, other_row))).collect();
        let found = best_row_pairs(&ring);
        assert!(found.len() > 1 && found.iter().all(|pair| pair.rows[0] == pair.rows[1]), "{found:?}");
    }
}
