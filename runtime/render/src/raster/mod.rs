//! Pixels: shapes, colours, text, and picture files.
//!
//! Enters: bodies in world metres, shapes and texts in pixels. Leaves: opaque sRGB pictures, PNG and EXR files.
//!
//! Read `drawn_body` and `tapered_capsule` (bodies), then `palette`, `paint`, `pixels` and `text`, then `strips`, `png_frame`,
//! `scan_lines` with `exr_header`, `exr_frame` and `colour_space`.

pub(crate) mod colour_space;
pub(crate) mod drawn_body;
pub(crate) mod exr_frame;
pub(crate) mod exr_header;
pub(crate) mod paint;
pub(crate) mod palette;
pub(crate) mod pixels;
pub mod png_frame;
pub(crate) mod scan_lines;
pub(crate) mod strips;
pub(crate) mod tapered_capsule;
pub(crate) mod text;

pub use palette::decode_srgb;
pub use png_frame::RgbPicture;
