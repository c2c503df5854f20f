//! The speed of reading BVH files, against `bvh_anim` alone: the same bytes, in turns.
//!
//! Ours is bytes to [`motiondb_compiler::read::SourceClip`]: checked, parsed and posed. `bvh_anim` alone only
//! parses. It panics on some files that are read here, or takes as much memory as they claim. For such files it gets
//! the canonical text that the importer makes for it.

use std::hint::black_box;
use std::path::Path;

use motiondb::statistics;
use motiondb_compiler::RejectionReason;
use motiondb_compiler::read::{bvh, catch_panic};

/// Median durations of both readers for one file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReadingTimes {
    /// Bytes to `SourceClip`, s.
    pub(crate) ours_s: f64,
    /// `bvh_anim` alone, s.
    pub(crate) alone_s: f64,
}

/// Reads a file's bytes several times with both readers; `clock` returns the time, s.
///
/// # Errors
/// If the file is not BVH.
pub(crate) fn reading_times(
    file: &Path,
    bytes: &[u8],
    times: usize,
    clock: &dyn Fn() -> f64,
) -> Result<ReadingTimes, RejectionReason> {
    let clip = bvh::read(file, bytes)?;
    let canonical = bvh::canonical_text(bytes).unwrap_or_default().into_bytes();
    // A wrong `Frames:` gives a warning; one that claims terabytes would end the process.
    let survives =
        clip.diagnostics.is_empty() && catch_panic::catch(|| bvh_anim::from_bytes(bytes).is_ok()) == Some(true);
    let readable = if survives { bytes } else { &canonical };
    let (mut ours_s, mut alone_s) = (Vec::new(), Vec::new());
    for _ in 0..times {
        ours_s.push(seconds(clock, || drop(black_box(bvh::read(file, bytes)))));
        alone_s.push(seconds(clock, || drop(black_box(bvh_anim::from_bytes(readable)))));
    }
    let median = |times_s: Vec<f64>| statistics::median(times_s).unwrap_or(f64::NAN);
    Ok(ReadingTimes { ours_s: median(ours_s), alone_s: median(alone_s) })
}

/// Duration of some work, s.
fn seconds(clock: &dyn Fn() -> f64, work: impl FnOnce()) -> f64 {
    let start_s = clock();
    work();
    clock() - start_s
}
