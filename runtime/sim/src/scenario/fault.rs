//! A rule that a scenario breaks, and the part of the scenario that breaks it.

/// What is wrong with a table, and how to mend it.
pub(crate) type TableFault = (String, &'static str);

/// A rule that a scenario breaks.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioFault {
    /// The part that breaks it.
    pub part: ScenarioPart,
    /// What is wrong.
    pub message: String,
    /// How to mend it.
    pub help: &'static str,
}

/// A part of a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScenarioPart {
    /// `name`
    Name,
    /// `duration_s`
    Duration,
    /// `dt_s`
    Step,
    /// `[view]`
    View,
    /// `[shot]`
    Shot,
    /// `[variation]`
    Variation,
    /// A tunable: section and key.
    Parameter(String, String),
    /// Start or goals of an agent, by its index.
    Journey(usize),
    /// Disc, speed or facing of an agent, by its index.
    Agent(usize),
    /// An obstacle, by index.
    Obstacle(usize),
    /// A door, by index.
    Door(usize),
    /// An enclosure, by index.
    Enclosure(usize),
    /// A walkable polygon, by index.
    Walkable(usize),
    /// A source of agents, by index.
    Source(usize),
    /// A state of the behaviour, by index.
    State(usize),
    /// A set of goals, by index.
    Goals(usize),
    /// An area that conditions name, by index.
    Area(usize),
    /// A signal, by index.
    Signal(usize),
    /// An event, by index.
    Event(usize),
    /// A `[[measure]]` table, by index.
    Measure(usize),
    /// A marking, by index.
    Marking(usize),
    /// A label, by index.
    Label(usize),
    /// A zone, by index.
    Zone(usize),
    /// A camera, by index.
    Camera(usize),
    /// A character, by index.
    Character(usize),
    /// All agents together.
    Agents,
}

impl ScenarioPart {
    /// The error that this part breaks a rule.
    pub(crate) fn fault<T>(&self, message: String, help: &'static str) -> Result<T, ScenarioFault> {
        Err(ScenarioFault { part: self.clone(), message, help })
    }
}
