//! From the tables of agents in a scenario file to explicit agents, and back from an agent to its table or line.

use std::io::ErrorKind;
use std::ops::Range;
use std::path::Path;

use motiondb::files::{Invalid, SourceText, input_file};
use toml::Spanned;

use crate::behaviour::Behaviour;
use crate::maths::random::SplitMix64;
use crate::scenario::agent_spec::AgentSpec;
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::{ScenarioFault, ScenarioPart, TableFault};
use crate::scenario::file::agent_area::{AgentArea, AreaDisc, TakenGround};
use crate::scenario::file::agent_groups::{AgentGroup, AgentGroups, AgentLayout, Journey, check_size};
use crate::scenario::file::agent_lines::{AgentLines, LineRoom, is_agent_file, line_span, parse_lines};
use crate::scenario::file::behaviour::StateNames;
use crate::scenario::file::group_keys::form_groups;
use crate::scenario::file::profile_tables::Profiles;
use crate::scenario::profile::DrawnNumbers;
use crate::scenario::ranges::{AGENTS_MAX, check_sizes};
use crate::scenario::resolved::Scenario;

/// First random stream of the numbers of agents, one for each table.
const NUMBER_STREAM: u64 = 1 << 36;
/// First random stream of the sizes of groups, one for each table.
const GROUP_STREAM: u64 = 1 << 38;

/// All agents of a scenario file, and the tables that describe them.
#[derive(Default)]
pub(crate) struct PlacedAgents {
    pub(crate) agents: Vec<AgentSpec>,
    tables: Vec<AgentTable>,
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

/// What tables of agents refer to.
pub(crate) struct PlacementInput<'a> {
    pub(crate) source: &'a SourceText,
    pub(crate) states: &'a StateNames<'a>,
    pub(crate) profiles: &'a Profiles<'a>,
    /// A scenario with the walls, from which agents of areas keep apart.
    pub(crate) ground: &'a Scenario,
    pub(crate) seed: u64,
}

impl PlacedAgents {
    /// Places the agents of all tables; each table draws its random numbers from streams of its own. Areas come last,
    /// since their agents keep apart from all others.
    pub(crate) fn new(input: &PlacementInput<'_>, groups: &Spanned<AgentGroups>) -> Result<Self, ScenarioError> {
        let mut placing = Placing { input, agents: 0, waypoints: 0, line_bytes: 0 };
        let tables: Vec<(Range<usize>, &AgentGroup)> = groups
            .get_ref()
            .0
            .iter()
            .map(|(span, group)| (span.clone().unwrap_or_else(|| groups.span()), group))
            .collect();
        let mut placed: Vec<TableAgents> = Vec::with_capacity(tables.len());
        for (stream, (span, group)) in tables.iter().enumerate() {
            placed.push(placing.explicit(stream, span, group)?);
        }
        let area_of = |group: &'_ AgentGroup| match group.layout() {
            Ok(AgentLayout::Area(area)) => Some(area.clone()),
            _ => None,
        };
        let areas: Vec<Option<AgentArea>> = tables.iter().map(|(_, group)| area_of(group)).collect();
        let apart_m = areas.iter().flatten().map(AgentArea::apart_m).reduce(f32::max);
        if let Some(apart_m) = apart_m {
            let walls = input.ground.walls_with(&input.ground.doors_closed_at_start());
            let mut taken = TakenGround::new(&walls, apart_m);
            placed
                .iter()
                .flat_map(|table| &table.agents)
                .for_each(|agent| taken.take(agent.position_m, agent.radius_m));
            for (stream, (span, group)) in tables.iter().enumerate() {
                if let Some(area) = &areas[stream] {
                    placed[stream].agents = placing.spread(stream, span, group, area, &mut taken)?;
                }
            }
        }
        let mut all = Self::default();
        for (stream, ((span, group), TableAgents { mut agents, lines })) in tables.into_iter().zip(placed).enumerate() {
            let first = all.agents.len();
            if let Some(sizes) = group.group_sizes().map_err(|fault| placing.at_table(&span, fault))? {
                check_sizes(&ScenarioPart::Agents, &sizes)
                    .map_err(|fault| placing.at_table(&span, (fault.message, fault.help)))?;
                let mut random = SplitMix64::new(input.seed, GROUP_STREAM + stream as u64);
                form_groups(&mut agents, first, &sizes, &mut random);
            }
            all.tables.push(AgentTable { span, lines, first });
            all.agents.extend(agents);
        }
        Ok(all)
    }

    /// The table of an agent.
    pub(crate) fn table(&self, agent: usize) -> &AgentTable {
        // A table may have no agents; the last that begins no later than an agent holds it.
        &self.tables[self.tables.partition_point(|table| table.first <= agent) - 1]
    }
}

/// The agents of one table, and the agent file that it names.
struct TableAgents {
    agents: Vec<AgentSpec>,
    lines: Option<SourceText>,
}

/// The placement under way.
struct Placing<'a> {
    input: &'a PlacementInput<'a>,
    /// Number of agents so far.
    agents: usize,
    /// Number of their waypoints.
    waypoints: usize,
    /// Length of all agent files, bytes.
    line_bytes: usize,
}

impl Placing<'_> {
    /// What the agent files of further tables may hold.
    fn line_room(&self) -> LineRoom {
        LineRoom { agents: AGENTS_MAX - self.agents, used_bytes: self.line_bytes, without_goals: false }
    }

    /// The agents of a table with explicit positions; none of an area.
    fn explicit(
        &mut self,
        stream: usize,
        span: &Range<usize>,
        group: &AgentGroup,
    ) -> Result<TableAgents, ScenarioError> {
        let random = SplitMix64::new(self.input.seed, stream as u64);
        let (journeys, lines) = journeys(self.input.source, group, span, random, self.line_room())?;
        self.line_bytes += lines.as_ref().map_or(0, |lines| lines.text.len());
        let numbers = self.numbers(stream, span, group, journeys.len())?;
        Ok(TableAgents { agents: self.agents(span, group, journeys, &numbers)?, lines })
    }

    /// The agents of an area.
    fn spread(
        &mut self,
        stream: usize,
        span: &Range<usize>,
        group: &AgentGroup,
        area: &AgentArea,
        taken: &mut TakenGround<'_>,
    ) -> Result<Vec<AgentSpec>, ScenarioError> {
        let (ground, count) = area.resolve().map_err(|fault| self.at_table(span, fault))?;
        let size = check_size(self.agents + count, self.waypoints + count * group.goal_count());
        size.map_err(|fault| self.at_table(span, fault))?;
        let numbers = self.numbers(stream, span, group, count)?;
        let disc = |numbers: &DrawnNumbers| {
            let radius_m = numbers.radius_m;
            AreaDisc { radius_m, wall_radius_m: group.wall_radius_m(radius_m) }
        };
        let discs: Vec<AreaDisc> = numbers.iter().map(disc).collect();
        let closed_zones = numbers.iter().fold(0, |all, numbers| all | numbers.closed_zones);
        let ground_of = self.input.ground;
        let with_zones = || ground_of.walls_of(&ground_of.doors_closed_at_start(), closed_zones);
        taken.with_zones = (closed_zones != 0).then(with_zones);
        let random = SplitMix64::new(self.input.seed, stream as u64);
        let starts_m = area.positions_m(&ground, &discs, taken, random).map_err(|fault| self.at_table(span, fault))?;
        let journeys = starts_m.into_iter().map(|start_m| group.journey(start_m)).collect();
        self.agents(span, group, journeys, &numbers)
    }

    fn numbers(
        &self,
        stream: usize,
        span: &Range<usize>,
        group: &AgentGroup,
        count: usize,
    ) -> Result<Vec<DrawnNumbers>, ScenarioError> {
        let random = SplitMix64::new(self.input.seed, NUMBER_STREAM + stream as u64);
        group.numbers(count, self.input.profiles, random).map_err(|fault| self.at_table(span, fault))
    }

    fn agents(
        &mut self,
        span: &Range<usize>,
        group: &AgentGroup,
        journeys: Vec<Journey>,
        numbers: &[DrawnNumbers],
    ) -> Result<Vec<AgentSpec>, ScenarioError> {
        let StateNames { behaviour, .. } = *self.input.states;
        let state = self.input.states.index(group.state.as_ref(), self.input.source)?;
        self.agents += journeys.len();
        self.waypoints += journeys.iter().map(|(_, goals_m)| goals_m.len()).sum::<usize>();
        // After each table, so that many of them do not fill the memory first.
        check_size(self.agents, self.waypoints).map_err(|fault| self.at_table(span, fault))?;
        let journeys = journeys.into_iter().zip(numbers);
        Ok(journeys.map(|(journey, &numbers)| group.agent(journey, numbers, behaviour, state)).collect())
    }

    fn at_table(&self, span: &Range<usize>, (message, help): TableFault) -> ScenarioError {
        self.input.source.invalid(span.clone(), message, help).into()
    }
}

/// The journeys of one table, and the agent file that it names.
fn journeys(
    source: &SourceText,
    group: &AgentGroup,
    span: &Range<usize>,
    random: SplitMix64,
    room: LineRoom,
) -> Result<(Vec<Journey>, Option<SourceText>), ScenarioError> {
    let at_table = |(message, help): TableFault| ScenarioError::from(source.invalid(span.clone(), message, help));
    let journeys = match group.layout().map_err(at_table)? {
        AgentLayout::Single(at_m) => Ok(vec![group.journey(at_m)]),
        AgentLayout::Circle(circle) => circle.journeys(),
        AgentLayout::Grid(grid) => group.grid_journeys(grid, random),
        AgentLayout::Area(_) => Ok(Vec::new()),
        AgentLayout::File(name) => {
            let room = LineRoom { without_goals: group.state.is_some(), ..room };
            let AgentLines { source: lines, journeys } = read_lines(source, name, room)?;
            return Ok((journeys.map_err(|fault| wrong_line(&lines, fault))?, Some(lines)));
        }
    };
    Ok((journeys.map_err(at_table)?, None))
}

fn read_lines(source: &SourceText, name: &Spanned<String>, room: LineRoom) -> Result<AgentLines, ScenarioError> {
    let path = source.beside(Path::new(name.get_ref()));
    AgentLines::read(&path, room).map_err(|error| {
        if input_file::is_of_machine(&error) {
            return ScenarioError::Unreadable { path: path.clone(), source: error };
        }
        let message = match error.kind() {
            ErrorKind::NotFound => format!("{} does not exist", path.display()),
            _ => format!("{} cannot be read: {error}", path.display()),
        };
        source.invalid(name.span(), message, "give a path relative to the scenario file").into()
    })
}

/// The error of a line that is not an agent's, or has no room.
fn wrong_line(lines: &SourceText, (span, message): (Range<usize>, String)) -> ScenarioError {
    let is_quotable = is_agent_file(&lines.text);
    let message = if is_quotable { message } else { "this is not an agent's line".to_owned() };
    Invalid {
        is_quotable,
        ..lines.invalid(span, message, "write `x y goal_x goal_y`, in metres; with a `state`, `x y` is enough")
    }
    .into()
}

/// The agents of lines `x y goal_x goal_y`, with the default disc and speed, each facing its goal.
///
/// # Errors
/// Where a line is not valid.
pub fn agents_of_lines(lines: &SourceText) -> Result<Vec<AgentSpec>, ScenarioError> {
    let (group, behaviour) = (AgentGroup::default(), Behaviour::default());
    let AgentSpec { preferred_speed_mps, radius_m, pre_movement_s, .. } = AgentSpec::default();
    let numbers = DrawnNumbers {
        preferred_speed_mps,
        radius_m,
        pre_movement_s,
        closed_zones: 0,
        priority: 0.0,
        stature: 1.0,
        characters: 0,
        wears_radius: false,
        style: 0,
    };
    let journeys = parse_lines(&lines.text).map_err(|fault| wrong_line(lines, fault))?;
    Ok(journeys.into_iter().map(|journey| group.agent(journey, numbers, &behaviour, 0)).collect())
}

/// The error that agents of lines break a rule, at the line of the agent.
pub fn fault_of_lines(lines: &SourceText, fault: ScenarioFault) -> ScenarioError {
    let span = match fault.part {
        ScenarioPart::Journey(agent) => line_span(&lines.text, agent),
        _ => 0..0,
    };
    lines.invalid(span, fault.message, fault.help).into()
}
