//! The levels of detail of one character.

use glam::Vec3;
use motiondb::body::Skeleton;
use motiondb::character::{CharacterFit, CharacterMesh, Material};

use crate::detail::example_poses::{POSES, posed_m};
use crate::detail::reduction::Reduction;
use crate::detail::surface::{Points, Surface};
use crate::visibility::closed_triangles;

/// Error of the finest level, at the crowd's size, m.
const FINEST_M: f32 = 0.001;
/// Error of a level over that of the next finer one.
const STEP: f32 = std::f32::consts::SQRT_2;
/// Number of levels: the coarsest has an error of 9 cm.
const LEVELS: usize = 14;
/// Greatest share of triangles that a level has of the next finer one; levels with more are left out.
const SHARE_MAX: f32 = 0.95;
/// Error that is not seen, pixels. At .3, thin hair let the head shine through (docs/tuning.md).
const UNSEEN_PX: f32 = 0.2;

/// A mesh of a character.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    pub(crate) mesh: CharacterMesh,
    /// Whether each triangle is one of a closed surface.
    pub(crate) closed: Vec<bool>,
}

/// A character's own mesh and reduced ones.
#[derive(Clone, Debug)]
pub(crate) struct Levels {
    own: Level,
    /// Reduced meshes by rising error, m.
    reduced: Vec<(f32, Level)>,
}

impl Level {
    /// A mesh whose normals, triangles and weights fit its vertices.
    pub(crate) fn new(mesh: CharacterMesh) -> Self {
        let points = Points::new(&mesh);
        let triangles: Vec<_> = mesh.triangles.iter().map(|corners| points.of_corners(*corners)).collect();
        let closed = closed_triangles(&triangles, points.count(), |point| mesh.positions_m[points.vertex(point)]);
        Self { mesh, closed }
    }
}

impl Levels {
    /// The levels of a character on a skeleton.
    pub(crate) fn new(fit: &CharacterFit, skeleton: &Skeleton) -> Self {
        let own = &fit.character.mesh;
        let reduced = reduced(own, &posed_m(fit, skeleton));
        Self {
            own: Level::new(own.clone()),
            reduced: reduced.into_iter().map(|(error_m, mesh)| (error_m, Level::new(mesh))).collect(),
        }
    }

    /// The coarsest mesh whose errors are not seen where a pixel is so wide on the body, m.
    pub(crate) fn of_pixel(&self, pixel_m: f32) -> &Level {
        let fine = self.reduced.iter().take_while(|(error_m, _)| *error_m <= UNSEEN_PX * pixel_m);
        fine.last().map_or(&self.own, |(_, level)| level)
    }
}

/// Reduced meshes of a mesh, whose vertices have these positions in some poses, by rising error, m.
fn reduced(own: &CharacterMesh, posed_m: &[Vec<Vec3>; POSES]) -> Vec<(f32, CharacterMesh)> {
    let mut reduction = Reduction::new(Surface::new(own, posed_m), &own.normals);
    let (mut reduced, mut count) = (Vec::new(), own.triangles.len());
    let errors_m = std::iter::successors(Some(FINEST_M), |error_m| Some(STEP * error_m));
    for error_m in errors_m.take(LEVELS) {
        reduction.reduce(f64::from(error_m));
        let left = reduction.left().count();
        if left > 0 && left as f32 <= SHARE_MAX * count as f32 {
            reduced.push((error_m, left_of(own, &reduction)));
            count = left;
        }
    }
    reduced
}

/// The mesh of the triangles that are left.
fn left_of(own: &CharacterMesh, reduction: &Reduction) -> CharacterMesh {
    let surface = &reduction.surface;
    let mut counts = vec![0; own.materials.len()];
    let mut new_index = vec![None; own.positions_m.len()];
    for triangle in reduction.left() {
        counts[surface.materials[triangle] as usize] += 1;
        surface.triangles[triangle].iter().for_each(|corner| new_index[*corner as usize] = Some(0));
    }
    let mut kept = Vec::new();
    for (vertex, index) in new_index.iter_mut().enumerate().filter(|(_, index)| index.is_some()) {
        *index = Some(kept.len() as u32);
        kept.push(vertex);
    }
    let corners = |triangle: usize| surface.triangles[triangle].map(|corner| new_index[corner as usize].unwrap_or(0));
    let materials = own.materials.iter().zip(counts);
    CharacterMesh {
        positions_m: taken(&own.positions_m, &kept),
        normals: taken(&own.normals, &kept),
        colours: taken(&own.colours, &kept),
        uvs: taken(&own.uvs, &kept),
        tints: taken(&own.tints, &kept),
        joints: taken(&own.joints, &kept),
        weights: taken(&own.weights, &kept),
        triangles: reduction.left().map(corners).collect(),
        materials: materials.map(|(own, triangle_count)| Material { triangle_count, ..own.clone() }).collect(),
    }
}

/// The values of some vertices; none of an empty list.
fn taken<T: Copy>(values: &[T], vertices: &[usize]) -> Vec<T> {
    vertices.iter().filter_map(|vertex| values.get(*vertex).copied()).collect()
}

#[cfg(test)]
mod tests {
    use std::f32::consts::{FRAC_PI_3, TAU};

    use fbcrowd_sim::maths::SplitMix64;
    use glam::Quat;
    use motiondb::character::{CutOut, JointTransform};

    use super::*;

    /// Sides and rings of a tube.
    const TUBE: [usize; 2] = [32, 60];
    /// Length and radius of the tube, m.
    const SIZE_M: [f32; 2] = [1.0, 0.08];

    fn material(triangle_count: usize, texture: Option<u32>) -> Material {
        Material {
            name: "cloth".into(),
            mesh: "body".into(),
            triangle_count: triangle_count as u32,
            is_double_sided: false,
            keeps_hue: false,
            texture,
            cut_out: CutOut::Opaque,
        }
    }

    /// An upright tube that two joints bend in the middle. The vertices of its seam lie double, as texture coordinates need.
    /// Its lower half is red, its upper half blue, where it has no texture.
    fn tube(texture: Option<u32>) -> (CharacterMesh, [Vec<Vec3>; POSES]) {
        let ([sides, rings], mut mesh) = (TUBE, CharacterMesh::default());
        for (ring, side) in (0..=rings).flat_map(|ring| (0..=sides).map(move |side| (ring, side))) {
            let share = ring as f32 / rings as f32;
            // The first and the last vertex of a ring have the same bits.
            let (sin, cos) = libm::sincosf(TAU * (side % sides) as f32 / sides as f32);
            mesh.positions_m.push(Vec3::new(SIZE_M[1] * cos, SIZE_M[1] * sin, SIZE_M[0] * share));
            mesh.normals.push(Vec3::new(cos, sin, 0.0));
            mesh.colours.push(if share < 0.5 { [0.8, 0.1, 0.1] } else { [0.1, 0.1, 0.8] });
            // Denser near the ends: no plain image of the tube.
            mesh.uvs.push([side as f32 / sides as f32, share + 0.3 * share * (1.0 - share)]);
            mesh.tints.push([1.0; 3]);
            let upper = ((share - 0.45) / 0.1).clamp(0.0, 1.0);
            // Weights fall.
            let joint = u16::from(upper > 0.5);
            mesh.joints.push([joint, 1 - joint, 0, 0]);
            mesh.weights.push([upper.max(1.0 - upper), upper.min(1.0 - upper), 0.0, 0.0]);
        }
        for (ring, side) in (0..rings).flat_map(|ring| (0..sides).map(move |side| (ring, side))) {
            let corner = |ring: usize, side: usize| (ring * (sides + 1) + side) as u32;
            let [a, b, c, d] =
                [corner(ring, side), corner(ring, side + 1), corner(ring + 1, side), corner(ring + 1, side + 1)];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
        mesh.materials.push(material(mesh.triangles.len(), texture));
        if texture.is_none() {
            mesh.uvs.clear();
            mesh.tints.clear();
        }
        let posed_m = posed(&mesh);
        (mesh, posed_m)
    }

    /// The tube at rest, and bent to both sides.
    fn posed(mesh: &CharacterMesh) -> [Vec<Vec3>; POSES] {
        [0.0, FRAC_PI_3, -FRAC_PI_3].map(|angle_rad| {
            let at = |rotation: Quat| {
                let hinge_m = 0.5 * SIZE_M[0] * Vec3::Z;
                JointTransform { rotation, scale: 1.0, translation_m: hinge_m - rotation * hinge_m }
            };
            let (mut positions_m, mut normals) = (Vec::new(), Vec::new());
            mesh.skin(&[at(Quat::IDENTITY), at(Quat::from_rotation_x(angle_rad))], &mut positions_m, &mut normals);
            positions_m
        })
    }

    /// Distance of a point to a triangle, m, and the weights of its corners at the nearest point.
    fn nearest(point_m: Vec3, [a, b, c]: [Vec3; 3]) -> (f32, Vec3) {
        let on_edge =
            |from: Vec3, to: Vec3| ((point_m - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        let [ab, bc, ca] = [on_edge(a, b), on_edge(b, c), on_edge(c, a)];
        let mut candidates =
            vec![Vec3::new(1.0 - ab, ab, 0.0), Vec3::new(0.0, 1.0 - bc, bc), Vec3::new(ca, 0.0, 1.0 - ca)];
        let normal = (b - a).cross(c - a);
        let part = |from: Vec3, to: Vec3| (to - from).cross(point_m - from).dot(normal) / normal.length_squared();
        let inside = Vec3::new(part(b, c), part(c, a), part(a, b));
        if inside.min_element() >= 0.0 {
            candidates.push(inside);
        }
        let distance_m = |weights: &Vec3| (a * weights.x + b * weights.y + c * weights.z).distance(point_m);
        let nearest = candidates.into_iter().min_by(|one, other| distance_m(one).total_cmp(&distance_m(other)));
        nearest.map_or((f32::INFINITY, Vec3::ZERO), |weights| (distance_m(&weights), weights))
    }

    /// Distance of a point to a mesh with these positions, m, and what `of_vertex` is there.
    fn on_mesh(
        point_m: Vec3,
        mesh: &CharacterMesh,
        positions_m: &[Vec3],
        of_vertex: impl Fn(usize) -> Vec3,
    ) -> (f32, Vec3) {
        let found = mesh.triangles.iter().map(|corners| {
            let (distance_m, weights) = nearest(point_m, corners.map(|corner| positions_m[corner as usize]));
            (distance_m, weights, *corners)
        });
        let (distance_m, weights, corners) = found.min_by(|one, other| one.0.total_cmp(&other.0)).unwrap();
        let [a, b, c] = corners.map(|corner| of_vertex(corner as usize));
        (distance_m, a * weights.x + b * weights.y + c * weights.z)
    }

    #[test]
    fn levels_deviate_by_no_more_than_they_state_in_any_pose() {
        let (own, posed_m) = tube(None);
        let levels = reduced(&own, &posed_m);
        let counts: Vec<_> = levels.iter().map(|(error_m, mesh)| (error_m, mesh.triangles.len())).collect();
        assert!(levels.len() > 5, "{counts:?}");
        for (error_m, mesh) in &levels {
            let of_level_m = posed(mesh);
            for (own_m, level_m) in posed_m.iter().zip(&of_level_m) {
                let sampled = own_m.iter().step_by(7);
                let worst_m = sampled.map(|at_m| on_mesh(*at_m, mesh, level_m, |_| Vec3::ZERO).0).fold(0.0, f32::max);
                // The error is a mean over the surface around a vertex.
                assert!(worst_m < 2.0 * error_m, "{worst_m} m of {error_m} m, {} triangles", mesh.triangles.len());
            }
        }
        let counts: Vec<usize> = levels.iter().map(|(_, mesh)| mesh.triangles.len()).collect();
        assert!(counts.is_sorted_by(|one, other| one > other), "{counts:?}");
        let (_, at_one_cm) = levels.iter().rfind(|(error_m, _)| *error_m < 0.012).unwrap();
        assert!(at_one_cm.triangles.len() < own.triangles.len() / 10, "{counts:?}");
    }

    #[test]
    fn borders_of_colours_stay_where_they_are() {
        let (own, posed_m) = tube(None);
        for (error_m, mesh) in reduced(&own, &posed_m).iter().filter(|(error_m, _)| *error_m < 0.02) {
            let colour = |vertex: usize| Vec3::from(mesh.colours[vertex]);
            for (vertex, at_m) in own.positions_m.iter().enumerate().step_by(7) {
                let found = on_mesh(*at_m, mesh, &mesh.positions_m, colour).1;
                let beside_m = (at_m.z - 0.5 * SIZE_M[0]).abs();
                let difference = found.distance(own.colours[vertex].into());
                assert!(beside_m < 0.02 + 2.0 * error_m || difference < 0.2, "{difference} at {at_m} of {error_m} m");
            }
        }
    }

    #[test]
    fn textures_move_no_more_than_the_surface() {
        let (own, posed_m) = tube(Some(0));
        // Metres on the tube for a unit of each coordinate, about.
        let scale_m = Vec3::new(TAU * SIZE_M[1], SIZE_M[0], 0.0);
        for (error_m, mesh) in &reduced(&own, &posed_m) {
            let uv = |mesh: &CharacterMesh, vertex: usize| Vec3::new(mesh.uvs[vertex][0], mesh.uvs[vertex][1], 0.0);
            for (vertex, at_m) in own.positions_m.iter().enumerate().step_by(7) {
                let own_uv = uv(&own, vertex);
                // Vertices of the seam have two.
                if own_uv.x > 0.04 && own_uv.x < 0.96 {
                    let found = on_mesh(*at_m, mesh, &mesh.positions_m, |vertex| uv(mesh, vertex)).1;
                    let moved_m = ((found - own_uv) * scale_m).length();
                    assert!(moved_m < 5.0 * error_m, "{moved_m} m at {own_uv} of {error_m} m");
                }
            }
        }
    }

    /// A mesh of such positions and triangles, all of one joint.
    fn rigid(positions_m: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> CharacterMesh {
        let count = positions_m.len();
        CharacterMesh {
            normals: vec![Vec3::Z; count],
            colours: vec![[0.5; 3]; count],
            joints: vec![[0; 4]; count],
            weights: vec![[1.0, 0.0, 0.0, 0.0]; count],
            materials: vec![material(triangles.len() / 3, None), material(triangles.len() - triangles.len() / 3, None)],
            positions_m,
            triangles,
            ..CharacterMesh::default()
        }
    }

    #[test]
    fn meshes_that_are_no_surfaces_stay_valid() {
        let mut random = SplitMix64::new(3, 9);
        let mut soup = Vec::new();
        for _ in 0..3000 {
            let mut within = |range: f64| random.within(range) as f32;
            soup.push(Vec3::new(within(0.3), within(0.3), within(0.9)));
        }
        let any = (0..6000).map(|_| [0; 3].map(|_| (random.next_u64() % 3000) as u32)).collect();
        let hub = (1..2999).map(|index| [0, index, index + 1]).collect();
        let same = vec![[5, 6, 7]; 500];
        for triangles in [any, hub, same, vec![[1, 1, 2]; 9], Vec::new()] {
            let mesh = rigid(soup.clone(), triangles);
            for (_, level) in reduced(&mesh, &[0; POSES].map(|_| mesh.positions_m.clone())) {
                let of_materials: usize = level.materials.iter().map(|material| material.triangle_count as usize).sum();
                assert_eq!(of_materials, level.triangles.len());
                assert!(
                    level.triangles.as_flattened().iter().all(|corner| (*corner as usize) < level.positions_m.len())
                );
                assert_eq!(level.normals.len(), level.positions_m.len());
            }
        }
    }

    #[test]
    fn levels_are_the_same_for_any_number_of_threads() {
        let (own, posed_m) = tube(None);
        let levels = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| reduced(&own, &posed_m))
        };
        assert!(levels(1) == levels(3));
    }
}
