//! Pelvis and trunk: trousers up to the waist, a shirt over them up to the collar, with shoulders that slope into the
//! neck. Rest pose, metres.

use glam::Vec3;
use motiondb::body::Joint;

use crate::figure::build::Build;
use crate::figure::section::Section;
use crate::figure::style::Cloth;
use crate::figure::template::Template;

/// Sections of the pelvis: height, half width, front, back.
const PELVIS: [[f32; 4]; 7] = [
    [0.800, 0.045, 0.030, 0.050],
    [0.818, 0.098, 0.062, 0.085],
    [0.850, 0.146, 0.088, 0.112],
    [0.895, 0.166, 0.098, 0.126],
    [0.945, 0.168, 0.102, 0.122],
    [1.000, 0.156, 0.104, 0.100],
    [1.050, 0.140, 0.096, 0.082],
];
/// Sections of the shirt: height, half width, front, back.
const SHIRT: [[f32; 4]; 15] = [
    [0.925, 0.160, 0.098, 0.112],
    [0.928, 0.174, 0.109, 0.127],
    [0.965, 0.171, 0.111, 0.121],
    [1.020, 0.158, 0.110, 0.101],
    [1.080, 0.150, 0.109, 0.092],
    [1.150, 0.150, 0.110, 0.092],
    [1.225, 0.158, 0.116, 0.101],
    [1.295, 0.169, 0.120, 0.112],
    [1.350, 0.177, 0.113, 0.116],
    [1.395, 0.198, 0.097, 0.112],
    [1.422, 0.213, 0.078, 0.098],
    [1.441, 0.206, 0.064, 0.088],
    [1.458, 0.178, 0.057, 0.082],
    [1.478, 0.122, 0.054, 0.075],
    [1.496, 0.066, 0.055, 0.064],
];
/// Sections of the collar, a narrow band around the neck that begins in the shirt.
const COLLAR: [[f32; 4]; 4] = [
    [1.468, 0.080, 0.051, 0.070],
    [1.488, 0.074, 0.062, 0.071],
    [1.504, 0.068, 0.062, 0.068],
    [1.503, 0.057, 0.050, 0.058],
];
/// Factors of a woman's half width, front and back at the heights of [`FEMALE_HEIGHTS`].
const FEMALE: [[f32; 3]; 8] = [
    [1.04, 0.98, 1.06],
    [1.03, 0.98, 1.05],
    [0.93, 0.93, 0.95],
    [0.83, 0.86, 0.86],
    [0.85, 0.96, 0.86],
    [0.86, 1.18, 0.88],
    [0.92, 0.98, 0.90],
    [0.93, 0.88, 0.88],
];
/// Heights of [`FEMALE`].
const FEMALE_HEIGHTS: [f32; 8] = [0.85, 0.945, 1.02, 1.10, 1.20, 1.29, 1.37, 1.48];
/// Power of the sections: a trunk is boxier than an ellipse.
const POWER: f32 = 2.35;

impl Template {
    pub(crate) fn add_trunk(&mut self, build: &Build) {
        let points = build.fineness.points(10);
        let pelvis: Vec<Section> = PELVIS.iter().map(|row| section(build, *row, Cloth::Trousers)).collect();
        let shirt: Vec<Section> = SHIRT.iter().map(|row| section(build, *row, Cloth::Shirt)).collect();
        self.loft(&pelvis, points);
        self.loft(&shirt, points);
        let collar = COLLAR.map(|row| section(build, row, Cloth::Collar));
        self.loft(&collar, points);
    }
}

fn section(build: &Build, [height, width, front, back]: [f32; 4], cloth: Cloth) -> Section {
    let [wide, ahead, behind] = sex_factors(build, height);
    let scale = build.scale;
    let (joints, share) = trunk_joints(build, height * scale);
    let neck_x = build.joint(Joint::Neck).x;
    Section {
        at: Vec3::new(neck_x, 0.0, height * scale),
        side: Vec3::Y * (width * wide * scale),
        front: Vec3::X * (front * ahead * scale),
        back: Vec3::X * (back * behind * scale),
        power: POWER,
        joints,
        share,
        cloth,
    }
}

pub(crate) fn sex_factors(build: &Build, height: f32) -> [f32; 3] {
    let after = FEMALE_HEIGHTS.partition_point(|known| *known <= height);
    let (low, high) = (after.saturating_sub(1), after.min(FEMALE.len() - 1));
    let span = FEMALE_HEIGHTS[high] - FEMALE_HEIGHTS[low];
    let share = if span > 0.0 { (height - FEMALE_HEIGHTS[low]) / span } else { 0.0 };
    [0, 1, 2].map(|index| build.by_sex(1.0, FEMALE[low][index] + share * (FEMALE[high][index] - FEMALE[low][index])))
}

/// The two joints between whose segments' middles a height lies, and the share of the upper one.
fn trunk_joints(build: &Build, height: f32) -> ([usize; 2], f32) {
    let joints = [Joint::Pelvis, Joint::SpineLower, Joint::SpineMiddle, Joint::SpineUpper];
    let middle = |joint: Joint| build.joint(joint).z + 0.5 * build.skeleton.segment_ends_m[joint.index()].z;
    for pair in joints.windows(2) {
        let (below, above) = (middle(pair[0]), middle(pair[1]));
        if height < above {
            let share = ((height - below) / (above - below)).clamp(0.0, 1.0);
            return ([pair[0].index(), pair[1].index()], share);
        }
    }
    ([Joint::SpineUpper.index(); 2], 0.0)
}
