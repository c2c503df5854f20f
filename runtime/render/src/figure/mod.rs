//! The figure: one posed skeleton as parts that read as a person at eye height.
//!
//! Enters: a recorded root and pose, the skeleton, a look. Leaves: rounded cones, and where they serve surfaces, world,
//! metres.

use fbcrowd_sim::recording::AgentFrame;
use glam::Vec3;
use motiondb::body::Skeleton;

use crate::raster::drawn_body::{self, Detail};
use crate::raster::palette::{Look, decode_srgb};
use crate::visibility::{Cone, Owner, SceneParts};

/// Appends the parts of one agent's body, which is `height_px` high in the picture.
pub(crate) fn append_figure(
    parts: &mut SceneParts,
    skeleton: &Skeleton,
    frame: &AgentFrame,
    look: &Look,
    _height_px: f32,
) {
    let mut drawn = Vec::new();
    drawn_body::append_parts(&mut drawn, skeleton, frame, *look, Detail::Full);
    let owner = Owner { agent: frame.id.0, material: 1 };
    parts.cones.extend(drawn.iter().map(|part| Cone {
        ends_m: part.ends_m,
        radii_m: part.radii_m,
        colour: part.colour.map(decode_srgb).min(Vec3::ONE),
        owner,
    }));
}
