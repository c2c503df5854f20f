//! The figure: one posed skeleton as surfaces that read as a person at eye height.
//!
//! Enters: a recorded root and pose, the skeleton, a look. Leaves: a skinned mesh of lofted sections, or at crowd distance
//! rounded cones; and always the rounded cones by which occlusion is computed. World, metres.
//!
//! Sections are stated in the rest pose of a body 1.775 m high (x forward, y left, z up, arms straight out), and scaled
//! to the skeleton. Read `style` (sex, age, hair, clothes of an agent), `section` and `loft` (sections to a mesh), `template` (a mesh and its
//! joints), `build` (the frame of reference), then `trunk`, `limbs`, `hand`, `foot`, `head`, `hair` and `skirt`, `cone_figure` (the
//! crowd's), and `figures` (all of it).

pub(crate) mod build;
pub(crate) mod cone_figure;
pub(crate) mod figures;
mod foot;
mod hair;
mod hand;
mod head;
mod limbs;
mod loft;
mod section;
mod skirt;
pub(crate) mod style;
mod template;
mod trunk;

pub(crate) use figures::{Figures, Wanted};
pub(crate) use style::BodySize;
