//! What parts of a scene belong to, and the owners of many triangles in little memory.

/// What a part belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Owner {
    /// Id of the agent; [`Owner::NO_AGENT`] for a part of the scene.
    pub agent: u32,
    /// Material, by index: what a matte by material separates.
    pub material: u32,
}

impl Owner {
    /// The agent of parts that belong to none.
    pub const NO_AGENT: u32 = u32::MAX;
    /// A part of the scene: walls, blocks.
    pub const SCENE: Self = Self { agent: Self::NO_AGENT, material: 0 };
}

/// Number of triangles of a block.
const BLOCK: usize = 1024;

/// Owners of triangles, of which those of a mesh follow each other: kept by runs, 12 bytes a run instead of 8 a triangle.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Owners {
    /// First triangle of each run, and its owner.
    runs: Vec<(u32, Owner)>,
    /// Run of the first triangle of each block.
    blocks: Vec<u32>,
    count: usize,
}

impl Owners {
    /// Gives the triangles up to a number, exclusive, that have no owner yet an owner.
    pub fn fill(&mut self, count: usize, owner: Owner) {
        if count <= self.count {
            return;
        }
        if self.runs.last().is_none_or(|(_, last)| *last != owner) {
            self.runs.push((self.count as u32, owner));
        }
        self.count = count;
        self.blocks.resize(count.div_ceil(BLOCK), self.runs.len() as u32 - 1);
    }

    /// Appends the owners of other triangles.
    pub fn extend(&mut self, other: &Self) {
        let first = self.count;
        let ends = other.runs.iter().skip(1).map(|(start, _)| *start as usize).chain([other.count]);
        for ((_, owner), end) in other.runs.iter().zip(ends) {
            self.fill(first + end, *owner);
        }
    }

    /// The owner of a triangle.
    pub fn of(&self, triangle: usize) -> Owner {
        let from = self.blocks.get(triangle / BLOCK).map_or(self.runs.len(), |run| *run as usize);
        let runs = self.runs[from..].iter().take_while(|(first, _)| *first as usize <= triangle);
        runs.last().map_or(Owner::SCENE, |(_, owner)| *owner)
    }

    /// Owners in the order of their triangles; each of a run once.
    pub fn distinct(&self) -> impl Iterator<Item = Owner> {
        self.runs.iter().map(|(_, owner)| *owner)
    }
}

#[cfg(test)]
mod tests {
    use fbcrowd_sim::maths::SplitMix64;

    use super::*;

    #[test]
    fn runs_give_the_owner_of_each_triangle() {
        let mut random = SplitMix64::new(3, 1);
        let (mut owners, mut expected) = (Owners::default(), Vec::new());
        for _ in 0..40 {
            let mut other = Owners::default();
            for agent in 0..(4.0 * random.unit()) as u32 {
                let owner = Owner { agent, material: 0 };
                let length = (1500.0 * random.unit()) as usize;
                expected.resize(expected.len() + length, owner);
                other.fill(other.count + length, owner);
            }
            owners.extend(&other);
        }
        assert!(expected.len() > 20_000);
        assert!((0..expected.len()).all(|triangle| owners.of(triangle) == expected[triangle]));
        assert!(owners.runs.len() < 120);
    }
}
