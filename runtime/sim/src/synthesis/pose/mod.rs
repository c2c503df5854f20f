//! The final pose: planted feet hold, the pelvis comes down, legs reach the feet, the head turns.
//!
//! Enters: a sampled pose, the root, foot contacts. Leaves: the pose after inverse kinematics.
//!
//! Read `posture`, then `foot_lock`, `pelvis`, `heel_rise`, `leg`, `ik`; `look_at` turns head and chest.

pub(crate) mod foot_lock;
pub(crate) mod heel_rise;
pub(crate) mod ik;
pub(crate) mod leg;
pub(crate) mod look_at;
pub(crate) mod pelvis;
pub(crate) mod posture;

pub use foot_lock::{FootHold, HeldFoot, PosedFoot};
pub use leg::{FootPose, Leg};
pub use look_at::Gaze;
pub use pelvis::Descent;
pub use posture::Posture;
