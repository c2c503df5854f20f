//! The `[[sources]]` tables of a scenario file: agents that come during the simulation.
//!
//! Read `source_tables` (the keys), then `schedule_value` (rows of times) and `schedule_file` (the same in a CSV file).

mod schedule_file;
mod schedule_value;
mod source_tables;

pub(crate) use source_tables::{SourceTable, sources};
