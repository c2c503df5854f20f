//! Invariants of lengths, indices and names. All other invariants are based on these.

use crate::body::skeleton::JOINT_COUNT;
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};
use crate::validate::{CheckResult, each, ensure};

/// There is at least one example.
pub(crate) fn has_examples(db: &MotionDb) -> CheckResult {
    ensure(!db.examples.is_empty(), || "the database holds no example".into())
}

/// Every example has all its rows.
pub(crate) fn rows_are_complete(db: &MotionDb) -> CheckResult {
    let rows = db.examples.len() * PHASE_COUNT;
    let lengths = [db.rows.rotations.len(), db.rows.pelvis_m.len(), db.rows.contacts.len()];
    let expected = [rows * JOINT_COUNT, rows, rows];
    ensure(lengths == expected, || {
        format!("rotations, pelvis and contacts have {lengths:?} entries; the examples need {expected:?}")
    })
}

/// All indices in examples, simplices and correspondences exist.
pub(crate) fn indices_are_in_range(db: &MotionDb) -> CheckResult {
    let examples = db.examples.len();
    each(db, |_, example| {
        ensure((example.source as usize) < db.sources.len(), || format!("its source {} does not exist", example.source))
    })?;
    ensure(db.blend_space.dimension <= 3, || format!("the blend space has {} dimensions", db.blend_space.dimension))?;
    let corners = db.blend_space.dimension as usize + 1;
    let indices = &db.blend_space.simplices;
    ensure(!indices.is_empty() && indices.len().is_multiple_of(corners), || {
        format!("simplices have {corners} corners each, but {} are stored", indices.len())
    })?;
    let pair = db.correspondence.iter().flat_map(|found| [found.semi_procedural, found.blending]);
    match indices.iter().copied().chain(pair).find(|&index| index as usize >= examples) {
        Some(index) => Err(format!("there is an index {index}, but there are only {examples} examples")),
        None => Ok(()),
    }
}

/// Examples are sorted by name, and no name occurs twice.
pub(crate) fn names_are_unique(db: &MotionDb) -> CheckResult {
    match db.examples.windows(2).find(|pair| pair[0].name >= pair[1].name) {
        Some(pair) => Err(format!(
            "example names are not sorted or not unique: `{}` is followed by `{}`",
            pair[0].name, pair[1].name
        )),
        None => Ok(()),
    }
}
