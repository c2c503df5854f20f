//! GLB, glTF, VRM or `.fbchar` → a character, and the file of a character.

use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_sim::recording::Header;
use fbcrowd_sim::scenario::{self, CharacterSize, STATURE, Scenario};
use motiondb::body::Skeleton;
use motiondb::character::{self, Character, CharacterFit};
use motiondb_compiler::Outside;
use motiondb_compiler::character::{CharacterNote, CompiledCharacter, RolesFrom, compile_character};

use crate::error::JobError;
use crate::observer::{JobEvent, Observer};
use crate::output_path::check_is_no_input;

/// A character from a file.
pub struct LoadedCharacter {
    /// The character.
    pub character: Character,
    /// Checksum of its `.fbchar`, written or not.
    pub checksum: u32,
    /// How its roles were found; none of a `.fbchar`.
    pub roles_from: Option<RolesFrom>,
    /// What the compiler reports; none of a `.fbchar`.
    pub notes: Vec<CharacterNote>,
}

/// Whether a path names a compiled character.
pub fn is_compiled(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("fbchar"))
}

/// Loads a `.fbchar`, or compiles a GLB, glTF or VRM file without the meshes that `hide` names.
///
/// # Errors
/// Where the file gives no character, or meshes of a `.fbchar` are to be hidden.
pub fn load(path: &Path, outside: Outside, hide: &[String]) -> Result<LoadedCharacter, JobError> {
    if is_compiled(path) {
        if !hide.is_empty() {
            return Err(JobError::CompiledMeshes { path: path.to_owned() });
        }
        let (character, checksum) = character::load(path)?;
        return Ok(LoadedCharacter { character, checksum, roles_from: None, notes: Vec::new() });
    }
    let CompiledCharacter { character, roles_from, notes } = compile_character(path, outside, hide)?;
    let (_, checksum) = character::from_bytes(path, &character::to_bytes(&character))?;
    Ok(LoadedCharacter { character, checksum, roles_from: Some(roles_from), notes })
}

/// Compiles a character into a `.fbchar`, without the meshes that `hide` names.
///
/// # Errors
/// Where the file gives no character, `output` is the input, or cannot be written.
pub fn compile(
    input: &Path,
    output: &Path,
    outside: Outside,
    hide: &[String],
    observer: &Observer,
) -> Result<LoadedCharacter, JobError> {
    check_is_no_input(output, [input])?;
    observer(JobEvent::Stage("compiling"));
    let loaded = load(input, outside, hide)?;
    observer(JobEvent::Stage("writing"));
    character::write(output, &loaded.character)?;
    Ok(loaded)
}

/// Folder of the characters of a recording, beside it.
const FOLDER: &str = "characters";

/// The characters of a scenario, in its order.
pub struct ScenarioCharacters {
    /// Each character's name in the scenario, and itself.
    pub characters: Vec<(String, LoadedCharacter)>,
    /// The files that were read.
    pub files: Vec<PathBuf>,
}

impl ScenarioCharacters {
    /// Loads or compiles the characters that a scenario file names; none where it names none.
    ///
    /// # Errors
    /// Where a file is missing or gives no character.
    pub fn load(file: &Path, scenario: &Scenario, outside: Outside, observer: &Observer) -> Result<Self, JobError> {
        if scenario.characters.is_empty() {
            return Ok(Self { characters: Vec::new(), files: Vec::new() });
        }
        observer(JobEvent::Stage("characters"));
        let files = scenario::character_files(file)?;
        let mut characters = Vec::new();
        for (file, spec) in files.iter().zip(&scenario.characters) {
            characters.push((spec.name.clone(), load(&file.path, outside, &file.hide)?));
        }
        Ok(Self { characters, files: files.into_iter().map(|file| file.path).collect() })
    }

    /// The files that [`ScenarioCharacters::write`] writes for a recording.
    pub fn outputs(&self, recording: &Path) -> Vec<PathBuf> {
        self.characters.iter().map(|(name, _)| path_beside(recording, name)).collect()
    }

    /// Writes each character as `characters/NAME.fbchar` beside a recording, which keeps their names and checksums.
    ///
    /// # Errors
    /// Where the system does not allow it.
    pub fn write(&self, recording: &Path) -> Result<(), JobError> {
        for (name, loaded) in &self.characters {
            let path = path_beside(recording, name);
            let folder = path.parent().unwrap_or(Path::new(""));
            fs::create_dir_all(folder).map_err(|error| JobError::unwritable(folder, error))?;
            character::write(&path, &loaded.character)?;
        }
        Ok(())
    }

    /// Checksums, in the scenario's order.
    pub fn checksums(&self) -> Vec<u32> {
        self.characters.iter().map(|(_, loaded)| loaded.checksum).collect()
    }

    /// Gives the characters their sizes on a skeleton, and agents that wear them their radius, unless one is stated.
    pub fn wear(&self, scenario: &mut Scenario, skeleton: &Skeleton) {
        let size = |(_, loaded): &(String, LoadedCharacter)| {
            CharacterSize::of(&CharacterFit::new(&loaded.character, skeleton), skeleton)
        };
        scenario.wear(self.characters.iter().map(size));
    }

    /// Notes what the compiler reports, and characters whose legs or height differ much from the crowd's.
    pub fn note(&self, skeleton: &Skeleton, observer: &Observer) {
        for (name, loaded) in &self.characters {
            for note in &loaded.notes {
                observer(JobEvent::Note(&format!("character {name}: {note}")));
            }
            if let Some(warning) = size_warning(&CharacterFit::new(&loaded.character, skeleton)) {
                observer(JobEvent::Note(&format!("character {name}: {warning}")));
            }
        }
    }
}

/// The warning about a character whose legs or height differ much from the crowd's; none about others.
pub fn size_warning(fit: &CharacterFit) -> Option<String> {
    if !fit.is_scaled() && fit.is_as_tall() {
        return None;
    }
    let (own_m, crowd_m) = (fit.character.hips_over_soles_m, fit.hips_over_soles_m);
    let crowd_height = (!fit.is_as_tall()).then_some(("to be as tall as the crowd", fit.skeleton_height_m));
    let own_height = fit.is_scaled().then_some(("for its own size", fit.character.height_m));
    let remedy = |(aim, height_m): (&str, f32)| {
        let stature = height_m / fit.height_m();
        STATURE.contains(&stature).then(|| format!("`stature = {stature:.2}` {aim} ({height_m:.2} m)"))
    };
    let remedies: Vec<String> = [crowd_height, own_height].into_iter().flatten().filter_map(remedy).collect();
    let remedy = if remedies.is_empty() {
        String::new()
    } else {
        format!("; give the agents that wear it a profile with {}", remedies.join(", or "))
    };
    Some(format!(
        "the hips are {own_m:.2} m over the soles, the crowd's {crowd_m:.2} m: the figure is worn scaled by {:.2}, {:.2} m \
         tall{remedy}",
        fit.scale,
        fit.height_m()
    ))
}

/// The characters of a recording, from the folder beside it, in its order.
///
/// # Errors
/// Where a character is missing, damaged or another one than that of the simulation.
pub fn of_recording(recording: &Path, header: &Header) -> Result<Vec<Character>, JobError> {
    let load = |recorded: &fbcrowd_sim::recording::RecordedCharacter| {
        let path = path_beside(recording, &recorded.name);
        if !path.exists() {
            return Err(JobError::MissingCharacter { path, recording: recording.to_owned() });
        }
        let (character, checksum) = character::load(&path)?;
        match checksum == recorded.checksum {
            true => Ok(character),
            false => Err(JobError::OtherCharacter { path, recording: recording.to_owned() }),
        }
    };
    header.characters.iter().map(load).collect()
}

/// Path of a character's file beside a recording.
fn path_beside(recording: &Path, name: &str) -> PathBuf {
    recording.parent().unwrap_or(Path::new("")).join(FOLDER).join(format!("{name}.fbchar"))
}
