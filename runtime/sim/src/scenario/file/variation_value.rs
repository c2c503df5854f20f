//! How much the bodies of a scenario differ, as written: `variation = false`, or a table.
//!
//! ```toml
//! [variation]                         # the defaults; without this table, the same
//! reaction_s = [0.2, 0.8]             # of agents that are there at the start
//! cadence = 0.05                      # shares: deviations of cadence at equal speed, ...
//! arm_swing = 0.2                     # ... of the swing of both arms, ...
//! arm_asymmetry = 0.1                 # ... and of one arm against the other
//! trunk_pitch_deg = 2
//! head_pitch_deg = 4
//! secondary_motion = 1                # of head, forearms and hands, where the clips lack it
//! stature = 0.05                      # a share: deviation of the size of the body
//! ```

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::variation::Variation;

/// The value of the key `variation`; none: all bodies move as in the clips.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VariationValue(pub(crate) Option<Variation>);

impl<'de> Deserialize<'de> for VariationValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SwitchOrTable)
    }
}

struct SwitchOrTable;

impl<'de> Visitor<'de> for SwitchOrTable {
    type Value = VariationValue;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("`true`, `false` or a table `[variation]`")
    }

    fn visit_bool<E: Error>(self, differs: bool) -> Result<VariationValue, E> {
        Ok(VariationValue(differs.then(Variation::default)))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<VariationValue, A::Error> {
        Variation::deserialize(MapAccessDeserializer::new(map)).map(|variation| VariationValue(Some(variation)))
    }
}
