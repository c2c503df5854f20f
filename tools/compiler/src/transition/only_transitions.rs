//! Notes on clips that give transitions and no example, because they hold no steady gait.

use motiondb::diagnostic::{Diagnostic, Note, Unfit};
use motiondb::motion::{ActionKind, SourceRecord};

use crate::action::joined_action::JoinedAction;

/// Turns the reason why a clip shows no steady gait into a note where the clip gives a transition.
pub(crate) fn note_only_transitions(sources: &mut [SourceRecord], actions: &[JoinedAction]) {
    for action in actions.iter().filter(|action| action.kind != ActionKind::Idle) {
        for diagnostic in &mut sources[action.source as usize].diagnostics {
            if let Diagnostic::NoExample(reason) = diagnostic
                && lacks_steady_gait(reason)
            {
                *diagnostic = Diagnostic::Note(Note::OnlyTransitionsUsed { reason: reason.clone() });
            }
        }
    }
}

fn lacks_steady_gait(reason: &Unfit) -> bool {
    matches!(reason, Unfit::NoStep | Unfit::NoWholeStride | Unfit::StridesUneven { .. })
}
