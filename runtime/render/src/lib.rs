//! Pictures of recordings and databases: PNG and EXR sequences, plots.
//!
//! A top view goes, in reading order: numbers of frames ([`frame_range`]) → bodies at each frame's time ([`playback`]) → the window onto the
//! world ([`framing`]) → what stands still ([`ground`]) → where all have walked ([`trails`]) → [`shade`] → limbs ([`body`], painted by
//! [`cone`], coloured by [`palette`]) → writing ([`overlay`], [`text`]) → the picture ([`top_view`]) → files ([`png_frame`], [`exr_frame`],
//! all of them by [`sequence`]).
//!
//! Conventions: world metres, x right and y up in the picture; pixels, x right and y down; colours sRGB-encoded, 0 to 1.

pub mod body;
pub mod cone;
pub mod error;
pub mod exr_frame;
pub mod frame_range;
pub mod framing;
pub mod ground;
pub mod overlay;
pub mod palette;
pub mod playback;
pub mod plot;
pub mod png_frame;
pub mod sequence;
pub mod shade;
pub mod text;
pub mod top_view;
pub mod trails;
pub mod trajectories;
