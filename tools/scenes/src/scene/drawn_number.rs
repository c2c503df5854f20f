//! Numbers that are fixed or drawn for each agent.

/// Standard deviations about the mean that bound a normal distribution without bounds; as in scenario files.
const DEVIATIONS: f64 = 3.0;

/// A number that is fixed or drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DrawnNumber {
    /// The same for all.
    Constant(f64),
    /// Uniform between two numbers.
    Uniform {
        /// Least number.
        from: f64,
        /// Greatest number.
        to: f64,
    },
    /// Normal about a mean.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        deviation: f64,
        /// Least number, where it is stated.
        min: Option<f64>,
        /// Greatest number, where it is stated.
        max: Option<f64>,
    },
}

impl DrawnNumber {
    /// The number, where it is fixed.
    pub fn constant(self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(value),
            Self::Uniform { from, to } => (from == to).then_some(from),
            Self::Normal { mean, deviation, .. } => (deviation == 0.0).then_some(mean),
        }
    }

    /// Mean of the numbers; bounds of a normal distribution are left out.
    pub fn mean(self) -> f64 {
        match self {
            Self::Constant(value) => value,
            Self::Uniform { from, to } => 0.5 * (from + to),
            Self::Normal { mean, .. } => mean,
        }
    }

    /// Mean of the squares; bounds of a normal distribution are left out.
    pub fn mean_square(self) -> f64 {
        match self {
            Self::Constant(value) => value * value,
            Self::Uniform { from, to } => (from * from + from * to + to * to) / 3.0,
            Self::Normal { mean, deviation, .. } => mean * mean + deviation * deviation,
        }
    }

    /// Least and greatest number.
    pub fn bounds(self) -> [f64; 2] {
        match self {
            Self::Constant(value) => [value, value],
            Self::Uniform { from, to } => [from, to],
            Self::Normal { mean, deviation, min, max } => {
                [min.unwrap_or(mean - DEVIATIONS * deviation), max.unwrap_or(mean + DEVIATIONS * deviation)]
            }
        }
    }

    /// The numbers times a factor.
    pub fn scaled(self, factor: f64) -> Self {
        self.mapped(|value| value * factor, factor)
    }

    /// The numbers plus an offset.
    pub fn shifted(self, offset: f64) -> Self {
        self.mapped(|value| value + offset, 1.0)
    }

    fn mapped(self, map: impl Fn(f64) -> f64, spread: f64) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(map(value)),
            Self::Uniform { from, to } => Self::Uniform { from: map(from), to: map(to) },
            Self::Normal { mean, deviation, min, max } => {
                Self::Normal { mean: map(mean), deviation: deviation * spread, min: min.map(&map), max: max.map(&map) }
            }
        }
    }

    /// The numbers cut to a range; none where they lie within it.
    pub fn cut(self, least: f64, greatest: f64) -> Option<Self> {
        let [low, high] = self.bounds();
        if least <= low && high <= greatest {
            return None;
        }
        let clamp = |value: f64| value.clamp(least, greatest);
        Some(match self {
            Self::Constant(value) => Self::Constant(clamp(value)),
            Self::Uniform { from, to } => Self::Uniform { from: clamp(from), to: clamp(to) },
            Self::Normal { mean, deviation, .. } => {
                Self::Normal { mean: clamp(mean), deviation, min: Some(clamp(low)), max: Some(clamp(high)) }
            }
        })
    }
}
