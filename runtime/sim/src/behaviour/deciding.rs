//! One agent in its step: transitions, then what it wants (`goal_keeping` keeps its goal up to date between). World,
//! metres, seconds.

use glam::Vec2;

use crate::behaviour::agent_state::{AgentState, Aim, ChosenGoal};
use crate::behaviour::choice::draw;
use crate::behaviour::condition::Facts;
use crate::behaviour::crowd_view::{CrowdView, Moment};
use crate::behaviour::draw::{Drawer, Purpose};
use crate::behaviour::occupancy::Occupancy;
use crate::behaviour::state::{Behaviour, Facing, Movement, Target};

/// Transitions of one agent in one step from which on they count as endless.
const TRANSITIONS_MAX: usize = 100;
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
    /// Position to which a state has moved the agent in this step, m.
    pub(crate) teleported_m: Option<Vec2>,
}

impl Deciding<'_> {
    pub(crate) fn position_m(&self) -> Vec2 {
        self.teleported_m.unwrap_or(self.view.positions_m[self.index])
    }

    pub(crate) fn drawer(&self) -> Drawer {
        Drawer { seed: self.view.seed, agent: self.view.ids[self.index].0, entries: self.agent.entries }
    }

    pub(crate) fn movement(&self) -> &Movement {
        &self.behaviour.states[self.agent.state as usize].movement
    }

    /// Takes transitions until none is due. Returns the states entered where the transitions do not end, each once.
    pub(crate) fn follow_transitions(&mut self, moment: &Moment) -> Vec<u32> {
        if self.agent.entries == 0 {
            self.enter(self.agent.state);
        }
        let mut entered = Vec::new();
        while let Some(target) = self.next_state(moment) {
            if entered.len() == TRANSITIONS_MAX {
                entered.sort_unstable();
                entered.dedup();
                return entered;
            }
            entered.push(target);
            self.enter(target);
        }
        Vec::new()
    }

    /// The state to which the first transition leads whose condition holds.
    fn next_state(&self, moment: &Moment) -> Option<u32> {
        let position_m = self.position_m();
        let is_inside = |area: usize| self.behaviour.areas[area].holds(position_m);
        let facts = Facts {
            to_goal_m: self.to_goal_m(),
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

    /// Distance to the goal of the present state, m; none without a goal. An agent that stands at its goal has reached
    /// it, however small the goal is.
    fn to_goal_m(&self) -> Option<f32> {
        let is_of_this_state = self.agent.entered_s < self.view.time_s;
        let distance_m = self.goal_distance_m()?;
        Some(if is_of_this_state && (self.view.stands_at_goal)(self.index) { 0.0 } else { distance_m })
    }

    fn goal_distance_m(&self) -> Option<f32> {
        let (position_m, start_m) = (self.position_m(), self.agent.start_m);
        match *self.movement() {
            Movement::OwnPath => (self.view.path_end_m)(self.index),
            Movement::Mirrored { centre_m } => Some(position_m.distance(2.0 * centre_m - start_m)),
            Movement::Offset { by_m } => Some(position_m.distance(start_m + by_m)),
            Movement::Goals { .. } | Movement::Walk { .. } | Movement::Stand { .. } | Movement::Leave { .. } => {
                self.agent.goal.map(|goal| self.area(goal.at).area.distance_m(position_m))
            }
        }
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
            let position_m = self.view.draw_clear_m(area, &mut drawer.random(Purpose::Setting(3)));
            self.teleported_m = Some(position_m).filter(|&position_m| (self.view.is_clear)(position_m));
        }
    }

    /// What the agent wants now.
    pub(crate) fn aim(&self) -> Aim {
        let start_m = self.agent.start_m;
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
            Movement::Leave { at_once } => Aim::Leave { at_once },
        }
    }

    fn aim_at_goal(&self, facing_rad: Option<f32>) -> Aim {
        match self.agent.goal {
            Some(ChosenGoal { at: goal, position_m, .. }) => Aim::Goal { goal, position_m, facing_rad },
            None => Aim::Stay { facing_rad },
        }
    }
}
