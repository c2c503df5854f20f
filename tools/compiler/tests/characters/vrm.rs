//! Figures with the bone tables of VRM.

use serde_json::{Value, json};

use crate::figure::Figure;

/// VRM's names of the adult's bones.
pub(crate) const VRM_BONES: [(&str, usize); 21] = [
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

/// The adult with a bone table of VRM 0 or 1 without some bones, and names that mean nothing.
pub(crate) fn vrm(version: usize, left_out: &[&str]) -> (Value, Vec<u8>) {
    let bones = VRM_BONES.into_iter().filter(|(bone, _)| !left_out.contains(bone));
    let bones: Vec<(String, usize)> = bones.map(|(bone, node)| (bone.to_owned(), node)).collect();
    figure_with_table(&Figure::adult(), version, &bones)
}

/// A figure with a bone table of VRM 0 or 1, and names that mean nothing.
pub(crate) fn figure_with_table(figure: &Figure, version: usize, bones: &[(String, usize)]) -> (Value, Vec<u8>) {
    let (mut json, bytes) = figure.document();
    for (index, node) in json["nodes"].as_array_mut().unwrap().iter_mut().enumerate() {
        node["name"] = json!(format!("J_{index}"));
    }
    json["extensions"] = match version {
        0 => {
            let bones: Vec<Value> = bones.iter().map(|(bone, node)| json!({ "bone": bone, "node": node })).collect();
            json!({ "VRM": { "humanoid": { "humanBones": bones } } })
        }
        _ => {
            let bones = bones.iter().map(|(bone, node)| (bone.clone(), json!({ "node": node })));
            json!({ "VRMC_vrm": { "humanoid": { "humanBones": Value::Object(bones.collect()) } } })
        }
    };
    (json, bytes)
}
