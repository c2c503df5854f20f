//! How many samples of each pixel of a tile show each id, for each matte. Counts of several moments add up.

use crate::passes::cryptomatte::Coverage;

/// Samples of an id in a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct MatteCount {
    pixel: u32,
    id: u32,
    samples: u32,
}

/// Counts of one tile.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct TileMattes {
    /// Of each matte, by rising pixel and id.
    of_mattes: Vec<Vec<MatteCount>>,
}

/// Reads counts pixel by pixel.
pub(crate) struct Coverages<'a> {
    /// Counts of each matte that are not read yet.
    left: Vec<&'a [MatteCount]>,
    of_samples: usize,
    coverage: Coverage,
}

impl TileMattes {
    pub(crate) fn new(mattes: usize) -> Self {
        Self { of_mattes: vec![Vec::new(); mattes] }
    }

    /// Counts samples; [`merge`](Self::merge) makes them readable.
    pub(crate) fn count(&mut self, matte: usize, pixel: u32, id: u32, samples: u32) {
        self.of_mattes[matte].push(MatteCount { pixel, id, samples });
    }

    /// Adds the counts of another moment.
    pub(crate) fn add(&mut self, other: Self) {
        self.of_mattes.resize(other.of_mattes.len(), Vec::new());
        for (counts, others) in self.of_mattes.iter_mut().zip(other.of_mattes) {
            counts.extend(others);
        }
        self.merge();
    }

    /// Sorts the counts, and adds those of the same pixel and id.
    pub(crate) fn merge(&mut self) {
        for counts in &mut self.of_mattes {
            counts.sort_unstable();
            counts.dedup_by(|next, kept| {
                let is_same = (next.pixel, next.id) == (kept.pixel, kept.id);
                kept.samples += if is_same { next.samples } else { 0 };
                is_same
            });
        }
    }

    /// The counts as coverages, of a number of samples a pixel.
    pub(crate) fn coverages(&self, of_samples: usize) -> Coverages<'_> {
        let left = self.of_mattes.iter().map(Vec::as_slice).collect();
        Coverages { left, of_samples, coverage: Coverage::default() }
    }
}

impl Coverages<'_> {
    /// Appends the ranks of a pixel; pixels rise from call to call.
    pub(crate) fn append(&mut self, matte: usize, pixel: u32, values: &mut Vec<f32>) {
        self.coverage.clear();
        let left = &mut self.left[matte];
        let here = left.iter().take_while(|count| count.pixel <= pixel).count();
        left[..here].iter().for_each(|count| self.coverage.add(count.id, count.samples));
        *left = &left[here..];
        self.coverage.append_ranks(self.of_samples, values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_of_two_moments_add_up_in_each_pixel() {
        let moment = |counts: &[(u32, u32, u32)]| {
            let mut mattes = TileMattes::new(1);
            counts.iter().for_each(|&(pixel, id, samples)| mattes.count(0, pixel, id, samples));
            mattes.merge();
            mattes
        };
        let mut sum = TileMattes::default();
        sum.add(moment(&[(0, 7, 4), (2, 7, 1), (2, 9, 3)]));
        sum.add(moment(&[(2, 9, 1), (2, 7, 2), (2, 5, 1)]));
        let (mut coverages, mut values) = (sum.coverages(8), Vec::new());
        (0..3).for_each(|pixel| coverages.append(0, pixel, &mut values));
        let ranks: Vec<(u32, f32)> =
            values.as_chunks::<2>().0.iter().map(|[id, share]| (id.to_bits(), *share)).collect();
        assert_eq!(ranks[0], (7, 0.5));
        assert_eq!(ranks[6], (0, 0.0));
        assert_eq!(ranks[12..15], [(9, 0.5), (7, 0.375), (5, 0.125)]);
    }
}
