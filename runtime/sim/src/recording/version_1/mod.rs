//! Format version 1, frozen: its header in bincode, and its index. These types never change; they are converted into
//! today's.
//!
//! A file of version 1 has the same agents in all frames. Its frames hold no number, ids or states; the 200 bytes of an
//! agent are those of version 2. Walls held the disc of `radius_m`.
//!
//! Read `header`, then `body` and `params`, its parts.

mod body;
mod header;
mod params;

pub(crate) use header::{read_header, read_index};
