//! The grid of cells of a figure with many panels: cells row by row, below a head with title and legend. Pixels.

use glam::Vec2;

/// A grid of equal cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellGrid {
    /// Number of cells side by side.
    pub(crate) columns: usize,
    /// Width and height of a cell, pixels.
    pub(crate) cell_px: Vec2,
    /// Height of the head above the cells, pixels.
    pub(crate) head_px: f32,
}

impl CellGrid {
    /// Width and height of a figure with so many cells, pixels.
    pub(crate) fn size_px(&self, cells: usize) -> [u32; 2] {
        let rows = cells.div_ceil(self.columns) as f32;
        [(self.columns as f32 * self.cell_px.x) as u32, (self.head_px + rows * self.cell_px.y) as u32]
    }

    /// A rectangle of left, top, width, height in a cell, moved to the cell's position on the figure.
    pub(crate) fn rect_px(&self, cell: usize, [left, top, width, height]: [f32; 4]) -> [f32; 4] {
        let corner = self.corner_px(cell);
        [corner.x + left, corner.y + top, width, height]
    }

    /// Upper left corner of a cell.
    pub(crate) fn corner_px(&self, cell: usize) -> Vec2 {
        let [column, row] = [cell % self.columns, cell / self.columns].map(|index| index as f32);
        Vec2::new(column * self.cell_px.x, self.head_px + row * self.cell_px.y)
    }
}
