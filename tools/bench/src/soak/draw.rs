//! Random draws of a copy: positions, choices, and the edits of [`crate::soak::mutation`].

use fbcrowd_sim::maths::SplitMix64;

use crate::soak::mutation::Edit;

/// Length of a file's head, with its names, counts and structure, bytes.
const HEAD_BYTES: usize = 4096;
/// Most edits of a copy.
const MOST_EDITS: usize = 5;

/// The random numbers of one copy.
pub(crate) struct Draw(SplitMix64);

impl Draw {
    /// The draws of one copy. Each kind of input has its own stream.
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        Self(SplitMix64::new(seed, stream))
    }

    /// A seed for other random numbers.
    pub(crate) fn seed(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A number below a limit, which must not be 0.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        (self.0.next_u64() % limit as u64) as usize
    }

    /// One of several items.
    pub(crate) fn one<'a, T>(&mut self, several: &'a [T]) -> &'a T {
        &several[self.below(several.len())]
    }

    /// True every other time.
    pub(crate) fn flip(&mut self) -> bool {
        self.below(2) == 0
    }

    /// An edit at a position.
    pub(crate) fn edit_at(&mut self, position: usize) -> Edit {
        Edit { position: position as u64, kind: self.below(256) as u8, value: self.0.next_u64() as u32 }
    }

    /// A few edits of a file of this length, which must not be 0; one is likelier than many. Every other one is in the
    /// head.
    pub(crate) fn edits(&mut self, length: usize) -> Vec<Edit> {
        let most = 1 + self.below(MOST_EDITS);
        (0..=self.below(most))
            .map(|_| {
                let limit = if self.flip() { length.min(HEAD_BYTES) } else { length };
                let position = self.below(limit);
                self.edit_at(position)
            })
            .collect()
    }
}
