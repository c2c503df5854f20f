//! The preferred velocity, adapted to who comes (`FbCrowd` §4.3, App. 9.1, Eqs. 9 and 11).
//!
//! The force between two agents is the universal power law of Karamouzas, Skinner, Guy 2014: the gradient of the energy
//! E(τ) = k τ⁻² e^(−τ/τ_0) of their time to collision τ, in closed form. Walls act alike, on the capsule that a segment grown by the
//! agent's radius makes. Masses are 1, so forces are accelerations, m/s².
//!
//! Integrated over many steps Eq. 9 is stiff and stalls crowds (`facts/planning.md` §1): it is evaluated afresh each step and only
//! modulates v_pref.

use glam::Vec2;

use super::params::McnParams;
use super::time_to_collision::{disc_with_disc, disc_with_side};

/// Discs that overlap are shrunk to this share of their distance, so that their time to collision is short, and not 0.
const OVERLAP_RADIUS_SHARE: f32 = 0.99;

/// Floor of the time to collision, s: keeps the force finite; far inside the reach of the clamp on the acceleration.
const TIME_MIN_S: f32 = 1e-2;

/// Eq. 9, one explicit step from the present velocity, the acceleration limited; `forces` is Σ f_ij + Σ f_iW.
pub fn adapted_mps(velocity_mps: Vec2, preferred_mps: Vec2, forces_mps2: Vec2, dt_s: f32, params: &McnParams) -> Vec2 {
    let driving_mps2 = (preferred_mps - velocity_mps) / params.relaxation_s;
    let acceleration_mps2 = (driving_mps2 + forces_mps2).clamp_length_max(params.acceleration_max_mps2);
    velocity_mps + params.response_s.max(dt_s) * acceleration_mps2
}

/// Eq. 11: the force on disc i from disc j; `offset` p_j − p_i, `velocity` v_i − v_j, `radius` r_i + r_j.
pub fn agent_force_mps2(offset_m: Vec2, velocity_mps: Vec2, radius_m: f32, params: &McnParams) -> Vec2 {
    // Overlapping discs count as touching (the authors' code).
    let radius_m = radius_m.min(OVERLAP_RADIUS_SHARE * offset_m.length());
    let time_s = disc_with_disc(offset_m, velocity_mps, radius_m);
    if !time_s.is_finite() {
        return Vec2::ZERO;
    }
    let speed_squared = velocity_mps.length_squared();
    let approach = velocity_mps.dot(offset_m);
    let root = (approach * approach - speed_squared * (offset_m.length_squared() - radius_m * radius_m)).sqrt();
    let along = velocity_mps - (approach * velocity_mps - speed_squared * offset_m) / root;
    -steepness(time_s, params) / speed_squared * along
}

/// f_iW: the force from a segment; `corners` relative to the disc's centre.
pub fn wall_force_mps2(corners_m: [Vec2; 2], velocity_mps: Vec2, radius_m: f32, params: &McnParams) -> Vec2 {
    let side_s = disc_with_side(corners_m, velocity_mps, radius_m);
    let ends_s = corners_m.map(|corner_m| disc_with_disc(corner_m, velocity_mps, radius_m));
    if side_s > ends_s[0].min(ends_s[1]) || side_s.is_infinite() {
        let nearer = usize::from(ends_s[1] < ends_s[0]);
        return agent_force_mps2(corners_m[nearer], velocity_mps, radius_m, params);
    }
    let along = (corners_m[1] - corners_m[0]).normalize();
    steepness(side_s, params) / velocity_mps.perp_dot(along) * along.perp()
}

/// −dE/dτ = k e^(−τ/τ_0) τ⁻² (2/τ + 1/τ_0).
fn steepness(time_s: f32, params: &McnParams) -> f32 {
    let time_s = time_s.max(TIME_MIN_S);
    let energy = params.interaction_strength * libm::expf(-time_s / params.interaction_horizon_s) / (time_s * time_s);
    energy * (2.0 / time_s + 1.0 / params.interaction_horizon_s)
}
