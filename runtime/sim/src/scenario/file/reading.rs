//! From the text of a scenario file to a checked scenario; every mistake is shown at its position in the text.
//!
//! 1. parse the keys (`scenario_file`);
//! 2. find the source of the motion;
//! 3. resolve the behaviour (`behaviour`), place the agents (`agent_placement`);
//! 4. check all rules (`check`), and show a broken one at its part of the text.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::route::reach::check_reach;
use crate::scenario::characters::character_tables::{self, CharacterFile, characters};
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::file::agent_placement::{AgentTable, PlacedAgents, PlacementInput, fault_of_lines};
use crate::scenario::file::behaviour::{BehaviourTables, Names, StateNames};
use crate::scenario::file::ground_tables::PlacedGround;
use crate::scenario::file::marking_tables::PlacedMarkings;
use crate::scenario::file::measure_tables::measures;
use crate::scenario::file::profile_tables::Profiles;
use crate::scenario::file::scenario_file::{MotionSource, ScenarioFile};
use crate::scenario::file::sources::sources;
use crate::scenario::file::zone_tables::zones;
use crate::scenario::resolved::{SEED, Scenario};
use crate::scenario::rules::check::{check, check_plan};
use crate::scenario::rules::ground_check::{check_ground, check_ground_ranges};
use crate::scenario::rules::measure_check::check_zones;
use crate::variation::Variation;

/// Reads a scenario file and the agent files that it names. The source of its motion is a result of its own: a caller
/// that brings a database does not need the one that the file names.
///
/// # Errors
/// Where a file cannot be read or describes something that cannot be simulated.
pub fn read(path: &Path) -> Result<(Scenario, Result<MotionSource, ScenarioError>), ScenarioError> {
    parse(&read_text(path)?)
}

/// As [`read`], from a text in memory; files that it names are relative to its path.
///
/// # Errors
/// Where it describes something that cannot be simulated, or a file that it names cannot be read.
pub fn parse(source: &SourceText) -> Result<(Scenario, Result<MotionSource, ScenarioError>), ScenarioError> {
    let file = ScenarioFile::parse(source)?;
    file.check_has_agents(source)?;
    resolve(file, source, check)
}

/// As [`read`]; the file may state a ground alone, without agents and sources.
///
/// # Errors
/// Where a file cannot be read or describes something that cannot be simulated.
pub fn read_plan(path: &Path) -> Result<(Scenario, Result<MotionSource, ScenarioError>), ScenarioError> {
    let source = read_text(path)?;
    resolve(ScenarioFile::parse(&source)?, &source, check_plan)
}

/// The scenario that a file describes, which `check` accepts.
fn resolve(
    mut file: ScenarioFile,
    source: &SourceText,
    check: fn(&Scenario) -> Result<(), ScenarioFault>,
) -> Result<(Scenario, Result<MotionSource, ScenarioError>), ScenarioError> {
    let tables = file.take_behaviour();
    let behaviour = tables.resolve(source)?;
    let states = StateNames { tables: &tables, behaviour: &behaviour };
    let motion = file.motion_source(source)?;
    let seed = file.seed.unwrap_or(SEED);
    let characters = characters(&file.characters)
        .map_err(|fault| at_key(source, character_span(&file, &fault.part), fault.message, fault.help))?;
    let styles = file.styles();
    let mut profiles = Profiles::new(&file.profiles, &characters, &styles, source)?;
    let zones = zones(source, &file.zones, &mut profiles, &states)?;
    let signals = Names::new("signal", &tables.signals);
    let mut ground = PlacedGround::new(source, &file.obstacles, &file.walkable, &behaviour, &signals)?;
    ground.scenario.zones = zones;
    let markings = PlacedMarkings::new(source, &file.markings, &behaviour, &mut ground.labels)?;
    let texts = ScenarioTexts { source, file: &file, behaviour: &tables, ground: &ground, markings: &markings };
    check_ground_ranges(&ground.scenario)
        .and_then(|()| check_zones(&ground.scenario))
        .and_then(|()| check_ground(&ground.scenario))
        .map_err(|fault| texts.point_at(&PlacedAgents::default(), fault))?;
    let input = PlacementInput { source, states: &states, profiles: &profiles, ground: &ground.scenario, seed };
    let mut placed = match file.agents() {
        Some(groups) => PlacedAgents::new(&input, groups)?,
        None => PlacedAgents::default(),
    };
    let defaults = Scenario { agents: std::mem::take(&mut placed.agents), ..ground.scenario.clone() };
    let scenario = Scenario {
        name: file.name.as_ref().map_or_else(|| stem(&source.path), |name| name.get_ref().clone()),
        duration_s: *file.duration_s.get_ref(),
        dt_s: file.dt_s.as_ref().map_or(defaults.dt_s, |dt_s| *dt_s.get_ref()),
        seed,
        planner: file.planner,
        coupling: file.coupling,
        sources: sources(&input, &file.sources, *file.duration_s.get_ref())?,
        measures: measures(source, &file.measure)?,
        markings: markings.markings.clone(),
        labels: ground.labels.labels.clone(),
        characters: characters.clone(),
        styles: styles.clone(),
        cameras: file.cameras().map(|camera| camera.get_ref().clone()).collect(),
        shot: file.shot.as_ref().map(|shot| shot.get_ref().clone()),
        variation: file.variation.as_ref().map_or(Some(Variation::default()), |value| value.get_ref().0),
        params: file.params.clone(),
        view: file.view.as_ref().map_or_else(|| defaults.view.clone(), |view| view.get_ref().clone()),
        ..defaults
    };
    check(&scenario).and_then(|()| check_reach(&scenario)).map_err(|fault| texts.point_at(&placed, fault))?;
    Ok((scenario, motion))
}

/// The agent files, WKT files and schedule files that a scenario file names, which no output may replace.
///
/// # Errors
/// Where it cannot be read or is no scenario file.
pub fn agent_files(path: &Path) -> Result<Vec<PathBuf>, ScenarioError> {
    let source = read_text(path)?;
    let file = ScenarioFile::parse(&source)?;
    let groups = file.agents().into_iter().flat_map(|groups| &groups.get_ref().0);
    let named = groups.filter_map(|(_, group)| group.file.as_ref());
    let grounds = file.walkable.iter().filter_map(|table| table.get_ref().file(&source));
    let schedules = file.sources.iter().filter_map(|table| table.get_ref().file(&source));
    Ok(named.map(|name| source.beside(Path::new(name.get_ref()))).chain(grounds).chain(schedules).collect())
}

/// Checks that every style that a scenario file names is one of the motion's.
///
/// # Errors
/// Where the file cannot be read, is no scenario file, or names another style: shown at its line, with the list.
pub fn check_styles(path: &Path, existing: &[String]) -> Result<(), ScenarioError> {
    let source = read_text(path)?;
    ScenarioFile::parse(&source)?.check_styles(&source, existing)
}

/// Whether a scenario file names a motion: clips or a database, which need not exist.
///
/// # Errors
/// Where it cannot be read or is no scenario file.
pub fn names_motion(path: &Path) -> Result<bool, ScenarioError> {
    Ok(ScenarioFile::parse(&read_text(path)?)?.names_motion())
}

/// The files of the characters that a scenario file names, in the order of its characters.
///
/// # Errors
/// Where it cannot be read, is no scenario file, or names a character that does not exist.
pub fn character_files(path: &Path) -> Result<Vec<CharacterFile>, ScenarioError> {
    let source = read_text(path)?;
    let file = ScenarioFile::parse(&source)?;
    character_tables::files(&source, &file.characters)
}

pub(super) fn read_text(path: &Path) -> Result<SourceText, ScenarioError> {
    SourceText::read(path).map_err(|source| ScenarioError::Unreadable { path: path.to_owned(), source })
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The texts of a scenario's parts.
struct ScenarioTexts<'a> {
    source: &'a SourceText,
    file: &'a ScenarioFile,
    behaviour: &'a BehaviourTables,
    ground: &'a PlacedGround,
    markings: &'a PlacedMarkings,
}

impl ScenarioTexts<'_> {
    /// A broken rule, shown at the text of the part that breaks it.
    fn point_at(&self, placed: &PlacedAgents, fault: ScenarioFault) -> ScenarioError {
        if let ScenarioPart::Journey(agent) = fault.part
            && let AgentTable { lines: Some(lines), first, .. } = placed.table(agent)
        {
            return fault_of_lines(lines, ScenarioFault { part: ScenarioPart::Journey(agent - first), ..fault });
        }
        at_key(self.source, self.span(placed, &fault.part), fault.message, fault.help)
    }

    fn span(&self, placed: &PlacedAgents, part: &ScenarioPart) -> Range<usize> {
        let Self { source, file, behaviour, ground, markings } = *self;
        /// The bytes of the table that an item comes from.
        fn of<T>(tables: &[Spanned<T>], table_of: &[usize], item: usize) -> Range<usize> {
            table_of.get(item).map_or(0..0, |&table| tables[table].span())
        }
        match *part {
            ScenarioPart::Name => file.name.as_ref().map_or(0..0, Spanned::span),
            ScenarioPart::Duration => file.duration_s.span(),
            ScenarioPart::Step => file.dt_s.as_ref().map_or(0..0, Spanned::span),
            ScenarioPart::View => file.view.as_ref().map_or(0..0, Spanned::span),
            ScenarioPart::Shot => file.shot.as_ref().map_or(0..0, Spanned::span),
            ScenarioPart::Variation => file.variation.as_ref().map_or(0..0, Spanned::span),
            ScenarioPart::Parameter(ref section, ref key) => parameter_span(source, section, key),
            ScenarioPart::Journey(agent) | ScenarioPart::Agent(agent) => placed.table(agent).span.clone(),
            ScenarioPart::Obstacle(index) => of(&file.obstacles, &ground.solids, index),
            ScenarioPart::Enclosure(index) => of(&file.obstacles, &ground.enclosures, index),
            ScenarioPart::Door(index) => of(&file.obstacles, &ground.doors, index),
            ScenarioPart::Walkable(index) => of(&file.walkable, &ground.walkable, index),
            ScenarioPart::Marking(index) => of(&file.markings, &markings.tables, index),
            ScenarioPart::Label(index) => ground.labels.spans.get(index).cloned().unwrap_or(0..0),
            ScenarioPart::Source(index) => file.sources.get(index).map_or(0..0, Spanned::span),
            ScenarioPart::State(_)
            | ScenarioPart::Goals(_)
            | ScenarioPart::Area(_)
            | ScenarioPart::Signal(_)
            | ScenarioPart::Event(_) => behaviour.span(part),
            ScenarioPart::Zone(index) => file.zones.get(index).map_or(0..0, Spanned::span),
            ScenarioPart::Camera(index) => file.cameras().nth(index).map_or(0..0, Spanned::span),
            ScenarioPart::Character(_) => character_span(file, part),
            ScenarioPart::Measure(index) => file.measure.get(index).map_or(0..0, Spanned::span),
            ScenarioPart::Agents => file.agents().map_or(0..0, Spanned::span),
        }
    }
}

/// The bytes of the table of a character.
fn character_span(file: &ScenarioFile, part: &ScenarioPart) -> Range<usize> {
    match *part {
        ScenarioPart::Character(index) => file.characters.get(index).map_or(0..0, Spanned::span),
        _ => 0..0,
    }
}

/// A mistake in a table, shown at the key that its message begins with, or else at the table.
pub(super) fn at_key(source: &SourceText, table: Range<usize>, message: String, help: &str) -> ScenarioError {
    let span = key_span(&source.text, &table, &message).unwrap_or(table);
    source.invalid(span, message, help).into()
}

/// The bytes of the key that a message begins with (`focal_mm is 0`, `y of eye_m is NaN`, `` `up` is … ``), in the table
/// that begins at some bytes; none where the table has no such key.
fn key_span(text: &str, table: &Range<usize>, message: &str) -> Option<Range<usize>> {
    let is_of_key = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
    let of_axis = message.split_once(" of ").filter(|(axis, _)| axis.len() == 1);
    let message = of_axis.map_or(message, |(_, rest)| rest).trim_start_matches('`');
    let key = message.split(|letter| !is_of_key(letter)).next().filter(|key| !key.is_empty())?;
    let mut begin = table.start;
    for line in text.get(begin..)?.split_inclusive('\n') {
        let indent = line.len() - line.trim_start().len();
        // A list of points may begin with a bracket, too.
        let is_header = line[indent..].starts_with('[')
            && line[indent..].trim_start_matches('[').starts_with(|letter: char| letter.is_alphabetic());
        if begin > table.start && is_header {
            return None;
        }
        let rest = line[indent..].strip_prefix(key);
        if rest.is_some_and(|rest| rest.trim_start().starts_with('=')) {
            return Some(begin + indent..begin + line.trim_end().len());
        }
        begin += line.len();
    }
    None
}

/// The bytes of a tunable. Parses the text once more, since [`Params`](crate::params::Params) keeps no positions.
fn parameter_span(source: &SourceText, section: &str, key: &str) -> Range<usize> {
    #[derive(Deserialize)]
    struct SpannedParams {
        params: BTreeMap<String, BTreeMap<String, Spanned<toml::Value>>>,
    }
    let spanned = toml::from_str::<SpannedParams>(&source.text).ok();
    spanned.and_then(|spanned| Some(spanned.params.get(section)?.get(key)?.span())).unwrap_or(0..0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_found_in_its_table_alone() {
        let text = "[[zones]]\npolygon_m = [\n  [2, -1],\n]\n  speed_factor = -1\n[[zones]]\nspeed_factor=0\none_way_deg = 5\n";
        let found = |start: usize, message: &str| key_span(text, &(start..start + 9), message).map(|span| &text[span]);
        let second = text.rfind("[[").unwrap_or_default();
        assert_eq!(found(0, "speed_factor is -1, not between"), Some("speed_factor = -1"));
        assert_eq!(found(second, "speed_factor is 0, not between"), Some("speed_factor=0"));
        assert_eq!(found(second, "y of speed_factor is 0"), Some("speed_factor=0"));
        assert_eq!(found(second, "`one_way_deg` belongs to a lane"), Some("one_way_deg = 5"));
        assert_eq!(found(0, "one_way_deg is 5"), None);
        assert_eq!(found(0, "speed is 5"), None);
        assert_eq!(found(0, "the zone has no area"), None);
    }
}
