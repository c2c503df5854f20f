//! The screening of [`crate::dedup::duplicates`]: where in time the legs of two performances are most alike, fast.
//!
//! r² of [`crate::dedup::performance`], of the legs alone, forward and to the left: with running sums of the samples and of
//! their squares only the sum of products is left to be computed at each lag, and movements of different size are
//! passed over. Most lags are passed over by less: by a few seconds of the shorter clip, told in eight numbers each.

use crate::dedup::performance::{self, LEG_DIRECTION_COUNT, Performance};

/// Greatest r that is worth an exact comparison: half a step of the screening's lag, 25 ms, costs a run of two strides
/// a second 0.3, retargeting 0.2.
pub(crate) const SCREEN_MAX: f64 = 0.45;
/// Share of the shorter clip that both must show.
const OVERLAP_SHARE: f64 = 0.8;
/// Numbers a sample: of each direction of the legs how far it points forward and to the left.
const WIDTH: usize = 2 * LEG_DIRECTION_COUNT;
/// Greatest r².
const LIMIT: f32 = (SCREEN_MAX * SCREEN_MAX) as f32;
/// Samples of a second, and how many seconds of a long clip are looked at before all of it is.
const SECOND: usize = 20;
const SECONDS_MAX: usize = 8;

/// The legs' directions about their mean over the clip, with running sums of them and of their squares.
pub(crate) struct Outline {
    /// From each sample on that a second is left of.
    seconds: Vec<Second>,
    samples: Vec<[f32; WIDTH]>,
    sums: Vec<[f32; WIDTH]>,
    squares: Vec<f32>,
}

impl Outline {
    pub(crate) fn of(performance: &Performance) -> Self {
        let flat =
            |row: &performance::Directions| std::array::from_fn(|index| row[index / 2].to_array()[index % 2] as f32);
        let mut samples: Vec<[f32; WIDTH]> = performance.directions.iter().map(flat).collect();
        let count = samples.len() as f32;
        let total = samples.iter().fold([0.0; WIDTH], |sum, row| plus(&sum, row));
        for row in &mut samples {
            *row = std::array::from_fn(|index| row[index] - total[index] / count);
        }
        let (mut sums, mut squares) = (vec![[0.0; WIDTH]], vec![0.0]);
        for (index, row) in samples.iter().enumerate() {
            sums.push(plus(&sums[index], row));
            squares.push(squares[index] + product(row, row));
        }
        let mut outline = Self { seconds: Vec::new(), samples, sums, squares };
        let angle = |sample: usize| std::f32::consts::TAU * sample as f32 / SECOND as f32;
        let circle = std::array::from_fn(|sample| libm::sincosf(angle(sample)));
        let starts = 0..(outline.samples.len() + 1).saturating_sub(SECOND);
        outline.seconds = starts.map(|from| outline.second(from, &circle)).collect();
        outline
    }

    fn second(&self, from: usize, circle: &[(f32, f32); SECOND]) -> Second {
        let scale = libm::sqrtf(2.0 / SECOND as f32);
        let mut wave = [0.0; WIDTH];
        for (row, (sine, cosine)) in self.samples[from..from + SECOND].iter().zip(circle) {
            for direction in 0..LEG_DIRECTION_COUNT {
                wave[2 * direction] += scale * cosine * row[2 * direction];
                wave[2 * direction + 1] += scale * sine * row[2 * direction];
            }
        }
        Second { wave, size: libm::sqrtf(self.moments(from, SECOND).1) }
    }

    /// The sum over samples, and the sum of squares about their mean.
    fn moments(&self, from: usize, count: usize) -> ([f32; WIDTH], f32) {
        let (before, after) = (&self.sums[from], &self.sums[from + count]);
        let sum = std::array::from_fn(|index| after[index] - before[index]);
        let about_mean = self.squares[from + count] - self.squares[from] - product(&sum, &sum) / count as f32;
        (sum, about_mean.max(0.0))
    }
}

fn plus(a: &[f32; WIDTH], b: &[f32; WIDTH]) -> [f32; WIDTH] {
    std::array::from_fn(|index| a[index] + b[index])
}

fn product(a: &[f32; WIDTH], b: &[f32; WIDTH]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The second from a sample on, in short: r² of the legs over a second is at least
///
/// ```text
/// |wave − wave'|² / (size · size'),
/// ```
///
/// since the waves are orthogonal projections.
#[derive(Clone, Copy)]
struct Second {
    /// How the directions swing forward with a period of a second: cosine and sine of each.
    wave: [f32; WIDTH],
    /// Root of the sum of all squares about the mean.
    size: f32,
}

/// The lag, in samples of the screening, at which the legs are most alike; none where they never are.
pub(crate) fn nearest_lag(one: &Outline, other: &Outline) -> Option<isize> {
    let (count, other_count) = (one.samples.len() as isize, other.samples.len() as isize);
    let least = least_overlap(one.samples.len().min(other.samples.len())) as isize;
    let of_short = |(short, long): (&Outline, &Outline), sign: isize| {
        let offsets = least - short.samples.len() as isize..=long.samples.len() as isize - least;
        let found = offsets.filter(|&offset| middle_may_be_alike(short, long, offset));
        let found = found.filter_map(|offset| Some((sign * offset, leg_unlikeness(one, other, sign * offset)?)));
        found.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(lag, _)| lag)
    };
    if count < other_count { of_short((one, other), -1) } else { of_short((other, one), 1) }
}

/// Whether the seconds in the middle of the shorter, taken together, may be what the longer shows there: a rest among
/// them, all noise, weighs nothing.
fn middle_may_be_alike(short: &Outline, long: &Outline, offset: isize) -> bool {
    let (mut between, mut sizes) = (0.0, 0.0);
    for from in middle_seconds(short.samples.len()) {
        let (a, b) = (&short.seconds[from], &long.seconds[(from as isize + offset) as usize]);
        between += a.wave.iter().zip(&b.wave).map(|(a, b)| (a - b) * (a - b)).sum::<f32>();
        sizes += a.size * b.size;
    }
    between <= LIMIT * sizes
}

/// Where the seconds begin that are looked at: spread over the part of a clip that every lag leaves covered; none in
/// clips of less than 1.7 s.
fn middle_seconds(count: usize) -> impl Iterator<Item = usize> {
    let covered = covered(count);
    let seconds = (covered / SECOND).min(SECONDS_MAX);
    let apart = covered / seconds.max(1);
    (0..seconds).map(move |index| (count - seconds * apart) / 2 + index * apart)
}

/// Samples in the middle of a clip of so many that every lag leaves covered, where it is the shorter.
pub(crate) fn covered(count: usize) -> usize {
    (2 * least_overlap(count)).saturating_sub(count)
}

/// Samples of the shorter clip that both must show.
fn least_overlap(count: usize) -> usize {
    ((count as f64 * OVERLAP_SHARE) as usize).max(1)
}

/// r² of the legs; none where it is beyond the limit.
fn leg_unlikeness(one: &Outline, other: &Outline, lag: isize) -> Option<f32> {
    let (from, other_from, count) = performance::overlap(one.samples.len(), other.samples.len(), lag)?;
    let ((sum_a, of_a), (sum_b, of_b)) = (one.moments(from, count), other.moments(other_from, count));
    let geometric = libm::sqrtf(of_a * of_b);
    // By Cauchy and Schwarz no lag makes up for movements of different size.
    if of_a + of_b - 2.0 * geometric > LIMIT * geometric {
        return None;
    }
    let mut products = [0.0; WIDTH];
    for (a, b) in one.samples[from..from + count].iter().zip(&other.samples[other_from..other_from + count]) {
        for index in 0..WIDTH {
            products[index] += a[index] * b[index];
        }
    }
    let between = products.iter().sum::<f32>() - product(&sum_a, &sum_b) / count as f32;
    let unlikeness = (of_a + of_b - 2.0 * between) / geometric;
    (unlikeness <= LIMIT).then_some(unlikeness)
}
