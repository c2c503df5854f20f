//! Pictures as users get them: whole sequences, golden images, plots of databases.

mod camera;
mod golden;
mod overlay;
mod plots;
mod scene_ground;
mod sequence;
mod support;
