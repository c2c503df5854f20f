//! Numbers that are fixed or drawn, as written: `1.3`, `{ uniform = [1, 2] }`, `{ normal = [1.3, 0.2], min = 0.5, max = 2 }`.

use std::fmt;

use serde::de::{Error, IgnoredAny, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::behaviour::Distribution;
use crate::scenario::fault::TableFault;
use crate::scenario::ranges::PRIORITY;

/// Standard deviations about the mean that a normal distribution has without `min` and `max`: 99.7 % of all draws.
const DEVIATIONS: f32 = 3.0;

/// A number that is fixed or drawn, as written.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "a number, `{ uniform = [a, b] }` or `{ normal = [mean, deviation], min = a, max = b }`")]
pub(crate) enum DistributionValue {
    Constant(f32),
    Uniform(UniformTable),
    Normal(NormalTable),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct UniformTable {
    uniform: [f32; 2],
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NormalTable {
    normal: [f32; 2],
    min: Option<f32>,
    max: Option<f32>,
}

impl DistributionValue {
    /// The distribution, all of whose draws must lie within bounds.
    pub(crate) fn resolve(self, name: &str, [least, greatest]: [f32; 2]) -> Result<Distribution, TableFault> {
        let distribution = match self {
            Self::Constant(value) => Distribution::Constant(value),
            Self::Uniform(UniformTable { uniform: [from, to] }) => Distribution::Uniform { from, to },
            Self::Normal(NormalTable { normal: [mean, deviation], min, max }) => Distribution::Normal {
                mean,
                deviation,
                min: min.unwrap_or((mean - DEVIATIONS * deviation).max(least)),
                max: max.unwrap_or((mean + DEVIATIONS * deviation).min(greatest)),
            },
        };
        if let Distribution::Normal { mean, deviation, .. } = distribution
            && !(mean.is_finite() && (0.0..=f32::MAX).contains(&deviation))
        {
            let message = format!("the mean of {name} is {mean}, its deviation {deviation}");
            return Err((message, "write `normal = [mean, deviation]`, with finite numbers"));
        }
        let [min, max] = distribution.bounds();
        if let Distribution::Normal { mean, .. } = distribution {
            if !(least..=greatest).contains(&mean) {
                let message = format!("the mean of {name} is {mean}, not within {least} and {greatest}");
                return Err((message, "give a mean in this range"));
            }
            // So few draws would lie within the limits that most agents had a limit itself.
            if mean < min || mean > max {
                let message = format!("the mean of {name} is {mean}, not between `min` and `max`");
                return Err((message, "give a mean between the limits, or change these"));
            }
        }
        if min > max {
            return Err((format!("{name} falls from {min} to {max}"), "write the lower number first"));
        }
        if least <= min && max <= greatest {
            return Ok(distribution);
        }
        let value = if min == max { format!("is {min}") } else { format!("lies between {min} and {max}") };
        Err((format!("{name} {value}, not within {least} and {greatest}"), "give numbers in this range"))
    }
}

/// A number that is the same for all agents of a table. A distribution is refused: it belongs in a profile.
pub(crate) fn fixed_number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f32>, D::Error> {
    deserializer.deserialize_any(FixedNumber).map(Some)
}

struct FixedNumber;

impl<'de> Visitor<'de> for FixedNumber {
    type Value = f32;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("f32")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f32, E> {
        Ok(value as f32)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<f32, E> {
        Ok(value as f32)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<f32, A::Error> {
        while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Err(A::Error::custom(
            "a number is expected here; write a distribution in `[profiles.NAME]`, and `profile = \"NAME\"` here",
        ))
    }
}

/// A priority within its range.
pub(crate) fn priority(value: f32) -> Result<f32, TableFault> {
    let within = PRIORITY.contains(&value).then_some(value);
    within.ok_or_else(|| {
        (format!("`priority` is {value}"), "give a number within -100 and 100; 0 is that of most agents")
    })
}
