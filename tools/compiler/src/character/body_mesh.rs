//! All parts of a character as one mesh: colours from materials and textures, hidden triangles left out, normals where
//! the file has none.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;
use gltf::json::Material as GltfMaterial;
use gltf::json::material::AlphaMode;
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use motiondb::character::{Material, WEIGHT_COUNT};

use crate::character::mesh_instances::Instance;
use crate::character::primitive::{self, Part};
use crate::character::reason::{CharacterNote, CharacterReason};
use crate::character::texture::{self, Texture};
use crate::read::gltf::buffers::Outside;
use crate::read::gltf::document::Document;

/// Alpha below which a blended material hides a triangle.
const BLEND_CUTOFF: f32 = 0.1;
/// Alpha below which a masked material hides a triangle, where the file states none.
const MASK_CUTOFF: f32 = 0.5;
/// Parts of names of materials whose hue does not vary: bodies' own colours.
const OWN_COLOURS: [&str; 12] =
    ["skin", "face", "head", "eye", "hair", "mouth", "teeth", "tongue", "brow", "lip", "hand", "body"];

/// One mesh in body axes. Lists are by vertex but triangles and materials.
#[derive(Default)]
pub(crate) struct BodyMesh {
    pub positions_m: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    pub colours: Vec<[f32; 3]>,
    /// Slots of nodes and weights.
    pub weights: Vec<[(usize, f32); WEIGHT_COUNT]>,
    pub triangles: Vec<[u32; 3]>,
    pub materials: Vec<Material>,
}

/// Reads textures, and adds parts to a mesh.
pub(crate) struct MeshBuilder<'a> {
    document: &'a Document,
    path: &'a Path,
    outside: Outside,
    linear: [f32; 256],
    pub mesh: BodyMesh,
    unread: Vec<String>,
    hidden: usize,
    uneven: usize,
    unweighted: usize,
}

impl<'a> MeshBuilder<'a> {
    pub(crate) fn new(document: &'a Document, path: &'a Path, outside: Outside) -> Self {
        Self {
            document,
            path,
            outside,
            linear: texture::linear_values(),
            mesh: BodyMesh::default(),
            unread: Vec::new(),
            hidden: 0,
            uneven: 0,
            unweighted: 0,
        }
    }

    /// Adds all parts, textures one at a time: a material's parts come together.
    pub(crate) fn add_all(&mut self, parts: Vec<(Instance<'a>, Part)>) -> Result<(), CharacterReason> {
        let mut room = texture::PIXELS_MAX;
        let texture_of = |instance: &Instance| self.material(instance).and_then(base_texture).map(|(index, _)| index);
        let mut by_texture: BTreeMap<Option<usize>, Vec<(Instance<'a>, Part)>> = BTreeMap::new();
        for (instance, part) in parts {
            by_texture.entry(texture_of(&instance)).or_default().push((instance, part));
        }
        for (index, parts) in by_texture {
            let texture = match index {
                Some(index) => {
                    let texture = texture::read(self.document, self.path, self.outside, index, &mut room)?;
                    if texture.is_none() {
                        self.unread.push(texture::name(&self.document.root, index));
                    }
                    texture
                }
                None => None,
            };
            for (instance, part) in parts {
                self.add(&instance, part, texture.as_ref())?;
            }
        }
        Ok(())
    }

    fn material(&self, instance: &Instance) -> Option<&'a GltfMaterial> {
        self.document.root.materials.get(instance.primitive.material?.value())
    }

    fn add(&mut self, instance: &Instance, part: Part, texture: Option<&Texture>) -> Result<(), CharacterReason> {
        let material = self.material(instance);
        let colours = self.colours(instance, part.positions_m.len(), material, texture)?;
        let cutoff = material.map_or(0.0, cutoff);
        let is_shown = |triangle: &[u32; 3]| triangle.iter().any(|&vertex| colours[vertex as usize][3] >= cutoff);
        let count = part.triangles.len();
        let mut shown = part.triangles;
        shown.retain(is_shown);
        self.hidden += count - shown.len();
        self.uneven += part.uneven;
        self.unweighted += part.unweighted;

        let mut places: Vec<Option<u32>> = vec![None; part.positions_m.len()];
        let mesh = &mut self.mesh;
        for corner in shown.as_flattened_mut() {
            let vertex = *corner as usize;
            *corner = *places[vertex].get_or_insert_with(|| {
                mesh.positions_m.push(part.positions_m[vertex]);
                mesh.normals.push(part.normals[vertex]);
                mesh.weights.push(part.weights[vertex]);
                let [red, green, blue, _] = colours[vertex];
                mesh.colours.push([red, green, blue]);
                mesh.positions_m.len() as u32 - 1
            });
        }
        let name = material.and_then(|material| material.name.clone()).unwrap_or_default();
        let lower = name.to_lowercase();
        mesh.materials.push(Material {
            triangle_count: shown.len() as u32,
            is_double_sided: material.is_some_and(|material| material.double_sided),
            keeps_hue: OWN_COLOURS.iter().any(|own| lower.contains(own)),
            name,
        });
        mesh.triangles.extend(shown);
        Ok(())
    }

    /// RGBA of each vertex: factor of the material × vertex colour × texture.
    fn colours(
        &self,
        instance: &Instance,
        count: usize,
        material: Option<&GltfMaterial>,
        texture: Option<&Texture>,
    ) -> Result<Vec<[f32; 4]>, CharacterReason> {
        let factor = material.map_or([1.0; 4], |material| material.pbr_metallic_roughness.base_color_factor.0);
        let factor = factor.map(|part| if part.is_finite() { part.clamp(0.0, 1.0) } else { 1.0 });
        let mut colours: Vec<[f32; 4]> = primitive::vertex_colours(self.document, instance.primitive, count)?
            .into_iter()
            .map(|colour| std::array::from_fn(|part| factor[part] * colour.to_array()[part] as f32))
            .collect();
        let (Some(texture), Some((_, set))) = (texture, material.and_then(base_texture)) else { return Ok(colours) };
        let semantic = Semantic::TexCoords(set);
        if let Some(numbers) = primitive::attribute(self.document, instance.primitive, semantic, false)?
            && numbers.width == 2
        {
            for (colour, uv) in colours.iter_mut().zip(numbers.values.chunks_exact(2)) {
                let sampled = texture.colour([uv[0], uv[1]], &self.linear);
                colour.iter_mut().zip(sampled).for_each(|(part, sampled)| *part *= sampled);
            }
        }
        Ok(colours)
    }

    /// The mesh with all normals, and notes about what was left out.
    pub(crate) fn finish(mut self, notes: &mut Vec<CharacterNote>) -> BodyMesh {
        complete_normals(&mut self.mesh);
        if !self.unread.is_empty() {
            notes.push(CharacterNote::UnreadTextures(self.unread));
        }
        let counted = [
            CharacterNote::MaskedTriangles(self.hidden),
            CharacterNote::UnevenWeights(self.uneven),
            CharacterNote::UnweightedVertices(self.unweighted),
        ];
        let counts = [self.hidden, self.uneven, self.unweighted];
        notes.extend(counted.into_iter().zip(counts).filter(|(_, count)| *count > 0).map(|(note, _)| note));
        self.mesh
    }
}

/// The texture of a material's colour, and its set of coordinates.
fn base_texture(material: &GltfMaterial) -> Option<(usize, u32)> {
    let info = material.pbr_metallic_roughness.base_color_texture.as_ref()?;
    Some((info.index.value(), info.tex_coord))
}

/// Alpha below which a triangle is hidden.
fn cutoff(material: &GltfMaterial) -> f32 {
    match material.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => material.alpha_cutoff.map_or(MASK_CUTOFF, |cutoff| cutoff.0),
        Checked::Valid(AlphaMode::Blend) => BLEND_CUTOFF,
        _ => 0.0,
    }
}

/// Gives vertices without normal the mean of their triangles', by area, over all vertices at the same position.
fn complete_normals(mesh: &mut BodyMesh) {
    if mesh.normals.iter().all(|normal| *normal != DVec3::ZERO) {
        return;
    }
    let key = |position_m: DVec3| position_m.to_array().map(|part| (part as f32).to_bits());
    let mut sums: BTreeMap<[u32; 3], DVec3> = BTreeMap::new();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| mesh.positions_m[vertex as usize]);
        let normal = (b - a).cross(c - a);
        for corner in [a, b, c] {
            *sums.entry(key(corner)).or_default() += normal;
        }
    }
    for (normal, position_m) in mesh.normals.iter_mut().zip(&mesh.positions_m) {
        if *normal == DVec3::ZERO {
            let sum = sums.get(&key(*position_m)).copied().unwrap_or_default();
            *normal = sum.try_normalize().unwrap_or(DVec3::Z);
        }
    }
}
