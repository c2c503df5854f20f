//! From the tables of behaviour to a [`Behaviour`]: names become indices, degrees radians; every mistake is shown at its
//! position in the text.

use std::collections::BTreeMap;
use std::ops::{Range, RangeInclusive};

use motiondb::files::SourceText;
use toml::Spanned;

use crate::behaviour::{Behaviour, Choice, FOLLOWS_PATH, Facing, GoalSet, Movement, Settings, State};
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::{ScenarioPart, TableFault};
use crate::scenario::file::behaviour::goal_tables::{choice, goal_sets, signal};
use crate::scenario::file::behaviour::numbers::{DistributionValue, priority};
use crate::scenario::file::behaviour::placed_fault::{At, Names, PlacedFault, check_count, fault};
use crate::scenario::file::behaviour::shared_goals::share_goals;
use crate::scenario::file::behaviour::tables::{
    BACK, BehaviourTables, FacingName, GoValue, RememberValue, RemoveName, RemoveValue, SetTable, StandTable,
    StateTable,
};
use crate::scenario::point::Point;
use crate::scenario::ranges::{RADIUS_M, SPEED_MPS};

/// Greatest number of transitions of all states, and of their conditions.
pub(crate) const TRANSITIONS_MAX: usize = 100_000;
/// Greatest factor of a speed.
const FACTOR_MAX: f32 = 10.0;
/// The agent's own waypoints, as a goal.
const OWN_PATH: &str = "own_path";

impl BehaviourTables {
    /// The behaviour.
    pub(crate) fn resolve(&self, source: &SourceText) -> Result<Behaviour, ScenarioError> {
        self.behaviour().map_err(|(span, (message, help))| source.invalid(span, message, help).into())
    }

    /// The bytes of a part of the behaviour.
    pub(crate) fn span(&self, part: &ScenarioPart) -> Range<usize> {
        fn nth<T>(tables: &BTreeMap<String, Spanned<T>>, index: usize) -> Range<usize> {
            tables.values().nth(index).map_or(0..0, Spanned::span)
        }
        match *part {
            ScenarioPart::State(state) => nth(&self.states, state.saturating_sub(1)),
            ScenarioPart::Goals(set) => nth(&self.goals, set),
            ScenarioPart::Area(area) => nth(&self.areas, area),
            ScenarioPart::Signal(signal) => nth(&self.signals, signal),
            ScenarioPart::Event(event) => nth(&self.events, event),
            _ => 0..0,
        }
    }

    fn behaviour(&self) -> Result<Behaviour, PlacedFault> {
        let Self { signals, areas, goals, states, events } = self;
        check_count("states", states)?;
        check_count("signals", signals)?;
        check_count("areas", areas)?;
        check_count("goals", goals)?;
        check_count("events", events)?;
        let goals = goal_sets(goals)?;
        let mut resolving = Resolving {
            goals: &goals,
            choices: self.goals.values().map(|table| choice(table.get_ref().choose)).collect(),
            states: Names::new("state", states),
            goal_names: Names::new("goals", &self.goals),
            signals: Names::new("signal", signals),
            areas: Names::new("area", areas),
            left: TRANSITIONS_MAX,
        };
        let mut resolved = Vec::new();
        if !states.is_empty() {
            resolved.push(State::follow_path());
        }
        for (name, table) in states {
            resolved.push(resolving.state(name, table)?);
        }
        share_goals(&mut resolved, states, |movement| resolving.is_queue(movement))?;
        let events = events.iter().map(|(name, table)| resolving.event(name, table)).collect::<Result<_, _>>()?;
        let behaviour = Behaviour {
            states: resolved,
            events,
            signals: signals.iter().map(|(name, table)| signal(name, table)).collect::<Result<_, _>>()?,
            areas: areas.values().map(|table| table.get_ref().area().at(&table.span())).collect::<Result<_, _>>()?,
            goals,
        };
        let endless = behaviour.endless_states();
        if let Some(first) = endless.first() {
            let names = endless.join("`, `");
            let message = format!("states `{names}` change into one another without end within one step");
            return Err(fault(&states[*first].span(), message, "add `when` to one of their transitions"));
        }
        Ok(behaviour)
    }
}

/// The states that agents and sources may name.
pub(crate) struct StateNames<'a> {
    pub(crate) tables: &'a BehaviourTables,
    pub(crate) behaviour: &'a Behaviour,
}

impl StateNames<'_> {
    /// Index of the state in which agents of a table begin; 0 where it names none.
    pub(crate) fn index(&self, name: Option<&Spanned<String>>, source: &SourceText) -> Result<u32, ScenarioError> {
        let Some(name) = name.filter(|name| name.get_ref() != FOLLOWS_PATH) else { return Ok(0) };
        let index = Names::new("state", &self.tables.states).index(name.get_ref());
        let state = index.map_err(|(message, help)| source.invalid(name.span(), message, help))?;
        Ok(state as u32 + 1)
    }
}

/// Names and limits, for one state after the other.
pub(crate) struct Resolving<'a> {
    goals: &'a [GoalSet],
    /// How agents choose in each set of goals.
    choices: Vec<Choice>,
    pub(crate) states: Names<'a>,
    goal_names: Names<'a>,
    pub(crate) signals: Names<'a>,
    pub(crate) areas: Names<'a>,
    /// Number of conditions that may still come.
    pub(crate) left: usize,
}

impl Resolving<'_> {
    fn state(&mut self, name: &str, table: &Spanned<StateTable>) -> Result<State, PlacedFault> {
        let (span, state) = (table.span(), table.get_ref());
        if [FOLLOWS_PATH, BACK].contains(&name) {
            return Err(fault(&span, format!("`{name}` is a name that every scenario has"), "choose another name"));
        }
        let movement = self.movement(name, state, &span)?;
        if matches!(movement, Movement::Leave { .. }) && !state.then.is_empty() {
            let message = format!("state `{name}` removes its agents, so no state comes after it");
            return Err(fault(&span, message, "remove `then`"));
        }
        Ok(State {
            name: name.to_owned(),
            movement,
            settings: state.set.as_ref().map_or_else(|| Ok(Settings::default()), settings)?,
            transitions: state.then.iter().map(|then| self.transition(then)).collect::<Result<_, _>>()?,
        })
    }

    fn movement(&self, name: &str, state: &StateTable, span: &Range<usize>) -> Result<Movement, PlacedFault> {
        let movement = match (&state.go, &state.stand, state.walk_mps, state.remove) {
            (Some(go), None, None, None) => self.go(name, go, state)?,
            (None, Some(stand), None, None) => Movement::Stand { facing: facing(stand).at(span)? },
            (None, None, Some(Point(velocity_mps)), None) => {
                if velocity_mps.is_nan() || velocity_mps.length() > *SPEED_MPS.end() {
                    let message = format!("`walk_mps` is {velocity_mps}, faster than {} m/s", SPEED_MPS.end());
                    return Err(fault(span, message, "give a velocity in m/s"));
                }
                Movement::Walk { velocity_mps }
            }
            (None, None, None, Some(RemoveValue::Flag(true))) => Movement::Leave { at_once: false },
            (None, None, None, Some(RemoveValue::Named(name))) => {
                Movement::Leave { at_once: name == RemoveName::AtOnce }
            }
            _ => {
                let message =
                    format!("state `{name}` needs exactly one of `go`, `stand`, `walk_mps` and `remove = true`");
                return Err(fault(span, message, "write `stand = {}` for agents that stay"));
            }
        };
        match (&state.remember, &movement) {
            (Some(remember), Movement::Goals { .. }) if self.is_queue(&movement) => {
                Err(fault(&remember.span(), "a place in a queue is not remembered".into(), "remove `remember`"))
            }
            (None, _) | (Some(_), Movement::Goals { .. }) => Ok(movement),
            (Some(remember), _) => {
                Err(fault(&remember.span(), "only `go` to goals can be remembered".into(), "remove `remember`"))
            }
        }
    }

    fn is_queue(&self, movement: &Movement) -> bool {
        matches!(movement, Movement::Goals { set, .. } if self.goals[*set].queue)
    }

    fn go(&self, name: &str, go: &Spanned<GoValue>, state: &StateTable) -> Result<Movement, PlacedFault> {
        match go.get_ref() {
            GoValue::Goals(goals) if goals == OWN_PATH => Ok(Movement::OwnPath),
            GoValue::Goals(goals) => {
                let set = self.goal_names.index(goals).at(&go.span())?;
                let memory = match &state.remember {
                    None => None,
                    Some(remember) => match remember.get_ref() {
                        RememberValue::Own(false) => None,
                        RememberValue::Own(true) => Some(name),
                        RememberValue::Of(of) => Some(of.as_str()),
                    }
                    .map(|of| self.state_index(of).at(&remember.span()))
                    .transpose()?,
                };
                Ok(Movement::Goals { set, choice: self.choices[set], memory })
            }
            GoValue::Mirror(mirror) => Ok(Movement::Mirrored { centre_m: mirror.mirror_m.0 }),
            GoValue::Offset(offset) => Ok(Movement::Offset { by_m: offset.offset_m.0 }),
        }
    }

    /// Index of a state; the first is [`FOLLOWS_PATH`].
    pub(crate) fn state_index(&self, name: &str) -> Result<u32, TableFault> {
        match name {
            FOLLOWS_PATH => Ok(0),
            _ => self.states.index(name).map(|state| state as u32 + 1),
        }
    }
}

fn facing(stand: &StandTable) -> Result<Facing, TableFault> {
    match (stand.facing, stand.facing_deg, stand.facing_m) {
        (None, None, None) => Ok(Facing::AsArrived),
        (Some(FacingName::Goal), None, None) => Ok(Facing::OfGoal),
        (None, Some(facing_deg), None) if facing_deg.is_finite() => Ok(Facing::Towards(facing_deg.to_radians())),
        (None, None, Some(Point(at_m))) => Ok(Facing::At(at_m)),
        _ => {
            let message = "`stand` needs at most one of `facing`, `facing_deg` and `facing_m`";
            Err((message.into(), "write `stand = { facing = \"goal\" }` or `stand = {}`"))
        }
    }
}

fn settings(table: &Spanned<SetTable>) -> Result<Settings, PlacedFault> {
    let (span, set) = (table.span(), table.get_ref());
    let drawn = |name, value: Option<DistributionValue>, bounds| {
        value.map(|value| value.resolve(name, bounds)).transpose().at(&span)
    };
    let bounds = |range: &RangeInclusive<f32>| [*range.start(), *range.end()];
    Ok(Settings {
        preferred_speed_mps: drawn("`preferred_speed_mps`", set.preferred_speed_mps, bounds(&SPEED_MPS))?,
        speed_factor: drawn("`speed_factor`", set.speed_factor, [1e-3, FACTOR_MAX])?,
        radius_m: drawn("`radius_m`", set.radius_m, bounds(&RADIUS_M))?,
        priority: set.priority.map(priority).transpose().at(&span)?,
        teleport: set.teleport.as_ref().map(|area| area.area()).transpose().at(&span)?,
        remain: set.remain,
    })
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
