//! Places and focal lengths that are tried. World, metres; z up.

use glam::{Vec2, Vec3};

use crate::camera::default_camera::framing::{Framing, Slopes};
use crate::shading::light::TO_SUN;

/// Number of directions that are tried, from the middle of the crowd to the camera.
const DIRECTIONS: usize = 16;
/// Distances that are tried, of the one at which a slight wide angle frames the crowd.
const DISTANCES: [f32; 4] = [0.5, 0.9, 1.5, 2.4];
/// Width of the picture over its distance of that wide angle: 35 mm on film of 36 mm.
const WIDTH_TANGENT: f32 = 36.0 / 35.0;
/// Share of the bodies that it frames.
const FRAMED_BODIES: f32 = 0.95;
/// Least and greatest distance of the camera from the middle of the crowd, m.
const DISTANCE_M: [f32; 2] = [5.0, 80.0];
/// Elevations of the eye above the chests that are tried, degrees.
const ELEVATIONS_DEG: [f32; 6] = [0.0, 6.0, 12.0, 21.0, 33.0, 50.0];
/// Least height of the eye, m: an adult's.
const EYE_M: f32 = 1.65;
/// Shares of the bodies that a focal length frames.
const SHARES: [f32; 3] = [0.97, 0.85, 0.65];
/// Height of the point that the eye is elevated from, m.
const CHEST_M: f32 = 1.15;
/// What a score counts against the sun.
const AGAINST_SUN: f32 = 0.75;

/// A place of the eye from the middle of the crowd, and what it frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Eye from the middle of the crowd on the ground, m.
    pub(super) offset_m: Vec3,
    pub(super) framing: Framing,
    /// What its score counts.
    pub(super) weight: f32,
    /// Index of its elevation.
    pub(super) elevation: usize,
    /// Index of the share of the bodies that it frames.
    pub(super) share: usize,
}

impl Candidate {
    /// The same place and focal length, aimed at bodies at some positions from the middle of the crowd, m.
    pub(super) fn aimed(&self, offsets_m: &[Vec2]) -> Self {
        let slopes = Slopes::new(self.offset_m, -self.offset_m.truncate().normalize_or_zero(), offsets_m);
        let framing = Framing { direction: slopes.direction(SHARES[self.share]), ..self.framing };
        Self { framing, ..*self }
    }
}

/// Number of elevations of the eye.
pub(super) const ELEVATION_COUNT: usize = ELEVATIONS_DEG.len();

/// Candidates for bodies at some positions from the middle of the crowd, m.
pub(super) fn candidates(offsets_m: &[Vec2], size_px: [u32; 2]) -> Vec<Candidate> {
    let mut candidates = Vec::new();
    for index in 0..DIRECTIONS {
        // From the south, so that a lone body is seen from there.
        let turns = index as f32 / DIRECTIONS as f32 - 0.25;
        let (sin, cos) = libm::sincosf(std::f32::consts::TAU * turns);
        let direction = Vec2::new(cos, sin);
        let whole_m = framing_distance_m(offsets_m, direction);
        let with_sun = 0.5 + 0.5 * direction.dot(TO_SUN.truncate().normalize());
        let light = AGAINST_SUN + (1.0 - AGAINST_SUN) * with_sun;
        let mut distances_m = DISTANCES.map(|share| (share * whole_m).clamp(DISTANCE_M[0], DISTANCE_M[1])).to_vec();
        distances_m.dedup();
        for distance_m in distances_m {
            for (elevation, elevation_deg) in ELEVATIONS_DEG.into_iter().enumerate() {
                let (sin, cos) = libm::sincosf(elevation_deg.to_radians());
                let offset_m = (cos * distance_m * direction).extend((CHEST_M + sin * distance_m).max(EYE_M));
                // A steep view shows the tops of heads.
                let weight = light * cos * cos * cos;
                let slopes = Slopes::new(offset_m, -direction, offsets_m);
                candidates.extend(SHARES.into_iter().enumerate().map(|(share, framed)| {
                    let framing = slopes.framing(framed, size_px);
                    Candidate { offset_m, framing, weight, elevation, share }
                }));
            }
        }
    }
    candidates
}

/// Distance in a direction from the middle at which most positions are between the sides of the picture.
fn framing_distance_m(offsets_m: &[Vec2], direction: Vec2) -> f32 {
    let slope = 0.5 * WIDTH_TANGENT;
    let needed_m = |offset_m: &Vec2| offset_m.dot(direction) + offset_m.perp_dot(direction).abs() / slope;
    let mut distances_m: Vec<f32> = offsets_m.iter().map(needed_m).collect();
    distances_m.sort_by(f32::total_cmp);
    let at = (FRAMED_BODIES * distances_m.len() as f32) as usize;
    distances_m.get(at).copied().unwrap_or(DISTANCE_M[0])
}
