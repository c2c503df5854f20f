//! Characters: figures as other tools write them give a character, or are rejected by name.
//!
//! `figure` makes the files; `read`, `textures` and `poses` are about those that are read, `refused` and `many_legs` about the others.

mod figure;
mod many_legs;
mod poses;
mod read;
mod refused;
mod support;
mod textures;
