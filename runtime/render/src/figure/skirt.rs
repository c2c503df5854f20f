//! Skirts, and the lower part of coats: cloth around the hips and both thighs, open below. Rest pose, metres.

use glam::Vec3;
use motiondb::body::Joint;

use crate::figure::build::Build;
use crate::figure::section::Section;
use crate::figure::style::Cloth;
use crate::figure::template::{Template, Vertex};
use crate::figure::trunk::sex_factors;

/// Sections of a skirt: height, half width, front, back.
const SKIRT: [[f32; 4]; 8] = [
    [1.000, 0.135, 0.085, 0.080],
    [0.950, 0.158, 0.098, 0.110],
    [0.915, 0.171, 0.107, 0.125],
    [0.870, 0.180, 0.113, 0.134],
    [0.800, 0.188, 0.126, 0.140],
    [0.700, 0.200, 0.142, 0.152],
    [0.600, 0.214, 0.160, 0.168],
    [0.540, 0.222, 0.170, 0.177],
];
/// Sections of a coat below the waist.
const COAT: [[f32; 4]; 8] = [
    [1.110, 0.146, 0.104, 0.088],
    [1.070, 0.158, 0.117, 0.101],
    [1.000, 0.172, 0.122, 0.116],
    [0.925, 0.186, 0.122, 0.138],
    [0.830, 0.194, 0.130, 0.146],
    [0.740, 0.201, 0.142, 0.154],
    [0.640, 0.210, 0.156, 0.164],
    [0.580, 0.215, 0.163, 0.170],
];
/// Height up to which cloth follows the thighs alone, and from which it follows the pelvis alone, on the reference body, m.
const FOLLOWS_M: [f32; 2] = [0.80, 0.93];
/// Half width over which cloth changes from one thigh to the other, m.
const BETWEEN_M: f32 = 0.07;
/// Thickness of the hem, m.
const HEM_M: f32 = 0.012;

impl Template {
    pub(crate) fn add_skirt(&mut self, build: &Build) {
        self.add_hanging(build, &SKIRT);
    }

    pub(crate) fn add_coat(&mut self, build: &Build) {
        self.add_hanging(build, &COAT);
    }

    /// Cloth from inside the hem to its upper edge.
    fn add_hanging(&mut self, build: &Build, rows: &[[f32; 4]; 8]) {
        let inside = |[height, width, front, back]: [f32; 4]| [height, width - HEM_M, front - HEM_M, back - HEM_M];
        // Front × side × up is right-handed.
        let mut sections: Vec<Section> = [rows[6], rows[7]].map(|row| section(build, inside(row))).to_vec();
        sections.extend(rows.iter().rev().map(|row| section(build, *row)));
        let first = self.vertices.len();
        self.loft(&sections, build.fineness.points(12));
        for vertex in &mut self.vertices[first..] {
            follow_thighs(vertex, build.scale);
        }
    }
}

fn section(build: &Build, [height, width, front, back]: [f32; 4]) -> Section {
    let scale = build.scale;
    let [wide, ahead_share, behind_share] = sex_factors(build, height);
    let at = Vec3::new(build.joint(Joint::Neck).x, 0.0, height * scale);
    let [side, ahead, behind] = [width * wide, front * ahead_share, back * behind_share].map(|half| half * scale);
    Section {
        back: Vec3::X * behind,
        power: 2.2,
        ..Section::round(at, Vec3::Y * side, Vec3::X * ahead, Joint::Pelvis.index(), Cloth::Skirt)
    }
}

/// Lets a point follow the thigh of its side, in the middle both, and above them the pelvis.
fn follow_thighs(vertex: &mut Vertex, scale: f32) {
    let point = vertex.position / scale;
    let [low, high] = FOLLOWS_M;
    let left = (0.5 + 0.5 * point.y / BETWEEN_M).clamp(0.0, 1.0);
    let thigh = 1.0 - ((point.z - low) / (high - low)).clamp(0.0, 1.0);
    let [left_thigh, right_thigh] = Joint::THIGHS.map(Joint::index);
    let shares = [1.0 - thigh, thigh * left, thigh * (1.0 - left)];
    vertex.follow([(Joint::Pelvis.index(), shares[0]), (left_thigh, shares[1]), (right_thigh, shares[2])]);
}
