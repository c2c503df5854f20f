//! The parts of a document's JSON that the crate `gltf` does not read: required extensions and VRM's bone tables.
//!
//! VRM 0: `extensions.VRM.humanoid.humanBones[] {bone, node}`. VRM 1: `extensions.VRMC_vrm.humanoid.humanBones.NAME.node`.

use std::collections::BTreeMap;

use gltf::json;
use motiondb::body::Joint;
use serde::Deserialize;

use crate::character::reason::{CharacterNote, CharacterReason};

/// Extensions that compress meshes, and are not read.
const COMPRESSIONS: [&str; 3] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];
/// Required extensions that are read, or change nothing that is drawn.
const READ: [&str; 8] = [
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    "KHR_materials_specular",
    "KHR_materials_ior",
    "KHR_materials_emissive_strength",
    "VRM",
    "VRMC_vrm",
    "VRMC_materials_mtoon",
];

/// A bone table of VRM: the node of each bone, by VRM's names.
pub(crate) type BoneTable = BTreeMap<String, usize>;

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct ExtendedDocument {
    extensions_required: Vec<String>,
    extensions: RootExtensions,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct RootExtensions {
    #[serde(rename = "VRM")]
    vrm_0: Option<Vrm0>,
    #[serde(rename = "VRMC_vrm")]
    vrm_1: Option<Vrm1>,
}

#[derive(Deserialize)]
struct Vrm0 {
    humanoid: Vrm0Humanoid,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Vrm0Humanoid {
    human_bones: Vec<Vrm0Bone>,
}

#[derive(Deserialize)]
struct Vrm0Bone {
    bone: String,
    node: i64,
}

#[derive(Deserialize)]
struct Vrm1 {
    humanoid: Vrm1Humanoid,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Vrm1Humanoid {
    human_bones: BTreeMap<String, Vrm1Bone>,
}

#[derive(Deserialize)]
struct Vrm1Bone {
    node: usize,
}

/// VRM's name of each role's bone. `chest` and `upperChest` are the middle and the upper spine; without `upperChest`
/// the chest is the upper spine.
const BONES: [(&str, Joint); 22] = [
    ("hips", Joint::Pelvis),
    ("spine", Joint::SpineLower),
    ("chest", Joint::SpineMiddle),
    ("upperChest", Joint::SpineUpper),
    ("neck", Joint::Neck),
    ("head", Joint::Head),
    ("leftShoulder", Joint::LeftClavicle),
    ("leftUpperArm", Joint::LeftUpperArm),
    ("leftLowerArm", Joint::LeftForearm),
    ("leftHand", Joint::LeftHand),
    ("rightShoulder", Joint::RightClavicle),
    ("rightUpperArm", Joint::RightUpperArm),
    ("rightLowerArm", Joint::RightForearm),
    ("rightHand", Joint::RightHand),
    ("leftUpperLeg", Joint::LeftThigh),
    ("leftLowerLeg", Joint::LeftShank),
    ("leftFoot", Joint::LeftFoot),
    ("leftToes", Joint::LeftToe),
    ("rightUpperLeg", Joint::RightThigh),
    ("rightLowerLeg", Joint::RightShank),
    ("rightFoot", Joint::RightFoot),
    ("rightToes", Joint::RightToe),
];
/// Bones that VRM requires.
const REQUIRED: [&str; 15] = [
    "hips",
    "leftUpperLeg",
    "leftLowerLeg",
    "leftFoot",
    "rightUpperLeg",
    "rightLowerLeg",
    "rightFoot",
    "leftUpperArm",
    "leftLowerArm",
    "leftHand",
    "rightUpperArm",
    "rightLowerArm",
    "rightHand",
    "spine",
    "head",
];

/// The bone table of a VRM file; none of other files. Adds a note about extensions that are not read.
///
/// # Errors
/// [`CharacterReason::Compressed`], [`CharacterReason::WrongBone`].
pub(crate) fn bone_table(json: &[u8], notes: &mut Vec<CharacterNote>) -> Result<Option<BoneTable>, CharacterReason> {
    // Parsing the whole document finds all mistakes but those of a table.
    let document: ExtendedDocument = json::deserialize::from_slice(json).unwrap_or_else(|_| without_tables(json));
    let required = document.extensions_required;
    if let Some(extension) = required.iter().find(|extension| COMPRESSIONS.contains(&extension.as_str())) {
        return Err(CharacterReason::Compressed { extension: extension.clone() });
    }
    let unread: Vec<String> = required.into_iter().filter(|extension| !READ.contains(&extension.as_str())).collect();
    if !unread.is_empty() {
        notes.push(CharacterNote::UnreadExtensions(unread));
    }
    let RootExtensions { vrm_0, vrm_1 } = document.extensions;
    if let Some(vrm) = vrm_1 {
        return Ok(Some(vrm.humanoid.human_bones.into_iter().map(|(name, bone)| (name, bone.node)).collect()));
    }
    let Some(vrm) = vrm_0 else { return Ok(None) };
    // VRM 0 lists bones without a node as −1.
    let bones = vrm.humanoid.human_bones.into_iter();
    Ok(Some(bones.filter_map(|Vrm0Bone { bone, node }| Some((bone, usize::try_from(node).ok()?))).collect()))
}

/// The document where its tables cannot be parsed.
fn without_tables(json: &[u8]) -> ExtendedDocument {
    #[derive(Default, Deserialize)]
    #[serde(rename_all = "camelCase", default)]
    struct Required {
        extensions_required: Vec<String>,
    }
    let Required { extensions_required } = json::deserialize::from_slice(json).unwrap_or_default();
    ExtendedDocument { extensions_required, ..ExtendedDocument::default() }
}

/// The node of each role, by a bone table of a document of so many nodes.
///
/// # Errors
/// [`CharacterReason::MissingBone`], [`CharacterReason::WrongBone`].
pub(crate) fn nodes_of_roles(table: &BoneTable, node_count: usize) -> Result<Vec<(Joint, usize)>, CharacterReason> {
    if let Some(&bone) = REQUIRED.iter().find(|bone| !table.contains_key(**bone)) {
        return Err(CharacterReason::MissingBone { bone });
    }
    let mut nodes: Vec<(Joint, usize)> = Vec::new();
    for (bone, role) in BONES {
        let Some(&node) = table.get(bone) else { continue };
        let wrong = |problem| CharacterReason::WrongBone { bone: bone.to_owned(), node, problem };
        if node >= node_count {
            return Err(wrong("which does not exist"));
        }
        if nodes.iter().any(|(_, other)| *other == node) {
            return Err(wrong("which is another bone already"));
        }
        nodes.push((role, node));
    }
    if !table.contains_key("upperChest") {
        // The highest joint of the spine carries neck and arms.
        let highest =
            nodes.iter_mut().filter(|(role, _)| [Joint::SpineLower, Joint::SpineMiddle].contains(role)).last();
        if let Some((role, _)) = highest {
            *role = Joint::SpineUpper;
        }
    }
    Ok(nodes)
}
