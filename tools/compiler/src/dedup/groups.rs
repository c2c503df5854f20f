//! Clips → groups of one take, each of a leading clip and its copies, without comparing each with each.
//!
//! The clips are gone through from the best on. Each is compared with the clips that lead a group. It joins every group
//! whose leader it is a copy or a part of; where there is none it leads a group of its own. So the result depends on the
//! order of the clips only, thousands of copies cost a comparison each, and every clip of a group shows what its leader
//! shows: a chain of copies cannot join takes that have nothing in common.

use rayon::prelude::*;

use crate::dedup::alignment::Alignment;
use crate::dedup::comparison::Match;

/// Most groups: 8 million pairs, half a minute.
pub(crate) const GROUPS_MAX: usize = 4000;

/// A clip of a group, and how it lies on the leader.
pub(crate) type Member = (usize, Alignment);

/// The groups of all clips.
#[derive(Default)]
pub(crate) struct Groups {
    /// The members of each group, the leader first.
    pub(crate) members: Vec<Vec<Member>>,
    /// Clips that would lead a group more than there may be; no later one was compared with them.
    pub(crate) uncompared: Vec<usize>,
}

impl Groups {
    /// Of clips in an order, by a comparison of a leader with another clip. `may_lead` holds for the first in order.
    pub(crate) fn find(
        order: &[usize],
        may_lead: impl Fn(usize) -> bool,
        compare: impl Fn(usize, usize) -> Option<Match> + Sync,
    ) -> Self {
        let mut groups = Self::default();
        for &clip in order {
            let on_leader = |members: &Vec<Member>| compare(members[0].0, clip).map(|found| found.alignment);
            let found: Vec<Option<Alignment>> = groups.members.par_iter().map(on_leader).collect();
            if found.iter().all(Option::is_none) && may_lead(clip) {
                match groups.members.len() < GROUPS_MAX {
                    true => groups.members.push(vec![(clip, Alignment::SAME)]),
                    false => groups.uncompared.push(clip),
                }
            }
            for (members, alignment) in groups.members.iter_mut().zip(found) {
                members.extend(alignment.map(|alignment| (clip, alignment)));
            }
        }
        groups
    }

    /// Of each of so many clips the groups of several clips that it is in, and how it lies on their leaders.
    pub(crate) fn of_clips(&self, count: usize) -> Vec<Vec<(usize, Alignment)>> {
        let mut of_clips = vec![Vec::new(); count];
        for (group, members) in self.members.iter().enumerate().filter(|(_, members)| members.len() > 1) {
            members.iter().for_each(|(clip, on_leader)| of_clips[*clip].push((group, *on_leader)));
        }
        of_clips
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clips_beyond_the_most_groups_are_reported() {
        let order: Vec<usize> = (0..GROUPS_MAX + 2).collect();
        let groups = Groups::find(&order, |_| true, |_, _| None);
        assert_eq!((groups.members.len(), groups.uncompared), (GROUPS_MAX, vec![GROUPS_MAX, GROUPS_MAX + 1]));
    }
}
