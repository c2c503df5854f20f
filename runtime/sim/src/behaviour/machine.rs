//! One step of the state machine of all agents: transitions, goals, aims. World, metres, seconds.
//!
//! 1. Count the agents in states and areas, and look at the signals, as the last step left them.
//! 2. For each agent in the order of ids: take the first transition whose condition holds, until none holds or it would
//!    enter a state for the second time in this step.
//! 3. Keep its goal up to date: move up in a queue, leave a busy exit for another, look again for a goal with room.
//!
//! Rooms of goals change at once, so the order of ids decides which agent gets the last place. All else is read as it
//! was when the step began.

use glam::Vec2;

use crate::behaviour::agent_state::{AgentState, Aim, ChosenGoal, GoalRef, Traits};
use crate::behaviour::area::Area;
use crate::behaviour::choice::{Choice, Options, draw};
use crate::behaviour::condition::Facts;
use crate::behaviour::draw::{Drawer, Purpose};
use crate::behaviour::goals::GoalArea;
use crate::behaviour::occupancy::Occupancy;
use crate::behaviour::state::{Behaviour, Facing, Movement, Target};

/// Distance from the end of a queue within which an agent joins it, m.
const JOINS_QUEUE_M: f32 = 1.5;
/// Distance from the head of a queue within which an agent is served, m.
const AT_HEAD_M: f32 = 0.4;
/// Time between two choices among busy exits, s: sooner, agents would oscillate.
const CHOOSES_AGAIN_S: f64 = 1.5;
/// Share of the time that another exit must save.
const SAVES_SHARE: f32 = 0.1;

/// What the state machine reads of the crowd.
pub struct CrowdView<'a> {
    /// Time, s.
    pub time_s: f64,
    /// Seed of the scenario.
    pub seed: u64,
    /// Stable ids of the agents, ascending.
    pub ids: &'a [u32],
    /// Present positions, m.
    pub positions_m: &'a [Vec2],
    /// Positions at their starts, m.
    pub starts_m: &'a [Vec2],
    /// Length of the route from a position to an area, m; none where there is no route.
    pub route_m: &'a (dyn Fn(Vec2, GoalRef) -> Option<f32> + Sync),
}

/// The state machine of all agents.
#[derive(Clone, Debug, Default)]
pub struct CrowdBehaviour {
    /// What it remembers of each agent, in the order of ids.
    pub agents: Vec<AgentState>,
    /// Agents that go to, or stand in, each area.
    pub occupancy: Occupancy,
    /// Agents in the last step that wanted a goal and found none with room.
    pub waiting: usize,
    /// Teleports of the last step: index of the agent, and where it is now, m.
    pub teleports: Vec<(usize, Vec2)>,
}

/// What holds for all agents in a step.
struct Moment {
    green: Vec<bool>,
    numbers: Vec<u32>,
    populations: Vec<u32>,
    /// For each set that is a queue, the agent that may join it in this step.
    joining: Vec<Option<usize>>,
}

impl CrowdBehaviour {
    /// A crowd without agents.
    pub fn new(behaviour: &Behaviour) -> Self {
        Self { occupancy: Occupancy::new(&behaviour.goals), ..Self::default() }
    }

    /// Adds an agent behind the others; it enters its state in the next step.
    pub fn add(&mut self, state: u32, traits: Traits) {
        self.agents.push(AgentState::new(state, traits));
    }

    /// Keeps only some agents; the goals of the others become free.
    pub fn retain(&mut self, kept: &[bool]) {
        let occupancy = &mut self.occupancy;
        let mut kept = kept.iter().copied();
        self.agents.retain_mut(|agent| {
            let keep = kept.next().unwrap_or(true);
            if !keep {
                agent.remembered.retain(|(_, goal)| agent.goal.is_none_or(|present| present.at != goal.at));
                leave_goal(agent, occupancy);
                while let Some((_, goal)) = agent.remembered.pop() {
                    agent.goal = Some(goal);
                    leave_goal(agent, occupancy);
                }
            }
            keep
        });
    }

    /// One step.
    pub fn decide(&mut self, behaviour: &Behaviour, view: &CrowdView) {
        let moment = self.moment(behaviour, view);
        let mut agents = std::mem::take(&mut self.agents);
        (self.waiting, self.teleports) = (0, Vec::new());
        for (index, agent) in agents.iter_mut().enumerate() {
            let mut deciding = Deciding { behaviour, view, index, agent, occupancy: &mut self.occupancy };
            self.teleports.extend(deciding.follow_transitions(&moment).map(|position_m| (index, position_m)));
            deciding.update_goal(&moment);
            agent.aim = deciding.aim();
            let wants_goal = matches!(behaviour.states[agent.state as usize].movement, Movement::Goals { .. });
            self.waiting += usize::from(wants_goal && agent.goal.is_none());
        }
        self.agents = agents;
    }

    fn moment(&self, behaviour: &Behaviour, view: &CrowdView) -> Moment {
        let mut populations = vec![0; behaviour.states.len()];
        for agent in self.agents.iter().filter(|agent| agent.entries > 0) {
            populations[agent.state as usize] += 1;
        }
        let number = |area: &Area| view.positions_m.iter().filter(|&&position_m| area.holds(position_m)).count() as u32;
        Moment {
            green: behaviour.signals.iter().map(|signal| signal.is_green(view.time_s)).collect(),
            numbers: behaviour.areas.iter().map(number).collect(),
            populations,
            joining: self.joining(behaviour, view),
        }
    }

    /// For each set that is a queue, the agent beside its end that is the nearest to it.
    fn joining(&self, behaviour: &Behaviour, view: &CrowdView) -> Vec<Option<usize>> {
        let mut nearest: Vec<(f32, Option<usize>)> = vec![(JOINS_QUEUE_M, None); behaviour.goals.len()];
        for (index, agent) in self.agents.iter().enumerate() {
            let Some(goal) = agent.goal.filter(|goal| !goal.is_taken) else { continue };
            let place = &behaviour.goals[goal.at.set as usize].areas[goal.at.area as usize];
            let distance_m = place.area.distance_m(view.positions_m[index]);
            let nearest = &mut nearest[goal.at.set as usize];
            if distance_m < nearest.0 {
                *nearest = (distance_m, Some(index));
            }
        }
        nearest.into_iter().map(|(_, index)| index).collect()
    }
}

/// An agent in its step.
struct Deciding<'a> {
    behaviour: &'a Behaviour,
    view: &'a CrowdView<'a>,
    index: usize,
    agent: &'a mut AgentState,
    occupancy: &'a mut Occupancy,
}

impl Deciding<'_> {
    fn position_m(&self) -> Vec2 {
        self.view.positions_m[self.index]
    }

    fn drawer(&self) -> Drawer {
        Drawer { seed: self.view.seed, agent: self.view.ids[self.index], entries: self.agent.entries }
    }

    fn movement(&self) -> &Movement {
        &self.behaviour.states[self.agent.state as usize].movement
    }

    /// Takes transitions. Returns the position to which a state has moved the agent.
    fn follow_transitions(&mut self, moment: &Moment) -> Option<Vec2> {
        let mut teleported = None;
        let mut entered = Vec::new();
        if self.agent.entries == 0 {
            entered.push(self.agent.state);
            teleported = self.enter(self.agent.state);
        }
        while let Some(target) = self.next_state(moment).filter(|target| !entered.contains(target)) {
            entered.push(target);
            teleported = self.enter(target).or(teleported);
        }
        teleported
    }

    /// The state to which the first transition leads whose condition holds.
    fn next_state(&self, moment: &Moment) -> Option<u32> {
        let position_m = self.position_m();
        let is_inside = |area: usize| self.behaviour.areas[area].holds(position_m);
        let facts = Facts {
            to_goal_m: self.agent.goal.map(|goal| self.area(goal.at).area.distance_m(position_m)),
            in_state_s: self.view.time_s - self.agent.entered_s,
            at_head_s: self.agent.at_head_s.map(|at_head_s| self.view.time_s - at_head_s),
            is_inside: &is_inside,
            green: &moment.green,
            numbers: &moment.numbers,
            populations: &moment.populations,
        };
        let drawer = self.drawer();
        let transitions = self.behaviour.states[self.agent.state as usize].transitions.iter().enumerate();
        let (index, taken) = transitions.into_iter().find(|(index, transition)| {
            transition.condition.holds(&facts, &mut drawer.random(Purpose::Duration(*index as u32)))
        })?;
        match &taken.target {
            Target::Back => self.agent.before,
            Target::States(states) => {
                let items: Vec<usize> = (0..states.len()).collect();
                let random = &mut drawer.random(Purpose::Target(index as u32));
                draw(&items, |item| states[item].1, random).map(|item| states[item].0)
            }
        }
    }

    /// Enters a state: leaves the old goal unless it stands there now, applies the settings. Returns the position to
    /// which the state moves the agent.
    fn enter(&mut self, state: u32) -> Option<Vec2> {
        let behaviour = self.behaviour;
        let entered = &behaviour.states[state as usize];
        self.agent.before = (self.agent.entries > 0).then_some(self.agent.state);
        (self.agent.state, self.agent.entered_s) = (state, self.view.time_s);
        self.agent.entries += 1;
        if !matches!(entered.movement, Movement::Stand { .. }) {
            leave_goal(self.agent, self.occupancy);
        }
        self.agent.at_head_s = None;
        let drawer = self.drawer();
        let settings = &entered.settings;
        let mut traits = self.agent.lasting;
        if let Some(speed_mps) = settings.preferred_speed_mps {
            traits.preferred_speed_mps = speed_mps.draw(&mut drawer.random(Purpose::Setting(0)));
        }
        if let Some(factor) = settings.speed_factor {
            traits.preferred_speed_mps *= factor.draw(&mut drawer.random(Purpose::Setting(1)));
        }
        if let Some(radius_m) = settings.radius_m {
            traits.radius_m = radius_m.draw(&mut drawer.random(Purpose::Setting(2)));
        }
        self.agent.traits = traits;
        if settings.remain {
            self.agent.lasting = traits;
        }
        settings.teleport.as_ref().map(|area| area.draw_m(&mut drawer.random(Purpose::Setting(3))))
    }

    /// Chooses a goal where the agent wants one and has none; moves up in a queue; changes between busy exits.
    fn update_goal(&mut self, moment: &Moment) {
        let &Movement::Goals { set, choice, memory } = self.movement() else { return };
        let memory = memory.filter(|_| !self.behaviour.goals[set].queue);
        if self.agent.goal.is_none()
            && let Some(memory) = memory
            && let Some((_, goal)) = self.agent.remembered.iter().find(|(of, _)| *of == memory)
        {
            self.agent.goal = Some(*goal);
        }
        if self.behaviour.goals[set].queue {
            self.update_place(set, moment.joining[set] == Some(self.index));
        } else if self.agent.goal.is_none() {
            self.choose(set, choice);
        } else if choice == Choice::LeastBusy && self.view.time_s - self.agent.chosen_s >= CHOOSES_AGAIN_S {
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
        let free = self.occupancy.free(set, &self.behaviour.goals[set]);
        let random = &mut self.drawer().random(Purpose::Goal);
        let Some(area) = choice.choose(&self.options(set, &free, &|area| self.route_m(set, area)), random) else {
            return;
        };
        self.take(GoalRef { set: set as u32, area: area as u32 });
    }

    /// Leaves the chosen exit for another that saves enough time.
    fn choose_again(&mut self, set: usize) {
        self.agent.chosen_s = self.view.time_s;
        let Some(goal) = self.agent.goal else { return };
        let free = self.occupancy.free(set, &self.behaviour.goals[set]);
        let route_m = |area| self.route_m(set, area);
        let options = self.options(set, &free, &route_m);
        let Some(area) = Choice::LeastBusy.choose(&options, &mut self.drawer().random(Purpose::Goal)) else { return };
        let [now_s, other_s] = [goal.at.area as usize, area].map(|area| options.time_s(area));
        if other_s < now_s.map(|now_s| (1.0 - SAVES_SHARE) * now_s) {
            self.agent.remembered.retain(|(_, remembered)| remembered.at != goal.at);
            leave_goal(self.agent, self.occupancy);
            self.take(GoalRef { set: set as u32, area: area as u32 });
        }
    }

    fn options<'b>(&'b self, set: usize, free: &'b [usize], route_m: &'b dyn Fn(usize) -> Option<f32>) -> Options<'b> {
        let (goals, taken) = (&self.behaviour.goals[set], self.occupancy.of_set(set));
        Options { set: goals, free, taken, route_m, speed_mps: self.agent.traits.preferred_speed_mps }
    }

    fn route_m(&self, set: usize, area: usize) -> Option<f32> {
        (self.view.route_m)(self.position_m(), GoalRef { set: set as u32, area: area as u32 })
    }

    fn take(&mut self, at: GoalRef) {
        let position_m = self.area(at).area.draw_m(&mut self.drawer().random(Purpose::Position));
        if self.agent.remembered.iter().all(|(_, remembered)| remembered.at != at) {
            self.occupancy.take(at);
        }
        self.agent.goal = Some(ChosenGoal { at, position_m, is_taken: true });
        self.agent.chosen_s = self.view.time_s;
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
                    self.occupancy.take(goal.at);
                    self.agent.goal = Some(ChosenGoal { is_taken: true, ..goal });
                }
            }
            Some(goal) if goal.at.area > 0 => {
                let ahead = goal.at.area as usize - 1;
                if self.occupancy.of_set(set)[ahead] == 0 {
                    self.occupancy.release(goal.at);
                    self.occupancy.take(place(ahead));
                    self.agent.goal = Some(self.place(place(ahead), true));
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

    fn area(&self, at: GoalRef) -> &GoalArea {
        &self.behaviour.goals[at.set as usize].areas[at.area as usize]
    }

    /// What the agent wants now.
    fn aim(&self) -> Aim {
        let start_m = self.view.starts_m[self.index];
        match *self.movement() {
            Movement::OwnPath => Aim::OwnPath,
            Movement::Goals { .. } => self.aim_at_goal(None),
            Movement::Mirrored { centre_m } => Aim::Position(2.0 * centre_m - start_m),
            Movement::Offset { by_m } => Aim::Position(start_m + by_m),
            Movement::Walk { velocity_mps } => Aim::Velocity(velocity_mps),
            Movement::Stand { facing } => {
                let of_goal = || self.agent.goal.and_then(|goal| self.area(goal.at).facing_rad);
                let at = |to_m: Vec2| to_m.try_normalize().map(|to| libm::atan2f(to.y, to.x));
                self.aim_at_goal(match facing {
                    Facing::AsArrived => None,
                    Facing::OfGoal => of_goal(),
                    Facing::Towards(facing_rad) => Some(facing_rad),
                    Facing::At(point_m) => at(point_m - self.position_m()),
                })
            }
            Movement::Leave => Aim::Leave,
        }
    }

    fn aim_at_goal(&self, facing_rad: Option<f32>) -> Aim {
        match self.agent.goal {
            Some(ChosenGoal { at: goal, position_m, .. }) => Aim::Goal { goal, position_m, facing_rad },
            None => Aim::Stay { facing_rad },
        }
    }
}

/// Gives up an agent's goal; a goal that the agent remembers stays taken.
fn leave_goal(agent: &mut AgentState, occupancy: &mut Occupancy) {
    let Some(goal) = agent.goal.take() else { return };
    let is_remembered = agent.remembered.iter().any(|(_, remembered)| remembered.at == goal.at);
    if goal.is_taken && !is_remembered {
        occupancy.release(goal.at);
    }
}

#[cfg(test)]
#[path = "machine_tests.rs"]
mod tests;
