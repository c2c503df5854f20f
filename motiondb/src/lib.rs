//! The motion database: the nouns that the offline compiler and the runtime share.
//!
//! Chapters, in reading order: [`body`] (skeleton and poses), [`diagnostic`] (what is reported of clips), [`motion`] (parameters, examples, the database, where
//! synthesis may switch), [`velocity_sets`] (`FbCrowd` §4.1), [`blend_space`] (§5), [`quality`], [`validate`] (the
//! invariants) and [`files`].
//!
//! Conventions: metres, seconds, radians; x and y on the ground, z up, right-handed. A body's frame: x forward, y left.
//! Angles are counter-clockwise seen from above. Pairs of sides are `[left, right]`.

pub mod blend_space;
pub mod body;
pub mod diagnostic;
pub mod files;
pub mod motion;
pub mod quality;
pub mod statistics;
pub mod validate;
pub mod velocity_sets;
