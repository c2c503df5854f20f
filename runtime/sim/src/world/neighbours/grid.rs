//! A uniform grid over some of the agents, and grids within its crowded cells: the layout that a search walks over.
//!
//! A grid has half as many cells as agents, whatever their number. Where they are spread unevenly (a crowd and a
//! straggler a kilometre off) most fall into few cells, so a crowded cell gets a grid of its own over its own box, and
//! so on. Positions outside a grid count to its border cells. All the cell numbers come from one monotone function of a
//! coordinate, so what lies between two coordinates lies in the cells between theirs, rounding included.
//! World, metres.

use std::ops::Range;

use glam::Vec2;

/// Agents to a cell, on average; from 2 to 4 the time of a search hardly changes.
const AGENTS_PER_CELL: f32 = 3.0;
/// Agents in a cell that make a grid of their own worth its while: more than a jam puts into a cell of a loose crowd.
const CROWDED: usize = 48;
/// Grids within grids, at most. Each divides the number of agents or, of a straggler, the size of the box.
const DEPTH_MAX: usize = 16;
/// Least side of a cell, m: agents nearer to each other count as being in one place.
const CELL_MIN_M: f32 = 1e-6;
/// Stands for no grid.
const NONE: u32 = u32::MAX;

/// One grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// Corners of the box of its agents.
    pub(crate) least_m: Vec2,
    pub(crate) most_m: Vec2,
    cells_per_m: f32,
    columns: i32,
    rows: i32,
    /// Of its cells, row by row, in [`Layout::starts`].
    first_cell: usize,
    /// Some of its cells have grids of their own.
    has_crowded: bool,
}

/// A rectangle of cells, both ends within.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window {
    pub(crate) columns: [i32; 2],
    pub(crate) rows: [i32; 2],
}

/// All grids, the whole one first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layout {
    pub(crate) grids: Vec<Grid>,
    /// The agents, cell by cell.
    pub(crate) agents: Vec<u32>,
    /// Of each cell of each grid its first place in `agents`; after each grid's cells their end.
    starts: Vec<u32>,
    /// Beside each start the grid of its cell.
    inner: Vec<u32>,
    // Of the slice that is being sorted.
    cells: Vec<u32>,
    unsorted: Vec<u32>,
}

impl Grid {
    /// Column and row of a position.
    pub(crate) fn cell_of(&self, position_m: Vec2) -> [i32; 2] {
        let cell = (position_m - self.least_m) * self.cells_per_m;
        [(cell.x as i32).clamp(0, self.columns - 1), (cell.y as i32).clamp(0, self.rows - 1)]
    }

    /// The cells of all agents that are no farther than `reach` from a position.
    pub(crate) fn within(&self, position_m: Vec2, reach_m: f32) -> Window {
        let [least, most] = [-reach_m, reach_m].map(|by_m| self.cell_of(position_m + by_m));
        Window { columns: [least[0], most[0]], rows: [least[1], most[1]] }
    }

    /// Distance of a position from the box.
    pub(crate) fn distance_m(&self, position_m: Vec2) -> f32 {
        position_m.distance(position_m.clamp(self.least_m, self.most_m))
    }
}

impl Window {
    /// The cells that are no more than `ring` columns and rows from one.
    pub(crate) fn around([column, row]: [i32; 2], ring: i32) -> Self {
        Self { columns: [column - ring, column + ring], rows: [row - ring, row + ring] }
    }

    /// With as much again on each side.
    pub(crate) fn doubled(&self) -> Self {
        let wider = |[first, last]: [i32; 2]| {
            let more = (last - first) / 2 + 1;
            [first.saturating_sub(more), last.saturating_add(more)]
        };
        Self { columns: wider(self.columns), rows: wider(self.rows) }
    }

    /// The cells of both.
    pub(crate) fn and(&self, other: &Self) -> Self {
        let both = |a: [i32; 2], b: [i32; 2]| [a[0].max(b[0]), a[1].min(b[1])];
        Self { columns: both(self.columns, other.columns), rows: both(self.rows, other.rows) }
    }
}

impl Layout {
    /// Sorts the agents into cells; within a cell they stay in order of index.
    pub(crate) fn rebuild(&mut self, positions_m: &[Vec2]) {
        self.grids.clear();
        self.starts.clear();
        self.inner.clear();
        self.agents.clear();
        self.agents.extend(0..positions_m.len() as u32);
        self.add_grid(positions_m, 0..positions_m.len(), 0);
    }

    /// Of a run of cells of one row, those with grids of their own as such, the places of the others in runs.
    pub(crate) fn runs(&self, grid: &Grid, row: i32, [first, last]: [i32; 2], mut visit: impl FnMut(Run)) {
        let row = grid.first_cell + (row * grid.columns) as usize;
        let [first, last] = [first, last].map(|column| row + column as usize);
        if !grid.has_crowded {
            return visit(Run::Places(self.starts[first] as usize..self.starts[last + 1] as usize));
        }
        for cell in first..=last {
            match self.inner[cell] {
                NONE => visit(Run::Places(self.starts[cell] as usize..self.starts[cell + 1] as usize)),
                inner => visit(Run::Grid(inner as usize)),
            }
        }
    }

    fn add_grid(&mut self, positions_m: &[Vec2], places: Range<usize>, depth: usize) -> u32 {
        let index = self.grids.len();
        let grid = grid_over(self.agents[places.clone()].iter().map(|&agent| positions_m[agent as usize]));
        let grid = Grid { first_cell: self.starts.len(), ..grid };
        self.grids.push(grid);
        self.sort(&grid, positions_m, places);
        if depth < DEPTH_MAX && grid.most_m != grid.least_m {
            self.add_inner_grids(index, positions_m, depth + 1);
        }
        index as u32
    }

    fn add_inner_grids(&mut self, index: usize, positions_m: &[Vec2], depth: usize) {
        let grid = self.grids[index];
        for cell in grid.first_cell..grid.first_cell + grid.cell_count() {
            let places = self.starts[cell] as usize..self.starts[cell + 1] as usize;
            if places.len() > CROWDED {
                self.inner[cell] = self.add_grid(positions_m, places, depth);
                self.grids[index].has_crowded = true;
            }
        }
    }

    /// Counting sort of the agents in `places`.
    fn sort(&mut self, grid: &Grid, positions_m: &[Vec2], places: Range<usize>) {
        self.unsorted.clear();
        self.unsorted.extend_from_slice(&self.agents[places.clone()]);
        self.cells.clear();
        self.cells.extend(self.unsorted.iter().map(|&agent| {
            let [column, row] = grid.cell_of(positions_m[agent as usize]);
            (row * grid.columns + column) as u32
        }));
        self.starts.resize(grid.first_cell + grid.cell_count() + 1, 0);
        self.inner.resize(self.starts.len(), NONE);
        let starts = &mut self.starts[grid.first_cell..];
        for &cell in &self.cells {
            starts[cell as usize + 1] += 1;
        }
        starts[0] = places.start as u32;
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        // Each start runs through its cell, until it is the next one's; one place to the right, all are right again.
        for (&agent, &cell) in self.unsorted.iter().zip(&self.cells) {
            let place = &mut starts[cell as usize];
            self.agents[*place as usize] = agent;
            *place += 1;
        }
        starts.rotate_right(1);
        starts[0] = places.start as u32;
    }
}

/// What a run of cells consists of.
pub(crate) enum Run {
    /// Places in [`Layout::agents`].
    Places(Range<usize>),
    /// Index of a crowded cell's grid.
    Grid(usize),
}

impl Grid {
    fn cell_count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }
}

/// The box of all positions, [`AGENTS_PER_CELL`] to a cell on average.
fn grid_over(positions_m: impl ExactSizeIterator<Item = Vec2>) -> Grid {
    let count = positions_m.len() as f32;
    let empty = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    let (least_m, most_m) = positions_m.fold(empty, |(least, most), at| (least.min(at), most.max(at)));
    let (least_m, most_m) = if count == 0.0 { (Vec2::ZERO, Vec2::ZERO) } else { (least_m, most_m) };
    let size_m = most_m - least_m;
    let by_density_m = (size_m.x * size_m.y * AGENTS_PER_CELL / count.max(1.0)).sqrt();
    // A long file of agents has no area; its length over their number bounds the number of cells.
    let by_length_m = (size_m.x + size_m.y) / count.max(1.0);
    let cells_per_m = 1.0 / by_density_m.max(by_length_m).max(CELL_MIN_M);
    let cells = size_m * cells_per_m;
    let [columns, rows] = [cells.x as i32 + 1, cells.y as i32 + 1];
    Grid { least_m, most_m, cells_per_m, columns, rows, first_cell: 0, has_crowded: false }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maths::random::SplitMix64;

    const COUNT: usize = 20_000;

    fn within(random: &mut SplitMix64, bound_m: f64) -> Vec2 {
        Vec2::new(random.within(bound_m) as f32, random.within(bound_m) as f32)
    }

    /// Every agent stands in one cell, no cell is crowded, and there are not many cells.
    fn check(positions_m: &[Vec2]) {
        let mut layout = Layout::default();
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
                        let Run::Places(places) = run else { return };
                        seen += places.len();
                        let mut in_cell =
                            layout.agents[places.clone()].iter().map(|&agent| positions_m[agent as usize]);
                        let first_m = in_cell.next();
                        assert!(places.len() <= CROWDED || in_cell.all(|at| Some(at) == first_m), "{}", places.len());
                    });
                }
            }
        }
        assert_eq!(seen, positions_m.len());
    }

    #[test]
    fn no_cell_is_crowded_however_uneven_the_crowd_is() {
        let mut random = SplitMix64::new(1, 0);
        let crowd: Vec<Vec2> = (0..COUNT).map(|_| within(&mut random, 100.0)).collect();
        check(&crowd);
        let two_cities =
            |agent: usize| within(&mut random, 30.0) + Vec2::splat(if agent.is_multiple_of(2) { 0.0 } else { 1e4 });
        check(&(0..COUNT).map(two_cities).collect::<Vec<_>>());
        let mut stragglers = crowd.clone();
        (0..12).for_each(|power| stragglers[power] = Vec2::splat(200.0 * 2.0_f32.powi(power as i32)));
        check(&stragglers);
        let pile = |agent: usize| within(&mut random, if agent.is_multiple_of(2) { 1e-3 } else { 100.0 });
        check(&(0..COUNT).map(pile).collect::<Vec<_>>());
    }

    #[test]
    fn one_place_one_line_and_nobody_are_laid_out_too() {
        check(&vec![Vec2::new(3.0, -7.0); COUNT]);
        check(&(0..COUNT).map(|agent| Vec2::new(agent as f32, 0.0)).collect::<Vec<_>>());
        check(&[Vec2::ONE]);
        check(&[]);
    }
}
