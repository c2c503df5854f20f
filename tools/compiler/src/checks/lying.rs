//! Clips in which the body lies: alone, such a clip seems to stand along another axis. A rig that walks along one axis in
//! other clips shows which axis is up.

use std::collections::{BTreeMap, BTreeSet};

use motiondb::diagnostic::Unfit;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::retarget::human_clip::HumanClip;
use crate::rig::rig_head::Rig;

/// Leaves out clips in which the body lies: it neither steps nor moves otherwise, and stretches along none of the axes that
/// are up where the same rig steps. Their heads say nothing of the rig. A clip whose manifest states `up` stays.
pub(crate) fn leave_out_lying(clips: &mut [HumanClip], analyzed: &mut [AnalyzedClip]) {
    let steps = |found: &AnalyzedClip| found.windows.iter().any(|window| window.stepping().is_some());
    let mut up_axes: BTreeMap<(Rig, String), BTreeSet<String>> = BTreeMap::new();
    for (clip, _) in clips.iter().zip(&*analyzed).filter(|(_, found)| steps(found)) {
        if let Some(rig) = rig(clip) {
            up_axes.entry(rig).or_default().insert(clip.source.up_axis.clone());
        }
    }
    for (clip, found) in clips.iter_mut().zip(analyzed) {
        let Some(walks) = rig(clip).and_then(|rig| up_axes.get(&rig)) else { continue };
        let is_still = !steps(found) && found.movements.is_empty();
        if is_still && !clip.choices.is_up_stated && !walks.contains(&clip.source.up_axis) {
            let walks = walks.iter().cloned().collect();
            found.leave_out(Unfit::LiesDown { found: clip.source.up_axis.clone(), walks });
            clip.rig_head = None;
        }
    }
}

/// What tells the rigs of clips apart, and the axis along which their rest pose stands.
fn rig(clip: &HumanClip) -> Option<(Rig, String)> {
    clip.rig_head.as_ref().map(|head| (head.rig.clone(), head.rest_up.clone()))
}
