//! From the tables of agents in a scenario file to explicit agents, and back from an agent to its table or line.

use std::io::ErrorKind;
use std::ops::Range;
use std::path::Path;

use motiondb::files::{Invalid, SourceText};
use toml::Spanned;

use crate::behaviour::Behaviour;
use crate::maths::random::SplitMix64;
use crate::scenario::agent_spec::AgentSpec;
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::file::agent_groups::{AgentGroup, AgentGroups, AgentLayout, GroupFault, Journey, check_size};
use crate::scenario::file::agent_lines::{is_agent_file, line_span, parse_lines};
use crate::scenario::file::behaviour::StateNames;

/// All agents of a scenario file, and the tables that describe them.
#[derive(Default)]
pub(crate) struct PlacedAgents {
    pub(crate) agents: Vec<AgentSpec>,
    tables: Vec<AgentTable>,
    waypoints: usize,
}

/// One table of agents.
pub(crate) struct AgentTable {
    /// Bytes of the table in the scenario file.
    pub(crate) span: Range<usize>,
    /// The agent file that it names.
    pub(crate) lines: Option<SourceText>,
    /// Index of its first agent.
    pub(crate) first: usize,
}

impl PlacedAgents {
    /// Places the agents of all tables; each table draws its random numbers from a stream of its own.
    pub(crate) fn new(
        source: &SourceText,
        groups: &Spanned<AgentGroups>,
        states: &StateNames,
        seed: u64,
    ) -> Result<Self, ScenarioError> {
        let mut placed = Self::default();
        for (stream, (span, group)) in groups.get_ref().0.iter().enumerate() {
            let span = span.clone().unwrap_or_else(|| groups.span());
            let random = SplitMix64::new(seed, stream as u64);
            let (journeys, lines) = journeys(source, group, &span, random)?;
            let state = states.index(group.state.as_ref(), source)?;
            let agents = group.agents(journeys, states.behaviour, state);
            placed.waypoints += agents.iter().map(|agent| agent.goals_m.len()).sum::<usize>();
            // After each table, so that many of them do not fill the memory first.
            if let Err((message, help)) = check_size(placed.agents.len() + agents.len(), placed.waypoints) {
                return Err(source.invalid(span, message, help).into());
            }
            placed.tables.push(AgentTable { span, lines, first: placed.agents.len() });
            placed.agents.extend(agents);
        }
        Ok(placed)
    }

    /// The table of an agent.
    pub(crate) fn table(&self, agent: usize) -> &AgentTable {
        // A table may have no agents; the last that begins no later than an agent holds it.
        &self.tables[self.tables.partition_point(|table| table.first <= agent) - 1]
    }
}

/// The journeys of one table, and the agent file that it names.
fn journeys(
    source: &SourceText,
    group: &AgentGroup,
    span: &Range<usize>,
    random: SplitMix64,
) -> Result<(Vec<Journey>, Option<SourceText>), ScenarioError> {
    let at_table = |(message, help): GroupFault| ScenarioError::from(source.invalid(span.clone(), message, help));
    let journeys = match group.layout().map_err(at_table)? {
        AgentLayout::Single(at_m) => Ok(vec![group.journey(at_m)]),
        AgentLayout::Circle(circle) => circle.journeys(),
        AgentLayout::Grid(grid) => group.grid_journeys(grid, random),
        AgentLayout::File(name) => {
            let lines = read_lines(source, name)?;
            return Ok((journeys_of_lines(&lines)?, Some(lines)));
        }
    };
    Ok((journeys.map_err(at_table)?, None))
}

fn read_lines(source: &SourceText, name: &Spanned<String>) -> Result<SourceText, ScenarioError> {
    let path = source.beside(Path::new(name.get_ref()));
    SourceText::read(&path).map_err(|error| {
        let message = match error.kind() {
            ErrorKind::NotFound => format!("{} does not exist", path.display()),
            _ => format!("{} cannot be read: {error}", path.display()),
        };
        source.invalid(name.span(), message, "give a path relative to the scenario file").into()
    })
}

fn journeys_of_lines(lines: &SourceText) -> Result<Vec<Journey>, ScenarioError> {
    parse_lines(&lines.text).map_err(|(span, message)| {
        let is_quotable = is_agent_file(&lines.text);
        let message = if is_quotable { message } else { "this is not an agent's line".to_owned() };
        Invalid { is_quotable, ..lines.invalid(span, message, "write `x y goal_x goal_y`, in metres") }.into()
    })
}

/// The agents of lines `x y goal_x goal_y`, with the default disc and speed, each facing its goal.
///
/// # Errors
/// Where a line is not valid.
pub fn agents_of_lines(lines: &SourceText) -> Result<Vec<AgentSpec>, ScenarioError> {
    Ok(AgentGroup::default().agents(journeys_of_lines(lines)?, &Behaviour::default(), 0))
}

/// The error that agents of lines break a rule, at the line of the agent.
pub fn fault_of_lines(lines: &SourceText, fault: ScenarioFault) -> ScenarioError {
    let span = match fault.part {
        ScenarioPart::Journey(agent) => line_span(&lines.text, agent),
        _ => 0..0,
    };
    lines.invalid(span, fault.message, fault.help).into()
}
