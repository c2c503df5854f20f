//! Characters: figures as other tools write them give a character, or are rejected by name.
//!
//! `figure` and `vrm` make the files; `read`, `textures`, `poses`, `fingers` and `palms` are about those that are read, `refused`, `many_legs` and `animals` about the others.

mod animals;
mod figure;
mod fingers;
mod many_legs;
mod palms;
mod poses;
mod read;
mod refused;
mod support;
mod textures;
mod vrm;
