//! Tunables of the planner, with units, sources and reasons.

use serde::{Deserialize, Serialize};

use crate::planning::mcn::social_force::PowerLaw;

/// The parts of MCN, each of which can be taken out to see what it is good for: `[params.planner.parts]`. All out, MCN
/// is plain ORCA, but for its horizon, a shorter one against who stands, a hair more distance to walls, and a body's
/// greatest speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Parts {
    /// §4.3: social forces make v_op of v_pref.
    pub adaptation: bool,
    /// §4.3: v_op is no faster than the crowd ahead allows.
    pub density_filter: bool,
    /// §4.1: velocities that the database can realise.
    pub hull: bool,
    /// §4.1: the sharp-turn edges.
    pub sharp_turns: bool,
    /// §4.2: where the stance foot lets the body go.
    pub stance: StanceForm,
    /// §4.4: whoever is met sooner matters more, in being taken for a neighbour and in yielding last.
    pub order: bool,
    /// §4.5: the facing may stay on v_pref; else it follows the velocity.
    pub orientation: bool,
    /// Stepping back at held facing, which the paper lacks.
    pub back_pedalling: bool,
    /// Keeping right, which resolves symmetric encounters.
    pub keep_right: bool,
}

/// How the stance foot limits the velocity (§4.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StanceForm {
    /// Where the swing foot lands.
    Landing,
    /// The paper's: a wall before the disc, in the direction of the stance foot (Eqs. 7, 8).
    Radial,
    /// Not at all.
    Off,
}

impl Default for Parts {
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
        }
    }
}

/// Tunables of the planner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct McnParams {
    /// τ: how far ahead agents avoid each other, s.
    pub time_horizon_s: f32,
    /// How far ahead walls are avoided, s. Short, because a wall does not move and a longer one keeps agents out of
    /// narrow passages.
    pub obstacle_time_horizon_s: f32,
    /// Farthest neighbour, m.
    pub neighbour_range_m: f32,
    /// k of Eq. 11, m²: strength of the social force.
    pub interaction_strength: f32,
    /// τ_0 of Eq. 11, s: interactions that lie farther ahead fade.
    pub interaction_horizon_s: f32,
    /// τ_0 of Eq. 9, s: time in which the preferred velocity is taken up.
    pub relaxation_s: f32,
    /// Time for which the acceleration of Eq. 9 is applied to the velocity of a body, s; never less than a step. It is
    /// what a body needs to follow: with less, a body that lags would be slowed by Eq. 9's relaxation and by its own.
    /// Discs do not lag, theirs is the step.
    pub response_s: f32,
    /// Greatest acceleration of Eq. 9, m/s².
    pub acceleration_max_mps2: f32,
    /// Density filter: stride factor of the fundamental diagram.
    pub density_factor: f32,
    /// Density filter: space kept beyond the stride, as a share of it.
    pub density_buffer: f32,
    /// The density filter slows nobody below this, m/s.
    pub density_speed_min_mps: f32,
    /// Greatest turn of v_pref to the right where the way is obstructed, rad. It resolves symmetric encounters.
    pub keep_right_rad: f32,
    /// Greatest twist of the stance foot in place (§4.2), rad.
    pub stance_twist_rad: f32,
    /// t_strafeLim (§4.5), s; who only shuffles may side-step and step back longer (`orientation`).
    pub strafing_limit_s: f32,
    /// Longest contiguous stepping back at held facing, s.
    pub stepping_back_limit_s: f32,
    /// What of it all is in force.
    pub parts: Parts,
}

impl Default for McnParams {
    fn default() -> Self {
        Self {
            // Beyond the longest transition between syntheses. Measured on circles of 17 to 100 and crossing streams:
            // overlap and acceleration grow below 3 and gain nothing above 4.
            time_horizon_s: 4.0,
            obstacle_time_horizon_s: 1.0,
            // As far as Karamouzas, Skinner, Guy 2014 sense.
            neighbour_range_m: 10.0,
            // Karamouzas, Skinner, Guy 2014: k, τ_0 and the driving force's relaxation.
            interaction_strength: 1.5,
            interaction_horizon_s: 3.0,
            relaxation_s: 0.54,
            response_s: 0.3,
            // About what people start and stop with unhurried. The 20 of the power law's authors, whose steps are 5 ms,
            // shakes at steps of 0.1 s. Measured through bodies on Table 1, from 1.1 to 2.5: the acceleration on the
            // circle grows with it by a seventh; below, nothing is gained.
            acceleration_max_mps2: 1.1,
            // Menge's PedVO (Curtis, Best, Manocha 2016). Between its two buffers, 0.5 and 0.9: with this one people
            // walk within 0.09 m/s of Weidmann's diagram (RiMEA test 4; at 0.8 within 0.16); beyond, doors let fewer of
            // them through.
            density_factor: 1.57,
            density_buffer: 0.84,
            density_speed_min_mps: 0.3,
            // 16°. Measured: at 0.2 a crowd of 1,000 with antipodal goals dissolves a fifth more slowly, up to 0.27
            // somebody may stand for five seconds in a circle of exact symmetry; at 0.4 late comers stray about their
            // goals.
            keep_right_rad: 0.28,
            // 36°: as far as a hip turns over a planted foot (Roach, Miles 1991: 32 ± 8°). Measured in the four-way
            // crossing of Table 1: at 20° somebody stands for five seconds in two runs of five, from 30 to 60° in none
            // or one.
            stance_twist_rad: 0.63,
            // Two strides. Measured: below, those who pass each other turn aside and back again, which costs more
            // acceleration than side-stepping on.
            strafing_limit_s: 2.5,
            stepping_back_limit_s: 2.0,
            parts: Parts::default(),
        }
    }
}

impl McnParams {
    /// Eq. 11's constants.
    pub fn power_law(&self) -> PowerLaw {
        PowerLaw { strength: self.interaction_strength, horizon_s: self.interaction_horizon_s }
    }
}
