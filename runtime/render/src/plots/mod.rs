//! Plots of databases, recordings and benches.
//!
//! Enters: a database, a character, the tracks of a recording, or measures of a bench. Leaves: opaque pictures, or PNG files.
//!
//! Read `chart` (figures with axes, marks and labels), then `database` and `crowd`, which draw one plot per file, and
//! `character`, a picture of a figure.

pub mod character;
pub(crate) mod chart;
pub mod crowd;
pub mod database;
