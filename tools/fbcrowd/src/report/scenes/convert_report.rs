//! The report of `fbcrowd convert`: what was written, and what the scenario cannot say as the scene says it.

use std::path::{Path, PathBuf};

use fbcrowd_jobs::wording::counted;
use fbcrowd_scenes::scene::{Note, Scene};
use schemars::JsonSchema;
use serde::Serialize;

/// A converted scene.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ConvertReport {
    /// Path of the scenario file.
    scenario: String,
    /// Paths of the agent files that it names.
    agent_files: Vec<String>,
    /// Number of agents at the start.
    agents: usize,
    /// Number of sources of agents.
    sources: usize,
    /// Number of states.
    states: usize,
    /// Number of sets of goals.
    goals: usize,
    /// Number of obstacles.
    obstacles: usize,
    /// Number of walkable polygons.
    walkable: usize,
    /// Whether a note changes what happens.
    pub(crate) changes: bool,
    /// What the scenario cannot say as the scene says it.
    notes: Vec<NoteReport>,
}

/// One note.
#[derive(JsonSchema, Serialize)]
struct NoteReport {
    /// File of the scene; empty where the note is about the whole scene.
    file: String,
    /// Line of the file, from 1; 0 where the note is about the whole file.
    line: usize,
    /// Number of positions with the same note; `line` is the first.
    count: usize,
    /// What is not supported, and what the scenario says instead.
    message: String,
    /// Whether it changes what happens.
    changes: bool,
}

impl ConvertReport {
    /// The report of a scene.
    pub(crate) fn new(scene: &Scene, scenario: &Path, agent_files: &[PathBuf]) -> Self {
        let shown = |path: &Path| path.display().to_string();
        Self {
            scenario: shown(scenario),
            agent_files: agent_files.iter().map(|path| shown(path)).collect(),
            agents: scene.agent_count(),
            sources: scene.sources.len(),
            states: scene.states.len(),
            goals: scene.goals.len(),
            obstacles: scene.obstacles.len(),
            walkable: scene.walkable.len(),
            changes: scene.notes.change_what_happens(),
            notes: scene.notes.list().into_iter().map(NoteReport::from).collect(),
        }
    }

    /// What was written; then a line for each note, those that change what happens first.
    pub(crate) fn text(&self) -> String {
        let mut parts = vec![
            counted(self.agents, "agent", "agents"),
            counted(self.sources, "source", "sources"),
            counted(self.states, "state", "states"),
            counted(self.obstacles, "obstacle", "obstacles"),
            counted(self.walkable, "walkable polygon", "walkable polygons"),
        ];
        parts.retain(|part| !part.starts_with("0 "));
        let mut text = format!("{}: {}\n", self.scenario, parts.join(", "));
        for path in &self.agent_files {
            text += &format!("{path}: starts of agents\n");
        }
        for changes in [true, false] {
            let notes = self.notes.iter().filter(|note| note.changes == changes);
            text.extend(notes.map(NoteReport::text));
        }
        text
    }
}

impl NoteReport {
    fn text(&self) -> String {
        let kind = if self.changes { "changes" } else { "note" };
        let position = match (self.file.is_empty(), self.line) {
            (true, _) => String::new(),
            (false, 0) => format!("{}: ", self.file),
            (false, line) => format!("{}:{line}: ", self.file),
        };
        let times = if self.count > 1 { format!(" ({} times)", self.count) } else { String::new() };
        format!("{kind:<8} {position}{}{times}\n", self.message)
    }
}

impl From<Note> for NoteReport {
    fn from(note: Note) -> Self {
        let Note { file, line, count, what, changes } = note;
        Self { file, line, count, message: what, changes }
    }
}
