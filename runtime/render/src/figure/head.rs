//! Neck and head: jaw and chin, nose, ears, eyes and mouth. Rest pose, metres; heights from the head's joint.

use glam::Vec3;
use motiondb::body::Joint;

use crate::figure::build::{Build, Fineness};
use crate::figure::section::Section;
use crate::figure::style::Cloth;
use crate::figure::template::Template;

/// Sections of the neck: height, half width, front, back.
const NECK: [[f32; 4]; 5] = [
    [-0.145, 0.074, 0.056, 0.070],
    [-0.105, 0.060, 0.053, 0.060],
    [-0.060, 0.055, 0.053, 0.057],
    [-0.010, 0.055, 0.056, 0.062],
    [0.030, 0.054, 0.050, 0.066],
];
/// Sections of the head from chin to crown: height, half width, front end, back end.
const HEAD: [[f32; 4]; 14] = [
    [-0.026, 0.014, 0.088, 0.050],
    [-0.020, 0.030, 0.098, 0.020],
    [-0.004, 0.046, 0.103, -0.030],
    [0.014, 0.057, 0.100, -0.062],
    [0.030, 0.063, 0.101, -0.080],
    [0.048, 0.067, 0.101, -0.091],
    [0.070, 0.071, 0.095, -0.099],
    [0.092, 0.074, 0.094, -0.104],
    [0.112, 0.075, 0.101, -0.106],
    [0.135, 0.075, 0.100, -0.105],
    [0.160, 0.071, 0.090, -0.098],
    [0.182, 0.060, 0.070, -0.081],
    [0.198, 0.040, 0.042, -0.053],
    [0.205, 0.016, 0.012, -0.020],
];
/// Sections of the nose: height, half width, front end, back end.
const NOSE: [[f32; 4]; 6] = [
    [0.040, 0.010, 0.106, 0.085],
    [0.044, 0.017, 0.120, 0.080],
    [0.054, 0.015, 0.124, 0.080],
    [0.070, 0.011, 0.112, 0.080],
    [0.090, 0.009, 0.101, 0.080],
    [0.104, 0.008, 0.098, 0.080],
];
/// Sections of an ear: height, half thickness, front end, back end.
const EAR: [[f32; 4]; 5] = [
    [0.040, 0.006, 0.004, -0.006],
    [0.050, 0.010, 0.010, -0.014],
    [0.075, 0.012, 0.008, -0.024],
    [0.095, 0.011, 0.004, -0.026],
    [0.104, 0.004, -0.006, -0.018],
];
/// Sections of an eye's dark slit: height, half width, front end, back end; its distance from the middle.
const EYE: [[f32; 4]; 3] = [[0.083, 0.011, 0.091, 0.070], [0.088, 0.014, 0.0945, 0.070], [0.094, 0.011, 0.091, 0.070]];
/// Distance of an eye from the middle, m.
const EYE_Y: f32 = 0.033;
/// Sections of the mouth.
const MOUTH: [[f32; 4]; 3] =
    [[0.013, 0.018, 0.1020, 0.070], [0.019, 0.024, 0.1040, 0.070], [0.025, 0.018, 0.1020, 0.070]];

impl Template {
    pub(crate) fn add_head(&mut self, build: &Build) {
        let points = build.fineness.points(10);
        self.add_neck(build, points);
        self.loft(&HEAD.map(|row| section(build, row, 0.0, Cloth::Skin)), points);
        if build.fineness == Fineness::Coarse {
            return;
        }
        let few = build.fineness.points(6);
        self.loft(&NOSE.map(|row| section(build, row, 0.0, Cloth::Skin)), few);
        self.loft(&MOUTH.map(|row| section(build, row, 0.0, Cloth::Lips)), few);
        for side in [-1.0, 1.0] {
            self.loft(&EAR.map(|row| section(build, row, side * 0.074, Cloth::Skin)), few);
            self.loft(&EYE.map(|row| section(build, row, side * EYE_Y, Cloth::Eye)), few);
        }
    }

    fn add_neck(&mut self, build: &Build, points: u32) {
        let joints = [Joint::SpineUpper, Joint::Neck, Joint::Head].map(Joint::index);
        let sections = NECK.map(|[height, width, front, back]| {
            let slim = build.by_sex(1.0, 0.84);
            // The base follows the chest, the top the head.
            let (pair, share) = if height < -0.06 {
                ([joints[0], joints[1]], ((height + 0.145) / 0.085).clamp(0.0, 1.0))
            } else {
                ([joints[1], joints[2]], ((height + 0.06) / 0.07).clamp(0.0, 1.0))
            };
            let row = [height, width * slim, front * slim, -back * slim];
            Section { joints: pair, share, ..section(build, row, 0.0, Cloth::Skin) }
        });
        self.loft(&sections, points);
    }
}

/// A section of the head: height, half width, front end and back end from the head's joint; `beside` shifts it.
pub(crate) fn section(build: &Build, row: [f32; 4], beside: f32, cloth: Cloth) -> Section {
    let [height, width, front, back] = row;
    let scale = build.by_sex(1.0, 0.955) * build.scale;
    let middle = 0.5 * (front + back);
    let jaw = if height < 0.04 { build.by_sex(1.0, 0.93) } else { 1.0 };
    let at = build.joint(Joint::Head) + Vec3::new(middle, beside, height) * scale;
    let half = Vec3::X * (0.5 * (front - back) * scale);
    Section::round(at, Vec3::Y * (width * jaw * scale), half, Joint::Head.index(), cloth)
}
