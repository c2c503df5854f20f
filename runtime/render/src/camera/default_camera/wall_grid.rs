//! Edges of walls in a grid on the ground, so that a line of sight meets few of them. World, metres.
//!
//! A line visits the cells that it passes, in their order (Amanatides and Woo 1987).

use glam::{IVec2, Vec2};

/// Least side of a cell, m.
const CELL_MIN_M: f32 = 2.0;
/// Greatest number of cells along a side.
const SIDE_MAX: f32 = 128.0;

/// Share of a cell by which an edge reaches into the next one, so that rounding loses none.
const BORDER: f32 = 1e-3;

/// The foot of an upright wall, and its height.
#[derive(Clone, Copy, Debug)]
pub(super) struct WallEdge {
    pub(super) ends_m: [Vec2; 2],
    pub(super) height_m: f32,
}

/// Edges of walls by the cells that they pass.
pub(super) struct WallGrid {
    edges: Vec<WallEdge>,
    low_m: Vec2,
    cell_m: f32,
    /// Number of cells along x and y.
    sides: IVec2,
    /// Indices of the edges whose boxes meet each cell, row by row.
    of_cell: Vec<Vec<u32>>,
}

impl WallGrid {
    pub(super) fn new(edges: Vec<WallEdge>) -> Self {
        let corners_m = || edges.iter().flat_map(|edge| edge.ends_m);
        let low_m = corners_m().reduce(Vec2::min).unwrap_or(Vec2::ZERO);
        let size_m = corners_m().reduce(Vec2::max).unwrap_or(Vec2::ZERO) - low_m;
        let cell_m = (size_m.max_element() / SIDE_MAX).max(CELL_MIN_M);
        let sides = (size_m / cell_m).as_ivec2() + 1;
        let mut of_cell = vec![Vec::new(); (sides.x * sides.y) as usize];
        for (index, edge) in edges.iter().enumerate() {
            let [from, to] = edge.ends_m.map(|end_m| (end_m - low_m) / cell_m);
            let [low, high] = [from.min(to) - BORDER, from.max(to) + BORDER]
                .map(|cell| cell.as_ivec2().clamp(IVec2::ZERO, sides - 1));
            for row in low.y..=high.y {
                for column in low.x..=high.x {
                    of_cell[(row * sides.x + column) as usize].push(index as u32);
                }
            }
        }
        Self { edges, low_m, cell_m, sides, of_cell }
    }

    /// Edges near the segment between two points; some come more than once.
    pub(super) fn along(&self, ends_m: [Vec2; 2]) -> impl Iterator<Item = &WallEdge> {
        self.cells(ends_m).flat_map(|cell| &self.of_cell[cell]).map(|index| &self.edges[*index as usize])
    }

    /// Cells that the segment between two points passes, in the order of the segment.
    fn cells(&self, ends_m: [Vec2; 2]) -> impl Iterator<Item = usize> + use<> {
        let [from, to] = ends_m.map(|end_m| (end_m - self.low_m) / self.cell_m);
        let ray = to - from;
        let (first, last) = clipped(from, ray, self.sides.as_vec2()).unwrap_or((1.0, 0.0));
        let sides = self.sides;
        let cell_at = |share: f32| (from + share * ray).as_ivec2().clamp(IVec2::ZERO, sides - 1);
        let (mut cell, end) = (cell_at(first), cell_at(last));
        let step = IVec2::new(ray.x.signum() as i32, ray.y.signum() as i32);
        let mut left = if first <= last { (end - cell).abs().element_sum() + 1 } else { 0 };
        std::iter::from_fn(move || {
            left -= 1;
            if left < 0 {
                return None;
            }
            let here = (cell.y * sides.x + cell.x) as usize;
            // The share of the segment at which it leaves the cell, along x and y.
            let border = (cell + step.max(IVec2::ZERO)).as_vec2();
            let leaves = Vec2::new(
                if cell.x == end.x { f32::INFINITY } else { (border.x - from.x) / ray.x },
                if cell.y == end.y { f32::INFINITY } else { (border.y - from.y) / ray.y },
            );
            if leaves.x <= leaves.y {
                cell.x += if cell.x == end.x { 0 } else { step.x };
            } else {
                cell.y += step.y;
            }
            Some(here)
        })
    }
}

/// Shares of a ray, from 0 to 1, at which it enters and leaves a box from the origin; none where it passes beside it.
fn clipped(from: Vec2, ray: Vec2, size: Vec2) -> Option<(f32, f32)> {
    let (mut first, mut last) = (0.0_f32, 1.0_f32);
    for axis in 0..2 {
        if ray[axis] == 0.0 {
            if !(0.0..=size[axis]).contains(&from[axis]) {
                return None;
            }
            continue;
        }
        let [a, b] = [0.0, size[axis]].map(|border| (border - from[axis]) / ray[axis]);
        (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
    }
    (first <= last).then_some((first, last))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether two segments cross.
    fn cross([a, b]: [Vec2; 2], [c, d]: [Vec2; 2]) -> bool {
        let side = |from: Vec2, to: Vec2, at: Vec2| (to - from).perp_dot(at - from);
        side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
    }

    #[test]
    fn a_line_of_sight_meets_every_edge_that_it_crosses() {
        // A made-up sequence of points within 40 m, and some on borders of cells.
        let at_m = |index: u32| {
            let part = |factor: u32| (index.wrapping_mul(factor) >> 16) % 400;
            let point_m = 0.1 * Vec2::new(part(2_654_435_761) as f32, part(2_246_822_519) as f32);
            if index.is_multiple_of(5) { (0.5 * point_m).round() * 2.0 } else { point_m }
        };
        let ends_m = |index: u32| [at_m(2 * index + 1), at_m(2 * index + 2)];
        let edges: Vec<WallEdge> = (0..60).map(|index| WallEdge { ends_m: ends_m(index), height_m: 2.0 }).collect();
        let grid = WallGrid::new(edges.clone());
        let mut crossed = 0;
        for index in 0..400 {
            // Some begin and end outside the walls.
            let line_m = ends_m(7_000 + index).map(|end_m| 1.6 * end_m - 12.0);
            let met: Vec<[Vec2; 2]> = grid.along(line_m).map(|edge| edge.ends_m).collect();
            for edge in edges.iter().filter(|edge| cross(line_m, edge.ends_m)) {
                assert!(met.contains(&edge.ends_m), "{line_m:?} meets {edge:?}");
                crossed += 1;
            }
        }
        assert!(crossed > 1_000, "{crossed}");
    }

    #[test]
    fn a_scene_without_walls_has_a_grid() {
        let grid = WallGrid::new(Vec::new());
        assert_eq!(grid.along([Vec2::ZERO, Vec2::new(1e6, f32::NAN)]).count(), 0);
    }
}
