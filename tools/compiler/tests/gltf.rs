//! glTF as other tools write it: each feature reads as the plain document does, or is rejected by name.

#[path = "gltf/document.rs"]
mod document;

use std::fs;
use std::path::{Path, PathBuf};

use document::{BODY, Document, FRAMES, check_walks, human, root, rotation};
use motiondb::diagnostic::{Diagnostic, Note, Warning};
use motiondb_compiler::{RejectionReason, import_bytes, import_file};
use serde_json::json;

/// Short and normalised quaternions of one joint.
fn shorts(joint: usize) -> Vec<u8> {
    let short = |value: f32| ((value * 32_767.0).round() as i16).to_le_bytes();
    (0..FRAMES).flat_map(|frame| rotation(joint, frame)).flat_map(short).collect()
}

/// Index of the accessor that holds the values of a channel of the first animation.
fn output(document: &Document, channel: usize) -> usize {
    document.json["animations"][0]["samplers"][channel]["output"].as_u64().unwrap() as usize
}

fn names(document: &Document) -> Vec<String> {
    document.imports().into_iter().map(|import| import.clip).collect()
}

#[test]
fn text_and_binary_read_alike() {
    let walker = Document::walker();
    let plain = walker.only();
    check_walks(&plain);
    let binary = import_bytes(Path::new("walk.glb"), &walker.glb()).unwrap().remove(0);
    assert_eq!(human(binary).frames, plain.frames);
}

#[test]
fn integer_quaternions_are_fractions() {
    let mut walker = Document::walker();
    for joint in 0..BODY.len() {
        let view = walker.view(&shorts(joint));
        let accessor = output(&walker, joint);
        walker.json["accessors"][accessor]["bufferView"] = json!(view);
        walker.json["accessors"][accessor]["componentType"] = json!(5122);
        walker.json["accessors"][accessor]["normalized"] = json!(true);
    }
    check_walks(&walker.only());
}

#[test]
fn sparse_accessors_replace_elements_and_zeros() {
    let plain = Document::walker().only();
    for has_base in [true, false] {
        let mut walker = Document::walker();
        let (knee, every) = (2, 0..FRAMES);
        let indices: Vec<u8> = every.clone().flat_map(|frame| (frame as u16).to_le_bytes()).collect();
        let turns: Vec<u8> = every.flat_map(|frame| rotation(knee, frame)).flat_map(f32::to_le_bytes).collect();
        let (indices, values) = (walker.view(&indices), walker.view(&turns));
        let accessor = output(&walker, knee);
        let base = output(&walker, knee + 1);
        let base = walker.json["accessors"][base]["bufferView"].clone();
        let object = walker.json["accessors"][accessor].as_object_mut().unwrap();
        object.remove("bufferView");
        if has_base {
            object.insert("bufferView".into(), base);
        }
        let indices = json!({ "bufferView": indices, "componentType": 5123 });
        object.insert(
            "sparse".into(),
            json!({ "count": FRAMES, "indices": indices, "values": { "bufferView": values } }),
        );
        assert_eq!(walker.only().frames, plain.frames, "{has_base}");
    }
}

#[test]
fn transforms_above_the_skeleton_count() {
    // Blender's armature: Z up, centimetres.
    let mut scaled = Document::walker();
    scaled.json["nodes"][0]["rotation"] = json!([0, 0, 0, 1]);
    scaled.put_below(json!({ "name": "Armature", "matrix": [0.5,0,0,0, 0,0.5,0,0, 0,0,0.5,0, 3,0,7,1] }), 0);
    let half = scaled.only();
    assert!((half.source.speed_mps - 0.6).abs() < 0.01, "{:?}", half.source);

    // The path is animated above the skeleton, which stays in place.
    let mut carried = Document::walker();
    let armature = carried.put_below(json!({ "name": "Armature" }), 0);
    let positions: Vec<f32> = (0..FRAMES).flat_map(|frame| [0.0, 0.0, root(frame)[2]]).collect();
    let output = carried.floats("VEC3", &positions);
    let last = carried.json["animations"][0]["channels"].as_array().unwrap().len() - 1;
    carried.json["animations"][0]["samplers"][last]["output"] = json!(output);
    carried.json["animations"][0]["channels"][last]["target"]["node"] = json!(armature);
    check_walks(&carried.only());

    // The whole body is stretched.
    let mut stretched = Document::walker();
    stretched.put_below(json!({ "name": "Armature", "scale": [1.0, 1.1, 1.0] }), 0);
    check_walks(&stretched.only());
}

#[test]
fn an_implausible_unit_is_found_instead() {
    for (units_per_m, metres_per_unit) in [(100.0, 0.01), (1000.0, 0.001), (39.370_08, 0.0254)] {
        let mut scaled = Document::walker();
        scaled.put_below(json!({ "name": "Armature", "scale": [units_per_m, units_per_m, units_per_m] }), 0);
        let record = scaled.only().source;
        assert!((record.speed_mps - 1.2).abs() < 0.02 && record.metres_per_unit == metres_per_unit, "{record:?}");
        let is_rejected = |found: &Diagnostic| matches!(found, Diagnostic::Warning(Warning::UnitRejected { .. }));
        assert!(record.diagnostics.iter().any(is_rejected), "{record:?}");
    }
    // A toy and a giant keep their size.
    for size in [0.2, 3.0] {
        let mut scaled = Document::walker();
        scaled.put_below(json!({ "name": "Armature", "scale": [size, size, size] }), 0);
        assert_eq!(scaled.only().source.metres_per_unit, 1.0);
    }
}

#[test]
fn a_mirrored_body_walks_forward() {
    let mut mirrored = Document::walker();
    mirrored.put_below(json!({ "name": "Armature", "scale": [-1, 1, 1] }), 0);
    check_walks(&mirrored.only());
}

#[test]
fn late_keys_single_keys_and_steps_are_keys() {
    let mut late = Document::walker();
    let times: Vec<f32> = (0..FRAMES).map(|frame| 5.0 + frame as f32 / 30.0).collect();
    let input = late.floats("SCALAR", &times);
    for sampler in late.json["animations"][0]["samplers"].as_array_mut().unwrap() {
        sampler["input"] = json!(input);
    }
    check_walks(&late.only());

    let mut single = Document::walker();
    let (input, output) = (single.floats("SCALAR", &[0.5]), single.floats("VEC4", &[0.0, 0.0, 0.0, 1.0]));
    let chest = &mut single.json["animations"][0]["samplers"][10];
    *chest = json!({ "input": input, "output": output, "interpolation": "STEP" });
    check_walks(&single.only());
}

#[test]
fn equal_key_times_are_read_and_unordered_ones_rejected() {
    let with_times = |last_s: f32| {
        let mut walker = Document::walker();
        let mut times: Vec<f32> = (0..FRAMES).map(|frame| frame as f32 / 30.0).collect();
        times[FRAMES - 1] = last_s;
        let input = walker.floats("SCALAR", &times);
        walker.json["animations"][0]["samplers"][2]["input"] = json!(input);
        walker
    };
    check_walks(&with_times((FRAMES - 2) as f32 / 30.0).only());
    let error = import_bytes(Path::new("walk.glb"), &with_times(0.0).glb()).unwrap_err().to_string();
    assert!(error.contains("in order"), "{error}");
}

#[test]
fn cameras_and_props_do_not_affect_clips() {
    let mut document = Document::walker();
    document.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1 } }));
    let camera = document.push("nodes", json!({ "name": "Camera", "camera": 0 }));
    let (input, output) = (document.floats("SCALAR", &[0.0, 60.0]), document.floats("VEC3", &[0.0; 6]));
    document.channel(0, camera, "translation", input, output);
    check_walks(&document.only());
}

#[test]
fn each_body_of_a_file_is_a_clip() {
    for have_skins in [false, true] {
        for share_a_root in [false, true] {
            // Only skins separate bodies in one tree.
            if share_a_root && !have_skins {
                continue;
            }
            let mut two = Document::empty();
            let bodies = ["", "_B"].map(|suffix| two.add_body(suffix));
            if have_skins {
                bodies.iter().for_each(|&first| two.add_skin(first));
            }
            if share_a_root {
                two.push("nodes", json!({ "name": "Scene", "children": bodies }));
            }
            two.add_walk("first", &bodies[..1]);
            two.add_walk("second", &bodies[1..]);
            two.add_walk("both", &bodies);
            assert_eq!(names(&two), ["first", "second", "both Hips", "both Hips_B"], "{have_skins} {share_a_root}");
            two.imports().into_iter().for_each(|import| check_walks(&human(import)));
        }
    }
}

#[test]
fn several_skins_of_one_skeleton_are_one_body() {
    let mut document = Document::walker();
    document.add_skin(0);
    document.push("skins", json!({ "joints": [17, 18] }));
    document.push("skins", json!({ "joints": (0..BODY.len()).collect::<Vec<_>>() }));
    check_walks(&document.only());
}

#[test]
fn animations_get_unique_names() {
    let mut document = Document::walker();
    document.add_walk("walk", &[0]);
    document.add_walk("walk_2", &[0]);
    let unnamed = document.add_walk("", &[0]);
    document.json["animations"][unnamed].as_object_mut().unwrap().remove("name");
    assert_eq!(names(&document), ["walk", "walk_3", "walk_2", "animation 3"]);
    let clips: Vec<String> = document.imports().into_iter().map(|import| human(import).name).collect();
    assert_eq!(clips, ["walk walk", "walk walk_3", "walk walk_2", "walk animation 3"]);
}

#[test]
fn equal_and_missing_joint_names_do_not_matter() {
    let (mut nameless, mut alike) = (Document::walker(), Document::walker());
    for joint in 0..BODY.len() {
        nameless.json["nodes"][joint].as_object_mut().unwrap().remove("name");
        alike.json["nodes"][joint]["name"] = json!("joint");
    }
    check_walks(&nameless.only());
    check_walks(&alike.only());
}

#[test]
fn an_animation_without_joints_hides_no_walk() {
    let mut document = Document::walker();
    let (input, output) = (document.floats("SCALAR", &[0.0, 1.0]), document.floats("SCALAR", &[0.0, 1.0]));
    let smile = document.push("animations", json!({ "name": "smile", "channels": [], "samplers": [] }));
    document.channel(smile, 18, "weights", input, output);
    let mut imports = document.imports();
    assert_eq!(imports[1].outcome.clone().unwrap_err(), RejectionReason::Motionless);
    assert_eq!(imports[1].clip, "smile");
    check_walks(&human(imports.remove(0)));
}

#[test]
fn animation_pointers_are_skipped_with_a_note() {
    let mut document = Document::walker();
    document.json["extensionsUsed"] = json!(["KHR_animation_pointer"]);
    let pointer = json!({ "pointer": "/materials/0/alphaCutoff" });
    document.json["animations"][0]["channels"].as_array_mut().unwrap().push(json!({
        "sampler": 0, "target": { "path": "pointer", "extensions": { "KHR_animation_pointer": pointer } },
    }));
    let clip = document.only();
    check_walks(&clip);
    assert_eq!(clip.source.diagnostics, [Diagnostic::Note(Note::PointersNotRead)]);
}

#[test]
fn an_animation_of_pointers_alone_is_rejected_with_its_reason() {
    let mut document = Document::walker();
    for channel in document.json["animations"][0]["channels"].as_array_mut().unwrap() {
        let pointer = json!({ "pointer": format!("/nodes/{}/rotation", channel["target"]["node"]) });
        channel["target"] = json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": pointer } });
    }
    assert_eq!(document.imports().remove(0).outcome.unwrap_err(), RejectionReason::PointersOnly);
}

#[test]
fn a_scene_may_have_no_nodes() {
    let mut document = Document::walker();
    document.push("scenes", json!({ "name": "empty" }));
    document.push("scenes", json!({}));
    check_walks(&document.only());
}

#[test]
fn a_repeated_key_is_rejected() {
    let text = Document::walker().gltf();
    let twice = String::from_utf8(text).unwrap().replacen('{', r#"{"asset": {"version": "2.0"}, "#, 1);
    let error = import_bytes(Path::new("walk.gltf"), twice.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("duplicate field `asset`"), "{error}");
}

#[test]
fn only_gltf_2_is_read() {
    let with = |version: &str, least: Option<&str>| {
        let mut document = Document::walker();
        document.json["asset"] = json!({ "version": version, "minVersion": least });
        document
    };
    for (version, least) in [("2.0", None), ("2.0", Some("2.0")), ("2.1", None), ("2.1", Some("2.0"))] {
        check_walks(&with(version, least).only());
    }
    for (version, least) in [("1.0", None), ("3.0", None), ("2.1", Some("2.1"))] {
        let message = import_bytes(Path::new("walk.gltf"), &with(version, least).gltf()).unwrap_err().to_string();
        let needed = format!("walk.gltf: asset: it needs a reader of glTF {}; ", least.unwrap_or(version));
        assert!(message.starts_with(&needed), "{message}");
    }
}

#[test]
fn compressed_meshes_are_read_and_compressed_animations_rejected() {
    let mut meshes = Document::walker();
    meshes.json["extensionsRequired"] =
        json!(["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_mesh_quantization"]);
    meshes.push("accessors", json!({ "componentType": 5126, "count": 3, "type": "VEC3" }));
    let position = meshes.json["accessors"].as_array().unwrap().len() - 1;
    meshes.push("meshes", json!({ "primitives": [{ "attributes": { "POSITION": position } }] }));
    meshes.push(
        "buffers",
        json!({ "byteLength": 36, "extensions": { "EXT_meshopt_compression": { "fallback": true } } }),
    );
    check_walks(&meshes.only());

    let mut packed = meshes;
    for view in packed.json["bufferViews"].as_array_mut().unwrap() {
        view["buffer"] = json!(1);
    }
    packed.json["buffers"][1]["byteLength"] = json!(packed.bytes.len());
    let message = import_bytes(Path::new("walk.gltf"), &packed.gltf()).unwrap_err().to_string();
    assert!(message.contains("walk.gltf: buffer 1") && message.contains("compressed"), "{message}");
}

#[test]
fn vrm_avatars_are_bodies() {
    for extension in ["VRM", "VRMC_vrm"] {
        let mut avatar = Document::walker();
        avatar.json["extensionsUsed"] = json!([extension]);
        avatar.json["extensions"] = json!({ extension: { "specVersion": "1.0", "humanoid": { "humanBones": {} } } });
        let bones = [
            "Hips",
            "L_UpperLeg",
            "L_LowerLeg",
            "L_Foot",
            "L_ToeBase",
            "R_UpperLeg",
            "R_LowerLeg",
            "R_Foot",
            "R_ToeBase",
            "Spine",
            "Chest",
            "L_UpperArm",
            "L_LowerArm",
            "L_Hand",
            "R_UpperArm",
            "R_LowerArm",
            "R_Hand",
            "Neck",
            "Head",
        ];
        for (joint, bone) in bones.iter().enumerate() {
            avatar.json["nodes"][joint]["name"] =
                json!(format!("J_Bip_{}{bone}", if bone.contains('_') { "" } else { "C_" }));
        }
        check_walks(&avatar.only());
    }
}

#[test]
fn a_malformed_animation_hides_no_other() {
    let mut document = Document::walker();
    let second = document.add_walk("broken", &[0]);
    document.json["animations"][second]["samplers"][3]["output"] = json!(100_000);
    let long = document.add_walk("endless", &[0]);
    let (input, output) = (document.floats("SCALAR", &[0.0, 1e9]), document.floats("VEC4", &[0.0; 8]));
    document.channel(long, 3, "rotation", input, output);
    let mut imports = document.imports();
    for (import, word) in imports[1..].iter().zip(["accessor 100000", "longer than"]) {
        let reason = import.outcome.clone().unwrap_err();
        assert!(
            matches!(reason, RejectionReason::Malformed { .. }) && reason.to_string().contains(word),
            "{}: {reason}",
            import.clip
        );
    }
    check_walks(&human(imports.remove(0)));
}

/// An empty folder for one test.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn buffers_beside_the_document_are_read() {
    let folder = folder("gltf_buffers");
    let walker = Document::walker();
    fs::create_dir(folder.join("data")).unwrap();
    fs::write(folder.join("data/my walk.bin"), &walker.bytes).unwrap();
    let file = folder.join("walk.gltf");
    fs::write(&file, walker.gltf_with("data/my%20walk.bin")).unwrap();
    check_walks(&human(import_file(&file).unwrap().remove(0)));
    fs::write(&file, walker.gltf_with("data/your%20walk.bin")).unwrap();
    let message = import_file(&file).unwrap_err().to_string();
    assert!(message.contains("walk.gltf: buffer 0") && message.contains("data/your walk.bin"), "{message}");
}

#[test]
fn buffers_outside_the_documents_folder_are_not_read() {
    let folder = folder("gltf_escape");
    let walker = Document::walker();
    fs::write(folder.join("walk.bin"), &walker.bytes).unwrap();
    let inside = folder.join("inside");
    fs::create_dir(&inside).unwrap();
    let absolute = folder.join("walk.bin").display().to_string();
    let outside = ["../walk.bin", "a/../../walk.bin", "%2e%2e/walk.bin", &absolute].map(|uri| (uri, "outside"));
    let no_paths = ["..\\walk.bin", "file:../walk.bin"].map(|uri| (uri, "no path"));
    for (uri, reason) in outside.into_iter().chain(no_paths) {
        fs::write(inside.join("walk.gltf"), walker.gltf_with(uri)).unwrap();
        let message = import_file(&inside.join("walk.gltf")).unwrap_err().to_string();
        assert!(message.contains(reason), "{uri}: {message}");
    }
}

#[test]
fn a_thousand_animations_are_a_thousand_clips_in_order() {
    let mut document = Document::walker();
    let walk = document.json["animations"][0].clone();
    for number in 1..1_000 {
        let mut another = walk.clone();
        another["name"] = json!(format!("walk {number}"));
        document.push("animations", another);
    }
    let imports = document.imports();
    assert_eq!((imports.len(), imports[999].clip.as_str()), (1_000, "walk 999"));
    imports.into_iter().for_each(|import| check_walks(&human(import)));
}
