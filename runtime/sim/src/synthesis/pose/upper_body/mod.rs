//! Trunk, head and arms, beside what the examples say: no root, pelvis or leg depends on them.
//!
//! Enters: a pose, and what each part follows. Leaves: the pose.
//!
//! `curve_look` turns the head of a clip out of the clip's curve. `look_at` turns head and chest, `squeeze` the shoulders
//! where room is narrow, both as far as `yaw_limit` allows. `secondary_motion` moves head, forearms and hands. Last,
//! after the legs, `body_clearance` keeps trunk and arms out of walls and other bodies.

pub(crate) mod body_clearance;
pub(crate) mod curve_look;
pub(crate) mod look_at;
pub(crate) mod secondary_motion;
pub(crate) mod squeeze;
pub(crate) mod yaw_limit;

pub(crate) use body_clearance::BodyClearance;
pub(crate) use look_at::LookAt;
pub use secondary_motion::LackingMotion;
pub(crate) use secondary_motion::SecondaryMotion;
pub(crate) use squeeze::Squeeze;
