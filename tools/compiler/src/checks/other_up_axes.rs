//! Clips whose bodies stretch along another axis than the same rig walks upright in other clips. Alone, a body that lies
//! seems to stand along that axis, and one that jumps or climbs may seem to crawl.

use std::collections::{BTreeMap, BTreeSet};

use motiondb::diagnostic::Unfit;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::retarget::human_clip::HumanClip;
use crate::rig::rig_head::Rig;

/// Leaves out clips by the axes that are up where the same rig steps, if none of them is the clip's: a body that neither
/// steps nor moves otherwise lies; one that seems to crawl jumps or climbs. Their heads say nothing of the rig. A clip
/// whose manifest states `up` stays, and a crawl whose manifest takes any posture.
pub(crate) fn leave_out_other_up_axes(clips: &mut [HumanClip], analyzed: &mut [AnalyzedClip]) {
    let steps = |found: &AnalyzedClip| found.windows.iter().any(|window| window.stepping().is_some());
    let mut up_axes: BTreeMap<(Rig, String), BTreeSet<String>> = BTreeMap::new();
    for (clip, _) in clips.iter().zip(&*analyzed).filter(|(clip, found)| steps(found) && !clip.seems_to_crawl) {
        if let Some(rig) = rig(clip) {
            up_axes.entry(rig).or_default().insert(clip.source.up_axis.clone());
        }
    }
    for (clip, found) in clips.iter_mut().zip(analyzed) {
        let Some(walks) = rig(clip).and_then(|rig| up_axes.get(&rig)) else { continue };
        let is_stated = clip.choices.is_up_stated || clip.seems_to_crawl && clip.choices.takes_any_posture;
        if is_stated || walks.contains(&clip.source.up_axis) {
            continue;
        }
        let is_still = !steps(found) && found.movements.is_empty();
        let lies_down =
            || Unfit::LiesDown { found: clip.source.up_axis.clone(), walks: walks.iter().cloned().collect() };
        let reason = if clip.seems_to_crawl { Some(Unfit::MovesLengthwise) } else { is_still.then(lies_down) };
        if let Some(reason) = reason {
            found.leave_out(reason);
            clip.rig_head = None;
        }
    }
}

/// What tells the rigs of clips apart, and the axis along which their rest pose stands.
fn rig(clip: &HumanClip) -> Option<(Rig, String)> {
    clip.rig_head.as_ref().map(|head| (head.rig.clone(), head.rest_up.clone()))
}
