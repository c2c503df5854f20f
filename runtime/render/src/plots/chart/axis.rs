//! Axes of plots: range, round ticks, and the text of numbers.

/// Usual distance of ticks, pixels.
const TICK_DISTANCE_PX: f32 = 80.0;
/// Least number of ticks; on a short axis they are closer.
const MIN_TICKS: f32 = 4.5;
/// Margin beyond the values on both ends of an axis, share of their range.
const MARGIN_SHARE: f32 = 0.08;

/// An axis: its label and range.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlotAxis {
    /// Quantity and unit, as in `forward speed, m/s`.
    pub(crate) label: String,
    /// Value at the left or lower end.
    pub(crate) low: f32,
    /// Value at the right or upper end.
    pub(crate) high: f32,
}

impl PlotAxis {
    pub(crate) fn new(label: &str, [low, high]: [f32; 2]) -> Self {
        Self { label: label.to_owned(), low, high }
    }

    /// An axis over all values with a margin on both ends; one unit long if all are equal.
    pub(crate) fn around(label: &str, values: impl Iterator<Item = f32>) -> Self {
        let [low, high] =
            values.map(|value| [value; 2]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or_default();
        let margin = if high - low > 1e-6 { MARGIN_SHARE * (high - low) } else { 0.5 };
        Self::new(label, [low - margin, high + margin])
    }

    /// Round distance of ticks on an axis of a length in pixels.
    pub(crate) fn tick_step(&self, length_px: f32) -> f32 {
        let count = (length_px / TICK_DISTANCE_PX).max(MIN_TICKS);
        round_step((self.high - self.low) / count)
    }

    /// Multiples of a step on the axis.
    pub(crate) fn ticks(&self, step: f32) -> Vec<f32> {
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        (first..=last).map(|index| index as f32 * step).collect()
    }
}

/// Least of 1, 2, 5, 10, … times a power of ten that is at least `least`.
fn round_step(least: f32) -> f32 {
    let power = libm::powf(10.0, libm::floorf(libm::log10f(least.max(1e-6))));
    [1.0, 2.0, 5.0].into_iter().map(|factor| factor * power).find(|step| *step >= 0.999 * least).unwrap_or(10.0 * power)
}

/// Text of a tick's value, with as many decimals as the step needs.
pub(crate) fn tick_text(value: f32, step: f32) -> String {
    number(value, (-libm::floorf(libm::log10f(step) + 1e-3)).max(0.0) as usize)
}

/// Text of a number, with a minus sign instead of a hyphen, and none before zero.
pub(crate) fn number(value: f32, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.trim_start_matches(['-', '0', '.']).is_empty();
    text.replace('-', if is_zero { "" } else { "−" })
}

/// Widens one of two axes so that a unit has the same length on both.
#[must_use]
pub(crate) fn equal_units(rect_px: [f32; 4], mut axes: [PlotAxis; 2]) -> [PlotAxis; 2] {
    let units_px = [0, 1].map(|index: usize| rect_px[2 + index] / (axes[index].high - axes[index].low));
    let common_px = units_px[0].min(units_px[1]);
    for (axis, unit_px) in axes.iter_mut().zip(units_px) {
        let widen = 0.5 * (axis.high - axis.low) * (unit_px / common_px - 1.0);
        (axis.low, axis.high) = (axis.low - widen, axis.high + widen);
    }
    axes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_axis() {
        let axis = PlotAxis::new("", [-0.31, 2.4]);
        assert_eq!(axis.ticks(axis.tick_step(6.0 * TICK_DISTANCE_PX)), [0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(tick_text(-0.5, 0.5), "−0.5");
        assert_eq!(tick_text(-0.0, 0.5), "0.0");
        assert_eq!(tick_text(20.0, 10.0), "20");
    }

    #[test]
    fn equal_units_are_equal_and_show_no_less() {
        let axes = [PlotAxis::new("", [0.0, 1.0]), PlotAxis::new("", [-2.0, 2.0])];
        let [x, y] = equal_units([0.0, 0.0, 300.0, 100.0], axes);
        assert!(((x.high - x.low) / 300.0 - (y.high - y.low) / 100.0).abs() < 1e-5);
        assert!(x.low <= 0.0 && x.high >= 1.0 && y.low <= -2.0 && y.high >= 2.0);
    }
}
