//! Tunables in a header of version 1.

use serde::Deserialize;

use crate::params::Params;
use crate::planning::baselines::{OrcaParams, SocialForceParams};
use crate::planning::mcn::{McnParams, McnParts, StanceForm};
use crate::route::RouteParams;
use crate::synthesis::{HmsParams, Modes, Transition};

#[derive(Deserialize)]
pub(super) struct ParamsV1 {
    planner: McnParamsV1,
    orca: OrcaParamsV1,
    social_force: SocialForceParamsV1,
    synthesis: HmsParamsV1,
}

#[derive(Deserialize)]
struct McnParamsV1 {
    time_horizon_s: f32,
    obstacle_time_horizon_s: f32,
    neighbour_range_m: f32,
    interaction_strength: f32,
    interaction_horizon_s: f32,
    relaxation_s: f32,
    response_s: f32,
    acceleration_max_mps2: f32,
    density_factor: f32,
    density_buffer: f32,
    density_speed_min_mps: f32,
    keep_right_rad: f32,
    stance_twist_rad: f32,
    strafing_limit_s: f32,
    stepping_back_limit_s: f32,
    parts: McnPartsV1,
}

#[derive(Deserialize)]
struct McnPartsV1 {
    adaptation: bool,
    density_filter: bool,
    hull: bool,
    sharp_turns: bool,
    stance: StanceFormV1,
    order: bool,
    orientation: bool,
    back_pedalling: bool,
    keep_right: bool,
}

#[derive(Deserialize)]
enum StanceFormV1 {
    Landing,
    Radial,
    Off,
}

#[derive(Deserialize)]
struct OrcaParamsV1 {
    time_horizon_s: f32,
    obstacle_time_horizon_s: f32,
    neighbour_range_m: f32,
    speed_max_mps: f32,
}

#[derive(Deserialize)]
struct SocialForceParamsV1 {
    interaction_strength: f32,
    interaction_horizon_s: f32,
    relaxation_s: f32,
    acceleration_max_mps2: f32,
    neighbour_range_m: f32,
    substeps: u32,
}

#[derive(Deserialize)]
struct HmsParamsV1 {
    modes: ModesV1,
    transition: TransitionV1,
    acceleration_max_mps2: f32,
    turn_acceleration_max_rad_s2: f32,
    pose_change_max_mps: f32,
    turn_time_s: f32,
    density_threshold: f32,
}

#[derive(Deserialize)]
enum ModesV1 {
    Hybrid,
    Blending,
    SemiProcedural,
}

#[derive(Deserialize)]
enum TransitionV1 {
    Direct,
    ThroughMMb,
}

impl From<ParamsV1> for Params {
    fn from(params: ParamsV1) -> Self {
        let ParamsV1 { planner, orca, social_force, synthesis } = params;
        Self {
            route: RouteParams::default(),
            planner: planner.into(),
            orca: orca.into(),
            social_force: social_force.into(),
            synthesis: synthesis.into(),
        }
    }
}

impl From<McnParamsV1> for McnParams {
    fn from(params: McnParamsV1) -> Self {
        Self {
            time_horizon_s: params.time_horizon_s,
            obstacle_time_horizon_s: params.obstacle_time_horizon_s,
            neighbour_range_m: params.neighbour_range_m,
            interaction_strength: params.interaction_strength,
            interaction_horizon_s: params.interaction_horizon_s,
            relaxation_s: params.relaxation_s,
            response_s: params.response_s,
            acceleration_max_mps2: params.acceleration_max_mps2,
            density_factor: params.density_factor,
            density_buffer: params.density_buffer,
            density_speed_min_mps: params.density_speed_min_mps,
            keep_right_rad: params.keep_right_rad,
            stance_twist_rad: params.stance_twist_rad,
            strafing_limit_s: params.strafing_limit_s,
            stepping_back_limit_s: params.stepping_back_limit_s,
            parts: params.parts.into(),
        }
    }
}

impl From<McnPartsV1> for McnParts {
    fn from(parts: McnPartsV1) -> Self {
        Self {
            adaptation: parts.adaptation,
            density_filter: parts.density_filter,
            hull: parts.hull,
            sharp_turns: parts.sharp_turns,
            stance: match parts.stance {
                StanceFormV1::Landing => StanceForm::Landing,
                StanceFormV1::Radial => StanceForm::Radial,
                StanceFormV1::Off => StanceForm::Off,
            },
            order: parts.order,
            orientation: parts.orientation,
            back_pedalling: parts.back_pedalling,
            keep_right: parts.keep_right,
            queueing: false,
            slowing: false,
            pressing: false,
            turn_first: false,
        }
    }
}

impl From<OrcaParamsV1> for OrcaParams {
    fn from(params: OrcaParamsV1) -> Self {
        let OrcaParamsV1 { time_horizon_s, obstacle_time_horizon_s, neighbour_range_m, speed_max_mps } = params;
        Self { time_horizon_s, obstacle_time_horizon_s, neighbour_range_m, speed_max_mps }
    }
}

impl From<SocialForceParamsV1> for SocialForceParams {
    fn from(params: SocialForceParamsV1) -> Self {
        Self {
            interaction_strength: params.interaction_strength,
            interaction_horizon_s: params.interaction_horizon_s,
            relaxation_s: params.relaxation_s,
            acceleration_max_mps2: params.acceleration_max_mps2,
            neighbour_range_m: params.neighbour_range_m,
            substeps: params.substeps,
        }
    }
}

impl From<HmsParamsV1> for HmsParams {
    fn from(params: HmsParamsV1) -> Self {
        Self {
            modes: match params.modes {
                ModesV1::Hybrid => Modes::Hybrid,
                ModesV1::Blending => Modes::Blending,
                ModesV1::SemiProcedural => Modes::SemiProcedural,
            },
            transition: match params.transition {
                TransitionV1::Direct => Transition::Direct,
                TransitionV1::ThroughMMb => Transition::ThroughMMb,
            },
            acceleration_max_mps2: params.acceleration_max_mps2,
            turn_acceleration_max_rad_s2: params.turn_acceleration_max_rad_s2,
            pose_change_max_mps: params.pose_change_max_mps,
            turn_time_s: params.turn_time_s,
            density_threshold: params.density_threshold,
        }
    }
}
