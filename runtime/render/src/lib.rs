//! Pictures of recordings and databases: PNG and EXR sequences, plots.
//!
//! A top view goes, in reading order: numbers of frames ([`frame_range`]) → bodies at each frame's time ([`playback`])
//! → the window onto the world ([`framing`]) → what stands still ([`ground`]) → where all have walked ([`trails`]) →
//! [`shade`] → limbs ([`body`], painted by [`cone`], coloured by [`palette`]) → writing ([`overlay`], [`text`]) → the
//! picture ([`top_view`]) → where asked for, why an agent goes where it goes ([`overlay_constraints`]: marks in the
//! scene, `overlay_scene`; its velocity space, `velocity_panel`, `permitted`; legend and numbers, `constraint_key`) →
//! files ([`png_frame`], [`exr_frame`], all of them by [`sequence`]).
//!
//! Plots stand on a small kit ([`plot`], [`axis`], [`mark`], `name_places`): everybody's paths ([`trajectories`]),
//! those of several runs beside each other ([`side_by_side`]), figures of many runs ([`comparison_plot`]), points
//! against a published curve ([`diagram_plot`]); of a database its velocity sets ([`velocity_plot`]), blend space
//! ([`parameter_plot`]) and where it is thin ([`coverage_plot`]), bodies and sticks ([`contact_sheet`], `stick`), steps
//! ([`gait_plot`]) and correspondences ([`pose_distance_plot`]), all of them by [`database_plots`].
//!
//! Conventions: world metres, x right and y up in the picture; pixels, x right and y down; colours sRGB-encoded, 0 to
//! 1.

pub mod axis;
pub mod body;
pub mod comparison_plot;
pub mod cone;
mod constraint_key;
pub mod contact_sheet;
pub mod coverage_plot;
pub mod database_plots;
pub mod diagram_plot;
pub mod error;
pub mod exr_frame;
pub mod frame_range;
pub mod framing;
pub mod gait_plot;
pub mod ground;
pub mod mark;
mod name_places;
pub mod overlay;
pub mod overlay_constraints;
mod overlay_scene;
pub mod palette;
pub mod parameter_plot;
mod permitted;
pub mod playback;
pub mod plot;
pub mod png_frame;
pub mod pose_distance_plot;
pub mod sequence;
pub mod shade;
pub mod side_by_side;
mod stick;
pub mod text;
pub mod top_view;
pub mod trails;
pub mod trajectories;
mod velocity_panel;
pub mod velocity_plot;
