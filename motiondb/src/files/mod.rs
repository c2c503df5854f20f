//! Files: reading without surprises, writing whole or not at all.
//!
//! Read `database_file` (`.fbdb`) with its `container`, then `atomic_file` and `input_file`, then `source_text`, which
//! reports a mistake at its line, and `parser_words`.

pub mod atomic_file;
pub mod container;
pub mod database_file;
pub mod input_file;
pub(crate) mod parser_words;
pub(crate) mod source_text;

pub use source_text::{Invalid, SourceText};
