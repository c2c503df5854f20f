//! Every tunable of a simulation, as a scenario file may set it; each section's defaults, units and reasons stand with
//! its owner.

use serde::{Deserialize, Serialize};

use crate::hms::params::HmsParams;
use crate::mcn::params::McnParams;

/// Tunables of planner and synthesis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// `[params.planner]`
    pub planner: McnParams,
    /// `[params.synthesis]`
    pub synthesis: HmsParams,
}
