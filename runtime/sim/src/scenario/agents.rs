//! The `agents` of a scenario file: one table or a list of tables, each of exactly one kind, and the agents that each
//! stands for.
//!
//! | kind | its goals |
//! |---|---|
//! | `at_m = [x, y]` | `goals_m`, waypoints in order; then, where given, the start plus `goal_offset_m` |
//! | `circle = { count, radius_m, centre_m }` | the opposite place on the circle, exactly |
//! | `grid = { columns, rows, spacing_m, centre_m, jitter_m }` | the same: `goals_m` for all alike, `goal_offset_m` from each one's own start |
//! | `file = "x.txt"` | lines `x y goal_x goal_y`, `#` begins a comment |

use std::f64::consts::TAU;
use std::fmt;
use std::ops::Range;

use glam::{DVec2, Vec2};
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

use crate::maths::random::SplitMix64;
use crate::scenario::AgentSpec;
use crate::scenario::point::Point;
use crate::scenario::ranges::{AGENTS_MAX, COORDINATE_MAX_M};

/// Disc of an agent, m: half an adult's bideltoid breadth (0.48 m), the tightest circle about the projected trunk, and
/// the radius of the protocol of Table 1's scenes (`assets/scenarios/table1`), under which RVO2 was measured too, so
/// that figures compare.
const RADIUS_M: f32 = 0.25;
/// Of the same protocol, m/s.
const PREFERRED_SPEED_MPS: f32 = 1.33;
/// Of all agents together: ten for each of the largest crowd, 80 MB.
const WAYPOINTS_MAX: usize = 10 * AGENTS_MAX;

/// What `agents` holds: each table and, in a list, where it stands.
#[derive(Debug)]
pub(crate) struct Groups(pub(crate) Vec<(Option<Range<usize>>, Group)>);

/// One table of agents.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Group {
    at_m: Option<Point>,
    circle: Option<Circle>,
    grid: Option<Grid>,
    pub(crate) file: Option<Spanned<String>>,
    goals_m: Option<Vec<Point>>,
    goal_offset_m: Option<Point>,
    facing_deg: Option<f32>,
    #[serde(default = "radius_m")]
    radius_m: f32,
    #[serde(default = "preferred_speed_mps")]
    preferred_speed_mps: f32,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Circle {
    count: usize,
    radius_m: f64,
    #[serde(default)]
    centre_m: Point,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Grid {
    columns: usize,
    rows: usize,
    spacing_m: f64,
    #[serde(default)]
    centre_m: Point,
    #[serde(default)]
    jitter_m: f64,
}

/// What a table stands for.
#[derive(Debug)]
pub(crate) enum Kind<'a> {
    /// Where one agent starts.
    Single(Vec2),
    Circle(&'a Circle),
    Grid(&'a Grid),
    /// The name of a file of lines.
    File(&'a Spanned<String>),
}

/// Where an agent starts and where it goes.
pub(crate) type Journey = (Vec2, Vec<Vec2>);

/// A message and what to do.
pub(crate) type Complaint = (String, &'static str);

fn radius_m() -> f32 {
    RADIUS_M
}

fn preferred_speed_mps() -> f32 {
    PREFERRED_SPEED_MPS
}

impl Group {
    /// What the table stands for, if it is of exactly one kind and says where its agents go.
    pub(crate) fn kind(&self) -> Result<Kind<'_>, Complaint> {
        match (self.at_m, &self.circle, &self.grid, &self.file) {
            (Some(Point(at_m)), None, None, None) => self.with_goals(Kind::Single(at_m)),
            (None, Some(circle), None, None) => self.without_goals(Kind::Circle(circle)),
            (None, None, Some(grid), None) => self.with_goals(Kind::Grid(grid)),
            (None, None, None, Some(file)) => self.without_goals(Kind::File(file)),
            _ => {
                let message = "agents need exactly one of `at_m`, `circle`, `grid` and `file`";
                Err((message.into(), "split what is different into several `[[agents]]`"))
            }
        }
    }

    fn with_goals<'a>(&self, kind: Kind<'a>) -> Result<Kind<'a>, Complaint> {
        if self.goal_offset_m.is_some() || self.goals_m.as_ref().is_some_and(|goals_m| !goals_m.is_empty()) {
            return Ok(kind);
        }
        let message = "agents of `at_m` or `grid` need to be told where to go";
        Err((message.into(), "add `goals_m = [[x, y]]`, `goal_offset_m = [x, y]` or both"))
    }

    fn without_goals<'a>(&self, kind: Kind<'a>) -> Result<Kind<'a>, Complaint> {
        if self.goals_m.is_none() && self.goal_offset_m.is_none() {
            return Ok(kind);
        }
        let message = "agents of a circle or a file bring their own goals";
        Err((message.into(), "remove `goals_m` and `goal_offset_m`"))
    }

    /// From a start to the goals that the table names.
    pub(crate) fn journey(&self, start_m: Vec2) -> Journey {
        let shared_m = self.goals_m.iter().flatten().map(|&Point(goal_m)| goal_m);
        let own_m = self.goal_offset_m.map(|Point(offset_m)| start_m + offset_m);
        (start_m, shared_m.chain(own_m).collect())
    }

    /// From each place of a grid to the goals that the table names.
    pub(crate) fn grid_journeys(&self, grid: &Grid, random: SplitMix64) -> Result<Vec<Journey>, Complaint> {
        let places_m = grid.places_m(random)?;
        let goals = self.goals_m.as_ref().map_or(0, Vec::len) + usize::from(self.goal_offset_m.is_some());
        check_size(places_m.len(), places_m.len() * goals)?;
        Ok(places_m.into_iter().map(|place_m| self.journey(place_m)).collect())
    }

    /// A table that says nothing of its agents.
    pub(crate) fn plain() -> Self {
        Self {
            at_m: None,
            circle: None,
            grid: None,
            file: None,
            goals_m: None,
            goal_offset_m: None,
            facing_deg: None,
            radius_m: radius_m(),
            preferred_speed_mps: preferred_speed_mps(),
        }
    }

    /// With all that the table says of its agents besides their journeys.
    pub(crate) fn agents(&self, journeys: Vec<Journey>) -> Vec<AgentSpec> {
        journeys.into_iter().map(|(position_m, goals_m)| self.agent(position_m, goals_m)).collect()
    }

    fn agent(&self, position_m: Vec2, goals_m: Vec<Vec2>) -> AgentSpec {
        let towards_goal = goals_m.first().map_or(Vec2::ZERO, |goal_m| goal_m - position_m);
        let facing_rad = self.facing_deg.map_or_else(|| libm::atan2f(towards_goal.y, towards_goal.x), f32::to_radians);
        let &Self { radius_m, preferred_speed_mps, .. } = self;
        AgentSpec { position_m, facing_rad, goals_m, radius_m, preferred_speed_mps }
    }
}

impl Circle {
    /// Counter-clockwise from +x.
    pub(crate) fn journeys(&self) -> Result<Vec<Journey>, Complaint> {
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

impl Grid {
    /// Row by row, from the lower left; the jitter is uniform in a square of ± `jitter_m`.
    fn places_m(&self, mut random: SplitMix64) -> Result<Vec<Vec2>, Complaint> {
        let count = check_count(self.columns.checked_mul(self.rows))?;
        let corner_m = DVec2::from(self.centre_m.0)
            - 0.5 * self.spacing_m * DVec2::new(self.columns as f64 - 1.0, self.rows as f64 - 1.0);
        let mut place_m = |index: usize| {
            let cell = DVec2::new((index % self.columns) as f64, (index / self.columns) as f64);
            let jitter_m = DVec2::new(random.within(self.jitter_m), random.within(self.jitter_m));
            (corner_m + self.spacing_m * cell + jitter_m).as_vec2()
        };
        Ok((0..count).map(&mut place_m).collect())
    }
}

/// Before anything is allocated for them.
fn check_count(count: Option<usize>) -> Result<usize, Complaint> {
    match count {
        Some(count) if (1..=AGENTS_MAX).contains(&count) => Ok(count),
        _ => Err((format!("these are no 1 to {AGENTS_MAX} agents"), "give another count")),
    }
}

/// A few lines of text may ask for more than any memory holds.
pub(crate) fn check_size(agents: usize, waypoints: usize) -> Result<(), Complaint> {
    if agents > AGENTS_MAX {
        return Err((format!("with these there are {agents} agents, more than {AGENTS_MAX}"), "ask for fewer"));
    }
    if waypoints > WAYPOINTS_MAX {
        let message = format!("with these there are {waypoints} waypoints, more than {WAYPOINTS_MAX}");
        return Err((message, "ask for fewer agents or fewer goals"));
    }
    Ok(())
}

/// Lines `x y goal_x goal_y` in metres.
///
/// # Errors
/// The bytes of the first line that is none, and what is wrong with it.
pub(crate) fn parse_lines(text: &str) -> Result<Vec<Journey>, (Range<usize>, String)> {
    lines(text).map(|(span, content)| parse_line(content).map_err(|message| (span, message))).collect()
}

/// The bytes of the line that an agent of such a file stands on.
pub(crate) fn line_span(text: &str, agent: usize) -> Range<usize> {
    lines(text).nth(agent).map_or(0..0, |(span, _)| span)
}

/// Each line that holds more than a comment: its bytes and what it says.
fn lines(text: &str) -> impl Iterator<Item = (Range<usize>, &str)> {
    let mut end = 0;
    let lines = text.split_inclusive('\n').map(move |line| {
        let begin = end;
        end += line.len();
        (begin..begin + line.trim_end().len(), line.split('#').next().unwrap_or_default().trim())
    });
    lines.filter(|(_, content)| !content.is_empty())
}

fn parse_line(content: &str) -> Result<Journey, String> {
    let number = |word: &str| match word.parse::<f32>() {
        Ok(metres) if metres.abs() <= COORDINATE_MAX_M => Ok(metres),
        Ok(_) => Err(format!("`{word}` is no place within 10 km of the origin")),
        Err(_) => Err(format!("`{word}` is no number")),
    };
    let numbers = content.split_whitespace().map(number).collect::<Result<Vec<f32>, String>>()?;
    match numbers[..] {
        [x, y, goal_x, goal_y] => Ok((Vec2::new(x, y), vec![Vec2::new(goal_x, goal_y)])),
        _ => Err(format!("{} numbers, not the four of `x y goal_x goal_y`", numbers.len())),
    }
}

impl<'de> Deserialize<'de> for Groups {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrMany)
    }
}

/// Written by hand because serde's untagged enums forget where a mistake stands.
struct OneOrMany;

impl<'de> Visitor<'de> for OneOrMany {
    type Value = Groups;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a table of agents or a list of such tables")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Groups, A::Error> {
        Ok(Groups(vec![(None, Group::deserialize(MapAccessDeserializer::new(map))?)]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Groups, A::Error> {
        let mut groups = Vec::new();
        while let Some(group) = list.next_element::<Spanned<Group>>()? {
            groups.push((Some(group.span()), group.into_inner()));
        }
        Ok(Groups(groups))
    }
}
