//! A copy's random draws: places, choices, and the edits of [`motiondb_compiler::mutation`].

use fbcrowd_sim::maths::SplitMix64;
use motiondb_compiler::mutation::Edit;

/// Names, counts and structure of a file stand before its data, within so many bytes.
const HEAD_BYTES: usize = 4096;
const MOST_EDITS: usize = 5;

/// The random numbers of one copy.
pub(super) struct Draw(SplitMix64);

impl Draw {
    /// Each kind of input has a stream of its own.
    pub(super) fn new(seed: u64, stream: u64) -> Self {
        Self(SplitMix64::new(seed, stream))
    }

    /// The seed of something that draws for itself.
    pub(super) fn seed(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A number below a limit, which is not 0.
    pub(super) fn below(&mut self, limit: usize) -> usize {
        (self.0.next_u64() % limit as u64) as usize
    }

    /// One of several.
    pub(super) fn one<'a, T>(&mut self, several: &'a [T]) -> &'a T {
        &several[self.below(several.len())]
    }

    /// Yes every other time.
    pub(super) fn flip(&mut self) -> bool {
        self.below(2) == 0
    }

    /// An edit at a place.
    pub(super) fn edit_at(&mut self, place: usize) -> Edit {
        Edit { place: place as u64, kind: self.below(256) as u8, value: self.0.next_u64() as u32 }
    }

    /// A few edits of so many bytes, which are not 0, rather one than many; every other one stands in the head.
    pub(super) fn edits(&mut self, length: usize) -> Vec<Edit> {
        let most = 1 + self.below(MOST_EDITS);
        (0..=self.below(most))
            .map(|_| {
                let limit = if self.flip() { length.min(HEAD_BYTES) } else { length };
                let place = self.below(limit);
                self.edit_at(place)
            })
            .collect()
    }
}
