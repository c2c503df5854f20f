//! `manifest.toml`: what a user says of the clips instead of letting it be found. Every mistake is shown where it
//! stands.
//!
//! ```toml
//! #:schema ../manifest.schema.json
//! # All of it may be left out. Every clip below the manifest's folder is used; tables say more of some.
//! semi_procedural = "walk"            # m_sp, by the name of its example
//! target_skeleton = "walk"            # whose body all examples share
//! max_examples = 40                   # of near-equal ones the best are kept; mirrors not counted
//! velocity_hull = "paper"             # the paper's own construction alone; else "turning_and_holding"
//!
//! [[clips]]
//! path = "."                          # a folder: holds for all clips below it; relative to this file
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
//! A file's own table counts most, then its innermost folder's; of two of one folder the later. So `path = "."` with
//! `skip = true` leaves only what other tables name.

pub(crate) mod error;
pub(crate) mod table;

pub use error::ManifestError;

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use motiondb::files::{Invalid, SourceText};
use motiondb::velocity_sets::velocity_hull::Construction;
use serde::Deserialize;
use toml::Spanned;

use crate::compile::Options;
use crate::error::Refusal;
use crate::import;
use crate::input::clip_settings::Take;
use crate::input::manifest::table::Table;
use crate::input::name_suggestions::nearest_first;
use crate::retarget::human_clip::HumanClip;

/// Names that are shown where there is none as given.
const NEAR_NAMES: usize = 5;

/// What is to be compiled, and how.
#[derive(Clone, Debug, Default)]
pub struct Manifest {
    /// Every clip, sorted by path; takes of one file in the manifest's order.
    pub takes: Vec<Take>,
    /// What is wanted of the whole set.
    pub options: Options,
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
        Ok(Self { takes, options, source, semi_procedural, target_skeleton })
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
            let (clip, tenth) = self.named(clips, name)?;
            clips[clip].choices.is_semi_procedural = true;
            clips[clip].choices.semi_procedural_tenth = tenth;
        }
        if let Some(name) = &self.target_skeleton {
            let (clip, _) = self.named(clips, name)?;
            clips[clip].choices.is_target_skeleton = true;
        }
        Ok(())
    }

    /// The clip of a name; where it is the name of one of a clip's further windows (`capture@12.6s`), also the tenth of
    /// a second at which that begins.
    fn named(&self, clips: &[HumanClip], name: &Spanned<String>) -> Result<(usize, Option<u32>), Invalid> {
        let called = |name: &str| clips.iter().position(|clip| clip.name == name);
        let window = || {
            let (clip, start) = name.get_ref().rsplit_once('@')?;
            let start_s: f64 = start.strip_suffix('s')?.parse().ok()?;
            Some((called(clip)?, Some(libm::round(10.0 * start_s) as u32)))
        };
        called(name.get_ref()).map(|clip| (clip, None)).or_else(window).ok_or_else(|| {
            let mut near = nearest_first(name.get_ref(), clips.iter().map(|clip| clip.name.as_str()));
            near.truncate(NEAR_NAMES);
            let message = format!("no clip is called `{}`; near it are {}", name.get_ref(), near.join(", "));
            self.source.invalid(name.span(), message, "name one of these")
        })
    }

    /// That the example chosen as m_sp has no steps, or is none of `stepping`, those of its clip.
    pub(crate) fn not_stepping(&self, stepping: &[String]) -> Invalid {
        let span = self.semi_procedural.as_ref().map_or(0..0, Spanned::span);
        if stepping.is_empty() {
            let message = "no stepping cycle found; this clip cannot be the base walk (m_sp)";
            return self.source.invalid(span, message, "choose a straight walk");
        }
        let message = format!("no stepping cycle of this name; this clip gives {}", stepping.join(", "));
        self.source.invalid(span, message, "name one of these")
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

/// Every clip below the manifest's folder or named by a table, but for those whose innermost table skips them.
fn takes(source: &SourceText, tables: &[Spanned<Table>]) -> Result<Vec<Take>, ManifestError> {
    let (mut files, mut folders, mut own) = (Vec::new(), Vec::new(), Vec::new());
    for table in tables {
        let path = existing(source, table)?;
        if or_here(&path).is_dir() {
            table.get_ref().check_folder(source)?;
            files.extend(clip_files(&path)?);
            folders.push((path, table));
        } else {
            own.push((path, Some(table)));
        }
    }
    files.extend(clip_files(&tidy(&source.beside(Path::new(""))))?);
    // What is told last counts most: the innermost folder's table.
    folders.sort_by_key(|(folder, _)| folder.components().count());
    files.retain(|file| !own.iter().any(|(path, _)| path == file));
    files.sort();
    files.dedup();
    let all = own.into_iter().chain(files.into_iter().map(|file| (file, None)));
    let mut takes: Vec<Take> = all.filter_map(|(path, own)| take(path, own, &folders)).collect();
    takes.sort_by(|a, b| (a.path.file_name(), &a.path).cmp(&(b.path.file_name(), &b.path)));
    Ok(takes)
}

/// The file or folder of a table.
fn existing(source: &SourceText, table: &Spanned<Table>) -> Result<PathBuf, Invalid> {
    let given = &table.get_ref().path;
    let path = tidy(&source.beside(given.get_ref()));
    if or_here(&path).exists() {
        return Ok(path);
    }
    let message = format!("there is no {}", path.display());
    Err(source.invalid(given.span(), message, "the path is relative to the manifest"))
}

/// A file with what its folders' tables and then its own say of it; none where the last of them skips it.
fn take(path: PathBuf, own: Option<&Spanned<Table>>, folders: &[(PathBuf, &Spanned<Table>)]) -> Option<Take> {
    let around = folders.iter().filter(|(folder, _)| path.starts_with(folder)).map(|(_, table)| *table);
    let tables: Vec<&Spanned<Table>> = around.chain(own).collect();
    if tables.last().is_some_and(|table| table.get_ref().skip) {
        return None;
    }
    let mut take = Take::from(path);
    for table in tables {
        table.get_ref().tell(table.span(), &mut take);
    }
    Some(take)
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
