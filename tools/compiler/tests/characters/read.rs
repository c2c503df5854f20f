//! Files that are read: sizes, roles, meshes and notes.

use std::env;
use std::path::{Path, PathBuf};

use glam::Vec3;
use motiondb::body::Joint;
use motiondb::character::{from_bytes, to_bytes};
use motiondb_compiler::Outside;
use motiondb_compiler::character::{
    CharacterNote, CharacterRejection, CompiledCharacter, RolesFrom, compile_character,
};
use serde_json::{Value, json};

use crate::figure::{Figure, glb};
use crate::support::{bounds, check_rejected, compiled, joint_name, worn_at_rest};
use crate::vrm::vrm;

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
fn weights_that_are_not_finite_are_noted() {
    let (json, mut bytes) = Figure::adult().document();
    let plain = compiled(&glb(&json, &bytes)).character;
    let accessor = json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"].as_u64().unwrap() as usize;
    let view = json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
    let second = json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize + 4;
    bytes[second..second + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    let CompiledCharacter { character, notes, .. } = compiled(&glb(&json, &bytes));
    assert_eq!(notes, [CharacterNote::NotFiniteWeights(1)]);
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
fn bone_tables_of_vrm_must_fit_the_body() {
    let with = |swaps: &[(&str, &str)]| {
        let (mut json, bytes) = vrm(1, &[]);
        let bones = &mut json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"];
        for (one, other) in swaps {
            let (first, second) = (bones[one].clone(), bones[other].clone());
            (bones[one], bones[other]) = (second, first);
        }
        (json, bytes)
    };
    let limbs = ["Shoulder", "UpperLeg", "LowerLeg", "Foot", "Toes", "UpperArm", "LowerArm", "Hand"];
    let sides: Vec<_> = limbs.iter().map(|limb| (format!("left{limb}"), format!("right{limb}"))).collect();
    let sides: Vec<_> = sides.iter().map(|(left, right)| (&**left, &**right)).collect();
    let (json, bytes) = with(&sides);
    let CompiledCharacter { character, notes, .. } = compiled(&glb(&json, &bytes));
    assert_eq!(joint_name(&character, Joint::LeftToe), "J_16");
    assert!(notes.contains(&CharacterNote::MirroredNames));
    let arms_as_legs = [
        ("leftUpperLeg", "leftUpperArm"),
        ("leftLowerLeg", "leftLowerArm"),
        ("leftFoot", "leftHand"),
        ("rightUpperLeg", "rightUpperArm"),
        ("rightLowerLeg", "rightLowerArm"),
        ("rightFoot", "rightHand"),
    ];
    let (json, bytes) = with(&arms_as_legs);
    check_rejected(&json, &bytes, "off the legs' direction");
    let (json, bytes) = with(&[("leftUpperLeg", "leftLowerLeg")]);
    check_rejected(&json, &bytes, "does not hang from");
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
fn a_character_file_holds_what_was_compiled() {
    let character = compiled(&Figure::adult().glb()).character;
    let bytes = to_bytes(&character);
    let (read, checksum) = from_bytes(Path::new("figure.fbchar"), &bytes).unwrap();
    assert_eq!(read, character);
    assert_eq!(from_bytes(Path::new("other.fbchar"), &bytes).unwrap().1, checksum);
    assert_eq!(to_bytes(&compiled(&Figure::adult().glb()).character), bytes);
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
        let CompiledCharacter { character, .. } = compile_character(&characters().join(file), Outside::Refused, &[])
            .unwrap_or_else(|error| panic!("{error}"));
        let roles = [Joint::Pelvis, Joint::LeftToe, Joint::LeftFoot].map(|role| joint_name(&character, role));
        assert_eq!(roles, [pelvis, toe, foot], "{file}");
        let [low, high] = bounds(&worn_at_rest(&character));
        // The rogue's weapons hang from its hands.
        assert!(file.starts_with("kaykit") || low.z.abs() < 0.01, "{file}: {low}");
        assert!(high.z > 1.4, "{file}: {high}");
    }
}

/// The adult with four boxes: two on a socket of the right hand, one on one of the left, one on the head.
fn with_things() -> (Value, Vec<u8>) {
    let (mut json, bytes) = Figure::adult().document();
    let mut thing = json["meshes"][0]["primitives"][0].clone();
    thing["attributes"] = json!({ "POSITION": thing["attributes"]["POSITION"] });
    json["meshes"].as_array_mut().unwrap().push(json!({ "name": "Cube.004", "primitives": [thing] }));
    let place = |nodes: &Vec<Value>, name: &str| nodes.iter().position(|node| node["name"] == name).unwrap();
    let nodes = json["nodes"].as_array_mut().unwrap();
    for (joint, names) in [("RightHand", &["Sword", "Bow"][..]), ("LeftHand", &["Shield"]), ("Head", &["Hat"])] {
        let first = nodes.len();
        let things = names.iter().map(|name| json!({ "name": name, "mesh": 1, "scale": [0.01, 0.01, 0.01] }));
        nodes.extend(things);
        let last = nodes.len();
        nodes.push(json!({ "name": format!("{joint}Slot"), "children": (first..last).collect::<Vec<_>>() }));
        let hand = place(nodes, joint);
        nodes[hand]["children"] = json!([last]);
    }
    (json, bytes)
}

#[test]
fn a_hand_holds_one_thing() {
    let (json, bytes) = with_things();
    let bytes = glb(&json, &bytes);
    let meshes = |hide: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("figure.glb");
        std::fs::write(&path, &bytes).unwrap();
        let hide: Vec<String> = hide.iter().map(|name| (*name).to_owned()).collect();
        let compiled = compile_character(&path, Outside::Refused, &hide)?;
        let mut meshes: Vec<String> =
            compiled.character.mesh.materials.iter().map(|material| material.mesh.clone()).collect();
        meshes.sort();
        Ok::<_, CharacterRejection>((meshes, compiled.notes))
    };
    let (worn, notes) = meshes(&[]).unwrap();
    assert_eq!(worn, ["Hat", "Mesh", "Shield", "Sword"]);
    assert_eq!(notes, [CharacterNote::SpareMeshes(vec!["Bow".into()])]);
    let (worn, notes) = meshes(&["Sword", "Hat"]).unwrap();
    assert_eq!((worn, notes), (["Bow", "Mesh", "Shield"].map(str::to_owned).to_vec(), Vec::new()));
    // All nodes that draw a mesh of this name.
    assert_eq!(meshes(&["Cube.004"]).unwrap().0, ["Mesh"]);
    let unknown = meshes(&["Axe"]).unwrap_err().to_string();
    assert!(unknown.contains("no mesh `Axe` to hide; its meshes are") && unknown.contains("Shield"), "{unknown}");
}
