//! Every tunable of a simulation, as a scenario file may set it. Defaults, units and sources are documented at the
//! owner of each section.

use serde::{Deserialize, Serialize};

use crate::planning::baselines::{OrcaParams, SocialForceParams};
use crate::planning::mcn::McnParams;
use crate::route::RouteParams;
use crate::synthesis::params::HmsParams;

/// Tunables of the planners and of synthesis: the tables below `[params]` in a scenario file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// `[params.route]`: tunables of routes.
    #[serde(skip_serializing_if = "RouteParams::is_default")]
    pub route: RouteParams,
    /// `[params.planner]`: tunables of MCN.
    pub planner: McnParams,
    /// `[params.orca]`: tunables of plain ORCA.
    pub orca: OrcaParams,
    /// `[params.social_force]`: tunables of social forces.
    pub social_force: SocialForceParams,
    /// `[params.synthesis]`: tunables of synthesis.
    pub synthesis: HmsParams,
}
