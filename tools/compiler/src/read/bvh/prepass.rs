//! Bytes of a BVH file → checked joints, numbers and diagnostics. See [`crate::read::bvh`] for why.

use motiondb::diagnostic::Diagnostic;
use motiondb::files::input_file;

use crate::error::RejectionReason;
use crate::read::bvh::hierarchy::{CheckedJoint, checked_hierarchy};
use crate::read::bvh::lines::numbered_lines;
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

/// Checks the bytes of a BVH file.
pub(crate) fn check(bytes: &[u8]) -> Result<CheckedBvh, RejectionReason> {
    if bytes.is_empty() {
        return malformed_line(1, "the file is empty", "export the clip again");
    }
    if input_file::is_utf16(bytes) {
        return malformed_line(1, "the text is UTF-16, two bytes a letter", "save it as UTF-8 or plain ASCII");
    }
    let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let mut lines = numbered_lines(&text);
    let (joints, motion_line) = checked_hierarchy(&mut lines)?;
    let mut diagnostics = Vec::new();
    let motion = checked_motion(lines, motion_line, &joints, &mut diagnostics)?;
    Ok(CheckedBvh { joints, motion, diagnostics })
}
