//! Runs of equal flags in a sequence with one flag a frame: the contacts and the swings of a foot, the rests of a body.

use std::ops::Range;

/// The longest ranges of frames in which every flag equals `value`, in order of time.
pub(crate) fn frame_runs(flags: &[bool], value: bool) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for frame in (0..flags.len()).filter(|&frame| flags[frame] == value) {
        match runs.last_mut() {
            Some(run) if run.end == frame => run.end += 1,
            _ => runs.push(frame..frame + 1),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_longest_and_in_order() {
        let flags = [true, true, false, true, false, false];
        assert_eq!(frame_runs(&flags, true), [0..2, 3..4]);
        assert_eq!(frame_runs(&flags, false), [2..3, 4..6]);
        assert_eq!(frame_runs(&[], true), []);
    }
}
