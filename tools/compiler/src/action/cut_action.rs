//! A part of a clip that becomes an action: its poses in the world at the frame rate of actions.
//!
//! World frame: metres, radians, Z up; times in frames of the clip.

use motiondb::motion::{ACTION_RATE_HZ, ActionKind};

use crate::retarget::human_clip::HumanPose;

/// A part of a clip at [`ACTION_RATE_HZ`].
#[derive(Clone, Debug)]
pub(crate) struct CutAction {
    /// Name of the action.
    pub(crate) name: String,
    /// What the body does.
    pub(crate) kind: ActionKind,
    /// Index of the clip.
    pub(crate) source: u32,
    /// First and last second of the part, from the file's first frame.
    pub(crate) window_s: [f64; 2],
    /// Poses, uniform in time, of the clip's own ground.
    pub(crate) poses: Vec<HumanPose>,
    /// Contact of each foot, `[left, right]`, at each pose.
    pub(crate) contacts: Vec<[f64; 2]>,
}

/// The times, in frames of a clip, at which an action over some frames is sampled: uniform, at nearly
/// [`ACTION_RATE_HZ`], with both ends.
pub(crate) fn sample_frames([first, last]: [f64; 2], frame_rate_hz: f64) -> impl Iterator<Item = f64> {
    let steps = libm::round((last - first) / frame_rate_hz * f64::from(ACTION_RATE_HZ)).max(1.0);
    (0..=steps as usize).map(move |step| first + (last - first) * step as f64 / steps)
}
