//! The cells of a coarse picture that bodies cover, a bit each.

use glam::Vec2;

/// Cells of a picture, row by row.
pub(super) struct CellRows {
    width: usize,
    height: usize,
    /// Number of words of a row.
    words: usize,
    bits: Vec<u64>,
}

impl CellRows {
    /// A picture without a covered cell.
    pub(super) fn new([width, height]: [u32; 2]) -> Self {
        let [width, height] = [width, height].map(|side| side as usize);
        let words = width.div_ceil(64);
        Self { width, height, words, bits: vec![0; words * height] }
    }

    /// Whether a cell of some columns and rows is in the picture.
    pub(super) fn holds_any(&self, columns: [f32; 2], rows: [f32; 2]) -> bool {
        !inside(columns, self.width).is_empty() && !inside(rows, self.height).is_empty()
    }

    /// Covers some columns and rows; the number of cells that were free.
    pub(super) fn cover(&mut self, columns: [f32; 2], rows: [f32; 2]) -> u32 {
        let columns = inside(columns, self.width);
        let mut covered = 0;
        for row in inside(rows, self.height) {
            for word in columns.start / 64..columns.end.div_ceil(64) {
                let bits = &mut self.bits[row * self.words + word];
                let added = below(columns.end - 64 * word) & !below(columns.start.saturating_sub(64 * word)) & !*bits;
                covered += added.count_ones();
                *bits |= added;
            }
        }
        covered
    }

    /// Middle of the covered cells, from that of the picture, of half its size; and the standard deviation of their
    /// height, of its height.
    pub(super) fn middle_and_spread(&self) -> (Vec2, f32) {
        let size = Vec2::new(self.width as f32, self.height as f32);
        let (mut count, mut sum, mut squares) = (0.0, Vec2::ZERO, 0.0);
        for (at, bits) in self.bits.iter().enumerate() {
            let (row, first) = (at / self.words, 64 * (at % self.words));
            let y = (row as f32 + 0.5) / size.y;
            let mut left = *bits;
            while left != 0 {
                let x = ((first + left.trailing_zeros() as usize) as f32 + 0.5) / size.x;
                (count, sum, squares) = (count + 1.0, sum + Vec2::new(x, y), squares + y * y);
                left &= left - 1;
            }
        }
        if count == 0.0 {
            return (Vec2::ZERO, 0.0);
        }
        let mean = sum / count;
        (2.0 * mean - 1.0, (squares / count - mean.y * mean.y).max(0.0).sqrt())
    }
}

/// The bits below a number; all from 64 on.
fn below(count: usize) -> u64 {
    if count < 64 { (1 << count) - 1 } else { u64::MAX }
}

/// The part of a range of cells that is in a picture.
fn inside([first, end]: [f32; 2], side: usize) -> std::ops::Range<usize> {
    let end = (end.max(0.0) as usize).min(side);
    (first.max(0.0) as usize).min(end)..end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_covered_once() {
        let mut rows = CellRows::new([200, 3]);
        assert_eq!(rows.cover([60.0, 130.0], [-5.0, 2.0]), 2 * 70);
        assert_eq!(rows.cover([64.0, 140.0], [1.0, 9.0]), 10 + 76);
        assert_eq!(rows.cover([-9.0, 300.0], [0.0, 3.0]), 3 * 200 - 2 * 70 - 86);
        assert!(rows.middle_and_spread().0.length() < 1e-5);
        assert!(!rows.holds_any([200.0, 210.0], [0.0, 3.0]) && rows.holds_any([-3.0, 1.0], [2.0, 9.0]));
    }

    #[test]
    fn the_middle_is_that_of_the_covered_cells() {
        let mut rows = CellRows::new([100, 4]);
        assert_eq!(rows.middle_and_spread(), (Vec2::ZERO, 0.0));
        rows.cover([75.0, 100.0], [0.0, 2.0]);
        let (middle, spread) = rows.middle_and_spread();
        assert!(middle.distance(Vec2::new(0.75, -0.5)) < 1e-5 && (spread - 0.125).abs() < 1e-5, "{middle}, {spread}");
    }
}
