//! Unlikeness of two motion signatures at a lag, by their normalised cross-correlation.
//!
//! With a, b the directions of both, ‾ their mean over the common rows and ρ their normalised cross-correlation, the
//! unlikeness r is
//!
//! ```text
//! r² = Σ|(a − a‾) − (b − b‾)|² / √(A·B) = (A + B) / √(A·B) − 2ρ,  A = Σ|a − a‾|²,  B = Σ|b − b‾|²,
//! ```
//!
//! 0 for a copy and √2 for unrelated motions. The means are subtracted because retargeting tilts a limb by a constant
//! 2–6°.
//!
//! 1. Coarse screening rejects most lags. It compares *probes*: 16 rows of the shorter clip, one from each sixteenth of
//!    its movement, and of them only how far thighs and shanks point forward.
//! 2. A and B, from running sums, reject movements of different size.
//! 3. The sum over all rows decides. It stops where it exceeds the limit.

use std::f32::consts::PI;

use crate::dedup::signature::{DIRECTION_COUNT, FACING, LEG_COUNT, Row, WIDTH};

/// Share of the shorter clip that both clips must show.
const OVERLAP_SHARE: f64 = 0.8;
/// Number of probes of a clip.
const PROBE_COUNT: usize = 16;
/// Number of probes between two checks of the limit.
const PROBES_PER_CHECK: usize = 4;
/// Greatest r² of the probes. At the nearest lag in rows, at most 25 ms off, that of copies is below 0.3.
const PROBES_MAX: f32 = 0.5;
/// Root mean square deviation of directions from their mean below which a clip has no motion to compare, rad: 0.2°.
const STILL_RAD: f32 = 0.2 * PI / 180.0;
/// Distance of rows that are summed between two checks of the limit: neighbouring rows are alike.
const ROW_STEP: usize = 16;

/// Forward coordinates of thighs and shanks.
type Legs = [f32; LEG_COUNT];

/// A motion signature, ready for comparison at all lags.
pub(crate) struct Series {
    /// Rows of the signature about their mean.
    pub(crate) rows: Vec<Row>,
    /// Mean of the signature; none where only its rows about their mean are known.
    mean: Option<Row>,
    /// Running sums of the rows.
    sums: Vec<Row>,
    /// Running sums of the squares of the rows' directions.
    squares: Vec<f32>,
    /// Forward coordinates of the legs, of each row.
    legs: Vec<Legs>,
    /// Indices of the probes' rows.
    probes: Vec<usize>,
    /// Sum of squares of the probes about their mean.
    probe_squares: f32,
}

impl Series {
    /// Prepares a signature.
    pub(crate) fn of(rows: &[Row]) -> Self {
        let mean = mean(rows);
        Self { mean: Some(mean), ..Self::about(rows, &mean) }
    }

    /// Prepares a signature of which only rows about a mean are known.
    pub(crate) fn about_mean(rows: &[Row]) -> Self {
        Self::about(rows, &mean(rows))
    }

    fn about(rows: &[Row], mean: &Row) -> Self {
        let rows: Vec<Row> = rows.iter().map(|row| minus(row, mean)).collect();
        let (mut sums, mut squares) = (vec![[0.0; WIDTH]], vec![0.0]);
        for (index, row) in rows.iter().enumerate() {
            sums.push(std::array::from_fn(|at| sums[index][at] + row[at]));
            squares.push(squares[index] + row[..FACING].iter().map(|value| value * value).sum::<f32>());
        }
        let legs: Vec<Legs> = rows.iter().map(|row| std::array::from_fn(|leg| row[leg])).collect();
        let probes = probes(&legs);
        let mut probed = Squares::default();
        probes.iter().for_each(|&probe| probed.add(legs[probe]));
        Self { probe_squares: probed.about_mean(), rows, mean: None, sums, squares, legs, probes }
    }

    /// Mean of `count` rows, and sum of squares of their directions about it.
    fn moments(&self, from: usize, count: usize) -> (Row, f32) {
        let (before, after) = (&self.sums[from], &self.sums[from + count]);
        let mean: Row = std::array::from_fn(|at| (after[at] - before[at]) / count as f32);
        let of_mean = count as f32 * mean[..FACING].iter().map(|value| value * value).sum::<f32>();
        (mean, (self.squares[from + count] - self.squares[from] - of_mean).max(0.0))
    }

    /// Mean of `count` rows of the signature, if it is known.
    pub(crate) fn mean_of(&self, from: usize, count: usize) -> Option<Row> {
        let (mean, (about_mean, _)) = (self.mean?, self.moments(from, count));
        Some(std::array::from_fn(|at| mean[at] + about_mean[at]))
    }

    /// Lags, in rows of this longer series, at which it covers most of a shorter one.
    pub(crate) fn lags_of(&self, shorter: &Self) -> std::ops::RangeInclusive<isize> {
        let least = least_overlap(shorter.rows.len()) as isize;
        least - shorter.rows.len() as isize..=self.rows.len() as isize - least
    }

    /// Whether the probes are like the rows of a longer series at a lag.
    fn probes_are_alike(&self, longer: &Self, lag: isize) -> bool {
        let mut apart = Squares::default();
        self.probes.chunks(PROBES_PER_CHECK).all(|probes| {
            for &probe in probes {
                let (a, b) = (&self.legs[probe], &longer.legs[(probe as isize + lag) as usize]);
                apart.add(std::array::from_fn(|leg| a[leg] - b[leg]));
            }
            // Further probes only add to this sum.
            apart.about_mean() <= PROBES_MAX * self.probe_squares
        })
    }
}

/// r² where row 0 of the shorter series meets row `lag` of the longer one. `None` where r² exceeds `limit` or a clip is
/// still.
pub(crate) fn squared_unlikeness(shorter: &Series, longer: &Series, lag: isize, limit: f32) -> Option<f32> {
    if !shorter.probes_are_alike(longer, lag) {
        return None;
    }
    let [from, longer_from] = [(-lag).max(0) as usize, lag.max(0) as usize];
    let count = (shorter.rows.len() - from).min(longer.rows.len() - longer_from);
    if count == 0 {
        return None;
    }
    let ((mean, of_a), (longer_mean, of_b)) = (shorter.moments(from, count), longer.moments(longer_from, count));
    let geometric = libm::sqrtf(of_a * of_b);
    let (still, most) = (STILL_RAD * STILL_RAD * (count * DIRECTION_COUNT) as f32, limit * geometric);
    // ρ ≤ 1 (Cauchy–Schwarz), so r² is at least this.
    if geometric <= still || of_a + of_b - 2.0 * geometric > most {
        return None;
    }
    let mean_apart = minus(&mean, &longer_mean);
    let (rows, longer_rows) = (&shorter.rows[from..from + count], &longer.rows[longer_from..longer_from + count]);
    let mut sum = 0.0;
    for first in 0..ROW_STEP.min(count) {
        let pairs = rows[first..].iter().step_by(ROW_STEP).zip(longer_rows[first..].iter().step_by(ROW_STEP));
        let mut squares = [0.0; FACING];
        for (a, b) in pairs {
            for at in 0..FACING {
                let apart = a[at] - b[at] - mean_apart[at];
                squares[at] += apart * apart;
            }
        }
        sum += total(&squares);
        if sum > most {
            return None;
        }
    }
    Some(sum / geometric)
}

/// Sum of the coordinates' squares, four at a time: one after the other, each addition would wait for the one before.
fn total(squares: &[f32; FACING]) -> f32 {
    let mut sums = [0.0; 4];
    for four in squares.chunks_exact(sums.len()) {
        sums.iter_mut().zip(four).for_each(|(sum, square)| *sum += square);
    }
    sums.iter().sum()
}

/// Number of rows of the shorter of two clips that both must show.
fn least_overlap(count: usize) -> usize {
    libm::ceil(count as f64 * OVERLAP_SHARE) as usize
}

/// Row in the middle of each of [`PROBE_COUNT`] equal shares of the movement, among the rows that all lags cover.
fn probes(legs: &[Legs]) -> Vec<usize> {
    let covered = legs.len() - least_overlap(legs.len())..least_overlap(legs.len());
    let movement = |row: usize| legs[row].iter().map(|value| value * value).sum::<f32>();
    let share = covered.clone().map(movement).sum::<f32>() / PROBE_COUNT as f32;
    let (mut probes, mut moved) = (Vec::new(), 0.0);
    for row in covered {
        moved += movement(row);
        if moved > share * (probes.len() as f32 + 0.5) {
            probes.push(row);
        }
    }
    probes
}

/// Sums of values and of their squares over probes.
#[derive(Default)]
struct Squares {
    count: f32,
    sums: Legs,
    squares: Legs,
}

impl Squares {
    fn add(&mut self, legs: Legs) {
        self.count += 1.0;
        self.sums.iter_mut().zip(&legs).for_each(|(sum, value)| *sum += value);
        self.squares.iter_mut().zip(&legs).for_each(|(sum, value)| *sum += value * value);
    }

    /// Sum of squares about the mean.
    fn about_mean(&self) -> f32 {
        (0..LEG_COUNT).map(|leg| self.squares[leg] - self.sums[leg] * self.sums[leg] / self.count).sum()
    }
}

/// Mean of all rows.
fn mean(rows: &[Row]) -> Row {
    let sum = rows.iter().fold([0.0; WIDTH], |sum, row| std::array::from_fn(|at| sum[at] + f64::from(row[at])));
    sum.map(|sum| (sum / rows.len() as f64) as f32)
}

fn minus(a: &Row, b: &Row) -> Row {
    std::array::from_fn(|at| a[at] - b[at])
}
