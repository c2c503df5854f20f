//! The soles: heel, ball and toe tip of each foot, in the canonical foot's and toe's frames, and the height of the
//! ground.
//!
//! Where leaf joints named `…HeelSole`, `…BallSole`, `…ToeSole` exist, they are the soles. Otherwise the soles are
//! estimated: the ground is the file's own zero if the planted feet stand just above it, else a joint's thickness below
//! them; ball and toe tip lie on it under their joints, the heel behind the ankle. Slide is then measured at the
//! joints, which do not depend on that estimate.

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};

use crate::retarget::calibration::{Tracks, flat_frames};

/// Heel behind the ankle, over the distance from ankle to ball: 5 cm where that is 13.
const HEEL_BEHIND: f64 = 0.4;
/// Toe tip beyond the ball where the source has no toe end, over leg length: 7 cm for an adult.
const TIP_OVER_LEG: f64 = 0.085;
/// Toes shorter than this have no real end, over leg length.
const TIP_MIN_OVER_LEG: f64 = 0.02;
/// The lowest joint of a planted foot over the sole, over leg length: 2 cm for an adult.
const THICKNESS_OVER_LEG: f64 = 0.024;
/// A planted lowest joint this high over the file's zero still stands on it, over leg length: 5 cm (Bandai's toe
/// joints: 4).
const ZERO_TRUSTED_OVER_LEG: f64 = 0.06;

/// What was found of both feet.
pub(crate) struct Soles {
    /// `[left, right]`: heel, ball (foot frame), toe tip (toe frame).
    pub points_m: [[DVec3; 3]; 2],
    /// In the same frames, the points at which slide is measured: those of `…Sole` joints, else the joints over the
    /// sole.
    pub measured_m: [[DVec3; 3]; 2],
    /// The ground's height in the source.
    pub ground_m: f64,
}

/// Finds the soles from the calibrated joints.
pub(crate) fn find(tracks: &Tracks, orientations: &[[DQuat; JOINT_COUNT]], leg_m: f64) -> Soles {
    if let [Some(left), Some(right)] = tracks.roles.soles {
        let points_m = [measured(tracks, orientations, 0, left), measured(tracks, orientations, 1, right)];
        let ground = |joint| planted(tracks, |frame| tracks.clip.position(frame, joint).z);
        let ground_m = left.into_iter().chain(right).map(ground).fold(f64::INFINITY, f64::min);
        return Soles { points_m, measured_m: points_m, ground_m };
    }
    let ground_m = ground(tracks, leg_m);
    let measured_m = [0, 1].map(|side| foot_joints(tracks, orientations, side, leg_m));
    let points_m = [0, 1].map(|side| under_joints(tracks, side, measured_m[side], ground_m));
    Soles { points_m, measured_m, ground_m }
}

fn measured(tracks: &Tracks, orientations: &[[DQuat; JOINT_COUNT]], side: usize, joints: [usize; 3]) -> [DVec3; 3] {
    let carriers = [Joint::FEET[side], Joint::FEET[side], Joint::TOES[side]];
    [0, 1, 2]
        .map(|point| tracks.mean_in(carriers[point], orientations, |frame| tracks.clip.position(frame, joints[point])))
}

/// Height at which a point is planted: the lowest twentieth, as in [`crate::gait::contacts`].
fn planted(tracks: &Tracks, height_m: impl Fn(usize) -> f64) -> f64 {
    let mut heights: Vec<f64> = (0..tracks.positions_m.len()).map(height_m).collect();
    heights.sort_by(f64::total_cmp);
    heights[(heights.len() - 1) / 20]
}

fn ground(tracks: &Tracks, leg_m: f64) -> f64 {
    let joint_height = |joint: Joint| planted(tracks, |frame| tracks.positions_m[frame][joint.index()].z);
    let end_height = |joint: Joint| {
        let end = tracks.roles.ends[joint.index()];
        end.map_or(f64::INFINITY, |end| planted(tracks, |frame| tracks.clip.position(frame, end).z))
    };
    let joints = Joint::FEET.into_iter().chain(Joint::TOES);
    let lowest = joints.map(|joint| joint_height(joint).min(end_height(joint))).fold(f64::INFINITY, f64::min);
    if (0.0..ZERO_TRUSTED_OVER_LEG * leg_m).contains(&lowest) { 0.0 } else { lowest - THICKNESS_OVER_LEG * leg_m }
}

/// Heel joint (the ankle where there is none), ball and end of the toe.
fn foot_joints(tracks: &Tracks, orientations: &[[DQuat; JOINT_COUNT]], side: usize, leg_m: f64) -> [DVec3; 3] {
    let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
    let heel = tracks.roles.heels[side]
        .map(|joint| tracks.mean_in(foot, orientations, |frame| tracks.clip.position(frame, joint)))
        .filter(|heel| heel.z < 0.0);
    let ball = tracks.mean_in(foot, orientations, |frame| tracks.positions_m[frame][toe.index()]);
    let end = tracks.mean_end(toe, orientations).filter(|end| end.length() > TIP_MIN_OVER_LEG * leg_m);
    [heel.unwrap_or(DVec3::ZERO), ball, end.unwrap_or(TIP_OVER_LEG * leg_m * DVec3::X)]
}

/// The sole under the joints of a foot, as high as the flat foot stands over the ground.
fn under_joints(tracks: &Tracks, side: usize, [heel, ball, end]: [DVec3; 3], ground_m: f64) -> [DVec3; 3] {
    let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
    let flat = flat_frames(tracks, &[foot, toe]);
    let over_ground = |joint: Joint| {
        let sum: f64 = flat.iter().map(|&frame| tracks.positions_m[frame][joint.index()].z).sum();
        (sum / flat.len() as f64 - ground_m).max(0.0)
    };
    let (ankle_m, ball_m) = (over_ground(foot), over_ground(toe));
    // Rigs put the heel's joint under the ankle rather than at the end of the foot.
    let heel = heel.with_x(heel.x.min(-HEEL_BEHIND * ball.x));
    [heel.with_z(-ankle_m), ball.with_z(-ankle_m), DVec3::new(end.x.max(0.0), 0.0, -ball_m)]
}

impl Tracks<'_> {
    /// Mean of a world point in a canonical joint's frame, metres.
    pub(crate) fn mean_in(
        &self,
        joint: Joint,
        orientations: &[[DQuat; JOINT_COUNT]],
        point_m: impl Fn(usize) -> DVec3,
    ) -> DVec3 {
        let index = joint.index();
        let local =
            |frame: usize| orientations[frame][index].inverse() * (point_m(frame) - self.positions_m[frame][index]);
        (0..orientations.len()).map(local).sum::<DVec3>() / orientations.len() as f64
    }

    /// Mean far end of a leaf joint's segment in its frame, where the source has one.
    pub(crate) fn mean_end(&self, joint: Joint, orientations: &[[DQuat; JOINT_COUNT]]) -> Option<DVec3> {
        let end = self.roles.ends[joint.index()]?;
        Some(self.mean_in(joint, orientations, |frame| self.clip.position(frame, end)))
    }
}
