//! The levels of detail of one character.

use motiondb::body::Skeleton;
use motiondb::character::{CharacterFit, CharacterMesh, Material};

use crate::detail::example_poses::posed_m;
use crate::detail::reduction::Reduction;
use crate::detail::surface::Surface;

/// Error of the finest level, at the crowd's size, m.
const FINEST_M: f32 = 0.001;
/// Error of a level over that of the next finer one.
const STEP: f32 = std::f32::consts::SQRT_2;
/// Number of levels: the coarsest has an error of 9 cm.
const LEVELS: usize = 14;
/// Greatest share of triangles that a level has of the next finer one; levels with more are left out.
const SHARE_MAX: f32 = 0.8;
/// Error that is not seen, pixels.
const UNSEEN_PX: f32 = 0.3;

/// A character's own mesh and reduced ones.
#[derive(Clone, Debug)]
pub(crate) struct Levels<'a> {
    own: &'a CharacterMesh,
    /// Reduced meshes by rising error, m.
    reduced: Vec<(f32, CharacterMesh)>,
}

impl<'a> Levels<'a> {
    /// The levels of a character on a skeleton.
    pub(crate) fn new(fit: &CharacterFit<'a>, skeleton: &Skeleton) -> Self {
        let own = &fit.character.mesh;
        let mut reduction = Reduction::new(Surface::new(own, &posed_m(fit, skeleton)), &own.normals);
        let (mut reduced, mut count) = (Vec::new(), own.triangles.len());
        let errors_m = std::iter::successors(Some(FINEST_M), |error_m| Some(STEP * error_m)).take(LEVELS);
        for error_m in errors_m {
            reduction.reduce(f64::from(error_m));
            let left = reduction.left().count();
            if left > 0 && left as f32 <= SHARE_MAX * count as f32 {
                reduced.push((error_m, left_of(own, &reduction)));
                count = left;
            }
        }
        Self { own, reduced }
    }

    /// The coarsest mesh whose errors are not seen where a pixel is so wide on the body, m.
    pub(crate) fn of_pixel(&self, pixel_m: f32) -> &CharacterMesh {
        let fine = self.reduced.iter().take_while(|(error_m, _)| *error_m <= UNSEEN_PX * pixel_m);
        fine.last().map_or(self.own, |(_, mesh)| mesh)
    }
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
