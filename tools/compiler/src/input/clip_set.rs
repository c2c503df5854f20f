//! Manifest → the set of clips to compile: each clip is imported, in parallel, and gets a unique name.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use crate::error::{CompileError, Rejection};
use crate::import::{self, ImportedClip, Importer};
use crate::input::clip_settings::ClipSettings;
use crate::input::manifest::Manifest;
use crate::input::rig_units::unify_units;
use crate::input::unique_names;
use crate::progress::{CompileEvent, Observer};
use crate::retarget::human_clip::HumanClip;

/// The clips of a manifest after import.
#[derive(Clone, Debug, Default)]
pub struct ClipSet {
    /// Clips of human motion, in the order of a database's sources.
    pub clips: Vec<HumanClip>,
    /// Files and clips that cannot be used, in order of file name.
    pub rejected: Vec<Rejection>,
}

impl ClipSet {
    /// Adds a rejection, unless the machine failed.
    fn reject(&mut self, rejection: Rejection) -> Result<(), CompileError> {
        if rejection.reason.is_of_machine() {
            return Err(CompileError::ClipUnread(Box::new(rejection)));
        }
        self.rejected.push(rejection);
        Ok(())
    }
}

/// Imports all clips of a manifest. A file that cannot be used is rejected and does not stop the others.
///
/// # Errors
/// [`CompileError::InvalidManifest`] if a clip contradicts the manifest; [`CompileError::ClipUnread`].
pub fn import_clip_set(manifest: &Manifest, observer: &Observer) -> Result<ClipSet, CompileError> {
    clip_set(manifest, &import::import_with_settings, observer)
}

/// As [`import_clip_set`], through an importer.
pub(crate) fn clip_set(manifest: &Manifest, importer: &Importer, observer: &Observer) -> Result<ClipSet, CompileError> {
    observer(CompileEvent::Stage("import"));
    let import = |settings: &ClipSettings| {
        let imported = importer(settings);
        observer(CompileEvent::Imported(&settings.path));
        imported
    };
    let mut imports: Vec<Result<Vec<ImportedClip>, Rejection>> = manifest.clips.par_iter().map(import).collect();
    unify_units(&manifest.clips, &mut imports, importer);
    let mut set = ClipSet::default();
    let styles = manifest.styles();
    for ((settings, style), imported) in manifest.clips.iter().zip(styles).zip(imports) {
        let imported = match imported {
            Ok(imported) => imported,
            Err(rejection) => {
                set.reject(rejection)?;
                continue;
            }
        };
        for ImportedClip { clip, outcome, .. } in imported {
            match outcome {
                Ok(human) => set.clips.push(HumanClip { style: style.clone(), ..human }),
                Err(reason) => {
                    manifest.check_reason(settings, &reason)?;
                    set.reject(Rejection { file: settings.path.display().to_string(), clip, reason })?;
                }
            }
        }
    }
    sort(&mut set.clips);
    manifest.mark_chosen(&mut set.clips)?;
    Ok(set)
}

/// Sorts clips into the order of a database's sources and makes their names unique.
///
/// Neither folders nor the order of arguments change the result: files of equal names are sorted by their style and
/// their content. Clips of one name in several styles have their style before it. A name that a manifest states goes to
/// the clip for which it is stated.
pub(crate) fn sort(clips: &mut [HumanClip]) {
    fn names(clip: &HumanClip) -> [&str; 4] {
        [&clip.source.file, &clip.source.clip, &clip.name, &clip.style]
    }
    clips.sort_by(|a, b| names(a).cmp(&names(b)));
    let of_one_name = clips.chunk_by_mut(|a, b| names(a) == names(b));
    of_one_name.filter(|clips| clips.len() > 1).for_each(|clips| clips.sort_by_cached_key(HumanClip::content_order));
    let mut styles_of_names: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for clip in clips.iter() {
        styles_of_names.entry(clip.name.clone()).or_default().insert(clip.style.clone());
    }
    for clip in clips.iter_mut().filter(|clip| !clip.style.is_empty()) {
        if styles_of_names.get(&clip.name).is_some_and(|styles| styles.len() > 1) {
            clip.name = format!("{} {}", clip.style, clip.name);
        }
    }
    let (stated, others): (Vec<_>, Vec<_>) = clips.iter_mut().partition(|clip| clip.choices.is_name_stated);
    unique_names::make_unique(stated.into_iter().chain(others).map(|clip| &mut clip.name));
}
