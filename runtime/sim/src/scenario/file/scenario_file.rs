//! The keys of a scenario file in TOML, as written, and the source of its motion.
//!
//! ```toml
//! clips = "../clips"                  # or database = "x.fbdb"; a folder, file or manifest, relative to this file;
//!                                     # neither where the reader brings a database
//! duration_s = 30.0
//! agents = { circle = { count = 17, radius_m = 4.0 } }    # or [[agents]] tables: see `agent_groups.rs`; may be left
//!                                     # out where there are sources
//!
//! # All keys below are optional.
//! name = "antipodal"                  # default: the file's stem
//! dt_s = 0.0333333                    # default: 1/30
//! seed = 1                            # of everything random
//! planner = "mcn"                     # or "orca", "social_force": see `planner.rs`
//! coupling = "two_way"                # or "decoupled", "discs": see `coupling.rs`
//! [[sources]]                         # agents that come later: see `sources/mod.rs`
//! [[walkable]]                        # the ground that agents can walk on; else it is open: see `ground_tables.rs`
//! [goals.NAME]                        # what agents want: see `behaviour/mod.rs`
//! [states.NAME]
//! [signals.NAME]
//! [profiles.NAME]                     # numbers that are drawn: see `profile_tables.rs`
//! [areas.NAME]
//! [[zones]]                           # ground on which agents are slower: see `zone_tables.rs`
//! [[measure]]                         # lines and areas: see `measure_tables.rs`
//! [[markings]]                        # what is painted on the ground: see `marking_tables.rs`
//! [[characters]]                      # figures that bodies are drawn as: see `character_tables.rs`
//! [[obstacles]]
//! polygon_m = [[0, 0], [1, 0], [1, 1]]
//! [variation]                         # how much bodies differ; or `variation = false`: see `variation_value.rs`
//! [params.planner]                    # MCN's tunables; all sections: see `params.rs`
//! [params.synthesis]
//! [view]
//! [shot]                              # frames in time: see `shot_spec.rs`
//! [camera]                            # or several [[cameras]]: see `camera_spec.rs`
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::params::Params;
use crate::planning::planner::Planner;
use crate::scenario::characters::character_tables::CharacterTable;
use crate::scenario::coupling::Coupling;
use crate::scenario::error::ScenarioError;
use crate::scenario::file::agent_groups::AgentGroups;
use crate::scenario::file::behaviour::{AreaTable, BehaviourTables, EventTable, GoalsTable, SignalTable, StateTable};
use crate::scenario::file::ground_tables::{ObstacleTable, WalkableTable};
use crate::scenario::file::marking_tables::MarkingTable;
use crate::scenario::file::measure_tables::MeasureTable;
use crate::scenario::file::profile_tables::ProfileTable;
use crate::scenario::file::sources::SourceTable;
use crate::scenario::file::variation_value::VariationValue;
use crate::scenario::file::zone_tables::ZoneTable;
use crate::scenario::places::camera_spec::CameraSpec;
use crate::scenario::places::shot_spec::ShotSpec;
use crate::scenario::rules::camera_check::CAMERAS_MAX;
use crate::scenario::view::View;

/// How to mend a scenario without agents.
const NO_AGENTS: &str = "add `[[agents]]`, or `[[sources]]` for agents that come later";
/// Keys by one of which a scenario file is recognised.
pub(super) const KEYS: [&str; 7] = ["duration_s", "agents", "clips", "dt_s", "obstacles", "planner", "sources"];
/// How to mend a scenario without motion.
const NO_MOTION: &str = "add `clips = \"FOLDER\"` or `database = \"FILE.fbdb\"`, relative to this file, or give a database with `fbcrowd simulate --db`";

/// The source of a scenario's motion; apart from the [`Scenario`](crate::scenario::Scenario), so that no path gets into
/// a recording.
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
pub(crate) struct ScenarioFile {
    pub(crate) name: Option<Spanned<String>>,
    clips: Option<Spanned<PathBuf>>,
    database: Option<Spanned<PathBuf>>,
    pub(crate) duration_s: Spanned<f32>,
    pub(crate) dt_s: Option<Spanned<f32>>,
    pub(crate) seed: Option<u64>,
    #[serde(default)]
    pub(crate) planner: Planner,
    #[serde(default)]
    pub(crate) coupling: Coupling,
    agents: Option<Spanned<AgentGroups>>,
    #[serde(default)]
    pub(crate) sources: Vec<Spanned<SourceTable>>,
    #[serde(default)]
    signals: BTreeMap<String, Spanned<SignalTable>>,
    #[serde(default)]
    events: BTreeMap<String, Spanned<EventTable>>,
    #[serde(default)]
    areas: BTreeMap<String, Spanned<AreaTable>>,
    #[serde(default)]
    goals: BTreeMap<String, Spanned<GoalsTable>>,
    #[serde(default)]
    states: BTreeMap<String, Spanned<StateTable>>,
    #[serde(default)]
    pub(crate) zones: Vec<Spanned<ZoneTable>>,
    #[serde(default)]
    pub(crate) measure: Vec<Spanned<MeasureTable>>,
    #[serde(default)]
    pub(crate) profiles: BTreeMap<String, Spanned<ProfileTable>>,
    #[serde(default)]
    pub(crate) obstacles: Vec<Spanned<ObstacleTable>>,
    #[serde(default)]
    pub(crate) walkable: Vec<Spanned<WalkableTable>>,
    #[serde(default)]
    pub(crate) markings: Vec<Spanned<MarkingTable>>,
    #[serde(default)]
    pub(crate) characters: Vec<Spanned<CharacterTable>>,
    pub(crate) variation: Option<Spanned<VariationValue>>,
    #[serde(default)]
    pub(crate) params: Params,
    pub(crate) view: Option<Spanned<View>>,
    pub(crate) shot: Option<Spanned<ShotSpec>>,
    camera: Option<Spanned<CameraSpec>>,
    #[serde(default)]
    cameras: Vec<Spanned<CameraSpec>>,
}

/// Rejects a text with too many tables of cameras before it is parsed, which takes 700 MB for 180,000.
pub(super) fn check_camera_count(source: &SourceText) -> Result<(), ScenarioError> {
    match source.entry_after("cameras", CAMERAS_MAX) {
        Some(bytes) => {
            let message = format!("the file has more than {CAMERAS_MAX} cameras");
            Err(source.invalid(bytes, message, "give fewer").into())
        }
        None => Ok(()),
    }
}

impl ScenarioFile {
    pub(crate) fn parse(source: &SourceText) -> Result<Self, ScenarioError> {
        if source.text.trim().is_empty() {
            return Err(source
                .invalid(0..0, "the file is empty", "write a scenario as docs/scenario.md shows it")
                .into());
        }
        check_camera_count(source)?;
        toml::from_str(&source.text).map_err(|error| source.unparsed(error.span(), error.message(), &KEYS).into())
    }

    /// Checks that the file states agents or sources.
    pub(crate) fn check_has_agents(&self, source: &SourceText) -> Result<(), ScenarioError> {
        if self.agents.is_some() || !self.sources.is_empty() {
            return Ok(());
        }
        let mut missing = source.unparsed(None, "missing field `agents`", &KEYS);
        if missing.is_quotable {
            NO_AGENTS.clone_into(&mut missing.help);
        }
        Err(missing.into())
    }

    /// The tables of agents, and their bytes in the text; none where all agents come from sources.
    pub(crate) fn agents(&self) -> Option<&Spanned<AgentGroups>> {
        self.agents.as_ref()
    }

    /// The styles that tables of agents, sources and profiles state, each as often as it is stated. An empty name
    /// stands for no style.
    fn stated_styles(&self) -> impl Iterator<Item = &Spanned<String>> {
        let groups = self.agents().into_iter().flat_map(|groups| &groups.get_ref().0);
        let of_agents = groups.filter_map(|(_, group)| group.style.as_ref());
        let of_sources = self.sources.iter().filter_map(|table| table.get_ref().style.as_ref());
        let of_profiles = self.profiles.values().filter_map(|table| table.get_ref().style.as_ref());
        of_agents.chain(of_sources).chain(of_profiles).filter(|style| !style.get_ref().is_empty())
    }

    /// The names of these styles, sorted.
    pub(crate) fn styles(&self) -> Vec<String> {
        let names: BTreeSet<&str> = self.stated_styles().map(|style| style.get_ref().as_str()).collect();
        names.into_iter().map(str::to_owned).collect()
    }

    /// Checks that each of these styles is among those of the motion.
    pub(crate) fn check_styles(&self, source: &SourceText, existing: &[String]) -> Result<(), ScenarioError> {
        let missing = self.stated_styles().find(|style| !existing.contains(style.get_ref()));
        let Some(missing) = missing else { return Ok(()) };
        let names: Vec<&str> = existing.iter().map(String::as_str).filter(|name| !name.is_empty()).collect();
        let (what, help) = match names[..] {
            [] => ("has none".to_owned(), "remove `style`, or compile clips of this style (docs/manifest.md)"),
            _ => (format!("has {}", names.join(", ")), "name one of these"),
        };
        let message = format!("there is no style `{}`; the motion {what}", missing.get_ref());
        Err(source.invalid(missing.span(), message, help).into())
    }

    /// The tables of cameras, `[camera]` first.
    pub(crate) fn cameras(&self) -> impl Iterator<Item = &Spanned<CameraSpec>> {
        self.camera.iter().chain(&self.cameras)
    }

    /// Takes the tables of behaviour out of the file.
    pub(crate) fn take_behaviour(&mut self) -> BehaviourTables {
        let Self { signals, areas, goals, states, events, .. } = self;
        BehaviourTables {
            signals: std::mem::take(signals),
            events: std::mem::take(events),
            areas: std::mem::take(areas),
            goals: std::mem::take(goals),
            states: std::mem::take(states),
        }
    }

    /// Whether the file names a motion, which need not exist.
    pub(crate) fn names_motion(&self) -> bool {
        self.clips.is_some() || self.database.is_some()
    }

    /// The motion that the file names. The inner error: it names none, or one that is missing. The outer error: the
    /// file itself is wrong, because it names two.
    pub(crate) fn motion_source(
        &self,
        source: &SourceText,
    ) -> Result<Result<MotionSource, ScenarioError>, ScenarioError> {
        let (named, to_motion): (_, fn(PathBuf) -> MotionSource) = match (&self.clips, &self.database) {
            (Some(clips), None) => (clips, MotionSource::Clips),
            (None, Some(database)) => (database, MotionSource::Database),
            (None, None) => {
                return Ok(Err(source
                    .invalid(0..0, "the file names neither `clips` nor `database`", NO_MOTION)
                    .into()));
            }
            (Some(_), Some(database)) => {
                let message = "the file names both `clips` and `database`";
                return Err(source.invalid(database.span(), message, "remove one of them").into());
            }
        };
        let path = source.beside(named.get_ref());
        let wrong = |what: &str, help| source.invalid(named.span(), format!("{} {what}", path.display()), help).into();
        Ok(match to_motion(path.clone()) {
            _ if !path.exists() => Err(wrong("does not exist", "give a path relative to the scenario file")),
            MotionSource::Clips(path) if path.extension().is_some_and(|extension| extension == "fbdb") => {
                Err(wrong("is a database", "write `database` instead of `clips`"))
            }
            MotionSource::Database(path) if path.is_dir() => {
                Err(wrong("is a folder", "write `clips` instead of `database`, or name a .fbdb file"))
            }
            motion => Ok(motion),
        })
    }
}
