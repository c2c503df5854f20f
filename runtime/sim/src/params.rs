//! Every tunable of a simulation, as a scenario file may set it; each section's defaults, units and reasons stand with
//! its owner.

use serde::{Deserialize, Serialize};

use crate::hms::params::HmsParams;
use crate::mcn::params::McnParams;
use crate::rivals::orca::OrcaParams;
use crate::rivals::social_force::SocialForceParams;

/// Tunables of the planners and of synthesis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// `[params.planner]`: MCN's.
    pub planner: McnParams,
    /// `[params.orca]`
    pub orca: OrcaParams,
    /// `[params.social_force]`
    pub social_force: SocialForceParams,
    /// `[params.synthesis]`
    pub synthesis: HmsParams,
}
