//! The body of the bundled clips: its skeleton, poses and legs.
//!
//! Enters: nothing; lengths are published. Leaves: [`ClipPose`], one frame of a clip on the skeleton (x forward, y
//! left, z up, metres, radians).
//!
//! Read `skeleton`, then `pose`, then `rotation` and `leg_ik`.

pub(crate) mod leg_ik;
pub(crate) mod pose;
pub(crate) mod rotation;
pub(crate) mod skeleton;

pub(crate) use pose::ClipPose;
