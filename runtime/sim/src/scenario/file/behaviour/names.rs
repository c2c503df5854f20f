//! From the tables of behaviour to a [`Behaviour`]: names become indices, degrees radians; every mistake is shown at its
//! position in the text.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::Vec2;
use motiondb::files::SourceText;
use toml::Spanned;

use crate::behaviour::{
    Area, Behaviour, Bound, Choice, Condition, Facing, GoalArea, GoalSet, Movement, Settings, Signal, State, Target,
    Transition,
};
use crate::scenario::error::ScenarioError;
use crate::scenario::file::behaviour::area_table::TableFault;
use crate::scenario::file::behaviour::numbers::DistributionValue;
use crate::scenario::file::behaviour::tables::{
    BehaviourTables, ChooseName, ChooseValue, FacingName, GoValue, GoalAreaTable, GoalsTable, RememberValue, SetTable,
    SignalTable, StandTable, StateTable, ThenTable, ToValue, WhenTable,
};
use crate::scenario::point::Point;
use crate::scenario::ranges::{RADIUS_M, SPEED_MPS};

/// Greatest number of states, signals or areas, and of areas of all goals.
const ITEMS_MAX: usize = 10_000;
/// Greatest number of transitions of all states, and of conditions in one.
const TRANSITIONS_MAX: usize = 100_000;
/// Greatest duration, s: a day.
const DURATION_MAX_S: f32 = 86_400.0;
/// Greatest factor of a speed.
const FACTOR_MAX: f32 = 10.0;
/// The state before, as a target.
const BACK: &str = "back";
/// The agent's own waypoints, as a goal.
const OWN_PATH: &str = "own_path";

impl BehaviourTables {
    /// The behaviour.
    pub(crate) fn resolve(&self, source: &SourceText) -> Result<Behaviour, ScenarioError> {
        let resolving = Resolving { tables: self };
        resolving.behaviour().map_err(|(span, (message, help))| source.invalid(span, message, help).into())
    }
}

/// A mistake, and its bytes in the text.
type PlacedFault = (Range<usize>, TableFault);

/// Gives faults a position.
trait At<T> {
    fn at(self, span: &Range<usize>) -> Result<T, PlacedFault>;
}

impl<T> At<T> for Result<T, TableFault> {
    fn at(self, span: &Range<usize>) -> Result<T, PlacedFault> {
        self.map_err(|fault| (span.clone(), fault))
    }
}

struct Resolving<'a> {
    tables: &'a BehaviourTables,
}

impl Resolving<'_> {
    fn behaviour(&self) -> Result<Behaviour, PlacedFault> {
        let BehaviourTables { signals, areas, goals, states } = self.tables;
        check_count("states", states)?;
        check_count("signals", signals)?;
        check_count("areas", areas)?;
        check_count("goals", goals)?;
        let behaviour = Behaviour {
            signals: signals.iter().map(|(name, table)| signal(name, table)).collect::<Result<_, _>>()?,
            areas: areas.values().map(|table| table.get_ref().area().at(&table.span())).collect::<Result<_, _>>()?,
            goals: goals.iter().map(|(name, table)| goal_set(name, table)).collect::<Result<_, _>>()?,
            states: states.iter().map(|(name, table)| self.state(name, table)).collect::<Result<_, _>>()?,
        };
        let endless = behaviour.endless_states();
        if let Some(first) = endless.first() {
            let names = endless.join("`, `");
            let message = format!("states `{names}` change into one another without end within one step");
            return Err(fault(&states[*first].span(), message, "add `when` to one of their transitions"));
        }
        Ok(behaviour)
    }

    fn state(&self, name: &str, table: &Spanned<StateTable>) -> Result<State, PlacedFault> {
        let (span, state) = (table.span(), table.get_ref());
        let transitions: usize = state.then.len();
        if transitions > TRANSITIONS_MAX {
            let message = format!("state `{name}` has {transitions} transitions, more than {TRANSITIONS_MAX}");
            return Err(fault(&span, message, "give fewer"));
        }
        Ok(State {
            name: name.to_owned(),
            movement: self.movement(name, state, &span)?,
            settings: state.set.as_ref().map_or_else(|| Ok(Settings::default()), settings)?,
            transitions: state.then.iter().map(|then| self.transition(then)).collect::<Result<_, _>>()?,
        })
    }

    fn movement(&self, name: &str, state: &StateTable, span: &Range<usize>) -> Result<Movement, PlacedFault> {
        let movement = match (&state.go, &state.stand, state.walk_mps, state.leave) {
            (Some(go), None, None, None) => self.go(name, go, state)?,
            (None, Some(stand), None, None) => Movement::Stand { facing: facing(stand).at(span)? },
            (None, None, Some(Point(velocity_mps)), None) => {
                if velocity_mps.is_nan() || velocity_mps.length() > *SPEED_MPS.end() {
                    let message = format!("`walk_mps` is {velocity_mps}, faster than {} m/s", SPEED_MPS.end());
                    return Err(fault(span, message, "give a velocity in m/s"));
                }
                Movement::Walk { velocity_mps }
            }
            (None, None, None, Some(true)) => Movement::Leave,
            _ => {
                let message =
                    format!("state `{name}` needs exactly one of `go`, `stand`, `walk_mps` and `leave = true`");
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
        matches!(movement, Movement::Goals { set, .. } if self.tables.goals.values().nth(*set).is_some_and(|goals| goals.get_ref().queue))
    }

    fn go(&self, name: &str, go: &Spanned<GoValue>, state: &StateTable) -> Result<Movement, PlacedFault> {
        match go.get_ref() {
            GoValue::Goals(goals) if goals == OWN_PATH => Ok(Movement::OwnPath),
            GoValue::Goals(goals) => {
                let set = index(&self.tables.goals, "goals", goals).at(&go.span())?;
                let choice = choice(self.tables.goals[goals].get_ref().choose);
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
                Ok(Movement::Goals { set, choice, memory })
            }
            GoValue::Mirror(mirror) => Ok(Movement::Mirrored { centre_m: mirror.mirror_m.0 }),
            GoValue::Offset(offset) => Ok(Movement::Offset { by_m: offset.offset_m.0 }),
        }
    }

    fn state_index(&self, name: &str) -> Result<u32, TableFault> {
        index(&self.tables.states, "state", name).map(|state| state as u32)
    }

    fn transition(&self, then: &Spanned<ThenTable>) -> Result<Transition, PlacedFault> {
        let (span, table) = (then.span(), then.get_ref());
        let mut left = TRANSITIONS_MAX;
        let condition = self.condition(&table.when, &mut left).at(&span)?;
        let to = table.to.span();
        let target = match table.to.get_ref() {
            ToValue::State(name) if name == BACK => Target::Back,
            ToValue::State(name) => Target::States(vec![(self.state_index(name).at(&to)?, 1.0)]),
            ToValue::Weights(weights) => {
                let weighted = |(name, &weight): (&String, &f32)| Ok((self.state_index(name)?, weight));
                let states: Vec<(u32, f32)> = weights.iter().map(weighted).collect::<Result<_, _>>().at(&to)?;
                let sum: f32 = states.iter().map(|(_, weight)| weight).sum();
                if !states.iter().all(|(_, weight)| *weight >= 0.0) || !(sum > 0.0 && sum.is_finite()) {
                    let message = format!("the weights add up to {sum}, or one is negative");
                    return Err(fault(&to, message, "give weights of 0 or more, one of them above 0"));
                }
                Target::States(states)
            }
        };
        Ok(Transition { condition, target })
    }

    /// All keys of a table together.
    fn condition(&self, when: &WhenTable, left: &mut usize) -> Result<Condition, TableFault> {
        *left = left.checked_sub(1).ok_or_else(|| ("too many conditions".to_owned(), "give fewer"))?;
        let mut parts = Vec::new();
        if let Some(reached_m) = when.reached_m {
            if !(0.0..=1e4).contains(&reached_m) {
                return Err((format!("`reached_m` is {reached_m}"), "give a distance in metres; 0 means inside"));
            }
            parts.push(Condition::Reached(reached_m));
        }
        let duration = |name, value: DistributionValue| value.resolve(name, [0.0, DURATION_MAX_S]);
        if let Some(after_s) = when.after_s {
            parts.push(Condition::After(duration("`after_s`", after_s)?));
        }
        if let Some(served_s) = when.served_s {
            parts.push(Condition::Served(duration("`served_s`", served_s)?));
        }
        if let Some(area) = &when.inside {
            parts.push(Condition::Inside(index(&self.tables.areas, "area", area)?));
        }
        if let Some(signal) = &when.green {
            parts.push(Condition::Green(index(&self.tables.signals, "signal", signal)?));
        }
        if let Some(number) = &when.number {
            let area = index(&self.tables.areas, "area", &number.inside)?;
            parts.push(Condition::Number(area, bound(number.at_least, number.at_most)?));
        }
        if let Some(population) = &when.population {
            let state = index(&self.tables.states, "state", &population.state)?;
            parts.push(Condition::Population(state, bound(population.at_least, population.at_most)?));
        }
        let mut all = |tables: &[WhenTable]| -> Result<Vec<Condition>, TableFault> {
            tables.iter().map(|table| self.condition(table, left)).collect()
        };
        if let Some(tables) = &when.all {
            parts.push(Condition::All(all(tables)?));
        }
        if let Some(tables) = &when.any {
            parts.push(Condition::Any(all(tables)?));
        }
        if let Some(table) = &when.not {
            parts.push(Condition::Not(Box::new(self.condition(table, left)?)));
        }
        Ok(match parts.len() {
            0 => Condition::Always,
            1 => parts.remove(0),
            _ => Condition::All(parts),
        })
    }
}

fn fault(span: &Range<usize>, message: String, help: &'static str) -> PlacedFault {
    (span.clone(), (message, help))
}

fn check_count<T>(what: &str, items: &BTreeMap<String, Spanned<T>>) -> Result<(), PlacedFault> {
    match items.values().nth(ITEMS_MAX) {
        None => Ok(()),
        Some(item) => {
            let message = format!("the scenario has {} {what}, more than {ITEMS_MAX}", items.len());
            Err(fault(&item.span(), message, "give fewer"))
        }
    }
}

/// Index of a name among the sorted names.
fn index<T>(items: &BTreeMap<String, T>, what: &str, name: &str) -> Result<usize, TableFault> {
    if let Some(index) = items.keys().position(|key| key == name) {
        return Ok(index);
    }
    let names: Vec<&str> = items.keys().map(String::as_str).take(20).collect();
    let message = match names.is_empty() {
        true => format!("there is no {what} `{name}`, and none at all"),
        false => format!("there is no {what} `{name}`; there are `{}`", names.join("`, `")),
    };
    Err((message, "correct the name, or add its table"))
}

fn signal(name: &str, table: &Spanned<SignalTable>) -> Result<Signal, PlacedFault> {
    let SignalTable { green_s, red_s, offset_s } = *table.get_ref();
    let is_duration = |duration_s: f32| (0.0..=DURATION_MAX_S).contains(&duration_s);
    if is_duration(green_s) && is_duration(red_s) && green_s + red_s > 0.0 && offset_s.abs() <= DURATION_MAX_S {
        return Ok(Signal { name: name.to_owned(), green_s, red_s, offset_s });
    }
    let message = format!("signal `{name}` is green for {green_s} s, red for {red_s} s, offset {offset_s} s");
    Err(fault(&table.span(), message, "give durations from 0 s to a day, one of them above 0"))
}

fn goal_set(name: &str, table: &Spanned<GoalsTable>) -> Result<GoalSet, PlacedFault> {
    let (span, goals) = (table.span(), table.get_ref());
    let offsets_m: Vec<Vec2> = match &goals.copies_m {
        None => vec![Vec2::ZERO],
        Some(copies_m) => copies_m.iter().map(|&Point(offset_m)| offset_m).collect(),
    };
    let count = goals.areas.len().saturating_mul(offsets_m.len());
    if !(1..=ITEMS_MAX).contains(&count) {
        let message = format!("goals `{name}` have {count} areas, not between 1 and {ITEMS_MAX}");
        return Err(fault(&span, message, "add `areas = [{ point_m = [x, y] }]`"));
    }
    let mut areas = Vec::with_capacity(count);
    for offset_m in offsets_m {
        for table in &goals.areas {
            areas.push(goal_area(goals, table, offset_m)?);
        }
    }
    Ok(GoalSet { name: name.to_owned(), areas, queue: goals.queue })
}

fn goal_area(goals: &GoalsTable, table: &Spanned<GoalAreaTable>, offset_m: Vec2) -> Result<GoalArea, PlacedFault> {
    let (span, area) = (table.span(), table.get_ref());
    let capacity = area.capacity.or(goals.capacity);
    let weight = area.weight.unwrap_or(1.0);
    if capacity == Some(0) || !(0.0..=1e6).contains(&weight) {
        let message = format!("the area has capacity {capacity:?} and weight {weight}");
        return Err(fault(&span, message, "give a capacity of 1 or more, and a weight from 0 to a million"));
    }
    if goals.queue && capacity.is_some() {
        return Err(fault(&span, "a place of a queue takes one agent".into(), "remove `capacity`"));
    }
    let facing_rad = area.facing_deg.map(f32::to_radians);
    if facing_rad.is_some_and(|facing_rad| !facing_rad.is_finite()) {
        return Err(fault(&span, "the facing is no number".into(), "give degrees, counter-clockwise from +x"));
    }
    let moved = match area.keys().area().at(&span)? {
        Area::Disc { centre_m, radius_m } => Area::Disc { centre_m: centre_m + offset_m, radius_m },
        Area::Polygon(corners_m) => Area::Polygon(corners_m.iter().map(|&corner_m| corner_m + offset_m).collect()),
    };
    Ok(GoalArea { area: moved, facing_rad, capacity, weight })
}

fn choice(value: ChooseValue) -> Choice {
    match value {
        ChooseValue::Named(ChooseName::Nearest) => Choice::Nearest,
        ChooseValue::Named(ChooseName::Farthest) => Choice::Farthest,
        ChooseValue::Named(ChooseName::Random) => Choice::Random,
        ChooseValue::Named(ChooseName::Weighted) => Choice::Weighted,
        ChooseValue::Named(ChooseName::LeastBusy) => Choice::LeastBusy,
        ChooseValue::NearestOf(table) => Choice::NearestOf(table.nearest_of.max(1)),
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
    let bounds = |range: &std::ops::RangeInclusive<f32>| [*range.start(), *range.end()];
    Ok(Settings {
        preferred_speed_mps: drawn("`preferred_speed_mps`", set.preferred_speed_mps, bounds(&SPEED_MPS))?,
        speed_factor: drawn("`speed_factor`", set.speed_factor, [1e-3, FACTOR_MAX])?,
        radius_m: drawn("`radius_m`", set.radius_m, bounds(&RADIUS_M))?,
        teleport: set.teleport.as_ref().map(|area| area.area()).transpose().at(&span)?,
        remain: set.remain,
    })
}

fn bound(at_least: Option<u32>, at_most: Option<u32>) -> Result<Bound, TableFault> {
    let bound = Bound { at_least: at_least.unwrap_or(0), at_most: at_most.unwrap_or(u32::MAX) };
    if bound.at_least <= bound.at_most && (at_least.is_some() || at_most.is_some()) {
        return Ok(bound);
    }
    Err(("a number needs `at_least`, `at_most` or both, the former no greater".into(), "write `at_most = 2`"))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use serde::Deserialize;

    use super::*;
    use crate::behaviour::Distribution;

    /// The tables of behaviour alone.
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields, default)]
    #[derive(Default)]
    struct File {
        signals: BTreeMap<String, Spanned<SignalTable>>,
        areas: BTreeMap<String, Spanned<crate::scenario::file::behaviour::area_table::AreaTable>>,
        goals: BTreeMap<String, Spanned<GoalsTable>>,
        states: BTreeMap<String, Spanned<StateTable>>,
    }

    fn resolved(text: &str) -> Result<Behaviour, String> {
        let source = SourceText { path: PathBuf::from("x.toml"), text: text.to_owned() };
        let file: File = toml::from_str(text).map_err(|error| error.to_string())?;
        let File { signals, areas, goals, states } = file;
        BehaviourTables { signals, areas, goals, states }.resolve(&source).map_err(|error| error.to_string())
    }

    fn check_refused(text: &str, line: usize, part: &str) {
        let message = resolved(text).expect_err(text);
        assert!(message.contains(part) && message.contains(&format!("{line}")), "{message}");
    }

    const VISIT: &str = "
        [signals.light]
        green_s = 4
        red_s = 6
        [areas.hall]
        rect_m = [9, 9, 0, 0]
        [goals.booths]
        choose = { nearest_of = 3 }
        capacity = 2
        copies_m = [[0, 0], [5, 1]]
        areas = [{ rect_m = [0, 0, 1, 1], facing_deg = 90 }, { circle_m = [0, 3, 0.5], weight = 3, capacity = 1 }]
        [goals.till]
        queue = true
        areas = [{ point_m = [1, 2] }]
        [states.walk]
        go = 'booths'
        remember = true
        set = { speed_factor = { uniform = [0.9, 1.1] } }
        then = [
            { when = { reached_m = 0.2, inside = 'hall' }, to = 'look' },
            { when = { any = [{ after_s = 60 }, { not = { green = 'light' } }] }, to = { walk = 3, gone = 1 } },
        ]
        [states.look]
        stand = { facing = 'goal' }
        then = [{ when = { after_s = { normal = [5, 2], min = 1 }, number = { inside = 'hall', at_most = 4 } }, to = 'back' }]
        [states.pay]
        go = 'till'
        then = [{ when = { served_s = 3, population = { state = 'gone', at_least = 2 } }, to = 'gone' }]
        [states.gone]
        leave = true
    ";

    #[test]
    fn names_become_indices() {
        let behaviour = resolved(VISIT).unwrap();
        let names: Vec<&str> = behaviour.states.iter().map(|state| state.name.as_str()).collect();
        assert_eq!(names, ["gone", "look", "pay", "walk"]);
        let walk = &behaviour.states[3];
        assert_eq!(walk.movement, Movement::Goals { set: 0, choice: Choice::NearestOf(3), memory: Some(3) });
        assert_eq!(walk.transitions[0].condition, Condition::All(vec![Condition::Reached(0.2), Condition::Inside(0)]));
        assert_eq!(walk.transitions[1].target, Target::States(vec![(0, 1.0), (3, 3.0)]));
        let Condition::All(parts) = &behaviour.states[1].transitions[0].condition else { panic!() };
        assert_eq!(parts[0], Condition::After(Distribution::Normal { mean: 5.0, deviation: 2.0, min: 1.0, max: 11.0 }));
        assert_eq!(behaviour.states[1].transitions[0].target, Target::Back);
        assert_eq!(behaviour.goals[0].areas.len(), 4);
        assert_eq!(behaviour.goals[0].areas[3].area, Area::Disc { centre_m: Vec2::new(5.0, 4.0), radius_m: 0.5 });
        assert_eq!([0, 1].map(|area| behaviour.goals[0].capacity(area)), [2, 1]);
        assert!(behaviour.areas[0].holds(Vec2::splat(4.0)));
    }

    #[test]
    fn mistakes_are_shown_at_their_line() {
        check_refused("[states.a]\ngo = 'nowhere'", 2, "there is no goals `nowhere`, and none at all");
        check_refused("[states.a]\nstand = {}\nthen = [{ to = 'b' }]", 3, "there is no state `b`; there are `a`");
        check_refused("[states.a]\nstand = {}\nwalk_mps = [1, 0]", 1, "exactly one of `go`");
        check_refused("[states.a]\nstand = {}\nthen = [{ to = 'a' }]", 1, "without end");
        check_refused("[goals.g]\nareas = []", 1, "have 0 areas");
        check_refused(
            "[goals.g]\nareas = [{ point_m = [0, 0], rect_m = [0, 0, 1, 1] }]",
            2,
            "exactly one of `point_m`",
        );
        check_refused("[goals.g]\nareas = [{ polygon_m = [[0, 0], [1, 1], [1, 0], [0, 1]] }]", 2, "crosses");
        check_refused("[goals.g]\nareas = [{ point_m = [0, 0], weight = -1 }]", 2, "weight -1");
        check_refused("[signals.s]\ngreen_s = 0\nred_s = 0", 1, "green for 0 s");
        check_refused(
            "[states.a]\nstand = {}\nthen = [{ when = { after_s = { uniform = [3, 1] } }, to = 'back' }]",
            3,
            "rise",
        );
        check_refused("[states.a]\nstand = {}\nthen = [{ when = { soon = 1 }, to = 'back' }]", 3, "soon");
        check_refused("[states.a]\nstand = {}\nremember = true", 3, "only `go` to goals");
        check_refused("[states.a]\ngo = { mirror = [0, 0] }", 2, "`{ mirror_m = [x, y] }`");
        check_refused("[states.a]\nstand = {}\nset = { radius_m = 40 }", 3, "within 0.1 and 1");
    }
}
