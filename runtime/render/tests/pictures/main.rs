//! Pictures as users get them: whole sequences, golden images, plots of databases.

mod golden;
mod overlay;
mod plots;
mod sequence;
mod support;
