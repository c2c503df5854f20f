//! The database: parameters, rows and correspondence of the selected cycles.

pub(crate) mod correspondence;
pub(crate) mod parameterize;
pub(crate) mod rows;

pub use correspondence::find;
