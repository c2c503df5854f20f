//! A position in a scenario file, `[x, y]`: exactly two numbers; glam's own reading would drop a third silently. World,
//! metres.
//!
//! Recordings hold positions too, in the same order and without their number, so one reading serves both.

use std::fmt;

use glam::Vec2;
use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// `[x, y]`, m.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point(pub(crate) Vec2);

impl<'de> Deserialize<'de> for Point {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_tuple(2, TwoNumbers)
    }
}

/// Reads an optional position: for public fields, which are no [`Point`].
pub(crate) fn optional<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec2>, D::Error> {
    Ok(Option::<Point>::deserialize(deserializer)?.map(|Point(position_m)| position_m))
}

struct TwoNumbers;

impl<'de> Visitor<'de> for TwoNumbers {
    type Value = Point;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("the two numbers of `[x, y]`")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Point, A::Error> {
        let mut next = |count: usize| numbers.next_element()?.ok_or_else(|| A::Error::invalid_length(count, &self));
        let position_m = Vec2::new(next(0)?, next(1)?);
        let mut count = 2;
        while numbers.next_element::<IgnoredAny>()?.is_some() {
            count += 1;
        }
        if count == 2 { Ok(Point(position_m)) } else { Err(A::Error::invalid_length(count, &self)) }
    }
}
