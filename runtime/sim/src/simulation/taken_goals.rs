//! Goals that others have taken: agents with one goal stand around it, one behind the other. World, metres, m/s.
//!
//! An agent that stands takes the goals on which it stands. One that stands at its goal, or behind others that have taken
//! it, takes that goal, too; so does one that brakes in order to stand there.

use std::num::NonZeroU32;

use glam::Vec2;
use rayon::prelude::*;

use crate::route::braking::{Braking, coasting_mps};
use crate::route::standing_position::StandingPosition;
use crate::scenario::AtGoal;
use crate::simulation::standing_crowd::{Approach, Newcomer, StandingAgent, StandingCrowd};
use crate::simulation::{ROUTES_PER_TASK_MIN, Simulation};

/// Distance within which a goal is taken, as a share of the sum of both radii.
const TAKEN_SHARE: f32 = 0.5;
/// Cosine of the angle between v_pref and the direction of the goal within which the route leads straight to it: 18°.
const STRAIGHT_COS: f32 = 0.95;

impl Simulation {
    /// Slows down agents whose last goals others have taken, and lets them stand behind these.
    pub(super) fn stand_around_goals(&mut self) {
        if Braking::of(self.scenario.coupling, self.scenario.dt_s) != Braking::Evenly {
            return;
        }
        let newcomers: Vec<usize> = (0..self.agents.count()).filter(|&index| self.walks_to_stay(index)).collect();
        let crowd = StandingCrowd::new(if newcomers.is_empty() { Vec::new() } else { self.standing_agents() });
        let approach = |&index: &usize| (index, self.approach_goal(index, &crowd));
        let approaches: Vec<_> = newcomers.par_iter().with_min_len(ROUTES_PER_TASK_MIN).map(approach).collect();
        self.agents.progress.iter_mut().for_each(|progress| progress.standing = None);
        for (index, approach) in approaches {
            self.agents.progress[index].standing = approach.standing;
            self.agents.preferred_mps[index] = approach.preferred_mps;
        }
    }

    /// Whether an agent, by index, walks to a last goal at which it is to stay.
    fn walks_to_stay(&self, index: usize) -> bool {
        let agents = &self.agents;
        let (spec, progress) = (self.population.spec(agents.ids[index]), &agents.progress[index]);
        let walks = agents.preferred_mps[index] != Vec2::ZERO && agents.removals[index].is_none() && !progress.arrived;
        walks && spec.at_goal == AtGoal::Stay && progress.is_at_last(spec) && self.follows_path(index)
    }

    /// The agents that stand, or brake in order to stand: those that did so in the last step, and those that want to stand.
    fn standing_agents(&self) -> Vec<StandingAgent> {
        let agents = &self.agents;
        let standing_agent = |index: usize| {
            let position_m = agents.positions_m[index];
            let wants_to_stand = agents.preferred_mps[index] == Vec2::ZERO;
            let here = wants_to_stand.then_some(StandingPosition { position_m, rank: Some(NonZeroU32::MIN) });
            let walks_there = agents.removals[index].is_none() && self.follows_path(index);
            let remembered = agents.progress[index].standing.filter(|_| walks_there);
            let standing = remembered.map(|standing| standing.now(position_m)).or(here)?;
            let to_front_m = self.last_goal_m(index).map_or(0.0, |goal_m| goal_m.distance(position_m));
            Some(StandingAgent { index, radius_m: agents.radii_m[index], standing, to_front_m })
        };
        (0..agents.count()).filter_map(standing_agent).collect()
    }

    /// How an agent that comes to its goal goes on.
    fn approach_goal(&self, index: usize, crowd: &StandingCrowd) -> Approach {
        let agents = &self.agents;
        let (position_m, preferred_mps) = (agents.positions_m[index], agents.preferred_mps[index]);
        let Some(goal_m) = self.last_goal_m(index) else { return Approach { standing: None, preferred_mps } };
        let offset_m = goal_m - position_m;
        let to_goal_m = offset_m.length();
        let newcomer = Newcomer {
            index,
            position_m,
            radius_m: agents.radii_m[index],
            preferred_mps,
            coasting_mps: coasting_mps(self.scenario.coupling, agents.velocities_mps[index]),
            to_front_m: to_goal_m,
            stood: agents.progress[index].stands_behind(),
        };
        let is_straight = preferred_mps.dot(offset_m) > STRAIGHT_COS * preferred_mps.length() * to_goal_m;
        let brakes = is_straight && to_goal_m < newcomer.brakes_m() && self.obstacles.is_free(position_m, goal_m);
        let has_taken = |other: &&StandingAgent| self.has_taken(goal_m, other, &newcomer);
        let up_to_m = if brakes { to_goal_m } else { f32::INFINITY };
        newcomer.approach(up_to_m, crowd.near(&newcomer).filter(has_taken))
    }

    /// Whether an agent that stands or brakes has taken the goal of a newcomer, nearer to it, with no wall between.
    fn has_taken(&self, goal_m: Vec2, other: &StandingAgent, newcomer: &Newcomer) -> bool {
        let (other_m, taken_m) = (other.standing.position_m, TAKEN_SHARE * (newcomer.radius_m + other.radius_m));
        let progress = &self.agents.progress[other.index];
        let comes_to_goal = progress.arrived || progress.standing.is_some();
        let own_m = self.last_goal_m(other.index).filter(|_| comes_to_goal && self.follows_path(other.index));
        let takes = |taken_at_m: Vec2| taken_at_m.distance(goal_m) < taken_m;
        (takes(other_m) || own_m.is_some_and(takes))
            && other_m.distance(goal_m) < newcomer.position_m.distance(goal_m)
            && self.obstacles.is_free(newcomer.position_m, other_m)
    }

    /// The last goal of an agent, by index; none without goals.
    pub(super) fn last_goal_m(&self, index: usize) -> Option<Vec2> {
        self.population.spec(self.agents.ids[index]).goals_m.last().copied()
    }
}
