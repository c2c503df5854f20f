//! BVH → [`SourceClip`], in the file's unit and axes.
//!
//! # What `bvh_anim` does
//! The crate `bvh_anim` 0.4 parses `HIERARCHY` into joints (name, OFFSET, CHANNELS) and `MOTION` into `f32` values. It
//! numbers the channels: a joint's channel knows its type, its axis and its column in a row of motion.
//!
//! # What our pre-pass does
//! `prepass` reads the text first. It checks every statement of the hierarchy (`hierarchy`) and every number of the
//! motion (`motion_section`, as `f64`), and names the line of each mistake. It accepts files as other tools write them:
//! a byte order mark, CR or CRLF, any case of keywords, a brace beside a keyword, leaves without an End Site, a wrong
//! `Frames:`, text after the last row. It reads line by line and limits the length of lines, the number of joints and the
//! number of frames.
//!
//! # Why both
//! `bvh_anim` alone cannot read files as other tools write them. It panics on a byte order mark, a joint without a
//! name, an extra brace and a huge `Frames:`. It cuts names at spaces, drops a last joint without an End Site, and
//! rejects a wrong `Frames:`, channels in another case, a brace beside a keyword and bare CR. The pre-pass alone does
//! not number the channels. So `canonical_text` rewrites the checked hierarchy (joints `j0`, `j1` …, an End Site on
//! every leaf, no frames), `bvh_anim` reads that, and `kinematics` applies its channels to the checked numbers. Each
//! number of the motion is parsed once.
//!
//! # Poses
//! A joint's frame is its parent's frame, translated by OFFSET or by position channels, then rotated by its rotation
//! channels in the file's order. Angles in degrees.

mod canonical_text;
mod hierarchy;
mod kinematics;
mod lines;
mod motion_section;
pub(crate) mod prepass;

use std::io::BufRead;
use std::path::Path;

use crate::error::RejectionReason;
use crate::read::malformed::malformed_line;
use crate::read::source_clip::SourceClip;
use crate::read::source_motion::SourceMotion;

/// The text of a BVH file that `bvh_anim` can read, with all frames; none if the file is not BVH.
pub fn canonical_text(bytes: &[u8]) -> Option<String> {
    prepass::check(bytes).ok().map(|checked| checked.text(usize::MAX))
}

/// The clip of a BVH file, which is read piece by piece; `file` gives the clip's file name.
///
/// # Errors
/// [`RejectionReason::Malformed`] at the line that breaks the format; [`RejectionReason::Unreadable`] and
/// [`RejectionReason::OutOfMemory`].
pub fn read(file: &Path, reader: impl BufRead) -> Result<SourceClip, RejectionReason> {
    open(file, reader)?.into_whole_clip()
}

/// The motion of a BVH file, as [`read`], before its frames are posed.
pub(crate) fn open(file: &Path, reader: impl BufRead) -> Result<SourceMotion<'static>, RejectionReason> {
    let checked = prepass::check(reader)?;
    let channels = bvh_anim::from_str(&checked.text(0))
        .or_else(|error| malformed_line(1, error.to_string(), "export the clip again"))?;
    Ok(kinematics::source_motion(file, checked, &channels))
}
