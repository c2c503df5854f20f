//! Whether two performances stir enough alike to be worth a comparison at all lags: two short rows of numbers tell.
//!
//! The stir of a stretch is the root mean square, over its samples, by which each coordinate of each direction leaves
//! its mean. Whatever the lag, the stirs a, b of two courses x, y lie no farther apart than the courses themselves,
//! |a − b| ≤ ‖x − y‖. The middle of the shorter clip is covered at every lag that is tried, so its stir must lie near
//! the box of the stirs of all stretches of the other that are as long.

use crate::dedup::performance::{DIRECTION_COUNT, Directions, MIRRORED, Performance};

/// Coordinates of all directions.
const WIDTH: usize = 3 * DIRECTION_COUNT;
/// Samples of the stretches that are told; clips whose covered middle is shorter tell nothing.
const STRETCHES: [usize; 9] = [10, 14, 20, 28, 40, 56, 80, 112, 160];
/// How far stirs of one take may lie apart, in stirs of the shorter clip. Of the copies in 151 clips they lie half as
/// far apart as the courses themselves, up to 0.10 where r is 0.19; r may be 0.23.
const APART_MAX: f64 = 0.2;
/// The same of whole clips, of which one may miss a tenth.
const WHOLE_APART_MAX: f64 = 0.25;

type Stir = [f32; WIDTH];

/// The stirs of a clip.
pub(crate) struct Stirs {
    samples: usize,
    whole: Stir,
    stretches: [Option<Stretches>; STRETCHES.len()],
}

/// What stretches of one length tell.
struct Stretches {
    /// Least and greatest of all.
    least: Stir,
    greatest: Stir,
    /// The mean of those side by side in the middle; none in a short clip.
    middle: Option<Stir>,
}

impl Stirs {
    /// `covered` tells how many samples in the middle of a clip of so many are covered at all lags.
    pub(crate) fn of(performance: &Performance, covered: impl Fn(usize) -> usize) -> Self {
        let sums = Sums::of(&performance.directions);
        let samples = performance.directions.len();
        let stretches =
            STRETCHES.map(|count| (count <= samples).then(|| Stretches::of(&sums, count, covered(samples))));
        Self { samples, whole: sums.stir(0, samples), stretches }
    }

    /// Whether the two may be one take, the other mirrored or not.
    pub(crate) fn may_be_alike(&self, other: &Self, mirrored: bool) -> bool {
        let (short, long) = if self.samples < other.samples { (self, other) } else { (other, self) };
        let both = short.stretches.iter().zip(&long.stretches).rev();
        let told = both.filter_map(|(short, long)| Some((short.as_ref()?.middle.as_ref()?, long.as_ref()?))).next();
        let Some((middle, long)) = told else { return true };
        let apart = long.squared_distance(&if mirrored { swapped(middle) } else { *middle });
        f64::from(apart) <= APART_MAX * APART_MAX * f64::from(squared(middle))
    }

    /// Whether the two may be the same frames at other times.
    pub(crate) fn may_have_the_same_frames(&self, other: &Self, mirrored: bool) -> bool {
        let told = if mirrored { swapped(&self.whole) } else { self.whole };
        let apart: f32 = told.iter().zip(&other.whole).map(|(a, b)| (a - b) * (a - b)).sum();
        let limit = WHOLE_APART_MAX * WHOLE_APART_MAX;
        f64::from(apart) <= limit * f64::from(squared(&self.whole).max(squared(&other.whole)))
    }
}

impl Stretches {
    fn of(sums: &Sums, count: usize, covered: usize) -> Self {
        let samples = sums.of_squares.len() - 1;
        let (mut least, mut greatest) = ([f32::INFINITY; WIDTH], [0.0_f32; WIDTH]);
        for from in 0..=samples - count {
            let stir = sums.stir(from, count);
            for index in 0..WIDTH {
                least[index] = least[index].min(stir[index]);
                greatest[index] = greatest[index].max(stir[index]);
            }
        }
        let beside = covered / count;
        let first = (samples - beside * count) / 2;
        let middle = (0..beside).fold([0.0; WIDTH], |sum, index| {
            let stir = sums.stir(first + index * count, count);
            std::array::from_fn(|at| sum[at] + stir[at] / beside as f32)
        });
        Self { least, greatest, middle: (beside > 0).then_some(middle) }
    }

    /// From a stir to the nearest in the box.
    fn squared_distance(&self, stir: &Stir) -> f32 {
        let outside = |index: usize| (self.least[index] - stir[index]).max(stir[index] - self.greatest[index]).max(0.0);
        (0..WIDTH).map(|index| outside(index) * outside(index)).sum()
    }
}

/// Running sums of all coordinates and of their squares.
struct Sums {
    of_values: Vec<[f64; WIDTH]>,
    of_squares: Vec<[f64; WIDTH]>,
}

impl Sums {
    fn of(directions: &[Directions]) -> Self {
        let (mut of_values, mut of_squares) = (vec![[0.0; WIDTH]], vec![[0.0; WIDTH]]);
        for (index, row) in directions.iter().enumerate() {
            let value = |at: usize| row[at / 3][at % 3];
            let (values, squares) = (&of_values[index], &of_squares[index]);
            let next = std::array::from_fn(|at| values[at] + value(at));
            let next_square = std::array::from_fn(|at| squares[at] + value(at) * value(at));
            of_values.push(next);
            of_squares.push(next_square);
        }
        Self { of_values, of_squares }
    }

    fn stir(&self, from: usize, count: usize) -> Stir {
        let between = |sums: &[[f64; WIDTH]], at: usize| (sums[from + count][at] - sums[from][at]) / count as f64;
        std::array::from_fn(|at| {
            let mean = between(&self.of_values, at);
            libm::sqrt((between(&self.of_squares, at) - mean * mean).max(0.0)) as f32
        })
    }
}

/// The stir in a mirror: to the left is as far as to the right.
fn swapped(stir: &Stir) -> Stir {
    std::array::from_fn(|at| stir[3 * MIRRORED[at / 3] + at % 3])
}

fn squared(stir: &Stir) -> f32 {
    stir.iter().map(|value| value * value).sum()
}
