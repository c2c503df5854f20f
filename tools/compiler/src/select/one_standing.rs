//! NamedCycles → those of which one stands: the standing example of a set. Its other rests are idles alone.

use motiondb::diagnostic::{Diagnostic, Note};

use crate::action::cut_action::CutAction;
use crate::retarget::human_clip::HumanBody;
use crate::select::named_cycles::SelectedCycles;

/// Of the cycles that stand keeps the one with the fewest flaws, by window and posture. A source of another one gets a note
/// unless it gives an idle.
pub(crate) fn one_standing(mut selected: SelectedCycles, idles: &[CutAction], body: &HumanBody) -> SelectedCycles {
    let cycles = &selected.cycles;
    let standing = (0..cycles.len()).filter(|&index| !cycles[index].cycle.steps);
    let ranked: Vec<(usize, f64)> = standing.map(|index| (index, cycles[index].rank(body))).collect();
    let Some(&(best, _)) = ranked.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else { return selected };
    let gives_idle = |source: u32| idles.iter().any(|idle| idle.source == source);
    let others = ranked.iter().filter(|(index, _)| *index != best).map(|(index, _)| &cycles[*index]);
    for other in others.filter(|other| !gives_idle(other.source)) {
        let note = Note::CoincidentExample { example: other.name.clone(), blended: cycles[best].name.clone() };
        selected.sources[other.source as usize].diagnostics.push(Diagnostic::Note(note));
    }
    let mut index = 0..;
    selected.cycles.retain(|named| index.next() == Some(best) || named.cycle.steps);
    selected
}

#[cfg(test)]
mod tests {
    use motiondb::diagnostic::{Diagnostic, Note};

    use crate::synthetic::{SyntheticWalk, database_of, swaying, walk};

    #[test]
    fn of_several_idles_one_is_the_standing_example() {
        let walk = walk("walk", SyntheticWalk::default());
        let db = database_of(vec![swaying("wait", 4.0, 1.7), swaying("wait_long", 9.0, 2.9), walk], 0);
        let names: Vec<&str> = db.examples.iter().map(|example| example.name.as_str()).collect();
        assert_eq!(names, ["wait_long", "walk"]);
        assert_eq!(db.idles().count(), 2);
    }

    #[test]
    fn a_standing_clip_that_gives_neither_example_nor_idle_is_noted() {
        let clips = (0..10).map(|index| swaying(&format!("idle{index}"), 5.0, 1.0 + 0.17 * f64::from(index))).collect();
        let db = database_of(clips, 0);
        let is_noted = |found: &Diagnostic| matches!(found, Diagnostic::Note(Note::CoincidentExample { .. }));
        let noted = db.sources.iter().filter(|source| source.diagnostics.iter().any(is_noted)).count();
        assert_eq!((db.examples.len(), db.idles().count(), noted), (1, 8, 2));
    }
}
