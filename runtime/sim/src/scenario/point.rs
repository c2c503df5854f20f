//! A place in a scenario, `[x, y]`: exactly two numbers, of which glam's own reading would drop a third silently.
//! World, metres.
//!
//! Recordings hold places too, in the same order and without their number, so one reading serves both.

use std::fmt;

use glam::Vec2;
use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// `[x, y]`
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point(pub(crate) Vec2);

impl<'de> Deserialize<'de> for Point {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_tuple(2, TwoNumbers)
    }
}

/// Reads what may be left out: for fields that are no [`Point`] because they are public.
pub(crate) fn optional<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec2>, D::Error> {
    Ok(Option::<Point>::deserialize(deserializer)?.map(|Point(place_m)| place_m))
}

struct TwoNumbers;

impl<'de> Visitor<'de> for TwoNumbers {
    type Value = Point;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("the two numbers of `[x, y]`")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Point, A::Error> {
        let mut next = |count: usize| numbers.next_element()?.ok_or_else(|| A::Error::invalid_length(count, &self));
        let place_m = Vec2::new(next(0)?, next(1)?);
        let mut count = 2;
        while numbers.next_element::<IgnoredAny>()?.is_some() {
            count += 1;
        }
        if count == 2 { Ok(Point(place_m)) } else { Err(A::Error::invalid_length(count, &self)) }
    }
}
