//! The generator of the bundled clips.
