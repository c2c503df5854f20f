//! Aim and focal length that frame bodies from an eye. World, metres.

use glam::{Vec2, Vec3};

use crate::camera::default_camera::crowd::quantile;
use crate::visibility::Lens;

/// Width of the film, mm.
const FILM_MM: f32 = 36.0;
/// Shortest and longest focal length, mm: a wide angle without distorted bodies at the edges, a long lens.
const FOCAL_MM: [f32; 2] = [28.0, 135.0];
/// Share of the picture within which bodies are framed.
const FRAMED: f32 = 0.88;
/// Greatest share of the picture's height that a body in the middle of the crowd takes.
const BODY_SHARE: f32 = 0.5;
/// Distance before the eye from which on bodies are framed, m.
const NEAR_M: f32 = 1.0;

/// Bodies that a view frames, all equally high.
#[derive(Clone, Copy, Debug)]
pub(super) struct FramedBodies<'a> {
    pub(super) positions_m: &'a [Vec2],
    pub(super) height_m: f32,
}

/// Direction of a view, and its focal length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Framing {
    pub(super) direction: Vec3,
    /// On film of 36 mm.
    pub(super) focal_mm: f32,
}

impl Framing {
    pub(super) fn lens(&self, eye_m: Vec3, size_px: [u32; 2]) -> Lens {
        Lens::perspective(size_px, eye_m, eye_m + self.direction, FILM_MM / self.focal_mm)
    }
}

/// What a level view sees of bodies: slopes of each, sorted.
pub(super) struct Slopes {
    ahead: Vec2,
    /// Height of a body above the eye, and of the ground, m.
    head_m: f32,
    feet_m: f32,
    left: Vec<f32>,
    /// One over the depth, 1/m.
    nearness: Vec<f32>,
}

impl Slopes {
    /// The slopes of bodies from an eye that looks in a level direction.
    pub(super) fn new(eye_m: Vec3, ahead: Vec2, bodies: &FramedBodies) -> Self {
        let (head_m, feet_m) = (bodies.height_m - eye_m.z, -eye_m.z);
        let mut slopes = Self { ahead, head_m, feet_m, left: Vec::new(), nearness: Vec::new() };
        for position_m in bodies.positions_m {
            let offset_m = *position_m - eye_m.truncate();
            let depth_m = offset_m.dot(ahead);
            if depth_m > NEAR_M {
                slopes.left.push(ahead.perp_dot(offset_m) / depth_m);
                slopes.nearness.push(1.0 / depth_m);
            }
        }
        for values in [&mut slopes.left, &mut slopes.nearness] {
            values.sort_unstable_by(f32::total_cmp);
        }
        slopes
    }

    /// The direction to the middle of a share of the bodies.
    pub(super) fn direction(&self, share: f32) -> Vec3 {
        let [right, left, low, high] = self.edges(share);
        self.to_world(left.midpoint(right), low.midpoint(high)).normalize()
    }

    /// The framing that holds a share of the bodies.
    pub(super) fn framing(&self, share: f32, size_px: [u32; 2]) -> Framing {
        let [right, left, low, high] = self.edges(share);
        let direction = self.direction(share);
        let level = Lens::perspective(size_px, Vec3::ZERO, direction, 1.0);
        let mut half = Vec2::ZERO;
        for (left, up) in [(left, low), (left, high), (right, low), (right, high)] {
            let at = level.to_camera(self.to_world(left, up));
            half = half.max(at.truncate().abs() / at.z.max(1e-3));
        }
        let proportion = size_px[0] as f32 / size_px[1] as f32;
        let of_body = proportion * (self.head_m - self.feet_m) * quantile(&self.nearness, 0.5) / BODY_SHARE;
        let tangent = (2.0 / FRAMED * half.x.max(proportion * half.y)).max(of_body);
        let focal_mm = (FILM_MM / tangent.max(1e-3)).floor().clamp(FOCAL_MM[0], FOCAL_MM[1]);
        Framing { direction, focal_mm }
    }

    /// Slopes of the right and left edge of a share of the bodies, and of its lower and upper edge.
    fn edges(&self, share: f32) -> [f32; 4] {
        let out = 1.0 - share;
        let [right, left] = [0.5 * out, 1.0 - 0.5 * out].map(|at| quantile(&self.left, at));
        // The slope of a point that is higher than the eye grows as it comes nearer; that of a lower one falls.
        let high = quantile(&self.nearness, if self.head_m > 0.0 { share } else { out });
        [right, left, self.feet_m * quantile(&self.nearness, share), self.head_m * high]
    }

    fn to_world(&self, left: f32, up: f32) -> Vec3 {
        (self.ahead + left * self.ahead.perp()).extend(up)
    }
}
