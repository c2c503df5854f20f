//! Animals and things as other tools write them. Each is refused, and the error says what it is and what to do. Names of
//! joints do not matter.

use std::path::Path;

use motiondb::body::Joint;
use motiondb_compiler::character::{CharacterReason, compile_character_bytes};
use serde_json::json;

use crate::figure::{Bone, Figure};
use crate::support::{check_rejected, joint_name, reason};

/// A part of an animal's body, on a side (`L`, `R` or none), counted from the trunk.
struct Part {
    name: &'static str,
    side: Option<char>,
    index: usize,
}

/// How a rig names its joints; the number counts all joints.
type Naming = fn(&Part, usize) -> String;

/// A four-legged body of a height at its back, with so many joints a leg; more chains hang from it.
fn animal(naming: Naming, height_m: f32, leg_joints: usize, more: &[(&'static str, [[f32; 3]; 3])]) -> Figure {
    let mut bones: Vec<Bone> = Vec::new();
    let mut push = |part: Part, parent: Option<usize>, at: [f32; 3]| {
        let name: &'static str = naming(&part, bones.len()).leak();
        bones.push((name, parent, at.map(|share| height_m * share)));
        bones.len() - 1
    };
    let trunk = |name, index| Part { name, side: None, index };
    let hips = push(trunk("hips", 0), None, [0.0, 0.97, -0.45]);
    let spine = push(trunk("spine", 0), Some(hips), [0.0, 1.0, -0.2]);
    let chest = push(trunk("chest", 0), Some(spine), [0.0, 1.0, 0.35]);
    let neck = push(trunk("neck", 0), Some(chest), [0.0, 1.1, 0.55]);
    let head = push(trunk("head", 0), Some(neck), [0.0, 1.3, 0.7]);
    let mut tail = hips;
    for index in 0..3 {
        tail = push(trunk("tail", index), Some(tail), [0.0, 0.95 - 0.1 * index as f32, -0.6 - 0.15 * index as f32]);
    }
    for (name, parent, z) in [("front", chest, 0.35), ("hind", hips, -0.45)] {
        for (side, x) in [('L', 0.13), ('R', -0.13)] {
            let mut above = parent;
            for index in 0..leg_joints {
                let down = index as f32 / (leg_joints - 1) as f32;
                // Knees and hocks stand out by turns.
                let bend = if index % 2 == 1 { 0.06 } else { 0.0 };
                let at = [x, 0.85 * (1.0 - down) + 0.03, z + if name == "hind" { -bend } else { bend }];
                above = push(Part { name, side: Some(side), index }, Some(above), at);
            }
        }
    }
    for (name, points) in more {
        for (side, sign) in [('L', 1.0), ('R', -1.0)] {
            let mut above = if *name == "ear" { head } else { chest };
            for (index, [x, y, z]) in points.iter().enumerate() {
                above = push(Part { name, side: Some(side), index }, Some(above), [sign * x, *y, *z]);
            }
        }
    }
    Figure::of(&bones)
}

fn dotted(part: &Part) -> String {
    part.side.map_or(String::new(), |side| format!(".{side}"))
}

/// `front_leg.L`, `front_leg.L.001`.
fn blender(part: &Part, _: usize) -> String {
    let name = match part.name {
        "front" => "front_leg",
        "hind" => "hind_leg",
        name => name,
    };
    let number = if part.index > 0 { format!(".{:03}", part.index) } else { String::new() };
    format!("{name}{}{number}", dotted(part))
}

/// Rigify's wolf: forelegs are arms.
fn rigify(part: &Part, _: usize) -> String {
    let name = match (part.name, part.index) {
        ("front", index) => ["upper_arm", "forearm", "hand", "f_toe", "f_tip"][index],
        ("hind", index) => ["thigh", "shin", "foot", "toe", "tip"][index],
        (name, index) => return format!("{name}{}.{index:03}", dotted(part)),
    };
    format!("{name}{}", dotted(part))
}

/// A biped of 3ds Max on four legs.
fn biped(part: &Part, _: usize) -> String {
    let side = part.side.map_or(String::new(), |side| format!("{side} "));
    let name = match (part.name, part.index) {
        ("front", index) => ["UpperArm", "Forearm", "Hand", "Finger0", "Finger01"][index].to_owned(),
        ("hind", index) => ["Thigh", "Calf", "HorseLink", "Foot", "Toe0"][index].to_owned(),
        ("hips", _) => "Pelvis".to_owned(),
        (name, index) => format!("{name}{index}"),
    };
    format!("Bip01 {side}{name}")
}

fn unnamed(_: &Part, joint: usize) -> String {
    if joint == 0 { "Bone".to_owned() } else { format!("Bone.{joint:03}") }
}

/// `b_LeftFrontUpLeg`.
fn words(part: &Part, _: usize) -> String {
    let side = match part.side {
        Some('L') => "Left",
        Some(_) => "Right",
        None => "",
    };
    let name = match (part.name, part.index) {
        ("front", index) => format!("Front{}", ["UpLeg", "Leg", "Foot", "Toe", "ToeEnd"][index]),
        ("hind", index) => ["UpLeg", "Leg", "Foot", "ToeBase", "ToeEnd"][index].to_owned(),
        (name, index) => format!("{name}{index}"),
    };
    format!("b_{side}{name}")
}

const NAMINGS: [(&str, Naming); 5] =
    [("blender", blender), ("rigify", rigify), ("biped", biped), ("unnamed", unnamed), ("words", words)];

/// Ears that stand up, of a length.
fn ears(length: f32) -> (&'static str, [[f32; 3]; 3]) {
    ("ear", [[0.06, 1.4, 0.68], [0.08, 1.4 + 0.5 * length, 0.64], [0.08, 1.4 + length, 0.66]])
}

/// Wings that are spread.
const WINGS: (&str, [[f32; 3]; 3]) = ("wing", [[0.1, 1.1, 0.3], [0.7, 1.5, 0.1], [1.6, 1.3, -0.1]]);

/// What is wrong with the answer to a four-legged figure; none where it is refused: as one, or where it has `ears or wings`
/// without a name, because of these.
fn fault(figure: &Figure, has_more: bool) -> Option<String> {
    let found = match compile_character_bytes(Path::new("figure.glb"), &figure.glb()) {
        Ok(compiled) => {
            return Some(format!(
                "thighs {:?}",
                Joint::THIGHS.map(|leg| joint_name(&compiled.character, leg).to_owned())
            ));
        }
        Err(rejection) => rejection.reason,
    };
    let is_named = matches!(found, CharacterReason::FourLegs { .. } | CharacterReason::ManyLegs { .. });
    let is_refused = is_named || (has_more && found.to_string().contains("; "));
    (!is_refused).then(|| found.to_string())
}

#[test]
fn four_legged_animals_are_refused_whatever_their_joints_are_called() {
    let mut faults = Vec::new();
    for (rig, naming) in NAMINGS {
        for joints in 3..=5 {
            let animals = [
                ("horse", animal(naming, 1.5, joints, &[])),
                ("dog", animal(naming, 0.5, joints, &[ears(0.1)])),
                ("fox", animal(naming, 0.35, joints, &[ears(0.3)])),
                ("rabbit", animal(naming, 0.25, joints, &[ears(0.9)])),
                ("dragon", animal(naming, 3.0, joints, &[WINGS])),
            ];
            let found = animals
                .iter()
                .filter_map(|(name, figure)| Some((name, fault(figure, ["rabbit", "dragon"].contains(name))?)));
            faults.extend(found.map(|(name, fault)| format!("{name}, {rig}, {joints} joints a leg: {fault}")));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn a_hand_is_no_human_figure() {
    let mut bones: Vec<Bone> = vec![("Wrist", None, [0.0, 0.0, 0.0])];
    for finger in 0..5 {
        for joint in 0..4 {
            let parent = if joint == 0 { 0 } else { bones.len() - 1 };
            let name: &'static str = format!("Finger{finger}_{joint}").leak();
            bones.push((
                name,
                Some(parent),
                [0.02 * finger as f32 - 0.04, 0.05 + 0.03 * joint as f32, 0.001 * joint as f32],
            ));
        }
    }
    let found = reason(&Figure::of(&bones).glb()).to_string();
    assert!(found.contains("human"), "{found}");
}

#[test]
fn a_table_without_joints_is_no_human_figure() {
    let (mut json, bytes) = Figure::adult().document();
    json["nodes"] = json!([{ "name": "Table", "mesh": 0 }]);
    json["scenes"] = json!([{ "nodes": [0] }]);
    json.as_object_mut().unwrap().remove("skins");
    check_rejected(&json, &bytes, "no human legs");
}
