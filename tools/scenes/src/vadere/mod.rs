//! Scenarios of Vadere (`.scenario`, JSON): bounds, obstacles, targets, sources, single agents. Tested with files of
//! releases 2.4 and 3.0, which state sources and targets by other keys.
//!
//! Enters: the path of a file. Leaves: a [`Scene`](crate::scene::Scene). Read `vadere_file` (the keys) and `shapes`, then `topography`
//! (ground and order of reading), `targets` (goals and states), `sources`.

mod shapes;
mod sources;
mod targets;
mod topography;
mod vadere_file;

pub(crate) use topography::read;
