//! All parts of a character as one mesh: colours from materials and textures, hidden triangles left out, normals where
//! the file has none.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;
use gltf::json::Material as GltfMaterial;
use gltf::json::material::AlphaMode;
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use motiondb::character::{CharacterTexture, CutOut, Material, TEXTURE_PIXELS_MAX, WEIGHT_COUNT, linear_values};

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
/// Number of steps along a triangle's side at which its texture is looked at.
const LOOKS: usize = 6;
/// Greatest texture coordinate.
const UV_MAX: f32 = 1024.0;
/// Parts of names of materials whose hue does not vary: bodies' own colours.
const OWN_COLOURS: [&str; 12] =
    ["skin", "face", "head", "eye", "hair", "mouth", "teeth", "tongue", "brow", "lip", "hand", "body"];

/// One mesh in body axes. Lists are by vertex but triangles and materials.
#[derive(Default)]
pub(crate) struct BodyMesh {
    pub positions_m: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    pub colours: Vec<[f32; 3]>,
    /// Texture coordinates and colours without texture.
    pub uvs: Vec<[f32; 2]>,
    pub tints: Vec<[f32; 3]>,
    /// Slots of nodes and weights.
    pub weights: Vec<[(usize, f32); WEIGHT_COUNT]>,
    pub triangles: Vec<[u32; 3]>,
    pub materials: Vec<Material>,
    pub textures: Vec<CharacterTexture>,
}

/// Colours of the vertices of a part.
struct Coloured {
    /// RGBA with the texture.
    colours: Vec<[f32; 4]>,
    /// RGB and alpha without the texture.
    tints: Vec<[f32; 4]>,
    /// Texture coordinates; empty without a texture.
    uvs: Vec<[f32; 2]>,
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
    not_finite: usize,
    unweighted: usize,
}

impl<'a> MeshBuilder<'a> {
    pub(crate) fn new(document: &'a Document, path: &'a Path, outside: Outside) -> Self {
        Self {
            document,
            path,
            outside,
            linear: linear_values(),
            mesh: BodyMesh::default(),
            unread: Vec::new(),
            hidden: 0,
            uneven: 0,
            not_finite: 0,
            unweighted: 0,
        }
    }

    /// Adds all parts, textures one at a time: a material's parts come together.
    pub(crate) fn add_all(&mut self, parts: Vec<(Instance<'a>, Part)>) -> Result<(), CharacterReason> {
        let texture_of = |instance: &Instance| self.material(instance).and_then(base_texture).map(|(index, _)| index);
        let mut by_texture: BTreeMap<Option<usize>, Vec<(Instance<'a>, Part)>> = BTreeMap::new();
        for (instance, part) in parts {
            by_texture.entry(texture_of(&instance)).or_default().push((instance, part));
        }
        texture::check_sizes(self.document, self.path, self.outside, by_texture.keys().copied().flatten())?;
        for (index, parts) in by_texture {
            let texture = match index {
                Some(index) => {
                    let texture = texture::read(self.document, self.path, self.outside, index)?;
                    if texture.is_none() {
                        self.unread.push(texture::name(&self.document.root, index));
                    }
                    texture
                }
                None => None,
            };
            let count = self.mesh.materials.len();
            for (instance, part) in parts {
                self.add(&instance, part, texture.as_ref())?;
            }
            if let Some(texture) = &texture {
                self.keep(texture, count);
            }
        }
        Ok(())
    }

    /// Keeps a texture for those of the materials from an index on that have coordinates; the largest textures are halved
    /// until all are within bounds.
    fn keep(&mut self, texture: &Texture, first: usize) {
        let mesh = &mut self.mesh;
        if !mesh.materials[first..].iter().any(|material| material.texture.is_some() && material.triangle_count > 0) {
            return mesh.materials[first..].iter_mut().for_each(|material| material.texture = None);
        }
        mesh.textures.push(texture.kept(&self.linear));
        while mesh.textures.iter().map(CharacterTexture::pixel_count).sum::<usize>() > TEXTURE_PIXELS_MAX {
            let largest = mesh.textures.iter_mut().rev().max_by_key(|texture| texture.pixel_count());
            largest.into_iter().for_each(|texture| *texture = texture.halved(&self.linear));
        }
    }

    fn material(&self, instance: &Instance) -> Option<&'a GltfMaterial> {
        self.document.root.materials.get(instance.primitive.material?.value())
    }

    fn add(&mut self, instance: &Instance, part: Part, texture: Option<&Texture>) -> Result<(), CharacterReason> {
        let material = self.material(instance);
        let coloured = self.coloured(instance, part.positions_m.len(), material, texture)?;
        let has_texture = !coloured.uvs.is_empty();
        let cut_out = material.map_or(CutOut::Opaque, cut_out);
        let count = part.triangles.len();
        let mut shown = part.triangles;
        shown.retain(|triangle| self.is_shown(triangle, &coloured, texture, cut_out));
        self.hidden += count - shown.len();
        self.uneven += part.uneven;
        self.not_finite += part.not_finite;
        self.unweighted += part.unweighted;

        let mut places: Vec<Option<u32>> = vec![None; part.positions_m.len()];
        let mesh = &mut self.mesh;
        let rgb = |[red, green, blue, _]: [f32; 4]| [red, green, blue];
        for corner in shown.as_flattened_mut() {
            let vertex = *corner as usize;
            *corner = *places[vertex].get_or_insert_with(|| {
                mesh.positions_m.push(part.positions_m[vertex]);
                mesh.normals.push(part.normals[vertex]);
                mesh.weights.push(part.weights[vertex]);
                mesh.colours.push(rgb(coloured.colours[vertex]));
                mesh.tints.push(rgb(coloured.tints[vertex]));
                mesh.uvs.push(coloured.uvs.get(vertex).copied().unwrap_or_default());
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
            mesh: instance.node.clone(),
            texture: has_texture.then_some(mesh.textures.len() as u32),
            cut_out: if has_texture { cut_out } else { CutOut::Opaque },
        });
        mesh.triangles.extend(shown);
        Ok(())
    }

    /// Whether any of the points that are looked at is not transparent.
    fn is_shown(&self, triangle: &[u32; 3], coloured: &Coloured, texture: Option<&Texture>, cut_out: CutOut) -> bool {
        let cutoff = match cut_out {
            CutOut::Opaque => return true,
            CutOut::Below(alpha) => alpha,
            CutOut::Blended => BLEND_CUTOFF,
        };
        let corners = triangle.map(|vertex| vertex as usize);
        if corners.iter().any(|&vertex| coloured.colours[vertex][3] >= cutoff) {
            return true;
        }
        let Some(texture) = texture.filter(|_| !coloured.uvs.is_empty()) else { return false };
        let tint = corners.iter().map(|&vertex| coloured.tints[vertex][3]).fold(0.0, f32::max);
        let uvs = corners.map(|vertex| coloured.uvs[vertex]);
        barycentric_points().any(|weights| {
            let uv = [0, 1].map(|axis| (0..3).map(|corner| weights[corner] * uvs[corner][axis]).sum::<f32>());
            tint * texture.colour(uv, &self.linear)[3] >= cutoff
        })
    }

    /// Factor of the material × vertex colour, and both × texture.
    fn coloured(
        &self,
        instance: &Instance,
        count: usize,
        material: Option<&GltfMaterial>,
        texture: Option<&Texture>,
    ) -> Result<Coloured, CharacterReason> {
        let factor = material.map_or([1.0; 4], |material| material.pbr_metallic_roughness.base_color_factor.0);
        let factor = factor.map(|part| if part.is_finite() { part.clamp(0.0, 1.0) } else { 1.0 });
        let tints: Vec<[f32; 4]> = primitive::vertex_colours(self.document, instance.primitive, count)?
            .into_iter()
            .map(|colour| std::array::from_fn(|part| factor[part] * colour.to_array()[part] as f32))
            .collect();
        let mut coloured = Coloured { colours: tints.clone(), tints, uvs: Vec::new() };
        let (Some(texture), Some((_, set))) = (texture, material.and_then(base_texture)) else { return Ok(coloured) };
        let semantic = Semantic::TexCoords(set);
        if let Some(numbers) = primitive::attribute(self.document, instance.primitive, semantic, false)?
            && numbers.width == 2
        {
            let within = |part: f32| if part.is_finite() { part.clamp(-UV_MAX, UV_MAX) } else { 0.0 };
            coloured.uvs = numbers.values.chunks_exact(2).map(|uv| [within(uv[0]), within(uv[1])]).collect();
            for (colour, uv) in coloured.colours.iter_mut().zip(&coloured.uvs) {
                let sampled = texture.colour(*uv, &self.linear);
                colour.iter_mut().zip(sampled).for_each(|(part, sampled)| *part *= sampled);
            }
        }
        Ok(coloured)
    }

    /// The mesh with all normals, and notes about what was left out.
    pub(crate) fn finish(mut self, notes: &mut Vec<CharacterNote>) -> BodyMesh {
        complete_normals(&mut self.mesh);
        if self.mesh.textures.is_empty() {
            (self.mesh.uvs, self.mesh.tints) = (Vec::new(), Vec::new());
        }
        if !self.unread.is_empty() {
            notes.push(CharacterNote::UnreadTextures(self.unread));
        }
        let counted = [
            CharacterNote::MaskedTriangles(self.hidden),
            CharacterNote::UnevenWeights(self.uneven),
            CharacterNote::NotFiniteWeights(self.not_finite),
            CharacterNote::UnweightedVertices(self.unweighted),
        ];
        let counts = [self.hidden, self.uneven, self.not_finite, self.unweighted];
        notes.extend(counted.into_iter().zip(counts).filter(|(_, count)| *count > 0).map(|(note, _)| note));
        self.mesh
    }
}

/// The texture of a material's colour, and its set of coordinates.
fn base_texture(material: &GltfMaterial) -> Option<(usize, u32)> {
    let info = material.pbr_metallic_roughness.base_color_texture.as_ref()?;
    Some((info.index.value(), info.tex_coord))
}

/// What the alpha of a material hides.
fn cut_out(material: &GltfMaterial) -> CutOut {
    match material.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => {
            let cutoff = material.alpha_cutoff.map_or(MASK_CUTOFF, |cutoff| cutoff.0);
            CutOut::Below(if cutoff.is_finite() { cutoff.clamp(0.0, 1.0) } else { MASK_CUTOFF })
        }
        Checked::Valid(AlphaMode::Blend) => CutOut::Blended,
        _ => CutOut::Opaque,
    }
}

/// Points of a triangle at which its texture is looked at, by the weights of its corners.
fn barycentric_points() -> impl Iterator<Item = [f32; 3]> {
    let step = 1.0 / LOOKS as f32;
    (0..=LOOKS).flat_map(move |a| {
        (0..=LOOKS - a).map(move |b| [a as f32 * step, b as f32 * step, (LOOKS - a - b) as f32 * step])
    })
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
