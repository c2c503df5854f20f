//! Every tunable of a simulation, as a scenario file may set it; each section's defaults, units and reasons stand with
//! its owner.

use serde::{Deserialize, Serialize};

use crate::planning::baselines::orca::OrcaParams;
use crate::planning::baselines::social_force::SocialForceParams;
use crate::planning::mcn::params::McnParams;
use crate::synthesis::HmsParams;

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
