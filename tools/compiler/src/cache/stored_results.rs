//! What a compilation stores and finds again: the clips of each file, the analysis of each clip, the comparisons of
//! clips.
//!
//! The frames of a clip are not stored: only its analysis needs them, and imports the file again where none is stored.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use crate::cache::cache_folder::CacheFolder;
use crate::cache::key;
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::dedup::comparison::ComparedClip;
use crate::dedup::comparison_log::{ComparisonLog, LoggedComparisons};
use crate::dedup::signature::{self, Row};
use crate::error::{CompileError, Rejection, RejectionReason};
use crate::import::{ImportedClip, import_with_settings};
use crate::input::clip_settings::ClipSettings;
use crate::retarget::human_clip::{Digest, HumanBody, HumanClip, HumanPose, StoredFrames};

/// Greatest size of all results that a compilation leaves beside its own, bytes.
const UNUSED_LIMIT: u64 = 1 << 30;

/// Results of earlier compilations, in a folder. Its files can be deleted at any time.
#[derive(Debug)]
pub struct Cache {
    folder: CacheFolder,
    /// Where each clip of the present compilation comes from, by its key.
    origins: Mutex<BTreeMap<Digest, Origin>>,
}

/// Where a clip comes from.
#[derive(Clone, Debug)]
struct Origin {
    settings: ClipSettings,
    /// Index of the clip in its file.
    index: usize,
    signature: Vec<Row>,
}

/// A clip as it is stored.
#[derive(Serialize, Deserialize)]
struct StoredClip {
    file: String,
    clip: String,
    human: HumanClip,
    signature: Vec<Row>,
}

impl Cache {
    /// Opens the cache in a folder, and creates the folder where there is none.
    ///
    /// # Errors
    /// If the folder cannot be created.
    pub fn open(folder: &Path) -> io::Result<Self> {
        Ok(Self { folder: CacheFolder::open(folder, UNUSED_LIMIT)?, origins: Mutex::default() })
    }

    /// The clips of a file, as [`import_with_settings`]; without frames where they are stored. A file with a rejected clip
    /// is not stored.
    ///
    /// # Errors
    /// As [`import_with_settings`].
    pub(crate) fn import(&self, settings: &ClipSettings) -> Result<Vec<ImportedClip>, Rejection> {
        let Some(file) = key::of_file(settings) else { return import_with_settings(settings) };
        let stored = match self.folder.get::<Vec<StoredClip>>(&file) {
            Some(stored) => stored,
            None => {
                let imported = import_with_settings(settings)?;
                let all_human = imported.iter().all(|import| import.outcome.is_ok());
                // A file that changes while it is read is not stored.
                if !all_human || key::of_file(settings) != Some(file) {
                    return Ok(imported);
                }
                let stored = imported.into_iter().enumerate();
                let stored = stored.filter_map(|(index, import)| StoredClip::of(import, &file, index)).collect();
                self.folder.put(&file, &stored);
                stored
            }
        };
        let mut origins = self.origins.lock().unwrap_or_else(PoisonError::into_inner);
        let import = |(index, StoredClip { file: name, clip, human, signature }): (usize, StoredClip)| {
            let settings = settings.clone();
            origins.insert(key::of_clip(&file, index), Origin { settings, index, signature });
            ImportedClip { file: name, clip, outcome: Ok(human) }
        };
        Ok(stored.into_iter().enumerate().map(import).collect())
    }

    /// A clip in the form in which clips are compared.
    pub(crate) fn compared(&self, clip: &HumanClip) -> ComparedClip {
        self.origin(clip).map_or_else(
            || ComparedClip::of(clip),
            |origin| ComparedClip::of_rows(clip.frame_count(), clip.frame_rate_hz, &origin.signature),
        )
    }

    /// The analysis of a clip on a body, stored or made by `analyze`. The clip has no frames afterwards.
    ///
    /// # Errors
    /// [`CompileError::ClipUnread`] if the file cannot be imported again.
    pub(crate) fn analyzed(
        &self,
        clip: &mut HumanClip,
        body: &HumanBody,
        analyze: impl Fn(&mut HumanClip) -> AnalyzedClip,
    ) -> Result<AnalyzedClip, CompileError> {
        let Some((stored, origin)) = clip.stored.clone().zip(self.origin(clip)) else { return Ok(analyze(clip)) };
        let key = key::of_analysis(clip, &stored.key, body);
        if let Some(found) = self.folder.get(&key) {
            clip.frames = Vec::new();
            return Ok(found);
        }
        if clip.frames.is_empty() {
            clip.frames = origin.frames(&stored).ok_or_else(|| CompileError::ClipUnread(Box::new(origin.changed())))?;
        }
        let found = analyze(clip);
        self.folder.put(&key, &found);
        Ok(found)
    }

    /// The comparisons of these clips that earlier compilations made.
    pub(crate) fn comparisons(&self, clips: &[HumanClip]) -> ComparisonLog {
        let keys = clips.iter().filter_map(|clip| Some(clip.stored.as_ref()?.key));
        let earlier: Option<LoggedComparisons> = self.folder.get(&key::of_comparisons());
        ComparisonLog::of(keys, earlier.as_ref())
    }

    /// Stores the comparisons, and removes old results.
    pub(crate) fn close(&self, comparisons: &ComparisonLog) {
        if let Some(logged) = comparisons.logged_if_new() {
            self.folder.put(&key::of_comparisons(), &logged);
        }
        self.folder.remove_old();
    }

    fn origin(&self, clip: &HumanClip) -> Option<Origin> {
        let origins = self.origins.lock().unwrap_or_else(PoisonError::into_inner);
        origins.get(&clip.stored.as_ref()?.key).cloned()
    }
}

impl StoredClip {
    /// An imported clip with its key and its signature; `None` for a rejected one.
    fn of(ImportedClip { file, clip, outcome }: ImportedClip, key: &Digest, index: usize) -> Option<Self> {
        let mut human = outcome.ok()?;
        let signature = signature::rows(&human);
        let (key, count, digest) = (key::of_clip(key, index), human.frames.len(), human.digest());
        human.stored = Some(StoredFrames { key, count, digest });
        Some(Self { file, clip, human, signature })
    }
}

impl Origin {
    /// The frames of the clip, imported again; `None` where the file is no longer the same.
    fn frames(&self, stored: &StoredFrames) -> Option<Vec<HumanPose>> {
        let human = import_with_settings(&self.settings).ok()?.into_iter().nth(self.index)?.outcome.ok()?;
        (human.digest() == stored.digest).then_some(human.frames)
    }

    fn changed(&self) -> Rejection {
        let problem = "the file changed during the compilation".to_owned();
        let file = self.settings.path.display().to_string();
        Rejection { file, clip: String::new(), reason: RejectionReason::ReadFailed { problem } }
    }
}
