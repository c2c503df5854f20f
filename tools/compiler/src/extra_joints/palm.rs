//! The palm: a hand's axes along and across its knuckles, constant in the frame of the source's hand.
//!
//! | axis | direction |
//! |---|---|
//! | ±y, matched exactly | wrist → knuckles |
//! | +x | little → index knuckle |
//!
//! Unlike the elbow hinge, the palm shows how far a forearm is turned about itself. It needs two fingers beside the thumb.
//! World frame of the clip: metres, z up.

use glam::{DQuat, DVec3};
use motiondb::body::{ExtraJoint, JOINT_COUNT, Side};
use motiondb::statistics::mean;

use crate::retarget::calibration::basis;
use crate::retarget::joint_tracks::JointTracks;
use crate::rig::roles::ARMS;
use crate::rig::sampled_frames;

/// Distance of the outer knuckles across the hand below which the palm has no axes, m.
const NARROWEST_M: f64 = 1e-3;

/// Makes the palms the axes of the hands that have them, in the constants K_j of all joints.
pub(crate) fn turn_to_palms(tracks: &JointTracks, constants: &mut [DQuat; JOINT_COUNT]) {
    for side in Side::BOTH {
        if let Some(palm) = palm(tracks, side) {
            constants[ARMS[side.index()][2].index()] = palm;
        }
    }
}

/// Rotation of a palm in the frame of the source's hand; none where fewer than two knuckles are known.
fn palm(tracks: &JointTracks, side: Side) -> Option<DQuat> {
    let knuckles_m: Vec<DVec3> = (1..5).filter_map(|finger| knuckle_m(tracks, side, finger)).collect();
    let (first_m, last_m) = (knuckles_m.first()?, knuckles_m.last()?);
    let along = knuckles_m.iter().sum::<DVec3>().try_normalize()?;
    let across_m = (*first_m - *last_m).reject_from_normalized(along);
    let rest = basis(f64::from(side.sign()) * DVec3::Y, DVec3::X);
    (across_m.length() > NARROWEST_M).then(|| DQuat::from_mat3(&(basis(along, across_m) * rest.transpose())))
}

/// Mean position of a finger's first joint in the frame of the source's hand, m.
fn knuckle_m(tracks: &JointTracks, side: Side, finger: usize) -> Option<DVec3> {
    let hand = ARMS[side.index()][2];
    let knuckle = ExtraJoint::finger(side, finger, 0);
    let source = tracks.roles.extra.iter().find(|extra| extra.joint == knuckle)?.source;
    let in_hand_m = |frame| {
        let from_wrist_m = tracks.clip.position(frame, source) - tracks.position_m(hand, frame);
        tracks.source_orientation(hand, frame).inverse() * from_wrist_m
    };
    mean(sampled_frames(tracks.frame_count()).into_iter().map(in_hand_m))
}
