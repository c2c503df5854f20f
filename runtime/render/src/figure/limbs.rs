//! Arms and legs. Rest pose, metres.

use glam::Vec3;
use motiondb::body::{Joint, Side};

use crate::figure::build::{Build, arm};
use crate::figure::section::Section;
use crate::figure::style::Cloth;
use crate::figure::template::Template;

/// Sections of an arm from shoulder (0) over elbow (1) to wrist (2): place, half width fore and aft, half height.
const ARM: [[f32; 3]; 16] = [
    [-0.040, 0.012, 0.012],
    [-0.030, 0.028, 0.027],
    [0.000, 0.040, 0.034],
    [0.050, 0.051, 0.041],
    [0.110, 0.058, 0.047],
    [0.200, 0.060, 0.052],
    [0.370, 0.056, 0.051],
    [0.600, 0.048, 0.047],
    [0.850, 0.043, 0.043],
    [1.000, 0.042, 0.042],
    [1.150, 0.044, 0.042],
    [1.320, 0.043, 0.039],
    [1.600, 0.036, 0.033],
    [1.850, 0.031, 0.026],
    [2.000, 0.029, 0.023],
    [2.060, 0.026, 0.019],
];
/// Place on the arm at which short sleeves end.
const SLEEVE_END: f32 = 0.72;
/// Half of the stretch over which a limb bends around its middle joint, share of a bone.
const BEND: f32 = 0.17;
/// Sections of a leg from hip (0) over knee (1) to ankle (2): place, half depth, half width, shift forward.
const LEG: [[f32; 4]; 14] = [
    [-0.045, 0.060, 0.054, -0.008],
    [0.030, 0.086, 0.075, -0.008],
    [0.150, 0.093, 0.081, -0.002],
    [0.350, 0.085, 0.075, 0.004],
    [0.600, 0.073, 0.066, 0.006],
    [0.850, 0.062, 0.058, 0.006],
    [1.000, 0.059, 0.055, 0.004],
    [1.120, 0.057, 0.053, -0.004],
    [1.300, 0.060, 0.054, -0.013],
    [1.500, 0.054, 0.049, -0.012],
    [1.720, 0.047, 0.044, -0.006],
    [1.880, 0.047, 0.044, -0.002],
    [1.945, 0.049, 0.045, 0.000],
    [1.948, 0.036, 0.033, 0.000],
];

/// Sections of a bare leg, which begins under cloth: where a long step lifts the thigh, its upper end stays below the cloth.
const BARE_LEG: [[f32; 4]; 12] = [
    [0.550, 0.071, 0.064, 0.006],
    [0.650, 0.066, 0.060, 0.007],
    [0.850, 0.057, 0.053, 0.006],
    [0.960, 0.055, 0.051, 0.007],
    [1.060, 0.052, 0.048, 0.003],
    [1.180, 0.052, 0.047, -0.007],
    [1.320, 0.055, 0.049, -0.014],
    [1.480, 0.049, 0.044, -0.013],
    [1.680, 0.038, 0.035, -0.006],
    [1.840, 0.032, 0.029, -0.002],
    [1.940, 0.033, 0.030, 0.000],
    [2.010, 0.031, 0.028, 0.004],
];
/// Place on the leg at which shorts end.
const SHORTS_END: f32 = 0.83;

impl Template {
    /// An arm in a sleeve down to the wrist.
    pub(crate) fn add_long_sleeve(&mut self, build: &Build, side: Side) {
        let sections: Vec<Section> = ARM.iter().map(|row| arm_section(build, side, *row, Cloth::Sleeve)).collect();
        self.loft_limb(&sections, build.fineness.points(8), side);
    }

    /// A bare arm below, above it a sleeve that ends with a hem.
    pub(crate) fn add_short_sleeve(&mut self, build: &Build, side: Side) {
        let section = |row: [f32; 3], cloth: Cloth| arm_section(build, side, row, cloth);
        let is_below = |row: &&[f32; 3]| row[0] > SLEEVE_END - 0.2;
        let below: Vec<Section> = ARM.iter().filter(is_below).map(|row| section(*row, Cloth::Skin)).collect();
        let sleeve = ARM.iter().take_while(|row| row[0] < SLEEVE_END).copied();
        let hem = [[SLEEVE_END, 0.0462, 0.0462], [SLEEVE_END + 0.004, 0.040, 0.040]];
        let above: Vec<Section> = sleeve.chain(hem).map(|row| section(row, Cloth::Shirt)).collect();
        let points = build.fineness.points(8);
        self.loft_limb(&below, points, side);
        self.loft_limb(&above, points, side);
    }

    /// A leg in trousers.
    pub(crate) fn add_trouser_leg(&mut self, build: &Build, side: Side) {
        self.loft_leg(build, side, &LEG, Cloth::Trousers);
    }

    /// A bare leg.
    pub(crate) fn add_bare_leg(&mut self, build: &Build, side: Side) {
        self.loft_leg(build, side, &BARE_LEG, Cloth::Skin);
    }

    /// A leg of shorts.
    pub(crate) fn add_short_leg(&mut self, build: &Build, side: Side) {
        let above = LEG.iter().take_while(|row| row[0] < SHORTS_END).copied();
        let hem = [[SHORTS_END, 0.074, 0.068, 0.006], [SHORTS_END + 0.004, 0.060, 0.055, 0.006]];
        let rows: Vec<[f32; 4]> = above.chain(hem).collect();
        self.loft_leg(build, side, &rows, Cloth::Trousers);
    }

    fn loft_leg(&mut self, build: &Build, side: Side, rows: &[[f32; 4]], cloth: Cloth) {
        let sections: Vec<Section> = rows.iter().rev().map(|row| leg(build, side, *row, cloth)).collect();
        self.loft(&sections, build.fineness.points(8));
    }

    /// A loft along +y or −y, facing outward on both sides.
    pub(crate) fn loft_limb(&mut self, sections: &[Section], points: u32, side: Side) {
        let turned: Vec<Section> = match side {
            // Front × side × direction: x, z and −y are right-handed.
            Side::Right => sections.to_vec(),
            Side::Left => sections.iter().map(|section| Section { side: -section.side, ..*section }).collect(),
        };
        self.loft(&turned, points);
    }
}

/// A section of an arm: place, half width fore and aft, half height.
fn arm_section(build: &Build, side: Side, [at, depth, height]: [f32; 3], cloth: Cloth) -> Section {
    let joints = arm(side);
    let [shoulder, elbow, wrist] = joints.map(|joint| build.joint(joint));
    let place = if at < 1.0 { shoulder.lerp(elbow, at) } else { elbow.lerp(wrist, at - 1.0) };
    let size = build.by_sex(1.0, 0.84) * build.scale * loose(cloth, at);
    let (index, share) = bend(at);
    Section {
        joints: [joints[index].index(), joints[index + 1].index()],
        share,
        ..Section::round(place, Vec3::Z * height * size, Vec3::X * depth * size, joints[0].index(), cloth)
    }
}

/// A section of a leg: place, half depth, half width, shift forward.
fn leg(build: &Build, side: Side, [at, depth, width, shift]: [f32; 4], cloth: Cloth) -> Section {
    let index = side.index();
    let joints = [Joint::THIGHS[index], Joint::SHANKS[index], Joint::FEET[index]];
    let [hip, knee, ankle] = joints.map(|joint| build.joint(joint));
    let place = if at < 1.0 { hip.lerp(knee, at) } else { knee.lerp(ankle, at - 1.0) };
    let size = build.by_sex(1.0, if at < 0.7 { 1.0 } else { 0.9 }) * build.scale;
    let (from, share) = bend(at);
    let at_m = place + Vec3::X * shift * build.scale;
    let (side_m, front_m) = (Vec3::Y * width * size, Vec3::X * depth * size);
    let round = Section::round(at_m, side_m, front_m, joints[0].index(), cloth);
    // The top of a thigh follows the pelvis a little.
    if at < 0.1 {
        let share = 0.35 * (1.0 - at / 0.1).clamp(0.0, 1.0);
        return Section { joints: [joints[0].index(), Joint::Pelvis.index()], share, ..round };
    }
    // Trousers end at the shank; the foot does not pull them.
    let last = if from == 1 { joints[1] } else { joints[from + 1] };
    Section { joints: [joints[from].index(), last.index()], share, ..round }
}

/// Factor of a cloth's size: a sleeve hangs about the arm, and narrows to the wrist.
fn loose(cloth: Cloth, at: f32) -> f32 {
    if cloth == Cloth::Skin { 1.0 } else { 1.0 + 0.035 * ((at - 0.1) / 0.4).min((2.0 - at) / 0.5).clamp(0.0, 1.0) }
}

/// The first of the two joints that a place on a limb follows, and the share of the second.
fn bend(at: f32) -> (usize, f32) {
    let around = |joint: f32| ((at - joint + BEND) / (2.0 * BEND)).clamp(0.0, 1.0);
    if at < 1.0 + BEND { (0, around(1.0)) } else { (1, around(2.0)) }
}
