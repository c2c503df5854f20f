//! The `agents` of a scenario file: one table or a list of tables, each of exactly one layout, and the agents that each
//! describes. World, metres.
//!
//! | layout | its goals |
//! |---|---|
//! | `at_m = [x, y]` | `goals_m`, waypoints in order; then, if set, the start plus `goal_offset_m`; none with `state` |
//! | `circle = { count, radius_m, centre_m }` | the opposite position on the circle, exactly |
//! | `grid = { columns, rows, spacing_m, centre_m, jitter_m }` | as of `at_m`; `goal_offset_m` counts from each agent's own start |
//! | `area = { rect_m, count, apart_m }` | as of `at_m`; see `agent_area.rs` |
//! | `file = "x.txt"` | lines `x y goal_x goal_y`, `#` begins a comment |

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt;
use std::ops::Range;

use glam::{DVec2, Vec2};
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

use crate::behaviour::Behaviour;
use crate::maths::random::SplitMix64;
use crate::scenario::agent_spec::{AgentSpec, AtGoal, PREFERRED_SPEED_MPS, RADIUS_M, WALL_RADIUS_M};
use crate::scenario::fault::TableFault;
use crate::scenario::file::agent_area::AgentArea;
use crate::scenario::file::behaviour::{DistributionValue, fixed_number};
use crate::scenario::file::group_keys::group_sizes;
use crate::scenario::file::profile_tables::{ProfileValue, Profiles};
use crate::scenario::point::Point;
use crate::scenario::profile::DrawnNumbers;
use crate::scenario::ranges::{AGENTS_MAX, WAYPOINTS_MAX};
use crate::scenario::social_group::GroupSizes;

/// The value of `agents`: each table and, in a list, its bytes in the text.
#[derive(Debug)]
pub(crate) struct AgentGroups(pub(crate) Vec<(Option<Range<usize>>, AgentGroup)>);

/// One table of agents.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct AgentGroup {
    at_m: Option<Point>,
    circle: Option<AgentCircle>,
    grid: Option<AgentGrid>,
    area: Option<AgentArea>,
    pub(crate) file: Option<Spanned<String>>,
    goals_m: Option<Vec<Point>>,
    goal_offset_m: Option<Point>,
    facing_deg: Option<f32>,
    #[serde(deserialize_with = "fixed_number")]
    radius_m: Option<f32>,
    wall_radius_m: Option<f32>,
    #[serde(deserialize_with = "fixed_number")]
    preferred_speed_mps: Option<f32>,
    pre_movement_s: Option<DistributionValue>,
    profile: Option<Spanned<ProfileValue>>,
    at_goal: AtGoal,
    pub(crate) state: Option<Spanned<String>>,
    groups: Option<BTreeMap<String, f32>>,
    group_spacing_m: Option<f32>,
    characters: Option<Vec<String>>,
    pub(crate) style: Option<Spanned<String>>,
}

/// Agents on a circle, each bound for the opposite position.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AgentCircle {
    count: usize,
    radius_m: f64,
    #[serde(default)]
    centre_m: Point,
}

/// Agents in rows and columns.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AgentGrid {
    columns: usize,
    rows: usize,
    spacing_m: f64,
    #[serde(default)]
    centre_m: Point,
    #[serde(default)]
    jitter_m: f64,
}

/// The layout of a table.
#[derive(Debug)]
pub(crate) enum AgentLayout<'a> {
    /// The start of a single agent, m.
    Single(Vec2),
    Circle(&'a AgentCircle),
    Grid(&'a AgentGrid),
    Area(&'a AgentArea),
    /// The name of a file of lines.
    File(&'a Spanned<String>),
}

/// Start and goals of an agent, m.
pub(crate) type Journey = (Vec2, Vec<Vec2>);

impl Default for AgentGroup {
    /// A table without keys.
    fn default() -> Self {
        Self {
            at_m: None,
            circle: None,
            grid: None,
            area: None,
            file: None,
            goals_m: None,
            goal_offset_m: None,
            facing_deg: None,
            radius_m: None,
            wall_radius_m: None,
            preferred_speed_mps: None,
            pre_movement_s: None,
            profile: None,
            at_goal: AtGoal::default(),
            state: None,
            groups: None,
            group_spacing_m: None,
            characters: None,
            style: None,
        }
    }
}

impl AgentGroup {
    /// The layout of the table, if it has exactly one, and goals as that layout needs them.
    pub(crate) fn layout(&self) -> Result<AgentLayout<'_>, TableFault> {
        match (self.at_m, &self.circle, &self.grid, &self.area, &self.file) {
            (Some(Point(at_m)), None, None, None, None) => self.with_goals(AgentLayout::Single(at_m)),
            (None, Some(circle), None, None, None) => self.without_goals(AgentLayout::Circle(circle)),
            (None, None, Some(grid), None, None) => self.with_goals(AgentLayout::Grid(grid)),
            (None, None, None, Some(area), None) => self.with_goals(AgentLayout::Area(area)),
            (None, None, None, None, Some(file)) => self.without_goals(AgentLayout::File(file)),
            _ => {
                let message = "agents need exactly one of `at_m`, `circle`, `grid`, `area` and `file`";
                Err((message.into(), "use several `[[agents]]` tables, one for each layout"))
            }
        }
    }

    fn with_goals<'a>(&self, layout: AgentLayout<'a>) -> Result<AgentLayout<'a>, TableFault> {
        if self.state.is_some()
            || self.goal_offset_m.is_some()
            || self.goals_m.as_ref().is_some_and(|goals_m| !goals_m.is_empty())
        {
            return Ok(layout);
        }
        let message = "agents of `at_m`, `grid` or `area` need a goal";
        Err((message.into(), "add `goals_m = [[x, y]]`, `goal_offset_m = [x, y]` or both, or `state = \"NAME\"`"))
    }

    fn without_goals<'a>(&self, layout: AgentLayout<'a>) -> Result<AgentLayout<'a>, TableFault> {
        if self.goals_m.is_none() && self.goal_offset_m.is_none() {
            return Ok(layout);
        }
        let message = "agents of a circle or a file have goals already";
        Err((message.into(), "remove `goals_m` and `goal_offset_m`"))
    }

    /// From a start to the goals of the table.
    pub(crate) fn journey(&self, start_m: Vec2) -> Journey {
        let shared_m = self.goals_m.iter().flatten().map(|&Point(goal_m)| goal_m);
        let own_m = self.goal_offset_m.map(|Point(offset_m)| start_m + offset_m);
        (start_m, shared_m.chain(own_m).collect())
    }

    /// From each position of a grid to the goals of the table.
    pub(crate) fn grid_journeys(&self, grid: &AgentGrid, random: SplitMix64) -> Result<Vec<Journey>, TableFault> {
        let starts_m = grid.positions_m(random)?;
        check_size(starts_m.len(), starts_m.len() * self.goal_count())?;
        Ok(starts_m.into_iter().map(|start_m| self.journey(start_m)).collect())
    }

    /// Number of goals of each agent of a grid or area.
    pub(crate) fn goal_count(&self) -> usize {
        self.goals_m.as_ref().map_or(0, Vec::len) + usize::from(self.goal_offset_m.is_some())
    }

    /// The numbers of a number of agents, drawn from their profiles; without profiles, those of the table.
    pub(crate) fn numbers(
        &self,
        count: usize,
        profiles_of: &Profiles<'_>,
        mut random: SplitMix64,
    ) -> Result<Vec<DrawnNumbers>, TableFault> {
        let &Self { preferred_speed_mps, radius_m, pre_movement_s, .. } = self;
        let [states_speed, states_radius] = [preferred_speed_mps, radius_m].map(|number| number.is_some());
        let profiles = profiles_of.of_table(self.profile.as_ref(), pre_movement_s, states_speed, states_radius)?;
        let (profiles, characters) = profiles_of.with_characters(profiles, self.characters.as_ref())?;
        let (profiles, style) = profiles_of.with_style(profiles, self.style.as_ref());
        let of_table = DrawnNumbers {
            preferred_speed_mps: preferred_speed_mps.unwrap_or(PREFERRED_SPEED_MPS),
            radius_m: radius_m.unwrap_or(RADIUS_M),
            pre_movement_s: 0.0,
            closed_zones: 0,
            priority: 0.0,
            stature: 1.0,
            characters,
            wears_radius: !states_radius && profiles_of.has_characters(),
            style,
        };
        Ok((0..count).map(|_| of_table.draw(&profiles, &mut random)).collect())
    }

    /// The sizes of the groups that the agents form; none where all walk alone.
    pub(crate) fn group_sizes(&self) -> Result<Option<GroupSizes>, TableFault> {
        group_sizes(self.groups.as_ref(), self.group_spacing_m)
    }

    /// Radius of the disc that walls hold of an agent with a radius, m.
    pub(crate) fn wall_radius_m(&self, radius_m: f32) -> f32 {
        match self.wall_radius_m {
            // A radius that is drawn may be smaller.
            Some(wall_radius_m) if self.profile.is_some() && self.radius_m.is_none() => wall_radius_m.min(radius_m),
            Some(wall_radius_m) => wall_radius_m,
            None => WALL_RADIUS_M.min(radius_m),
        }
    }

    /// The agent of a journey, with the table's facing, in a state of the behaviour.
    pub(crate) fn agent(
        &self,
        (position_m, goals_m): Journey,
        numbers: DrawnNumbers,
        behaviour: &Behaviour,
        state: u32,
    ) -> AgentSpec {
        let towards_goal = goals_m.first().map_or(Vec2::ZERO, |goal_m| goal_m - position_m);
        let of_state = || behaviour.start_facing_rad(state, position_m);
        let ahead = || of_state().unwrap_or_else(|| libm::atan2f(towards_goal.y, towards_goal.x));
        let facing_rad = self.facing_deg.map_or_else(ahead, f32::to_radians);
        let DrawnNumbers { preferred_speed_mps, radius_m, pre_movement_s, closed_zones, priority, .. } = numbers;
        AgentSpec {
            position_m,
            facing_rad,
            goals_m,
            radius_m,
            wall_radius_m: self.wall_radius_m(radius_m),
            preferred_speed_mps,
            at_goal: self.at_goal,
            state,
            pre_movement_s,
            closed_zones,
            priority,
            stature: numbers.stature,
            characters: numbers.characters,
            wears_radius: numbers.wears_radius,
            style: numbers.style,
            group: None,
        }
    }
}

impl AgentCircle {
    /// The journeys, counter-clockwise from +x.
    pub(crate) fn journeys(&self) -> Result<Vec<Journey>, TableFault> {
        check_count(Some(self.count))?;
        let centre_m = DVec2::from(self.centre_m.0);
        let journey = |index: usize| {
            let (sin, cos) = libm::sincos(TAU * index as f64 / self.count as f64);
            let arm_m = DVec2::new(cos, sin) * self.radius_m;
            ((centre_m + arm_m).as_vec2(), vec![(centre_m - arm_m).as_vec2()])
        };
        Ok((0..self.count).map(journey).collect())
    }
}

impl AgentGrid {
    /// The positions row by row from the lower left, m; the jitter is uniform in a square of ± `jitter_m`.
    fn positions_m(&self, mut random: SplitMix64) -> Result<Vec<Vec2>, TableFault> {
        let count = check_count(self.columns.checked_mul(self.rows))?;
        let corner_m = DVec2::from(self.centre_m.0)
            - 0.5 * self.spacing_m * DVec2::new(self.columns as f64 - 1.0, self.rows as f64 - 1.0);
        let mut position_m = |index: usize| {
            let cell = DVec2::new((index % self.columns) as f64, (index / self.columns) as f64);
            let jitter_m = DVec2::new(random.within(self.jitter_m), random.within(self.jitter_m));
            (corner_m + self.spacing_m * cell + jitter_m).as_vec2()
        };
        Ok((0..count).map(&mut position_m).collect())
    }
}

/// The number of agents of a table, checked before anything is allocated for them.
fn check_count(count: Option<usize>) -> Result<usize, TableFault> {
    match count {
        Some(count) if (1..=AGENTS_MAX).contains(&count) => Ok(count),
        _ => {
            let message = format!("the number of agents is not between 1 and {AGENTS_MAX}");
            Err((message, "set `count`, or `columns` and `rows`, in this range"))
        }
    }
}

/// Checks the size of a crowd: a few lines of text may describe more agents than fit into any memory.
pub(crate) fn check_size(agents: usize, waypoints: usize) -> Result<(), TableFault> {
    if agents > AGENTS_MAX {
        let message = format!("with this table the scenario has {agents} agents, more than {AGENTS_MAX}");
        return Err((message, "reduce the number of agents"));
    }
    if waypoints > WAYPOINTS_MAX {
        let message = format!("with this table the scenario has {waypoints} waypoints, more than {WAYPOINTS_MAX}");
        return Err((message, "reduce the number of agents or of goals"));
    }
    Ok(())
}

impl<'de> Deserialize<'de> for AgentGroups {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrMany)
    }
}

/// Reads one table or a list of tables. Serde's untagged enums would lose the position of a mistake.
struct OneOrMany;

impl<'de> Visitor<'de> for OneOrMany {
    type Value = AgentGroups;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a table of agents or a list of such tables")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<AgentGroups, A::Error> {
        Ok(AgentGroups(vec![(None, AgentGroup::deserialize(MapAccessDeserializer::new(map))?)]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<AgentGroups, A::Error> {
        let mut groups = Vec::new();
        while let Some(group) = list.next_element::<Spanned<AgentGroup>>()? {
            groups.push((Some(group.span()), group.into_inner()));
        }
        Ok(AgentGroups(groups))
    }
}
