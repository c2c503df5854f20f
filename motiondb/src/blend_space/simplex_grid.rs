//! A grid over the simplices' bounding box: each cell lists the simplices that reach into it, the likeliest first.
//!
//! Enters: a point in the metric of the blend space. Leaves: the simplices that may hold it, in constant time. There
//! are many more cells than simplices, so the lists stay short. The work of building them is bounded for any input.
//! Along a dropped axis the box has no extent, and everything is in the first cells.

use glam::DVec3;

use crate::blend_space::simplex::Simplex;

/// Number of cells per simplex: more make shorter lists, but need more memory.
const CELLS_PER_SIMPLEX: f64 = 64.0;
/// Greatest number of pairs of a cell and a simplex that are examined: 16 MB of lists at most.
const MOST_PAIRS: f64 = (1 << 22) as f64;

/// Lists of simplices by cell.
#[derive(Clone, Debug)]
pub(crate) struct SimplexGrid {
    cells: GridCells,
    /// Start of each cell's list in `lists`, then the end of the last list.
    starts: Vec<u32>,
    /// Numbers of simplices, cell after cell.
    lists: Vec<u32>,
}

/// A box that is cut into equal cells.
#[derive(Clone, Copy, Debug)]
struct GridCells {
    /// Least corner of the box, in the metric.
    least: DVec3,
    /// Greatest corner of the box, in the metric.
    greatest: DVec3,
    /// Number of cells along each axis.
    side: usize,
    /// Cells per unit of the metric, along each axis.
    per_unit: DVec3,
}

impl SimplexGrid {
    pub(crate) fn new(simplices: &[Simplex]) -> Self {
        let mut side = libm::cbrt(CELLS_PER_SIMPLEX * simplices.len() as f64) as usize + 1;
        let mut cells = GridCells::around(simplices, side);
        while side > 1 && simplices.iter().map(|simplex| cells.in_box_of(simplex)).sum::<f64>() > MOST_PAIRS {
            side /= 2;
            cells = GridCells::around(simplices, side);
        }
        let mut pairs: Vec<(usize, f64, u32)> = Vec::new();
        for (number, simplex) in (0..).zip(simplices) {
            cells.visit_reached(simplex, |cell, depth| pairs.push((cell, depth, number)));
        }
        // First the simplex in which the cell's centre lies deepest.
        pairs.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)).then(a.2.cmp(&b.2)));
        let start = |cell: usize| pairs.partition_point(|pair| pair.0 < cell) as u32;
        Self {
            cells,
            starts: (0..=side * side * side).map(start).collect(),
            lists: pairs.iter().map(|pair| pair.2).collect(),
        }
    }

    /// Numbers of the simplices that may hold a point.
    pub(crate) fn near(&self, point: DVec3) -> &[u32] {
        let Some(cell) = self.cells.index_of(point) else { return &[] };
        &self.lists[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

impl GridCells {
    /// The cells of the box around all simplices.
    fn around(simplices: &[Simplex], side: usize) -> Self {
        let both = |[least, greatest]: [DVec3; 2], other: [DVec3; 2]| [least.min(other[0]), greatest.max(other[1])];
        let [least, greatest] = simplices.iter().map(Simplex::bounds).reduce(both).unwrap_or_default();
        Self { least, greatest, side, per_unit: side as f64 / (greatest - least) }
    }

    /// Index of the cell that holds a point; `None` outside the box.
    fn index_of(&self, point: DVec3) -> Option<usize> {
        let is_within = (point.cmpge(self.least) & point.cmple(self.greatest)).all();
        is_within.then(|| self.index(self.coordinates(point)))
    }

    /// Column, row and layer of a point in the box.
    fn coordinates(&self, point: DVec3) -> [usize; 3] {
        let cells = (point - self.least) * self.per_unit;
        cells.to_array().map(|x| (x as usize).min(self.side - 1))
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        x + self.side * (y + self.side * z)
    }

    /// Number of cells that the simplex's bounding box touches.
    fn in_box_of(&self, simplex: &Simplex) -> f64 {
        let [first, last] = simplex.bounds().map(|corner| self.coordinates(corner));
        (0..3).map(|axis| (last[axis] - first[axis] + 1) as f64).product()
    }

    /// Calls `visit` with the index of each cell that the simplex reaches into, and the depth of the cell's centre.
    fn visit_reached(&self, simplex: &Simplex, mut visit: impl FnMut(usize, f64)) {
        let [first, last] = simplex.bounds().map(|corner| self.coordinates(corner));
        let half = 0.5 * self.per_unit.recip();
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                for x in first[0]..=last[0] {
                    let centre = self.least + half * (2.0 * DVec3::new(x as f64, y as f64, z as f64) + 1.0);
                    if let Some(depth) = simplex.depth_in_box(centre, half) {
                        visit(self.index([x, y, z]), depth);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blend_space::simplex::soup;
    use proptest::prelude::*;

    proptest! {
        /// Simplices may overlap; queries on a lattice fall on corners, edges, faces and walls of cells.
        #[test]
        fn cells_list_every_simplex_that_holds_their_points(
            points in prop::collection::vec(prop::array::uniform3(-3i8..4), 4..12),
            corners in prop::collection::vec(prop::array::uniform4(0usize..12), 0..40),
            query in prop::array::uniform3(-16i8..17),
        ) {
            let (simplices, point) = (soup(&points, &corners, 4), DVec3::from_array(query.map(f64::from)) * 0.25);
            let grid = SimplexGrid::new(&simplices);
            let listed = |index: &usize| grid.near(point).contains(&(*index as u32));
            let missed = |index: &usize| simplices[*index].shares_within(point).is_some() && !listed(index);
            prop_assert_eq!((0..simplices.len()).find(missed), None);
        }
    }

    #[test]
    fn needles_across_the_box_take_bounded_memory() {
        let needles = |k: usize| {
            let high = k as f64 * 1e-4;
            let points = [[0.0, 0.0, high], [1.0, 1.0, 1.0 - high], [1.0, 0.9, 0.5], [0.9, 1.0, 0.5 + high]];
            Simplex::new(&[0, 1, 2, 3], &points.map(DVec3::from_array))
        };
        let grid = SimplexGrid::new(&(0..6000).map(needles).collect::<Vec<_>>());
        assert!(grid.lists.len() as f64 <= MOST_PAIRS && grid.cells.side > 1);
    }
}
