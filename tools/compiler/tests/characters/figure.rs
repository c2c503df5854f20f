//! Figures that the tests write as GLB files: boxes on a skeleton with names.

use glam::{Mat4, Quat, Vec3};
use serde_json::{Value, json};

/// A joint: name, parent, position in metres (Y up, facing +Z).
pub(crate) type Bone = (&'static str, Option<usize>, [f32; 3]);

/// An adult with arms out and toe joints.
pub(crate) const ADULT: [Bone; 21] = [
    ("Hips", None, [0.0, 0.95, 0.0]),
    ("Spine", Some(0), [0.0, 1.08, 0.0]),
    ("Chest", Some(1), [0.0, 1.28, 0.0]),
    ("Neck", Some(2), [0.0, 1.48, 0.0]),
    ("Head", Some(3), [0.0, 1.58, 0.0]),
    ("LeftShoulder", Some(2), [0.05, 1.43, 0.0]),
    ("LeftArm", Some(5), [0.18, 1.43, 0.0]),
    ("LeftForeArm", Some(6), [0.45, 1.43, 0.0]),
    ("LeftHand", Some(7), [0.70, 1.43, 0.0]),
    ("RightShoulder", Some(2), [-0.05, 1.43, 0.0]),
    ("RightArm", Some(9), [-0.18, 1.43, 0.0]),
    ("RightForeArm", Some(10), [-0.45, 1.43, 0.0]),
    ("RightHand", Some(11), [-0.70, 1.43, 0.0]),
    ("LeftUpLeg", Some(0), [0.09, 0.90, 0.0]),
    ("LeftLeg", Some(13), [0.09, 0.49, 0.01]),
    ("LeftFoot", Some(14), [0.09, 0.08, 0.0]),
    ("LeftToe", Some(15), [0.09, 0.02, 0.13]),
    ("RightUpLeg", Some(0), [-0.09, 0.90, 0.0]),
    ("RightLeg", Some(17), [-0.09, 0.49, 0.01]),
    ("RightFoot", Some(18), [-0.09, 0.08, 0.0]),
    ("RightToe", Some(19), [-0.09, 0.02, 0.13]),
];

/// How a figure is written.
#[derive(Clone)]
pub(crate) struct Figure {
    pub(crate) bones: Vec<Bone>,
    /// Size of the figure.
    pub(crate) size: f32,
    /// Scale of the armature above the joints; lengths below are divided by it.
    pub(crate) armature: f32,
    /// Whether the armature's own up axis is Z.
    pub(crate) is_z_up: bool,
    /// Whether the meshes have normals.
    pub(crate) has_normals: bool,
    /// Factor of all weights.
    pub(crate) weight: f32,
}

impl Figure {
    pub(crate) fn adult() -> Self {
        Self::of(&ADULT)
    }

    pub(crate) fn of(bones: &[Bone]) -> Self {
        Self { bones: bones.to_vec(), size: 1.0, armature: 1.0, is_z_up: false, has_normals: true, weight: 1.0 }
    }

    /// A fox: trunk along z, four legs of the same length.
    pub(crate) fn fox() -> Self {
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
        Self::of(&bones)
    }

    /// With straight fingers of three joints: fingers along the arms, palms down, thumbs ahead of them.
    pub(crate) fn with_fingers(mut self) -> Self {
        for (hand, side, sign) in [("LeftHand", "Left", 1.0), ("RightHand", "Right", -1.0)] {
            let wrist = self.bones.iter().position(|(name, ..)| *name == hand).unwrap();
            let [x, y, z] = self.bones[wrist].2;
            for (finger, name) in ["Thumb", "Index", "Middle", "Ring", "Pinky"].into_iter().enumerate() {
                for joint in 0..3 {
                    let parent = if joint == 0 { wrist } else { self.bones.len() - 1 };
                    let along = joint as f32;
                    let offset = match finger {
                        0 => [0.03 + 0.02 * along, -0.01, 0.03 + 0.02 * along],
                        _ => [0.09 + 0.03 * along, 0.0, 0.05 - 0.02 * finger as f32],
                    };
                    let name: &'static str = Box::leak(format!("{side}Hand{name}{}", joint + 1).into_boxed_str());
                    self.bones.push((name, Some(parent), [x + sign * offset[0], y + offset[1], z + offset[2]]));
                }
            }
        }
        self
    }

    /// Without the joints whose names contain a word, and those below them.
    pub(crate) fn without(&self, word: &str) -> Self {
        let is_out = |mut joint: usize| loop {
            match self.bones[joint] {
                (name, ..) if name.contains(word) => return true,
                (_, Some(parent), _) => joint = parent,
                _ => return false,
            }
        };
        let kept: Vec<usize> = (0..self.bones.len()).filter(|&joint| !is_out(joint)).collect();
        let place = |joint: usize| kept.iter().position(|&kept| kept == joint);
        let bones = kept.iter().map(|&joint| {
            let (name, parent, position) = self.bones[joint];
            (name, parent.and_then(place), position)
        });
        Self { bones: bones.collect(), ..self.clone() }
    }

    /// World → the armature's space.
    fn to_armature(&self) -> Mat4 {
        let turn = if self.is_z_up { Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2) } else { Quat::IDENTITY };
        Mat4::from_scale_rotation_translation(Vec3::splat(self.armature), turn, Vec3::ZERO).inverse()
    }

    fn position_m(&self, joint: usize) -> Vec3 {
        self.size * Vec3::from(self.bones[joint].2)
    }

    /// The box around a joint's segment in the world: from the joint to its children, or on in the direction from its
    /// parent.
    fn segment_m(&self, joint: usize) -> [Vec3; 2] {
        let start_m = self.position_m(joint);
        let children = (0..self.bones.len()).filter(|&child| self.bones[child].1 == Some(joint));
        let mut ends: Vec<Vec3> = children.map(|child| self.position_m(child)).collect();
        if ends.is_empty() {
            let from_m = self.bones[joint].1.map_or(Vec3::ZERO, |parent| self.position_m(parent));
            let ahead = if self.bones[joint].0.contains("Toe") { Vec3::Z } else { (start_m - from_m).normalize() };
            ends.push(start_m + 0.07 * self.size * ahead);
        }
        let (mut low, mut high) =
            ends.iter().fold((start_m, start_m), |(low, high), end| (low.min(*end), high.max(*end)));
        let girth = Vec3::splat(0.04 * self.size);
        (low, high) = (low - girth, high + girth);
        // Feet end at their toes.
        if self.bones[joint].0.contains("Foot") && ends[0].z > start_m.z {
            high.z = ends[0].z;
        }
        // Soles are level.
        if self.bones[joint].0.contains("Foot") || self.bones[joint].0.contains("Toe") {
            low.y = 0.0;
        }
        [low, high]
    }

    /// The file's document and its buffer.
    pub(crate) fn document(&self) -> (Value, Vec<u8>) {
        let (mut bytes, mut views, mut accessors) = (Vec::new(), Vec::new(), Vec::new());
        let to_armature = self.to_armature();
        let mut add = |content: Vec<u8>, component: u32, count: usize, shape: &str| {
            views.push(json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": content.len() }));
            bytes.extend(content);
            bytes.resize(bytes.len().next_multiple_of(4), 0);
            let view = views.len() - 1;
            accessors.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": shape }));
            accessors.len() - 1
        };
        let floats = |values: &[f32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
        let (mut positions, mut normals, mut joints, mut weights, mut corners) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::<u16>::new());
        for joint in 0..self.bones.len() {
            let [low, high] = self.segment_m(joint);
            for (axis, side) in (0..3).flat_map(|axis| [(axis, low), (axis, high)]) {
                let mut normal = Vec3::ZERO;
                normal[axis] = if side == high { 1.0 } else { -1.0 };
                let (across, up) = ((axis + 1) % 3, (axis + 2) % 3);
                let first = positions.len() as u16 / 3;
                for (a, b) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                    let mut corner = side;
                    corner[across] = [low, high][a][across];
                    corner[up] = [low, high][b][up];
                    positions.extend(to_armature.transform_point3(corner).to_array());
                    normals.extend(to_armature.transform_vector3(normal).normalize().to_array());
                    joints.extend([joint as u8, 0, 0, 0]);
                    weights.extend([self.weight, 0.0, 0.0, 0.0]);
                }
                let order = if side == high { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
                corners.extend(order.map(|corner| first + corner));
            }
        }
        let vertices = positions.len() / 3;
        let position = add(floats(&positions), 5126, vertices, "VEC3");
        let normal = add(floats(&normals), 5126, vertices, "VEC3");
        let joint = add(joints, 5121, vertices, "VEC4");
        let weight = add(floats(&weights), 5126, vertices, "VEC4");
        let count = corners.len();
        let index = add(corners.into_iter().flat_map(u16::to_le_bytes).collect(), 5123, count, "SCALAR");
        let inverse: Vec<f32> = (0..self.bones.len())
            .flat_map(|joint| {
                let at = to_armature.transform_point3(self.position_m(joint));
                Mat4::from_translation(-at).to_cols_array()
            })
            .collect();
        let inverse = add(floats(&inverse), 5126, self.bones.len(), "MAT4");
        let mut attributes = json!({ "POSITION": position, "NORMAL": normal, "JOINTS_0": joint, "WEIGHTS_0": weight });
        if !self.has_normals {
            attributes.as_object_mut().unwrap().remove("NORMAL");
        }
        let length = bytes.len();
        let json = json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [self.bones.len() + 1] }],
            "nodes": self.nodes(&to_armature),
            "meshes": [{ "name": "Body", "primitives": [{ "attributes": attributes, "indices": index, "material": 0 }] }],
            "materials": [{ "name": "Cloth", "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.1, 0.1, 1.0] } }],
            "skins": [{ "joints": (0..self.bones.len()).collect::<Vec<_>>(), "inverseBindMatrices": inverse }],
            "accessors": accessors, "bufferViews": views, "buffers": [{ "byteLength": length }],
        });
        (json, bytes)
    }

    fn nodes(&self, to_armature: &Mat4) -> Vec<Value> {
        let local = |joint: usize| to_armature.transform_point3(self.position_m(joint));
        let node = |joint: usize| {
            let (name, parent, _) = self.bones[joint];
            let offset = local(joint) - parent.map_or(Vec3::ZERO, local);
            let children: Vec<usize> =
                (0..self.bones.len()).filter(|&child| self.bones[child].1 == Some(joint)).collect();
            let mut node = json!({ "name": name, "translation": offset.to_array() });
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            node
        };
        let mut nodes: Vec<Value> = (0..self.bones.len()).map(node).collect();
        nodes.push(json!({ "name": "Mesh", "mesh": 0, "skin": 0 }));
        let (scale, rotation, _) = to_armature.inverse().to_scale_rotation_translation();
        let roots = (0..self.bones.len()).filter(|&joint| self.bones[joint].1.is_none());
        let children: Vec<usize> = roots.chain([self.bones.len()]).collect();
        nodes.push(json!({
            "name": "Armature", "scale": scale.to_array(), "rotation": rotation.to_array(), "children": children,
        }));
        nodes
    }

    pub(crate) fn glb(&self) -> Vec<u8> {
        let (json, bytes) = self.document();
        glb(&json, &bytes)
    }
}

/// A GLB file of a document and its buffer.
pub(crate) fn glb(json: &Value, bytes: &[u8]) -> Vec<u8> {
    let mut json = serde_json::to_vec(json).unwrap();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut buffer = bytes.to_vec();
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let word = |number: usize| (number as u32).to_le_bytes();
    let length = word(12 + 8 + json.len() + 8 + buffer.len());
    let parts: [&[u8]; 9] =
        [b"glTF", &word(2), &length, &word(json.len()), b"JSON", &json, &word(buffer.len()), b"BIN\0", &buffer];
    parts.concat()
}
