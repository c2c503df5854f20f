//! `manifest.toml`: what a user states about clips instead of letting the compiler find it. An error names its line.
//!
//! ```toml
//! #:schema ../manifest.schema.json
//! # Every key may be left out. All clips below the manifest's folder are used; tables state more about some of them.
//! semi_procedural = "walk"            # base walk m_sp: name of its example
//! target_skeleton = "walk"            # the clip whose body all examples share
//! max_examples = 40                   # maximum number of examples; of two near-equal examples the better is kept;
//!                                     # mirrors are not counted
//! velocity_hull = "paper"             # the paper's construction alone; default: "turning_and_holding"
//!
//! [[clips]]
//! path = "."                          # a folder: holds for all clips below it; relative to this file
//! metres_per_unit = 0.01
//! frame_rate_hz = 60.0
//! up = "+Y"
//! forward = "+Z"                      # facing in the first frame, to within 60°
//! joints = { neck = "Neck1" }         # role = joint; give all joints of legs and arms, or none of them
//!
//! [[clips]]
//! path = "capture.bvh"                # a file: one clip; a second table of the same file makes a second clip
//! animation = "Walk"                  # animation of a glTF file; default: all
//! name = "walk"                       # name of the example
//! frames = [120, 480]                 # first and last, counted from 1
//! mirror = false
//! transition = "start"                # the clip shows a start, stop, turn, step or pivot, and gives no example
//! style = "elderly"                   # the clips of a style are blended among themselves; "" for none
//!
//! [[clips]]
//! path = "broken"                     # a file or folder that is not used
//! skip = true
//! ```
//!
//! A file's own table overrides the tables of its folders; an inner folder's table overrides an outer one's; if two
//! tables name the same folder, the later one applies. So `path = "."` with `skip = true` leaves only what other tables
//! name.
//!
//! `clips_table` is one `[[clips]]` table; `clip_selection` applies all tables to the clips below the folder.

mod clip_selection;
mod clips_table;

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use motiondb::files::{Invalid, SourceText};
use motiondb::motion::ActionKind;
use motiondb::velocity_sets::velocity_hull::Construction;
use serde::Deserialize;
use toml::Spanned;

use crate::error::{CompileError, ManifestKey, RejectionReason, transition_remedy};
use crate::input::clip_settings::ClipSettings;
use crate::input::manifest::clips_table::ClipsTable;
use crate::input::name_suggestions::nearest_first;
use crate::input::options::Options;
use crate::input::style_names;
use crate::retarget::human_clip::HumanClip;

/// Number of existing names that a message suggests for a name that does not exist.
const SUGGESTIONS: usize = 5;

/// The clips to compile and the options of the set.
///
/// ```
/// use motiondb::files::SourceText;
/// use motiondb_compiler::Manifest;
///
/// let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips/manifest.toml").into();
/// let text = "max_examples = 3\n[[clips]]\npath = 'idle.bvh'\nskip = true\n".to_owned();
/// let manifest = Manifest::parse(SourceText { path, text })?;
/// assert_eq!(manifest.options.max_examples.map(|count| count.get()), Some(3));
/// assert!(manifest.clips.iter().any(|clip| clip.path.ends_with("walk_110.bvh")));
/// assert!(!manifest.clips.iter().any(|clip| clip.path.ends_with("idle.bvh")));
/// # Ok::<(), motiondb_compiler::CompileError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Manifest {
    /// All clips, sorted by file name. Clips of one file keep the manifest's order.
    pub clips: Vec<ClipSettings>,
    /// Options of the whole set.
    pub options: Options,
    source: SourceText,
    semi_procedural: Option<Spanned<String>>,
    target_skeleton: Option<Spanned<String>>,
}

/// Keys by one of which a manifest is recognised.
const KEYS: [&str; 5] = ["clips", "semi_procedural", "target_skeleton", "max_examples", "velocity_hull"];
/// The key that every scenario has and no manifest.
const SCENARIO_KEY: &str = "duration_s";

/// The keys of the file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ManifestFile {
    semi_procedural: Option<Spanned<String>>,
    target_skeleton: Option<Spanned<String>>,
    max_examples: Option<NonZeroUsize>,
    #[serde(default)]
    velocity_hull: Construction,
    #[serde(default)]
    clips: Vec<Spanned<ClipsTable>>,
}

impl Manifest {
    /// Reads a manifest and finds the clips that it names.
    ///
    /// # Errors
    /// [`CompileError::UnreadableManifest`], or as [`Manifest::parse`].
    pub fn read(path: &Path) -> Result<Self, CompileError> {
        let unreadable = |source| CompileError::UnreadableManifest { manifest: path.to_owned(), source };
        Self::parse(SourceText::read(path).map_err(unreadable)?)
    }

    /// A manifest from its text. Paths in it are relative to `source.path`.
    ///
    /// # Errors
    /// [`CompileError::InvalidManifest`] if the text breaks the format or names a clip that does not exist;
    /// [`CompileError::UnreadableFolder`].
    pub fn parse(source: SourceText) -> Result<Self, CompileError> {
        let file: ManifestFile = toml::from_str(&source.text).map_err(|error| no_manifest(&source, &error))?;
        for table in &file.clips {
            table.get_ref().check(&source)?;
        }
        let clips = clip_selection::selected_clips(&source, &file.clips)?;
        let options =
            Options { max_examples: file.max_examples, velocity_hull: file.velocity_hull, ..Options::default() };
        let (semi_procedural, target_skeleton) = (file.semi_procedural, file.target_skeleton);
        Ok(Self { clips, options, source, semi_procedural, target_skeleton })
    }

    /// A manifest that states nothing about some files.
    pub fn of_files(files: &[PathBuf]) -> Self {
        let mut manifest = Self::default();
        manifest.add_files(files);
        manifest
    }

    /// Adds files with default settings, except those that the manifest already has.
    pub fn add_files(&mut self, files: &[PathBuf]) {
        let present: Vec<PathBuf> = self.clips.iter().map(|clip| clip.path.clone()).collect();
        let new = files.iter().map(|file| clip_selection::normal_path(file)).filter(|file| !present.contains(file));
        self.clips.extend(new.map(ClipSettings::from));
        clip_selection::sort(&mut self.clips);
    }

    /// The style of each clip: the stated one, else the one that its path names; empty for none.
    pub fn styles(&self) -> Vec<String> {
        let paths: Vec<&Path> = self.clips.iter().map(|clip| clip.path.as_path()).collect();
        let found = style_names::found_styles(&paths);
        self.clips.iter().zip(found).map(|(clip, found)| clip.style.clone().unwrap_or(found)).collect()
    }

    /// Known manners in the names of clips without a style, and of their folders, in alphabetical order; of the files of some
    /// names alone. Clips whose style the manifest states do not count.
    pub(crate) fn unstyled_manners(&self, files: &BTreeSet<&str>) -> BTreeSet<&'static str> {
        let is_used = |path: &Path| path.file_name().and_then(OsStr::to_str).is_some_and(|name| files.contains(name));
        let clips = self.clips.iter().zip(self.styles());
        let unstyled = clips.filter(|(clip, style)| style.is_empty() && clip.style.is_none() && is_used(&clip.path));
        style_names::manners_in_names(&unstyled.map(|(clip, _)| clip.path.as_path()).collect::<Vec<&Path>>())
    }

    /// Leaves only the clips of some styles; the empty name stands for clips without a style.
    ///
    /// # Errors
    /// [`CompileError::NoStyle`] if there is no clip of a style.
    pub fn keep_styles(&mut self, kept: &[String]) -> Result<(), CompileError> {
        let styles = self.styles();
        if let Some(missing) = kept.iter().find(|style| !styles.contains(style)) {
            let existing: BTreeSet<&str> =
                styles.iter().map(String::as_str).filter(|style| !style.is_empty()).collect();
            let styles = nearest_first(missing, existing).into_iter().map(str::to_owned).collect();
            return Err(CompileError::NoStyle { style: missing.clone(), styles });
        }
        for (clip, style) in self.clips.iter_mut().zip(styles) {
            clip.style = Some(style);
        }
        self.clips.retain(|clip| clip.style.as_ref().is_some_and(|style| kept.contains(style)));
        Ok(())
    }

    /// Marks the clips that `semi_procedural` and `target_skeleton` name.
    ///
    /// # Errors
    /// If no clip has such a name.
    pub(crate) fn mark_chosen(&self, clips: &mut [HumanClip]) -> Result<(), Invalid> {
        if let Some(name) = &self.semi_procedural {
            let (clip, tenth) = self.clip_named(clips, name)?;
            clips[clip].choices.is_semi_procedural = true;
            clips[clip].choices.semi_procedural_tenth = tenth;
        }
        if let Some(name) = &self.target_skeleton {
            let (clip, _) = self.clip_named(clips, name)?;
            clips[clip].choices.is_target_skeleton = true;
        }
        Ok(())
    }

    /// Index of the clip of a name. The name of a clip's further window, `capture@12.6s`, also gives the tenth of a
    /// second at which the window begins.
    fn clip_named(&self, clips: &[HumanClip], name: &Spanned<String>) -> Result<(usize, Option<u32>), Invalid> {
        let index_of = |name: &str| clips.iter().position(|clip| clip.name == name);
        let of_window = || {
            let (clip, start) = name.get_ref().rsplit_once('@')?;
            let start_s: f64 = start.strip_suffix('s')?.parse().ok()?;
            Some((index_of(clip)?, Some(libm::round(10.0 * start_s) as u32)))
        };
        index_of(name.get_ref()).map(|clip| (clip, None)).or_else(of_window).ok_or_else(|| {
            let mut near = nearest_first(name.get_ref(), clips.iter().map(|clip| clip.name.as_str()));
            near.truncate(SUGGESTIONS);
            let message = format!("there is no clip `{}`; near it are {}", name.get_ref(), near.join(", "));
            self.source.invalid(name.span(), message, "name one of these")
        })
    }

    /// The error at `semi_procedural` where its example has no steps, or is not among `stepping`, the clip's examples
    /// that step.
    pub(crate) fn not_stepping(&self, stepping: &[String]) -> Invalid {
        let span = self.semi_procedural.as_ref().map_or(0..0, Spanned::span);
        if stepping.is_empty() {
            let message = "no walk straight ahead found; this clip cannot be the base walk (m_sp)";
            return self.source.invalid(span, message, "choose a straight walk");
        }
        let message = format!("no walk ahead of this name; this clip gives {}", stepping.join(", "));
        self.source.invalid(span, message, "name one of these")
    }

    /// The error at `transition` of a file that shows no transition of the stated kind.
    pub(crate) fn no_transition(&self, file: &str, kind: ActionKind) -> CompileError {
        let is_it = |clip: &&ClipSettings| {
            clip.transition == Some(kind) && clip.path.file_name().is_some_and(|name| name.to_string_lossy() == file)
        };
        let span = self.clips.iter().find(is_it).and_then(|clip| clip.spans.values.get(&ManifestKey::Transition));
        match span {
            Some(span) => {
                let message = format!("{file}: no {} was found", kind.name());
                self.source.invalid(span.clone(), message, &transition_remedy(kind)).into()
            }
            None => CompileError::NoTransition { file: file.to_owned(), kind },
        }
    }

    /// Checks that a clip is not rejected because of a wrong value in the manifest.
    ///
    /// # Errors
    /// The error at that value.
    pub(crate) fn check_reason(&self, settings: &ClipSettings, reason: &RejectionReason) -> Result<(), Invalid> {
        let RejectionReason::ManifestContradicted { key, problem, remedy } = reason else { return Ok(()) };
        let span = settings.spans.values.get(key).unwrap_or(&settings.spans.table);
        Err(self.source.invalid(span.clone(), problem.as_str(), remedy))
    }
}

/// The error that a text is not a manifest.
fn no_manifest(source: &SourceText, error: &toml::de::Error) -> Invalid {
    let mistake = source.unparsed(error.span(), error.message(), &KEYS);
    if !source.text.lines().any(|line| line.trim_start().starts_with(SCENARIO_KEY)) {
        return mistake;
    }
    let message = "this is a scenario, not a manifest of clips".to_owned();
    Invalid { message, help: "simulate it with `fbcrowd run`, or give its clips here".to_owned(), ..mistake }
}
