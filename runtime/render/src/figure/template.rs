//! A mesh in the rest pose, and the joints that move its vertices. Metres.

use glam::{Mat3, Vec3};

use crate::figure::section::Section;
use crate::figure::style::{CLOTHS, Cloth};
use crate::visibility::{Meshes, Owner};

/// A vertex of a template.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    position: Vec3,
    normal: Vec3,
    joints: [usize; 2],
    share: f32,
    cloth: Cloth,
}

/// A mesh in the rest pose.
#[derive(Clone, Debug, Default)]
pub(crate) struct Template {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// A posed joint: turns and moves what is fixed to it, from the rest pose into the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PosedJoint {
    pub(crate) rotation: Mat3,
    pub(crate) rest: Vec3,
    pub(crate) position: Vec3,
}

impl PosedJoint {
    /// A point of the rest pose, in the world.
    pub(crate) fn to_world(self, point: Vec3) -> Vec3 {
        self.position + self.rotation * (point - self.rest)
    }
}

impl Vertex {
    pub(crate) fn new(position: Vec3, section: &Section) -> Self {
        let Section { joints, share, cloth, .. } = *section;
        Self { position, normal: Vec3::ZERO, joints, share, cloth }
    }
}

impl Template {
    /// Computes the normals: of each vertex, the sum over its triangles by area. Vertices at one place share theirs.
    pub(crate) fn finish(mut self) -> Self {
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| self.vertices[corner as usize].position);
            let normal = (b - a).cross(c - a);
            for corner in corners {
                self.vertices[*corner as usize].normal += normal;
            }
        }
        for vertex in &mut self.vertices {
            vertex.normal = vertex.normal.try_normalize().unwrap_or(Vec3::Z);
        }
        self
    }

    /// Appends the posed mesh.
    pub(crate) fn append(&self, meshes: &mut Meshes, joints: &[PosedJoint], colours: &[Vec3; CLOTHS], owner: Owner) {
        let first = meshes.positions_m.len() as u32;
        for vertex in &self.vertices {
            let [one, other] = vertex.joints.map(|joint| &joints[joint]);
            let (mut position, mut normal) = (one.to_world(vertex.position), one.rotation * vertex.normal);
            if vertex.share > 0.0 {
                position = position.lerp(other.to_world(vertex.position), vertex.share);
                normal = normal.lerp(other.rotation * vertex.normal, vertex.share);
            }
            meshes.positions_m.push(position);
            meshes.normals.push(normal);
            meshes.colours.push(colours[vertex.cloth as usize]);
        }
        meshes.triangles.extend(self.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        meshes.owners.resize(meshes.triangles.len(), owner);
    }
}
