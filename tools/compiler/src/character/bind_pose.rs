//! The bind pose: where every node was when the meshes were bound.
//!
//! A skin's inverse bind matrices state it, not the nodes' rest: these differ by scale (100 or 0.01 above the joints), by
//! axes (Z-up centimetres under a Y-up node), and sometimes by pose. The skin with the most joints gives the space;
//! other skins are moved into it by a joint that both have; other nodes follow their parent or child at rest. The
//! space is scaled to metres by the nodes' rest, in the skin's own axes.

use glam::{DMat3, DMat4, DQuat, DVec3};
use gltf::json::Root;

use crate::character::reason::CharacterReason;
use crate::error::RejectionReason;
use crate::read::gltf::accessor;
use crate::read::gltf::document::Document;
use crate::read::gltf::node_tree::NodeTree;

/// Greatest number of inverse bind matrices of all skins.
const MATRICES_MAX: usize = 1 << 20;
/// Least absolute determinant of a matrix that is inverted.
const DETERMINANT_MIN: f64 = 1e-24;

/// One skin: its joints and their inverse bind matrices.
pub(crate) struct Skin {
    /// Slots of the joints.
    pub slots: Vec<usize>,
    /// Mesh space → joint.
    pub inverse_bind: Vec<DMat4>,
}

/// All nodes of a document in the pose in which meshes were bound. Lists are by slot of the node tree.
pub(crate) struct BindPose {
    /// Names; empty where a node has none.
    pub names: Vec<String>,
    /// Slots of parents.
    pub parents: Vec<Option<usize>>,
    /// Slot of each node.
    pub slot_of: Vec<usize>,
    /// Node → bind space, metres.
    pub bind: Vec<DMat4>,
    /// Node → world at rest.
    pub world: Vec<DMat4>,
    /// Whether a node is drawn: it hangs from the document's scene.
    pub is_in_scene: Vec<bool>,
    /// Whether a node is a joint of a skin.
    pub is_skin_joint: Vec<bool>,
    /// All skins of the document.
    pub skins: Vec<Skin>,
}

impl BindPose {
    pub(crate) fn new(document: &Document, tree: &NodeTree) -> Result<Self, CharacterReason> {
        let root = &document.root;
        let rest = document.rest_transforms();
        let mut slot_of = vec![0; tree.order.len()];
        tree.order.iter().enumerate().for_each(|(slot, &node)| slot_of[node] = slot);
        let local: Vec<DMat4> = tree
            .order
            .iter()
            .map(|&node| {
                DMat4::from_scale_rotation_translation(rest[node].scale, rest[node].rotation, rest[node].translation)
            })
            .collect();
        let mut world = local.clone();
        for slot in 0..world.len() {
            if let Some(parent) = tree.parents[slot] {
                world[slot] = world[parent] * local[slot];
            }
        }
        let skins = skins(document, &slot_of)?;
        let mut is_skin_joint = vec![false; tree.order.len()];
        skins.iter().flat_map(|skin| &skin.slots).for_each(|&slot| is_skin_joint[slot] = true);
        let name = |&node: &usize| root.nodes[node].name.clone().unwrap_or_default();
        let bind = bind(tree, &local, &world, &skins);
        if let Some(slot) = bind.iter().position(|bind| !bind.is_finite()) {
            let part = format!("node {}", tree.order[slot]);
            return Err(CharacterReason::NotFinite { part });
        }
        Ok(Self {
            names: tree.order.iter().map(name).collect(),
            parents: tree.parents.clone(),
            is_in_scene: is_in_scene(root, tree, &slot_of),
            slot_of,
            bind,
            world,
            is_skin_joint,
            skins,
        })
    }

    /// Position of a node in bind space, m.
    pub(crate) fn position_m(&self, slot: usize) -> DVec3 {
        self.bind[slot].w_axis.truncate()
    }

    /// Orientation of a node in bind space.
    pub(crate) fn orientation(&self, slot: usize) -> DQuat {
        let (_, rotation, _) = self.bind[slot].to_scale_rotation_translation();
        if rotation.is_finite() && rotation.length() > 0.5 { rotation.normalize() } else { DQuat::IDENTITY }
    }

    /// The nodes from one to its root.
    pub(crate) fn with_ancestors(&self, slot: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(slot), |&slot| self.parents[slot])
    }
}

/// Slots that hang from the scene; all where the document has no scene.
fn is_in_scene(root: &Root, tree: &NodeTree, slot_of: &[usize]) -> Vec<bool> {
    let scene = root.scene.map_or(0, |scene| scene.value());
    let Some(scene) = root.scenes.get(scene) else { return vec![true; tree.order.len()] };
    let mut is_in_scene = vec![false; tree.order.len()];
    for node in &scene.nodes {
        if let Some(&slot) = slot_of.get(node.value()) {
            is_in_scene[slot] = true;
        }
    }
    for slot in 0..is_in_scene.len() {
        is_in_scene[slot] |= tree.parents[slot].is_some_and(|parent| is_in_scene[parent]);
    }
    is_in_scene
}

fn skins(document: &Document, slot_of: &[usize]) -> Result<Vec<Skin>, CharacterReason> {
    let matrices = document.root.skins.iter().filter_map(|skin| skin.inverse_bind_matrices);
    let accessors = matrices.filter_map(|index| document.root.accessors.get(index.value()));
    let count = accessors.fold(0_u64, |sum, accessor| sum.saturating_add(accessor.count.0));
    if count > MATRICES_MAX as u64 {
        return Err(CharacterReason::TooLarge { count, what: "inverse bind matrices", most: MATRICES_MAX });
    }
    let skin = |(index, skin): (usize, &gltf::json::Skin)| {
        let slots: Vec<usize> = skin.joints.iter().map(|joint| slot_of[joint.value()]).collect();
        let Some(matrices) = skin.inverse_bind_matrices else {
            return Ok(Skin { inverse_bind: vec![DMat4::IDENTITY; slots.len()], slots });
        };
        let numbers = accessor::numbers(document, matrices.value(), false)?;
        let part = || format!("inverse bind matrices of skin {index}");
        if numbers.width != 16 || numbers.values.len() < 16 * slots.len() {
            let problem = "they are fewer than its joints";
            let reason =
                RejectionReason::Malformed { position: part(), problem: problem.into(), remedy: "export it again" };
            return Err(reason.into());
        }
        let matrix = |values: &[f32]| {
            let columns: [f64; 16] = std::array::from_fn(|index| f64::from(values[index]));
            DMat4::from_cols_array(&columns)
        };
        let inverse_bind: Vec<DMat4> = numbers.values.chunks_exact(16).take(slots.len()).map(matrix).collect();
        match inverse_bind.iter().all(DMat4::is_finite) {
            true => Ok(Skin { slots, inverse_bind }),
            false => Err(CharacterReason::NotFinite { part: part() }),
        }
    };
    document.root.skins.iter().enumerate().map(skin).collect()
}

/// Node → bind space, for every slot.
fn bind(tree: &NodeTree, local: &[DMat4], world: &[DMat4], skins: &[Skin]) -> Vec<DMat4> {
    let mut bind: Vec<Option<DMat4>> = vec![None; tree.order.len()];
    let mut by_size: Vec<&Skin> = skins.iter().collect();
    by_size.sort_by_key(|skin| std::cmp::Reverse(skin.slots.len()));
    let to_metres = by_size.first().map_or(DMat4::IDENTITY, |skin| to_metres(skin, world));
    for (index, skin) in by_size.iter().enumerate() {
        let joints = skin.slots.iter().zip(&skin.inverse_bind);
        let shared = joints.clone().find_map(|(&slot, inverse)| Some(bind[slot]? * *inverse));
        // A skin that shares no joint with those before keeps its nodes' rest.
        let Some(to_bind) = shared.or((index == 0).then_some(to_metres)) else { continue };
        for (&slot, inverse) in joints {
            bind[slot] = bind[slot].or_else(|| inverted(inverse).map(|matrix| to_bind * matrix));
        }
    }
    // What differs between bind space and the world at rest, at any known node.
    let known = (0..bind.len()).find_map(|slot| Some(bind[slot]? * inverted(&world[slot])?));
    for slot in (0..bind.len()).rev() {
        if let (Some(own), Some(parent)) = (bind[slot], tree.parents[slot])
            && bind[parent].is_none()
        {
            bind[parent] = inverted(&local[slot]).map(|inverse| own * inverse);
        }
    }
    for slot in 0..bind.len() {
        let below = || tree.parents[slot].and_then(|parent| bind[parent]).map(|parent| parent * local[slot]);
        bind[slot] = bind[slot].or_else(below).or_else(|| known.map(|known| known * world[slot]));
    }
    bind.iter().zip(world).map(|(bind, world)| bind.unwrap_or(*world)).collect()
}

/// The scale from a skin's mesh space to metres: the median over its joints at rest. A mirrored space is mirrored back.
fn to_metres(skin: &Skin, world: &[DMat4]) -> DMat4 {
    let joints = skin.slots.iter().zip(&skin.inverse_bind);
    let mut volumes: Vec<f64> = joints.map(|(&slot, inverse)| (world[slot] * *inverse).determinant()).collect();
    volumes.retain(|volume| volume.is_finite() && volume.abs() > DETERMINANT_MIN);
    volumes.sort_by(f64::total_cmp);
    let Some(&volume) = volumes.get(volumes.len() / 2) else { return DMat4::IDENTITY };
    let scale = libm::cbrt(volume.abs());
    DMat4::from_scale(DVec3::new(if volume < 0.0 { -scale } else { scale }, scale, scale))
}

fn inverted(matrix: &DMat4) -> Option<DMat4> {
    let inverse = matrix.inverse();
    (matrix.determinant().abs() > DETERMINANT_MIN && inverse.is_finite()).then_some(inverse)
}

/// The matrix that turns normals as `matrix` moves points, and whether `matrix` mirrors.
pub(crate) fn of_normals(matrix: &DMat4) -> (DMat3, bool) {
    let linear = DMat3::from_mat4(*matrix);
    let determinant = linear.determinant();
    let inverse = linear.inverse().transpose();
    let normals = if determinant.abs() > DETERMINANT_MIN && inverse.is_finite() { inverse } else { linear };
    (normals, determinant < 0.0)
}
