//! The motion database: the nouns that the offline compiler and the runtime share.
//!
//! In reading order: whose body ([`skeleton`]), how it is posed ([`pose`]) and how far its joints turn
//! ([`joint_ranges`]), how a clip moves ([`parameters`]) and when ([`phase_map`]), which velocities it allows
//! ([`velocity_hull`], [`convex_hull`], [`wrapping_polygon`], `FbCrowd` §4.1), how clips blend ([`blend_space`] by
//! [`triangulation`], [`locator`], §5),
//! where synthesis may switch ([`correspondence`] by [`pose_distance`], §5, Eq. 10), the database itself
//! ([`motion_db`]) with what was found in its clips ([`diagnostic`]), what its feet do on the ground ([`planted_feet`]), its
//! invariants ([`validate`]; of the blend space [`tiling`], on the [`lattice`]), how good its examples are
//! ([`quality`]), where it is thin ([`coverage`]) and its file ([`mod@file`]).
//!
//! Conventions: metres, seconds, radians; x and y on the ground, z up, right-handed. A body's frame: x forward, y left.
//! Angles are counter-clockwise seen from above. Pairs of sides are `[left, right]`.

pub mod atomic_file;
pub mod blend_space;
pub mod container;
pub mod convex_hull;
pub mod correspondence;
pub mod coverage;
pub mod diagnostic;
pub mod file;
mod grid;
pub mod input_file;
pub mod joint_ranges;
pub mod lattice;
pub mod locator;
pub mod median;
pub mod motion_db;
pub mod parameters;
mod parser_words;
pub mod phase_map;
pub mod planted_feet;
pub mod pose;
pub mod pose_distance;
pub mod quality;
mod simplex;
pub mod skeleton;
pub mod source_text;
mod surface;
pub mod tiling;
pub mod triangulation;
pub mod validate;
pub mod velocity_hull;
pub mod wrapping_polygon;
