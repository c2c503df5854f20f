//! Characters: figures as other tools write them give a character, or are rejected by name.

#[path = "characters/figure.rs"]
mod figure;

use std::path::{Path, PathBuf};
use std::{env, fs};

use figure::{Bone, Figure, glb};
use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Foot, JOINT_COUNT, Joint, Joints, Pose, RootFrame, Skeleton};
use motiondb::character::{Character, CharacterFit, from_bytes, to_bytes};
use motiondb_compiler::Outside;
use motiondb_compiler::character::{
    CharacterNote, CharacterReason, CompiledCharacter, RolesFrom, compile_character, compile_character_bytes,
};
use proptest::prelude::*;
use serde_json::{Value, json};

#[track_caller]
fn compiled(bytes: &[u8]) -> CompiledCharacter {
    compile_character_bytes(Path::new("figure.glb"), bytes).unwrap_or_else(|rejection| panic!("{rejection}"))
}

fn reason(bytes: &[u8]) -> CharacterReason {
    compile_character_bytes(Path::new("figure.glb"), bytes).expect_err("it is no character").reason
}

#[track_caller]
fn check_rejected(json: &Value, bytes: &[u8], words: &str) {
    let text = reason(&glb(json, bytes)).to_string();
    assert!(text.contains(words), "{text}");
    assert!(text.contains("; "), "no remedy: {text}");
}

fn joint_name(character: &Character, role: Joint) -> &str {
    character.joint(role).map_or("", |joint| &character.joints[joint].name)
}

/// A skeleton with arms out along y, as a crowd's; hips 0.9 m over the soles.
fn skeleton() -> Skeleton {
    let mut offsets_m = [Vec3::ZERO; JOINT_COUNT];
    let mut set = |joint: Joint, offset: [f32; 3]| offsets_m[joint.index()] = Vec3::from(offset);
    set(Joint::Pelvis, [0.0, 0.0, 0.95]);
    for (joint, height_m) in [(Joint::SpineLower, 0.1), (Joint::SpineMiddle, 0.1), (Joint::SpineUpper, 0.12)] {
        set(joint, [0.0, 0.0, height_m]);
    }
    set(Joint::Neck, [0.0, 0.0, 0.22]);
    set(Joint::Head, [0.0, 0.0, 0.1]);
    for (side, sign) in [(0, 1.0), (1, -1.0)] {
        set([Joint::LeftClavicle, Joint::RightClavicle][side], [0.0, 0.05 * sign, 0.15]);
        set(Joint::UPPER_ARMS[side], [0.0, 0.13 * sign, 0.0]);
        set([Joint::LeftForearm, Joint::RightForearm][side], [0.0, 0.28 * sign, 0.0]);
        set([Joint::LeftHand, Joint::RightHand][side], [0.0, 0.25 * sign, 0.0]);
        set(Joint::THIGHS[side], [0.0, 0.1 * sign, -0.05]);
        set(Joint::SHANKS[side], [0.0, 0.0, -0.42]);
        set(Joint::FEET[side], [0.0, 0.0, -0.41]);
        set(Joint::TOES[side], [0.14, 0.0, -0.05]);
    }
    let points = [Vec3::new(-0.05, 0.0, -0.07), Vec3::new(0.14, 0.0, -0.07), Vec3::new(0.07, 0.0, -0.02)];
    let foot = Foot { heel_m: points[0], ball_m: points[1], toe_tip_m: points[2], measured_m: points };
    Skeleton {
        segment_ends_m: offsets_m,
        offsets_m,
        segment_radii_m: [0.05; JOINT_COUNT],
        limits_rad: [[Vec3::splat(-3.0), Vec3::splat(3.0)]; JOINT_COUNT],
        feet: [foot; 2],
    }
}

fn rest(skeleton: &Skeleton) -> Pose {
    Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] }
}

/// Positions of all vertices in a pose of the skeleton, facing x at the origin.
fn worn(character: &Character, joints: &Joints) -> Vec<Vec3> {
    let (skeleton, frame) = (skeleton(), RootFrame { position_m: Vec2::ZERO, forward: Vec2::X });
    let (mut transforms, mut positions_m, mut normals) = (Vec::new(), Vec::new(), Vec::new());
    CharacterFit::new(character, &skeleton).pose(&skeleton, joints, frame, &mut transforms);
    character.mesh.skin(&transforms, &mut positions_m, &mut normals);
    assert!(normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-3));
    positions_m
}

fn worn_at_rest(character: &Character) -> Vec<Vec3> {
    worn(character, &rest(&skeleton()).forward_kinematics(&skeleton()))
}

fn bounds(positions_m: &[Vec3]) -> [Vec3; 2] {
    let bound = |pick: fn(Vec3, Vec3) -> Vec3| positions_m.iter().copied().reduce(pick).unwrap();
    [bound(Vec3::min), bound(Vec3::max)]
}

#[test]
fn an_adult_has_all_roles_and_sizes() {
    let CompiledCharacter { character, roles_from, notes } = compiled(&Figure::adult().glb());
    assert_eq!((roles_from, notes), (RolesFrom::BindPose, Vec::new()));
    for (role, name) in [
        (Joint::Pelvis, "Hips"),
        (Joint::SpineUpper, "Chest"),
        (Joint::Head, "Head"),
        (Joint::LeftClavicle, "LeftShoulder"),
        (Joint::RightHand, "RightHand"),
        (Joint::LeftThigh, "LeftUpLeg"),
        (Joint::RightToe, "RightToe"),
    ] {
        assert_eq!(joint_name(&character, role), name);
    }
    assert!((character.hips_over_soles_m - 0.9).abs() < 1e-4, "{}", character.hips_over_soles_m);
    assert!((character.leg_length_m - 0.82).abs() < 1e-2);
    assert!((character.feet[0].ball_m - Vec3::new(0.13, 0.09, 0.0)).length() < 1e-4, "{:?}", character.feet);
    assert!(character.mesh.colours.iter().all(|colour| *colour == [0.8, 0.1, 0.1]));
    assert_eq!(character.mesh.triangles.len(), 21 * 12);
}

#[test]
fn scale_axes_and_weights_do_not_matter() {
    let plain = compiled(&Figure::adult().glb()).character;
    for (armature, is_z_up) in [(100.0, false), (0.01, false), (100.0, true), (1.0, true)] {
        let other = compiled(&Figure { armature, is_z_up, ..Figure::adult() }.glb()).character;
        for (a, b) in plain.mesh.positions_m.iter().zip(&other.mesh.positions_m) {
            assert!(a.distance(*b) < 1e-4, "armature {armature}, z up {is_z_up}: {a} {b}");
        }
        assert!((plain.height_m - other.height_m).abs() < 1e-4);
    }
    let CompiledCharacter { character, notes, .. } = compiled(&Figure { weight: 1.755, ..Figure::adult() }.glb());
    assert_eq!(notes, [CharacterNote::UnevenWeights(21 * 24)]);
    assert_eq!(character.mesh.weights, plain.mesh.weights);
}

#[test]
fn missing_normals_point_outwards() {
    let stated = compiled(&Figure::adult().glb()).character.mesh;
    let computed = compiled(&Figure { has_normals: false, ..Figure::adult() }.glb()).character.mesh;
    for triangle in &stated.triangles {
        let [a, b, c] = triangle.map(|vertex| stated.positions_m[vertex as usize]);
        assert!(stated.normals[triangle[0] as usize].dot((b - a).cross(c - a).normalize()) > 0.999);
    }
    // Smooth ones at the corners of boxes; some boxes share a corner.
    let alike = stated.normals.iter().zip(&computed.normals).filter(|(a, b)| a.dot(**b) > 0.2).count();
    assert!(alike * 10 > 8 * stated.normals.len(), "{alike} of {}", stated.normals.len());
}

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

/// VRM's names of the adult's bones.
const VRM_BONES: [(&str, usize); 21] = [
    ("hips", 0),
    ("spine", 1),
    ("chest", 2),
    ("neck", 3),
    ("head", 4),
    ("leftShoulder", 5),
    ("leftUpperArm", 6),
    ("leftLowerArm", 7),
    ("leftHand", 8),
    ("rightShoulder", 9),
    ("rightUpperArm", 10),
    ("rightLowerArm", 11),
    ("rightHand", 12),
    ("leftUpperLeg", 13),
    ("leftLowerLeg", 14),
    ("leftFoot", 15),
    ("leftToes", 16),
    ("rightUpperLeg", 17),
    ("rightLowerLeg", 18),
    ("rightFoot", 19),
    ("rightToes", 20),
];

/// The adult with names that mean nothing, and a bone table of VRM 0 or 1 without some bones.
fn vrm(version: usize, left_out: &[&str]) -> (Value, Vec<u8>) {
    let (mut json, bytes) = Figure::adult().document();
    for (index, node) in json["nodes"].as_array_mut().unwrap().iter_mut().enumerate() {
        node["name"] = json!(format!("J_{index}"));
    }
    let bones: Vec<_> = VRM_BONES.iter().filter(|(bone, _)| !left_out.contains(bone)).collect();
    json["extensions"] = match version {
        0 => {
            let bones: Vec<Value> = bones.iter().map(|(bone, node)| json!({ "bone": bone, "node": node })).collect();
            json!({ "VRM": { "humanoid": { "humanBones": bones } } })
        }
        _ => {
            let bones = bones.iter().map(|(bone, node)| ((*bone).to_owned(), json!({ "node": node })));
            json!({ "VRMC_vrm": { "humanoid": { "humanBones": Value::Object(bones.collect()) } } })
        }
    };
    (json, bytes)
}

#[test]
fn bone_tables_of_vrm_name_the_joints() {
    for version in [0, 1] {
        let (json, bytes) = vrm(version, &[]);
        let CompiledCharacter { character, roles_from, .. } = compiled(&glb(&json, &bytes));
        assert_eq!(roles_from, RolesFrom::Vrm);
        assert_eq!(joint_name(&character, Joint::SpineUpper), "J_2");
        assert_eq!(joint_name(&character, Joint::LeftToe), "J_16");
        assert_eq!(character.joint(Joint::SpineMiddle), None);
        let (json, bytes) = vrm(version, &["hips"]);
        check_rejected(&json, &bytes, "its VRM bone table lacks `hips`");
    }
    let (mut json, bytes) = vrm(1, &[]);
    json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]["hips"]["node"] = json!(4000);
    check_rejected(&json, &bytes, "node 4000 as `hips`, which does not exist");
    json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]["hips"]["node"] = json!(4);
    check_rejected(&json, &bytes, "which is another bone already");
}

#[test]
fn compressed_meshes_are_rejected_by_name() {
    for extension in ["KHR_draco_mesh_compression", "EXT_meshopt_compression"] {
        let (mut json, bytes) = Figure::adult().document();
        json["extensionsRequired"] = json!([extension]);
        check_rejected(&json, &bytes, &format!("compressed with {extension}"));
    }
}

/// A fox: trunk along z, four legs of the same length.
fn fox() -> Figure {
    let bones: [Bone; 19] = [
        ("Root", None, [0.0, 0.5, -0.4]),
        ("Spine1", Some(0), [0.0, 0.52, -0.2]),
        ("Spine2", Some(1), [0.0, 0.52, 0.1]),
        ("Spine3", Some(2), [0.0, 0.5, 0.4]),
        ("Neck", Some(3), [0.0, 0.6, 0.55]),
        ("Head", Some(4), [0.0, 0.7, 0.65]),
        ("FrontLegL1", Some(3), [0.1, 0.45, 0.4]),
        ("FrontLegL2", Some(6), [0.1, 0.22, 0.38]),
        ("FrontLegL3", Some(7), [0.1, 0.03, 0.4]),
        ("FrontLegR1", Some(3), [-0.1, 0.45, 0.4]),
        ("FrontLegR2", Some(9), [-0.1, 0.22, 0.38]),
        ("FrontLegR3", Some(10), [-0.1, 0.03, 0.4]),
        ("BackLegL1", Some(0), [0.1, 0.45, -0.4]),
        ("BackLegL2", Some(12), [0.1, 0.22, -0.42]),
        ("BackLegL3", Some(13), [0.1, 0.03, -0.4]),
        ("BackLegR1", Some(0), [-0.1, 0.45, -0.4]),
        ("BackLegR2", Some(15), [-0.1, 0.22, -0.42]),
        ("BackLegR3", Some(16), [-0.1, 0.03, -0.4]),
        ("Tail", Some(0), [0.0, 0.55, -0.7]),
    ];
    Figure::of(&bones)
}

/// The adult with short legs and ears longer than these.
fn hare() -> Figure {
    let mut figure = Figure::adult();
    for (joint, height) in [(13, 0.55), (17, 0.55), (14, 0.3), (18, 0.3)] {
        figure.bones[joint].2[1] = height;
    }
    figure.bones[0].2[1] = 0.6;
    figure.bones[1].2[1] = 0.8;
    for sign in [1.0, -1.0] {
        let names = if sign > 0.0 { ["Ear1.L", "Ear2.L", "Ear3.L"] } else { ["Ear1.R", "Ear2.R", "Ear3.R"] };
        for (index, name) in names.into_iter().enumerate() {
            let parent = if index == 0 { 4 } else { figure.bones.len() - 1 };
            let bend = if index == 1 { 0.02 } else { 0.0 };
            figure.bones.push((name, Some(parent), [sign * 0.09, 1.7 + 0.35 * index as f32, bend]));
        }
    }
    figure
}

#[test]
fn named_legs_beat_longer_ears() {
    let character = compiled(&hare().glb()).character;
    assert_eq!(joint_name(&character, Joint::LeftThigh), "LeftUpLeg");
    assert_eq!(joint_name(&character, Joint::RightFoot), "RightFoot");
}

#[test]
fn figures_that_cannot_walk_are_rejected_by_name() {
    assert!(matches!(reason(&fox().glb()), CharacterReason::FourLegs { .. }), "{}", reason(&fox().glb()));
    let legless = Figure::adult().without("UpLeg");
    let found = reason(&legless.glb());
    assert!(matches!(found, CharacterReason::NoArms { .. } | CharacterReason::NoLegs), "{found}");
    let ears_alone = hare().without("UpLeg");
    let found = reason(&ears_alone.glb());
    assert!(matches!(found, CharacterReason::NotLegs { .. } | CharacterReason::NoArms { .. }), "{found}");
}

#[test]
fn numbers_that_are_not_finite_are_rejected() {
    let (json, mut bytes) = Figure::adult().document();
    bytes[40..44].copy_from_slice(&f32::NAN.to_le_bytes());
    check_rejected(&json, &bytes, "positions of mesh `Body`: a number is not finite");
}

#[test]
fn a_small_file_of_billions_of_triangles_is_rejected() {
    let (mut json, bytes) = Figure::adult().document();
    let primitive = json["meshes"][0]["primitives"][0].clone();
    json["meshes"][0]["primitives"] = json!(vec![primitive; 9_000]);
    check_rejected(&json, &bytes, "vertices, more than 1000000");
    let (mut json, bytes) = Figure::adult().document();
    json["accessors"][4]["count"] = json!(9_000_000_000_u64);
    check_rejected(&json, &bytes, "3000000000 triangles, more than 2000000");
}

/// A PNG file of a checkerboard of two colours, 2 by 2 pixels.
fn checkerboard() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
    encoder.set_color(png::ColorType::Rgba);
    let pixels = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 0]];
    encoder.write_header().unwrap().write_image_data(pixels.as_flattened()).unwrap();
    bytes
}

/// The adult with a texture of this content; each vertex lies in the middle of the same pixel.
fn textured(content: &[u8], uv: [f32; 2]) -> (Value, Vec<u8>) {
    let (mut json, mut bytes) = Figure::adult().document();
    let push = |json: &mut Value, array: &str, value: Value| {
        let array = json[array].as_array_mut().unwrap();
        array.push(value);
        array.len() - 1
    };
    let count = json["accessors"][0]["count"].as_u64().unwrap() as usize;
    let view = json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": 8 * count });
    let view = push(&mut json, "bufferViews", view);
    (0..count).for_each(|_| bytes.extend(uv.iter().flat_map(|part| part.to_le_bytes())));
    let accessor = json!({ "bufferView": view, "componentType": 5126, "count": count, "type": "VEC2" });
    let accessor = push(&mut json, "accessors", accessor);
    json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(accessor);
    let view = json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": content.len() });
    let view = push(&mut json, "bufferViews", view);
    bytes.extend(content);
    json["images"] = json!([{ "bufferView": view, "mimeType": "image/png", "name": "skin" }]);
    json["textures"] = json!([{ "source": 0 }]);
    json["materials"][0] = json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } });
    json["buffers"][0]["byteLength"] = json!(bytes.len());
    (json, bytes)
}

#[test]
fn colours_come_from_textures() {
    let (json, bytes) = textured(&checkerboard(), [0.75, 0.25]);
    let character = compiled(&glb(&json, &bytes)).character;
    assert!(character.mesh.colours.iter().all(|colour| *colour == [0.0, 1.0, 0.0]), "{:?}", character.mesh.colours[0]);
    // A masked material leaves out what the alpha channel hides.
    let (mut json, bytes) = textured(&checkerboard(), [0.75, 0.75]);
    json["materials"][0]["alphaMode"] = json!("MASK");
    assert_eq!(reason(&glb(&json, &bytes)), CharacterReason::NoMesh);
}

#[test]
fn textures_of_other_formats_are_noted() {
    let (json, bytes) = textured(b"RIFF\0\0\0\0WEBPVP8 ", [0.5, 0.5]);
    let CompiledCharacter { character, notes, .. } = compiled(&glb(&json, &bytes));
    assert_eq!(notes, [CharacterNote::UnreadTextures(vec!["skin".into()])]);
    assert!(character.mesh.colours.iter().all(|colour| *colour == [1.0; 3]));
}

#[test]
fn texture_bombs_are_rejected_before_they_are_decoded() {
    let mut bomb = checkerboard();
    // Width and height of the header, and its checksum.
    bomb[16..24].copy_from_slice(&[0, 0, 0xff, 0xff, 0, 0, 0xff, 0xff]);
    let checksum = png_checksum(&bomb[12..29]);
    bomb[29..33].copy_from_slice(&checksum.to_be_bytes());
    let (json, bytes) = textured(&bomb, [0.5, 0.5]);
    check_rejected(&json, &bytes, "65535 × 65535 pixels, more than 8192 a side");
    let (json, bytes) = textured(&checkerboard()[..60], [0.5, 0.5]);
    check_rejected(&json, &bytes, "image 0");
    let (json, bytes) = textured(&[0xff, 0xd8, 0xff, 0xc0, 0, 17, 8], [0.5, 0.5]);
    check_rejected(&json, &bytes, "image 0");
}

/// CRC-32 of PNG, bit by bit.
fn png_checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg()))
    })
}

#[test]
fn nothing_outside_the_folder_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("inside");
    fs::create_dir(&inside).unwrap();
    fs::write(folder.path().join("secret.png"), checkerboard()).unwrap();
    let (mut json, bytes) = textured(&checkerboard(), [0.25, 0.25]);
    json["images"][0] = json!({ "uri": "../secret.png" });
    let path = inside.join("figure.glb");
    fs::write(&path, glb(&json, &bytes)).unwrap();
    let rejection = compile_character(&path, Outside::Refused).unwrap_err().to_string();
    assert!(rejection.contains("`../secret.png` lies outside the document's folder"), "{rejection}");
    let colours = compile_character(&path, Outside::Allowed).unwrap().character.mesh.colours;
    assert!(colours.iter().all(|colour| *colour == [1.0, 0.0, 0.0]));
}

#[test]
fn rigid_meshes_move_with_their_joint() {
    let (mut json, bytes) = Figure::adult().document();
    let primitive = json["meshes"][0]["primitives"][0].clone();
    let attributes = json!({ "POSITION": primitive["attributes"]["POSITION"] });
    let mut hat = primitive;
    hat["attributes"] = attributes;
    let meshes = json["meshes"].as_array_mut().unwrap();
    meshes.push(json!({ "name": "Hat", "primitives": [hat] }));
    let nodes = json["nodes"].as_array_mut().unwrap();
    nodes.push(json!({ "name": "Hat", "mesh": 1, "scale": [0.1, 0.1, 0.1] }));
    let hat = nodes.len() - 1;
    nodes[4]["children"] = json!([hat]);
    let character = compiled(&glb(&json, &bytes)).character;
    assert_eq!(character.mesh.triangles.len(), 2 * 21 * 12);
    let own = character.joints.iter().position(|joint| joint.name == "Hat").unwrap();
    assert_eq!(character.joints[own].parent, character.roles[Joint::Head.index()]);
    // A mesh that hangs from nothing is left out.
    let nodes = json["nodes"].as_array_mut().unwrap();
    nodes[4].as_object_mut().unwrap().remove("children");
    json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(hat));
    let CompiledCharacter { character, notes, .. } = compiled(&glb(&json, &bytes));
    assert_eq!(notes, [CharacterNote::LooseMeshes(vec!["Hat".into()])]);
    assert_eq!(character.mesh.triangles.len(), 21 * 12);
}

#[test]
fn morph_targets_are_passed_over() {
    let (mut json, bytes) = Figure::adult().document();
    json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": 0 }, { "POSITION": 0 }]);
    assert_eq!(compiled(&glb(&json, &bytes)).notes, [CharacterNote::MorphTargets(2)]);
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

#[test]
fn a_character_file_holds_what_was_compiled() {
    let character = compiled(&Figure::adult().glb()).character;
    let bytes = to_bytes(&character);
    let (read, checksum) = from_bytes(Path::new("figure.fbchar"), &bytes).unwrap();
    assert_eq!(read, character);
    assert_eq!(from_bytes(Path::new("other.fbchar"), &bytes).unwrap().1, checksum);
    assert_eq!(to_bytes(&compiled(&Figure::adult().glb()).character), bytes);
}

/// A container with a valid checksum around a payload.
fn sealed(payload: &[u8]) -> Vec<u8> {
    motiondb::files::container::seal(motiondb::character::MAGIC, motiondb::character::VERSION, payload)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn damaged_figures_never_panic(position in 0.0_f64..1.0, byte: u8, cut in 0.0_f64..1.5) {
        let mut bytes = Figure::adult().glb();
        let at = (position * bytes.len() as f64) as usize;
        bytes[at] = byte;
        bytes.truncate((cut * bytes.len() as f64) as usize);
        let _ = compile_character_bytes(Path::new("figure.glb"), &bytes);
    }

    #[test]
    fn damaged_character_files_are_errors_or_sound(position in 0.0_f64..1.0, byte: u8, cut in 0.0_f64..1.5) {
        let bytes = to_bytes(&compiled(&Figure::adult().glb()).character);
        let mut payload = bytes[24..].to_vec();
        let at = (position * payload.len() as f64) as usize;
        payload[at] = byte;
        payload.truncate((cut * payload.len() as f64) as usize);
        if let Ok((character, _)) = from_bytes(Path::new("figure.fbchar"), &sealed(&payload)) {
            prop_assert!(worn_at_rest_unchecked(&character) > 0);
        }
        let mut raw = bytes;
        let at = (position * raw.len() as f64) as usize;
        let is_changed = raw[at] != byte;
        raw[at] = byte;
        prop_assert_eq!(from_bytes(Path::new("figure.fbchar"), &raw).is_err(), is_changed);
    }
}

/// Poses and skins a character at rest; returns its number of vertices. No character may panic here.
fn worn_at_rest_unchecked(character: &Character) -> usize {
    let skeleton = skeleton();
    let (mut transforms, mut positions_m, mut normals) = (Vec::new(), Vec::new(), Vec::new());
    let joints = rest(&skeleton).forward_kinematics(&skeleton);
    let frame = RootFrame { position_m: Vec2::ZERO, forward: Vec2::X };
    CharacterFit::new(character, &skeleton).pose(&skeleton, &joints, frame, &mut transforms);
    character.mesh.skin(&transforms, &mut positions_m, &mut normals);
    positions_m.len()
}

/// The folder of other people's characters.
fn characters() -> PathBuf {
    let folder = env::var_os("FBCROWD_CHARACTERS").map(PathBuf::from);
    folder.expect("set FBCROWD_CHARACTERS to the folder of other people's characters, as an absolute path")
}

#[test]
#[ignore = "needs other people's characters: set FBCROWD_CHARACTERS"]
fn figures_of_other_makers_compile() {
    for (file, pelvis, toe, foot) in [
        ("CesiumMan.glb", "Skeleton_torso_joint_1", "leg_joint_L_5", "leg_joint_L_3"),
        ("RobotExpressive.glb", "Hips", "", "Foot.L"),
        ("kaykit_Rogue.glb", "hips", "toes.l", "foot.l"),
        ("mpfb_woman_mixamo.glb", "mixamorig:Hips", "mixamorig:LeftToeBase", "mixamorig:LeftFoot"),
        ("quaternius_Casual.glb", "Hips", "", "Foot.L"),
    ] {
        let CompiledCharacter { character, .. } =
            compile_character(&characters().join(file), Outside::Refused).unwrap_or_else(|error| panic!("{error}"));
        let roles = [Joint::Pelvis, Joint::LeftToe, Joint::LeftFoot].map(|role| joint_name(&character, role));
        assert_eq!(roles, [pelvis, toe, foot], "{file}");
        let [low, high] = bounds(&worn_at_rest(&character));
        // The rogue's weapons hang from its hands.
        assert!(file.starts_with("kaykit") || low.z.abs() < 0.01, "{file}: {low}");
        assert!(high.z > 1.4, "{file}: {high}");
    }
}
