//! Figures of the bodies of some poses: soles under the ground, knees, legs, and joints beyond their range. Root frame.

use glam::Vec3;

use crate::body::joint_ranges::JOINT_RANGES_DEG;
use crate::body::pose::{Joints, Pose};
use crate::body::skeleton::{Joint, Skeleton};
use crate::quality::finding::{FigureLimit, up_to};

/// Greatest depth of a sole below the ground, mm. The compiler permits 10, the give of pads and shoes; 20 is visible.
const PENETRATION_MAX_MM: f32 = 20.0;
/// Least flexion of a knee, degrees. People land on knees flexed by 3–5°; a straighter knee snaps.
const KNEE_FLEXION_MIN_DEG: f32 = 1.0;
/// Greatest distance of hip and ankle, divided by thigh plus shank. The compiler's leg inverse kinematics ends at
/// 0.9995 (a knee flexed by 3.6°), so a longer leg is the clip's own.
const LEG_EXTENSION_MAX: f32 = 0.9997;
/// Greatest turn of a joint beyond the published range, degrees: good clips exceed it by up to 42° (`docs/tuning.md`).
const RANGE_EXCESS_MAX_DEG: f32 = 45.0;

/// The worst figures of some poses; their units and meanings are those of
/// [`ExampleQuality`](crate::quality::example_quality::ExampleQuality).
pub(crate) struct BodyFigures {
    pub(crate) penetration_mm: f32,
    pub(crate) knee_flexion_min_deg: f32,
    pub(crate) leg_extension_max: f32,
    pub(crate) range_excess_deg: f32,
    pub(crate) range_excess_joint: &'static str,
}

impl BodyFigures {
    /// The figures of poses; `joints` are the same poses after forward kinematics.
    pub(crate) fn of(poses: &[Pose], joints: &[Joints], skeleton: &Skeleton) -> Self {
        let (range_excess_deg, joint) = range_excess_deg(poses);
        Self {
            penetration_mm: penetration_mm(joints, skeleton),
            knee_flexion_min_deg: knee_flexion_min_deg(poses),
            leg_extension_max: leg_extension_max(joints, skeleton),
            range_excess_deg,
            range_excess_joint: joint.name(),
        }
    }

    /// The figures with their usual ranges.
    pub(crate) fn limits(&self) -> [FigureLimit; 4] {
        let (sunk_mm, flexed_deg) = (self.penetration_mm, self.knee_flexion_min_deg);
        let (joint, excess_deg) = (self.range_excess_joint, self.range_excess_deg);
        let limit = |measure, unit, value, range, sentence| FigureLimit { measure, unit, value, range, sentence };
        let sinks = format!("a sole sinks {sunk_mm:.0} mm into the ground");
        let straightens = format!("a knee straightens to {flexed_deg:.1}° of flexion: it snaps or bends backward");
        let stretched = "a leg is stretched to its full length; it may be too short for the clip's steps".to_owned();
        let turns = format!("{joint} turns {excess_deg:.0}° beyond the human range");
        [
            limit("penetration_mm", "mm", sunk_mm, up_to(PENETRATION_MAX_MM), sinks),
            limit("knee_flexion_min_deg", "deg", flexed_deg, [KNEE_FLEXION_MIN_DEG, f32::INFINITY], straightens),
            limit("leg_extension_max", "", self.leg_extension_max, up_to(LEG_EXTENSION_MAX), stretched),
            limit("range_excess_deg", "deg", excess_deg, up_to(RANGE_EXCESS_MAX_DEG), turns),
        ]
    }
}

fn penetration_mm(joints: &[Joints], skeleton: &Skeleton) -> f32 {
    let soles = joints.iter().flat_map(|joints| [0, 1].map(|side| joints.sole_points_m(skeleton, side)));
    1000.0 * soles.flatten().map(|point| -point.z).fold(0.0, f32::max)
}

fn knee_flexion_min_deg(poses: &[Pose]) -> f32 {
    let flexions_rad = poses.iter().flat_map(|pose| [0, 1].map(|side| pose.knee_flexion_rad(side)));
    flexions_rad.fold(f32::INFINITY, f32::min).to_degrees()
}

fn leg_extension_max(joints: &[Joints], skeleton: &Skeleton) -> f32 {
    let extension = |joints: &Joints, side: usize| {
        let [thigh, shank, foot] = [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]].map(Joint::index);
        let leg_m = skeleton.offsets_m[shank].length() + skeleton.offsets_m[foot].length();
        joints.positions_m[thigh].distance(joints.positions_m[foot]) / leg_m
    };
    joints.iter().flat_map(|joints| [0, 1].map(|side| extension(joints, side))).fold(0.0, f32::max)
}

/// Greatest turn of a joint beyond its published range, degrees, and the joint.
fn range_excess_deg(poses: &[Pose]) -> (f32, Joint) {
    let mut worst = (0.0, Joint::Pelvis);
    for pose in poses {
        for (joint, rotation) in Joint::ALL.into_iter().zip(pose.rotations) {
            let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
            let turned_deg = rotation.to_scaled_axis().map(f32::to_degrees);
            let [least, greatest] = JOINT_RANGES_DEG[joint.index()].map(Vec3::from_array);
            let excess_deg = (least - turned_deg).max(turned_deg - greatest).max_element();
            if excess_deg > worst.0 {
                worst = (excess_deg, joint);
            }
        }
    }
    worst
}
