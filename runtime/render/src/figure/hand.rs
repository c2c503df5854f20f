//! Hands: a palm, fingers that curl a little, and a thumb. Rest pose (palms down), metres. Only fine hands part the fingers.

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
/// Number of sections of [`HAND`] before the knuckles.
const PALM: usize = 4;
/// Sections that close the palm of a fine hand over the knuckles.
const KNUCKLES: [[f32; 4]; 3] =
    [[0.520, 0.042, 0.015, 0.004], [0.565, 0.040, 0.011, 0.006], [0.585, 0.036, 0.005, 0.007]];
/// A finger, index finger first: where it begins as a share of the hand's length, distance beside the palm's middle, length as
/// a share of the hand's, and how far it curls.
const FINGERS: [[f32; 4]; 4] =
    [[0.500, 0.030, 0.44, 0.85], [0.515, 0.010, 0.48, 1.00], [0.500, -0.010, 0.45, 1.12], [0.465, -0.029, 0.37, 1.22]];
/// Sections of a finger: distance from the one before as a share of its length, turn from the palm, rad, radius.
const FINGER: [[f32; 3]; 9] = [
    [0.00, 0.00, 0.0070],
    [0.14, 0.12, 0.0098],
    [0.20, 0.28, 0.0094],
    [0.20, 0.30, 0.0088],
    [0.07, 0.55, 0.0092],
    [0.18, 0.80, 0.0080],
    [0.06, 0.95, 0.0080],
    [0.12, 1.05, 0.0071],
    [0.03, 1.10, 0.0040],
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
        let (wrist, scale, along) = (build.joint(joint), breadth(build), along(build, side));
        let section = |at: f32, beside: f32, drop: f32, half: [f32; 2]| {
            let middle = wrist + at * along + Vec3::new(beside, 0.0, -drop) * scale;
            let [width, height] = half.map(|half| half * scale);
            Section::round(middle, Vec3::Z * height, Vec3::X * width, joint.index(), Cloth::Skin)
        };
        let palm = |[at, width, height, drop]: [f32; 4]| section(at, 0.0, drop, [width, height]);
        let is_fine = build.fineness == Fineness::Fine;
        let rows = if is_fine { [&HAND[..PALM], &KNUCKLES[..]].concat() } else { HAND.to_vec() };
        let palm: Vec<Section> = rows.into_iter().map(palm).collect();
        self.loft_limb(&palm, build.fineness.points(8), side);
        if is_fine {
            for finger in FINGERS {
                self.loft_limb(&finger_sections(build, side, finger), build.fineness.points(5), side);
            }
        }
        if build.fineness > Fineness::Coarse {
            let thumb = THUMB.map(|[at, beside, drop, radius]| section(at, beside, drop, [radius, radius]));
            self.loft_limb(&thumb, build.fineness.points(5), side);
        }
    }
}

/// Size of a hand across, relative to the reference body.
fn breadth(build: &Build) -> f32 {
    build.by_sex(1.0, 0.88) * build.scale
}

/// From the wrist to the end of the hand.
fn along(build: &Build, side: Side) -> Vec3 {
    LENGTH * build.by_sex(1.0, 0.93) * build.skeleton.segment_ends_m[arm(side)[2].index()]
}

fn finger_sections(build: &Build, side: Side, [at, beside, length, curl]: [f32; 4]) -> Vec<Section> {
    let (joint, scale, along) = (arm(side)[2], breadth(build), along(build, side));
    let ahead = along.normalize_or_zero();
    let mut middle = build.joint(joint) + at * along + Vec3::new(beside, 0.0, -KNUCKLES[0][3]) * scale;
    let section = |[step, turn_rad, radius]: [f32; 3]| {
        let (sin, cos) = libm::sincosf(curl * turn_rad);
        middle += step * length * along.length() * (cos * ahead - sin * Vec3::Z);
        let up = cos * Vec3::Z + sin * ahead;
        Section::round(middle, radius * scale * up, radius * scale * Vec3::X, joint.index(), Cloth::Skin)
    };
    FINGER.into_iter().map(section).collect()
}
