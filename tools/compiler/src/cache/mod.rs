//! Cache: results of earlier compilations, so that a library of which one file changed costs that file's own time.
//!
//! A result is stored under the SHA-256 of all that it follows from (file `key`): bytes of the file, settings, sources of
//! this program, and of an analysis also the body that all examples share. So a stored result is the computed one, and
//! a database is the same bytes with and without a cache. What is damaged, cut, of another program or not there is
//! computed again.
//!
//! Enters: settings of clips. Leaves: imported clips without frames, their analysis, and known comparisons.
//!
//! Read `key`, `cache_folder` (files on disk), then `stored_results`.

pub(crate) mod cache_folder;
pub(crate) mod key;
pub(crate) mod stored_results;

pub use stored_results::Cache;
