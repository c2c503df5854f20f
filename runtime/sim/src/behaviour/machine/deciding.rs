//! One agent in its step: transitions, then what it wants (`goal_keeping` keeps its goal up to date between). World,
//! metres, seconds.

use glam::Vec2;

use crate::behaviour::agent_state::{AgentState, Aim, ChosenGoal};
use crate::behaviour::choice::draw;
use crate::behaviour::condition::Facts;
use crate::behaviour::crowd_view::{CrowdView, Moment};
use crate::behaviour::draw::{Drawer, Purpose};
use crate::behaviour::event::Event;
use crate::behaviour::machine::approach::Approach;
use crate::behaviour::occupancy::Occupancy;
use crate::behaviour::state::{Behaviour, Facing, Movement, Target};

/// Transitions of one agent in one step from which on they count as endless.
pub(crate) const TRANSITIONS_MAX: usize = 100;
/// Distance from its position in a queue within which an agent turns as it stands there, m.
const IN_QUEUE_M: f32 = 1.0;
/// Greatest preferred speed, m/s, that of a scenario's `preferred_speed_mps`: factors that remain multiply.
const SPEED_MAX_MPS: f32 = 10.0;

/// An agent in its step.
pub(crate) struct Deciding<'a> {
    pub(crate) behaviour: &'a Behaviour,
    pub(crate) view: &'a CrowdView<'a>,
    /// Index of the agent.
    pub(crate) index: usize,
    pub(crate) agent: &'a mut AgentState,
    pub(crate) occupancy: &'a mut Occupancy,
    pub(crate) approach: &'a mut Approach,
    /// Position to which a state has moved the agent in this step, m.
    pub(crate) teleported_m: Option<Vec2>,
    /// The members of its group that do as it does.
    pub(crate) followers: Followers,
}

/// The members of a group that do as its first member does: those in the same state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Followers {
    /// Number of them.
    pub(crate) count: u32,
    /// Greatest distance of one to its goal, m.
    pub(crate) to_goal_m: f32,
}

impl Deciding<'_> {
    pub(crate) fn position_m(&self) -> Vec2 {
        self.teleported_m.unwrap_or(self.view.positions_m[self.index])
    }

    /// The agent and its state, by index.
    pub(crate) fn of(&self) -> (usize, u32) {
        (self.index, self.agent.state)
    }

    pub(crate) fn drawer(&self) -> Drawer {
        Drawer { seed: self.view.seed, agent: self.view.ids[self.index].0, entries: self.agent.entries }
    }

    pub(crate) fn movement(&self) -> &Movement {
        &self.behaviour.states[self.agent.state as usize].movement
    }

    /// Takes transitions until none is due, or until they count as endless. Returns the states entered.
    pub(crate) fn follow_transitions(&mut self, moment: &Moment) -> Vec<u32> {
        if self.agent.entries == 0 {
            self.enter(self.agent.state);
        }
        let mut entered = Vec::new();
        while entered.len() < TRANSITIONS_MAX
            && let Some(target) = self.next_state(moment)
        {
            entered.push(target);
            self.enter(target);
        }
        entered
    }

    /// Enters the state to which an event moves the agent; an agent that leaves the scene goes on.
    pub(crate) fn be_moved(&mut self, event: &Event) {
        let stays = self.agent.entries == 0 || matches!(self.movement(), Movement::Leave { .. });
        if let Some(state) = event.moves(self.agent.state).filter(|_| !stays) {
            self.enter(state);
        }
    }

    /// Takes the transitions that the first member of its group has taken.
    pub(crate) fn follow_lead(&mut self, entered: &[u32]) {
        if self.agent.entries == 0 {
            self.enter(self.agent.state);
        }
        entered.iter().for_each(|&state| self.enter(state));
    }

    /// The state to which the first transition leads whose condition holds.
    fn next_state(&self, moment: &Moment) -> Option<u32> {
        let position_m = self.position_m();
        let is_inside = |area: usize| self.behaviour.areas[area].holds(position_m);
        let facts = Facts {
            to_goal_m: self.to_goal_m().map(|to_goal_m| to_goal_m.max(self.followers.to_goal_m)),
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

    fn to_goal_m(&self) -> Option<f32> {
        to_goal_m(self.behaviour, self.view, self.index, self.agent, self.position_m())
    }

    /// Enters a state: leaves the old goal unless it stands there now, applies the settings.
    fn enter(&mut self, state: u32) {
        let behaviour = self.behaviour;
        let entered = &behaviour.states[state as usize];
        self.agent.before = (self.agent.entries > 0).then_some(self.agent.state);
        (self.agent.state, self.agent.entered_s) = (state, self.view.time_s);
        self.agent.entries += 1;
        if !matches!(entered.movement, Movement::Stand { .. }) {
            self.occupancy.leave(self.agent);
        }
        self.agent.at_head_s = None;
        let drawer = self.drawer();
        let settings = &entered.settings;
        let mut traits = self.agent.lasting;
        if let Some(speed_mps) = settings.preferred_speed_mps {
            traits.preferred_speed_mps = speed_mps.draw(&mut drawer.random(Purpose::Setting(0)));
        }
        if let Some(factor) = settings.speed_factor {
            let speed_mps = traits.preferred_speed_mps * factor.draw(&mut drawer.random(Purpose::Setting(1)));
            traits.preferred_speed_mps = speed_mps.min(SPEED_MAX_MPS);
        }
        if let Some(radius_m) = settings.radius_m {
            traits.radius_m = radius_m.draw(&mut drawer.random(Purpose::Setting(2)));
        }
        self.agent.traits = traits;
        if settings.remain {
            self.agent.lasting = traits;
        }
        if let Some(area) = &settings.teleport {
            let position_m = self.view.draw_clear_m(self.of(), area, &mut drawer.random(Purpose::Setting(3)));
            self.teleported_m = Some(position_m).filter(|&position_m| (self.view.is_clear)(self.of(), position_m));
        }
    }

    /// What the agent wants now.
    pub(crate) fn aim(&self) -> Aim {
        let start_m = self.agent.start_m;
        match *self.movement() {
            Movement::OwnPath => Aim::OwnPath,
            Movement::Goals { .. } => self.aim_at_goal(self.facing_in_queue_rad()),
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
            Movement::Leave { at_once } => Aim::Leave { at_once },
        }
    }

    /// Facing at a position of a queue, rad: that of the position, or towards the next one; at the head as behind it.
    fn facing_in_queue_rad(&self) -> Option<f32> {
        let goal = self.agent.goal?.at;
        let set = &self.behaviour.goals[goal.set as usize];
        let place = &set.areas[goal.area as usize];
        if !set.queue || place.area.distance_m(self.position_m()) > IN_QUEUE_M {
            return None;
        }
        let ahead_of = |from: usize| {
            let [to_m, from_m] = [from - 1, from].map(|index| set.areas.get(index).map(|place| place.area.centre_m()));
            let to = (to_m? - from_m?).try_normalize()?;
            Some(libm::atan2f(to.y, to.x))
        };
        place.facing_rad.or_else(|| ahead_of((goal.area as usize).max(1)))
    }

    fn aim_at_goal(&self, facing_rad: Option<f32>) -> Aim {
        match self.agent.goal {
            Some(ChosenGoal { at: goal, position_m, .. }) => Aim::Goal { goal, position_m, facing_rad },
            None => Aim::Stay { facing_rad },
        }
    }
}

/// Distance of an agent at a position to the goal of its present state, m; none without a goal. An agent that stands at
/// its goal has reached it, however small the goal is.
pub(crate) fn to_goal_m(
    behaviour: &Behaviour,
    view: &CrowdView,
    index: usize,
    agent: &AgentState,
    position_m: Vec2,
) -> Option<f32> {
    let start_m = agent.start_m;
    let distance_m = match behaviour.states[agent.state as usize].movement {
        Movement::OwnPath => (view.path_end_m)(index)?,
        Movement::Mirrored { centre_m } => position_m.distance(2.0 * centre_m - start_m),
        Movement::Offset { by_m } => position_m.distance(start_m + by_m),
        Movement::Goals { .. } | Movement::Walk { .. } | Movement::Stand { .. } | Movement::Leave { .. } => {
            let goal = agent.goal?.at;
            behaviour.goals[goal.set as usize].areas[goal.area as usize].area.distance_m(position_m)
        }
    };
    let is_of_this_state = agent.entered_s < view.time_s;
    Some(if is_of_this_state && (view.has_come_to_goal)(index) { 0.0 } else { distance_m })
}
