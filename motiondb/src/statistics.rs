//! Statistics of small samples: mean, median, percentile.
//!
//! Values enter in any order of size; a result is `None` where there is no value. Sums run in the order of the values and
//! sorting uses the total order of floats, so that equal input gives equal bytes.

use std::iter::Sum;
use std::ops::Div;

/// The arithmetic mean of numbers or of vectors (`f64`, `glam::DVec2`, `glam::DVec3`).
pub fn mean<T: Sum + Div<f64, Output = T>>(values: impl IntoIterator<Item = T>) -> Option<T> {
    let mut count = 0_usize;
    let sum: T = values.into_iter().inspect(|_| count += 1).sum();
    (count > 0).then(|| sum / count as f64)
}

/// The middle value; of an even number of values the mean of the two in the middle.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let sorted = sorted(values);
    let last = sorted.len().checked_sub(1)?;
    Some(0.5 * (sorted[last / 2] + sorted[sorted.len() / 2]))
}

/// The value below which a share (0 to 1) of all values lies: no interpolation, of two neighbours the greater.
pub fn percentile(values: impl IntoIterator<Item = f64>, share: f64) -> Option<f64> {
    let sorted = sorted(values);
    let last = sorted.len().checked_sub(1)?;
    Some(sorted[((share * sorted.len() as f64) as usize).min(last)])
}

/// The sorted value at position `share` · (count − 1), rounded down: share 0 gives the least value, 1 the greatest.
pub fn lower_quantile(values: impl IntoIterator<Item = f64>, share: f64) -> Option<f64> {
    let sorted = sorted(values);
    let last = sorted.len().checked_sub(1)?;
    Some(sorted[(share * last as f64) as usize])
}

fn sorted(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_of_numbers_and_of_vectors() {
        assert_eq!(mean([1.0, 2.0, 6.0]), Some(3.0));
        assert_eq!(mean([glam::DVec2::X, glam::DVec2::Y]), Some(glam::DVec2::splat(0.5)));
        assert_eq!(mean::<f64>([]), None);
    }

    #[test]
    fn medians_of_even_counts_lie_between_two_values() {
        assert_eq!(median([3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median([4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median([]), None);
    }

    #[test]
    fn percentiles_are_values_of_the_sample() {
        assert_eq!(
            [0.0, 0.5, 0.99, 1.0].map(|share| percentile([4.0, 1.0, 2.0, 3.0], share)),
            [Some(1.0), Some(3.0), Some(4.0), Some(4.0)]
        );
        assert_eq!(percentile([], 0.5), None);
    }

    #[test]
    fn lower_quantiles_are_values_of_the_sample() {
        assert_eq!(lower_quantile([4.0, 1.0, 3.0, 2.0], 0.5), Some(2.0));
        assert_eq!(lower_quantile([4.0, 1.0, 3.0, 2.0], 1.0), Some(4.0));
        assert_eq!(lower_quantile([], 0.5), None);
    }
}
