//! `fbcrowd inspect` of a character: the joint of each role, sizes, notes, and its feet in a recording.

use std::path::{Path, PathBuf};

use fbcrowd_jobs::character::{self, LoadedCharacter};
use fbcrowd_sim::measures::character_soles;
use fbcrowd_sim::recording::Recording;
use motiondb_compiler::Outside;
use motiondb_compiler::character::{FileContent, file_content};

use crate::cmd::inspect::character_picture;
use crate::report::character_report::{CharacterInspection, CharacterReport};
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;

/// What `fbcrowd inspect` says of a character.
pub(super) struct CharacterOptions<'a> {
    pub(super) json: bool,
    pub(super) outside: Outside,
    pub(super) recording: Option<&'a Path>,
    /// Meshes that are left out.
    pub(super) hide: &'a [String],
    /// Where the picture goes.
    pub(super) picture: Option<PathBuf>,
}

/// Shows a character alone.
pub(super) fn show(path: &Path, options: &CharacterOptions) -> Result<Answer, Failure> {
    if let Some(picture) = &options.picture {
        let inputs: Vec<&Path> = options.recording.into_iter().chain([path]).collect();
        character_picture::check(picture, &inputs)?;
    }
    let loaded = character::load(path, options.outside, options.hide)?;
    let mut report = CharacterReport::new(path, &loaded);
    let recording = options.recording.map(Recording::open).transpose()?;
    if let Some(recording) = &recording {
        add_recording(&mut report, &loaded, recording)?;
    }
    if let Some(picture) = &options.picture {
        character_picture::write(picture, &loaded.character, recording.as_ref())?;
    }
    print(options, report)
}

fn add_recording(report: &mut CharacterReport, loaded: &LoadedCharacter, recording: &Recording) -> Result<(), Failure> {
    let soles = character_soles(recording, &loaded.character)?;
    report.add_recording(&loaded.character, recording.header().skeleton(), soles);
    Ok(())
}

/// Prints a report as JSON or text.
pub(super) fn print(options: &CharacterOptions, report: CharacterReport) -> Result<Answer, Failure> {
    if options.json {
        output::print_json(&CharacterInspection { character: report })?;
    } else {
        output::print(&report.text())?;
    }
    Ok(Answer::Yes)
}

/// The character of a file that may hold clips; none where it has no meshes, or no human that wears them.
pub(super) fn of_clip(path: &Path, outside: Outside) -> Option<CharacterReport> {
    file_content(path).filter(|content| content.has_meshes)?;
    let loaded = character::load(path, outside, &[]).ok()?;
    Some(CharacterReport::new(path, &loaded))
}

/// Whether a file is a character and holds no clip.
pub(super) fn is_character_alone(path: &Path) -> bool {
    matches!(file_content(path), Some(FileContent { has_meshes: true, has_animations: false }))
}
