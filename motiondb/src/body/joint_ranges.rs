//! Ranges of motion of human joints, from published tables.
//!
//! Sources: American Academy of Orthopaedic Surgeons, *Joint Motion: Method of Measuring and Recording* (1965), as
//! tabulated by Norkin and White, *Measurement of Joint Motion*, appendix A. The ankle bends farther under the body's
//! weight than the 20° of that table: 30 to 40° in lunges (Rabin et al. 2015, *J. Athl. Train.* 50, 30–35).
//!
//! The tables give ranges per anatomical axis. Where a segment represents several joints (spine, shoulder with its
//! blade), their sum is shared out. Rotation vectors are in the rest pose's body axes (x forward, y left, z up, arms
//! out, palms down): +y bends the trunk forward and flexes the knee; −y flexes the hip and lifts the toes.

use crate::body::skeleton::JOINT_COUNT;

/// Bound of an axis about which a joint turns freely, degrees.
const FREE: f32 = 180.0;

/// Least and greatest rotation vector of each joint, degrees. The pelvis turns freely.
#[rustfmt::skip]
pub const JOINT_RANGES_DEG: [[[f32; 3]; 2]; JOINT_COUNT] = [
    [[-FREE, -FREE, -FREE], [FREE, FREE, FREE]],        // pelvis
    [[-12.0, -8.0, -5.0], [12.0, 27.0, 5.0]],           // lower spine: the trunk bends 80° forward, 25 back, 35 sideways, twists 45
    [[-12.0, -8.0, -15.0], [12.0, 27.0, 15.0]],         // middle spine
    [[-12.0, -8.0, -25.0], [12.0, 27.0, 25.0]],         // upper spine
    [[-25.0, -30.0, -40.0], [25.0, 25.0, 40.0]],        // neck: half of head on trunk, 45/45, 45 sideways, 60–80 twisted
    [[-20.0, -30.0, -40.0], [20.0, 25.0, 40.0]],        // head
    [[-20.0, -20.0, -30.0], [40.0, 20.0, 30.0]],        // left clavicle: 40° up, 10–20 down, 30 forward and back
    [[-130.0, -90.0, -140.0], [90.0, 90.0, 60.0]],      // left upper arm: from level 130° down and across, 90 up
    [[-80.0, -10.0, -150.0], [80.0, 10.0, 10.0]],       // left elbow: 150° flexion, 80 each of pro- and supination (with the forearm)
    [[-30.0, -80.0, -80.0], [30.0, 80.0, 80.0]],        // left wrist: 80° flexion, 70 extension, 20–30 sideways, any palm direction
    [[-40.0, -20.0, -30.0], [20.0, 20.0, 30.0]],        // right clavicle
    [[-90.0, -90.0, -60.0], [130.0, 90.0, 140.0]],      // right upper arm
    [[-80.0, -10.0, -10.0], [80.0, 10.0, 150.0]],       // right elbow
    [[-30.0, -80.0, -80.0], [30.0, 80.0, 80.0]],        // right wrist
    [[-30.0, -120.0, -45.0], [45.0, 30.0, 45.0]],       // left hip: flexion 120°, extension 30, adduction 30, abduction 45, rotation 45
    [[-5.0, -5.0, -10.0], [5.0, 135.0, 10.0]],          // left knee: flexion 135°
    [[-35.0, -40.0, -30.0], [20.0, 50.0, 30.0]],        // left ankle: dorsiflexion 40°, plantarflexion 50, inversion 35, eversion 20
    [[-5.0, -70.0, -5.0], [5.0, 45.0, 5.0]],            // left toes: extension 70°, flexion 45
    [[-45.0, -120.0, -45.0], [30.0, 30.0, 45.0]],       // right hip
    [[-5.0, -5.0, -10.0], [5.0, 135.0, 10.0]],          // right knee
    [[-20.0, -40.0, -30.0], [35.0, 50.0, 30.0]],        // right ankle
    [[-5.0, -70.0, -5.0], [5.0, 45.0, 5.0]],            // right toes
];
