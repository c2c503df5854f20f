//! Figures on the poses of a skeleton.

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Joint, Pose, RootFrame};
use motiondb::character::CharacterFit;

use crate::figure::Figure;
use crate::support::{bounds, compiled, joint_name, rest, skeleton, worn, worn_at_rest};

#[test]
fn a_figure_stands_on_the_ground_with_arms_out() {
    let character = compiled(&Figure::adult().glb()).character;
    let positions_m = worn_at_rest(&character);
    let [low, high] = bounds(&positions_m);
    assert!(low.z.abs() < 2e-3, "{low}");
    assert!(high.y > 0.7 && low.y < -0.7, "{low} {high}");
    // It faces +x: its toes are ahead.
    assert!(high.x > 0.18 && low.x > -0.12, "{low} {high}");
}

/// The adult with its arms hanging half down.
fn a_pose() -> Figure {
    let mut figure = Figure::adult();
    for (joint, (along, down)) in [(7, (0.19, 0.19)), (8, (0.37, 0.37)), (11, (0.19, 0.19)), (12, (0.37, 0.37))] {
        let shoulder = figure.bones[if joint < 9 { 6 } else { 10 }].2;
        let sign = shoulder[0].signum();
        figure.bones[joint].2 = [shoulder[0] + sign * along, shoulder[1] - down, 0.0];
    }
    figure
}

#[test]
fn a_bind_pose_with_hanging_arms_vanishes() {
    let character = compiled(&a_pose().glb()).character;
    let skeleton = skeleton();
    let joints = rest(&skeleton).forward_kinematics(&skeleton);
    let mut transforms = Vec::new();
    let fit = CharacterFit::new(&character, &skeleton);
    fit.pose(&skeleton, &joints, RootFrame { position_m: Vec2::ZERO, forward: Vec2::X }, &mut transforms);
    let at_m = |role: Joint| {
        let joint = character.joint(role).unwrap();
        transforms[joint].point_m(character.joints[joint].position_m)
    };
    let arm = (at_m(Joint::LeftHand) - at_m(Joint::LeftUpperArm)).normalize();
    assert!(arm.dot(Vec3::Y) > 0.9999, "{arm}");
}

#[test]
fn soles_stay_on_the_ground_in_a_stride() {
    for figure in [Figure::adult(), Figure::adult().without("Toe"), Figure { size: 0.6, ..Figure::adult() }] {
        let character = compiled(&figure.glb()).character;
        let skeleton = skeleton();
        for hip_deg in [0.0_f32, 10.0, 20.0, 25.0] {
            // One leg ahead and one behind, both straight; the soles as low as they come.
            let mut pose = rest(&skeleton);
            pose.rotations[Joint::LeftThigh.index()] = Quat::from_rotation_y(-hip_deg.to_radians());
            pose.rotations[Joint::RightThigh.index()] = Quat::from_rotation_y(hip_deg.to_radians());
            let sole = |pose: &Pose| {
                let joints = pose.forward_kinematics(&skeleton);
                let points = (0..2).flat_map(|side| joints.sole_points_m(&skeleton, side));
                points.map(|point_m| point_m.z).fold(f32::INFINITY, f32::min)
            };
            pose.pelvis_m.z -= sole(&pose);
            let positions_m = worn(&character, &pose.forward_kinematics(&skeleton));
            let [low, _] = bounds(&positions_m);
            assert!(low.z.abs() < 0.01, "{} joints, {hip_deg}°: {low}", character.joints.len());
        }
    }
}

#[test]
fn a_child_is_worn_scaled() {
    let character = compiled(&Figure { size: 0.6, ..Figure::adult() }.glb()).character;
    let skeleton = skeleton();
    let fit = CharacterFit::new(&character, &skeleton);
    assert!(fit.is_scaled() && (fit.scale - 0.9 / 0.54).abs() < 1e-3, "{}", fit.scale);
    let adult = compiled(&Figure::adult().glb()).character;
    assert!(!CharacterFit::new(&adult, &skeleton).is_scaled());
}

#[test]
fn thighs_may_hang_from_a_root_beside_the_hips() {
    let mut figure = Figure::adult();
    let root = figure.bones.len();
    figure.bones.push(("Root", None, [0.0, 0.0, 0.0]));
    for joint in [0, 13, 17] {
        figure.bones[joint].1 = Some(root);
    }
    let character = compiled(&figure.glb()).character;
    assert_eq!(joint_name(&character, Joint::Pelvis), "Hips");
    let plain = compiled(&Figure::adult().glb()).character;
    assert!((character.hips_over_soles_m - plain.hips_over_soles_m).abs() < 1e-4);
    assert!(bounds(&worn_at_rest(&character))[1].distance(bounds(&worn_at_rest(&plain))[1]) < 1e-3);
}
