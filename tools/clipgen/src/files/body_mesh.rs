//! The body as a skinned mesh: a low-poly capsule of elliptic section for every segment.
//!
//! Two cases of a vertex's weights. Within a third of the segment from a joint that it shares with its parent or child,
//! half to none of the weight is the neighbour's, so that joints bend smoothly. Elsewhere the segment's own joint
//! carries all. Rest pose of the skeleton (x forward, y left, z up), metres. Half breadths and depths are those of a
//! slim adult, set by eye.

use glam::DVec3;

use crate::body::ClipPose;
use crate::body::rotation::wave;
use crate::body::skeleton::{
    ANKLE_HEIGHT_M, ARMS, BALL_X_M, CHEST, CLAVICLES, FEET, FOREARMS, HANDS, HEAD, HEEL_X_M, HEIGHT_M, NECK, SHANKS,
    SPINE, THIGHS, TOE_TIP_X_M, TOES, joints_at_rest,
};

/// Vertices of a ring.
const SIDES: usize = 10;
/// Rings of a segment: share of its length, and sine of the angle towards its nearer pole (0 off the caps).
const RINGS: [(f64, f64); 6] = [(0.0, -0.8), (0.0, 0.0), (1.0 / 3.0, 0.0), (2.0 / 3.0, 0.0), (1.0, 0.0), (1.0, 0.8)];
/// Weight of the neighbour at a shared joint.
const NEIGHBOUR_WEIGHT: f64 = 0.5;
/// Share of the segment from which on the neighbour has no weight.
const BLEND_SHARE: f64 = 1.0 / 3.0;

/// One vertex at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshVertex {
    /// Position, m.
    pub(crate) position_m: DVec3,
    /// Outward normal, a unit vector.
    pub(crate) normal: DVec3,
    /// Indices of the segment's own joint and of its neighbour.
    pub(crate) joints: [usize; 2],
    /// Weight of the neighbour; the own joint has the rest.
    pub(crate) neighbour_weight: f64,
}

/// Vertices and triangles, counter-clockwise from outside.
#[derive(Clone, Debug, Default)]
pub(crate) struct BodyMesh {
    /// Vertices at rest.
    pub(crate) vertices: Vec<MeshVertex>,
    /// Triangles, as indices of vertices.
    pub(crate) triangles: Vec<[usize; 3]>,
}

/// A tapered capsule on one joint.
struct BodySegment {
    /// Index of the joint.
    joint: usize,
    /// One end in the joint's frame, m.
    from_m: DVec3,
    /// The other end in the joint's frame, m.
    to_m: DVec3,
    /// Radii `[across, deep]` at `from_m`, m.
    from_radii_m: [f64; 2],
    /// Radii `[across, deep]` at `to_m`, m.
    to_radii_m: [f64; 2],
    /// Index of the joint that continues at `to_m`.
    next: Option<usize>,
}

/// The mesh of the whole body.
pub(crate) fn body_mesh() -> BodyMesh {
    let rest_m = ClipPose::rest().positions_m();
    let mut mesh = BodyMesh::default();
    for segment in segments() {
        add_segment(&mut mesh, &segment, rest_m[segment.joint]);
    }
    mesh
}

fn segments() -> Vec<BodySegment> {
    let at = DVec3::new;
    let segment = |joint, from_m, to_m, from_radii_m, to_radii_m, next| BodySegment {
        joint,
        from_m,
        to_m,
        from_radii_m,
        to_radii_m,
        next,
    };
    let zero = DVec3::ZERO;
    let offset = |joint: usize| joints_at_rest()[joint].offset_m;
    let mut segments = vec![
        segment(0, at(-0.01, 0.0, -0.01), offset(SPINE), [0.160, 0.105], [0.145, 0.100], Some(SPINE)),
        segment(SPINE, zero, offset(SPINE + 1), [0.142, 0.098], [0.140, 0.098], Some(SPINE + 1)),
        segment(SPINE + 1, zero, offset(CHEST), [0.140, 0.098], [0.155, 0.108], Some(CHEST)),
        segment(CHEST, zero, at(-0.005, 0.0, 0.140), [0.155, 0.108], [0.110, 0.080], None),
        segment(NECK, at(-0.005, 0.0, -0.04), offset(HEAD), [0.058, 0.058], [0.054, 0.056], Some(HEAD)),
        segment(HEAD, at(0.012, 0.0, 0.040), at(0.012, 0.0, 0.110), [0.068, 0.085], [0.074, 0.096], None),
    ];
    for side in 0..2 {
        let (arm, forearm, hand) = (ARMS[side], FOREARMS[side], HANDS[side]);
        let (thigh, shank, foot, toes) = (THIGHS[side], SHANKS[side], FEET[side], TOES[side]);
        let fingers_m = DVec3::Y * (if side == 0 { 0.095 } else { -0.095 }) * HEIGHT_M;
        let (heel_m, ball_m) = (at(HEEL_X_M + 0.025, 0.0, -0.030), at(BALL_X_M, 0.0, 0.024 - ANKLE_HEIGHT_M));
        let toe_end_m = at(TOE_TIP_X_M - BALL_X_M - 0.018, 0.0, -0.004);
        segments.extend([
            segment(CLAVICLES[side], zero, offset(arm), [0.055, 0.050], [0.056, 0.056], Some(arm)),
            segment(arm, zero, offset(forearm), [0.056, 0.052], [0.041, 0.040], Some(forearm)),
            segment(forearm, zero, offset(hand), [0.042, 0.040], [0.029, 0.025], Some(hand)),
            segment(hand, zero, fingers_m, [0.034, 0.020], [0.030, 0.012], None),
            segment(thigh, zero, offset(shank), [0.086, 0.088], [0.055, 0.058], Some(shank)),
            segment(shank, zero, offset(foot), [0.055, 0.060], [0.036, 0.040], Some(foot)),
            segment(foot, heel_m, ball_m, [0.034, 0.038], [0.046, 0.024], Some(toes)),
            segment(toes, zero, toe_end_m, [0.046, 0.022], [0.038, 0.017], None),
        ]);
    }
    segments
}

/// Adds the vertices and triangles of a segment whose joint rests at `rest_m`.
fn add_segment(mesh: &mut BodyMesh, segment: &BodySegment, rest_m: DVec3) {
    let first = mesh.vertices.len();
    let axis = (segment.to_m - segment.from_m).normalize();
    // Across the body; forward for a segment that itself lies across it.
    let across = if axis.y.abs() > 0.7 { DVec3::X } else { DVec3::Y };
    let across = across.reject_from_normalized(axis).normalize();
    let frame = [axis, across, axis.cross(across)];
    add_pole(mesh, segment, rest_m, axis, 0.0);
    for (share, pole_sine) in RINGS {
        add_ring(mesh, segment, rest_m, &frame, share, pole_sine);
    }
    add_pole(mesh, segment, rest_m, axis, 1.0);
    let ring = |index: usize, side: usize| first + 1 + index * SIDES + side % SIDES;
    let last_pole = first + 1 + RINGS.len() * SIDES;
    for side in 0..SIDES {
        mesh.triangles.push([first, ring(0, side + 1), ring(0, side)]);
        for index in 0..RINGS.len() - 1 {
            let [a, b] = [ring(index, side), ring(index, side + 1)];
            let [d, c] = [ring(index + 1, side), ring(index + 1, side + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        mesh.triangles.push([last_pole, ring(RINGS.len() - 1, side), ring(RINGS.len() - 1, side + 1)]);
    }
}

/// Adds the vertices of a ring at a share of the segment's length; `frame` is [along, across, deep].
fn add_ring(mesh: &mut BodyMesh, segment: &BodySegment, rest_m: DVec3, frame: &[DVec3; 3], share: f64, pole_sine: f64) {
    let [axis, across, deep] = *frame;
    let radii_m = segment.radii_m(share);
    let cap_m = radii_m[0].min(radii_m[1]);
    let girth = libm::sqrt(1.0 - pole_sine * pole_sine);
    for side in 0..SIDES {
        let angle = side as f64 / SIDES as f64;
        let [cos, sin] = [girth * wave(angle), girth * wave(angle - 0.25)];
        let out_m = axis * (cap_m * pole_sine) + across * (radii_m[0] * cos) + deep * (radii_m[1] * sin);
        // The gradient of the ellipsoid on which the ring lies.
        let gradient = axis * (pole_sine / cap_m) + across * (cos / radii_m[0]) + deep * (sin / radii_m[1]);
        mesh.vertices.push(segment.vertex(rest_m, share, out_m, gradient.normalize()));
    }
}

/// Adds the vertex at an end of the segment: share 0 or 1.
fn add_pole(mesh: &mut BodyMesh, segment: &BodySegment, rest_m: DVec3, axis: DVec3, share: f64) {
    let [across_m, deep_m] = segment.radii_m(share);
    let outward = axis * (2.0 * share - 1.0);
    mesh.vertices.push(segment.vertex(rest_m, share, outward * across_m.min(deep_m), outward));
}

impl BodySegment {
    /// Radii `[across, deep]` at a share of the length, m.
    fn radii_m(&self, share: f64) -> [f64; 2] {
        let mixed = |i: usize| self.from_radii_m[i] * (1.0 - share) + self.to_radii_m[i] * share;
        [mixed(0), mixed(1)]
    }

    /// The vertex at `out_m` from the axis, at a share of the length.
    fn vertex(&self, rest_m: DVec3, share: f64, out_m: DVec3, normal: DVec3) -> MeshVertex {
        let begins_at_joint = self.from_m == DVec3::ZERO && self.joint > 0;
        let weight = |distance: f64| NEIGHBOUR_WEIGHT * (1.0 - distance / BLEND_SHARE).max(0.0);
        let (neighbour, neighbour_weight) = match self.next {
            Some(next) if share > 0.5 => (next, weight(1.0 - share)),
            _ if begins_at_joint && share < 0.5 => (joints_at_rest()[self.joint].parent, weight(share)),
            _ => (self.joint, 0.0),
        };
        let position_m = rest_m + self.from_m.lerp(self.to_m, share) + out_m;
        MeshVertex { position_m, normal, joints: [self.joint, neighbour], neighbour_weight }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_triangle_faces_outward() {
        let mesh = body_mesh();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|index| mesh.vertices[index]);
            let face = (b.position_m - a.position_m).cross(c.position_m - a.position_m);
            assert!(face.dot(a.normal + b.normal + c.normal) > 0.0, "{triangle:?}");
        }
    }

    #[test]
    fn the_body_stands_on_the_ground_at_its_height() {
        let heights_m = || body_mesh().vertices.into_iter().map(|vertex| vertex.position_m.z);
        let (lowest_m, highest_m) = (heights_m().fold(f64::INFINITY, f64::min), heights_m().fold(0.0, f64::max));
        assert!(lowest_m.abs() < 0.003 && (highest_m - HEIGHT_M).abs() < 0.02, "{lowest_m} {highest_m}");
    }
}
