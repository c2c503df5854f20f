//! Checks whether a clip is plausible as human motion, and whether the feet alone move the body on level ground (no
//! slope, treadmill or sliding root).
//!
//! Enters: a `SourceClip` with roles and whole-clip parameters, or a `HumanBody`. Leaves: warnings, verdicts and
//! reasons of rejection, all typed.
//!
//! `plausibility` checks unit, up axis, gait and body; `level_ground` finds what moves the body if not the feet;
//! `lengthwise_path` whether it moves along its own length; `pose_jumps` where its pose jumps; `uneven_frames` whether frames
//! are missing or repeated; `spread_arms` where it stands as in a bind pose. Of a set, `other_up_axes` finds the clips that do
//! not stand as their rig does, `rare_frame_rates` those with a doubtful frame rate.

pub(crate) mod lengthwise_path;
pub(crate) mod level_ground;
pub(crate) mod other_up_axes;
pub(crate) mod plausibility;
pub(crate) mod pose_jumps;
pub(crate) mod rare_frame_rates;
pub(crate) mod spread_arms;
pub(crate) mod uneven_frames;
