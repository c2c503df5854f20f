//! The scenario file: header, duration, profiles, goals, states, agents, ground, picture.

use crate::scene::Scene;
use crate::write::text_file::TextFile;
use crate::write::words::{number, plain, quoted};
use crate::write::{agent_tables, behaviour_tables, ground_tables};

/// Simulated time of a scene that states none, s.
const DURATION_S: f64 = 120.0;
/// Notes that the header lists.
const NOTES_SHOWN: usize = 20;

/// What a scene does not state.
#[derive(Clone, Debug, Default)]
pub struct WriteOptions {
    /// Stem of the agent files: that of the scenario file.
    pub stem: String,
    /// Source of the motion, relative to the scenario file.
    pub clips: Option<String>,
    /// Simulated time, s; default: the scene's, or 120 s.
    pub duration_s: Option<f64>,
}

/// A scene as a scenario file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenScene {
    /// The scenario file.
    pub scenario: String,
    /// Agent files that it names.
    pub agent_files: Vec<TextFile>,
}

/// Writes a scene.
pub fn write(scene: &Scene, options: &WriteOptions) -> WrittenScene {
    let mut agent_files = Vec::new();
    let sections = [
        head(scene, options),
        agent_tables::profiles(scene),
        behaviour_tables::goals(scene),
        behaviour_tables::areas(scene),
        behaviour_tables::states(scene),
        agent_tables::agents(scene, &options.stem, &mut agent_files),
        agent_tables::sources(scene),
        ground_tables::walkable(scene),
        ground_tables::obstacles(scene),
        ground_tables::closed_zones(scene),
        ground_tables::measures(scene),
        picture(scene),
    ];
    let filled: Vec<&str> = sections.iter().map(|section| section.trim_end()).filter(|text| !text.is_empty()).collect();
    WrittenScene { scenario: filled.join("\n\n") + "\n", agent_files }
}

fn head(scene: &Scene, options: &WriteOptions) -> String {
    let mut text = format!("# Converted from the {} {} by `fbcrowd convert`.\n", scene.kind, plain(&scene.source));
    for remark in &scene.remarks {
        text += &format!("# {}\n", plain(remark));
    }
    let notes = scene.notes.list();
    let changing: Vec<_> = notes.iter().filter(|note| note.changes).collect();
    if !changing.is_empty() {
        text += "# What happens otherwise than in the source:\n";
    }
    for note in changing.iter().take(NOTES_SHOWN) {
        let position = match (note.file.as_str(), note.line) {
            ("", _) => String::new(),
            (file, 0) => format!("{file}: "),
            (file, line) => format!("{file}:{line}: "),
        };
        text += &format!("# - {}{}\n", plain(&position), plain(&note.what));
    }
    if changing.len() > NOTES_SHOWN {
        text += &format!("# - and {} more\n", changing.len() - NOTES_SHOWN);
    }
    text += &match &options.clips {
        Some(clips) => format!("clips = {}\n", quoted(clips)),
        None => "# clips = \"my/clips\"                    # the motion: a folder of clips\n".to_owned(),
    };
    let duration_s = options.duration_s.or(scene.duration_s).unwrap_or(DURATION_S);
    text += &format!("duration_s = {}\n", number(duration_s));
    if let Some(seed) = scene.seed {
        text += &format!("seed = {seed}\n");
    }
    text
}

fn picture(scene: &Scene) -> String {
    match scene.picture {
        Some([width, height]) => format!("[view]\nwidth = {width}\nheight = {height}\n"),
        None => String::new(),
    }
}
