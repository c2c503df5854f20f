//! The goal of one agent in its step: it chooses one, moves up in a queue, leaves a busy exit for another. World,
//! metres, seconds.

use glam::Vec2;

use crate::behaviour::agent_state::{ChosenGoal, GoalRef};
use crate::behaviour::choice::{Choice, Options};
use crate::behaviour::crowd_view::Moment;
use crate::behaviour::draw::Purpose;
use crate::behaviour::goals::GoalArea;
use crate::behaviour::machine::deciding::Deciding;
use crate::behaviour::state::Movement;

/// Distance from the head of a queue within which an agent is served, m.
const AT_HEAD_M: f32 = 0.4;
/// Time between two choices among busy exits, s: sooner, agents would oscillate.
const CHOOSES_AGAIN_S: f64 = 1.5;
/// Share of the time that another exit must save.
const SAVES_SHARE: f32 = 0.1;
/// Distance between two positions at which bodies do not touch, m: two discs and a hand's breadth.
const APART_M: f32 = 0.6;
/// Positions that are drawn in an area before the best one is taken.
const APART_DRAWS: usize = 16;
/// Number of agents in an area above which no position is sought apart from theirs: an exit, which they pass.
const CROWDED: usize = 64;

impl Deciding<'_> {
    /// Chooses a goal where the agent wants one and has none; moves up in a queue; changes between busy exits.
    /// A member of a group takes the area of its lead, or the nearest to it that has room.
    pub(crate) fn update_goal(&mut self, moment: &Moment, lead_goal: Option<GoalRef>) {
        let &Movement::Goals { set, choice, memory } = self.movement() else { return };
        let memory = memory.filter(|_| !self.behaviour.goals[set].queue);
        if self.agent.goal.is_none()
            && let Some(memory) = memory
            && let Some((_, goal)) = self.agent.remembered.iter().find(|(of, _)| *of == memory)
        {
            self.agent.goal = Some(*goal);
        }
        let wanted = lead_goal.filter(|at| at.set as usize == set && self.agent.goal_at() != Some(*at));
        if self.behaviour.goals[set].queue {
            self.update_place(set, moment.joining[set] == Some(self.index));
        } else if let Some(at) = wanted.filter(|at| self.occupancy.has_room(&self.behaviour.goals[set], *at, 1)) {
            self.occupancy.leave(self.agent);
            self.take(at);
        } else if self.agent.goal.is_none() {
            match wanted {
                Some(lead) => self.choose_beside(lead),
                None => self.choose(set, choice),
            }
        } else if choice == Choice::LeastBusy
            && lead_goal.is_none()
            && self.view.time_s - self.agent.chosen_s >= CHOOSES_AGAIN_S
        {
            self.choose_again(set);
        }
        let goal = self.agent.goal.filter(|goal| goal.is_taken);
        if let (Some(memory), Some(goal)) = (memory, goal) {
            match self.agent.remembered.iter_mut().find(|(of, _)| *of == memory) {
                Some((_, remembered)) => *remembered = goal,
                None => self.agent.remembered.push((memory, goal)),
            }
        }
    }

    fn choose(&mut self, set: usize, choice: Choice) {
        let goals = &self.behaviour.goals[set];
        let mut free = self.occupancy.free(set, goals, 1 + self.followers.count);
        if free.is_empty() {
            free = self.occupancy.free(set, goals, 1);
        }
        // Where only closed doors lead to a goal, the agent waits before one.
        let with_doors_open = || {
            let open_route_m = self.view.open_route_m?;
            let route_m =
                |area| open_route_m(self.of(), self.position_m(), GoalRef { set: set as u32, area: area as u32 });
            self.chosen(set, choice, &free, &route_m)
        };
        if let Some(area) = self.chosen(set, choice, &free, &|area| self.route_m(set, area)).or_else(with_doors_open) {
            self.take(GoalRef { set: set as u32, area: area as u32 });
        }
    }

    /// Takes the area with room that is the nearest to that of its lead.
    fn choose_beside(&mut self, lead: GoalRef) {
        let set = lead.set as usize;
        let beside_m = self.area(lead).area.centre_m();
        let away_m = |area: &usize| self.behaviour.goals[set].areas[*area].area.centre_m().distance(beside_m);
        let free = self.occupancy.free(set, &self.behaviour.goals[set], 1);
        let reachable = free.into_iter().filter(|&area| self.route_m(set, area).is_some());
        let nearest = reachable.min_by(|a, b| away_m(a).total_cmp(&away_m(b)));
        if let Some(area) = nearest {
            self.take(GoalRef { set: set as u32, area: area as u32 });
        }
    }

    /// Leaves the chosen exit for another that saves enough time.
    fn choose_again(&mut self, set: usize) {
        self.agent.chosen_s = self.view.time_s;
        let Some(goal) = self.agent.goal else { return };
        let free = self.occupancy.free(set, &self.behaviour.goals[set], 1 + self.followers.count);
        let route_m = |area| self.route_m(set, area);
        let Some(area) = self.chosen(set, Choice::LeastBusy, &free, &route_m) else { return };
        let [now_s, other_s] = self.with_options(set, &free, &route_m, |options| {
            [goal.at.area as usize, area].map(|area| options.time_s(area))
        });
        // A door that has closed may have cut off the present exit.
        if now_s.is_none_or(|now_s| other_s < Some((1.0 - SAVES_SHARE) * now_s)) {
            self.agent.remembered.retain(|(_, remembered)| remembered.at != goal.at);
            if let Some(route_m) = self.route_m(set, goal.at.area as usize) {
                self.approach.leave(goal.at, route_m);
            }
            self.occupancy.leave(self.agent);
            self.take(GoalRef { set: set as u32, area: area as u32 });
        }
    }

    /// Index of the area that a choice gives.
    fn chosen(
        &self,
        set: usize,
        choice: Choice,
        free: &[usize],
        route_m: &dyn Fn(usize) -> Option<f32>,
    ) -> Option<usize> {
        let random = &mut self.drawer().random(Purpose::Goal);
        self.with_options(set, free, route_m, |options| choice.choose(options, random))
    }

    fn with_options<T>(
        &self,
        set: usize,
        free: &[usize],
        route_m: &dyn Fn(usize) -> Option<f32>,
        read: impl FnOnce(&Options) -> T,
    ) -> T {
        let ahead =
            |area: usize, route_m: f32| self.approach.ahead(GoalRef { set: set as u32, area: area as u32 }, route_m);
        let speed_mps = self.agent.traits.preferred_speed_mps;
        read(&Options { set: &self.behaviour.goals[set], free, ahead: &ahead, route_m, speed_mps })
    }

    fn route_m(&self, set: usize, area: usize) -> Option<f32> {
        (self.view.route_m)(self.of(), self.position_m(), GoalRef { set: set as u32, area: area as u32 })
    }

    /// Takes an area: the position remembered there, or a new one.
    fn take(&mut self, at: GoalRef) {
        let remembered = self.agent.remembered.iter().map(|(_, goal)| *goal).find(|goal| goal.at == at);
        let goal =
            remembered.unwrap_or_else(|| ChosenGoal { at, position_m: self.draw_position_m(at), is_taken: true });
        if remembered.is_none() {
            self.occupancy.take(&goal);
        }
        self.agent.goal = Some(goal);
        self.agent.chosen_s = self.view.time_s;
        if let Some(route_m) = self.route_m(at.set as usize, at.area as usize) {
            self.approach.join(at, route_m);
        }
    }

    /// A position in an area apart from those of other agents; of a few draws the one farthest from them, where all are
    /// near to one.
    fn draw_position_m(&self, at: GoalRef) -> Vec2 {
        let random = &mut self.drawer().random(Purpose::Position);
        let held_m = self.occupancy.positions_m(at);
        let draws = if held_m.len() > CROWDED { 1 } else { APART_DRAWS };
        let mut best = (f32::NEG_INFINITY, Vec2::ZERO);
        for _ in 0..draws {
            let drawn_m = self.view.draw_clear_m(self.of(), &self.area(at).area, random);
            let apart_m = held_m.iter().map(|held_m| held_m.distance(drawn_m)).fold(f32::INFINITY, f32::min);
            if apart_m > best.0 {
                best = (apart_m, drawn_m);
            }
            if apart_m >= APART_M {
                break;
            }
        }
        best.1
    }

    /// Walks to the end of a queue, joins it, moves up, and stands at its head.
    fn update_place(&mut self, set: usize, may_join: bool) {
        let place = |area: usize| GoalRef { set: set as u32, area: area as u32 };
        match self.agent.goal.filter(|goal| goal.is_taken) {
            None => {
                let end = self.occupancy.end_of_queue(set).map(place);
                self.agent.goal = end.map(|at| self.place(at, false));
                if let Some(goal) = self.agent.goal
                    && may_join
                {
                    let goal = ChosenGoal { is_taken: true, ..goal };
                    self.occupancy.take(&goal);
                    self.agent.goal = Some(goal);
                }
            }
            Some(goal) if goal.at.area > 0 => {
                let ahead = goal.at.area as usize - 1;
                if self.occupancy.of_set(set)[ahead] == 0 {
                    let moved_up = self.place(place(ahead), true);
                    self.occupancy.release(&goal);
                    self.occupancy.take(&moved_up);
                    self.agent.goal = Some(moved_up);
                }
            }
            Some(goal) => {
                let is_there = self.area(goal.at).area.distance_m(self.position_m()) <= AT_HEAD_M;
                self.agent.at_head_s = self.agent.at_head_s.or_else(|| is_there.then_some(self.view.time_s));
            }
        }
    }

    fn place(&self, at: GoalRef, is_taken: bool) -> ChosenGoal {
        ChosenGoal { at, position_m: self.area(at).area.centre_m(), is_taken }
    }

    pub(crate) fn area(&self, at: GoalRef) -> &GoalArea {
        &self.behaviour.goals[at.set as usize].areas[at.area as usize]
    }
}
