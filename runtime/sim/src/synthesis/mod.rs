//! Human motion synthesis (HMS, `FbCrowd` §5): a plan becomes the next root and the next pose of a body.
//!
//! # A step
//!
//! A body's step has two halves, between which walls may move the root. `advance` follows the plan:
//!
//! 1. `displacement_accumulator`: planned displacement that is too slow to walk is accumulated and becomes one step;
//! 2. `blend_query`, `command_filter`: the plan requests (v_f, ω_t, ω_s); filtered, they are the command;
//! 3. `step_state`, `start_stop`: the body stands, and then blends, or steps; where the database has a recorded start that
//!    fits (`starts`), a body that begins to step plays it (`played_transition`);
//! 4. `motion_state`, `weight_transition`: the active motion moves toward the part of the command that it can reach;
//! 5. the root moves along its arc, and the phase advances (`phase_catch_up`);
//! 6. `pose_smoothing`, `inertialization`: the drawn motion follows, and the pose offset of the last switch decays
//!    (inertialization);
//! 7. `mode_selection`, `switching`: one mode may replace the other.
//!
//! `synthesize` makes the pose:
//!
//! 8. `active_motion`: blending, semi-procedural locomotion or a recorded transition gives a posture, to which the pose
//!    offset is added;
//! 9. `traits`, `look_at`, `squeeze`, `lean`, `secondary_motion`: the upper body moves as this agent does; head and
//!    chest turn; shoulders turn where room is narrow; the body leans;
//! 10. `centring`, `weight_shift`, `foot_room`, `foot_lock`, `pelvis`: the pelvis of a standing body moves over its feet,
//!     and over one of them before a first step; swinging feet move back towards the elbow room, planted ones are locked,
//!     and the pelvis drops where a leg would not reach, at limited accelerations;
//! 11. `ik`: the legs reach their feet;
//! 12. `body_clearance`: trunk and arms keep within the elbow room that walls and other bodies leave.
//!
//! Joints beside the 22 roles have no stage of their own: `extra_state` blends them by the weights of the pose, and
//! keeps what a switch has left of them.
//!
//! # Names
//!
//! | quantity | name |
//! |---|---|
//! | velocity that the planner chose | `Plan::velocity_mps` |
//! | (v_f, ω_t, ω_s) that the plan requests of the body | `requested` |
//! | the same, filtered over time | `command` |
//! | the nearest point that the examples reach | `reachable` |
//! | (v_f, ω_t, ω_s) toward which the active motion moves | `target` |
//! | (v_f, ω_t, ω_s) of the active motion now | `current` |
//! | velocity that the root had in the last step, after walls | `actual_mps` |
//!
//! # Chapters
//!
//! Each chapter depends only on those before it: `mode`, `params`, `time_step` (constants and options only), `traits`,
//! [`pose`], [`blending`], [`semi_procedural`], [`library`], [`command`], [`hybrid`], `body`, then `advance`,
//! `synthesize`, `walk_alone` and `stature` (bodies of other sizes).
//!
//! The state of a [`Body`] is grouped likewise: `CommandState`, [`MotionState`](hybrid::MotionState), `ContactState`,
//! `LookAt`, `Squeeze`, `ExcessLean`, `SecondaryMotion`, `WeightShift`, `Centring`, `ElbowRoom`, `BodyClearance`.
//!
//! # Frames and units
//!
//! World: x and y on the ground, z up. The root frame has x forward, y left, z up, and its origin on the ground under
//! the ripple-free root. Metres, seconds, radians. φ is 0 at right mid-stance and ½ at left mid-stance. Pairs of sides
//! are `[left, right]`.

pub(crate) mod advance;
pub mod blending;
pub(crate) mod body;
pub mod command;
pub mod hybrid;
pub mod library;
pub(crate) mod mode;
pub(crate) mod params;
pub mod pose;
pub mod semi_procedural;
pub mod stature;
pub(crate) mod synthesize;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod time_step;
pub(crate) mod traits;
pub(crate) mod walk_alone;

pub use body::{Body, BodyOutput};
pub use hybrid::ExtraState;
pub use library::SynthesisContext;
pub use mode::{Mode, Modes};
pub use params::{HmsParams, Transition};
pub use stature::Stature;
pub use time_step::{INERTIA_DURATION_S, TimeStep};
pub use traits::Traits;
