//! Places and focal lengths that are tried. World, metres; z up.

use glam::{Vec2, Vec3};

use crate::camera::default_camera::crowd::{halves, middle_m};
use crate::camera::default_camera::framing::{FramedBodies, Framing, Slopes};
use crate::shading::light::TO_SUN;

/// Number of directions that are tried, from the middle of the framed bodies to the camera.
const DIRECTIONS: usize = 16;
/// Distances that are tried, of the one at which a slight wide angle frames the bodies.
const DISTANCES: [f32; 4] = [0.5, 0.9, 1.5, 2.4];
/// Width of the picture over its distance of that wide angle: 35 mm on film of 36 mm.
const WIDTH_TANGENT: f32 = 36.0 / 35.0;
/// Share of the bodies, of the crowd or of a part of it, that it frames, and that a focal length frames.
const FRAMED_BODIES: f32 = 0.9;
/// Least and greatest distance of the camera from the middle of the framed bodies, over their height.
const DISTANCE: [f32; 2] = [2.9, 46.0];
/// Elevations of the eye above the chests that are tried, degrees.
const ELEVATIONS_DEG: [f32; 6] = [0.0, 6.0, 12.0, 21.0, 33.0, 50.0];
/// Least height of the eye, over that of the bodies: their own eyes.
const EYES: f32 = 0.94;
/// Height of the point that the eye is elevated from, over that of the bodies.
const CHEST: f32 = 0.66;
/// What a score counts against the sun.
const AGAINST_SUN: f32 = 0.75;

/// A place of the eye from the middle of the crowd, and what it frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Eye from the middle of the crowd on the ground, m.
    pub(super) offset_m: Vec3,
    /// Distance of the eye from the middle of the framed bodies, m.
    pub(super) distance_m: f32,
    pub(super) framing: Framing,
    /// What its score counts.
    pub(super) weight: f32,
    /// Index of its elevation.
    pub(super) elevation: usize,
}

impl Candidate {
    /// The same place and focal length, aimed at bodies; from the middle of the crowd.
    pub(super) fn aimed(&self, bodies: &FramedBodies) -> Self {
        let slopes = Slopes::new(self.offset_m, -self.offset_m.truncate().normalize_or_zero(), bodies);
        let framing = Framing { direction: slopes.direction(FRAMED_BODIES), ..self.framing };
        Self { framing, ..*self }
    }
}

/// Number of elevations of the eye.
pub(super) const ELEVATION_COUNT: usize = ELEVATIONS_DEG.len();

/// Candidates that frame bodies, from the middle of the crowd; and ones that frame a half or a quarter of them.
pub(super) fn candidates_of_parts(bodies: &FramedBodies, size_px: [u32; 2]) -> Vec<Candidate> {
    let in_halves = halves(bodies.positions_m.to_vec());
    let in_quarters: Vec<Vec<Vec2>> = in_halves.iter().cloned().flat_map(halves).collect();
    let parts = std::iter::once(bodies.positions_m).chain(in_halves.iter().chain(&in_quarters).map(Vec::as_slice));
    parts.flat_map(|positions_m| candidates(&FramedBodies { positions_m, ..*bodies }, size_px)).collect()
}

/// Candidates that frame bodies, from the middle of the crowd.
pub(super) fn candidates(bodies: &FramedBodies, size_px: [u32; 2]) -> Vec<Candidate> {
    let FramedBodies { positions_m: offsets_m, height_m } = *bodies;
    let [near_m, far_m] = DISTANCE.map(|distance| distance * height_m);
    let middle_m = middle_m(offsets_m.iter().copied());
    let mut candidates = Vec::new();
    for index in 0..DIRECTIONS {
        // From the south, so that a lone body is seen from there.
        let turns = index as f32 / DIRECTIONS as f32 - 0.25;
        let (sin, cos) = libm::sincosf(std::f32::consts::TAU * turns);
        let direction = Vec2::new(cos, sin);
        let whole_m = framing_distance_m(offsets_m, middle_m, direction).unwrap_or(near_m);
        let with_sun = 0.5 + 0.5 * direction.dot(TO_SUN.truncate().normalize());
        let light = AGAINST_SUN + (1.0 - AGAINST_SUN) * with_sun;
        let mut distances_m = DISTANCES.map(|share| (share * whole_m).clamp(near_m, far_m)).to_vec();
        distances_m.dedup();
        for distance_m in distances_m {
            candidates.extend(ELEVATIONS_DEG.into_iter().enumerate().map(|(elevation, elevation_deg)| {
                let (sin, cos) = libm::sincosf(elevation_deg.to_radians());
                let on_ground_m = middle_m + cos * distance_m * direction;
                let offset_m = on_ground_m.extend((CHEST * height_m + sin * distance_m).max(EYES * height_m));
                let framing = Slopes::new(offset_m, -direction, bodies).framing(FRAMED_BODIES, size_px);
                // A steep view shows the tops of heads.
                let weight = light * cos * cos * cos;
                Candidate { offset_m, distance_m, framing, weight, elevation }
            }));
        }
    }
    candidates
}

/// Distance in a direction from the middle at which most positions are between the sides of the picture; none without
/// positions.
fn framing_distance_m(offsets_m: &[Vec2], middle_m: Vec2, direction: Vec2) -> Option<f32> {
    let slope = 0.5 * WIDTH_TANGENT;
    let needed_m = |offset_m: &Vec2| {
        let from_middle_m = *offset_m - middle_m;
        from_middle_m.dot(direction) + from_middle_m.perp_dot(direction).abs() / slope
    };
    let mut distances_m: Vec<f32> = offsets_m.iter().map(needed_m).collect();
    distances_m.sort_by(f32::total_cmp);
    let at = (FRAMED_BODIES * distances_m.len() as f32) as usize;
    distances_m.get(at).copied()
}
