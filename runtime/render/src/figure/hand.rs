//! Hands: a palm, fingers that curl a little, and a thumb. Rest pose (palms down), metres.

use glam::Vec3;
use motiondb::body::Side;

use crate::figure::build::{Build, Fineness, arm};
use crate::figure::section::Section;
use crate::figure::style::Cloth;
use crate::figure::template::Template;

/// Sections of a hand from the wrist: share of its length, half width, half thickness, drop towards the palm.
const HAND: [[f32; 4]; 9] = [
    [-0.060, 0.024, 0.019, 0.000],
    [0.080, 0.030, 0.019, 0.000],
    [0.250, 0.040, 0.017, 0.001],
    [0.450, 0.043, 0.016, 0.003],
    [0.560, 0.041, 0.014, 0.006],
    [0.740, 0.036, 0.011, 0.017],
    [0.890, 0.029, 0.009, 0.031],
    [0.970, 0.018, 0.007, 0.041],
    [0.990, 0.006, 0.003, 0.044],
];
/// Sections of a thumb: share of the hand's length, distance beside the palm's middle, drop, radius.
const THUMB: [[f32; 4]; 5] = [
    [0.120, 0.014, 0.003, 0.010],
    [0.220, 0.034, 0.008, 0.014],
    [0.360, 0.050, 0.014, 0.012],
    [0.480, 0.057, 0.019, 0.010],
    [0.540, 0.059, 0.021, 0.005],
];
/// Length of a hand that is not stretched, as a share of the segment.
const LENGTH: f32 = 0.97;

impl Template {
    pub(crate) fn add_hand(&mut self, build: &Build, side: Side) {
        let joint = arm(side)[2];
        let (wrist, scale) = (build.joint(joint), build.by_sex(1.0, 0.88) * build.scale);
        let along = LENGTH * build.by_sex(1.0, 0.93) * build.skeleton.segment_ends_m[joint.index()];
        let section = |at: f32, beside: f32, drop: f32, half: [f32; 2]| {
            let middle = wrist + at * along + Vec3::new(beside, 0.0, -drop) * scale;
            let [width, height] = half.map(|half| half * scale);
            Section::round(middle, Vec3::Z * height, Vec3::X * width, joint.index(), Cloth::Skin)
        };
        let palm = HAND.map(|[at, width, height, drop]| section(at, 0.0, drop, [width, height]));
        self.loft_limb(&palm, build.fineness.points(8), side);
        if build.fineness > Fineness::Coarse {
            let thumb = THUMB.map(|[at, beside, drop, radius]| section(at, beside, drop, [radius, radius]));
            self.loft_limb(&thumb, build.fineness.points(5), side);
        }
    }
}
