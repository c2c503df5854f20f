//! Tunables of the planner, with units, sources and reasons.

use serde::{Deserialize, Serialize};

/// Tunables of the planner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct McnParams {}

impl Default for McnParams {
    fn default() -> Self {
        Self {}
    }
}
