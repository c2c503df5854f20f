//! Compile, simulate and render as jobs: what the command line, the benches and bindings to other languages share.
//!
//! A job takes plain values, reports its progress to an [`observer`], and returns a typed value or a
//! [`JobError`]. It prints nothing, and it knows neither a terminal nor exit codes.
//!
//! ```no_run
//! use std::path::Path;
//!
//! use fbcrowd_jobs::compiling::{Overrides, compile, write_database};
//! use fbcrowd_jobs::rendering::{open, plot_trajectories};
//! use fbcrowd_jobs::simulation::{SimulationInput, simulate};
//! use fbcrowd_jobs::{JobError, JobEvent};
//! use fbcrowd_sim::scenario;
//!
//! # fn main() -> Result<(), JobError> {
//! let observer = |event: JobEvent<'_>| {
//!     if let JobEvent::Note(note) = event {
//!         eprintln!("{note}");
//!     }
//! };
//! let (database, recording) = (Path::new("motion.fbdb"), Path::new("crossing.fbrec"));
//! let compiled = compile(&["assets/clips".into()], database, &Overrides::default(), &observer)?;
//! let database_checksum = write_database(database, &compiled.db, &observer)?;
//! let (scenario, _) = scenario::read(Path::new("assets/scenarios/crossing.toml"))?;
//! let input = SimulationInput { db: compiled.db, database_checksum, scenario, character_checksums: Vec::new() };
//! let timings = simulate(input, recording, &observer)?;
//! println!("{:.0} × real time", timings.times_real_time);
//! plot_trajectories(&open(recording)?, Path::new("trajectories.png"))?;
//! # Ok(())
//! # }
//! ```
//!
//! Read in this order: what a job reports ([`observer`], [`stages`]) and how it fails ([`error`]); paths
//! ([`clip_paths`], [`output_path`]); the jobs ([`compiling`], [`leave_one_out`], [`simulation`] with [`timings`],
//! [`rendering`]); [`character`] and [`camera_file`]; [`scene_check`] looks at a scenario beforehand; [`wording`] for texts that count things; [`json_schema`] for the schemas of reports.

pub mod camera_file;
pub mod character;
pub mod clip_paths;
pub mod compiling;
pub mod error;
pub mod json_schema;
pub mod leave_one_out;
pub mod observer;
pub mod output_path;
pub mod rendering;
pub mod scene_check;
pub mod simulation;
pub mod stages;
pub mod timings;
pub mod wording;

pub use crate::error::JobError;
pub use crate::observer::{JobEvent, Observer};
