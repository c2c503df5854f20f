//! Tunables of the synthesis, with units, sources and reasons.

use serde::{Deserialize, Serialize};

/// Tunables of the synthesis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HmsParams {}

impl Default for HmsParams {
    fn default() -> Self {
        Self {}
    }
}
