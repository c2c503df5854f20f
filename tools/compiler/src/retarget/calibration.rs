//! The one constant rotation K_j of each canonical joint j in a clip: R_j(t) = G_j(t)·K_j, with G_j the source joint's
//! global orientation and R_j the canonical joint's, against the rest pose.
//!
//! K_j matches two directions that are constant in the source joint's frame with those of the canonical rest pose: the
//! bone, and a lateral or hinge axis. Nothing is taken from the source's zero pose or its local rotations.
//!
//! | joint | first, matched exactly | second |
//! |---|---|---|
//! | pelvis | hip line, +y | hips → shoulders, +z |
//! | spine, neck | to the child, +z | body's left, +y |
//! | head | up, +z | body's left, +y |
//! | clavicle | to the shoulder, ±y | up, +z |
//! | upper arm, forearm, hand | to the child or fingertips, ±y | elbow hinge, ∓z |
//! | thigh, shank | to the child, −z | knee hinge, +y |
//! | foot, toe | up while it is flat on the ground, +z | to the toe, +x |
//!
//! Hinge axes are cross products of the two bones, which weigh themselves by flexion, plus a little of what a straight
//! limb would bend about; of knees that stand straight, that alone.

use glam::{DMat3, DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint, Side};

use crate::read::source_clip::SourceClip;
use crate::retarget::anchors::Anchor;
use crate::rig::roles::Roles;

/// Share of a straight limb's presumed hinge in the mean: decides only where the limb hardly bends (sin of 3°).
const STRAIGHT_HINGE: f64 = 0.05;
/// A knee that bends less than this on the mean (sin of 5°) tells no hinge: standing, it gives back by as much, and the
/// shank leans aside by as much, about other axes.
const TELLING_KNEE: f64 = 0.087;
/// Share of the frames, flattest first, in which a foot counts as flat on the ground.
const FLAT_SHARE: f64 = 0.15;
/// Bones shorter than this have no direction, m.
const SHORTEST_BONE_M: f64 = 0.01;

/// The canonical joints' tracks before calibration.
pub(crate) struct Tracks<'a> {
    pub clip: &'a SourceClip,
    pub roles: &'a Roles,
    pub anchors: &'a [Anchor; JOINT_COUNT],
    /// Of every canonical joint, one array a frame, metres.
    pub positions_m: &'a [[DVec3; JOINT_COUNT]],
    /// The body's facing on the ground.
    pub forward: &'a [DVec3],
}

/// The canonical orientation of every joint in every frame: R_j(t) = G_j(t)·K_j.
pub(crate) fn calibrated(tracks: &Tracks) -> Vec<[DQuat; JOINT_COUNT]> {
    let mut orientations = vec![[DQuat::IDENTITY; JOINT_COUNT]; tracks.positions_m.len()];
    for joint in Joint::ALL {
        let index = joint.index();
        let [first, second] = matched_axes(tracks, joint, &orientations);
        let source = basis(first.local, second.local);
        let rest = basis(first.rest, second.rest);
        let constant = DQuat::from_mat3(&(source * rest.transpose()));
        for (frame, orientation) in orientations.iter_mut().enumerate() {
            orientation[index] = (tracks.source(joint, frame) * constant).normalize();
        }
    }
    orientations
}

/// A direction in the source joint's frame and where it points in the rest pose.
struct Matched {
    local: DVec3,
    rest: DVec3,
}

/// Columns: the first direction, the second made perpendicular to it, and their cross product.
fn basis(first: DVec3, second: DVec3) -> DMat3 {
    let across = second.reject_from_normalized(first);
    let second = across.try_normalize().unwrap_or_else(|| first.any_orthonormal_vector());
    DMat3::from_cols(first, second, first.cross(second))
}

fn matched_axes(tracks: &Tracks, joint: Joint, orientations: &[[DQuat; JOINT_COUNT]]) -> [Matched; 2] {
    use Joint as J;
    let side = side(joint);
    let sign = f64::from(side.sign());
    let [first_rest, second_rest] = match joint {
        J::Pelvis => [DVec3::Y, DVec3::Z],
        J::SpineLower | J::SpineMiddle | J::SpineUpper | J::Neck | J::Head => [DVec3::Z, DVec3::Y],
        J::LeftClavicle | J::RightClavicle => [sign * DVec3::Y, DVec3::Z],
        J::LeftThigh | J::RightThigh | J::LeftShank | J::RightShank => [DVec3::NEG_Z, DVec3::Y],
        J::LeftFoot | J::RightFoot | J::LeftToe | J::RightToe => [DVec3::Z, DVec3::X],
        _ => [sign * DVec3::Y, -sign * DVec3::Z],
    };
    let like_parent =
        |frame: usize, rest: DVec3| joint.parent().map_or(rest, |parent| orientations[frame][parent.index()] * rest);
    let first = |frame: usize| first_axis(tracks, joint, frame).unwrap_or_else(|| like_parent(frame, first_rest));
    let is_leg = matches!(joint, J::LeftThigh | J::RightThigh | J::LeftShank | J::RightShank);
    let is_straight = is_leg && stands_straight(tracks, side);
    let second = |frame: usize| {
        if is_straight {
            return tracks.left(frame);
        }
        second_axis(tracks, joint, frame).unwrap_or_else(|| like_parent(frame, second_rest))
    };
    let frames = axis_frames(tracks, joint);
    [
        Matched { local: tracks.mean_local(joint, &frames, first), rest: first_rest },
        Matched { local: tracks.mean_local(joint, &frames, second), rest: second_rest },
    ]
}

fn first_axis(tracks: &Tracks, joint: Joint, frame: usize) -> Option<DVec3> {
    use Joint as J;
    match joint {
        J::Pelvis => tracks.direction(J::RightThigh, J::LeftThigh, frame),
        J::Head | J::LeftFoot | J::RightFoot | J::LeftToe | J::RightToe => Some(DVec3::Z),
        J::LeftHand | J::RightHand => tracks.to_end(joint, frame),
        J::SpineUpper => tracks.direction(joint, J::Neck, frame),
        _ => tracks.direction(joint, Joint::ALL[joint.index() + 1], frame),
    }
}

fn second_axis(tracks: &Tracks, joint: Joint, frame: usize) -> Option<DVec3> {
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
fn stands_straight(tracks: &Tracks, side: Side) -> bool {
    let bend = |frame: usize| tracks.knee_hinge(side.index(), frame).map_or(0.0, |hinge| hinge.dot(tracks.left(frame)));
    let frames = tracks.positions_m.len();
    (0..frames).map(bend).sum::<f64>() < TELLING_KNEE * frames as f64
}

/// All frames; for feet and toes those in which both lie flat: a toe's joint alone is often lowest as the foot rolls
/// off over it, when toes are bent.
fn axis_frames(tracks: &Tracks, joint: Joint) -> Vec<usize> {
    let side = side(joint).index();
    match joint {
        Joint::LeftFoot | Joint::RightFoot | Joint::LeftToe | Joint::RightToe => {
            flat_frames(tracks, &[Joint::FEET[side], Joint::TOES[side]])
        }
        _ => (0..tracks.positions_m.len()).collect(),
    }
}

/// The frames in which the highest of some joints, each over its own lowest, is lowest.
pub(crate) fn flat_frames(tracks: &Tracks, joints: &[Joint]) -> Vec<usize> {
    let height = |frame: usize, joint: &Joint| tracks.positions_m[frame][joint.index()].z;
    let frames = 0..tracks.positions_m.len();
    let lowest: Vec<f64> = joints
        .iter()
        .map(|joint| frames.clone().map(|frame| height(frame, joint)).fold(f64::INFINITY, f64::min))
        .collect();
    let lift = |frame: usize| {
        joints.iter().zip(&lowest).map(|(joint, lowest)| height(frame, joint) - lowest).fold(0.0, f64::max)
    };
    let mut sorted: Vec<(f64, usize)> = frames.map(|frame| (lift(frame), frame)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let count = ((sorted.len() as f64 * FLAT_SHARE) as usize).max(1);
    sorted[..count].iter().map(|&(_, frame)| frame).collect()
}

fn side(joint: Joint) -> Side {
    if joint.mirrored() < joint { Side::Right } else { Side::Left }
}

impl Tracks<'_> {
    /// G_j(t).
    fn source(&self, joint: Joint, frame: usize) -> DQuat {
        self.clip.orientation(frame, self.anchors[joint.index()].joint)
    }

    fn mean_local(&self, joint: Joint, frames: &[usize], direction: impl Fn(usize) -> DVec3) -> DVec3 {
        let sum: DVec3 = frames.iter().map(|&frame| self.source(joint, frame).inverse() * direction(frame)).sum();
        sum.try_normalize().unwrap_or(DVec3::Z)
    }

    /// The body's left on the ground.
    fn left(&self, frame: usize) -> DVec3 {
        DVec3::Z.cross(self.forward[frame])
    }

    /// What a leg bends about, as long as the sine of the bend.
    fn knee_hinge(&self, side: usize, frame: usize) -> Option<DVec3> {
        let [thigh, shank, foot] = [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]];
        Some(self.direction(thigh, shank, frame)?.cross(self.direction(shank, foot, frame)?))
    }

    fn middle(&self, pair: [Joint; 2], frame: usize) -> DVec3 {
        0.5 * (self.positions_m[frame][pair[0].index()] + self.positions_m[frame][pair[1].index()])
    }

    /// Unit vector between two canonical joints, unless they are in one place.
    fn direction(&self, from: Joint, to: Joint, frame: usize) -> Option<DVec3> {
        let bone = self.positions_m[frame][to.index()] - self.positions_m[frame][from.index()];
        (bone.length() > SHORTEST_BONE_M).then(|| bone.normalize())
    }

    /// Unit vector to the far end of a leaf's segment.
    fn to_end(&self, joint: Joint, frame: usize) -> Option<DVec3> {
        let end = self.clip.position(frame, self.roles.ends[joint.index()]?);
        let bone = end - self.positions_m[frame][joint.index()];
        (bone.length() > SHORTEST_BONE_M).then(|| bone.normalize())
    }
}
