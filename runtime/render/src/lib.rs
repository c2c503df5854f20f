//! Pictures of recordings and databases: frames of the top view, pictures of velocity space, plots; PNG and EXR.
//!
//! Render a recording from above, every second frame, as `frames/crossing.1001.png` and so on:
//!
//! ```no_run
//! use std::path::{Path, PathBuf};
//!
//! use fbcrowd_render::{PictureFormat, RenderError, SequenceOptions, render_sequence};
//! use fbcrowd_sim::Recording;
//!
//! fn main() -> Result<(), RenderError> {
//!     let recording = Recording::open(Path::new("crossing.fbrec"))?;
//!     let options = SequenceOptions {
//!         folder: PathBuf::from("frames"),
//!         name: "crossing".to_owned(),
//!         format: PictureFormat::Png,
//!         frames: Some("1001-1100x2".parse()?),
//!         shot: None, // as the scenario states
//!         constraints_of: vec![3], // explain the velocities of agent 3 beside the scene
//!     };
//!     let files = render_sequence(&recording, &options, &|done, all| println!("frame {done} of {all}"))?;
//!     println!("{} pictures, the first is {}", files.len(), files[0].display());
//!     Ok(())
//! }
//! ```
//!
//! To draw single frames in memory, see [`TopView`] and `examples/draw_one_frame.rs`.
//!
//! Chapters, in reading order: [`top_view`] (a recording becomes a sequence of frames), [`camera`] (the same at eye height,
//! by [`visibility`], [`shading`], the figure of a body and the levels of detail of characters), [`constraints`] (why a velocity was planned), [`plots`], and
//! what they draw with: [`raster`]. Faults are [`RenderError`]s.
//!
//! Conventions: world in metres, x right, y up; pixels x right, y down. Colours are sRGB, 0 to 1.

pub mod camera;
pub mod constraints;
pub(crate) mod detail;
pub mod error;
pub(crate) mod figure;
pub mod passes;
pub mod plots;
pub mod raster;
pub mod shading;
pub mod top_view;
pub mod visibility;

pub use constraints::ConstraintOverlay;
pub use error::RenderError;
pub use raster::png_frame;
pub use top_view::{FrameRange, Framing, PictureFormat, SequenceOptions, TopView, Tracks, render_sequence};
