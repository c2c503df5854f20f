//! Skirts, and the lower part of coats: cloth that hangs from the pelvis around both thighs, open below. Where a step
//! moves a thigh through it, it is pushed out. Rest pose, metres.

use glam::Vec3;
use motiondb::body::Joint;

use crate::figure::build::Build;
use crate::figure::section::Section;
use crate::figure::style::Cloth;
use crate::figure::template::{HangingCloth, Template};
use crate::figure::trunk::sex_factors;

/// Sections of a skirt: height, half width, front, back.
const SKIRT: [[f32; 4]; 8] = [
    [1.000, 0.135, 0.085, 0.080],
    [0.950, 0.158, 0.098, 0.110],
    [0.915, 0.171, 0.107, 0.125],
    [0.870, 0.180, 0.113, 0.134],
    [0.800, 0.188, 0.134, 0.140],
    [0.700, 0.200, 0.154, 0.154],
    [0.600, 0.214, 0.171, 0.170],
    [0.540, 0.222, 0.180, 0.180],
];
/// Sections of a coat below the waist.
const COAT: [[f32; 4]; 8] = [
    [1.100, 0.138, 0.096, 0.082],
    [1.092, 0.157, 0.116, 0.099],
    [1.000, 0.172, 0.122, 0.116],
    [0.925, 0.186, 0.122, 0.138],
    [0.830, 0.194, 0.130, 0.146],
    [0.740, 0.201, 0.142, 0.154],
    [0.640, 0.210, 0.156, 0.164],
    [0.580, 0.215, 0.163, 0.170],
];
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
        let points = build.fineness.points(12);
        self.loft(&sections, points);
        let waist = sections[sections.len() - 1].at;
        self.hanging =
            Some(HangingCloth { waist, inner: 2 * points as usize, scale: build.scale, hem: HEM_M * build.scale });
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use fbcrowd_sim::recording::Recording;
    use glam::{Mat3, Vec2};
    use motiondb::body::Side;

    use super::*;
    use crate::figure::build::Fineness;
    use crate::figure::style::{CLOTHS, Sex};
    use crate::figure::template::{Disc, PosedJoint, outline};
    use crate::visibility::{Meshes, Owner};

    /// A body at rest whose straight legs are swung forward by angles.
    fn striding(build: &Build, forward_rad: [f32; 2]) -> Vec<PosedJoint> {
        let at_rest = |rest: &Vec3| PosedJoint { rotation: Mat3::IDENTITY, rest: *rest, position: *rest };
        let mut joints: Vec<PosedJoint> = build.rest.iter().map(at_rest).collect();
        for (side, angle_rad) in forward_rad.into_iter().enumerate() {
            let hip = build.joint(Joint::THIGHS[side]);
            let rotation = Mat3::from_rotation_y(-angle_rad);
            for joint in [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]] {
                let rest = build.joint(joint);
                joints[joint.index()] = PosedJoint { rotation, rest, position: hip + rotation * (rest - hip) };
            }
        }
        joints
    }

    fn posed(template: Template, joints: &[PosedJoint]) -> Meshes {
        let mut meshes = Meshes::default();
        template.append(&mut meshes, joints, &[Vec3::ONE; CLOTHS], Owner::SCENE);
        meshes
    }

    /// Whether a ray from a point meets a triangle.
    fn meets(corners_m: [Vec3; 3], from_m: Vec3, direction: Vec3) -> bool {
        let [a, b, c] = corners_m.map(|corner_m| corner_m - from_m);
        let volumes = [a.cross(b), b.cross(c), c.cross(a)].map(|across| across.dot(direction));
        let is_across = volumes.iter().all(|volume| *volume > 0.0) || volumes.iter().all(|volume| *volume < 0.0);
        is_across && a.dot((b - a).cross(c - a)) * direction.dot((b - a).cross(c - a)) > 0.0
    }

    #[test]
    fn the_hem_of_a_skirt_stays_level_in_strides() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/walkers.fbrec");
        let recording = Recording::open(&path).unwrap();
        let build = Build::new(recording.header().skeleton(), Sex::Female, Fineness::Fine);
        let heights_m = |forward_rad: [f32; 2]| {
            let mut skirt = Template::default();
            skirt.add_skirt(&build);
            let points = Fineness::Fine.points(12) as usize;
            let hem = posed(skirt, &striding(&build, forward_rad)).positions_m[2 * points..3 * points].to_vec();
            let heights = hem.iter().map(|point_m| point_m.z / build.scale);
            [heights.clone().fold(f32::INFINITY, f32::min), heights.fold(0.0, f32::max)]
        };
        for forward_rad in [[0.0, 0.0], [0.35, -0.35], [0.5, -0.4], [-0.3, 0.52]] {
            let [low_m, high_m] = heights_m(forward_rad);
            assert!(low_m > 0.535 && high_m < low_m + 0.045, "{forward_rad:?}: {low_m} to {high_m}");
        }
    }

    /// Checks that a ray forward and one backward from each point of the legs above a height meets the cloth, in strides.
    fn check_legs_inside(sex: Sex, add_cloth: fn(&mut Template, &Build), add_leg: fn(&mut Template, &Build, Side)) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/walkers.fbrec");
        let recording = Recording::open(&path).unwrap();
        for fineness in Fineness::ALL {
            let build = Build::new(recording.header().skeleton(), sex, fineness);
            for forward_rad in [[0.35, -0.35], [0.5, -0.4], [-0.4, 0.5], [0.52, -0.3], [0.6, -0.5]] {
                let joints = striding(&build, forward_rad);
                let (mut cloth, mut legs) = (Template::default(), Template::default());
                add_cloth(&mut cloth, &build);
                Side::BOTH.into_iter().for_each(|side| add_leg(&mut legs, &build, side));
                let [cloth, legs] = [cloth, legs].map(|template| posed(template, &joints));
                let covers = |from_m: Vec3, direction: Vec3| {
                    (0..cloth.triangles.len()).any(|triangle| meets(cloth.corners_m(triangle), from_m, direction))
                };
                // Above the hem where a thigh lifts it.
                let above = legs.positions_m.iter().filter(|point_m| point_m.z > 0.72 * build.scale);
                let mut count = 0;
                for point_m in above {
                    count += 1;
                    // Not through an edge.
                    let beside_m = *point_m + Vec3::new(0.0, 1e-4, 2e-4);
                    let is_covered = [Vec3::X, -Vec3::X].map(|direction| covers(beside_m, direction));
                    assert_eq!(is_covered, [true; 2], "{fineness:?} {forward_rad:?} {point_m}");
                }
                assert!(count > 0, "{forward_rad:?}");
            }
        }
    }

    #[test]
    fn legs_stay_inside_a_skirt_in_strides() {
        check_legs_inside(Sex::Female, Template::add_skirt, Template::add_bare_leg);
    }

    #[test]
    fn trousers_stay_inside_a_coat_in_strides() {
        for sex in [Sex::Male, Sex::Female] {
            check_legs_inside(sex, Template::add_coat, Template::add_trouser_leg);
        }
    }

    #[test]
    fn cloth_is_straight_between_the_thighs() {
        let discs = [-0.1, 0.1].map(|aside| Disc { centre: Vec2::new(0.0, aside), radius: 0.08 });
        for angle_rad in [-0.6_f32, 0.0, 0.3, 0.8] {
            let outward = Vec2::from_angle(angle_rad);
            assert!((outline(&discs, outward) * outward.x - 0.08).abs() < 1e-6, "{angle_rad}");
        }
        assert!((outline(&discs, Vec2::Y) - 0.18).abs() < 1e-6);
        // One within the other: the larger one alone.
        let within = [discs[0], Disc { radius: 0.3, ..discs[0] }];
        assert!((outline(&within, Vec2::X) - (0.09_f32 - 0.01).sqrt()).abs() < 1e-6);
    }
}
