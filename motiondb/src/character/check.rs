//! Invariants of a character: posing and skinning rely on all of them, so a file that breaks one is rejected.

use glam::{Quat, Vec3};

use crate::body::{ExtraParent, Joint};
use crate::character::model::{Character, CharacterExtra, CharacterMesh, Material, WEIGHT_COUNT};
use crate::character::texture::{CutOut, TEXTURE_PIXELS_MAX, TEXTURE_SIDE_MAX};

/// Greatest number of joints; an index into them is a u16.
pub const JOINTS_MAX: usize = 4096;
/// Greatest number of vertices; a scanned figure has 100,000.
pub const VERTICES_MAX: usize = 1_000_000;
/// Greatest number of triangles.
pub const TRIANGLES_MAX: usize = 2_000_000;
/// Greatest number of materials.
const MATERIALS_MAX: usize = 4096;
/// Greatest coordinate, m: figures of giants and files in millimetres stay below.
const COORDINATE_MAX_M: f32 = 100_000.0;
/// Greatest texture coordinate: beyond, 32 bits hold no share of a pixel.
const UV_MAX: f32 = 1024.0;
/// Least height of the hips above the soles, m: smaller ones have no direction in 32 bits.
const HIPS_MIN_M: f32 = 1e-4;
/// Greatest deviation of a squared length, or of a sum of weights, from 1.
const UNIT_TOLERANCE: f32 = 1e-3;
/// Roles that a character must have to walk.
const REQUIRED: [Joint; 13] = [
    Joint::Pelvis,
    Joint::LeftThigh,
    Joint::LeftShank,
    Joint::LeftFoot,
    Joint::RightThigh,
    Joint::RightShank,
    Joint::RightFoot,
    Joint::LeftUpperArm,
    Joint::LeftForearm,
    Joint::LeftHand,
    Joint::RightUpperArm,
    Joint::RightForearm,
    Joint::RightHand,
];

/// The first invariant that a character breaks, as a text for people; none of a valid character.
pub fn first_fault(character: &Character) -> Option<String> {
    joints_fault(character)
        .or_else(|| extra_fault(character))
        .or_else(|| sizes_fault(character))
        .or_else(|| mesh_fault(character))
        .or_else(|| textures_fault(character))
}

fn joints_fault(character: &Character) -> Option<String> {
    let joints = &character.joints;
    if joints.len() > JOINTS_MAX {
        return Some(format!("it has {} joints, more than {JOINTS_MAX}", joints.len()));
    }
    for (index, joint) in joints.iter().enumerate() {
        let is_sound = joint.parent.is_none_or(|parent| (parent as usize) < index)
            && is_near(joint.position_m)
            && (joint.orientation.length_squared() - 1.0).abs() < UNIT_TOLERANCE;
        if !is_sound {
            return Some(format!("joint {index} has a parent after it, or is not at a finite place"));
        }
    }
    for role in Joint::ALL {
        match character.joint(role) {
            Some(joint) if joint >= joints.len() => return Some(format!("`{}` names no joint", role.name())),
            None if REQUIRED.contains(&role) => return Some(format!("no joint is the {}", role.name())),
            _ => (),
        }
    }
    None
}

/// Each extra joint hangs from a role, or comes after the extra joint that it hangs from.
fn extra_fault(character: &Character) -> Option<String> {
    let Character { joints, extra, .. } = character;
    let is_turn = |turn: Quat| (turn.length_squared() - 1.0).abs() < UNIT_TOLERANCE;
    let is_sound = |known: &CharacterExtra| {
        // Roles are posed first: a finger may hang from the forearm, before the hand in the file.
        let is_after_parent = match known.extra.parent() {
            ExtraParent::Role(role) => character.joint(role).is_some(),
            ExtraParent::Extra(parent) => character.extra_joint(parent).is_some_and(|at| at < known.joint as usize),
        };
        let is_role = character.roles.contains(&Some(known.joint));
        is_after_parent && !is_role && is_turn(known.parent_axes) && is_turn(known.axes)
    };
    let is_unique = |pair: &[CharacterExtra]| pair[0].extra < pair[1].extra;
    let unsound = extra.iter().find(|known| known.joint as usize >= joints.len() || !is_sound(known));
    match unsound {
        Some(known) => Some(format!("`{}` names no joint, or has a parent after it", known.extra.name())),
        None if !extra.windows(2).all(is_unique) => Some("its extra joints are not in order".into()),
        None => None,
    }
}

fn sizes_fault(character: &Character) -> Option<String> {
    let Character { hips_over_soles_m, leg_length_m, height_m, radius_m, .. } = *character;
    let sizes_m = [hips_over_soles_m, leg_length_m, height_m, radius_m];
    let feet = character.feet.iter().flat_map(|foot| [foot.heel_m, foot.ball_m, foot.toe_tip_m]);
    let is_size = |size_m: &f32| (0.0..COORDINATE_MAX_M).contains(size_m);
    let is_sound = sizes_m.iter().chain(&character.segment_radii_m).all(is_size)
        && hips_over_soles_m >= HIPS_MIN_M
        && feet.into_iter().all(is_near);
    (!is_sound).then(|| "a size is not finite, or the hips are not above the soles".into())
}

fn mesh_fault(character: &Character) -> Option<String> {
    let CharacterMesh { positions_m, normals, colours, joints, weights, triangles, materials, .. } = &character.mesh;
    let count = positions_m.len();
    if count > VERTICES_MAX || triangles.len() > TRIANGLES_MAX || materials.len() > MATERIALS_MAX {
        return Some(format!("its mesh has {count} vertices and {} triangles, too many", triangles.len()));
    }
    if [normals.len(), colours.len(), joints.len(), weights.len()] != [count; 4] {
        return Some("the lists of its vertices differ in length".into());
    }
    let of_materials: u64 = materials.iter().map(|material| u64::from(material.triangle_count)).sum();
    if of_materials != triangles.len() as u64 {
        return Some(format!("its materials have {of_materials} triangles, its mesh {}", triangles.len()));
    }
    if triangles.as_flattened().iter().any(|&vertex| vertex as usize >= count) {
        return Some("a triangle names a vertex that does not exist".into());
    }
    let is_vertex = |vertex: usize| {
        is_near(positions_m[vertex])
            && normals[vertex].is_finite()
            && normals[vertex].length_squared() < 1.0 + UNIT_TOLERANCE
            && colours[vertex].iter().all(|part| (0.0..=1.0).contains(part))
    };
    let has_weights = |vertex: usize| are_weights(&joints[vertex], &weights[vertex], character.joints.len());
    (0..count).find_map(|vertex| match (is_vertex(vertex), has_weights(vertex)) {
        (true, true) => None,
        (false, _) => Some(format!("vertex {vertex} is out of range")),
        (true, false) => Some(format!("the weights of vertex {vertex} do not fall, or do not add up to 1")),
    })
}

fn textures_fault(character: &Character) -> Option<String> {
    let Character { mesh, textures, .. } = character;
    let mut pixels = 0;
    for (index, texture) in textures.iter().enumerate() {
        let [width, height] = texture.size_px.map(|side| side as usize);
        let is_side = |side: usize| (1..=TEXTURE_SIDE_MAX).contains(&side);
        if !is_side(width) || !is_side(height) || texture.pixels.len() != 4 * width * height {
            return Some(format!("texture {index} has not as many pixels as its size"));
        }
        pixels += width * height;
    }
    if pixels > TEXTURE_PIXELS_MAX {
        return Some(format!("its textures have {pixels} pixels, more than {TEXTURE_PIXELS_MAX}"));
    }
    let names_texture = |material: &Material| match (material.texture, material.cut_out) {
        (_, CutOut::Below(alpha)) if !(0.0..=1.0).contains(&alpha) => false,
        (texture, _) => texture.is_none_or(|texture| (texture as usize) < textures.len()),
    };
    if !mesh.materials.iter().all(names_texture) {
        return Some("a material names a texture that does not exist, or an alpha that is none".into());
    }
    let is_textured = mesh.materials.iter().any(|material| material.texture.is_some());
    let count = if is_textured { mesh.positions_m.len() } else { 0 };
    if [mesh.uvs.len(), mesh.tints.len()] != [count; 2] {
        return Some("the lists of its vertices differ in length".into());
    }
    let is_sound = mesh.uvs.as_flattened().iter().all(|part| part.abs() <= UV_MAX)
        && mesh.tints.as_flattened().iter().all(|part| (0.0..=1.0).contains(part));
    (!is_sound).then(|| "a texture coordinate is out of range".into())
}

fn are_weights(joints: &[u16; WEIGHT_COUNT], weights: &[f32; WEIGHT_COUNT], joint_count: usize) -> bool {
    // Skinning ends at the first weight of 0.
    joints.iter().all(|&joint| usize::from(joint) < joint_count)
        && weights.is_sorted_by(|a, b| a >= b)
        && weights.iter().all(|weight| (0.0..=1.0).contains(weight))
        && (weights.iter().sum::<f32>() - 1.0).abs() < UNIT_TOLERANCE
}

fn is_near(point_m: Vec3) -> bool {
    point_m.is_finite() && point_m.abs().max_element() <= COORDINATE_MAX_M
}
