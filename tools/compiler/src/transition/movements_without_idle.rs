//! Movements between rest and steps that give no transition, since no clip of the style stands: the record of their clip
//! names them.

use motiondb::diagnostic::{Diagnostic, Note};
use motiondb::motion::SourceRecord;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::gait::movements::{Movement, MovementKind};
use crate::retarget::human_clip::HumanClip;

/// Adds a note to the record of each clip that has such movements. Where `max_examples` leaves out the one that stands,
/// another note says so.
pub(crate) fn note_movements_without_idle(
    sources: &mut [SourceRecord],
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
) {
    if analyzed.iter().flat_map(|found| &found.windows).any(|window| window.standing().is_some()) {
        return;
    }
    for ((source, clip), found) in sources.iter_mut().zip(clips).zip(analyzed) {
        let movements = apart(&found.movements);
        let Some(first) = movements.first() else { continue };
        source.diagnostics.push(Diagnostic::Note(Note::MovementsWithoutIdle {
            movements: movements.len() as u32,
            first_s: found.in_file_s(clip, *first).map(|time_s| time_s as f32),
        }));
    }
}

/// First and last frames of as many movements from or to rest as do not overlap, each in its shortest cut.
fn apart(movements: &[Movement]) -> Vec<[f64; 2]> {
    let needs_rest = |movement: &&Movement| movement.kind != MovementKind::Pivot;
    let mut all: Vec<[f64; 2]> = movements.iter().filter(needs_rest).map(|movement| movement.cuts[0]).collect();
    all.sort_by(|a, b| a[1].total_cmp(&b[1]));
    let mut apart: Vec<[f64; 2]> = Vec::new();
    for frames in all {
        if apart.last().is_none_or(|before| frames[0] >= before[1]) {
            apart.push(frames);
        }
    }
    apart
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{SyntheticWalk, database_of, idle, performance, walk};

    /// Number of movements in the notes on a body that stands, walks and stands, with so many examples at most.
    fn movements(rest_s: f64, max_examples: usize) -> Vec<u32> {
        let walks = walk("part", SyntheticWalk { duration_s: 4.0, ..SyntheticWalk::at(1.1, 0.0, 0.0) });
        let db =
            database_of(vec![performance("capture", &[idle("a", rest_s), walks, idle("b", rest_s)])], max_examples);
        let notes = db.sources[0].diagnostics.iter();
        let count = |found: &Diagnostic| match found {
            Diagnostic::Note(Note::MovementsWithoutIdle { movements, .. }) => Some(*movements),
            _ => None,
        };
        notes.filter_map(count).collect()
    }

    #[test]
    fn starts_and_stops_of_a_set_that_never_stands_long_are_named() {
        assert_eq!([movements(0.5, 0), movements(3.0, 0), movements(3.0, 1)], [vec![2], vec![], vec![]]);
    }
}
