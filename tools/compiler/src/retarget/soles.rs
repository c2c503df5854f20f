//! Soles: heel, ball and toe tip of each foot, and the height of the ground.
//!
//! Leaf joints named `…HeelSole`, `…BallSole` and `…ToeSole` are the soles where they exist. Else the soles are
//! estimated: the ground is the file's own zero where the planted feet stand just above it, else a joint's thickness
//! below them; ball and toe tip lie on it under their joints, the heel behind the ankle. Slide is then measured at the
//! joints, which do not depend on that estimate.
//!
//! Heel and ball are in the canonical foot's frame, the toe tip in the toe's; metres.

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::statistics::lower_quantile;

use crate::retarget::joint_tracks::{CalibratedTracks, JointTracks};

/// Distance of the heel behind the ankle, divided by the distance from ankle to ball: 5 cm of 13.
const HEEL_BEHIND: f64 = 0.4;
/// Distance of the toe tip from the ball where the source has no toe end, over leg length: 7 cm for an adult.
const TIP_OVER_LEG: f64 = 0.085;
/// Least distance of a toe end that counts from the ball, over leg length.
const TIP_MIN_OVER_LEG: f64 = 0.02;
/// Height of a planted foot's lowest joint above the sole, divided by leg length: 2 cm for an adult.
const THICKNESS_OVER_LEG: f64 = 0.024;
/// Greatest height of a planted foot's lowest joint above the file's zero, if that is the ground, divided by leg
/// length: 5 cm for an adult (Bandai's toe joints: 4).
const ZERO_TRUSTED_OVER_LEG: f64 = 0.06;
/// Share of a point's heights below its planted height, as in [`crate::gait::contacts`].
const PLANTED_QUANTILE: f64 = 0.05;

/// The soles of both feet and the ground.
pub(crate) struct Soles {
    /// `[left, right]`: heel, ball and toe tip on the sole.
    pub points_m: [[DVec3; 3]; 2],
    /// `[left, right]`: the points at which slide is measured: `…Sole` joints, else the joints over the sole.
    pub measured_m: [[DVec3; 3]; 2],
    /// `[left, right]`: whether the source shows the end of the toe.
    pub shows_toe_ends: [bool; 2],
    /// Height of the ground in the source, m.
    pub ground_m: f64,
}

/// The soles of a clip.
pub(crate) fn soles(calibrated: &CalibratedTracks, leg_m: f64) -> Soles {
    let tracks = &calibrated.tracks;
    if let [Some(left), Some(right)] = tracks.roles.soles {
        let points_m = [sole_joints(calibrated, 0, left), sole_joints(calibrated, 1, right)];
        let height = |joint| planted_height_m(tracks, |frame| tracks.clip.position(frame, joint).z);
        let ground_m = left.into_iter().chain(right).map(height).fold(f64::INFINITY, f64::min);
        return Soles { points_m, measured_m: points_m, shows_toe_ends: [true; 2], ground_m };
    }
    let ground_m = ground_height_m(tracks, leg_m);
    let toe_ends_m = Joint::TOES.map(|toe| toe_end(calibrated, toe, leg_m));
    let tips_m = toe_ends_m.map(|end| end.unwrap_or(TIP_OVER_LEG * leg_m * DVec3::X));
    let measured_m = [0, 1].map(|side| foot_joints(calibrated, side, tips_m[side]));
    let points_m = [0, 1].map(|side| under_joints(tracks, side, measured_m[side], ground_m));
    Soles { points_m, measured_m, shows_toe_ends: toe_ends_m.map(|end| end.is_some()), ground_m }
}

/// The `…Sole` joints of a foot.
fn sole_joints(calibrated: &CalibratedTracks, side: usize, joints: [usize; 3]) -> [DVec3; 3] {
    let carriers = [Joint::FEET[side], Joint::FEET[side], Joint::TOES[side]];
    [0, 1, 2].map(|point| {
        let point_m = |frame| calibrated.tracks.clip.position(frame, joints[point]);
        calibrated.mean_in_frame_of(carriers[point], point_m)
    })
}

/// Height at which a point is planted: a low quantile of its heights while the body is upright.
fn planted_height_m(tracks: &JointTracks, height_m: impl Fn(usize) -> f64) -> f64 {
    lower_quantile(tracks.upright.iter().map(|&frame| height_m(frame)), PLANTED_QUANTILE).unwrap_or_default()
}

/// Height of the ground under joints without soles.
fn ground_height_m(tracks: &JointTracks, leg_m: f64) -> f64 {
    let joint_height = |joint: Joint| planted_height_m(tracks, |frame| tracks.position_m(joint, frame).z);
    let end_height = |joint: Joint| {
        let end = tracks.roles.ends[joint.index()];
        end.map_or(f64::INFINITY, |end| planted_height_m(tracks, |frame| tracks.clip.position(frame, end).z))
    };
    let joints = Joint::FEET.into_iter().chain(Joint::TOES);
    let lowest = joints.map(|joint| joint_height(joint).min(end_height(joint))).fold(f64::INFINITY, f64::min);
    if (0.0..ZERO_TRUSTED_OVER_LEG * leg_m).contains(&lowest) { 0.0 } else { lowest - THICKNESS_OVER_LEG * leg_m }
}

/// End of a toe that the source shows, in the toe's frame, m.
fn toe_end(calibrated: &CalibratedTracks, toe: Joint, leg_m: f64) -> Option<DVec3> {
    calibrated.mean_end(toe).filter(|end| end.length() > TIP_MIN_OVER_LEG * leg_m)
}

/// Joint of the heel (the ankle where there is none), ball, and toe tip.
fn foot_joints(calibrated: &CalibratedTracks, side: usize, tip: DVec3) -> [DVec3; 3] {
    let tracks = &calibrated.tracks;
    let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
    let heel = tracks.roles.heels[side]
        .map(|joint| calibrated.mean_in_frame_of(foot, |frame| tracks.clip.position(frame, joint)))
        .filter(|heel| heel.z < 0.0);
    let ball = calibrated.mean_in_frame_of(foot, |frame| tracks.position_m(toe, frame));
    [heel.unwrap_or(DVec3::ZERO), ball, tip]
}

/// The sole under the joints of a foot: as far below them as the flat foot's joints are over the ground.
fn under_joints(tracks: &JointTracks, side: usize, [heel, ball, end]: [DVec3; 3], ground_m: f64) -> [DVec3; 3] {
    let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
    let flat = tracks.flat_frames(&[foot, toe]);
    let over_ground_m = |joint: Joint| {
        let sum: f64 = flat.iter().map(|&frame| tracks.position_m(joint, frame).z).sum();
        (sum / flat.len() as f64 - ground_m).max(0.0)
    };
    let (ankle_m, ball_m) = (over_ground_m(foot), over_ground_m(toe));
    // The heel's joint of a rig lies under the ankle, not at the end of the foot.
    let heel = heel.with_x(heel.x.min(-HEEL_BEHIND * ball.x));
    [heel.with_z(-ankle_m), ball.with_z(-ankle_m), DVec3::new(end.x.max(0.0), 0.0, -ball_m)]
}
