//! Linear blend skinning: transforms of joints → world positions and normals of all vertices.

use std::ops::Range;

use glam::Vec3;

use crate::character::dye::Dye;
use crate::character::model::{CharacterMesh, Material};
use crate::character::posing::JointTransform;

impl CharacterMesh {
    /// Positions (m) and unit normals of all vertices in the world; both lists are cleared first.
    ///
    /// # Panics
    /// If there are fewer transforms than joints.
    pub fn skin(&self, transforms: &[JointTransform], positions_m: &mut Vec<Vec3>, normals: &mut Vec<Vec3>) {
        positions_m.clear();
        normals.clear();
        let vertices = self.positions_m.iter().zip(&self.normals).zip(self.joints.iter().zip(&self.weights));
        for ((&bind_m, &bind_normal), (joints, weights)) in vertices {
            let (mut position_m, mut normal) = (Vec3::ZERO, Vec3::ZERO);
            for (&joint, &weight) in joints.iter().zip(weights).take_while(|(_, weight)| **weight > 0.0) {
                let transform = &transforms[usize::from(joint)];
                position_m += weight * transform.point_m(bind_m);
                normal += weight * (transform.rotation * bind_normal);
            }
            positions_m.push(position_m);
            normals.push(normal.normalize_or_zero());
        }
    }

    /// Colours of all vertices, linear and dyed; those of textured materials are the plain tints by which textures are
    /// multiplied, without dye. The list is cleared first.
    pub fn dyed(&self, dye: &Dye, colours: &mut Vec<Vec3>) {
        colours.clear();
        colours.extend(self.colours.iter().map(|colour| Vec3::from(*colour)));
        // Number of the last run, from 1, that coloured each vertex: triangles share vertices.
        let mut coloured_by = vec![0_u32; colours.len()];
        for (run, (material, triangles)) in (1..).zip(self.runs()) {
            let is_textured = material.texture.is_some();
            if !is_textured && *dye == Dye::default() {
                continue;
            }
            for &vertex in self.triangles[triangles].as_flattened() {
                let vertex = vertex as usize;
                if coloured_by[vertex] != run {
                    coloured_by[vertex] = run;
                    colours[vertex] = match is_textured {
                        true => self.tints[vertex].into(),
                        false => dye.applied(self.colours[vertex].into(), material.keeps_hue),
                    };
                }
            }
        }
    }

    /// The materials, each with its range of triangles.
    pub fn runs(&self) -> impl Iterator<Item = (&Material, Range<usize>)> {
        let mut first = 0;
        self.materials.iter().map(move |material| {
            let range = first..first + material.triangle_count as usize;
            first = range.end;
            (material, range)
        })
    }

    /// Position of one vertex in the world, m.
    ///
    /// # Panics
    /// If the mesh has no such vertex, or there are fewer transforms than joints.
    pub fn position_m(&self, vertex: usize, transforms: &[JointTransform]) -> Vec3 {
        let influences = self.joints[vertex].iter().zip(&self.weights[vertex]);
        let moved = influences
            .map(|(&joint, &weight)| weight * transforms[usize::from(joint)].point_m(self.positions_m[vertex]));
        moved.sum()
    }
}
