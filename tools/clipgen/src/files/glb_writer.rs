//! Poses → GLB: glTF 2.0 in one binary file, metres, Y up, Z forward, X to the body's left; a skinned body and one
//! animation.
//!
//! Nodes are the joints in their order, then the tips of head and hands, then the mesh. The generator's frame (x
//! forward, y left, z up) becomes glTF's by (X, Y, Z) = (y, z, x), as BVH's. Joints rest unturned, so that inverse
//! bind matrices only translate; rotation tracks run along the shorter arcs, LINEAR, 30 keys per second. The container
//! is that of glTF 2.0, §4.4: header, JSON chunk, binary chunk, each aligned to 4 bytes.

use glam::{DQuat, DVec3};

use crate::body::ClipPose;
use crate::body::skeleton::{JOINT_COUNT, JointAtRest, joints_at_rest};
use crate::files::body_mesh::{BodyMesh, MeshVertex, body_mesh};
use crate::files::glb_buffer::GlbBuffer;
use crate::plan::FRAME_RATE_HZ;

/// First bytes of a GLB file.
const MAGIC: &[u8; 4] = b"glTF";
/// Version of glTF.
const VERSION: u32 = 2;
/// Size of the file's header, bytes.
const HEADER_BYTES: usize = 12;
/// Size of the header of a chunk, bytes.
const CHUNK_HEADER_BYTES: usize = 8;

/// The bytes of a GLB file; `name` is that of the animation.
pub(crate) fn glb_bytes(name: &str, poses: &[ClipPose]) -> Vec<u8> {
    let mut buffer = GlbBuffer::default();
    let mesh = mesh_json(&mut buffer, &body_mesh());
    let skin = skin_json(&mut buffer);
    let animation = animation_json(&mut buffer, name, poses);
    let json = format!(
        "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"FbCrowd clipgen\"}},\"scene\":0,\
         \"scenes\":[{{\"nodes\":[0,{mesh_node}]}}],\"nodes\":[{nodes}],\"meshes\":[{mesh}],\"skins\":[{skin}],\
         \"animations\":[{animation}],\
         \"materials\":[{{\"pbrMetallicRoughness\":{{\"baseColorFactor\":[0.62,0.62,0.60,1],\"metallicFactor\":0}}}}],\
         {buffer}}}",
        mesh_node = tips().len() + JOINT_COUNT,
        nodes = nodes_json(),
        buffer = buffer.json(),
    );
    container(json.into_bytes(), buffer.bytes)
}

/// Joints that end in a segment of their own, not in a sole point, and where it ends relative to them, m.
fn tips() -> Vec<(usize, DVec3)> {
    let tip = |(index, joint): (usize, &JointAtRest)| Some((index, joint.end_m.filter(|end| *end != DVec3::ZERO)?));
    joints_at_rest().iter().enumerate().filter_map(tip).collect()
}

/// Joints, tips and mesh as nodes.
fn nodes_json() -> String {
    let joints = joints_at_rest();
    let tips = tips();
    let mut nodes: Vec<String> = Vec::new();
    for (index, joint) in joints.iter().enumerate() {
        let to_joints = (index + 1..JOINT_COUNT).filter(|child| joints[*child].parent == index);
        let to_tips = (0..tips.len()).filter(|tip| tips[*tip].0 == index).map(|tip| JOINT_COUNT + tip);
        let children: Vec<String> = to_joints.chain(to_tips).map(|child| child.to_string()).collect();
        let children =
            if children.is_empty() { String::new() } else { format!(",\"children\":[{}]", children.join(",")) };
        let offset_m = if index == 0 { ClipPose::rest().hips_m } else { joint.offset_m };
        nodes.push(node_json(joint.name, offset_m, &children));
    }
    nodes.extend(tips.iter().map(|(joint, end_m)| node_json(&format!("{}_End", joints[*joint].name), *end_m, "")));
    nodes.push("{\"name\":\"Body\",\"mesh\":0,\"skin\":0}".to_owned());
    nodes.join(",")
}

fn node_json(name: &str, offset_m: DVec3, children: &str) -> String {
    let [x, y, z] = vector(offset_m);
    format!("{{\"name\":\"{name}\",\"translation\":[{x},{y},{z}]{children}}}")
}

/// The skinned mesh; its arrays go to the buffer.
fn mesh_json(buffer: &mut GlbBuffer, mesh: &BodyMesh) -> String {
    let of = |value: &dyn Fn(&MeshVertex) -> DVec3| -> Vec<f32> {
        mesh.vertices.iter().flat_map(|vertex| vector(value(vertex))).collect()
    };
    let position = buffer.push_vertices(&of(&|vertex| vertex.position_m));
    let normal = buffer.push_vertices(&of(&|vertex| vertex.normal));
    // glTF: the joint of a zero weight is 0.
    let neighbour = |vertex: &MeshVertex| if weight_byte(vertex) == 0 { 0 } else { vertex.joints[1] as u8 };
    let joints = buffer
        .push_bytes(mesh.vertices.iter().flat_map(|vertex| [vertex.joints[0] as u8, neighbour(vertex), 0, 0]), false);
    let weights = buffer.push_bytes(
        mesh.vertices.iter().flat_map(|vertex| [u8::MAX - weight_byte(vertex), weight_byte(vertex), 0, 0]),
        true,
    );
    let indices = buffer.push_indices(mesh.triangles.iter().flatten().map(|index| *index as u16));
    format!(
        "{{\"name\":\"Body\",\"primitives\":[{{\"attributes\":{{\"POSITION\":{position},\"NORMAL\":{normal},\
         \"JOINTS_0\":{joints},\"WEIGHTS_0\":{weights}}},\"indices\":{indices},\"material\":0}}]}}"
    )
}

/// The neighbour's weight in 255ths.
fn weight_byte(vertex: &MeshVertex) -> u8 {
    libm::round(vertex.neighbour_weight * f64::from(u8::MAX)) as u8
}

/// The skin: joints and their inverse bind matrices.
fn skin_json(buffer: &mut GlbBuffer) -> String {
    let inverse_bind = |position_m: DVec3| {
        let [x, y, z] = vector(-position_m);
        [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0]
    };
    let matrices: Vec<f32> = ClipPose::rest().positions_m().into_iter().flat_map(inverse_bind).collect();
    let matrices = buffer.push_floats("MAT4", &matrices);
    let joints: Vec<String> = (0..JOINT_COUNT).map(|joint| joint.to_string()).collect();
    format!("{{\"inverseBindMatrices\":{matrices},\"skeleton\":0,\"joints\":[{}]}}", joints.join(","))
}

/// The animation: translation of the root, rotation of every joint but the sole points, which never turn.
fn animation_json(buffer: &mut GlbBuffer, name: &str, poses: &[ClipPose]) -> String {
    let times_s: Vec<f32> = (0..poses.len()).map(|frame| (frame as f64 / FRAME_RATE_HZ) as f32).collect();
    let input = buffer.push_floats("SCALAR", &times_s);
    let positions: Vec<f32> = poses.iter().flat_map(|pose| vector(pose.hips_m)).collect();
    let mut tracks = vec![(0, "translation", buffer.push_floats("VEC3", &positions))];
    for (index, joint) in joints_at_rest().iter().enumerate() {
        if joint.end_m != Some(DVec3::ZERO) {
            tracks.push((index, "rotation", buffer.push_floats("VEC4", &rotations(poses, index))));
        }
    }
    let channel = |(sampler, (node, path, _)): (usize, &(usize, &str, usize))| {
        format!("{{\"sampler\":{sampler},\"target\":{{\"node\":{node},\"path\":\"{path}\"}}}}")
    };
    let sampler = |(_, _, output): &(usize, &str, usize)| {
        format!("{{\"input\":{input},\"output\":{output},\"interpolation\":\"LINEAR\"}}")
    };
    let channels: Vec<String> = tracks.iter().enumerate().map(channel).collect();
    let samplers: Vec<String> = tracks.iter().map(sampler).collect();
    format!("{{\"name\":\"{name}\",\"channels\":[{}],\"samplers\":[{}]}}", channels.join(","), samplers.join(","))
}

/// Quaternions of one joint, each in the hemisphere of the one before.
fn rotations(poses: &[ClipPose], joint: usize) -> Vec<f32> {
    let mut before = DQuat::IDENTITY;
    let mut values = Vec::with_capacity(4 * poses.len());
    for pose in poses {
        let rotation = pose.rotations[joint].normalize();
        before = if rotation.dot(before) < 0.0 { -rotation } else { rotation };
        values.extend([before.y, before.z, before.x, before.w].map(|value| value as f32));
    }
    values
}

/// A vector of the generator's frame in glTF's.
fn vector(v: DVec3) -> [f32; 3] {
    // Adding zero removes the sign of a negative zero.
    [v.y, v.z, v.x].map(|value| value as f32 + 0.0)
}

/// The file: header, JSON chunk, binary chunk.
fn container(mut json: Vec<u8>, binary: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = HEADER_BYTES + 2 * CHUNK_HEADER_BYTES + json.len() + binary.len();
    let mut bytes = Vec::with_capacity(length);
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::planned_clips;

    #[test]
    fn skinned_clips_are_whole_aligned_and_small() {
        for clip in planned_clips().iter().filter(|clip| clip.is_skinned()) {
            let bytes = glb_bytes(clip.name, &clip.poses());
            let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
            let json_bytes = word(HEADER_BYTES);
            let binary = HEADER_BYTES + CHUNK_HEADER_BYTES + json_bytes;
            assert!(&bytes[..4] == MAGIC && word(8) == bytes.len() && json_bytes % 4 == 0, "{}", clip.name);
            assert_eq!(binary + CHUNK_HEADER_BYTES + word(binary), bytes.len(), "{}", clip.name);
            assert!(bytes.len() < 150_000, "{}", clip.name);
        }
    }

    #[test]
    fn at_least_six_clips_are_skinned() {
        assert!(planned_clips().iter().filter(|clip| clip.is_skinned()).count() >= 6);
    }
}
