//! The character: joints, their roles, feet, sizes and mesh. Bind space (see [`crate::character`]), metres.

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::body::{ExtraJoint, ExtraParent, JOINT_COUNT, Joint};
use crate::character::texture::{CharacterTexture, CutOut};

/// Greatest number of joints that move one vertex.
pub const WEIGHT_COUNT: usize = 4;

/// A skinned figure whose joints are mapped to those of the canonical humanoid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Character {
    /// Name: the stem of the file that it was compiled from.
    pub name: String,
    /// The joints that move vertices or have a role, and the joints above them; each parent comes before its children.
    pub joints: Vec<CharacterJoint>,
    /// Index of the joint of each canonical role; none where the character has no such joint.
    pub roles: [Option<u32>; JOINT_COUNT],
    /// Soles, `[left, right]`.
    pub feet: [CharacterFoot; 2],
    /// Height of the hip joints above the soles, m.
    pub hips_over_soles_m: f32,
    /// Thigh plus shank, mean of both sides, m.
    pub leg_length_m: f32,
    /// Height of the highest vertex above the soles, m.
    pub height_m: f32,
    /// Radius of the disc around the trunk and hanging arms: half the distance of the shoulders plus an arm's radius, m.
    pub radius_m: f32,
    /// Radius of the capsule of each role's segment, m; 0 where no vertex belongs to it.
    pub segment_radii_m: [f32; JOINT_COUNT],
    /// What is drawn.
    pub mesh: CharacterMesh,
    /// The textures of its materials.
    pub textures: Vec<CharacterTexture>,
    /// The joints beside the roles that poses move, in order; files hold them after all else.
    #[serde(skip)]
    pub extra: Vec<CharacterExtra>,
}

/// A joint of a character that is an extra joint: of a finger, a toe, or a twist bone. Rotations in bind space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CharacterExtra {
    /// What the joint is.
    pub extra: ExtraJoint,
    /// Index of the joint.
    pub joint: u32,
    /// Orientation of the parent's axes in the bind pose: of the palm, the limb, the toes, or the finger joint before.
    pub parent_axes: Quat,
    /// Orientation of the joint's own axes in the bind pose: at the rest of [`ExtraJoint`], those of the parent.
    pub axes: Quat,
}

/// A joint of a character in bind space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CharacterJoint {
    /// Name in the file.
    pub name: String,
    /// Index of the parent in the file, smaller than the joint's own; none of a root.
    pub parent: Option<u32>,
    /// Position, m.
    pub position_m: Vec3,
    /// Orientation.
    pub orientation: Quat,
}

/// Points of the sole of one foot, m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CharacterFoot {
    /// Rearmost point of the sole.
    pub heel_m: Vec3,
    /// Point of the sole under the toe joint; without toe joint, at 0.65 of the distance from the ankle to the tip.
    pub ball_m: Vec3,
    /// Foremost point of the sole.
    pub toe_tip_m: Vec3,
}

/// All meshes of a character as one. Lists are by vertex, except triangles and materials.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CharacterMesh {
    /// Positions in bind space, m.
    pub positions_m: Vec<Vec3>,
    /// Unit normals in bind space.
    pub normals: Vec<Vec3>,
    /// Colours, linear Rec. 709, from material, vertex colour and texture.
    pub colours: Vec<[f32; 3]>,
    /// Texture coordinates; empty where no material has a texture.
    pub uvs: Vec<[f32; 2]>,
    /// Linear colours by which textures are multiplied, from material and vertex colour; as long as `uvs`.
    pub tints: Vec<[f32; 3]>,
    /// Indices of the joints that move a vertex; unused ones are 0.
    pub joints: Vec<[u16; WEIGHT_COUNT]>,
    /// Weights of these joints, falling; their sum is 1.
    pub weights: Vec<[f32; WEIGHT_COUNT]>,
    /// Three vertices each, counter-clockwise seen from outside, in the order of the materials.
    pub triangles: Vec<[u32; 3]>,
    /// Materials, each of a run of triangles.
    pub materials: Vec<Material>,
}

/// A run of triangles of one material and one mesh of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Name in the file.
    pub name: String,
    /// Name of the mesh in the file: that of the node that draws it.
    pub mesh: String,
    /// Number of triangles; the runs follow each other.
    pub triangle_count: u32,
    /// Whether the backs of the triangles are seen.
    pub is_double_sided: bool,
    /// Whether hue variation leaves the colours as they are: skin, eyes, hair.
    pub keeps_hue: bool,
    /// Index of the texture; none of a plain material.
    pub texture: Option<u32>,
    /// What the texture's alpha hides.
    pub cut_out: CutOut,
}

impl Character {
    /// Index of the joint of a role.
    pub fn joint(&self, role: Joint) -> Option<usize> {
        self.roles[role.index()].map(|joint| joint as usize)
    }

    /// Position of the joint of a role in bind space, m.
    pub fn role_position_m(&self, role: Joint) -> Option<Vec3> {
        self.joint(role).map(|joint| self.joints[joint].position_m)
    }

    /// The nearest role above a role that the character has a joint for; none above the pelvis.
    pub fn role_above(&self, role: Joint) -> Option<Joint> {
        std::iter::successors(role.parent(), |above| above.parent()).find(|above| self.joint(*above).is_some())
    }

    /// Index of the joint that is an extra joint.
    pub fn extra_joint(&self, extra: ExtraJoint) -> Option<usize> {
        let found = self.extra.binary_search_by_key(&extra, |known| known.extra).ok()?;
        Some(self.extra[found].joint as usize)
    }

    /// Index of the joint of the role or of the extra joint from which an extra joint hangs.
    pub fn extra_parent(&self, extra: ExtraJoint) -> Option<usize> {
        match extra.parent() {
            ExtraParent::Role(role) => self.joint(role),
            ExtraParent::Extra(parent) => self.extra_joint(parent),
        }
    }

    /// Whether a foot bends at its toes.
    pub fn has_toe(&self, side: usize) -> bool {
        self.joint(Joint::TOES[side]).is_some()
    }
}
