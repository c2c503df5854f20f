//! A BVH file → checked joints, numbers and diagnostics. See [`crate::read::bvh`] for why.

use std::io::BufRead;

use motiondb::diagnostic::Diagnostic;
use motiondb::files::input_file;

use crate::error::RejectionReason;
use crate::read::bvh::hierarchy::{CheckedJoint, checked_hierarchy};
use crate::read::bvh::lines::TextLines;
use crate::read::bvh::motion_section::{MotionSection, checked_motion};
use crate::read::malformed::malformed_line;

/// A BVH file after all checks.
#[derive(Debug)]
pub(crate) struct CheckedBvh {
    /// Joints and end sites in file order.
    pub joints: Vec<CheckedJoint>,
    /// Numbers of the motion section.
    pub motion: MotionSection,
    /// Wrong counts, and parts of the file that are not used.
    pub diagnostics: Vec<Diagnostic>,
}

/// Checks a BVH file.
pub(crate) fn check(mut reader: impl BufRead) -> Result<CheckedBvh, RejectionReason> {
    let first = reader.fill_buf().map_err(|error| RejectionReason::unreadable(&error))?;
    if first.is_empty() {
        return malformed_line(1, "the file is empty", "export the clip again");
    }
    if input_file::is_utf16(first) {
        return malformed_line(1, "the text is UTF-16, two bytes a letter", "save it as UTF-8 or plain ASCII");
    }
    if first.starts_with(b"\xef\xbb\xbf") {
        reader.consume(3);
    }
    let mut lines = TextLines::new(reader);
    let (joints, motion_line) = checked_hierarchy(&mut lines)?;
    let mut diagnostics = Vec::new();
    let motion = checked_motion(&mut lines, motion_line, &joints, &mut diagnostics)?;
    Ok(CheckedBvh { joints, motion, diagnostics })
}
