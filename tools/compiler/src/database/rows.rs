//! GaitCycles → the database's flat rows, every rotation in its joint's hemisphere, so that a blend is a weighted sum.
//!
//! Root frame: metres; f64 in, f32 out.

use motiondb::motion::Rows;

use crate::cycle::gait_cycle::GaitCycle;
use crate::ground::rotations::align_hemispheres;

/// Rows of all cycles in the order of the examples; the hemispheres are those of the first row.
pub(crate) fn rows<'a>(cycles: impl Iterator<Item = &'a GaitCycle> + Clone) -> Rows {
    let mut rows = Rows::default();
    let Some(reference) = cycles.clone().find_map(|cycle| cycle.rows.first()) else { return rows };
    for (row, contacts) in cycles.flat_map(|cycle| cycle.rows.iter().zip(&cycle.contacts)) {
        let mut rotations = row.rotations;
        align_hemispheres(&mut rotations, &reference.rotations);
        rows.rotations.extend(rotations.map(|rotation| rotation.as_quat()));
        rows.pelvis_m.push(row.pelvis_m.as_vec3());
        rows.contacts.push(contacts.map(|contact| contact.clamp(0.0, 1.0) as f32));
    }
    rows
}
