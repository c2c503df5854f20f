//! One primitive: its triangles, and its vertices brought into the bind pose in body axes.
//!
//! Vertices of a skin are skinned into the bind pose, so that skins with different mesh spaces, and rigid meshes, share
//! one space.

use glam::{DMat3, DMat4, DVec3, DVec4};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use motiondb::character::WEIGHT_COUNT;

use crate::character::bind_pose::{BindPose, of_normals};
use crate::character::mesh_instances::Instance;
use crate::character::reason::CharacterReason;
use crate::error::RejectionReason;
use crate::read::gltf::accessor::{self, AccessorNumbers};
use crate::read::gltf::document::Document;

/// Greatest deviation of a sum of weights from 1 that is not reported: 8-bit weights round by as much.
const EVEN_WEIGHTS: f32 = 0.02;

/// The part of a mesh that one primitive gives.
pub(crate) struct Part {
    /// Positions in body axes; the origin is that of the bind space.
    pub positions_m: Vec<DVec3>,
    /// Normals; zero where the file has none.
    pub normals: Vec<DVec3>,
    /// Slots of the nodes that move a vertex, and weights that add up to 1.
    pub weights: Vec<[(usize, f32); WEIGHT_COUNT]>,
    pub triangles: Vec<[u32; 3]>,
    /// Vertices whose weights did not add up to 1.
    pub uneven: usize,
    /// Weights that are not finite, which count as 0.
    pub not_finite: usize,
    /// Vertices without weights.
    pub unweighted: usize,
}

/// Numbers of one attribute of a primitive; none where it has none.
pub(crate) fn attribute(
    document: &Document,
    primitive: &Primitive,
    semantic: Semantic,
    as_fractions: bool,
) -> Result<Option<AccessorNumbers>, CharacterReason> {
    let of = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).map(|index| index.value());
    let count = |index: Option<usize>| Some(document.root.accessors.get(index?)?.count.0);
    let (index, positions) = (of(semantic.clone()), of(Semantic::Positions));
    let Some(index) = index else { return Ok(None) };
    // A small file may name one long list for many short meshes.
    if count(Some(index)) != count(positions) {
        let problem = "it has another number of elements than the positions".to_owned();
        let remedy = "check it with the glTF validator, or export it again";
        return Err(RejectionReason::Malformed { position: format!("accessor {index}"), problem, remedy }.into());
    }
    Ok(Some(accessor::numbers(document, index, as_fractions)?))
}

/// Reads a primitive; `to_body` turns bind space into body axes, `pelvis` is the pelvis's slot.
pub(crate) fn read(
    document: &Document,
    pose: &BindPose,
    instance: &Instance,
    to_body: &DMat4,
    pelvis: usize,
) -> Result<Part, CharacterReason> {
    let primitive = instance.primitive;
    let positions = vectors(document, instance, Semantic::Positions)?.unwrap_or_default();
    let normals = vectors(document, instance, Semantic::Normals)?.unwrap_or_default();
    let mut part = Part {
        positions_m: Vec::with_capacity(positions.len()),
        normals: vec![DVec3::ZERO; positions.len()],
        weights: Vec::with_capacity(positions.len()),
        triangles: triangles(document, instance, positions.len())?,
        uneven: 0,
        not_finite: 0,
        unweighted: 0,
    };
    let influences = Influences::new(document, instance, pose, pelvis)?;
    part.not_finite = influences.not_finite;
    let matrices: Vec<DMat4> = influences.matrices.iter().map(|matrix| *to_body * *matrix).collect();
    let of_normals: Vec<(DMat3, bool)> = matrices.iter().map(of_normals).collect();
    let mut mirrored = 0;
    for (vertex, position) in positions.iter().enumerate() {
        let (weights, sum) = influences.of_vertex(vertex);
        part.uneven += usize::from(sum > 0.0 && (sum - 1.0).abs() > EVEN_WEIGHTS);
        part.unweighted += usize::from(sum == 0.0);
        let blended = |moved: &dyn Fn(usize) -> DVec3| {
            weights.iter().map(|&(index, weight)| f64::from(weight) * moved(index)).sum::<DVec3>()
        };
        part.positions_m.push(blended(&|index| matrices[index].transform_point3(*position)));
        if let Some(normal) = normals.get(vertex) {
            part.normals[vertex] = blended(&|index| of_normals[index].0 * *normal).normalize_or_zero();
        }
        mirrored += usize::from(of_normals[weights[0].0].1);
        part.weights.push(weights.map(|(index, weight)| (influences.slots[index], weight)));
    }
    if part.positions_m.iter().any(|position_m| !position_m.is_finite()) {
        return Err(CharacterReason::NotFinite { part: format!("positions of mesh `{}`", instance.name) });
    }
    if 2 * mirrored > positions.len() {
        part.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    if primitive.attributes.is_empty() {
        part.triangles.clear();
    }
    Ok(part)
}

fn vectors(
    document: &Document,
    instance: &Instance,
    semantic: Semantic,
) -> Result<Option<Vec<DVec3>>, CharacterReason> {
    let Some(numbers) = attribute(document, instance.primitive, semantic, false)? else { return Ok(None) };
    if numbers.width != 3 {
        return malformed(instance, "positions or normals without three numbers each");
    }
    let vector = |values: &[f32]| DVec3::new(values[0].into(), values[1].into(), values[2].into());
    Ok(Some(numbers.values.chunks_exact(3).map(vector).collect()))
}

fn malformed<T>(instance: &Instance, problem: &str) -> Result<T, CharacterReason> {
    let position = format!("mesh `{}`", instance.name);
    let reason = RejectionReason::Malformed {
        position,
        problem: format!("it has {problem}"),
        remedy: "check it with the glTF validator, or export it again",
    };
    Err(CharacterReason::File(reason))
}

/// The triangles of a primitive of so many vertices; strips and fans as single triangles.
fn triangles(document: &Document, instance: &Instance, count: usize) -> Result<Vec<[u32; 3]>, CharacterReason> {
    let corners: Vec<u32> = match instance.primitive.indices {
        Some(indices) => {
            let numbers = accessor::numbers(document, indices.value(), false)?.values;
            // Indices over 2²⁴ are rounded, but there are no so many vertices.
            if numbers.iter().any(|&index| !(index >= 0.0 && index < count as f32)) {
                return malformed(instance, "a triangle that names a vertex that does not exist");
            }
            numbers.into_iter().map(|index| index as u32).collect()
        }
        None => (0..count as u32).collect(),
    };
    let Checked::Valid(mode) = instance.primitive.mode else { return Ok(Vec::new()) };
    Ok(match mode {
        Mode::TriangleStrip => {
            let turned = |(index, corners): (usize, &[u32])| match index % 2 {
                0 => [corners[0], corners[1], corners[2]],
                _ => [corners[1], corners[0], corners[2]],
            };
            corners.windows(3).enumerate().map(turned).collect()
        }
        Mode::TriangleFan => {
            corners.get(1..).unwrap_or(&[]).windows(2).map(|pair| [corners[0], pair[0], pair[1]]).collect()
        }
        _ => corners.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect(),
    })
}

/// What moves the vertices of a primitive.
struct Influences {
    /// Slots of the joints; of a rigid mesh its own node. The last one is the pelvis, for vertices without weights.
    slots: Vec<usize>,
    /// Mesh space → bind space, by joint.
    matrices: Vec<DMat4>,
    /// Joint and weight, [`Influences::per_vertex`] for each vertex; empty for a rigid mesh.
    pairs: Vec<(usize, f32)>,
    per_vertex: usize,
    /// Weights that are not finite, which count as 0.
    not_finite: usize,
    /// Whether the mesh has no skin.
    is_rigid: bool,
}

impl Influences {
    fn new(document: &Document, instance: &Instance, pose: &BindPose, pelvis: usize) -> Result<Self, CharacterReason> {
        let Some(skin) = instance.skin.map(|skin| &pose.skins[skin]) else {
            let slots = vec![instance.slot];
            let matrices = vec![pose.bind[instance.slot]];
            return Ok(Self { slots, matrices, pairs: Vec::new(), per_vertex: 0, not_finite: 0, is_rigid: true });
        };
        let mut slots = skin.slots.clone();
        let mut matrices: Vec<DMat4> =
            slots.iter().zip(&skin.inverse_bind).map(|(&slot, inverse)| pose.bind[slot] * *inverse).collect();
        let without_weights = matrices.first().copied().unwrap_or(DMat4::IDENTITY);
        slots.push(pelvis);
        matrices.push(without_weights);
        let mut lists = Vec::new();
        for set in 0..2 {
            let joints = attribute(document, instance.primitive, Semantic::Joints(set), false)?;
            let weights = attribute(document, instance.primitive, Semantic::Weights(set), true)?;
            let (Some(joints), Some(weights)) = (joints, weights) else { break };
            if joints.width != 4 || weights.width != 4 {
                return malformed(instance, "joints or weights without four numbers each");
            }
            lists.push((joints.values, weights.values));
        }
        let count = lists.iter().map(|(joints, weights)| joints.len().min(weights.len()) / 4).min().unwrap_or(0);
        let mut pairs = Vec::with_capacity(count * 4 * lists.len());
        let mut not_finite = 0;
        for vertex in 0..count {
            for (joints, weights) in &lists {
                for index in 4 * vertex..4 * vertex + 4 {
                    not_finite += usize::from(!weights[index].is_finite());
                    let weight = if weights[index].is_finite() { weights[index].max(0.0) } else { 0.0 };
                    if weight > 0.0 && !(joints[index] >= 0.0 && (joints[index] as usize) < skin.slots.len()) {
                        return malformed(instance, "a weight of a joint that its skin does not have");
                    }
                    pairs.push((if weight > 0.0 { joints[index] as usize } else { 0 }, weight));
                }
            }
        }
        Ok(Self { slots, matrices, pairs, per_vertex: 4 * lists.len(), not_finite, is_rigid: false })
    }

    /// The greatest weights of a vertex, falling, scaled to add up to 1; and the sum of all.
    fn of_vertex(&self, vertex: usize) -> ([(usize, f32); WEIGHT_COUNT], f32) {
        let mut kept = [(self.slots.len() - 1, 0.0); WEIGHT_COUNT];
        let pairs = self.pairs.get(vertex * self.per_vertex..(vertex + 1) * self.per_vertex).unwrap_or(&[]);
        if pairs.is_empty() {
            kept[0].1 = 1.0;
            return (kept, if self.is_rigid { 1.0 } else { 0.0 });
        }
        let mut merged: Vec<(usize, f32)> = Vec::with_capacity(pairs.len());
        for &(joint, weight) in pairs.iter().filter(|(_, weight)| *weight > 0.0) {
            match merged.iter_mut().find(|(other, _)| *other == joint) {
                Some((_, sum)) => *sum += weight,
                None => merged.push((joint, weight)),
            }
        }
        merged.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let sum: f32 = merged.iter().map(|(_, weight)| weight).sum();
        let kept_sum: f32 = merged.iter().take(WEIGHT_COUNT).map(|(_, weight)| weight).sum();
        if !(kept_sum > 0.0 && kept_sum.is_finite()) {
            kept[0].1 = 1.0;
            return (kept, 0.0);
        }
        for (slot, (joint, weight)) in kept.iter_mut().zip(merged) {
            *slot = (joint, weight / kept_sum);
        }
        (kept, sum)
    }
}

/// A colour attribute of a primitive: RGBA of each vertex; white where it has none.
pub(crate) fn vertex_colours(
    document: &Document,
    primitive: &Primitive,
    count: usize,
) -> Result<Vec<DVec4>, CharacterReason> {
    let mut colours = vec![DVec4::ONE; count];
    if let Some(numbers) = attribute(document, primitive, Semantic::Colors(0), true)?
        && numbers.width >= 3
    {
        for (colour, values) in colours.iter_mut().zip(numbers.values.chunks_exact(numbers.width)) {
            let alpha = values.get(3).copied().unwrap_or(1.0);
            let given = DVec4::new(values[0].into(), values[1].into(), values[2].into(), alpha.into());
            if given.is_finite() {
                *colour = given.clamp(DVec4::ZERO, DVec4::ONE);
            }
        }
    }
    Ok(colours)
}
