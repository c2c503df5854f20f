//! The keys `groups` and `group_spacing_m` of agents and sources, and the groups that agents of a table form. World,
//! metres.

use std::collections::BTreeMap;

use glam::Vec2;

use crate::maths::random::SplitMix64;
use crate::scenario::agent_spec::AgentSpec;
use crate::scenario::fault::TableFault;
use crate::scenario::social_group::{GroupMember, GroupSizes, SIZE_MAX, SPACING_M};

/// Greatest distance at the start between the first member of a group and another, m.
const NEAR_M: f32 = 5.0;
/// Side of the cells in which the nearest agents are searched, m.
const CELL_M: f32 = 1.0;

/// The sizes of groups that a table states: `groups = { 1 = 0.6, 2 = 0.4 }`; none without `groups`.
pub(crate) fn group_sizes(
    shares_of: Option<&BTreeMap<String, f32>>,
    spacing_m: Option<f32>,
) -> Result<Option<GroupSizes>, TableFault> {
    let Some(shares_of) = shares_of else {
        return match spacing_m {
            None => Ok(None),
            Some(_) => Err(("`group_spacing_m` needs `groups`".into(), "add `groups = { 1 = 0.6, 2 = 0.4 }`")),
        };
    };
    let mut shares = [0.0; SIZE_MAX];
    for (size, &share) in shares_of {
        match size.parse::<usize>() {
            Ok(size @ 1..=SIZE_MAX) => shares[size - 1] = share,
            _ => {
                let message = format!("`{size}` in `groups` is no size of a group");
                return Err((message, "give sizes of 1 to 4 agents, as in `groups = { 1 = 0.6, 2 = 0.4 }`"));
            }
        }
    }
    Ok(Some(GroupSizes { shares, spacing_m: spacing_m.unwrap_or(SPACING_M) }))
}

/// Joins the agents of a table into groups of neighbours; the first agent has the id `first`. All members of a group
/// begin to walk when its first member does.
pub(crate) fn form_groups(agents: &mut [AgentSpec], first: usize, sizes: &GroupSizes, random: &mut SplitMix64) {
    let positions_m: Vec<Vec2> = agents.iter().map(|agent| agent.position_m).collect();
    let mut alone = LoneAgents::new(&positions_m);
    for index in 0..agents.len() {
        if !alone.take(index) {
            continue;
        }
        let mut members = vec![index];
        for _ in 1..sizes.draw(random) {
            let Some(other) = alone.nearest(positions_m[index]) else { break };
            alone.take(other);
            members.push(other);
        }
        if members.len() > 1 {
            let group = Some(GroupMember { first: (first + index) as u32, spacing_m: sizes.spacing_m });
            let pre_movement_s = agents[index].pre_movement_s;
            members
                .iter()
                .for_each(|&member| agents[member] = AgentSpec { group, pre_movement_s, ..agents[member].clone() });
        }
    }
}

/// The agents of a table that are in no group yet.
struct LoneAgents<'a> {
    positions_m: &'a [Vec2],
    are_alone: Vec<bool>,
    cells: BTreeMap<(i32, i32), Vec<usize>>,
}

impl<'a> LoneAgents<'a> {
    fn new(positions_m: &'a [Vec2]) -> Self {
        let mut cells: BTreeMap<(i32, i32), Vec<usize>> = BTreeMap::new();
        for (index, &position_m) in positions_m.iter().enumerate() {
            cells.entry(cell(position_m)).or_default().push(index);
        }
        Self { positions_m, are_alone: vec![true; positions_m.len()], cells }
    }

    /// Takes an agent into a group. Returns whether it was alone.
    fn take(&mut self, index: usize) -> bool {
        if let Some(others) = self.cells.get_mut(&cell(self.positions_m[index])) {
            others.retain(|&other| other != index);
        }
        std::mem::replace(&mut self.are_alone[index], false)
    }

    /// The agent nearest to a position, near enough to join its group; the first of several.
    fn nearest(&self, position_m: Vec2) -> Option<usize> {
        let reach = libm::ceilf(NEAR_M / CELL_M) as i32;
        let (column, row) = cell(position_m);
        let cells =
            (row - reach..=row + reach).flat_map(|row| (column - reach..=column + reach).map(move |at| (at, row)));
        let near = cells.filter_map(|cell| self.cells.get(&cell)).flatten().copied();
        let distance_m = |index: usize| self.positions_m[index].distance(position_m);
        near.filter(|&index| distance_m(index) <= NEAR_M)
            .min_by(|&a, &b| distance_m(a).total_cmp(&distance_m(b)).then(a.cmp(&b)))
    }
}

fn cell(position_m: Vec2) -> (i32, i32) {
    let Vec2 { x, y } = (position_m / CELL_M).floor();
    (x as i32, y as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_join_neighbours() {
        let at = |x: f32| AgentSpec { position_m: Vec2::new(x, 0.0), pre_movement_s: x, ..AgentSpec::default() };
        let mut agents: Vec<AgentSpec> = [0.0, 20.0, 1.0, 21.0, 2.5, 40.0].map(at).to_vec();
        let pairs = GroupSizes { shares: [0.0, 1.0, 0.0, 0.0], spacing_m: 0.75 };
        form_groups(&mut agents, 100, &pairs, &mut SplitMix64::new(1, 0));
        let first: Vec<Option<u32>> = agents.iter().map(|agent| agent.group.map(|group| group.first)).collect();
        assert_eq!(first, [Some(100), Some(101), Some(100), Some(101), None, None]);
        assert_eq!((agents[2].pre_movement_s, agents[4].pre_movement_s), (0.0, 2.5));
    }
}
