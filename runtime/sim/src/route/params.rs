//! Tunables of routes, `[params.route]`.

use serde::{Deserialize, Serialize};

/// The side on which agents keep where a corner leaves room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum KeepSide {
    /// The right side: off the inner corner of left turns.
    #[default]
    Right,
    /// The left side: off the inner corner of right turns.
    Left,
    /// No side.
    None,
}

/// Tunables of routes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RouteParams {
    /// The side on which agents keep.
    pub keep: KeepSide,
}

impl RouteParams {
    /// Whether all tunables have their defaults; then a recording leaves them out.
    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}
