//! Correspondence times T between two examples (`FbCrowd` §5, Eq. 10): where synthesis may switch from one to the
//! other.
//!
//! The pairs of T are the local minima of the pose distance D ([`crate::motion::pose_distance`]) on the torus of both cycles,
//! as far as they are at most [`THRESHOLD_RATIO`] times the least; a cell is a minimum where none of the eight around
//! it is lower. Of minima that cannot all be passed in turn (monotone and cyclic in both) the greatest number is kept,
//! and of equal numbers those with the least sum of distances. Every step (from one mid-stance to the other) of either
//! cycle has a pair; where it has no minimum, the most alike poses of a step of one and a step of the other stand in,
//! as few as can be. The table from B to A is that from A to B with its columns exchanged.
//!
//! A body that stands has no steps of its own: its half-cycles count as steps, and each step of the other has a pair
//! with some time of standing.

use serde::{Deserialize, Serialize};

use crate::motion::motion_db::{MotionDb, PHASE_COUNT};
use crate::motion::pose_distance::{Distances, distances_m};

/// A minimum counts up to this multiple of the least distance of all.
pub const THRESHOLD_RATIO: f32 = 1.5;

/// Where m_sp and m_mb are most alike, so that synthesis may switch from one to the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Correspondence {
    /// m_sp: index of the example that semi-procedural locomotion deforms.
    pub semi_procedural: u32,
    /// m_mb: index of the other example nearest to it in (v_f, ω_t, ω_s).
    pub blending: u32,
    /// [t_sp, t_mb], seconds from phase 0 of each cycle, in order of t_sp; cyclic and monotone in both.
    pub pairs_s: Vec<[f32; 2]>,
}

impl Correspondence {
    /// m_sp as given, m_mb and T; none where no other cycle steps.
    pub fn of(db: &MotionDb, semi_procedural: usize) -> Option<Self> {
        let place = |example: usize| db.blend_space.scaled(db.examples[example].parameters);
        let distance = |example: &usize| place(*example).distance_squared(place(semi_procedural));
        let stepping = (0..db.examples.len()).filter(|&example| db.examples[example].key_times_s.is_some());
        let others = stepping.filter(|&example| example != semi_procedural);
        let blending = others.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let pairs_s = table(db, semi_procedural, blending).iter().map(|alike| alike.times_s).collect();
        Some(Self { semi_procedural: semi_procedural as u32, blending: blending as u32, pairs_s })
    }
}

/// Two poses that are alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alike {
    /// Seconds from phase 0 of each cycle.
    pub times_s: [f32; 2],
    /// D, metres.
    pub distance_m: f32,
}

/// T between two examples, in order of the first's times.
pub fn table(db: &MotionDb, from: usize, to: usize) -> Vec<Alike> {
    if from > to {
        let mut table = table(db, to, from);
        for alike in &mut table {
            alike.times_s.reverse();
        }
        table.sort_by(|a, b| a.times_s[0].total_cmp(&b.times_s[0]));
        return table;
    }
    let distances_m = distances_m(db, from, to);
    let time_s = |example: usize, row: usize| db.examples[example].phase_map.time_s(row as f32 / PHASE_COUNT as f32);
    let alike = |Cell { rows: [row, other_row], distance_m }: Cell| Alike {
        times_s: [time_s(from, row), time_s(to, other_row)],
        distance_m,
    };
    correspond(&distances_m).into_iter().map(alike).collect()
}

/// A pair of stored phases.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    rows: [usize; 2],
    distance_m: f32,
}

/// The pairs of T, in order of the first's rows.
fn correspond(distances_m: &Distances) -> Vec<Cell> {
    let minima = minima(distances_m);
    let stand_ins = stand_ins(distances_m).into_iter().filter(|cell| !minima.contains(cell));
    let candidates: Vec<Candidate> = minima
        .iter()
        .map(|&cell| Candidate { cell, is_minimum: true })
        .chain(stand_ins.map(|cell| Candidate { cell, is_minimum: false }))
        .collect();
    let mut best: Option<Chain> = None;
    for &first in &candidates {
        let chain = best_chain_from(first, &candidates);
        if let Some(chain) = chain.filter(|chain| best.as_ref().is_none_or(|best| chain.is_better(best))) {
            best = Some(chain);
        }
    }
    let mut cells = best.map_or_else(Vec::new, |chain| chain.cells);
    cells.sort_by_key(|cell| cell.rows);
    cells
}

/// Local minima under the threshold. Of equal neighbours the first counts.
fn minima(distances_m: &Distances) -> Vec<Cell> {
    let least_m = distances_m.iter().flatten().copied().fold(f32::INFINITY, f32::min);
    let rows = (0..PHASE_COUNT).flat_map(|row| (0..PHASE_COUNT).map(move |other_row| [row, other_row]));
    let cells = rows.map(|rows| Cell { rows, distance_m: distances_m[rows[0]][rows[1]] });
    let is_minimum = |cell: &Cell| {
        neighbours(cell.rows).all(|[row, other_row]| {
            let around_m = distances_m[row][other_row];
            cell.distance_m < around_m || (cell.distance_m == around_m && cell.rows < [row, other_row])
        })
    };
    cells.filter(|cell| cell.distance_m <= THRESHOLD_RATIO * least_m && is_minimum(cell)).collect()
}

/// The eight cells around one, on the torus.
fn neighbours([row, other_row]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    let around = [PHASE_COUNT - 1, 0, 1];
    let all = around.into_iter().flat_map(move |down| around.map(|aside| [down, aside]));
    all.filter(|shift| *shift != [0, 0])
        .map(move |[down, aside]| [(row + down) % PHASE_COUNT, (other_row + aside) % PHASE_COUNT])
}

/// The most alike poses of each step of one and each step of the other.
fn stand_ins(distances_m: &Distances) -> Vec<Cell> {
    const HALF: usize = PHASE_COUNT / 2;
    let blocks = [0, HALF].into_iter().flat_map(|first| [0, HALF].map(|other_first| [first, other_first]));
    let best = |[first, other_first]: [usize; 2]| {
        let cells = (first..first + HALF)
            .flat_map(|row| (other_first..other_first + HALF).map(move |other_row| [row, other_row]))
            .map(|rows| Cell { rows, distance_m: distances_m[rows[0]][rows[1]] });
        cells.min_by(|a, b| a.distance_m.total_cmp(&b.distance_m)).expect("a step has rows")
    };
    blocks.map(best).collect()
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    cell: Cell,
    is_minimum: bool,
}

/// Cells that can be passed in turn.
#[derive(Clone, Debug)]
struct Chain {
    cells: Vec<Cell>,
    minima: usize,
    sum_m: f32,
    /// A bit for each half of each cycle.
    steps: usize,
}

/// Bits of [`Chain::steps`]: both halves of both cycles.
const ALL_STEPS: usize = 0b1111;

impl Chain {
    fn with(&self, next: &Candidate) -> Self {
        let [row, other_row] = next.cell.rows.map(|row| usize::from(row >= PHASE_COUNT / 2));
        let mut chain = self.clone();
        chain.cells.push(next.cell);
        chain.minima += usize::from(next.is_minimum);
        chain.sum_m += next.cell.distance_m;
        chain.steps |= 0b01 << row | 0b0100 << other_row;
        chain
    }

    /// More minima, fewer stand-ins, nearer poses.
    fn is_better(&self, other: &Self) -> bool {
        let lengths = |chain: &Self| (chain.minima, std::cmp::Reverse(chain.cells.len()));
        lengths(self).cmp(&lengths(other)).then(other.sum_m.total_cmp(&self.sum_m)).is_gt()
    }
}

/// The best chain that starts at a candidate, goes once round both cycles and serves every step; none where there is
/// none. Longest rising subsequence, counted from the first cell, kept apart by the steps that are served.
fn best_chain_from(first: Candidate, candidates: &[Candidate]) -> Option<Chain> {
    let from_first = |cell: &Cell| {
        let offset = |axis: usize| (cell.rows[axis] + PHASE_COUNT - first.cell.rows[axis]) % PHASE_COUNT;
        [offset(0), offset(1)]
    };
    let mut later: Vec<([usize; 2], &Candidate)> =
        candidates.iter().map(|candidate| (from_first(&candidate.cell), candidate)).collect();
    later.retain(|([row, other_row], _)| *row > 0 && *other_row > 0);
    later.sort_by_key(|(offsets, _)| *offsets);
    let start = Chain { cells: Vec::new(), minima: 0, sum_m: 0.0, steps: 0 }.with(&first);
    let mut ends: Vec<([usize; 2], Vec<Chain>)> = vec![([0, 0], vec![start])];
    for (offsets, candidate) in later {
        let mut best: Vec<Chain> = Vec::new();
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

    /// A torus of hills: waves of few periods, each with its size, periods round both cycles and phases.
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

    /// Whether cells, in order of their rows, rise in both cycles and go round each once.
    fn is_cyclic(cells: &[Cell]) -> bool {
        let ways = |axis: usize| -> usize {
            let pairs = cells.iter().zip(cells.iter().cycle().skip(1));
            // From a cell to itself is once round.
            let way = |(a, b): (&Cell, &Cell)| (b.rows[axis] + PHASE_COUNT - a.rows[axis] - 1) % PHASE_COUNT + 1;
            pairs.map(way).sum()
        };
        ways(0) == PHASE_COUNT && ways(1) == PHASE_COUNT
    }

    fn serves_every_step(cells: &[Cell]) -> bool {
        let serves = |axis: usize, late: bool| cells.iter().any(|cell| (cell.rows[axis] >= PHASE_COUNT / 2) == late);
        [0, 1].iter().all(|&axis| serves(axis, false) && serves(axis, true))
    }

    /// The most minima that any set of them and of stand-ins holds which is cyclic and serves every step; all sets are
    /// tried.
    fn most_minima(minima: &[Cell], stand_ins: &[Cell]) -> usize {
        let all: Vec<Cell> = minima.iter().chain(stand_ins).copied().collect();
        let chosen = |set: usize| {
            let mut cells: Vec<Cell> = (0..all.len()).filter(|bit| set >> bit & 1 == 1).map(|bit| all[bit]).collect();
            cells.sort_by_key(|cell| cell.rows);
            cells
        };
        let sets = (1usize..1 << all.len()).filter(|set| {
            let cells = chosen(*set);
            is_cyclic(&cells) && serves_every_step(&cells)
        });
        sets.map(|set| (set & ((1 << minima.len()) - 1)).count_ones() as usize).max().unwrap()
    }

    fn wave() -> impl Strategy<Value = (f32, [u8; 2], [f32; 2])> {
        (0.2f32..1.0, [0u8..4, 0u8..4], [0.0f32..1.0, 0.0f32..1.0])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn minima_are_all_cells_under_the_threshold_that_none_around_them_undercuts(
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
                    prop_assert!(!is_strict || found.iter().any(|cell| cell.rows == [row, other_row]));
                }
            }
            prop_assert!(found.iter().all(|cell| cell.distance_m <= THRESHOLD_RATIO * least));
        }

        #[test]
        fn pairs_are_cyclic_serve_every_step_and_keep_as_many_minima_as_can_be(
            waves in prop::collection::vec(wave(), 1..5),
        ) {
            let hills = hills(&waves);
            let found = correspond(&hills);
            prop_assert!(is_cyclic(&found) && serves_every_step(&found), "{found:?}");
            let minima = minima(&hills);
            prop_assume!(minima.len() < 9);
            let stand_ins: Vec<Cell> = stand_ins(&hills).into_iter().filter(|cell| !minima.contains(cell)).collect();
            let kept = found.iter().filter(|cell| minima.contains(cell)).count();
            prop_assert_eq!(kept, most_minima(&minima, &stand_ins), "{:?} of {:?}", found, minima);
        }

        #[test]
        fn exchanging_the_cycles_exchanges_the_columns(waves in prop::collection::vec(wave(), 2..5)) {
            let hills = hills(&waves);
            let exchanged: Distances =
                (0..PHASE_COUNT).map(|row| std::array::from_fn(|other_row| hills[other_row][row])).collect();
            let sum = |cells: &[Cell]| cells.iter().map(|cell| cell.distance_m).sum::<f32>();
            let (one, other) = (correspond(&hills), correspond(&exchanged));
            prop_assert_eq!(one.len(), other.len());
            prop_assert!((sum(&one) - sum(&other)).abs() < 1e-3);
        }
    }

    #[test]
    fn a_cycle_corresponds_to_itself_at_equal_times() {
        let apart = |row: usize, other_row: usize| (TAU * (row as f32 - other_row as f32) / PHASE_COUNT as f32).cos();
        let ring: Distances =
            (0..PHASE_COUNT).map(|row| std::array::from_fn(|other_row| 1.0 - apart(row, other_row))).collect();
        let found = correspond(&ring);
        assert!(found.len() > 1 && found.iter().all(|cell| cell.rows[0] == cell.rows[1]), "{found:?}");
    }
}
