//! GaitCycles → the database's flat rows, every rotation in its joint's hemisphere, so that a blend is a weighted sum.

use motiondb::motion::Rows;

use crate::cycle::mean_stride::GaitCycle;
use crate::ground::root_motion::align_to;

/// Rows of all cycles in the order of the examples; hemispheres are those of the first row.
pub(crate) fn flatten(cycles: &[GaitCycle]) -> Rows {
    let mut rows = Rows::default();
    let Some(reference) = cycles.first().and_then(|cycle| cycle.rows.first()) else { return rows };
    for (row, contacts) in cycles.iter().flat_map(|cycle| cycle.rows.iter().zip(&cycle.contacts)) {
        let mut rotations = row.rotations;
        align_to(&mut rotations, &reference.rotations);
        rows.rotations.extend(rotations.map(|rotation| rotation.as_quat()));
        rows.pelvis_m.push(row.pelvis_m.as_vec3());
        rows.contacts.push(contacts.map(|contact| contact.clamp(0.0, 1.0) as f32));
    }
    rows
}
