//! A point of a cone or a triangle: position, normal and colour. World, metres.

use glam::{Vec3, Vec4};

use crate::visibility::part::Shape;
use crate::visibility::rounded_cone::PreparedCone;
use crate::visibility::triangle::weights;
use crate::visibility::{Fragment, Lens, Owner, SceneParts};

/// Cosine of the angle to the eye below which a triangle shows its back: normals between its corners bend past the edge.
const BACK_COS: f32 = -0.2;

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfacePoint {
    pub(crate) point_m: Vec3,
    /// Unit vector, on the eye's side.
    pub(crate) normal: Vec3,
    /// Linear Rec. 709.
    pub(crate) colour: Vec3,
    pub(crate) owner: Owner,
}

impl SurfacePoint {
    /// The point of a fragment; none of ground and sky.
    pub(crate) fn of(fragment: &Fragment, scene: &SceneParts, lens: &Lens) -> Option<Self> {
        let point_m = lens.to_world(fragment.point_m);
        Some(match scene.shape(fragment.part)? {
            Shape::Cone(cone) => {
                let cone = &scene.cones[cone];
                let normal = PreparedCone::new(cone, lens).normal(fragment.point_m);
                Self { point_m, normal: lens.direction_to_world(normal), colour: cone.colour, owner: cone.owner }
            }
            Shape::Triangle(triangle) => Self::of_triangle(triangle, point_m, scene, lens),
        })
    }

    fn of_triangle(triangle: usize, point_m: Vec3, scene: &SceneParts, lens: &Lens) -> Self {
        let meshes = &scene.meshes;
        let weights = weights(meshes.corners_m(triangle), point_m);
        let normal = meshes.blended(triangle, weights, &meshes.normals).try_normalize().unwrap_or(Vec3::Z);
        let to_eye = if lens.is_perspective { (lens.eye_m - point_m).normalize_or_zero() } else { -lens.forward };
        // Both sides of a triangle are drawn.
        let normal = if normal.dot(to_eye) < BACK_COS { -normal } else { normal };
        let mut colour = meshes.blended(triangle, weights, &meshes.colours);
        if let Some(paint) = meshes.paint(triangle) {
            // A surface that is seen at an angle has a longer footprint.
            let facing = normal.dot(to_eye).max(0.1);
            let footprint_m = lens.pixel_m(lens.to_camera(point_m).z) / facing.sqrt();
            let texel = scene.texel(triangle, weights, footprint_m).unwrap_or(Vec4::ONE);
            colour = paint.dye.applied(colour * texel.truncate(), paint.keeps_hue);
        }
        Self { point_m, normal, colour, owner: meshes.owners.of(triangle) }
    }
}
