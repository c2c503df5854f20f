//! Hair: shells around the skull, by style. Where a shell enters the head is the hairline. Rest pose, metres; rows as
//! those of the head: height, half width, front end, back end.

use motiondb::body::Joint;

use crate::figure::build::Build;
use crate::figure::head::section;
use crate::figure::section::Section;
use crate::figure::style::{Cloth, HairStyle};
use crate::figure::template::Template;

/// Short at the sides and the nape.
const SHORT: [[f32; 4]; 9] = [
    [0.018, 0.040, -0.050, -0.092],
    [0.040, 0.066, -0.035, -0.106],
    [0.075, 0.077, -0.018, -0.113],
    [0.110, 0.081, 0.018, -0.117],
    [0.140, 0.081, 0.080, -0.115],
    [0.165, 0.078, 0.103, -0.108],
    [0.190, 0.066, 0.086, -0.090],
    [0.208, 0.046, 0.055, -0.060],
    [0.217, 0.018, 0.018, -0.024],
];
/// Thick, with a quiff.
const FULL: [[f32; 4]; 9] = [
    [0.000, 0.040, -0.050, -0.096],
    [0.030, 0.070, -0.030, -0.112],
    [0.070, 0.083, -0.012, -0.121],
    [0.110, 0.087, 0.020, -0.126],
    [0.140, 0.087, 0.082, -0.124],
    [0.168, 0.085, 0.113, -0.118],
    [0.200, 0.074, 0.102, -0.100],
    [0.224, 0.052, 0.070, -0.066],
    [0.234, 0.020, 0.028, -0.026],
];
/// Around a bald crown.
const RECEDING: [[f32; 4]; 6] = [
    [0.018, 0.040, -0.050, -0.090],
    [0.040, 0.066, -0.020, -0.1035],
    [0.075, 0.0765, 0.020, -0.1085],
    [0.105, 0.0785, 0.035, -0.1105],
    [0.130, 0.0780, 0.020, -0.1090],
    [0.152, 0.0690, -0.020, -0.1010],
];
/// Down to the chin, behind the face.
const BOB: [[f32; 4]; 12] = [
    [-0.030, 0.070, 0.000, -0.085],
    [-0.026, 0.086, 0.012, -0.104],
    [0.010, 0.092, 0.022, -0.118],
    [0.050, 0.093, 0.022, -0.124],
    [0.090, 0.091, 0.030, -0.126],
    [0.120, 0.088, 0.055, -0.125],
    [0.145, 0.086, 0.094, -0.122],
    [0.170, 0.082, 0.108, -0.114],
    [0.195, 0.070, 0.092, -0.097],
    [0.214, 0.050, 0.062, -0.068],
    [0.224, 0.026, 0.028, -0.034],
    [0.227, 0.008, 0.008, -0.012],
];
/// Down over the nape: the part that follows the neck and the chest.
const LOCKS: [[f32; 4]; 7] = [
    [-0.190, 0.050, -0.062, -0.100],
    [-0.185, 0.068, -0.052, -0.112],
    [-0.140, 0.078, -0.038, -0.116],
    [-0.080, 0.084, -0.022, -0.117],
    [-0.020, 0.087, -0.010, -0.118],
    [0.040, 0.089, -0.004, -0.1195],
    [0.100, 0.082, -0.010, -0.118],
];
/// Close to the head, gathered behind.
const GATHERED: [[f32; 4]; 9] = [
    [0.000, 0.034, -0.060, -0.092],
    [0.030, 0.064, -0.042, -0.107],
    [0.070, 0.078, -0.018, -0.114],
    [0.110, 0.081, 0.020, -0.117],
    [0.140, 0.081, 0.084, -0.114],
    [0.165, 0.078, 0.102, -0.106],
    [0.188, 0.066, 0.084, -0.089],
    [0.205, 0.046, 0.054, -0.060],
    [0.213, 0.018, 0.018, -0.024],
];
/// The bun itself.
const BUN: [[f32; 4]; 6] = [
    [0.075, 0.014, -0.118, -0.146],
    [0.084, 0.032, -0.100, -0.164],
    [0.105, 0.042, -0.092, -0.172],
    [0.127, 0.040, -0.092, -0.168],
    [0.145, 0.026, -0.100, -0.154],
    [0.151, 0.008, -0.114, -0.138],
];

impl Template {
    pub(crate) fn add_hair(&mut self, build: &Build, style: HairStyle) {
        match style {
            HairStyle::Short => self.shell(build, &SHORT),
            HairStyle::Full => self.shell(build, &FULL),
            HairStyle::Receding => self.shell(build, &RECEDING),
            HairStyle::Bob => self.shell(build, &BOB),
            HairStyle::Long => {
                self.shell(build, &BOB[2..]);
                self.locks(build);
            }
            HairStyle::Bun => {
                self.shell(build, &GATHERED);
                self.shell(build, &BUN);
            }
        }
    }

    fn shell(&mut self, build: &Build, rows: &[[f32; 4]]) {
        let sections: Vec<Section> = rows.iter().map(|row| section(build, *row, 0.0, Cloth::Hair)).collect();
        self.loft(&sections, build.fineness.points(10));
    }

    fn locks(&mut self, build: &Build) {
        let joints = [Joint::SpineUpper, Joint::Head].map(Joint::index);
        let sections = LOCKS.map(|row| {
            let share = ((row[0] + 0.20) / 0.16).clamp(0.0, 1.0);
            Section { joints, share, ..section(build, row, 0.0, Cloth::Hair) }
        });
        self.loft(&sections, build.fineness.points(10));
    }
}
