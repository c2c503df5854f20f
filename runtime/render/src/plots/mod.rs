//! Plots. `chart` draws figures with axes, marks and labels; `crowd` and `database` draw one plot per file.
//!
//! Enters: recordings, figures of benches, databases. Leaves: opaque pictures, or PNG files.

pub(crate) mod chart;
pub mod crowd;
pub mod database;
