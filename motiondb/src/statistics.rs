//! Statistics of a sample: mean, standard deviation, median, percentile. Values carry any unit; results have the same.
//!
//! An empty sample has none of them: each function returns `None`. Sums run in the order of the values, and sorting
//! uses the total order of floats, so equal input gives equal bytes.

use std::iter::Sum;
use std::ops::Div;

/// Arithmetic mean of numbers or of vectors (`f64`, `glam::DVec2`, `glam::DVec3`).
///
/// ```
/// use glam::DVec2;
/// use motiondb::statistics::mean;
///
/// assert_eq!(mean([1.0, 2.0, 6.0]), Some(3.0));
/// assert_eq!(mean([DVec2::X, DVec2::Y]), Some(DVec2::splat(0.5)));
/// ```
pub fn mean<T: Sum + Div<f64, Output = T>>(values: impl IntoIterator<Item = T>) -> Option<T> {
    let mut count = 0_usize;
    let sum: T = values.into_iter().inspect(|_| count += 1).sum();
    (count > 0).then(|| sum / count as f64)
}

/// Standard deviation of a sample: the divisor is n − 1. A single value has 0.
///
/// ```
/// assert_eq!(motiondb::statistics::standard_deviation([1.0, 2.0, 3.0]), Some(1.0));
/// ```
pub fn standard_deviation(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let values: Vec<f64> = values.into_iter().collect();
    let mean = mean(values.iter().copied())?;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    Some(libm::sqrt(squares / values.len().saturating_sub(1).max(1) as f64))
}

/// Middle value of the sorted sample; of an even number, the mean of the two in the middle.
///
/// ```
/// assert_eq!(motiondb::statistics::median([4.0, 1.0, 2.0, 3.0]), Some(2.5));
/// ```
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let sorted = sorted(values);
    let last = sorted.len().checked_sub(1)?;
    Some(0.5 * (sorted[last / 2] + sorted[sorted.len() / 2]))
}

/// Value of the sorted sample at the index ⌊`share` · n⌋: a `share` from 0 to 1 of the sample lies below it.
///
/// ```
/// assert_eq!(motiondb::statistics::percentile([5.0, 1.0, 2.0, 4.0, 3.0], 0.2), Some(2.0));
/// ```
pub fn percentile(values: impl IntoIterator<Item = f64>, share: f64) -> Option<f64> {
    let sorted = sorted(values);
    let last = sorted.len().checked_sub(1)?;
    Some(sorted[((share * sorted.len() as f64) as usize).min(last)])
}

/// Value of the sorted sample at the index ⌊`share` · (n − 1)⌋: 0 gives the least value, 1 the greatest.
///
/// ```
/// assert_eq!(motiondb::statistics::lower_quantile([4.0, 1.0, 3.0, 2.0], 0.5), Some(2.0));
/// ```
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
    fn an_empty_sample_has_no_statistics() {
        for statistic in [mean([]), standard_deviation([]), median([]), percentile([], 0.5)] {
            assert_eq!(statistic, None);
        }
    }

    #[test]
    fn median_of_odd_sample_is_middle_value() {
        assert_eq!(median([3.0, 1.0, 2.0]), Some(2.0));
    }

    #[test]
    fn one_value_deviates_by_nothing() {
        assert_eq!((standard_deviation([4.0]), mean([4.0])), (Some(0.0), Some(4.0)));
        assert!((standard_deviation([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]).unwrap() - 2.138).abs() < 1e-3);
    }

    #[test]
    fn percentiles_stay_within_the_sample() {
        let values = [30.0, 10.0, 20.0];
        assert_eq!([0.0, 0.34, 0.67, 1.0].map(|share| percentile(values, share)), [10.0, 20.0, 30.0, 30.0].map(Some));
    }

    #[test]
    fn a_lower_quantile_is_one_of_the_values() {
        assert_eq!(lower_quantile([4.0, 1.0, 3.0, 2.0], 0.5), Some(2.0));
        assert_eq!(lower_quantile([4.0, 1.0, 3.0, 2.0], 1.0), Some(4.0));
        assert_eq!(lower_quantile([], 0.5), None);
    }
}
