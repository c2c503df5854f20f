//! Published figures of the human body: how thick its segments are and how far its joints turn.
//!
//! Girths: men of the 2012 Anthropometric Survey of U.S. Army Personnel (ANSUR II; Gordon et al., NATICK/TR-15/007,
//! 2014), in round figures, over the stature of 1.755 m. Limbs: circumference over 2π, mean of the segment's ends.
//! Trunk, which is broader than deep: a quarter of breadth plus depth. They shape the drawn body and its capsules;
//! nothing is measured by them.
//!
//! Ranges: American Academy of Orthopaedic Surgeons, *Joint Motion: Method of Measuring and Recording* (1965), as
//! tabulated by Norkin and White, *Measurement of Joint Motion*, appendix A. Per anatomical axis; where a segment
//! stands for several joints (spine, shoulder with its blade) their sum is shared. Rotation vectors in rest-pose body
//! axes (x forward, y left, z up, arms out, palms down): +y bends the trunk forward and flexes the knee, −y flexes the
//! hip and lifts the toes.

use motiondb::skeleton::JOINT_COUNT;

/// Radius of each joint's own segment over the stature.
#[rustfmt::skip]
pub const SEGMENT_RADII_PER_STATURE: [f64; JOINT_COUNT] = [
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

const FREE: f32 = 180.0;

/// Least and greatest rotation vector of each joint, degrees; the pelvis turns freely.
#[rustfmt::skip]
pub const LIMITS_DEG: [[[f32; 3]; 2]; JOINT_COUNT] = [
    [[-FREE, -FREE, -FREE], [FREE, FREE, FREE]],        // pelvis
    [[-12.0, -8.0, -5.0], [12.0, 27.0, 5.0]],           // lower spine: the trunk bends 80° forward, 25 back, 35 aside, twists 45
    [[-12.0, -8.0, -15.0], [12.0, 27.0, 15.0]],         // middle spine
    [[-12.0, -8.0, -25.0], [12.0, 27.0, 25.0]],         // upper spine
    [[-25.0, -30.0, -40.0], [25.0, 25.0, 40.0]],        // neck: half of head on trunk, 45/45, 45 aside, 60–80 twisted
    [[-20.0, -30.0, -40.0], [20.0, 25.0, 40.0]],        // head
    [[-20.0, -20.0, -30.0], [40.0, 20.0, 30.0]],        // left clavicle: 40° up, 10–20 down, 30 to and fro
    [[-130.0, -90.0, -140.0], [90.0, 90.0, 60.0]],      // left upper arm: from level 130° down and across, 90 up
    [[-80.0, -10.0, -150.0], [80.0, 10.0, 10.0]],       // left elbow: 150° flexion, 80 each of pro- and supination (with the forearm)
    [[-30.0, -80.0, -80.0], [30.0, 80.0, 80.0]],        // left wrist: 80° flexion, 70 extension, 20–30 aside, any palm direction
    [[-40.0, -20.0, -30.0], [20.0, 20.0, 30.0]],        // right clavicle
    [[-90.0, -90.0, -60.0], [130.0, 90.0, 140.0]],      // right upper arm
    [[-80.0, -10.0, -10.0], [80.0, 10.0, 150.0]],       // right elbow
    [[-30.0, -80.0, -80.0], [30.0, 80.0, 80.0]],        // right wrist
    [[-30.0, -120.0, -45.0], [45.0, 30.0, 45.0]],       // left hip: flexion 120°, extension 30, adduction 30, abduction 45, rotation 45
    [[-5.0, -5.0, -10.0], [5.0, 135.0, 10.0]],          // left knee: flexion 135°
    [[-35.0, -20.0, -30.0], [20.0, 50.0, 30.0]],        // left ankle: dorsiflexion 20°, plantarflexion 50, inversion 35, eversion 20
    [[-5.0, -70.0, -5.0], [5.0, 45.0, 5.0]],            // left toes: extension 70°, flexion 45
    [[-45.0, -120.0, -45.0], [30.0, 30.0, 45.0]],       // right hip
    [[-5.0, -5.0, -10.0], [5.0, 135.0, 10.0]],          // right knee
    [[-20.0, -20.0, -30.0], [35.0, 50.0, 30.0]],        // right ankle
    [[-5.0, -70.0, -5.0], [5.0, 45.0, 5.0]],            // right toes
];
