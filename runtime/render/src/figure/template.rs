//! A mesh in the rest pose, and the joints that move its vertices. Metres.

use glam::{Mat3, Vec3};

use crate::figure::section::Section;
use crate::figure::style::{CLOTHS, Cloth};
use crate::visibility::{Meshes, Owner};

/// A vertex of a template.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub(crate) position: Vec3,
    normal: Vec3,
    /// The joints that it follows, and their shares; a share of 0 is left out.
    joints: [(usize, f32); 3],
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
        let joints = [(joints[0], 1.0 - share), (joints[1], share), (0, 0.0)];
        Self { position, normal: Vec3::ZERO, joints, cloth }
    }

    /// Lets it follow other joints, by shares that add up to 1.
    pub(crate) fn follow(&mut self, joints: [(usize, f32); 3]) {
        self.joints = joints;
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
            let (mut position, mut normal) = (Vec3::ZERO, Vec3::ZERO);
            for (joint, share) in vertex.joints.iter().filter(|(_, share)| *share > 0.0) {
                position += *share * joints[*joint].to_world(vertex.position);
                normal += *share * (joints[*joint].rotation * vertex.normal);
            }
            meshes.positions_m.push(position);
            meshes.normals.push(normal);
            meshes.colours.push(colours[vertex.cloth as usize]);
        }
        meshes.triangles.extend(self.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        meshes.owners.fill(meshes.triangles.len(), owner);
    }
}
