//! SelectedCycles → MotionDb: parameters, blend space, velocity sets, rows, correspondence.
//!
//! Cycles enter in the order of the examples; records are those of all sources. See [`MotionDb`] for units and frames.

use motiondb::motion::{Correspondence, ExtraMotion, MotionDb, MotionExample, Parameters};
use motiondb::velocity_sets::velocity_hull::{self, Construction};

use crate::action::joined_action::JoinedAction;
use crate::database::actions::actions as stored_actions;
use crate::database::coincident_examples::{blend_space_of_best, coincident_pairs, note_coincident};
use crate::database::example::motion_example;
use crate::database::rows::rows;
use crate::database::skeleton::skeleton;
use crate::progress::{CompileEvent, Observer};
use crate::retarget::human_clip::HumanBody;
use crate::select::named_cycles::SelectedCycles;

/// The database of cycles sorted by name; it may still be invalid.
///
/// # Steps
/// 1. (v_f, ω_t, ω_s), key times and slide of each example.
/// 2. Blend space; the best of coincident examples is its corner.
/// 3. Skeleton, velocity sets, rows, actions.
/// 4. m_sp, m_mb and correspondence times.
pub(crate) fn assemble(
    selected: SelectedCycles,
    actions: &[JoinedAction],
    body: &HumanBody,
    construction: Construction,
    observer: &Observer,
) -> MotionDb {
    let SelectedCycles { cycles, mut sources } = selected;
    observer(CompileEvent::Stage("parameters"));
    let examples: Vec<MotionExample> = cycles.iter().map(|named| motion_example(named, body)).collect();
    let parameters: Vec<Parameters> = examples.iter().map(|example| example.parameters).collect();
    observer(CompileEvent::Stage("blend space"));
    let flaws: Vec<f64> = cycles.iter().map(|named| named.rank(body)).collect();
    let blend_space = blend_space_of_best(&parameters, &flaws);
    note_coincident(&coincident_pairs(&parameters, &blend_space), &cycles, body, &mut sources);
    observer(CompileEvent::Stage("assembly"));
    let action_poses = actions.iter().flat_map(|action| &action.frames).map(|frame| &frame.pose);
    let mut db = MotionDb {
        extra: ExtraMotion::default(),
        style: String::new(),
        further_styles: Vec::new(),
        skeleton: skeleton(body, cycles.iter().flat_map(|named| &named.cycle.rows).chain(action_poses)),
        correspondence: None,
        actions: cycles.first().map_or_else(Vec::new, |first| stored_actions(actions, &first.cycle.rows[0])),
        velocity_hull: velocity_hull::build(&parameters, construction),
        rows: rows(cycles.iter().map(|named| &named.cycle)),
        blend_space,
        examples,
        sources,
    };
    observer(CompileEvent::Stage("correspondence times"));
    let base_walk = cycles.iter().position(|named| named.choices.is_semi_procedural);
    db.correspondence = base_walk.and_then(|example| Correspondence::of(&db, example));
    db
}
