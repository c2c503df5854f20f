//! Manifest → the set of clips that is compiled: every clip that it names, imported in parallel, in the order of a
//! database and each with a name of its own; and whatever is none, with the reason.

use rayon::prelude::*;

use crate::error::ImportError;
use crate::import::{self, Import};
use crate::input::clip_settings::Take;
use crate::input::manifest::Manifest;
use crate::input::manifest::error::ManifestError;
use crate::input::unique_names;
use crate::progress::{Event, Observer};
use crate::refused::Refused;
use crate::retarget::human_clip::HumanClip;

/// The human clips of a manifest, and each file or clip that gives none; both in order of file name.
///
/// # Errors
/// Where the manifest says of a clip what is not so.
pub fn import(manifest: &Manifest, tell: &Observer) -> Result<(Vec<HumanClip>, Vec<Refused>), ManifestError> {
    tell(Event::Stage("import"));
    let import = |take: &Take| {
        let import = import::import_take(take);
        tell(Event::Imported(&take.path));
        import
    };
    let imports: Vec<Result<Vec<Import>, ImportError>> = manifest.takes.par_iter().map(import).collect();
    let (mut clips, mut refused) = (Vec::new(), Vec::new());
    for (take, import) in manifest.takes.iter().zip(imports) {
        let file = take.path.display().to_string();
        let found = import.unwrap_or_else(|error| {
            refused.push(Refused { file: file.clone(), clip: String::new(), reason: error.reason() });
            Vec::new()
        });
        for Import { clip, outcome, .. } in found {
            match outcome {
                Ok(human) => clips.push(human),
                Err(refusal) => {
                    refused.push(Refused { file: file.clone(), clip, reason: manifest.reason(take, refusal)? });
                }
            }
        }
    }
    sort(&mut clips);
    manifest.choose(&mut clips)?;
    Ok((clips, refused))
}

/// Into the order of a database, which no folder and no argument changes: files of one name go by what they hold. Clips
/// of one name are told apart in that order.
pub(crate) fn sort(clips: &mut [HumanClip]) {
    let names = |clip: &HumanClip| (clip.source.file.clone(), clip.source.clip.clone(), clip.name.clone());
    clips.sort_by(|a, b| names(a).cmp(&names(b)).then_with(|| a.by_content(b)));
    unique_names::tell_apart(clips.iter_mut().map(|clip| &mut clip.name));
}
