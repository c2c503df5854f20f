//! A uniform grid over the agents, and grids within its crowded cells: the memory layout that a search walks over.
//!
//! A grid has one cell for every three agents. Where they are spread unevenly (a crowd and a
//! straggler a kilometre away) most agents fall into few cells, so a crowded cell gets a grid of its own over its own
//! box, and so on. Positions outside a grid belong to its border cells. Every cell number comes from one monotone
//! function of a coordinate, so what lies between two coordinates lies in the cells between theirs, rounding included.
//! World, metres.

use std::ops::Range;

use glam::Vec2;

/// Agents per cell on average. From 2 to 4 the time of a search hardly changes.
const AGENTS_PER_CELL: f32 = 3.0;
/// Agents in a cell from which a grid of its own pays off: more than a jam puts into a cell of a loose crowd.
const CROWDED: usize = 48;
/// Greatest depth of grids within grids. Each level divides the number of agents or, for a straggler, the box.
const DEPTH_MAX: usize = 16;
/// Least side of a cell, m: agents nearer to each other share one cell.
const CELL_MIN_M: f32 = 1e-6;
/// Index that stands for no grid.
const NO_GRID: u32 = u32::MAX;

/// One grid over the box of its agents.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellGrid {
    /// Lower left corner of the box, m.
    pub(crate) least_m: Vec2,
    /// Upper right corner of the box, m.
    pub(crate) most_m: Vec2,
    cells_per_m: f32,
    columns: i32,
    rows: i32,
    /// Index of its first cell in [`CellLayout::starts`]; its cells follow row by row.
    first_cell: usize,
    /// Whether some of its cells have grids of their own.
    has_crowded: bool,
}

/// A rectangle of cells: first and last column and row, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CellWindow {
    /// First and last column.
    pub(crate) columns: [i32; 2],
    /// First and last row.
    pub(crate) rows: [i32; 2],
}

/// All grids of a crowd, the outermost first, and the agents in cell order.
#[derive(Clone, Debug, Default)]
pub(crate) struct CellLayout {
    /// The grids; the first covers all agents.
    pub(crate) grids: Vec<CellGrid>,
    /// Indices of the agents, cell by cell.
    pub(crate) agents: Vec<u32>,
    /// First slot in `agents` of each cell of each grid; after the cells of a grid, their end.
    starts: Vec<u32>,
    /// Index of each cell's own grid, beside `starts`.
    inner: Vec<u32>,
    // Working memory of one counting sort.
    cells: Vec<u32>,
    unsorted: Vec<u32>,
}

/// What a run of cells consists of.
pub(crate) enum CellRun {
    /// Slots of [`CellLayout::agents`].
    Slots(Range<usize>),
    /// Index of the grid of a crowded cell.
    Grid(usize),
}

impl CellGrid {
    /// The box of all positions, with [`AGENTS_PER_CELL`] on average.
    fn over(positions_m: impl ExactSizeIterator<Item = Vec2>) -> Self {
        let count = positions_m.len() as f32;
        let empty = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        let (least_m, most_m) = positions_m.fold(empty, |(least, most), at| (least.min(at), most.max(at)));
        let (least_m, most_m) = if count == 0.0 { (Vec2::ZERO, Vec2::ZERO) } else { (least_m, most_m) };
        let size_m = most_m - least_m;
        let by_density_m = (size_m.x * size_m.y * AGENTS_PER_CELL / count.max(1.0)).sqrt();
        // A long line of agents has no area; its length divided by their number bounds the number of cells.
        let by_length_m = (size_m.x + size_m.y) / count.max(1.0);
        let cells_per_m = 1.0 / by_density_m.max(by_length_m).max(CELL_MIN_M);
        let cells = size_m * cells_per_m;
        let [columns, rows] = [cells.x as i32 + 1, cells.y as i32 + 1];
        Self { least_m, most_m, cells_per_m, columns, rows, first_cell: 0, has_crowded: false }
    }

    fn cell_count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// Column and row of a position; positions outside belong to the border cells.
    pub(crate) fn cell_of(&self, position_m: Vec2) -> [i32; 2] {
        let cell = (position_m - self.least_m) * self.cells_per_m;
        [(cell.x as i32).clamp(0, self.columns - 1), (cell.y as i32).clamp(0, self.rows - 1)]
    }

    /// The cells of all agents that are no farther than `reach_m` from a position.
    pub(crate) fn within(&self, position_m: Vec2, reach_m: f32) -> CellWindow {
        let [least, most] = [-reach_m, reach_m].map(|by_m| self.cell_of(position_m + by_m));
        CellWindow { columns: [least[0], most[0]], rows: [least[1], most[1]] }
    }

    /// Distance of a position from the box, m; 0 inside.
    pub(crate) fn distance_m(&self, position_m: Vec2) -> f32 {
        position_m.distance(position_m.clamp(self.least_m, self.most_m))
    }
}

impl CellWindow {
    /// The cells that are no more than `ring` columns and rows from one cell.
    pub(crate) fn around([column, row]: [i32; 2], ring: i32) -> Self {
        Self { columns: [column - ring, column + ring], rows: [row - ring, row + ring] }
    }

    /// The window, widened by half its size on each side.
    pub(crate) fn doubled(&self) -> Self {
        let wider = |[first, last]: [i32; 2]| {
            let more = (last - first) / 2 + 1;
            [first.saturating_sub(more), last.saturating_add(more)]
        };
        Self { columns: wider(self.columns), rows: wider(self.rows) }
    }

    /// The cells that both windows hold.
    pub(crate) fn and(&self, other: &Self) -> Self {
        let both = |a: [i32; 2], b: [i32; 2]| [a[0].max(b[0]), a[1].min(b[1])];
        Self { columns: both(self.columns, other.columns), rows: both(self.rows, other.rows) }
    }
}

impl CellLayout {
    /// Sorts the agents into cells; within a cell they stay in order of index.
    pub(crate) fn rebuild(&mut self, positions_m: &[Vec2]) {
        self.grids.clear();
        self.starts.clear();
        self.inner.clear();
        self.agents.clear();
        self.agents.extend(0..positions_m.len() as u32);
        self.add_grid(positions_m, 0..positions_m.len(), 0);
    }

    /// Visits the cells from the first to the last column of a row: slots in runs, crowded cells as grids.
    pub(crate) fn runs(&self, grid: &CellGrid, row: i32, [first, last]: [i32; 2], mut visit: impl FnMut(CellRun)) {
        let row = grid.first_cell + (row * grid.columns) as usize;
        let [first, last] = [first, last].map(|column| row + column as usize);
        if !grid.has_crowded {
            return visit(CellRun::Slots(self.starts[first] as usize..self.starts[last + 1] as usize));
        }
        for cell in first..=last {
            match self.inner[cell] {
                NO_GRID => visit(CellRun::Slots(self.starts[cell] as usize..self.starts[cell + 1] as usize)),
                inner => visit(CellRun::Grid(inner as usize)),
            }
        }
    }

    fn add_grid(&mut self, positions_m: &[Vec2], slots: Range<usize>, depth: usize) -> u32 {
        let index = self.grids.len();
        let grid = CellGrid::over(self.agents[slots.clone()].iter().map(|&agent| positions_m[agent as usize]));
        let grid = CellGrid { first_cell: self.starts.len(), ..grid };
        self.grids.push(grid);
        self.sort(&grid, positions_m, slots);
        if depth < DEPTH_MAX && grid.most_m != grid.least_m {
            self.add_inner_grids(index, positions_m, depth + 1);
        }
        index as u32
    }

    fn add_inner_grids(&mut self, index: usize, positions_m: &[Vec2], depth: usize) {
        let grid = self.grids[index];
        for cell in grid.first_cell..grid.first_cell + grid.cell_count() {
            let slots = self.starts[cell] as usize..self.starts[cell + 1] as usize;
            if slots.len() > CROWDED {
                self.inner[cell] = self.add_grid(positions_m, slots, depth);
                self.grids[index].has_crowded = true;
            }
        }
    }

    /// Counting sort of the agents in a range of slots.
    fn sort(&mut self, grid: &CellGrid, positions_m: &[Vec2], slots: Range<usize>) {
        self.unsorted.clear();
        self.unsorted.extend_from_slice(&self.agents[slots.clone()]);
        self.cells.clear();
        self.cells.extend(self.unsorted.iter().map(|&agent| {
            let [column, row] = grid.cell_of(positions_m[agent as usize]);
            (row * grid.columns + column) as u32
        }));
        self.starts.resize(grid.first_cell + grid.cell_count() + 1, 0);
        self.inner.resize(self.starts.len(), NO_GRID);
        let starts = &mut self.starts[grid.first_cell..];
        for &cell in &self.cells {
            starts[cell as usize + 1] += 1;
        }
        starts[0] = slots.start as u32;
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        // Each start advances through its cell until it equals the next cell's; shifted by one, all are right again.
        for (&agent, &cell) in self.unsorted.iter().zip(&self.cells) {
            let slot = &mut starts[cell as usize];
            self.agents[*slot as usize] = agent;
            *slot += 1;
        }
        starts.rotate_right(1);
        starts[0] = slots.start as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maths::random::SplitMix64;

    const COUNT: usize = 20_000;

    fn within(random: &mut SplitMix64, bound_m: f64) -> Vec2 {
        Vec2::new(random.within(bound_m) as f32, random.within(bound_m) as f32)
    }

    /// Every agent lies in exactly one cell, no cell is crowded, and there are not many cells.
    fn check(positions_m: &[Vec2]) {
        let mut layout = CellLayout::default();
        layout.rebuild(positions_m);
        let mut agents = layout.agents.clone();
        agents.sort_unstable();
        assert!(agents.iter().copied().eq(0..positions_m.len() as u32));
        assert!(layout.starts.len() <= 2 * positions_m.len() + 8, "{} cells", layout.starts.len());
        let mut seen = 0;
        for grid in &layout.grids {
            for row in 0..grid.rows {
                for column in 0..grid.columns {
                    layout.runs(grid, row, [column; 2], |run| {
                        let CellRun::Slots(slots) = run else { return };
                        seen += slots.len();
                        let mut in_cell = layout.agents[slots.clone()].iter().map(|&agent| positions_m[agent as usize]);
                        let first_m = in_cell.next();
                        assert!(slots.len() <= CROWDED || in_cell.all(|at| Some(at) == first_m), "{}", slots.len());
                    });
                }
            }
        }
        assert_eq!(seen, positions_m.len());
    }

    #[test]
    fn no_cell_is_crowded_in_an_uneven_crowd() {
        let mut random = SplitMix64::new(1, 0);
        let crowd: Vec<Vec2> = (0..COUNT).map(|_| within(&mut random, 100.0)).collect();
        check(&crowd);
        let two_crowds =
            |agent: usize| within(&mut random, 30.0) + Vec2::splat(if agent.is_multiple_of(2) { 0.0 } else { 1e4 });
        check(&(0..COUNT).map(two_crowds).collect::<Vec<_>>());
        let mut stragglers = crowd.clone();
        (0..12).for_each(|power| stragglers[power] = Vec2::splat(200.0 * (1 << power) as f32));
        check(&stragglers);
        let pile = |agent: usize| within(&mut random, if agent.is_multiple_of(2) { 1e-3 } else { 100.0 });
        check(&(0..COUNT).map(pile).collect::<Vec<_>>());
    }

    #[test]
    fn degenerate_crowds_are_laid_out() {
        check(&vec![Vec2::new(3.0, -7.0); COUNT]);
        check(&(0..COUNT).map(|agent| Vec2::new(agent as f32, 0.0)).collect::<Vec<_>>());
        check(&[Vec2::ONE]);
        check(&[]);
    }
}
