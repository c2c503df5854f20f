//! Bodies in the cells of a sheet, from the side, from the front and from above. Poses in metres; positions on the sheet
//! in pixels, y down.

use glam::{Mat3, Vec2, Vec3};
use motiondb::body::{Pose, Skeleton};
use tiny_skia::Pixmap;

use crate::plots::database::stick_figure;
use crate::raster::drawn_body::DrawnPart;
use crate::raster::tapered_capsule::{Canvas, TaperedCapsule};

/// Width and height of a body's cell, pixels.
pub(crate) const CELL_PX: Vec2 = Vec2::new(94.0, 150.0);
/// Scale of bodies up to [`HEIGHT_MAX_M`], pixels per metre; taller ones are reduced to fit.
const SCALE_PX_M: f32 = 66.0;
/// Greatest height of a body at full scale, m.
const HEIGHT_MAX_M: f32 = 1.95;
/// Width of the dark rim around a limb, pixels.
const RIM_PX: f32 = 1.5;
/// Displacement of bodies towards the eye, m: no part is below the paper, which would hide it.
const DEPTH_OFFSET_M: f32 = 2.0;

/// A direction of view.
pub(crate) struct BodyView {
    /// Name of the view on the sheet.
    pub(crate) name: &'static str,
    /// Axes of the view in the root frame: right, up, towards the eye.
    pub(crate) axes: [Vec3; 3],
    /// Height of the body's root above the ground line, pixels: bodies from above are centred in their cell.
    pub(crate) lift_px: f32,
}

/// The three views.
pub(crate) const VIEWS: [BodyView; 3] = [
    BodyView { name: "from its right side", axes: [Vec3::X, Vec3::Z, Vec3::NEG_Y], lift_px: 0.0 },
    BodyView { name: "from the front", axes: [Vec3::Y, Vec3::Z, Vec3::X], lift_px: 0.0 },
    BodyView { name: "from above", axes: [Vec3::X, Vec3::Y, Vec3::Z], lift_px: 56.0 },
];

/// Scale at which a body of the skeleton fits into its cell.
pub(crate) fn scale_px_m(skeleton: &Skeleton) -> f32 {
    SCALE_PX_M * (HEIGHT_MAX_M / skeleton.height_m()).min(1.0)
}

/// Draws a pose as a stick figure with its root at `at_px`.
pub(crate) fn draw_sticks(pixmap: &mut Pixmap, skeleton: &Skeleton, pose: &Pose, view: &BodyView, at_px: Vec2) {
    let scale_px_m = scale_px_m(skeleton);
    let to_px = |point_m: Vec3| at_px + scale_px_m * Vec2::new(view.axes[0].dot(point_m), -view.axes[1].dot(point_m));
    stick_figure::sticks(skeleton, pose).iter().for_each(|stick| stick_figure::draw(pixmap, stick, to_px));
}

/// Draws a body with its root at `at_px`: parts from the farthest to the nearest.
pub(crate) fn draw_body(canvas: &mut Canvas, parts: &[DrawnPart], view: &BodyView, scale_px_m: f32, at_px: Vec2) {
    let to_view = Mat3::from_cols(view.axes[0], view.axes[1], view.axes[2]).transpose();
    let to_px = |point: Vec3| {
        let in_view = (to_view * point + Vec3::Z * DEPTH_OFFSET_M) * scale_px_m;
        Vec3::new(at_px.x + in_view.x, at_px.y - in_view.y, in_view.z)
    };
    let mut capsules: Vec<(TaperedCapsule, Vec3)> =
        parts.iter().map(|part| (part.to_capsule(to_px, scale_px_m), part.colour)).collect();
    let depth = |capsule: &TaperedCapsule| capsule.ends_px[0].z + capsule.ends_px[1].z;
    capsules.sort_by(|one, other| depth(&one.0).total_cmp(&depth(&other.0)));
    for (capsule, colour) in &capsules {
        canvas.paint(capsule, *colour, RIM_PX);
    }
}
