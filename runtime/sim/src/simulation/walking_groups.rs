//! Groups that walk together: v_pref of each member is turned towards its place in the group (stage 1 of a step).
//!
//! Two to four members walk abreast, the middle ones a little behind, so that all see each other (Moussaïd et al. 2010,
//! "The walking behaviour of pedestrian social groups", PLoS ONE 5(4)). Where walls leave no room for that they walk in a
//! file. The group walks at the preferred speed of its slowest member; a member that is ahead slows down until the others
//! have come up, and one behind hurries. Near its goal each member walks to its own position.
//!
//! World, metres, seconds.

use std::collections::BTreeMap;

use glam::Vec2;

use crate::simulation::Simulation;
use crate::world::obstacles::Obstacles;

/// Time in which a member comes to its place beside the others, s.
const SIDE_TIME_S: f32 = 1.5;
/// Greatest speed sideways, as a share of the group's.
const SIDE_SHARE_MAX: f32 = 0.35;
/// Distance ahead of its place at which a member stands and waits, m.
const WAITS_M: f32 = 1.5;
/// Greatest increase of the speed of a member behind its place, as a share.
const HURRY_SHARE: f32 = 0.3;
/// Distance of middle members behind outer ones, m.
const BEND_M: f32 = 0.3;
/// Distance between members in a file, m.
const FILE_SPACING_M: f32 = 0.9;
/// Distance between the goals of two members below which they walk together, m.
const GOALS_NEAR_M: f32 = 5.0;
/// Distances ahead of the places abreast at which walls are looked for, m.
const LOOK_AHEAD_M: [f32; 3] = [0.0, 0.75, 1.5];
/// Mean of the unit directions of the members below which they walk apart, as in a hairpin.
const COMMON_SHARE: f32 = 0.5;

/// The present agents by groups.
#[derive(Debug, Default)]
pub(super) struct WalkingGroups {
    /// Indices of the members of each group with two or more, ascending.
    pub(super) members: Vec<Vec<usize>>,
}

impl WalkingGroups {
    /// For each of a number of agents the index of the first present member of its group; its own where it is alone.
    pub(super) fn leads(&self, count: usize) -> Vec<usize> {
        let mut leads: Vec<usize> = (0..count).collect();
        for members in &self.members {
            members.iter().for_each(|&member| leads[member] = members[0]);
        }
        leads
    }
}

/// A member that walks.
struct Walker {
    index: usize,
    position_m: Vec2,
    /// Unit direction of its route.
    direction: Vec2,
    preferred_speed_mps: f32,
    /// Share of its preferred speed at which it walks: less than 1 where it brakes before its goal.
    speed_share: f32,
}

impl Simulation {
    /// The groups of the present agents; none in a scenario without groups.
    pub(super) fn walking_groups(&self) -> WalkingGroups {
        if !self.has_groups {
            return WalkingGroups::default();
        }
        let mut members: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (index, id) in self.agents.ids.iter().enumerate() {
            if let Some(group) = self.population.spec(*id).group {
                members.entry(group.first).or_default().push(index);
            }
        }
        WalkingGroups { members: members.into_values().filter(|members| members.len() > 1).collect() }
    }

    /// Turns v_pref of the members of each group so that they walk together.
    pub(super) fn walk_together(&mut self) {
        for members in self.walking_groups().members {
            let mut parts: Vec<Vec<usize>> = Vec::new();
            for index in members.into_iter().filter(|&index| self.agents.removals[index].is_none()) {
                match parts.iter_mut().find(|part| self.have_one_purpose(part[0], index)) {
                    Some(part) => part.push(index),
                    None => parts.push(vec![index]),
                }
            }
            parts.iter().for_each(|part| self.walk_abreast(part));
        }
    }

    /// Whether two members walk together: they are in one state and their goals are near to each other.
    fn have_one_purpose(&self, a: usize, b: usize) -> bool {
        let (Some(a), Some(b)) = (self.crowd.agents.get(a), self.crowd.agents.get(b)) else { return true };
        let are_near = match (a.aim.position_m(), b.aim.position_m()) {
            (Some(a_m), Some(b_m)) => a_m.distance(b_m) < GOALS_NEAR_M,
            _ => true,
        };
        a.state == b.state && are_near
    }

    fn walk_abreast(&mut self, members: &[usize]) {
        let walkers: Vec<Walker> = members.iter().filter_map(|&index| self.walker(index)).collect();
        // A member that stands has arrived, or stands behind others; the rest go to their own positions.
        if walkers.len() < members.len() || walkers.len() < 2 {
            return;
        }
        let sum: Vec2 = walkers.iter().map(|walker| walker.direction).sum();
        let Some(forward) = sum.try_normalize().filter(|_| sum.length() > COMMON_SHARE * walkers.len() as f32) else {
            return;
        };
        let spec = self.population.spec(self.agents.ids[members[0]]);
        let spacing_m = spec.group.map_or(0.0, |group| group.spacing_m);
        let speed_mps = walkers.iter().map(|walker| walker.preferred_speed_mps).fold(f32::INFINITY, f32::min);
        let wall_radius_m = walkers.iter().map(|walker| self.agents.wall_radii_m[walker.index]).fold(0.0, f32::max);
        let places_m = places_m(&walkers, forward, spacing_m, wall_radius_m, &self.obstacles);
        for (walker, place_m) in walkers.iter().zip(places_m) {
            let to_place_m = place_m - walker.position_m;
            let along = 1.0 + (to_place_m.dot(forward) / WAITS_M).clamp(-1.0, HURRY_SHARE);
            let aside_mps = to_place_m.dot(forward.perp()) / SIDE_TIME_S;
            let aside_mps = aside_mps.clamp(-SIDE_SHARE_MAX * speed_mps, SIDE_SHARE_MAX * speed_mps);
            let velocity_mps = walker.direction * along * speed_mps + forward.perp() * aside_mps;
            self.agents.preferred_mps[walker.index] = velocity_mps * walker.speed_share;
            // Members face where they walk.
            self.agents.facing_offsets_rad[walker.index] = 0.0;
        }
    }

    /// The member with an index; none where it stands.
    fn walker(&self, index: usize) -> Option<Walker> {
        let preferred_mps = self.agents.preferred_mps[index];
        let spec = self.population.spec(self.agents.ids[index]);
        if self.agents.progress[index].stands_behind() {
            return None;
        }
        let state = self.crowd.agents.get(index);
        let preferred_speed_mps = state.map_or(spec.preferred_speed_mps, |state| state.traits.preferred_speed_mps);
        Some(Walker {
            index,
            position_m: self.agents.positions_m[index],
            direction: preferred_mps.try_normalize()?,
            preferred_speed_mps,
            speed_share: preferred_mps.length() / preferred_speed_mps,
        })
    }
}

/// The place of each member about their common centre, m: abreast, or in a file where walls leave no room abreast.
fn places_m(walkers: &[Walker], forward: Vec2, spacing_m: f32, wall_radius_m: f32, obstacles: &Obstacles) -> Vec<Vec2> {
    let count = walkers.len();
    let centre_m = walkers.iter().map(|walker| walker.position_m).sum::<Vec2>() / count as f32;
    let middle = 0.5 * (count as f32 - 1.0);
    let across = |rank: usize| rank as f32 - middle;
    let bends: Vec<f32> = (0..count).map(|rank| (across(rank) / middle) * (across(rank) / middle)).collect();
    let mean_bend = bends.iter().sum::<f32>() / count as f32;
    let abreast = |rank: usize| {
        centre_m + forward.perp() * (spacing_m * across(rank)) + forward * (BEND_M * (bends[rank] - mean_bend))
    };
    let is_clear = |place_m: Vec2| {
        LOOK_AHEAD_M.iter().all(|&ahead_m| obstacles.depth_m(place_m + forward * ahead_m, wall_radius_m) <= 0.0)
    };
    if (0..count).map(abreast).all(is_clear) {
        return in_order(walkers, forward.perp(), abreast);
    }
    in_order(walkers, forward, |rank| centre_m + forward * (FILE_SPACING_M * across(rank)))
}

/// Places by rank, for members in their order along an axis: none crosses another's path.
fn in_order(walkers: &[Walker], axis: Vec2, place_m: impl Fn(usize) -> Vec2) -> Vec<Vec2> {
    let along_m = |index: usize| walkers[index].position_m.dot(axis);
    let mut order: Vec<usize> = (0..walkers.len()).collect();
    order.sort_by(|&a, &b| along_m(a).total_cmp(&along_m(b)));
    let mut places_m = vec![Vec2::ZERO; walkers.len()];
    order.into_iter().enumerate().for_each(|(rank, index)| places_m[index] = place_m(rank));
    places_m
}
