//! Pictures of recordings and databases: frames of the top view, pictures of velocity space, plots; PNG and EXR.
//!
//! Chapters, in reading order: [`top_view`] (a recording becomes a sequence of frames), [`constraints`] (why a velocity
//! was planned), [`plots`], and what they draw with: [`raster`].

pub mod constraints;
pub mod error;
pub mod plots;
pub mod raster;
pub mod top_view;
