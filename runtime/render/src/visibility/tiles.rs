//! All tiles of a picture, in parallel. Each tile depends only on the scene and the lens, and the parts of a tile are
//! drawn in their order, so that any number of threads gives the same bits.

use std::ops::Range;

use glam::Vec3;
use motiondb::character::CutOut;
use rayon::prelude::*;

use crate::visibility::lens::{GroundDepth, Lens};
use crate::visibility::part::PartId;
use crate::visibility::rounded_cone::PreparedCone;
use crate::visibility::sample_pattern::SamplePattern;
use crate::visibility::scene_parts::SceneParts;
use crate::visibility::screen_bounds::{PixelBounds, cone_bounds};
use crate::visibility::screen_meshes::ScreenMeshes;
use crate::visibility::tile_samples::TileSamples;
use crate::visibility::triangle::{ScreenTriangle, weights};

/// Side of a tile, pixels: its samples fit the first cache.
pub(crate) const TILE_PX: u32 = 32;
/// A cone, and the pixels that it can touch.
struct VisibleCone {
    shape: PreparedCone,
    part: PartId,
    bounds: PixelBounds,
}

/// The parts that can touch each tile of some rows, in their order.
struct TileLists {
    /// Rows of tiles, and the number of tiles of a row.
    rows: Range<u32>,
    columns: u32,
    /// Index of the first entry of each tile, and the number of entries.
    starts: Vec<u32>,
    entries: Vec<u32>,
}

/// Calls a function for each tile, in parallel, and returns the results row by row. The ground is drawn where there is
/// one. Parts are numbered cones first, then triangles.
pub(crate) fn for_each_tile<T: Send>(
    scene: &SceneParts,
    lens: &Lens,
    pattern: SamplePattern,
    ground: Option<GroundDepth>,
    function: impl Fn(&mut TileSamples<'_>) -> T + Sync,
) -> Vec<T> {
    let tiles = PreparedTiles::new(scene, lens, pattern);
    tiles.draw(ground, 0..tiles.sides[1], function)
}

/// The parts of a scene that a lens sees, by tiles.
pub(crate) struct PreparedTiles<'a> {
    scene: &'a SceneParts,
    lens: &'a Lens,
    pattern: SamplePattern,
    cones: Vec<VisibleCone>,
    cone_lists: TileLists,
    meshes: ScreenMeshes<'a>,
    /// Number of tiles along width and height.
    sides: [u32; 2],
}

impl<'a> PreparedTiles<'a> {
    pub(crate) fn new(scene: &'a SceneParts, lens: &'a Lens, pattern: SamplePattern) -> Self {
        let (cones, sides) = (visible_cones(scene, lens), lens.size_px.map(|side| side.div_ceil(TILE_PX)));
        let cone_lists = TileLists::new(sides[0], 0..sides[1], &cones, |cone| cone.bounds);
        let meshes = ScreenMeshes::new(&scene.meshes, lens, pattern);
        Self { scene, lens, pattern, cones, cone_lists, meshes, sides }
    }

    /// As [`for_each_tile`], for some rows of tiles.
    pub(crate) fn draw<T: Send>(
        &self,
        ground: Option<GroundDepth>,
        rows: Range<u32>,
        function: impl Fn(&mut TileSamples<'_>) -> T + Sync,
    ) -> Vec<T> {
        let Self { scene, lens, pattern, .. } = *self;
        let columns = self.sides[0];
        let triangles = self.meshes.visible(rows.start * TILE_PX..(rows.end * TILE_PX).min(lens.size_px[1]));
        let triangle_lists =
            TileLists::new(columns, rows.clone(), &triangles, |triangle| triangle.bounds(lens.size_px));
        let draw = |tile: u32| {
            let corner_px = [tile % columns * TILE_PX, tile / columns * TILE_PX];
            let mut samples = TileSamples::new(lens, pattern, corner_px, TILE_PX);
            if let Some(ground) = &ground {
                samples.put_ground(ground);
            }
            for cone in self.cone_lists.of(tile).map(|index| &self.cones[index]) {
                samples.draw_cone(&cone.shape, cone.part, cone.bounds);
            }
            for triangle in triangle_lists.of(tile).map(|index| &triangles[index]) {
                draw_triangle(&mut samples, scene, lens, pattern, triangle);
            }
            function(&mut samples)
        };
        (rows.start * columns..rows.end * columns).into_par_iter().map(draw).collect()
    }
}

/// Draws a triangle; where its paint is cut out or blended, only the samples that its alpha covers.
fn draw_triangle(
    samples: &mut TileSamples<'_>,
    scene: &SceneParts,
    lens: &Lens,
    pattern: SamplePattern,
    triangle: &ScreenTriangle,
) {
    let (bounds, index) = (triangle.bounds(lens.size_px), triangle.index as usize);
    let part = PartId(scene.cones.len() as u32 + triangle.index);
    match scene.meshes.paint(index).map_or(CutOut::Opaque, |paint| paint.cut_out) {
        CutOut::Opaque => samples.draw_triangle(triangle, part, bounds, |_, _, _| true),
        cut_out => samples.draw_triangle(triangle, part, bounds, |uv, depth_m, sample| {
            let threshold = threshold(cut_out, sample, pattern.count());
            alpha(scene, lens, index, lens.at_depth(uv, depth_m)) >= threshold
        }),
    }
}

/// Alpha of a textured triangle at a point of camera space.
fn alpha(scene: &SceneParts, lens: &Lens, triangle: usize, point_m: Vec3) -> f32 {
    let weights = weights(scene.meshes.corners_m(triangle), lens.to_world(point_m));
    scene.texel(triangle, weights, lens.pixel_m(point_m.z)).map_or(1.0, |texel| texel.w)
}

/// Alpha from which a sample is covered. Blended surfaces cover as many samples of a pixel as their alpha states.
fn threshold(cut_out: CutOut, sample: usize, count: usize) -> f32 {
    match cut_out {
        CutOut::Opaque => 0.0,
        CutOut::Below(alpha) => alpha.max(f32::MIN_POSITIVE),
        // Samples in bit-reversed order, so that those of one share lie apart.
        CutOut::Blended => {
            let reversed = (sample as u32).reverse_bits() >> (32 - count.trailing_zeros()).min(31);
            (if count > 1 { reversed as f32 } else { 0.0 } + 0.5) / count as f32
        }
    }
}

fn visible_cones(scene: &SceneParts, lens: &Lens) -> Vec<VisibleCone> {
    let prepare = |(index, cone)| {
        let shape = PreparedCone::new(cone, lens);
        let bounds = cone_bounds(&shape, lens)?;
        Some(VisibleCone { shape, part: PartId(index as u32), bounds })
    };
    scene.cones.par_iter().enumerate().filter_map(prepare).collect()
}

impl TileLists {
    /// A counting sort of shapes by tile.
    fn new<T>(columns: u32, rows: Range<u32>, shapes: &[T], bounds: impl Fn(&T) -> PixelBounds) -> Self {
        let tiles_of = |shape: &T| {
            let [first, last] = bounds(shape).map(|corner| corner.map(|at| at / TILE_PX));
            let touched = first[1].max(rows.start)..(last[1] + 1).min(rows.end);
            let first_row = rows.start;
            touched.flat_map(move |row| (first[0]..=last[0]).map(move |column| (row - first_row) * columns + column))
        };
        let mut starts = vec![0; columns as usize * rows.len() + 1];
        for tile in shapes.iter().flat_map(tiles_of) {
            starts[tile as usize + 1] += 1;
        }
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut next = starts.clone();
        let mut entries = vec![0; starts[starts.len() - 1] as usize];
        for (index, shape) in shapes.iter().enumerate() {
            for tile in tiles_of(shape) {
                entries[next[tile as usize] as usize] = index as u32;
                next[tile as usize] += 1;
            }
        }
        Self { rows, columns, starts, entries }
    }

    /// The parts of a tile of the picture, by its index.
    fn of(&self, tile: u32) -> impl Iterator<Item = usize> {
        let at = (tile - self.rows.start * self.columns) as usize;
        let (from, to) = (self.starts[at] as usize, self.starts[at + 1] as usize);
        self.entries[from..to].iter().map(|index| *index as usize)
    }
}

#[cfg(test)]
mod tests {
    use fbcrowd_sim::maths::SplitMix64;
    use glam::Vec2;
    use motiondb::character::{CharacterTexture, Dye, Wrap};

    use super::*;
    use crate::visibility::closed_triangles;
    use crate::visibility::owner::Owner;
    use crate::visibility::scene_parts::{Cone, Paint};
    use crate::visibility::texture::Texture;

    fn random_scene(random: &mut SplitMix64, cones: usize, triangles: usize) -> SceneParts {
        let mut scene = SceneParts::default();
        let mut within = |range: f64| random.within(range) as f32;
        for _ in 0..cones {
            let from = Vec3::new(within(4.0), within(6.0), within(2.0));
            let ends_m = [from, from + Vec3::new(within(0.7), within(0.7), within(0.7))];
            let radii_m = [0.2 + within(0.15), 0.2 + within(0.15)];
            scene.cones.push(Cone { ends_m, radii_m, colour: Vec3::ONE, owner: Owner::SCENE });
        }
        for _ in 0..triangles {
            let centre = Vec3::new(within(4.0), within(6.0), within(2.0));
            let corners_m = [0; 3].map(|_| centre + Vec3::new(within(1.5), within(1.5), within(1.5)));
            scene.meshes.append(&corners_m, &[Vec3::Z; 3], &[Vec3::ONE; 3], &[[0, 1, 2]], Owner::SCENE);
        }
        scene
    }

    fn lenses() -> [Lens; 2] {
        // Parts lie behind the eye, before it and across its plane.
        let size_px = [90, 70];
        let eye_m = Vec3::new(0.1, -1.5, 0.3);
        [
            Lens::perspective(size_px, eye_m, Vec3::new(0.4, 4.0, 0.1), 1.3),
            Lens::orthographic(size_px, eye_m, Vec3::new(0.2, 1.0, -0.3), 7.0),
        ]
    }

    /// Depth at which a ray meets a triangle (Möller and Trumbore 1997), in f64; none near an edge is decided.
    fn cast(lens: &Lens, uv: Vec2, corners_m: [Vec3; 3]) -> (Option<f64>, bool) {
        let near = lens.at_depth(uv, 0.0).as_dvec3();
        let direction = lens.at_depth(uv, 1.0).as_dvec3() - near;
        let [a, b, c] = corners_m.map(|corner| lens.to_camera(corner).as_dvec3());
        let (first, second) = (b - a, c - a);
        let across = direction.cross(second);
        let scale = first.dot(across);
        let offset = near - a;
        let u = offset.dot(across) / scale;
        let around = offset.cross(first);
        let v = direction.dot(around) / scale;
        let least = u.min(v).min(1.0 - u - v);
        let depth_m = second.dot(around) / scale;
        ((least >= 0.0 && depth_m >= 0.1).then_some(depth_m), least.abs() < 2e-2 || (depth_m - 0.1).abs() < 1e-2)
    }

    #[test]
    fn triangles_are_where_rays_meet_them() {
        let mut random = SplitMix64::new(5, 8);
        let (mut hits, mut wrong) = (0, 0);
        for lens in &lenses() {
            for _ in 0..30 {
                let scene = random_scene(&mut random, 0, 1);
                let corners_m = scene.meshes.corners_m(0);
                let tiles = for_each_tile(&scene, lens, SamplePattern::Four, None, |tile| {
                    let samples = 0..tile.parts.len();
                    samples.map(|sample| (tile.uv(sample), tile.depths_m[sample])).collect::<Vec<_>>()
                });
                for (uv, depth_m) in tiles.into_iter().flatten() {
                    let (expected_m, is_edge) = cast(lens, uv, corners_m);
                    hits += usize::from(depth_m.is_finite());
                    if !is_edge && depth_m.is_finite() != expected_m.is_some() {
                        wrong += 1;
                    } else if let (true, Some(expected_m)) = (depth_m.is_finite(), expected_m) {
                        assert!((f64::from(depth_m) - expected_m).abs() < 2e-3 * expected_m.max(1.0));
                    }
                }
            }
        }
        assert!(hits > 10_000 && wrong == 0, "{hits} hits, {wrong} wrong");
    }

    #[test]
    fn triangles_with_a_common_edge_leave_no_gap() {
        // A fan around a point, through which no sample may look.
        let mut scene = SceneParts::default();
        let mut random = SplitMix64::new(4, 4);
        let centre = Vec3::new(random.within(0.3) as f32, 2.0, random.within(0.3) as f32);
        let rim = |index: usize| {
            let (sin, cos) = libm::sincosf(index as f32 * std::f32::consts::TAU / 23.0);
            Vec3::new(40.0 * cos, 2.0, 40.0 * sin)
        };
        for index in 0..23 {
            let corners_m = [centre, rim(index), rim(index + 1)];
            scene.meshes.append(&corners_m, &[Vec3::Y; 3], &[Vec3::ONE; 3], &[[0, 1, 2]], Owner::SCENE);
        }
        let tiles = for_each_tile(&scene, &lenses()[0], SamplePattern::Sixteen, None, |tile| {
            tile.parts.iter().filter(|part| **part == PartId::SKY).count()
        });
        assert_eq!(tiles.iter().sum::<usize>(), 0);
    }

    #[test]
    fn backs_of_closed_surfaces_change_no_picture() {
        let mut random = SplitMix64::new(6, 2);
        let mut within = |range: f64| random.within(range) as f32;
        let mut open = SceneParts::default();
        for _ in 0..40 {
            // Corners in an order that faces outwards.
            let centre_m = Vec3::new(within(4.0), 6.0 + within(3.0), within(2.0));
            let mut corners_m = [0; 4].map(|_| centre_m + Vec3::new(within(0.8), within(0.8), within(0.8)));
            let [a, b, c, d] = corners_m;
            if (b - a).cross(c - a).dot(d - a) < 0.0 {
                corners_m.swap(0, 1);
            }
            let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
            open.meshes.append(&corners_m, &[Vec3::Z; 4], &[Vec3::ONE; 4], &triangles, Owner::SCENE);
        }
        let meshes = &open.meshes;
        let mut closed = open.clone();
        closed
            .meshes
            .close(&closed_triangles(&meshes.triangles, meshes.positions_m.len(), |at| meshes.positions_m[at]));
        assert!(closed.meshes.closed.iter().all(|is_closed| *is_closed));
        for lens in &lenses() {
            let depths_m = |scene: &SceneParts| {
                for_each_tile(scene, lens, SamplePattern::Four, None, |tile| tile.depths_m.clone()).concat()
            };
            let [of_open, of_closed] = [&open, &closed].map(depths_m);
            assert!(of_open.iter().filter(|depth_m| depth_m.is_finite()).count() > 1_000);
            for (of_open, of_closed) in of_open.into_iter().zip(of_closed) {
                assert!(of_open == of_closed || (of_open - of_closed).abs() < 0.02, "{of_open} {of_closed}");
            }
        }
    }

    #[test]
    fn tiles_are_the_same_for_any_number_of_threads() {
        let scene = random_scene(&mut SplitMix64::new(1, 1), 60, 60);
        let draw = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let lens = lenses()[0];
            pool.install(|| {
                for_each_tile(&scene, &lens, SamplePattern::Four, Some(lens.ground()), |tile| {
                    (tile.depths_m.iter().map(|depth_m| depth_m.to_bits()).collect::<Vec<_>>(), tile.parts.clone())
                })
            })
        };
        let once = draw(1);
        assert!(once == draw(3));
        let parts: std::collections::BTreeSet<_> = once.iter().flat_map(|(_, parts)| parts).collect();
        assert!(parts.len() > 15, "{} parts are visible", parts.len());
    }

    #[test]
    fn rows_that_are_drawn_alone_are_those_of_the_whole() {
        // Before the eye, from below to above, so that each row of tiles needs some chunks of triangles.
        let mut scene = random_scene(&mut SplitMix64::new(9, 3), 20, 30_000);
        let (positions_m, triangles) = (&scene.meshes.positions_m, &mut scene.meshes.triangles);
        triangles.retain(|corners| corners.iter().all(|corner| positions_m[*corner as usize].y > 0.0));
        assert!(triangles.len() > 10_000);
        triangles.sort_by(|a, b| positions_m[a[0] as usize].z.total_cmp(&positions_m[b[0] as usize].z));
        for lens in &lenses() {
            let tiles = PreparedTiles::new(&scene, lens, SamplePattern::One);
            let draw = |rows: Range<u32>| tiles.draw(None, rows, |tile| (tile.depths_m.clone(), tile.parts.clone()));
            assert!(draw(0..3) == [draw(0..1), draw(1..3)].concat());
        }
    }

    #[test]
    fn the_nearest_cone_is_that_of_each_sample() {
        let scene = random_scene(&mut SplitMix64::new(7, 7), 40, 0);
        for lens in &lenses() {
            let prepared: Vec<PreparedCone> = scene.cones.iter().map(|cone| PreparedCone::new(cone, lens)).collect();
            for_each_tile(&scene, lens, SamplePattern::Four, None, |tile| {
                for sample in 0..tile.parts.len() {
                    let uv = tile.uv(sample);
                    let nearest_m =
                        prepared.iter().filter_map(|cone| cone.depth_m(uv)).filter(|depth_m| *depth_m > 0.0);
                    let nearest_m = nearest_m.fold(f32::INFINITY, f32::min);
                    let found_m = tile.depths_m[sample];
                    assert!(found_m == nearest_m || (found_m - nearest_m).abs() < 1e-3, "{found_m} {nearest_m}");
                }
            });
        }
    }

    /// A square 2 m wide at a depth of 2 m with a texture whose left half has an alpha; returns how many of its samples
    /// are covered, on the left and on the right.
    fn covered(alpha: u8, cut_out: CutOut, pattern: SamplePattern) -> [usize; 2] {
        let pixels = [[255, 0, 0, alpha], [255, 0, 0, 255]].concat();
        let texture = CharacterTexture { size_px: [2, 1], wraps: [Wrap::Clamp; 2], pixels };
        let textures = std::sync::Arc::new(vec![Texture::new(&texture, 0)]);
        let mut scene = SceneParts { textures, ..SceneParts::default() };
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let corners_m = corners.map(|[u, v]| Vec3::new(2.0 * u - 1.0, 2.0, 2.0 * v - 1.0));
        scene.meshes.append(&corners_m, &[Vec3::Y; 4], &[Vec3::ONE; 4], &[[0, 1, 2], [0, 2, 3]], Owner::SCENE);
        let paint = Paint { texture: 0, cut_out, dye: Dye::default(), keeps_hue: false };
        scene.meshes.texture(corners.into_iter().map(Vec2::from), [(2, Some(paint))].into_iter());
        let lens = Lens::perspective([64, 64], Vec3::ZERO, Vec3::Y, 1.0);
        let tiles = for_each_tile(&scene, &lens, pattern, None, |tile| {
            let is_covered = |sample: &usize| tile.depths_m[*sample].is_finite();
            let samples = (0..tile.parts.len()).filter(is_covered).map(|sample| tile.uv(sample).x);
            let (left, right): (Vec<f32>, Vec<f32>) = samples.filter(|u| u.abs() > 0.3).partition(|u| *u < 0.0);
            [left.len(), right.len()]
        });
        tiles.iter().fold([0; 2], |sum, tile| [sum[0] + tile[0], sum[1] + tile[1]])
    }

    #[test]
    fn alpha_hides_samples() {
        let [all, right] = covered(255, CutOut::Opaque, SamplePattern::Sixteen);
        assert!(all > 10_000 && all.abs_diff(right) < all / 50, "{all} {right}");
        assert_eq!(covered(0, CutOut::Opaque, SamplePattern::Sixteen)[0], all);
        assert_eq!(covered(120, CutOut::Below(0.5), SamplePattern::Sixteen), [0, right]);
        let shares = |[left, _]: [usize; 2], expected: usize| left.abs_diff(expected) < expected / 20;
        assert!(shares(covered(140, CutOut::Below(0.5), SamplePattern::Four), all / 4));
        // A quarter, and half, of the samples.
        assert!(shares(covered(64, CutOut::Blended, SamplePattern::Sixteen), all / 4));
        assert!(shares(covered(128, CutOut::Blended, SamplePattern::Four), all / 8));
    }
}
