//! Corners that are in no example and no transition: the record of their clip names them.

use motiondb::diagnostic::{Diagnostic, Note};
use motiondb::motion::SourceRecord;

use crate::action::joined_action::JoinedAction;
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::corners::{Corner, SHOWN_SHARE};

/// Adds a note to the record of each clip that has such corners.
pub(crate) fn note_unused_corners(sources: &mut [SourceRecord], analyzed: &[AnalyzedClip], actions: &[JoinedAction]) {
    for (index, (source, found)) in sources.iter_mut().zip(analyzed).enumerate() {
        let is_shown = |corner: &Corner| {
            let own = actions.iter().filter(|action| action.source as usize == index);
            own.into_iter().any(|action| corner.share_within(action.window_s) >= SHOWN_SHARE)
                || found.windows.iter().any(|window| corner.turns_alike(&window.rates()))
        };
        let unused: Vec<&Corner> = found.corners.iter().filter(|corner| !is_shown(corner)).collect();
        let sharpest = unused.iter().rev().max_by(|a, b| a.turn_rad.abs().total_cmp(&b.turn_rad.abs()));
        source.diagnostics.extend(sharpest.map(|corner| {
            Diagnostic::Note(Note::CornersUnused {
                window_s: corner.window_s.map(|time_s| time_s as f32),
                turn_rad: corner.turn_rad as f32,
                more: unused.len() as u32 - 1,
            })
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{SyntheticWalk, database_of, performance, walk};

    /// The notes on a walk of some turn rates (rad/s) and durations (s).
    fn notes(parts: &[(f64, f64)]) -> Vec<Note> {
        let part = |&(turn_rate_rad_s, duration_s): &(f64, f64)| {
            walk("part", SyntheticWalk { duration_s, ..SyntheticWalk::at(1.0, turn_rate_rad_s, 0.0) })
        };
        let parts: Vec<_> = parts.iter().map(part).collect();
        let db = database_of(vec![performance("capture", &parts)], 0);
        let notes = db.sources[0].diagnostics.iter();
        notes
            .filter_map(|found| match found {
                Diagnostic::Note(note @ Note::CornersUnused { .. }) => Some(note.clone()),
                _ => None,
            })
            .collect()
    }

    #[test]
    fn a_corner_at_the_end_of_a_clip_is_named() {
        let found = notes(&[(0.0, 4.0), (-1.4, 1.0)]);
        let [Note::CornersUnused { window_s: [from_s, to_s], turn_rad, more: 0 }] = found[..] else {
            panic!("{found:?}")
        };
        assert!((3.6..4.4).contains(&from_s) && to_s > 4.8, "{found:?}");
        assert!((-95.0..-60.0).contains(&turn_rad.to_degrees()), "{found:?}");
    }

    #[test]
    fn corners_that_examples_or_pivots_show_are_not_named() {
        assert_eq!(notes(&[(0.0, 4.0), (1.0, 5.0)]), []);
        assert_eq!(notes(&[(0.0, 4.0)]), []);
    }
}
