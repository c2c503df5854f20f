//! A file → a character, one line a step.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufReader, Cursor, Read, Seek};
use std::path::Path;

use glam::{DMat4, DQuat, DVec3};
use gltf::json::validation::Checked;
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::character::{self, Character, CharacterExtra, CharacterJoint, CharacterMesh, WEIGHT_COUNT};
use motiondb::files::input_file;

use crate::character::bind_pose::BindPose;
use crate::character::body_axes;
use crate::character::body_mesh::{BodyMesh, MeshBuilder};
use crate::character::extensions;
use crate::character::extra_bones::{ExtraBone, extra_bones};
use crate::character::joint_roles::{self, RolesFrom, SlotMap};
use crate::character::mesh_instances::{ATTRIBUTES, draws_triangles, instances};
use crate::character::primitive;
use crate::character::reason::{CharacterNote, CharacterReason, CharacterRejection};
use crate::character::sizes::{self, MeshOnJoints};
use crate::character::worn_meshes;
use crate::error::RejectionReason;
use crate::read::gltf::buffers::Outside;
use crate::read::gltf::chunks;
use crate::read::gltf::document::Document;
use crate::read::gltf::node_tree::NodeTree;

/// A character and what the compiler reports about it.
#[derive(Clone, Debug)]
pub struct CompiledCharacter {
    /// The character; all its invariants hold.
    pub character: Character,
    /// How the roles of its joints were found.
    pub roles_from: RolesFrom,
    /// What was left out or assumed.
    pub notes: Vec<CharacterNote>,
}

/// Whether a file's name is that of a character's source: `.glb`, `.gltf` or `.vrm`.
pub fn is_character_file(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    ["glb", "gltf", "vrm"].contains(&extension.as_str())
}

/// Compiles the character of a `.glb`, `.gltf` or `.vrm` file. `hide` names meshes that are left out.
///
/// # Errors
/// Why the file gives no character.
pub fn compile_character(
    path: &Path,
    outside: Outside,
    hide: &[String],
) -> Result<CompiledCharacter, CharacterRejection> {
    let rejected = |reason| CharacterRejection { file: path.display().to_string(), reason };
    let open = || -> Result<BufReader<File>, CharacterReason> {
        let file = input_file::open(path).map_err(|error| RejectionReason::unreadable(&error))?;
        Ok(BufReader::new(file))
    };
    if !is_character_file(path) {
        return Err(rejected(CharacterReason::UnknownFormat));
    }
    open().and_then(|file| compiled(path, file, outside, hide)).map_err(rejected)
}

/// As [`compile_character`], of all meshes, from a file's bytes; `path` gives the name and the folder of buffers and textures.
///
/// # Errors
/// As [`compile_character`].
pub fn compile_character_bytes(path: &Path, bytes: &[u8]) -> Result<CompiledCharacter, CharacterRejection> {
    let rejected = |reason| CharacterRejection { file: path.display().to_string(), reason };
    compiled(path, Cursor::new(bytes), Outside::Refused, &[]).map_err(rejected)
}

/// What a glTF file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileContent {
    /// Whether it has triangles.
    pub has_meshes: bool,
    /// Whether it has animations.
    pub has_animations: bool,
}

/// What a GLB, glTF or VRM file holds; none where it cannot be read. Nothing but its JSON is read.
pub fn file_content(path: &Path) -> Option<FileContent> {
    if !is_character_file(path) {
        return None;
    }
    let json = chunks::read(&mut BufReader::new(input_file::open(path).ok()?)).ok()?.json;
    let root = Document::parse(&json).ok()?.root;
    let has_meshes = root.meshes.iter().flat_map(|mesh| &mesh.primitives).any(draws_triangles);
    Some(FileContent { has_meshes, has_animations: !root.animations.is_empty() })
}

fn compiled(
    path: &Path,
    mut file: impl Read + Seek,
    outside: Outside,
    hide: &[String],
) -> Result<CompiledCharacter, CharacterReason> {
    let mut notes = Vec::new();
    let chunks = chunks::read(&mut file)?;
    let table = extensions::bone_table(&chunks.json, &mut notes)?;
    let mut document = Document::parse(&chunks.json)?;
    document.read_buffers(path, &mut file, chunks.binary, outside, &needed_buffers(&document))?;
    let tree = NodeTree::new(&document.root)?;
    let pose = BindPose::new(&document, &tree)?;
    let is_mesh: Vec<bool> = tree.order.iter().map(|&node| document.root.nodes[node].mesh.is_some()).collect();
    if !document.root.meshes.iter().flat_map(|mesh| &mesh.primitives).any(draws_triangles) {
        return Err(CharacterReason::NoMesh);
    }
    let (mut slots, roles_from) = joint_roles::slots_of_roles(&pose, table.as_ref(), &is_mesh, &mut notes)?;
    let to_body = body_axes::to_body(&pose, &slots)?;
    let mut builder = MeshBuilder::new(&document, path, outside);
    let pelvis = slots[Joint::Pelvis.index()].ok_or(CharacterReason::NoLegs)?;
    let instances = instances(&document, &tree, &pose, &slots, &mut notes)?;
    let instances = worn_meshes::worn(instances, hide, &pose, &slots, &mut notes)?;
    let parts = instances.into_iter().map(|instance| {
        let part = primitive::read(&document, &pose, &instance, &to_body, pelvis)?;
        Ok((instance, part))
    });
    builder.add_all(parts.collect::<Result<Vec<_>, CharacterReason>>()?)?;
    let mesh = builder.finish(&mut notes);
    if mesh.triangles.is_empty() {
        return Err(CharacterReason::NoMesh);
    }
    let (mut character, kept) = assembled(path, &pose, &mut slots, &to_body, mesh)?;
    let may_be_joints = joint_roles::joints(&pose, &is_mesh);
    let bones = extra_bones(&pose, &slots, &may_be_joints, table.as_ref(), &to_body);
    character.extra = bones.iter().filter_map(|bone| extra(&kept, bone)).collect();
    add_notes_of_roles(&slots, &mut notes);
    match character::first_fault(&character) {
        Some(fault) => Err(CharacterReason::Unsound { fault }),
        None => Ok(CompiledCharacter { character, roles_from, notes }),
    }
}

/// The buffers of meshes, skins and embedded textures.
fn needed_buffers(document: &Document) -> BTreeSet<usize> {
    let root = &document.root;
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let of_primitives = primitives.flat_map(|primitive| {
        let attributes = ATTRIBUTES.iter().filter_map(|kind| primitive.attributes.get(&Checked::Valid(kind.clone())));
        attributes.copied().chain(primitive.indices).map(|index| index.value())
    });
    let of_skins = root.skins.iter().filter_map(|skin| skin.inverse_bind_matrices).map(|index| index.value());
    let mut buffers = document.buffers_of(of_primitives.chain(of_skins));
    let views = root.images.iter().filter_map(|image| root.buffer_views.get(image.buffer_view?.value()));
    buffers.extend(views.map(|view| view.buffer.value()));
    buffers
}

fn add_notes_of_roles(slots: &SlotMap, notes: &mut Vec<CharacterNote>) {
    let missing = joint_roles::missing(slots);
    if !missing.is_empty() {
        notes.push(CharacterNote::MissingRoles(missing));
    }
    if slots[Joint::LeftToe.index()].is_none() {
        notes.push(CharacterNote::NoToes);
    }
}

/// The character of a mesh in body axes, with the soles on z = 0 and the hips over the origin; without extra joints. Also the
/// slots of its joints.
fn assembled(
    path: &Path,
    pose: &BindPose,
    slots: &mut SlotMap,
    to_body: &DMat4,
    mut mesh: BodyMesh,
) -> Result<(Character, Vec<usize>), CharacterReason> {
    let positions_m: Vec<DVec3> =
        (0..pose.parents.len()).map(|slot| to_body.transform_point3(pose.position_m(slot))).collect();
    let leaders = joint_roles::leaders(pose, slots);
    let on_joints = MeshOnJoints { mesh: &mesh, positions_m: &positions_m, leaders: &leaders };
    on_joints.remove_idle_toes(slots);
    let leaders = joint_roles::leaders(pose, slots);
    let on_joints = MeshOnJoints { leaders: &leaders, ..on_joints };
    let feet_m = on_joints.feet(slots);
    let sole_m = 0.5 * (feet_m[0][0].z + feet_m[1][0].z);
    let hips_over_soles_m = on_joints.hips_over_soles_m(slots, sole_m);
    let leg_length_m = on_joints.leg_length_m(slots);
    if hips_over_soles_m <= 0.5 * leg_length_m {
        return Err(CharacterReason::HipsAtSoles);
    }
    let radii_m = on_joints.segment_radii_m(slots);
    let [left_m, right_m] = Joint::THIGHS.map(|thigh| positions_m[slots[thigh.index()].unwrap_or(0)]);
    let origin_m = (0.5 * (left_m + right_m)).with_z(sole_m);
    let top_m = mesh.positions_m.iter().map(|position_m| position_m.z).fold(sole_m, f64::max);
    let kept = kept_slots(pose, slots, &mesh);
    let to_body = to_body.to_scale_rotation_translation().1;
    let character = Character {
        name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        joints: kept.iter().map(|&slot| joint(pose, &kept, slot, to_body, positions_m[slot] - origin_m)).collect(),
        roles: slots.map(|slot| slot.and_then(|slot| place(&kept, slot)).map(|index| index as u32)),
        feet: feet_m.map(|foot_m| sizes::foot(foot_m, origin_m)),
        hips_over_soles_m: hips_over_soles_m as f32,
        leg_length_m: leg_length_m as f32,
        height_m: (top_m - sole_m) as f32,
        radius_m: on_joints.radius_m(slots, &radii_m) as f32,
        segment_radii_m: std::array::from_fn::<f32, JOINT_COUNT, _>(|role| radii_m[role] as f32),
        textures: std::mem::take(&mut mesh.textures),
        mesh: on_kept_joints(mesh, &kept, origin_m),
        extra: Vec::new(),
    };
    Ok((character, kept))
}

/// Slots of the nodes that have a role or move a vertex, and of those above them.
fn kept_slots(pose: &BindPose, slots: &SlotMap, mesh: &BodyMesh) -> Vec<usize> {
    let mut is_kept = vec![false; pose.parents.len()];
    let moving = mesh.weights.as_flattened().iter().filter(|(_, weight)| *weight > 0.0).map(|(slot, _)| *slot);
    moving.chain(slots.iter().flatten().copied()).for_each(|slot| is_kept[slot] = true);
    for slot in (0..is_kept.len()).rev() {
        if let (true, Some(parent)) = (is_kept[slot], pose.parents[slot]) {
            is_kept[parent] = true;
        }
    }
    (0..is_kept.len()).filter(|&slot| is_kept[slot]).collect()
}

/// The extra joint of a bone; none of one that moves no vertex, or has no axes.
fn extra(kept: &[usize], bone: &ExtraBone) -> Option<CharacterExtra> {
    let [parent_axes, axes] = [bone.parent_axes, bone.axes].map(|axes| axes.normalize().as_quat());
    let joint = place(kept, bone.slot).filter(|_| parent_axes.is_finite() && axes.is_finite())? as u32;
    Some(CharacterExtra { extra: bone.extra, joint, parent_axes, axes })
}

fn place(kept: &[usize], slot: usize) -> Option<usize> {
    kept.binary_search(&slot).ok()
}

fn joint(pose: &BindPose, kept: &[usize], slot: usize, to_body: DQuat, position_m: DVec3) -> CharacterJoint {
    CharacterJoint {
        name: pose.names[slot].clone(),
        parent: pose.parents[slot].and_then(|parent| place(kept, parent)).map(|parent| parent as u32),
        position_m: position_m.as_vec3(),
        orientation: (to_body * pose.orientation(slot)).normalize().as_quat(),
    }
}

/// The mesh with the indices of the kept joints.
fn on_kept_joints(mesh: BodyMesh, kept: &[usize], origin_m: DVec3) -> CharacterMesh {
    let joint = |&(slot, weight): &(usize, f32)| match weight > 0.0 {
        true => place(kept, slot).unwrap_or(0) as u16,
        false => 0,
    };
    let joints = mesh.weights.iter().map(|weights| weights.each_ref().map(joint));
    let weights = mesh.weights.iter().map(|weights| weights.map(|(_, weight)| weight));
    CharacterMesh {
        positions_m: mesh.positions_m.iter().map(|position_m| (*position_m - origin_m).as_vec3()).collect(),
        normals: mesh.normals.iter().map(|normal| normal.as_vec3()).collect(),
        colours: mesh.colours,
        uvs: mesh.uvs,
        tints: mesh.tints,
        joints: joints.collect::<Vec<[u16; WEIGHT_COUNT]>>(),
        weights: weights.collect(),
        triangles: mesh.triangles,
        materials: mesh.materials,
    }
}
