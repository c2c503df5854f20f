//! Files that are refused: each rejection names the fault and a remedy, and nothing panics.

use std::path::Path;

use glam::{Quat, Vec2};
use motiondb::body::{Joint, RootFrame};
use motiondb::character::{Character, CharacterFit, from_bytes, to_bytes};
use motiondb_compiler::character::{CharacterReason, compile_character_bytes};
use proptest::prelude::*;
use serde_json::json;

use crate::figure::Figure;
use crate::support::{check_rejected, compiled, joint_name, reason, rest, skeleton};

#[test]
fn compressed_meshes_are_rejected_by_name() {
    for extension in ["KHR_draco_mesh_compression", "EXT_meshopt_compression"] {
        let (mut json, bytes) = Figure::adult().document();
        json["extensionsRequired"] = json!([extension]);
        check_rejected(&json, &bytes, &format!("compressed with {extension}"));
    }
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
    assert!(
        matches!(reason(&Figure::fox().glb()), CharacterReason::FourLegs { .. }),
        "{}",
        reason(&Figure::fox().glb())
    );
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

#[test]
fn weights_that_do_not_fall_are_rejected() {
    let mut character = compiled(&Figure::adult().glb()).character;
    character.mesh.weights[3] = [0.4, 0.0, 0.6, 0.0];
    let error = from_bytes(Path::new("figure.fbchar"), &to_bytes(&character)).unwrap_err().to_string();
    assert!(error.contains("weights of vertex 3") && error.contains("compile it again"), "{error}");
}

/// A container with a valid checksum around a payload.
fn sealed(payload: &[u8]) -> Vec<u8> {
    motiondb::files::container::seal(motiondb::character::MAGIC, motiondb::character::EXTRA_VERSION, payload)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn damaged_figures_never_panic(position in 0.0_f64..1.0, byte: u8, cut in 0.0_f64..1.5) {
        let mut bytes = Figure::adult().with_fingers().glb();
        let at = (position * bytes.len() as f64) as usize;
        bytes[at] = byte;
        bytes.truncate((cut * bytes.len() as f64) as usize);
        let _ = compile_character_bytes(Path::new("figure.glb"), &bytes);
    }

    #[test]
    fn damaged_character_files_are_errors_or_sound(position in 0.0_f64..1.0, byte: u8, cut in 0.0_f64..1.5) {
        let bytes = to_bytes(&compiled(&Figure::adult().with_fingers().glb()).character);
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
    let fit = CharacterFit::new(character, &skeleton);
    fit.pose(&skeleton, &joints, frame, &mut transforms);
    fit.pose_extra(|_| Some(Quat::IDENTITY), &mut transforms);
    character.mesh.skin(&transforms, &mut positions_m, &mut normals);
    positions_m.len()
}
