//! The meshes that are drawn: nodes of the scene with a mesh, skinned or hanging from a joint; and their sizes.

use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use motiondb::body::Joint;
use motiondb::character::{TRIANGLES_MAX, VERTICES_MAX};

use crate::character::bind_pose::BindPose;
use crate::character::joint_roles::SlotMap;
use crate::character::reason::{CharacterNote, CharacterReason};
use crate::read::gltf::document::Document;
use crate::read::gltf::node_tree::NodeTree;

/// Attributes of a vertex that are read.
pub(crate) const ATTRIBUTES: [Semantic; 10] = [
    Semantic::Positions,
    Semantic::Normals,
    Semantic::TexCoords(0),
    Semantic::TexCoords(1),
    Semantic::Colors(0),
    Semantic::Joints(0),
    Semantic::Weights(0),
    Semantic::Joints(1),
    Semantic::Weights(1),
    Semantic::TexCoords(2),
];

/// One primitive as a node draws it.
pub(crate) struct Instance<'a> {
    /// Name of the mesh, for messages.
    pub name: String,
    /// Name of the node that draws it, by which people know it.
    pub node: String,
    pub primitive: &'a Primitive,
    /// The node's slot.
    pub slot: usize,
    /// Index of the skin; none of a rigid mesh.
    pub skin: Option<usize>,
}

impl Instance<'_> {
    /// Whether a name is that of the mesh or of the node that draws it.
    pub(crate) fn is_called(&self, name: &str) -> bool {
        self.node == name || self.name == name
    }
}

/// All primitives of the character.
///
/// # Errors
/// [`CharacterReason::TooLarge`]: a small file can draw one mesh many times.
pub(crate) fn instances<'a>(
    document: &'a Document,
    tree: &NodeTree,
    pose: &BindPose,
    slots: &SlotMap,
    notes: &mut Vec<CharacterNote>,
) -> Result<Vec<Instance<'a>>, CharacterReason> {
    let root = &document.root;
    let is_moving = is_moving(pose, slots);
    let (mut instances, mut loose) = (Vec::new(), Vec::new());
    let (mut triangles, mut vertices) = (0_u64, 0_u64);
    let mut morph_targets = 0;
    for (slot, &node) in tree.order.iter().enumerate().filter(|(slot, _)| pose.is_in_scene[*slot]) {
        let node = &root.nodes[node];
        let Some(mesh) = node.mesh.and_then(|mesh| root.meshes.get(mesh.value())) else { continue };
        let name = mesh.name.clone().filter(|name| !name.is_empty()).unwrap_or_else(|| pose.names[slot].clone());
        let skin = node.skin.map(|skin| skin.value()).filter(|skin| *skin < pose.skins.len());
        if skin.is_none() && !is_moving[slot] {
            loose.push(name);
            continue;
        }
        for primitive in mesh.primitives.iter().filter(|primitive| draws_triangles(primitive)) {
            morph_targets += primitive.targets.as_ref().map_or(0, Vec::len);
            let count = |index: Option<usize>| {
                index.and_then(|index| root.accessors.get(index)).map_or(0, |accessor| accessor.count.0)
            };
            let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
            let of_positions = count(positions.map(|index| index.value()));
            let corners = primitive.indices.map_or(of_positions, |index| count(Some(index.value())));
            let per_corner = if primitive.mode == Checked::Valid(Mode::Triangles) { 3 } else { 1 };
            triangles = triangles.saturating_add(corners / per_corner);
            vertices = vertices.saturating_add(of_positions);
            check_sizes(triangles, vertices)?;
            instances.push(Instance { name: name.clone(), node: pose.names[slot].clone(), primitive, slot, skin });
        }
    }
    if morph_targets > 0 {
        notes.push(CharacterNote::MorphTargets(morph_targets));
    }
    if !loose.is_empty() {
        notes.push(CharacterNote::LooseMeshes(loose));
    }
    if instances.is_empty() { Err(CharacterReason::NoMesh) } else { Ok(instances) }
}

fn check_sizes(triangles: u64, vertices: u64) -> Result<(), CharacterReason> {
    let sizes = [(triangles, "triangles", TRIANGLES_MAX), (vertices, "vertices", VERTICES_MAX)];
    match sizes.into_iter().find(|(count, _, most)| *count > *most as u64) {
        Some((count, what, most)) => Err(CharacterReason::TooLarge { count, what, most }),
        None => Ok(()),
    }
}

pub(crate) fn draws_triangles(primitive: &Primitive) -> bool {
    let triangles = [Mode::Triangles, Mode::TriangleStrip, Mode::TriangleFan];
    matches!(primitive.mode, Checked::Valid(mode) if triangles.contains(&mode))
}

/// Whether a rigid mesh at each node moves with the body: it hangs from a joint of a skin, from a role, or from what the
/// pelvis hangs from below the scene's root.
fn is_moving(pose: &BindPose, slots: &SlotMap) -> Vec<bool> {
    let mut is_moving = pose.is_skin_joint.clone();
    let above = slots[Joint::Pelvis.index()].into_iter().flat_map(|pelvis| pose.with_ancestors(pelvis));
    let above = above.filter(|&slot| pose.parents[slot].is_some());
    above.chain(slots.iter().flatten().copied()).for_each(|slot| is_moving[slot] = true);
    // A parent comes before its children.
    for slot in 0..is_moving.len() {
        is_moving[slot] |= pose.parents[slot].is_some_and(|parent| is_moving[parent]);
    }
    is_moving
}
