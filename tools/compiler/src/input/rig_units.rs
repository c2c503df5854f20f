//! One unit for each rig of a set. BVH files state none, and two clips of one rig may seem to have two units: a stroll
//! in feet seems to be in metres, a run in decimetres. The unit of a rig is
//! 1. the one that a manifest states for one of its clips; of several the first;
//! 2. the most frequent one; clips with a wrong frame time show no unit;
//! 3. on a tie the first in [`UNITS`].
//!
//! Two rigs are the same if the names of their joints and the lengths of their bones agree.

use std::collections::BTreeMap;

use motiondb::diagnostic::{Diagnostic, Unfit, Warning};
use rayon::prelude::*;

use crate::error::Rejection;
use crate::import::{ImportedClip, Importer};
use crate::input::clip_files::ClipFormat;
use crate::input::clip_settings::ClipSettings;
use crate::retarget::human_clip::HumanClip;
use crate::retarget::units::UNITS;
use crate::rig::rig_head::Rig;

/// Step of the logarithm of a leg's length that tells sizes of a rig apart: 2 %.
const SIZE_STEP: f64 = 0.02;

/// A rig, and the logarithm of its legs' length in the unit of its files, in steps.
type SizedRig = (Rig, i64);

/// What the clips of a rig show of its unit.
#[derive(Default)]
struct RigUnit {
    /// The unit that a manifest states for one of them, m.
    stated_m: Option<f64>,
    /// Number of clips that seem to have each of [`UNITS`].
    votes: [usize; UNITS.len()],
}

impl RigUnit {
    /// The unit of all clips, m; `None` where nothing shows it.
    fn unit_m(&self) -> Option<f64> {
        // The first of the greatest: `max_by_key` alone would take the last.
        let most = (0..UNITS.len()).rev().max_by_key(|&unit| self.votes[unit]);
        self.stated_m.or(most.filter(|&unit| self.votes[unit] > 0).map(|unit| UNITS[unit].0))
    }
}

/// Imports again, in the rig's unit, each BVH clip that was found in another unit. Where no manifest states the rig's unit,
/// the clip gets a warning.
pub(crate) fn unify_units(
    clips: &[ClipSettings],
    imports: &mut [Result<Vec<ImportedClip>, Rejection>],
    importer: &Importer,
) {
    let mut rigs: BTreeMap<SizedRig, RigUnit> = BTreeMap::new();
    for (settings, import) in clips.iter().zip(&*imports) {
        let Some(human) = bvh_clip(settings, import) else { continue };
        let Some(rig) = sized_rig(human) else { continue };
        let found = rigs.entry(rig).or_default();
        match settings.metres_per_unit {
            Some(stated_m) => found.stated_m = found.stated_m.or(Some(stated_m)),
            None if has_human_gait(human) => UNITS.iter().zip(&mut found.votes).for_each(|((unit_m, _), votes)| {
                *votes += usize::from(is_unit(human, *unit_m));
            }),
            None => (),
        }
    }
    clips.par_iter().zip(imports).for_each(|(settings, import)| {
        let Some(human) = bvh_clip(settings, import).filter(|_| settings.metres_per_unit.is_none()) else { return };
        let Some(rig) = sized_rig(human).and_then(|rig| rigs.get(&rig)) else { return };
        let Some(unit_m) = rig.unit_m() else { return };
        let alone_m = UNITS.into_iter().map(|(unit_m, _)| unit_m).find(|unit_m| is_unit(human, *unit_m));
        if !is_unit(human, unit_m) {
            *import = importer(&ClipSettings { metres_per_unit: Some(unit_m), ..settings.clone() });
            if let (None, Some(alone_m)) = (rig.stated_m, alone_m) {
                warn(import, alone_m);
            }
        }
    });
}

/// The clip of a BVH file.
fn bvh_clip<'a>(settings: &ClipSettings, import: &'a Result<Vec<ImportedClip>, Rejection>) -> Option<&'a HumanClip> {
    let is_bvh = ClipFormat::of(&settings.path) == Some(ClipFormat::Bvh);
    import.as_ref().ok()?.first()?.outcome.as_ref().ok().filter(|_| is_bvh)
}

fn sized_rig(human: &HumanClip) -> Option<SizedRig> {
    let leg_units = human.body.leg_length_m() / f64::from(human.source.metres_per_unit);
    Some((human.rig_head.as_ref()?.rig.clone(), libm::round(libm::log(leg_units) / SIZE_STEP) as i64))
}

fn is_unit(human: &HumanClip, unit_m: f64) -> bool {
    human.source.metres_per_unit == unit_m as f32
}

/// Whether the frame time of a clip, and with it the cadence that shows its unit, can be right.
fn has_human_gait(human: &HumanClip) -> bool {
    !matches!(human.unfit, Some(Unfit::InhumanGait { .. }))
}

/// Adds the warning that a clip alone seems to have another unit.
fn warn(import: &mut Result<Vec<ImportedClip>, Rejection>, other_unit_m: f64) {
    for ImportedClip { outcome, .. } in import.iter_mut().flatten() {
        let Ok(human) = outcome else { continue };
        let leg_m = human.body.leg_length_m();
        let other_leg_m = leg_m / f64::from(human.source.metres_per_unit) * other_unit_m;
        let [leg_m, other_leg_m] = [leg_m, other_leg_m].map(|length_m| length_m as f32);
        let doubt = Warning::UnitDoubtful { leg_m, other_leg_m, other_unit_m };
        human.source.diagnostics.push(Diagnostic::Warning(doubt));
    }
}
