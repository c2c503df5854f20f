//! A mesh in the rest pose, and what moves its vertices: joints, and thighs that push hanging cloth out. Metres.

use glam::{Mat3, Vec2, Vec3};
use motiondb::body::Joint;

use crate::figure::section::Section;
use crate::figure::style::{CLOTHS, Cloth};
use crate::visibility::{MeshSize, Meshes, Owner};

/// Radius of a thigh with trousers at hip and knee, and the room between it and cloth, on the reference body, m.
const THIGH_M: [f32; 2] = [0.103, 0.067];
/// Width over which cloth bends where a thigh begins to push it, on the reference body, m.
const BEND_M: f32 = 0.03;
/// Share of the thigh from which cloth is pushed fully; above the hips it is tight.
const LOOSE_FROM: f32 = 0.2;
/// Distance by which the hem stands out from the waist at rest, on the reference body, m.
const FLARE_M: f32 = 0.06;
/// Angle beside a point of a ring within which cloth clears the thighs, of half the angle to the next point.
const CLEARED_GAP: f32 = 1.25;

/// A vertex of a template.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub(crate) position: Vec3,
    normal: Vec3,
    /// The joints that it follows, and their shares; a share of 0 is left out.
    joints: [(usize, f32); 2],
    cloth: Cloth,
}

/// A mesh in the rest pose.
#[derive(Clone, Debug, Default)]
pub(crate) struct Template {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// What keeps the legs inside, where the mesh is cloth that hangs around them.
    pub(crate) hanging: Option<HangingCloth>,
}

/// What moves hanging cloth away from the legs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HangingCloth {
    /// Upper end of the middle line at rest.
    pub(crate) waist: Vec3,
    /// Number of vertices inside the hem: the first ones.
    pub(crate) inner: usize,
    /// Size relative to the reference body.
    pub(crate) scale: f32,
    /// Thickness of the hem, m.
    pub(crate) hem: f32,
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
        let joints = [(joints[0], 1.0 - share), (joints[1], share)];
        Self { position, normal: Vec3::ZERO, joints, cloth }
    }
}

impl Template {
    /// Number of vertices and triangles.
    pub(crate) fn size(&self) -> MeshSize {
        MeshSize { vertices: self.vertices.len(), triangles: self.triangles.len() }
    }

    /// Computes the normals of the rest pose.
    pub(crate) fn finish(mut self) -> Self {
        let positions: Vec<Vec3> = self.vertices.iter().map(|vertex| vertex.position).collect();
        let mut normals = vec![Vec3::ZERO; positions.len()];
        self.set_normals(&positions, &mut normals);
        self.vertices.iter_mut().zip(normals).for_each(|(vertex, normal)| vertex.normal = normal);
        self
    }

    /// Sets the normal of each vertex at positions: the sum over its triangles by area.
    fn set_normals(&self, positions: &[Vec3], normals: &mut [Vec3]) {
        normals.fill(Vec3::ZERO);
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| positions[corner as usize]);
            let normal = (b - a).cross(c - a);
            corners.iter().for_each(|corner| normals[*corner as usize] += normal);
        }
        normals.iter_mut().for_each(|normal| *normal = normal.try_normalize().unwrap_or(Vec3::Z));
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
        if let Some(hanging) = &self.hanging {
            hanging.clear_legs(&self.vertices, &mut meshes.positions_m[first as usize..], joints);
            self.set_normals(&meshes.positions_m[first as usize..], &mut meshes.normals[first as usize..]);
        }
        meshes.triangles.extend(self.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        meshes.owners.fill(meshes.triangles.len(), owner);
    }
}

/// A thigh from hip to knee, in the world.
struct Thigh {
    ends: [Vec3; 2],
    radii: [f32; 2],
}

impl HangingCloth {
    /// Pushes vertices out that the thighs would pass: each to where the convex outline of both thighs is in its direction
    /// from the middle line, at its height. Between the thighs cloth is straight. What is pushed out hangs higher.
    fn clear_legs(&self, vertices: &[Vertex], positions: &mut [Vec3], joints: &[PosedJoint]) {
        let pelvis = joints[Joint::Pelvis.index()];
        let waist = pelvis.to_world(self.waist);
        let thighs = [0, 1].map(|side| Thigh {
            ends: [Joint::THIGHS[side], Joint::SHANKS[side]].map(|joint| joints[joint.index()].position),
            radii: THIGH_M.map(|radius| radius * self.scale),
        });
        // Edges between two points of a ring are to pass outside the thighs, too. The inner vertices are two rings.
        let half_gap = direction_of(CLEARED_GAP * std::f32::consts::TAU / self.inner.max(8) as f32);
        // The last two vertices are the middles of the caps.
        let rings = &vertices[..vertices.len().saturating_sub(2)];
        for (index, (vertex, position)) in rings.iter().zip(positions).enumerate() {
            let offset = (vertex.position - self.waist).with_z(0.0);
            let Some(outward) = (pelvis.rotation * offset).with_z(0.0).try_normalize() else { continue };
            let thickness = if index < self.inner { 0.0 } else { self.hem };
            let middle = pelvis.to_world(vertex.position - offset);
            let discs = thighs.each_ref().map(|thigh| thigh.disc(position.z, middle));
            let ahead = outward.truncate();
            let beside = [half_gap, half_gap * Vec2::new(1.0, -1.0)].map(|turn| outline(&discs, turn.rotate(ahead)));
            let reach = beside.map(|reach| reach / half_gap.x).into_iter().fold(outline(&discs, ahead), f32::max);
            let here = (*position - middle).dot(outward);
            let loose = thighs.iter().map(|thigh| thigh.share(position.z) / LOOSE_FROM).fold(1.0, f32::min);
            let pushed = loose * (smooth_max(here, reach + thickness, BEND_M * self.scale) - here);
            let below = waist.z - position.z;
            let length = (below * below - pushed * (pushed + 2.0 * FLARE_M * self.scale)).max(0.0).sqrt();
            *position += pushed * outward + (below - length).max(0.0) * Vec3::Z;
        }
    }
}

/// Unit vector at an angle from x.
fn direction_of(angle_rad: f32) -> Vec2 {
    let (sin, cos) = libm::sincosf(angle_rad);
    Vec2::new(cos, sin)
}

/// A level section of a thigh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    /// From the middle line of the cloth.
    pub(crate) centre: Vec2,
    pub(crate) radius: f32,
}

/// Distance from the middle line to the convex outline of two discs in a direction; 0 where it is not met.
pub(crate) fn outline(discs: &[Disc; 2], outward: Vec2) -> f32 {
    let of_disc = |disc: &Disc| {
        let aside = outward.perp_dot(disc.centre);
        let square = disc.radius * disc.radius - aside * aside;
        if square < 0.0 { 0.0 } else { disc.centre.dot(outward) + square.sqrt() }
    };
    let reach = discs.iter().map(of_disc).fold(0.0, f32::max);
    let between = discs[1].centre - discs[0].centre;
    let narrower = (discs[0].radius - discs[1].radius) / between.length().max(1e-6);
    let Some(along) = between.try_normalize().filter(|_| narrower.abs() < 1.0) else { return reach };
    // Both straight sides touch the discs where their common normal points.
    let across = (1.0 - narrower * narrower).sqrt();
    [across, -across].into_iter().fold(reach, |reach, across| {
        let normal = narrower * along + across * along.perp();
        let [from, to] = discs.map(|disc| disc.centre + disc.radius * normal);
        let [side_from, side_to] = [from, to].map(|end| outward.perp_dot(end));
        let crosses = side_from * side_to < 0.0;
        let at = from + (to - from) * (side_from / (side_from - side_to));
        if crosses { reach.max(at.dot(outward)) } else { reach }
    })
}

impl Thigh {
    /// Share of the thigh above a height.
    fn share(&self, height: f32) -> f32 {
        let [hip, knee] = self.ends;
        ((hip.z - height) / (hip.z - knee.z).max(0.1)).clamp(0.0, 1.0)
    }

    /// The section at a height, from a middle line.
    fn disc(&self, height: f32, middle: Vec3) -> Disc {
        let [hip, knee] = self.ends;
        let along = knee - hip;
        // The section of a thigh that is swung is longer.
        let stretch = along.length() / along.z.abs().max(0.5 * along.length());
        let share = self.share(height);
        let radius = stretch * (self.radii[0] + share * (self.radii[1] - self.radii[0]));
        Disc { centre: (hip + share * along - middle).truncate(), radius }
    }
}

/// The greater of two values, with a bend of a width instead of an edge; little changes where they are far apart.
fn smooth_max(a: f32, b: f32, width: f32) -> f32 {
    let over = (width - (a - b).abs()).max(0.0);
    a.max(b) + over * over / (4.0 * width)
}
