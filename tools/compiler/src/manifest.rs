//! `manifest.toml`: what a user says of the clips instead of letting it be found. Every mistake is shown where it
//! stands.
//!
//! ```toml
//! #:schema ../manifest.schema.json
//! # All of it may be left out. Unless [[clips]] name what is used, it is all below the manifest's folder.
//! semi_procedural = "walk"            # m_sp, by the name of its example
//! target_skeleton = "walk"            # whose body all examples share
//! max_examples = 40                   # of near-equal ones the best are kept; mirrors not counted
//! velocity_hull = "paper"             # the paper's own construction alone; else "turning_and_holding"
//!
//! [[clips]]
//! path = "."                          # a folder: what holds for all clips below it; relative to this file
//! metres_per_unit = 0.01
//! frame_rate_hz = 60.0
//! up = "+Y"
//! forward = "+Z"                      # where the body faces in the first frame, to within 90°
//! joints = { neck = "Neck1" }         # role → joint; of legs and arms all six or none
//!
//! [[clips]]
//! path = "capture.bvh"                # a file: one clip; a second table of the same file makes a second clip
//! animation = "Walk"                  # of a glTF file; all where left out
//! name = "walk"                       # the example's
//! frames = [120, 480]                 # first and last, counted from 1
//! mirror = false
//!
//! [[clips]]
//! path = "broken"                     # a file or folder that is not to be used
//! skip = true
//! ```
//!
//! Of the folders that hold a file, later tables count more; the file's own counts most.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use motiondb::source_text::{Invalid, SourceText};
use motiondb::velocity_hull::Construction;
use serde::Deserialize;
use toml::Spanned;

use crate::compile::Options;
use crate::error::Refusal;
use crate::human_clip::HumanClip;
use crate::import;
use crate::manifest_error::ManifestError;
use crate::manifest_table::Table;
use crate::take::Take;

/// What is to be compiled, and how.
#[derive(Clone, Debug, Default)]
pub struct Manifest {
    /// Every clip, sorted by path; takes of one file in the manifest's order.
    pub takes: Vec<Take>,
    /// What is wanted of the whole set.
    pub options: Options,
    /// Clips below its folder that its tables neither name nor skip: they are not used.
    pub unnamed: usize,
    source: SourceText,
    semi_procedural: Option<Spanned<String>>,
    target_skeleton: Option<Spanned<String>>,
}

/// The file as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ManifestFile {
    semi_procedural: Option<Spanned<String>>,
    target_skeleton: Option<Spanned<String>>,
    max_examples: Option<NonZeroUsize>,
    #[serde(default)]
    velocity_hull: Construction,
    #[serde(default)]
    clips: Vec<Spanned<Table>>,
}

impl Manifest {
    /// Reads a manifest and looks up the clips that it names.
    ///
    /// # Errors
    /// Where it cannot be read, says something impossible or names clips that are not there.
    pub fn read(path: &Path) -> Result<Self, ManifestError> {
        let unreadable = |source| ManifestError::Unreadable { path: path.to_owned(), source };
        Self::parse(SourceText::read(path).map_err(unreadable)?)
    }

    /// As [`Manifest::read`], from its text.
    ///
    /// # Errors
    /// As [`Manifest::read`].
    pub fn parse(source: SourceText) -> Result<Self, ManifestError> {
        let file: ManifestFile =
            toml::from_str(&source.text).map_err(|error| source.unparsed(error.span(), error.message()))?;
        for table in &file.clips {
            table.get_ref().check(&source)?;
        }
        let takes = takes(&source, &file.clips)?;
        let options = Options { max_examples: file.max_examples, velocity_hull: file.velocity_hull };
        let (semi_procedural, target_skeleton) = (file.semi_procedural, file.target_skeleton);
        let unnamed = unnamed(&source, &file.clips, &takes);
        Ok(Self { takes, options, unnamed, source, semi_procedural, target_skeleton })
    }

    /// Files of which nothing is said.
    pub fn of_files(files: &[PathBuf]) -> Self {
        let mut manifest = Self::default();
        manifest.add_files(files);
        manifest
    }

    /// Adds files of which it says nothing, unless it names them.
    pub fn add_files(&mut self, files: &[PathBuf]) {
        let named: Vec<PathBuf> = self.takes.iter().map(|take| take.path.clone()).collect();
        let new = files.iter().map(|file| tidy(file)).filter(|file| !named.contains(file));
        self.takes.extend(new.map(Take::from));
        self.takes.sort_by(|a, b| (a.path.file_name(), &a.path).cmp(&(b.path.file_name(), &b.path)));
    }

    /// Marks the clips that it gives a part to.
    ///
    /// # Errors
    /// Where there is no clip of a name.
    pub(crate) fn choose(&self, clips: &mut [HumanClip]) -> Result<(), ManifestError> {
        if let Some(name) = &self.semi_procedural {
            self.named(clips, name)?.choices.is_semi_procedural = true;
        }
        if let Some(name) = &self.target_skeleton {
            self.named(clips, name)?.choices.is_target_skeleton = true;
        }
        Ok(())
    }

    fn named<'a>(&self, clips: &'a mut [HumanClip], name: &Spanned<String>) -> Result<&'a mut HumanClip, Invalid> {
        match clips.iter().position(|clip| clip.name == *name.get_ref()) {
            Some(index) => Ok(&mut clips[index]),
            None => Err(self.unknown(clips, name)),
        }
    }

    /// That there is no clip of a name, which may be that of one of a clip's windows.
    fn unknown(&self, clips: &[HumanClip], name: &Spanned<String>) -> Invalid {
        let names: Vec<&str> = clips.iter().map(|clip| clip.name.as_str()).collect();
        let window_of = name.get_ref().rsplit_once('@').map(|(clip, _)| clip).filter(|clip| names.contains(clip));
        if let Some(clip) = window_of {
            let message = format!("`{}` is a window of the clip `{clip}`, not a clip", name.get_ref());
            let remedy = "name the clip, whose first window counts, or give it the `frames` of this one";
            return self.source.invalid(name.span(), message, remedy);
        }
        let message = format!("no clip is called `{}`; there are {}", name.get_ref(), names.join(", "));
        self.source.invalid(name.span(), message, "name one of these")
    }

    /// That the clip chosen as m_sp has no steps.
    pub(crate) fn not_stepping(&self) -> Invalid {
        let span = self.semi_procedural.as_ref().map_or(0..0, Spanned::span);
        self.source.invalid(span, "this clip gives no example that steps", "name a straight walk")
    }

    /// Why a clip is refused.
    ///
    /// # Errors
    /// Where the manifest says of it what is not so.
    pub(crate) fn reason(&self, take: &Take, refusal: Refusal) -> Result<String, Invalid> {
        match refusal {
            Refusal::Setting { setting, reason, remedy } => {
                let span = take.places.values.get(&setting).unwrap_or(&take.places.table);
                Err(self.source.invalid(span.clone(), reason, remedy))
            }
            refusal => Ok(refusal.to_string()),
        }
    }
}

/// Every clip that tables name, or all below the manifest's folder where there is no table.
fn takes(source: &SourceText, tables: &[Spanned<Table>]) -> Result<Vec<Take>, ManifestError> {
    let mut takes = Vec::new();
    let mut folders: Vec<(PathBuf, &Spanned<Table>)> = Vec::new();
    let mut skipped = Vec::new();
    let mut files = if tables.iter().all(|table| table.get_ref().skip) {
        clip_files(&tidy(&source.beside(Path::new(""))))?
    } else {
        Vec::new()
    };
    for table in tables {
        let given = &table.get_ref().path;
        let path = path_of(source, table);
        if !or_here(&path).exists() {
            let message = format!("there is no {}", path.display());
            return Err(source.invalid(given.span(), message, "the path is relative to the manifest").into());
        }
        if table.get_ref().skip {
            skipped.push(path);
        } else if or_here(&path).is_dir() {
            table.get_ref().check_folder(source)?;
            files.extend(clip_files(&path)?);
            folders.push((path, table));
        } else {
            takes.push((path, Some(table)));
        }
    }
    files.retain(|file| !takes.iter().any(|(path, _)| path == file));
    files.sort();
    files.dedup();
    takes.extend(files.into_iter().map(|file| (file, None)));
    takes.retain(|(path, _)| !skipped.iter().any(|skipped| path.starts_with(skipped)));
    let mut takes: Vec<Take> = takes.into_iter().map(|(path, own)| take(path, own, &folders)).collect();
    takes.sort_by(|a, b| (a.path.file_name(), &a.path).cmp(&(b.path.file_name(), &b.path)));
    Ok(takes)
}

/// How many clips below the manifest's folder its tables leave out without a word.
fn unnamed(source: &SourceText, tables: &[Spanned<Table>], takes: &[Take]) -> usize {
    let skipped: Vec<PathBuf> =
        tables.iter().filter(|table| table.get_ref().skip).map(|table| path_of(source, table)).collect();
    let is_known = |file: &PathBuf| {
        takes.iter().any(|take| take.path == *file) || skipped.iter().any(|path| file.starts_with(path))
    };
    let files = clip_files(&tidy(&source.beside(Path::new("")))).unwrap_or_default();
    files.iter().filter(|file| !is_known(file)).count()
}

/// The file or folder of a table.
fn path_of(source: &SourceText, table: &Spanned<Table>) -> PathBuf {
    tidy(&source.beside(table.get_ref().path.get_ref()))
}

/// A file with what its folders' tables and then its own say of it.
fn take(path: PathBuf, own: Option<&Spanned<Table>>, folders: &[(PathBuf, &Spanned<Table>)]) -> Take {
    let around = folders.iter().filter(|(folder, _)| path.starts_with(folder)).map(|(_, table)| *table);
    let tables: Vec<&Spanned<Table>> = around.chain(own).collect();
    let mut take = Take::from(path);
    for table in tables {
        table.get_ref().tell(table.span(), &mut take);
    }
    take
}

fn clip_files(folder: &Path) -> Result<Vec<PathBuf>, ManifestError> {
    Ok(import::clip_files(&or_here(folder))?.iter().map(|file| tidy(file)).collect())
}

/// Without `.`, so that one file has one path.
fn tidy(path: &Path) -> PathBuf {
    path.components().filter(|part| !matches!(part, std::path::Component::CurDir)).collect()
}

/// The folder that an empty path means.
fn or_here(path: &Path) -> PathBuf {
    if path.as_os_str().is_empty() { PathBuf::from(".") } else { path.to_owned() }
}
