//! A lens: where a picture is taken from, and how points of the world project into it.
//!
//! Camera space: x right, y down, z forward, metres from the eye. A picture point is (u, v): x/z and y/z in
//! perspective, x and y in orthographic projection. Pixels: x right, y down, (0, 0) the upper left corner.

use glam::{Vec2, Vec3};

/// Depth of the plane before which nothing is drawn, m: a hand's breadth.
pub(crate) const NEAR_M: f32 = 0.1;

/// Position, orientation and projection of a camera.
///
/// ```
/// use fbcrowd_render::visibility::Lens;
/// use glam::{Vec2, Vec3};
///
/// // From 5 m away, at eye height, with a picture as wide as it is far away.
/// let lens = Lens::perspective([640, 360], Vec3::new(0.0, -5.0, 1.65), Vec3::new(0.0, 0.0, 1.65), 1.0);
/// assert_eq!(lens.to_px(Vec3::new(1.0, 0.0, 1.65)), Some(Vec2::new(448.0, 180.0)));
/// assert_eq!(lens.to_px(Vec3::new(0.0, -6.0, 1.65)), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Width and height of the picture, pixels.
    pub size_px: [u32; 2],
    /// The eye, world, m.
    pub eye_m: Vec3,
    /// Unit vector to the right of the picture, world.
    pub right: Vec3,
    /// Unit vector down the picture, world.
    pub down: Vec3,
    /// Unit vector along the view, world.
    pub forward: Vec3,
    /// Length of a pixel in (u, v): a tangent in perspective, metres in orthographic projection.
    pub pixel: f32,
    /// Whether rays start at the eye; else they are parallel.
    pub is_perspective: bool,
}

impl Lens {
    /// A perspective lens that looks at a target. `width_tangent` is the film's width over the focal length.
    pub fn perspective(size_px: [u32; 2], eye_m: Vec3, target_m: Vec3, width_tangent: f32) -> Self {
        Self::new(size_px, eye_m, target_m - eye_m, width_tangent, true)
    }

    /// An orthographic lens along a direction, `width_m` wide.
    pub fn orthographic(size_px: [u32; 2], eye_m: Vec3, direction: Vec3, width_m: f32) -> Self {
        Self::new(size_px, eye_m, direction, width_m, false)
    }

    fn new(size_px: [u32; 2], eye_m: Vec3, direction: Vec3, width: f32, is_perspective: bool) -> Self {
        let forward = direction.try_normalize().unwrap_or(Vec3::Y);
        // A view straight down has world y up in the picture.
        let right = forward.cross(Vec3::Z).try_normalize().unwrap_or(Vec3::X);
        let down = forward.cross(right);
        Self { size_px, eye_m, right, down, forward, pixel: width / size_px[0] as f32, is_perspective }
    }

    /// The same lens, turned about the view so that a direction is up in the picture.
    pub fn with_up(self, up: Vec3) -> Self {
        let right = self.forward.cross(up).try_normalize().unwrap_or(self.right);
        Self { right, down: self.forward.cross(right), ..self }
    }

    /// A point in camera space, m.
    pub fn to_camera(&self, point_m: Vec3) -> Vec3 {
        let from_eye = point_m - self.eye_m;
        Vec3::new(self.right.dot(from_eye), self.down.dot(from_eye), self.forward.dot(from_eye))
    }

    /// A direction of camera space in the world.
    pub fn direction_to_world(&self, direction: Vec3) -> Vec3 {
        direction.x * self.right + direction.y * self.down + direction.z * self.forward
    }

    /// A point of camera space in the world, m.
    pub fn to_world(&self, point_m: Vec3) -> Vec3 {
        self.eye_m + self.direction_to_world(point_m)
    }

    /// A point of the world in the picture, pixels; none where it is not in front of the eye.
    pub fn to_px(&self, point_m: Vec3) -> Option<Vec2> {
        let camera_m = self.to_camera(point_m);
        if self.is_perspective && camera_m.z < NEAR_M {
            return None;
        }
        let depth = if self.is_perspective { camera_m.z } else { 1.0 };
        Some(camera_m.truncate() / (depth * self.pixel) + 0.5 * self.size())
    }

    /// (u, v) of a pixel position.
    pub fn to_uv(&self, px: Vec2) -> Vec2 {
        (px - 0.5 * self.size()) * self.pixel
    }

    /// The point at a depth on the ray through (u, v), camera space, m.
    pub fn at_depth(&self, uv: Vec2, depth_m: f32) -> Vec3 {
        if self.is_perspective { (uv * depth_m).extend(depth_m) } else { uv.extend(depth_m) }
    }

    /// Depths at which rays meet the ground, z = 0.
    pub(crate) fn ground(&self) -> GroundDepth {
        let slope = Vec3::new(self.right.z, self.down.z, self.forward.z);
        GroundDepth { height_m: self.eye_m.z, slope, is_perspective: self.is_perspective }
    }

    /// Unit vector of the ray through (u, v), world.
    pub fn ray(&self, uv: Vec2) -> Vec3 {
        let direction = if self.is_perspective { uv.extend(1.0) } else { Vec3::Z };
        self.direction_to_world(direction).normalize()
    }

    /// Length of a pixel at a depth, m.
    pub fn pixel_m(&self, depth_m: f32) -> f32 {
        if self.is_perspective { self.pixel * depth_m.max(NEAR_M) } else { self.pixel }
    }

    /// Width and height of the picture, pixels.
    pub fn size(&self) -> Vec2 {
        Vec2::new(self.size_px[0] as f32, self.size_px[1] as f32)
    }
}

/// Depth of the ground behind everything.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundDepth {
    height_m: f32,
    /// Height that is gained along right, down and forward.
    slope: Vec3,
    is_perspective: bool,
}

impl GroundDepth {
    /// Depth at which the ray through (u, v) meets the ground, m; infinite where it does not.
    #[inline]
    pub(crate) fn depth_m(&self, uv: Vec2) -> f32 {
        let across = self.slope.x * uv.x + self.slope.y * uv.y;
        let depth_m = if self.is_perspective {
            -self.height_m / (across + self.slope.z)
        } else {
            -(self.height_m + across) / self.slope.z
        };
        if depth_m > NEAR_M { depth_m } else { f32::INFINITY }
    }
}
