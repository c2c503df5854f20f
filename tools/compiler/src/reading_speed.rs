//! How fast BVH files are read, against `bvh_anim` alone: the same bytes, the same run, turn about.
//!
//! Ours is bytes to [`crate::read::source_clip::SourceClip`]: checked, parsed and posed. `bvh_anim` by itself only parses. It
//! panics on some files that are read here, or takes their memory by what they claim: those it gets in the canonical
//! text that the importer makes for it.

use std::hint::black_box;
use std::path::Path;

use motiondb::statistics;

use crate::error::RejectionReason;
use crate::read::{bvh, catch_panic};

/// Seconds that both readers took for one file, the median of several times.
#[derive(Clone, Copy, Debug)]
pub struct Race {
    /// Bytes to `SourceClip`.
    pub ours_s: f64,
    /// `bvh_anim`.
    pub alone_s: f64,
}

/// Reads a file's bytes some times with both readers; `clock` tells the seconds since some moment.
///
/// # Errors
/// Where the file is no BVH.
pub fn race(file: &Path, bytes: &[u8], times: usize, clock: &dyn Fn() -> f64) -> Result<Race, RejectionReason> {
    let clip = bvh::read(file, bytes)?;
    let canonical = bvh::prepass::check(bytes).map(|checked| checked.text(usize::MAX).into_bytes()).unwrap_or_default();
    // A lying `Frames:` is warned of; one that claims terabytes would end the process.
    let survives =
        clip.diagnostics.is_empty() && catch_panic::catch(|| bvh_anim::from_bytes(bytes).is_ok()) == Some(true);
    let digestible = if survives { bytes } else { &canonical };
    let (mut ours_s, mut alone_s) = (Vec::new(), Vec::new());
    for _ in 0..times {
        ours_s.push(seconds(clock, || drop(black_box(bvh::read(file, bytes)))));
        alone_s.push(seconds(clock, || drop(black_box(bvh_anim::from_bytes(digestible)))));
    }
    let median = |times_s: Vec<f64>| statistics::median(times_s).unwrap_or(f64::NAN);
    Ok(Race { ours_s: median(ours_s), alone_s: median(alone_s) })
}

fn seconds(clock: &dyn Fn() -> f64, work: impl FnOnce()) -> f64 {
    let start_s = clock();
    work();
    clock() - start_s
}
