//! Tunables of MCN, `[params.planner]`, with units and sources; how they were chosen: docs/tuning.md.

use serde::{Deserialize, Serialize};

use crate::planning::mcn::power_law::PowerLaw;

/// The parts of MCN, each of which can be switched off to measure its effect: `[params.planner.parts]`.
///
/// With all of them off, MCN is plain ORCA, except for its time horizon, a shorter one against agents that stand, a
/// slightly greater distance from walls, and a body's greatest speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct McnParts {
    /// Whether social forces adapt v_pref (§4.3).
    pub adaptation: bool,
    /// Whether v_op is no faster than the crowd ahead allows (§4.3).
    pub density_filter: bool,
    /// Whether velocities stay in the sets that the database can realise (§4.1).
    pub hull: bool,
    /// Whether sharp-turn edges apply (§4.1).
    pub sharp_turns: bool,
    /// How the stance foot limits the velocity (§4.2).
    pub stance: StanceForm,
    /// Whether agents met sooner rank higher: in the choice of neighbours and in the order of yielding (§4.4).
    pub order: bool,
    /// Whether the facing may stay on v_pref; else it follows the velocity (§4.5).
    pub orientation: bool,
    /// Whether agents may step back at held facing, which the paper lacks.
    pub back_pedalling: bool,
    /// Whether agents keep right, which resolves symmetric encounters.
    pub keep_right: bool,
    /// Whether agents that queue hold their place, and their bodies wait rather than creep backward.
    pub queueing: bool,
    /// Whether agents that brake before a goal, or want to stand, count as slower.
    pub slowing: bool,
    /// Whether agents that stand in contact, and want to go in different directions, press on.
    pub pressing: bool,
    /// Whether agents whose route leads aside or behind turn before they walk.
    pub turn_first: bool,
}

/// How the stance foot limits the velocity (§4.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StanceForm {
    /// By the position where the swing foot lands.
    Landing,
    /// The paper's: a wall before the disc, in the direction of the stance foot (Eqs. 7, 8).
    Radial,
    /// Not at all.
    Off,
}

impl Default for McnParts {
    fn default() -> Self {
        Self {
            adaptation: true,
            density_filter: true,
            hull: true,
            sharp_turns: true,
            stance: StanceForm::Landing,
            order: true,
            orientation: true,
            back_pedalling: true,
            keep_right: true,
            queueing: true,
            slowing: true,
            pressing: true,
            turn_first: true,
        }
    }
}

/// Tunables of MCN.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct McnParams {
    /// τ: time ahead within which agents avoid each other, s.
    pub time_horizon_s: f32,
    /// Time ahead within which walls are avoided, s. Short, because a wall does not move, and a longer time keeps
    /// agents out of narrow passages.
    pub obstacle_time_horizon_s: f32,
    /// Farthest neighbour, m.
    pub neighbour_range_m: f32,
    /// k of Eq. 11: strength of the social force, m².
    pub interaction_strength: f32,
    /// τ_0 of Eq. 11: time ahead beyond which interactions fade, s.
    pub interaction_horizon_s: f32,
    /// τ_0 of Eq. 9: time in which the preferred velocity is taken up, s.
    pub relaxation_s: f32,
    /// Lag of a body behind its plans, s. Eq. 9 begins at the last plan, which is ahead of the body's velocity by no more
    /// than the greatest acceleration adds in this time.
    pub response_s: f32,
    /// Greatest acceleration of Eq. 9, m/s².
    pub acceleration_max_mps2: f32,
    /// Stride factor of the density filter's fundamental diagram.
    pub density_factor: f32,
    /// Space that the density filter keeps beyond the stride, as a share of it.
    pub density_buffer: f32,
    /// Speed below which the density filter does not slow an agent, m/s.
    pub density_speed_min_mps: f32,
    /// Greatest turn of v_pref to the right where the path is obstructed, rad; resolves symmetric encounters.
    pub keep_right_rad: f32,
    /// Greatest twist of the stance foot in place (§4.2), rad.
    pub stance_twist_rad: f32,
    /// t_strafeLim (§4.5): longest contiguous side-stepping, s; agents that only shuffle have no limit.
    pub strafing_limit_s: f32,
    /// Longest contiguous stepping back at held facing, s; agents that only shuffle have no limit.
    pub stepping_back_limit_s: f32,
    /// The active parts.
    pub parts: McnParts,
}

impl Default for McnParams {
    fn default() -> Self {
        Self {
            // Longer than the longest transition between syntheses; overlap and acceleration grow below 3 s.
            time_horizon_s: 4.0,
            obstacle_time_horizon_s: 1.0,
            // The sensing range of Karamouzas, Skinner, Guy 2014.
            neighbour_range_m: 10.0,
            // Karamouzas, Skinner, Guy 2014: k and τ_0.
            interaction_strength: 1.5,
            interaction_horizon_s: 3.0,
            // With both, a start lasts 1 s, as people's do (docs/tuning.md).
            relaxation_s: 0.4,
            acceleration_max_mps2: 2.0,
            response_s: 0.3,
            // Menge's PedVO (Curtis, Best, Manocha 2016); the buffer lies between its two, 0.5 and 0.9.
            density_factor: 1.57,
            density_buffer: 0.84,
            density_speed_min_mps: 0.3,
            // 16°.
            keep_right_rad: 0.28,
            // 36°: as far as a hip turns over a planted foot (Roach, Miles 1991: 32 ± 8°).
            stance_twist_rad: 0.63,
            // Two strides.
            strafing_limit_s: 2.5,
            stepping_back_limit_s: 2.0,
            parts: McnParts::default(),
        }
    }
}

impl McnParams {
    /// The constants of Eq. 11.
    pub(crate) fn power_law(&self) -> PowerLaw {
        PowerLaw { strength: self.interaction_strength, horizon_s: self.interaction_horizon_s }
    }
}
