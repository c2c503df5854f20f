//! A scenario in TOML: read, resolved to explicit agents, checked; every mistake is shown where it stands.
//!
//! ```toml
//! clips = "../clips"                  # or database = "x.fbdb"; a folder, file or manifest, relative to this file;
//!                                     # neither where whoever reads it brings a database
//! duration_s = 30.0
//! agents = { circle = { count = 17, radius_m = 4.0 } }    # or [[agents]] tables: see `agents.rs` beside
//!
//! # All that follows may be left out.
//! name = "antipodal"                  # the file's stem
//! dt_s = 0.0333333                    # 1/30
//! seed = 1                            # of everything random
//! planner = "mcn"                     # or "orca", "social_force": see `planner.rs`
//! coupling = "two_way"                # or "decoupled", "discs": see `cns.rs`
//! [[obstacles]]
//! polygon_m = [[0, 0], [1, 0], [1, 1]]
//! [params.planner]                    # MCN's; see `params.rs` for all sections
//! [params.synthesis]
//! [view]
//! ```

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::Vec2;
use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::maths::polygon::signed_area_m2;
use crate::maths::random::SplitMix64;
use crate::params::Params;
use crate::planning::planner::Planner;
use crate::scenario::agents::{Complaint, Group, Groups, Journey, Kind, check_size, line_span, parse_lines};
use crate::scenario::check::{Fault, Place, check};
use crate::scenario::coupling::Coupling;
use crate::scenario::error::ScenarioError;
use crate::scenario::point::Point;
use crate::scenario::{AgentSpec, Scenario, View};

const STEP_S: f32 = 1.0 / 30.0;
const SEED: u64 = 1;
/// What to do about a scenario without motion.
const NO_MOTION: &str = "add `clips = \"FOLDER\"` or `database = \"FILE.fbdb\"`, relative to this file, or bring a database with `fbcrowd simulate --db`";

/// Where a scenario's motion comes from; apart from the [`Scenario`], so that no path gets into a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MotionSource {
    /// A folder of clips, one clip or a manifest, to be compiled.
    Clips(PathBuf),
    /// A compiled database.
    Database(PathBuf),
}

/// The file as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ScenarioFile {
    name: Option<Spanned<String>>,
    clips: Option<Spanned<PathBuf>>,
    database: Option<Spanned<PathBuf>>,
    duration_s: Spanned<f32>,
    dt_s: Option<Spanned<f32>>,
    seed: Option<u64>,
    #[serde(default)]
    planner: Planner,
    #[serde(default)]
    coupling: Coupling,
    agents: Spanned<Groups>,
    #[serde(default)]
    obstacles: Vec<Spanned<Obstacle>>,
    #[serde(default)]
    params: Params,
    view: Option<Spanned<View>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Obstacle {
    polygon_m: Vec<Point>,
}

/// Agents, and the tables that asked for them.
#[derive(Default)]
struct Placed {
    agents: Vec<AgentSpec>,
    tables: Vec<Table>,
    waypoints: usize,
}

/// One table of agents: where it stands, the file of lines that it names, and the first of its agents.
struct Table {
    span: Range<usize>,
    lines: Option<SourceText>,
    first: usize,
}

/// Reads a scenario file and whatever agent files it names. Its motion is an error of its own, so that whoever brings a
/// database need not have the one that the file names.
///
/// # Errors
/// Where a file cannot be read or says something that cannot be simulated.
pub fn read(path: &Path) -> Result<(Scenario, Result<MotionSource, ScenarioError>), ScenarioError> {
    of_text(&read_text(path)?)
}

/// As [`read`], of a text that lies at hand; files that it names are sought beside its path.
///
/// # Errors
/// Where it says something that cannot be simulated, or a file cannot be read.
pub fn of_text(source: &SourceText) -> Result<(Scenario, Result<MotionSource, ScenarioError>), ScenarioError> {
    let file = parsed(source)?;
    let motion = motion_source(source, &file)?;
    let placed = place_agents(source, &file)?;
    let scenario = Scenario {
        name: file.name.as_ref().map_or_else(|| stem(&source.path), |name| name.get_ref().clone()),
        duration_s: *file.duration_s.get_ref(),
        dt_s: file.dt_s.as_ref().map_or(STEP_S, |dt_s| *dt_s.get_ref()),
        seed: file.seed.unwrap_or(SEED),
        planner: file.planner,
        coupling: file.coupling,
        agents: placed.agents,
        obstacles_m: file.obstacles.iter().map(|obstacle| counter_clockwise(&obstacle.get_ref().polygon_m)).collect(),
        params: file.params.clone(),
        view: file.view.as_ref().map_or_else(View::default, |view| view.get_ref().clone()),
    };
    check(&scenario).map_err(|broken| fault(source, &file, &placed.tables, broken))?;
    Ok((scenario, motion))
}

/// The files of lines that a scenario file names, which no output may replace.
///
/// # Errors
/// Where it cannot be read or is no scenario file.
pub fn agent_files(path: &Path) -> Result<Vec<PathBuf>, ScenarioError> {
    let source = read_text(path)?;
    let file = parsed(&source)?;
    let named = file.agents.get_ref().0.iter().filter_map(|(_, group)| group.file.as_ref());
    Ok(named.map(|name| source.beside(Path::new(name.get_ref()))).collect())
}

fn parsed(source: &SourceText) -> Result<ScenarioFile, ScenarioError> {
    Ok(toml::from_str(&source.text).map_err(|error| source.unparsed(error.span(), error.message()))?)
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn counter_clockwise(polygon_m: &[Point]) -> Vec<Vec2> {
    let mut corners_m: Vec<Vec2> = polygon_m.iter().map(|&Point(corner_m)| corner_m).collect();
    if signed_area_m2(&corners_m) < 0.0 {
        corners_m.reverse();
    }
    corners_m
}

/// What the file names, or that it names nothing or what is not there; the file itself is wrong where it names two.
fn motion_source(
    source: &SourceText,
    file: &ScenarioFile,
) -> Result<Result<MotionSource, ScenarioError>, ScenarioError> {
    let (given, to_motion): (_, fn(PathBuf) -> MotionSource) = match (&file.clips, &file.database) {
        (Some(clips), None) => (clips, MotionSource::Clips),
        (None, Some(database)) => (database, MotionSource::Database),
        (None, None) => return Ok(Err(source.invalid(0..0, "names neither `clips` nor `database`", NO_MOTION).into())),
        (Some(_), Some(database)) => {
            let message = "names a database besides its clips";
            return Err(source.invalid(database.span(), message, "remove either `clips` or `database`").into());
        }
    };
    let path = source.beside(given.get_ref());
    let wrong = |what: &str, help| source.invalid(given.span(), format!("{} {what}", path.display()), help).into();
    Ok(match to_motion(path.clone()) {
        _ if !path.exists() => Err(wrong("is not there", "the path is relative to the scenario file")),
        MotionSource::Clips(path) if path.extension().is_some_and(|extension| extension == "fbdb") => {
            Err(wrong("is a database", "write `database` instead of `clips`"))
        }
        MotionSource::Database(path) if path.is_dir() => {
            Err(wrong("is a folder", "write `clips` instead of `database`, or name a .fbdb file"))
        }
        motion => Ok(motion),
    })
}

fn place_agents(source: &SourceText, file: &ScenarioFile) -> Result<Placed, ScenarioError> {
    let mut placed = Placed::default();
    for (stream, (span, group)) in file.agents.get_ref().0.iter().enumerate() {
        let span = span.clone().unwrap_or_else(|| file.agents.span());
        let random = SplitMix64::new(file.seed.unwrap_or(SEED), stream as u64);
        let (journeys, lines) = journeys(source, group, &span, random)?;
        let agents = group.agents(journeys);
        placed.waypoints += agents.iter().map(|agent| agent.goals_m.len()).sum::<usize>();
        // After each table, so that many of them do not fill the memory first.
        if let Err((message, help)) = check_size(placed.agents.len() + agents.len(), placed.waypoints) {
            return Err(source.invalid(span, message, help).into());
        }
        placed.tables.push(Table { span, lines, first: placed.agents.len() });
        placed.agents.extend(agents);
    }
    Ok(placed)
}

/// From where to where the agents of one table walk, and the file of lines that says so, where it names one.
fn journeys(
    source: &SourceText,
    group: &Group,
    span: &Range<usize>,
    random: SplitMix64,
) -> Result<(Vec<Journey>, Option<SourceText>), ScenarioError> {
    let complain = |(message, help): Complaint| ScenarioError::from(source.invalid(span.clone(), message, help));
    let journeys = match group.kind().map_err(complain)? {
        Kind::Single(at_m) => Ok(vec![group.journey(at_m)]),
        Kind::Circle(circle) => circle.journeys(),
        Kind::Grid(grid) => group.grid_journeys(grid, random),
        Kind::File(name) => {
            let lines = read_lines(source, name)?;
            return Ok((journeys_of_lines(&lines)?, Some(lines)));
        }
    };
    Ok((journeys.map_err(complain)?, None))
}

/// The agents of lines `x y goal_x goal_y`, with the default disc and speed, each facing its goal.
///
/// # Errors
/// Where a line is none.
pub fn agents_of_lines(lines: &SourceText) -> Result<Vec<AgentSpec>, ScenarioError> {
    Ok(Group::plain().agents(journeys_of_lines(lines)?))
}

/// A rule that agents of lines break, shown at the line that does.
pub fn fault_of_lines(lines: &SourceText, fault: Fault) -> ScenarioError {
    let span = match fault.place {
        Place::Journey(agent) => line_span(&lines.text, agent),
        _ => 0..0,
    };
    lines.invalid(span, fault.message, fault.help).into()
}

fn read_lines(source: &SourceText, name: &Spanned<String>) -> Result<SourceText, ScenarioError> {
    let path = source.beside(Path::new(name.get_ref()));
    SourceText::read(&path).map_err(|error| {
        let message = match error.kind() {
            ErrorKind::NotFound => format!("there is no file {}", path.display()),
            _ => format!("{} cannot be read: {error}", path.display()),
        };
        source.invalid(name.span(), message, "the path is relative to the scenario file").into()
    })
}

fn journeys_of_lines(lines: &SourceText) -> Result<Vec<Journey>, ScenarioError> {
    parse_lines(&lines.text)
        .map_err(|(span, message)| lines.invalid(span, message, "each line is `x y goal_x goal_y`, in metres").into())
}

/// The text of a file.
fn read_text(path: &Path) -> Result<SourceText, ScenarioError> {
    SourceText::read(path).map_err(|source| ScenarioError::Unreadable { path: path.to_owned(), source })
}

/// Points at what breaks a rule.
fn fault(source: &SourceText, file: &ScenarioFile, tables: &[Table], fault: Fault) -> ScenarioError {
    // A table may have no agents; the last that begins no later than an agent has it.
    let table = |agent: usize| &tables[tables.partition_point(|table| table.first <= agent) - 1];
    if let Place::Journey(agent) = fault.place
        && let Table { lines: Some(lines), first, .. } = table(agent)
    {
        return fault_of_lines(lines, Fault { place: Place::Journey(agent - first), ..fault });
    }
    let span = match fault.place {
        Place::Name => file.name.as_ref().map_or(0..0, Spanned::span),
        Place::Duration => file.duration_s.span(),
        Place::Step => file.dt_s.as_ref().map_or(0..0, Spanned::span),
        Place::View => file.view.as_ref().map_or(0..0, Spanned::span),
        Place::Parameter(section, key) => parameter_span(source, &section, &key),
        Place::Journey(agent) | Place::Agent(agent) => table(agent).span.clone(),
        Place::Obstacle(index) => file.obstacles[index].span(),
        Place::Agents => file.agents.span(),
    };
    source.invalid(span, fault.message, fault.help).into()
}

/// Reads the text once more, since [`Params`] keeps no places.
fn parameter_span(source: &SourceText, section: &str, key: &str) -> Range<usize> {
    #[derive(Deserialize)]
    struct Places {
        params: BTreeMap<String, BTreeMap<String, Spanned<toml::Value>>>,
    }
    let places = toml::from_str::<Places>(&source.text).ok();
    places.and_then(|places| Some(places.params.get(section)?.get(key)?.span())).unwrap_or(0..0)
}
