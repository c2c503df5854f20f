//! Calibration: the constant rotation K_j between each canonical joint j and its source joint.
//!
//! R_j(t) = G_j(t)·K_j, where G_j is the source joint's global orientation and R_j the canonical joint's rotation from
//! the rest pose. K_j matches two directions that are constant in the source joint's frame with those of the rest pose.
//! The source's zero pose and its local rotations are not used. World frame: metres, z up; rest pose: x forward, y
//! left.
//!
//! | joint | first direction, matched exactly | second direction |
//! |---|---|---|
//! | pelvis | hip line, +y | hips → shoulders, +z |
//! | spine, neck | to the child, +z | body's left, +y |
//! | head | up, +z | body's left, +y |
//! | clavicle | to the shoulder, ±y | up, +z |
//! | upper arm, forearm, hand | to the child or fingertips, ±y | elbow hinge, ∓z |
//! | thigh, shank | to the child, −z | knee hinge, +y |
//! | foot, toe | up while flat on the ground, +z | to the toe, +x |
//!
//! Hands with fingers are turned to their palms afterwards ([`crate::extra_joints::palm`]).
//!
//! A hinge is the mean cross product of the limb's two bones, which weighs frames by flexion, plus a little of the axis
//! about which a straight limb would bend. For knees that stay straight it is that axis alone.

use glam::{DMat3, DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint, Side};

use crate::retarget::joint_tracks::JointTracks;

/// Weight of a straight limb's presumed hinge: decides only where the limb hardly bends (sine of 3°).
const STRAIGHT_HINGE: f64 = 0.05;
/// Least mean bend of a knee whose hinge counts, as a sine (5°): standing knees bend back and aside by as much.
const LEAST_KNEE_BEND: f64 = 0.087;

/// The constant rotation K_j of each canonical joint.
pub(crate) fn calibration(tracks: &JointTracks) -> [DQuat; JOINT_COUNT] {
    let mut constants = [DQuat::IDENTITY; JOINT_COUNT];
    for joint in Joint::ALL {
        let [first, second] = matched_directions(tracks, joint, &constants);
        let source = basis(first.source, second.source);
        let rest = basis(first.rest, second.rest);
        constants[joint.index()] = DQuat::from_mat3(&(source * rest.transpose()));
    }
    constants
}

/// A direction in the source joint's frame and in the rest pose.
struct MatchedDirection {
    source: DVec3,
    rest: DVec3,
}

/// Columns: the first direction, the second one made perpendicular to it, and their cross product.
pub(crate) fn basis(first: DVec3, second: DVec3) -> DMat3 {
    let across = second.reject_from_normalized(first);
    let second = across.try_normalize().unwrap_or_else(|| first.any_orthonormal_vector());
    DMat3::from_cols(first, second, first.cross(second))
}

/// Both directions of a joint; `constants` holds those of its ancestors already.
fn matched_directions(tracks: &JointTracks, joint: Joint, constants: &[DQuat; JOINT_COUNT]) -> [MatchedDirection; 2] {
    let side = side(joint);
    let [first_rest, second_rest] = rest_directions(joint, side);
    let like_parent = |frame: usize, rest: DVec3| {
        joint.parent().map_or(rest, |parent| tracks.orientation(parent, frame, constants) * rest)
    };
    let first = |frame: usize| first_direction(tracks, joint, frame).unwrap_or_else(|| like_parent(frame, first_rest));
    let is_leg = matches!(joint, Joint::LeftThigh | Joint::RightThigh | Joint::LeftShank | Joint::RightShank);
    let is_straight = is_leg && is_knee_straight(tracks, side);
    let second = |frame: usize| {
        if is_straight {
            return tracks.left(frame);
        }
        second_direction(tracks, joint, frame).unwrap_or_else(|| like_parent(frame, second_rest))
    };
    let frames = measured_frames(tracks, joint);
    [
        MatchedDirection { source: mean_in_source(tracks, joint, &frames, first), rest: first_rest },
        MatchedDirection { source: mean_in_source(tracks, joint, &frames, second), rest: second_rest },
    ]
}

/// Both directions in the rest pose.
fn rest_directions(joint: Joint, side: Side) -> [DVec3; 2] {
    use Joint as J;
    let sign = f64::from(side.sign());
    match joint {
        J::Pelvis => [DVec3::Y, DVec3::Z],
        J::SpineLower | J::SpineMiddle | J::SpineUpper | J::Neck | J::Head => [DVec3::Z, DVec3::Y],
        J::LeftClavicle | J::RightClavicle => [sign * DVec3::Y, DVec3::Z],
        J::LeftThigh | J::RightThigh | J::LeftShank | J::RightShank => [DVec3::NEG_Z, DVec3::Y],
        J::LeftFoot | J::RightFoot | J::LeftToe | J::RightToe => [DVec3::Z, DVec3::X],
        _ => [sign * DVec3::Y, -sign * DVec3::Z],
    }
}

/// The first direction in one frame, world frame; none where the bone is too short.
fn first_direction(tracks: &JointTracks, joint: Joint, frame: usize) -> Option<DVec3> {
    use Joint as J;
    match joint {
        J::Pelvis => tracks.direction(J::RightThigh, J::LeftThigh, frame),
        J::Head | J::LeftFoot | J::RightFoot | J::LeftToe | J::RightToe => Some(DVec3::Z),
        J::LeftHand | J::RightHand => tracks.direction_to_end(joint, frame),
        J::SpineUpper => tracks.direction(joint, J::Neck, frame),
        _ => tracks.direction(joint, Joint::ALL[joint.index() + 1], frame),
    }
}

/// The second direction in one frame, world frame; none where a bone is too short.
fn second_direction(tracks: &JointTracks, joint: Joint, frame: usize) -> Option<DVec3> {
    use Joint as J;
    let side = side(joint).index();
    let left = tracks.left(frame);
    match joint {
        J::Pelvis => {
            let [hips, shoulders] = [J::THIGHS, J::UPPER_ARMS].map(|pair| tracks.middle(pair, frame));
            (shoulders - hips).try_normalize()
        }
        J::SpineLower | J::SpineMiddle | J::SpineUpper | J::Neck | J::Head => Some(left),
        J::LeftClavicle | J::RightClavicle => Some(DVec3::Z),
        J::LeftThigh | J::RightThigh | J::LeftShank | J::RightShank => {
            Some(tracks.knee_hinge(side, frame)? + STRAIGHT_HINGE * left)
        }
        J::LeftFoot | J::RightFoot | J::LeftToe | J::RightToe => tracks.direction(J::FEET[side], J::TOES[side], frame),
        _ => {
            let arm = J::UPPER_ARMS[side].index();
            let [arm, forearm, hand] = [Joint::ALL[arm], Joint::ALL[arm + 1], Joint::ALL[arm + 2]];
            let bones = [tracks.direction(arm, forearm, frame)?, tracks.direction(forearm, hand, frame)?];
            Some(bones[0].cross(bones[1]) + STRAIGHT_HINGE * bones[0].cross(tracks.forward[frame]))
        }
    }
}

/// Whether a knee hardly bends in the whole clip.
fn is_knee_straight(tracks: &JointTracks, side: Side) -> bool {
    let bend = |frame: usize| tracks.knee_hinge(side.index(), frame).map_or(0.0, |hinge| hinge.dot(tracks.left(frame)));
    let frames = tracks.frame_count();
    (0..frames).map(bend).sum::<f64>() < LEAST_KNEE_BEND * frames as f64
}

/// The frames in which the directions of a joint are measured: for feet and toes those in which both lie flat (a toe's
/// joint alone is often lowest while the foot rolls off over it); for trunk and head those in which the body is upright,
/// since its up and its left are theirs; for limbs all.
fn measured_frames(tracks: &JointTracks, joint: Joint) -> Vec<usize> {
    let side = side(joint).index();
    match joint {
        Joint::LeftFoot | Joint::RightFoot | Joint::LeftToe | Joint::RightToe => {
            tracks.flat_frames(&[Joint::FEET[side], Joint::TOES[side]])
        }
        Joint::SpineLower
        | Joint::SpineMiddle
        | Joint::SpineUpper
        | Joint::Neck
        | Joint::Head
        | Joint::LeftClavicle
        | Joint::RightClavicle => tracks.upright.to_vec(),
        _ => (0..tracks.frame_count()).collect(),
    }
}

/// Mean of a world direction in the source joint's frame, unit vector.
fn mean_in_source(tracks: &JointTracks, joint: Joint, frames: &[usize], direction: impl Fn(usize) -> DVec3) -> DVec3 {
    let local = |&frame: &usize| tracks.source_orientation(joint, frame).inverse() * direction(frame);
    frames.iter().map(local).sum::<DVec3>().try_normalize().unwrap_or(DVec3::Z)
}

/// The side of a joint; left for a joint in the middle.
fn side(joint: Joint) -> Side {
    if joint.mirrored() < joint { Side::Right } else { Side::Left }
}
