//! Agents that walk together: couples, friends, families. World, metres.

use serde::{Deserialize, Serialize};

use crate::maths::random::SplitMix64;

/// Greatest number of members: larger groups split into these as they walk (Moussaïd et al. 2010).
pub(crate) const SIZE_MAX: usize = 4;
/// Default distance between members that walk abreast, m: 0.6 to 0.8 m in streets (Moussaïd et al. 2010).
pub(crate) const SPACING_M: f32 = 0.75;

/// The group of an agent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroupMember {
    /// Id of the group's first member, which names the group.
    pub first: u32,
    /// Distance between members that walk abreast, m.
    pub spacing_m: f32,
}

/// The sizes of the groups of a table or source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroupSizes {
    /// Shares of groups of one, two, three and four agents.
    pub shares: [f32; SIZE_MAX],
    /// Distance between members that walk abreast, m.
    pub spacing_m: f32,
}

impl GroupSizes {
    /// Draws the size of a group.
    pub(crate) fn draw(&self, random: &mut SplitMix64) -> usize {
        let mut left = random.unit() * self.shares.iter().map(|&share| f64::from(share)).sum::<f64>();
        for (index, &share) in self.shares.iter().enumerate() {
            left -= f64::from(share);
            if left < 0.0 {
                return index + 1;
            }
        }
        self.shares.iter().rposition(|&share| share > 0.0).map_or(1, |index| index + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_follow_their_shares() {
        let sizes = GroupSizes { shares: [1.0, 2.0, 0.0, 1.0], spacing_m: SPACING_M };
        let mut counts = [0; SIZE_MAX];
        let mut random = SplitMix64::new(4, 0);
        (0..4_000).for_each(|_| counts[sizes.draw(&mut random) - 1] += 1);
        let expected: [i32; SIZE_MAX] = [1_000, 2_000, 0, 1_000];
        assert!(counts.iter().zip(expected).all(|(count, expected)| (count - expected).abs() < 120), "{counts:?}");
    }
}
