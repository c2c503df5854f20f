//! What is drawn besides the ground: rounded cones and meshes of triangles, in the world. Metres, z up, linear colours.

use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};
use motiondb::character::{CutOut, Dye};

use crate::visibility::owner::{Owner, Owners};
use crate::visibility::part::{PartId, Shape};
use crate::visibility::texture::Texture;

/// A ball that is swept along a segment while its radius changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Centre of the ball at both ends, world, m.
    pub ends_m: [Vec3; 2],
    /// Radius at both ends, m.
    pub radii_m: [f32; 2],
    /// Colour, linear Rec. 709.
    pub colour: Vec3,
    /// What it belongs to.
    pub owner: Owner,
}

/// A texture on triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    /// Index of the texture among those of the scene.
    pub texture: u32,
    /// What the texture's alpha hides.
    pub cut_out: CutOut,
    /// What changes the colours, and whether it leaves their hue.
    pub dye: Dye,
    /// Whether the dye leaves hues as they are.
    pub keeps_hue: bool,
}

/// Triangles of all meshes of a scene. A mesh is appended as plain slices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Meshes {
    /// Position of each vertex, world, m.
    pub positions_m: Vec<Vec3>,
    /// Normal of each vertex, world.
    pub normals: Vec<Vec3>,
    /// Colour of each vertex, linear Rec. 709.
    pub colours: Vec<Vec3>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// What each triangle belongs to.
    pub owners: Owners,
    /// Texture coordinates of vertices; those beyond the list's end have none.
    pub uvs: Vec<Vec2>,
    /// Textures on triangles.
    pub paints: Vec<Paint>,
    /// Index of each triangle's paint plus 1; 0 of one without texture, as of those beyond the list's end.
    pub paint_numbers: Vec<u32>,
    /// Whether each triangle is one of a closed surface, whose backs are never seen; those beyond the list's end are none.
    pub closed: Vec<bool>,
}

/// Size of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct MeshSize {
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
}

impl std::iter::Sum for MeshSize {
    fn sum<I: Iterator<Item = Self>>(sizes: I) -> Self {
        sizes.fold(Self::default(), |sum, size| Self {
            vertices: sum.vertices + size.vertices,
            triangles: sum.triangles + size.triangles,
        })
    }
}

/// All cones and triangles of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneParts {
    /// Rounded cones, by rising agent.
    pub cones: Vec<Cone>,
    /// Triangles.
    pub meshes: Meshes,
    /// Rounded cones that are not drawn, by which occlusion is computed; by rising agent.
    pub occluders: Vec<Cone>,
    /// Textures of the meshes.
    pub textures: Arc<Vec<Texture>>,
}

impl SceneParts {
    /// Appends the cones and triangles of another part of the frame, whose triangles show textures of this one.
    pub(crate) fn extend(&mut self, other: &Self) {
        self.cones.extend(&other.cones);
        self.occluders.extend(&other.occluders);
        self.meshes.extend(&other.meshes);
    }

    /// Colour and alpha of a triangle's texture at a point, by the weights of its corners; none without texture.
    /// `footprint_m` is the width of a pixel there.
    pub(crate) fn texel(&self, triangle: usize, weights: Vec3, footprint_m: f32) -> Option<Vec4> {
        let texture = self.textures.get(self.meshes.paint(triangle)?.texture as usize)?;
        let uvs = self.meshes.triangles[triangle]
            .map(|corner| self.meshes.uvs.get(corner as usize).copied().unwrap_or_default());
        let uv = uvs[0] * weights.x + uvs[1] * weights.y + uvs[2] * weights.z;
        let corners_m = self.meshes.corners_m(triangle);
        let area_m2 = (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]).length();
        let size = texture.size_px();
        let area_px2 = ((uvs[1] - uvs[0]) * size).perp_dot((uvs[2] - uvs[0]) * size).abs();
        let density = if area_m2 > 0.0 { (area_px2 / area_m2).sqrt() } else { 0.0 };
        Some(texture.sample(uv, footprint_m * density))
    }

    /// The shape of a part; none of ground and sky.
    pub(crate) fn shape(&self, part: PartId) -> Option<Shape> {
        part.shape(self.cones.len())
    }

    /// What a part belongs to; none of ground and sky.
    pub(crate) fn owner(&self, part: PartId) -> Option<Owner> {
        self.shape(part).map(|shape| match shape {
            Shape::Cone(cone) => self.cones[cone].owner,
            Shape::Triangle(triangle) => self.meshes.owners.of(triangle),
        })
    }
}

impl Meshes {
    /// Appends a mesh: as many normals and colours as positions, and triangles of its own indices. Triangles with an
    /// index beyond the positions are left out.
    ///
    /// ```
    /// use fbcrowd_render::visibility::{Meshes, Owner};
    /// use glam::Vec3;
    ///
    /// let mut meshes = Meshes::default();
    /// let corners_m = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// for _ in 0..2 {
    ///     meshes.append(&corners_m, &[Vec3::Z; 3], &[Vec3::ONE; 3], &[[0, 1, 2]], Owner::SCENE);
    /// }
    /// assert_eq!(meshes.triangles, [[0, 1, 2], [3, 4, 5]]);
    /// ```
    pub fn append(
        &mut self,
        positions_m: &[Vec3],
        normals: &[Vec3],
        colours: &[Vec3],
        triangles: &[[u32; 3]],
        owner: Owner,
    ) {
        let first = self.positions_m.len() as u32;
        let count = positions_m.len().min(normals.len()).min(colours.len());
        self.positions_m.extend_from_slice(&positions_m[..count]);
        self.normals.extend_from_slice(&normals[..count]);
        self.colours.extend_from_slice(&colours[..count]);
        let valid = triangles.iter().filter(|corners| corners.iter().all(|&corner| (corner as usize) < count));
        self.triangles.extend(valid.map(|corners| corners.map(|corner| first + corner)));
        self.owners.fill(self.triangles.len(), owner);
    }

    /// Textures the last triangles of the last vertices: coordinates of these vertices, and runs of so many triangles with
    /// a paint or none.
    pub fn texture(
        &mut self,
        uvs: impl ExactSizeIterator<Item = Vec2>,
        runs: impl Iterator<Item = (usize, Option<Paint>)>,
    ) {
        self.uvs.resize(self.positions_m.len().saturating_sub(uvs.len()), Vec2::ZERO);
        self.uvs.extend(uvs);
        let mut numbers = Vec::new();
        for (count, paint) in runs {
            self.paints.extend(paint);
            numbers.resize(numbers.len() + count, paint.map_or(0, |_| self.paints.len() as u32));
        }
        self.paint_numbers.resize(self.triangles.len().saturating_sub(numbers.len()), 0);
        self.paint_numbers.extend(numbers);
    }

    /// States of the last triangles whether each is one of a closed surface.
    pub(crate) fn close(&mut self, closed: &[bool]) {
        self.closed.resize(self.triangles.len().saturating_sub(closed.len()), false);
        self.closed.extend_from_slice(closed);
    }

    /// Shows the backs of all triangles from one on.
    pub(crate) fn open(&mut self, first_triangle: usize) {
        self.closed.truncate(first_triangle);
    }

    /// Whether the back of a triangle is never seen.
    pub(crate) fn hides_back(&self, triangle: usize) -> bool {
        self.closed.get(triangle).copied().unwrap_or(false)
    }

    /// The texture on a triangle.
    pub(crate) fn paint(&self, triangle: usize) -> Option<&Paint> {
        let number = self.paint_numbers.get(triangle).copied().unwrap_or(0);
        self.paints.get((number as usize).wrapping_sub(1))
    }

    /// Appends all triangles of other meshes.
    pub(crate) fn extend(&mut self, other: &Self) {
        let first = self.positions_m.len() as u32;
        if !other.paints.is_empty() {
            self.uvs.resize(first as usize, Vec2::ZERO);
            self.uvs.extend_from_slice(&other.uvs);
            self.paint_numbers.resize(self.triangles.len(), 0);
            let before = self.paints.len() as u32;
            let moved = other.paint_numbers.iter().map(|number| if *number > 0 { number + before } else { 0 });
            self.paint_numbers.extend(moved);
            self.paints.extend_from_slice(&other.paints);
        }
        if !other.closed.is_empty() {
            self.closed.resize(self.triangles.len(), false);
            self.closed.extend_from_slice(&other.closed);
        }
        self.positions_m.extend_from_slice(&other.positions_m);
        self.normals.extend_from_slice(&other.normals);
        self.colours.extend_from_slice(&other.colours);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        self.owners.extend(&other.owners);
    }

    /// Number of vertices and triangles.
    pub(crate) fn size(&self) -> MeshSize {
        MeshSize { vertices: self.positions_m.len(), triangles: self.triangles.len() }
    }

    /// A value of each vertex, blended by the weights of a triangle's corners.
    pub(crate) fn blended(&self, triangle: usize, weights: Vec3, values: &[Vec3]) -> Vec3 {
        let [a, b, c] = self.triangles[triangle].map(|corner| values[corner as usize]);
        a * weights.x + b * weights.y + c * weights.z
    }

    /// Corners of a triangle, world, m.
    pub(crate) fn corners_m(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|corner| self.positions_m[corner as usize])
    }
}
