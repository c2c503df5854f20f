//! A mesh as a surface: which of its vertices are one point, and which of these one wedge. World, metres.
//!
//! A *point* is a position and the joints that move it; at a seam it has several vertices. Its *wedges* are those of
//! different material, texture coordinates or colour; vertices of one wedge differ in their normals alone.

use glam::{DVec3, Vec3};
use motiondb::character::CharacterMesh;

use crate::detail::example_poses::POSES;

/// The points of a mesh.
pub(super) struct Points {
    /// Point of each vertex.
    of_vertices: Vec<u32>,
    /// A vertex of each point.
    vertices: Vec<u32>,
}

impl Points {
    pub(super) fn new(mesh: &CharacterMesh) -> Self {
        let (of_vertices, count) = groups(mesh.positions_m.len(), |vertex| {
            (bits(mesh.positions_m[vertex].to_array()), mesh.joints[vertex], mesh.weights[vertex].map(f32::to_bits))
        });
        let mut vertices = vec![0; count];
        of_vertices.iter().enumerate().for_each(|(vertex, point)| vertices[*point as usize] = vertex as u32);
        Self { of_vertices, vertices }
    }

    pub(super) fn count(&self) -> usize {
        self.vertices.len()
    }

    /// A vertex of a point.
    pub(super) fn vertex(&self, point: usize) -> usize {
        self.vertices[point] as usize
    }

    /// Points of three vertices.
    pub(super) fn of_corners(&self, corners: [u32; 3]) -> [u32; 3] {
        corners.map(|corner| self.of_vertices[corner as usize])
    }
}

/// Points, wedges and triangles of a mesh.
pub(super) struct Surface {
    /// Point of each vertex.
    pub(super) points: Vec<u32>,
    /// Wedge of each vertex.
    pub(super) wedges: Vec<u32>,
    /// Number of points and of wedges.
    pub(super) counts: [usize; 2],
    /// Positions of each point, by poses, m.
    pub(super) positions_m: Vec<[DVec3; POSES]>,
    /// Texture coordinates, or colour, of each wedge.
    pub(super) attributes: Vec<DVec3>,
    /// Whether each material has a texture.
    pub(super) is_textured: Vec<bool>,
    /// The triangles between three different points, as vertices.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Material of each triangle, by index.
    pub(super) materials: Vec<u32>,
}

impl Surface {
    /// Points of the corners of a triangle.
    pub(super) fn corner_points(&self, triangle: usize) -> [u32; 3] {
        self.triangles[triangle].map(|corner| self.points[corner as usize])
    }

    /// Wedges of the corners of a triangle.
    pub(super) fn corner_wedges(&self, triangle: usize) -> [u32; 3] {
        self.triangles[triangle].map(|corner| self.wedges[corner as usize])
    }

    /// The surface of a mesh with its vertices' positions in some poses.
    pub(super) fn new(mesh: &CharacterMesh, posed_m: &[Vec<Vec3>; POSES]) -> Self {
        let count = mesh.positions_m.len();
        let all = Points::new(mesh);
        let (point_count, points) = (all.count(), all.of_vertices);
        let mut material_of = vec![u32::MAX; count];
        let mut materials = Vec::with_capacity(mesh.triangles.len());
        for (material, (_, run)) in mesh.runs().enumerate() {
            materials.resize(run.end, material as u32);
            for vertex in mesh.triangles[run].as_flattened() {
                let first = &mut material_of[*vertex as usize];
                *first = (*first).min(material as u32);
            }
        }
        let is_textured: Vec<bool> = mesh.materials.iter().map(|material| material.texture.is_some()).collect();
        let attributes = |vertex: usize| match is_textured.get(material_of[vertex] as usize) {
            Some(true) => [mesh.uvs[vertex][0], mesh.uvs[vertex][1], 0.0],
            _ => mesh.colours[vertex],
        };
        let (wedges, wedge_count) =
            groups(count, |vertex| (points[vertex], material_of[vertex], bits(attributes(vertex))));
        let mut of_wedges = vec![DVec3::ZERO; wedge_count];
        let mut positions_m = vec![[DVec3::ZERO; POSES]; point_count];
        for vertex in 0..count {
            of_wedges[wedges[vertex] as usize] = DVec3::from(attributes(vertex).map(f64::from));
            positions_m[points[vertex] as usize] = [0, 1, 2].map(|pose: usize| posed_m[pose][vertex].as_dvec3());
        }
        let has_area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| points[corner as usize]);
            a != b && b != c && c != a
        };
        let kept = mesh.triangles.iter().zip(materials).filter(|(corners, _)| has_area(corners));
        let (triangles, materials) = kept.map(|(corners, material)| (*corners, material)).unzip();
        Self {
            points,
            wedges,
            counts: [point_count, wedge_count],
            positions_m,
            attributes: of_wedges,
            is_textured,
            triangles,
            materials,
        }
    }
}

/// Bits by which equal values are found; both zeros are one.
fn bits(values: [f32; 3]) -> [u32; 3] {
    values.map(|value| (value + 0.0).to_bits())
}

/// Groups of equal keys: the group of each index, by rising key, and their number.
fn groups<K: Ord>(count: usize, key: impl Fn(usize) -> K) -> (Vec<u32>, usize) {
    let mut order: Vec<(K, u32)> = (0..count).map(|index| (key(index), index as u32)).collect();
    order.sort_unstable();
    let (mut group_of, mut group) = (vec![0; count], 0);
    for (place, (own, index)) in order.iter().enumerate() {
        group += u32::from(place > 0 && order[place - 1].0 != *own);
        group_of[*index as usize] = group;
    }
    (group_of, if count > 0 { group as usize + 1 } else { 0 })
}
