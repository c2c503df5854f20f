//! A text that is written beside the scenario file.

/// A text beside the scenario file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextFile {
    /// Name of the file.
    pub name: String,
    /// Its content.
    pub text: String,
}
