//! Groups of clips of one take: a leader and its copies.
//!
//! Each clip, in the given order, is compared with the leaders. It joins every group whose leader it is a copy or a
//! part of. Without such a group it leads a new one. So a copy costs one comparison per leader, and a chain of copies
//! cannot join takes that have nothing in common.

use rayon::prelude::*;

use crate::dedup::alignment::Alignment;
use crate::dedup::comparison::Match;

/// Greatest number of groups: 8 million comparisons of leaders, about two minutes for clips of 12 s on two cores.
pub(crate) const GROUPS_MAX: usize = 4000;

/// A clip of a group, and its alignment on the leader.
pub(crate) type Member = (usize, Alignment);

/// Groups of all clips.
#[derive(Default)]
pub(crate) struct Groups {
    /// Members of each group, the leader first.
    pub(crate) members: Vec<Vec<Member>>,
    /// Clips that found the greatest number of groups reached; no later clip was compared with them.
    pub(crate) uncompared: Vec<usize>,
}

impl Groups {
    /// Finds the groups. `compare` compares a leader with another clip; `may_lead` holds for the first clips of
    /// `order`.
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
                    true => groups.members.push(vec![(clip, Alignment::IDENTITY)]),
                    false => groups.uncompared.push(clip),
                }
            }
            for (members, alignment) in groups.members.iter_mut().zip(found) {
                members.extend(alignment.map(|alignment| (clip, alignment)));
            }
        }
        groups
    }

    /// For each of `count` clips: its groups of several clips, and its alignment on their leaders.
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
