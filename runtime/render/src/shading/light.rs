//! The light of all pictures: a sun in the south-west and a clear sky. Linear Rec. 709; world directions, z up.

use glam::Vec3;

/// Direction to the sun: from the south-west, 47° high.
pub(crate) const TO_SUN: Vec3 = Vec3::new(-0.503, -0.457, 0.733);
/// Light of the sun on a surface that faces it.
pub(crate) const SUN: Vec3 = Vec3::new(0.86, 0.80, 0.70);
/// Light of the whole sky on a surface that faces up.
const SKY_LIGHT: Vec3 = Vec3::new(0.335, 0.365, 0.42);
/// Light from the ground on a surface that faces down.
const BOUNCE: Vec3 = Vec3::new(0.17, 0.162, 0.15);
/// Colour of the sky at the zenith.
const ZENITH: Vec3 = Vec3::new(0.22, 0.42, 0.74);
/// Colour of the sky at the horizon.
pub(crate) const HORIZON: Vec3 = Vec3::new(0.66, 0.765, 0.86);
/// Distance at which half of the ground's colour is the horizon's, m: no edge is seen at the horizon.
const HAZE_M: f32 = 420.0;

/// Light of sky and ground on a surface, without occlusion.
pub(crate) fn ambient(normal: Vec3) -> Vec3 {
    BOUNCE.lerp(SKY_LIGHT, 0.5 + 0.5 * normal.z)
}

/// Colour of the sky in a direction.
pub(crate) fn sky(direction: Vec3) -> Vec3 {
    let height = direction.z.max(0.0);
    // Steep near the horizon, flat above.
    let share = height / (height + 0.22);
    HORIZON.lerp(ZENITH, share * 1.1)
}

/// A colour seen through the air, from a distance; `fog_m` is the distance at which fog leaves a third.
pub(crate) fn through_air(colour: Vec3, distance_m: f32, fog_m: Option<f32>) -> Vec3 {
    let haze = distance_m * distance_m / (distance_m * distance_m + HAZE_M * HAZE_M);
    let fog = fog_m.map_or(0.0, |fog_m| 1.0 - libm::expf(-distance_m / fog_m));
    colour.lerp(HORIZON, haze.max(fog))
}
