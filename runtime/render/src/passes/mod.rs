//! Passes of a camera frame: what a compositor needs beside the picture.
//!
//! Enters: the samples of a tile ([`crate::visibility`]), and the scene one frame earlier and later. Leaves: the
//! channels of an EXR file.
//!
//! | pass | channels | type | meaning |
//! |---|---|---|---|
//! | `z` | `Z` | float | distance from the camera's plane, m, of the nearest sample; 1e10 where there is only sky |
//! | `n` | `N.X N.Y N.Z` | half | unit normal, world, at the nearest sample; 0 for the sky |
//! | `p` | `P.X P.Y P.Z` | float | position, world, m, of the nearest sample; 0 for the sky |
//! | `motion` | `forward.u forward.v backward.u backward.v` | half | pixels to where the same point is one frame later and earlier; u right, v up |
//! | `agent`, `group`, `material` | `CryptoAsset00.R` … | float | Cryptomatte 1.2 by agent, by group of agents, by material |
//! | `id` | `agent.id` | uint | id of the nearest agent plus 1; 0 for all else |
//!
//! Read `pass` (the choice), `cryptomatte`, `mattes` (names), `tile_mattes`, `motion`, `tile_passes` (one tile), and
//! `multi_channel_exr` (the file).

pub(crate) mod camera_matrices;
pub(crate) mod cryptomatte;
pub(crate) mod mattes;
pub(crate) mod motion;
pub(crate) mod multi_channel_exr;
pub(crate) mod pass;
pub(crate) mod tile_mattes;
pub(crate) mod tile_passes;

pub use crate::raster::colour_space::ColourSpace;
pub use multi_channel_exr::ExrCompression;
pub use pass::{Pass, PassSet};
