//! A grid over the edges of all walls, which finds those near a point: each cell lists the edges that pass through it.
//!
//! Built once per scene. An edge is listed in the cells that it crosses, row by row, not in all cells of its bounding
//! box. World, metres.

use glam::Vec2;

/// Number of cells over the number of edges.
const CELLS_PER_EDGE: f32 = 2.0;
/// Least side of a cell, m: a finer grid gains nothing for discs of a quarter of a metre.
const CELL_MIN_M: f32 = 0.5;
/// Margin by which an edge is listed too far, in cells: covers rounding.
const MARGIN_CELLS: f32 = 1e-2;

/// The edges by cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeGrid {
    least_m: Vec2,
    cells_per_m: f32,
    columns: i32,
    rows: i32,
    /// Index of each cell's first entry in `edges`, row by row, and the number of entries.
    starts: Vec<u32>,
    edges: Vec<u32>,
}

impl EdgeGrid {
    /// The grid of edges, given their ends.
    pub(crate) fn new(ends_m: &[[Vec2; 2]]) -> Self {
        let points_m = || ends_m.iter().flatten().copied();
        let least_m = points_m().reduce(Vec2::min).unwrap_or_default();
        let size_m = points_m().reduce(Vec2::max).unwrap_or_default() - least_m;
        let cells = CELLS_PER_EDGE * ends_m.len().max(1) as f32;
        // A long wall has no area; its length over the number of cells bounds their number.
        let cell_m = (size_m.x * size_m.y / cells).sqrt().max((size_m.x + size_m.y) / cells).max(CELL_MIN_M);
        let cells_per_m = 1.0 / cell_m;
        let [columns, rows] = (size_m * cells_per_m).to_array().map(|cells| cells as i32 + 1);
        let mut grid = Self { least_m, cells_per_m, columns, rows, ..Self::default() };
        grid.list(ends_m);
        grid
    }

    /// The edges of all cells that a box touches; an edge may come more than once.
    pub(crate) fn within(&self, least_m: Vec2, most_m: Vec2) -> impl Iterator<Item = u32> {
        let ([left, low], [right, high]) = (self.cell_of(least_m), self.cell_of(most_m));
        let rows = if self.edges.is_empty() { 0..0 } else { low..high + 1 };
        rows.flat_map(move |row| {
            let [first, last] = [left, right].map(|column| (row * self.columns + column) as usize);
            self.edges[self.starts[first] as usize..self.starts[last + 1] as usize].iter().copied()
        })
    }

    /// The edges that a ray in +x from a point may cross; an edge may come more than once.
    pub(crate) fn beyond(&self, point_m: Vec2) -> impl Iterator<Item = u32> {
        self.within(point_m, Vec2::new(f32::MAX, point_m.y))
    }

    /// Column and row of a point; points outside belong to the border cells.
    fn cell_of(&self, point_m: Vec2) -> [i32; 2] {
        let cell = (point_m - self.least_m) * self.cells_per_m;
        [(cell.x as i32).min(self.columns - 1).max(0), (cell.y as i32).min(self.rows - 1).max(0)]
    }

    /// Counting sort of all entries by cell.
    fn list(&mut self, ends_m: &[[Vec2; 2]]) {
        let mut entries: Vec<[u32; 2]> = Vec::new();
        for (edge, &ends_m) in ends_m.iter().enumerate() {
            self.for_each_cell(ends_m, |cell| entries.push([cell, edge as u32]));
        }
        entries.sort_unstable();
        self.edges = entries.iter().map(|&[_, edge]| edge).collect();
        let cells = (self.columns * self.rows) as u32;
        self.starts = (0..=cells).map(|cell| entries.partition_point(|entry| entry[0] < cell) as u32).collect();
    }

    /// Visits every cell that an edge passes through.
    fn for_each_cell(&self, ends_m: [Vec2; 2], mut visit: impl FnMut(u32)) {
        let [from, to] = ends_m.map(|end_m| (end_m - self.least_m) * self.cells_per_m);
        let (low, high) = if from.y <= to.y { (from, to) } else { (to, from) };
        let inside = |cell: f32, count: i32| (cell as i32).clamp(0, count - 1);
        for row in inside(low.y - MARGIN_CELLS, self.rows)..=inside(high.y + MARGIN_CELLS, self.rows) {
            // The stretch of the edge within the row.
            let at = |y: f32| low.lerp(high, ((y - low.y) / (high.y - low.y)).clamp(0.0, 1.0)).x;
            let level = high.y - low.y < MARGIN_CELLS;
            let (first, last) = if level {
                (low.x, high.x)
            } else {
                (at(row as f32 - MARGIN_CELLS), at(row as f32 + 1.0 + MARGIN_CELLS))
            };
            let columns = [first.min(last) - MARGIN_CELLS, first.max(last) + MARGIN_CELLS];
            for column in inside(columns[0], self.columns)..=inside(columns[1], self.columns) {
                visit((row * self.columns + column) as u32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maths::random::SplitMix64;
    use crate::world::segment::nearest_on_segment;

    fn vector(random: &mut SplitMix64, bound_m: f64) -> Vec2 {
        Vec2::new(random.within(bound_m) as f32, random.within(bound_m) as f32)
    }

    fn check(ends_m: &[[Vec2; 2]], random: &mut SplitMix64) {
        let grid = EdgeGrid::new(ends_m);
        for _ in 0..300 {
            let (point_m, reach_m) = (vector(random, 60.0), random.within(1.0).abs() as f32 * 8.0);
            let found: Vec<u32> = grid.within(point_m - reach_m, point_m + reach_m).collect();
            let crossed: Vec<u32> = grid.beyond(point_m).collect();
            for (edge, &[from_m, to_m]) in ends_m.iter().enumerate() {
                let near = nearest_on_segment(point_m, from_m, to_m).distance(point_m) <= reach_m;
                assert!(!near || found.contains(&(edge as u32)), "{point_m} {reach_m} {from_m} {to_m}");
                let share = (point_m.y - from_m.y) / (to_m.y - from_m.y);
                let crosses = (from_m.y > point_m.y) != (to_m.y > point_m.y) && from_m.lerp(to_m, share).x > point_m.x;
                assert!(!crosses || crossed.contains(&(edge as u32)), "{point_m} {from_m} {to_m}");
            }
        }
    }

    #[test]
    fn no_near_or_crossed_edge_is_missed() {
        let mut random = SplitMix64::new(1, 0);
        let long: Vec<[Vec2; 2]> = (0..40).map(|_| [vector(&mut random, 50.0), vector(&mut random, 50.0)]).collect();
        check(&long, &mut random);
        let mut short = |_| {
            let from_m = vector(&mut random, 50.0);
            [from_m, from_m + vector(&mut random, 1.0)]
        };
        let short: Vec<[Vec2; 2]> = (0..400).map(&mut short).collect();
        check(&short, &mut SplitMix64::new(2, 0));
        check(&[[Vec2::new(-40.0, 3.0), Vec2::new(50.0, 3.0)]], &mut SplitMix64::new(3, 0));
        check(&[], &mut SplitMix64::new(4, 0));
    }

    #[test]
    fn few_of_many_edges_are_visited() {
        let post = |index: i32| {
            let at_m = Vec2::new((index % 100) as f32, (index / 100) as f32) * 3.0;
            [at_m, at_m + Vec2::new(0.5, 0.2)]
        };
        let grid = EdgeGrid::new(&(0..10_000).map(post).collect::<Vec<_>>());
        let at_m = Vec2::new(150.0, 150.0);
        assert!(grid.within(at_m - 4.0, at_m + 4.0).count() < 60 && grid.beyond(at_m).count() < 300);
    }
}
