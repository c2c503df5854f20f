//! Files: databases on disk, atomic writing, and text files with errors that state the line.
//!
//! Enters: paths and bytes. Leaves: databases, texts, or an error that names the file and the remedy.
//!
//! Read `database_file` (`.fbdb`) with its `file_kind` and `container`, then `atomic_file` with `temporary_files`, and
//! `input_file`, then `source_text` with `parser_words` and `list_entries`.

pub mod atomic_file;
pub mod container;
pub mod database_file;
pub mod file_kind;
pub mod input_file;
mod list_entries;
pub(crate) mod parser_words;
pub(crate) mod source_text;
pub mod temporary_files;

pub use source_text::{Invalid, SourceText};
