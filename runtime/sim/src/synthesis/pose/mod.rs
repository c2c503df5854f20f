//! The final pose: planted feet hold, the pelvis comes down, legs reach the feet, the head turns.
//!
//! Enters: a sampled pose, the root, foot contacts. Leaves: the pose after inverse kinematics.
//!
//! Read `posture`, then `foot_lock`, `pelvis`, `heel_rise`, `leg`, `ik`; `look_at` turns head and chest.

pub mod foot_lock;
pub mod heel_rise;
pub mod ik;
pub mod leg;
pub mod look_at;
pub mod pelvis;
pub mod posture;
