//! Meshes in the picture: their vertices once, and their triangles for the lines that are drawn. A large picture is drawn
//! strip by strip, and keeps the triangles of one strip.

use std::ops::Range;
use std::sync::OnceLock;

use rayon::prelude::*;

use crate::visibility::lens::Lens;
use crate::visibility::sample_pattern::{SamplePattern, UNITS};
use crate::visibility::scene_parts::Meshes;
use crate::visibility::triangle::{FAR, Projection, ScreenTriangle, screen_position};

/// Number of triangles that are projected at once.
const TRIANGLES_AT_ONCE: usize = 4096;
/// Number of such chunks of each thread that exist at once: the triangles of a large crowd take hundreds of megabytes.
const CHUNKS_OF_THREAD: usize = 8;

/// Meshes as a lens sees them.
pub(crate) struct ScreenMeshes<'a> {
    meshes: &'a Meshes,
    lens: &'a Lens,
    pattern: SamplePattern,
    /// Position of each vertex, units; [`FAR`] for some.
    positions: Vec<[i32; 2]>,
    /// First and last line of each chunk of triangles; made when a part of the picture is drawn.
    lines: OnceLock<Vec<[i32; 2]>>,
}

impl<'a> ScreenMeshes<'a> {
    pub(crate) fn new(meshes: &'a Meshes, lens: &'a Lens, pattern: SamplePattern) -> Self {
        let positions = meshes.positions_m.par_iter().map(|position_m| screen_position(*position_m, lens)).collect();
        Self { meshes, lens, pattern, positions, lines: OnceLock::new() }
    }

    /// The triangles that may hold a sample of some lines, in their order.
    pub(crate) fn visible(&self, lines: Range<u32>) -> Vec<ScreenTriangle> {
        let lines = [lines.start, lines.end].map(|line| line as i32);
        let projection = Projection { lens: self.lens, pattern: self.pattern, lines };
        let mut visible = Vec::new();
        for chunks in self.chunks(lines).chunks(CHUNKS_OF_THREAD * rayon::current_num_threads()) {
            let of_chunks: Vec<Vec<ScreenTriangle>> =
                chunks.par_iter().map(|chunk| self.projected(&projection, *chunk)).collect();
            of_chunks.iter().for_each(|of_chunk| visible.extend_from_slice(of_chunk));
        }
        visible
    }

    /// The chunks of triangles that can touch some lines.
    fn chunks(&self, lines: [i32; 2]) -> Vec<usize> {
        let all = 0..self.meshes.triangles.len().div_ceil(TRIANGLES_AT_ONCE);
        if lines == [0, self.lens.size_px[1] as i32] {
            return all.collect();
        }
        let of_chunks = self.lines.get_or_init(|| {
            self.meshes.triangles.par_chunks(TRIANGLES_AT_ONCE).map(|chunk| self.lines_of(chunk)).collect()
        });
        all.filter(|chunk| of_chunks[*chunk][0] < lines[1] && of_chunks[*chunk][1] >= lines[0]).collect()
    }

    /// First and last line that triangles can touch, in or beside the picture.
    fn lines_of(&self, triangles: &[[u32; 3]]) -> [i32; 2] {
        let (mut low, mut high) = (i32::MAX, i32::MIN);
        for position in triangles.iter().flatten().map(|corner| self.positions[*corner as usize]) {
            if position == FAR {
                return [i32::MIN, i32::MAX];
            }
            (low, high) = (low.min(position[1]), high.max(position[1]));
        }
        [low, high].map(|units| units.div_euclid(UNITS))
    }

    fn projected(&self, projection: &Projection<'_>, chunk: usize) -> Vec<ScreenTriangle> {
        let (meshes, first) = (self.meshes, chunk * TRIANGLES_AT_ONCE);
        let mut visible = Vec::new();
        for index in first..(first + TRIANGLES_AT_ONCE).min(meshes.triangles.len()) {
            let corners = meshes.triangles[index].map(|corner| self.positions[corner as usize]);
            let corners_m = || meshes.corners_m(index);
            projection.append_visible(&mut visible, index as u32, corners, corners_m, meshes.hides_back(index));
        }
        visible
    }
}
