//! Figures of many figures: the median, mean and spread, and the share of which something holds.

/// [`motiondb::statistics`] of figures in single precision.
pub(crate) fn median(values: impl Iterator<Item = f32>) -> Option<f32> {
    motiondb::statistics::median(values.map(f64::from)).map(|middle| middle as f32)
}

/// Mean and standard deviation of a sample.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub(crate) struct Spread {
    pub(crate) mean: f64,
    /// With n − 1; 0 of a single value.
    pub(crate) deviation: f64,
}

/// None of none.
pub(crate) fn spread(values: impl Iterator<Item = f64> + Clone) -> Option<Spread> {
    let count = values.clone().count();
    let mean = values.clone().sum::<f64>() / count as f64;
    let squares = values.map(|value| (value - mean) * (value - mean)).sum::<f64>();
    (count > 0).then(|| Spread { mean, deviation: (squares / count.saturating_sub(1).max(1) as f64).sqrt() })
}

/// The share of all for which something holds; none where there is nothing.
pub(crate) fn share<T>(all: impl Iterator<Item = T>, holds: impl Fn(&T) -> bool) -> Option<f64> {
    let (mut count, mut holding) = (0_usize, 0_usize);
    for one in all {
        count += 1;
        holding += usize::from(holds(&one));
    }
    (count > 0).then(|| holding as f64 / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreads_are_of_samples_and_shares_count_what_holds() {
        assert_eq!(share([1, 2, 3, 4].into_iter(), |number| number % 2 == 0), Some(0.5));
        assert_eq!(spread([1.0, 2.0, 3.0].into_iter()), Some(Spread { mean: 2.0, deviation: 1.0 }));
        assert_eq!(spread([4.0].into_iter()), Some(Spread { mean: 4.0, deviation: 0.0 }));
        assert_eq!(spread(std::iter::empty()), None);
        assert_eq!(share(std::iter::empty::<u8>(), |_| true), None);
    }
}
