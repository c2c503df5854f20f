//! Girths of the human body: the radius of each body segment as a share of the stature.
//!
//! Men of the 2012 Anthropometric Survey of U.S. Army Personnel (ANSUR II; Gordon et al., NATICK/TR-15/007, 2014), in
//! round values, divided by the stature of 1.755 m. Limbs: circumference divided by 2π, mean of the segment's ends.
//! Trunk, which is broader than deep: a quarter of breadth plus depth. They shape the drawn body and its capsules;
//! nothing is measured by them. How far joints turn: [`motiondb::body::JOINT_RANGES_DEG`].

use motiondb::body::JOINT_COUNT;

/// Radius of the segment that each joint carries, divided by the stature.
#[rustfmt::skip]
pub(crate) const SEGMENT_RADII_PER_STATURE: [f64; JOINT_COUNT] = [
    0.085, // pelvis: hips 0.35 m broad, 0.25 deep
    0.079, // lower spine: waist 0.32 broad, 0.24 deep
    0.078, // middle spine: chest 0.29 broad, 0.25 deep
    0.070, // upper spine: chest, narrowing to where neck and clavicles take over
    0.036, // neck: 0.40 m
    0.052, // head: 0.57 m
    0.040, 0.030, 0.022, 0.019, // left clavicle (the shoulder's cap), upper arm 0.36 m to elbow 0.28, forearm 0.31 to wrist 0.18, hand 0.21
    0.040, 0.030, 0.022, 0.019, // right
    0.046, 0.028, 0.024, 0.021, // left thigh 0.62 m to knee 0.39, shank 0.39 to ankle 0.23, foot 0.26, toes
    0.046, 0.028, 0.024, 0.021, // right
];
