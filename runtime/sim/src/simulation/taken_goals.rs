//! Goals that others have taken: agents with one goal stand around it, one behind the other. World, metres, m/s.
//!
//! An agent that stands takes the goals on which it stands. One that stands at its goal, or behind others that have taken
//! it, takes that goal, too.

use glam::Vec2;
use rayon::prelude::*;

use crate::route::braking::{Braking, coasting_mps};
use crate::scenario::AtGoal;
use crate::simulation::places_behind::{Newcomer, Place, Standing, StandingCrowd};
use crate::simulation::{ROUTES_PER_TASK_MIN, Simulation};

/// Distance within which a goal is taken, as a share of the sum of both radii.
const TAKEN_SHARE: f32 = 0.5;

impl Simulation {
    /// Slows down agents whose last goals others have taken, and lets them stand behind these.
    pub(super) fn stand_around_goals(&mut self) {
        if Braking::of(self.scenario.coupling, self.scenario.dt_s) != Braking::Evenly {
            return;
        }
        let newcomers: Vec<usize> = (0..self.agents.count()).filter(|&index| self.walks_to_stay(index)).collect();
        let standing = if newcomers.is_empty() { Vec::new() } else { self.standing() };
        let crowd = StandingCrowd::new(standing);
        let find_place = |&index: &usize| (index, self.place_at_goal(index, &crowd));
        let placed: Vec<_> = newcomers.par_iter().with_min_len(ROUTES_PER_TASK_MIN).map(find_place).collect();
        self.agents.progress.iter_mut().for_each(|progress| progress.rank_behind = 0);
        for (index, (place, preferred_mps)) in placed {
            self.agents.progress[index].rank_behind = place.rank;
            self.agents.preferred_mps[index] = preferred_mps;
        }
    }

    /// Whether an agent, by index, walks to a last goal at which it is to stay.
    fn walks_to_stay(&self, index: usize) -> bool {
        let agents = &self.agents;
        let (spec, progress) = (self.population.spec(agents.ids[index]), &agents.progress[index]);
        let walks = agents.preferred_mps[index] != Vec2::ZERO && agents.removals[index].is_none() && !progress.arrived;
        walks && spec.at_goal == AtGoal::Stay && progress.is_at_last(spec) && self.follows_path(index)
    }

    /// The agents that stand: those that stood behind others in the last step, and those that want to.
    fn standing(&self) -> Vec<Standing> {
        let agents = &self.agents;
        let standing = |index: usize| {
            let wants_to_stand = agents.preferred_mps[index] == Vec2::ZERO;
            let rank = agents.progress[index].rank_behind.max(u32::from(wants_to_stand));
            let (position_m, radius_m) = (agents.positions_m[index], agents.radii_m[index]);
            (rank > 0).then_some(Standing { index, position_m, radius_m, rank })
        };
        (0..agents.count()).filter_map(standing).collect()
    }

    /// The place of an agent that comes to its goal, and v_pref before it, m/s.
    fn place_at_goal(&self, index: usize, crowd: &StandingCrowd) -> (Place, Vec2) {
        let agents = &self.agents;
        let (position_m, preferred_mps) = (agents.positions_m[index], agents.preferred_mps[index]);
        let motion = [position_m, preferred_mps, coasting_mps(self.scenario.coupling, agents.velocities_mps[index])];
        let newcomer = Newcomer::new(index, motion, agents.radii_m[index], agents.progress[index].rank_behind);
        let goal_m = self.last_goal_m(index);
        let has_taken = |other: &&Standing| goal_m.is_some_and(|goal_m| self.has_taken(goal_m, other, &newcomer));
        let place = newcomer.place_behind(f32::INFINITY, crowd.near(&newcomer).filter(has_taken));
        (place, newcomer.preferred_mps(place, preferred_mps))
    }

    /// Whether an agent that stands has taken the goal of a newcomer, and stands nearer to it with no wall between.
    fn has_taken(&self, goal_m: Vec2, other: &Standing, newcomer: &Newcomer) -> bool {
        let taken_m = TAKEN_SHARE * (newcomer.radius_m + other.radius_m);
        let progress = &self.agents.progress[other.index];
        let stands_at_goal = progress.arrived || progress.rank_behind > 0;
        let own_m = self.last_goal_m(other.index).filter(|_| stands_at_goal && self.follows_path(other.index));
        let takes = |taken_at_m: Vec2| taken_at_m.distance(goal_m) < taken_m;
        (takes(other.position_m) || own_m.is_some_and(takes))
            && other.position_m.distance(goal_m) < newcomer.position_m.distance(goal_m)
            && self.obstacles.is_free(newcomer.position_m, other.position_m)
    }

    fn last_goal_m(&self, index: usize) -> Option<Vec2> {
        self.population.spec(self.agents.ids[index]).goals_m.last().copied()
    }
}
