//! Statistics of samples: median, mean and standard deviation, and the share for which something holds.

use schemars::JsonSchema;
use serde::Serialize;

/// The middle value, as [`motiondb::statistics`] has it; none without values.
pub fn median(values: impl Iterator<Item = f32>) -> Option<f32> {
    motiondb::statistics::median(values.map(f64::from)).map(|middle| middle as f32)
}

/// Mean and standard deviation of a sample.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Spread {
    /// Mean of the sample.
    pub mean: f64,
    /// Standard deviation of the sample, with n − 1; 0 for a single value.
    pub deviation: f64,
}

/// Mean and standard deviation; none without values.
pub fn spread(values: impl Iterator<Item = f64> + Clone) -> Option<Spread> {
    let count = values.clone().count();
    let mean = values.clone().sum::<f64>() / count as f64;
    let squares = values.map(|value| (value - mean) * (value - mean)).sum::<f64>();
    (count > 0).then(|| Spread { mean, deviation: (squares / count.saturating_sub(1).max(1) as f64).sqrt() })
}

/// Mean and standard deviation of a measure over items that have it; none where no item has.
pub(crate) fn spread_of<T>(items: &[T], figure: impl Fn(&T) -> Option<f64>) -> Option<Spread> {
    let values: Vec<f64> = items.iter().filter_map(figure).collect();
    spread(values.into_iter())
}

/// Mean; none without values.
pub(crate) fn mean(values: impl Iterator<Item = f64> + Clone) -> Option<f64> {
    spread(values).map(|spread| spread.mean)
}

/// The share of items for which something holds, 0 to 1; none without items.
pub fn share<T>(items: impl Iterator<Item = T>, holds: impl Fn(&T) -> bool) -> Option<f64> {
    let (mut count, mut holding) = (0_usize, 0_usize);
    for item in items {
        count += 1;
        holding += usize::from(holds(&item));
    }
    (count > 0).then(|| holding as f64 / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreads_and_shares_of_small_samples() {
        assert_eq!(share([1, 2, 3, 4].into_iter(), |number| number % 2 == 0), Some(0.5));
        assert_eq!(spread([1.0, 2.0, 3.0].into_iter()), Some(Spread { mean: 2.0, deviation: 1.0 }));
        assert_eq!(spread([4.0].into_iter()), Some(Spread { mean: 4.0, deviation: 0.0 }));
        assert_eq!(spread(std::iter::empty()), None);
        assert_eq!(share(std::iter::empty::<u8>(), |_| true), None);
    }
}
