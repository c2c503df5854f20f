//! At most so many examples, so that the set still reaches as far as it can.
//!
//! m_sp, the cycle that stands and the ends of the set come first; then, each time, the cycle farthest from all that
//! are kept and from their mirrors. Distances: (v_f, ω_t, ω_s), each axis divided by its range (definition "Axes" of
//! `docs/definitions.md`).

use std::num::NonZeroUsize;

use glam::DVec3;
use motiondb::diagnostic::{Diagnostic, Note};

use crate::cycle::rate_cells::in_cells;
use crate::select::named_cycles::{NamedCycle, SelectedCycles, standing};

/// Keeps at most so many cycles, all without a limit; the sources of the others get a note.
pub(crate) fn limited_set(mut selected: SelectedCycles, max_examples: Option<NonZeroUsize>) -> SelectedCycles {
    let SelectedCycles { cycles, sources } = &mut selected;
    let Some(most) = max_examples.map(NonZeroUsize::get).filter(|most| *most < cycles.len()) else { return selected };
    let kept = farthest_reaching(cycles, most);
    let mut index = 0..;
    cycles.retain(|named| {
        let is_kept = index.next().is_some_and(|index: usize| kept.contains(&index));
        if !is_kept {
            let left_out = Note::ExampleLeftOut { example: named.name.clone(), max_examples: most as u32 };
            sources[named.source as usize].diagnostics.push(Diagnostic::Note(left_out));
        }
        is_kept
    });
    selected
}

/// Indices of so many cycles: m_sp, the one that stands, the ends of the set, then each time the cycle farthest from all
/// before and their mirrors; of several as far the one with the fewest flaws.
fn farthest_reaching(cycles: &[NamedCycle], most: usize) -> Vec<usize> {
    let points = normalised_rates(cycles);
    let ends = ends(&points);
    let base_walk = cycles.iter().position(|named| named.choices.is_semi_procedural);
    let first = [base_walk, standing(cycles)].into_iter().flatten();
    let mut kept = Vec::new();
    let mut is_kept = vec![false; cycles.len()];
    let mut gaps = vec![f64::INFINITY; cycles.len()];
    let mut first = first.take(most).collect::<Vec<usize>>().into_iter();
    while kept.len() < most {
        let farthest = |counts: &dyn Fn(usize) -> bool| {
            let left = (0..cycles.len()).filter(|&index| !is_kept[index] && counts(index));
            // The first of the farthest: `max_by` alone would take the last.
            left.rev().max_by(|a, b| gaps[*a].total_cmp(&gaps[*b]).then(cycles[*b].flaws.total_cmp(&cycles[*a].flaws)))
        };
        let next = first.next().or_else(|| farthest(&|index| ends.contains(&index))).or_else(|| farthest(&|_| true));
        let Some(next) = next else { break };
        kept.push(next);
        is_kept[next] = true;
        for (gap, point) in gaps.iter_mut().zip(&points) {
            *gap = gap.min(point.distance(points[next])).min(point.distance(mirrored(points[next])));
        }
    }
    kept
}

/// (v_f, ω_t, ω_s) of each cycle, divided by the ranges over all cycles and their mirrors; 0 on an axis on which all
/// lie within a cell, which does not count as a range.
fn normalised_rates(cycles: &[NamedCycle]) -> Vec<DVec3> {
    let points: Vec<DVec3> = cycles.iter().map(|named| in_cells(&named.cycle.rates)).collect();
    let both = || points.iter().flat_map(|point| [*point, mirrored(*point)]);
    let ranges = both().fold(DVec3::NEG_INFINITY, DVec3::max) - both().fold(DVec3::INFINITY, DVec3::min);
    let scale = ranges.map(|range| if range > 1.0 { 1.0 / range } else { 0.0 });
    points.iter().map(|point| *point * scale).collect()
}

fn mirrored(point: DVec3) -> DVec3 {
    point * DVec3::new(1.0, -1.0, -1.0)
}

/// Indices of the points that reach farthest, themselves or by their mirrors, in each of 26 directions: along the axes
/// and between them.
fn ends(points: &[DVec3]) -> Vec<usize> {
    let has_range = |axis: usize| points.iter().any(|point| point[axis] != 0.0);
    let signs = |axis: usize| if has_range(axis) { &[-1.0, 0.0, 1.0][..] } else { &[0.0] };
    let directions = signs(0)
        .iter()
        .flat_map(|&x| signs(1).iter().flat_map(move |&y| signs(2).iter().map(move |&z| DVec3::new(x, y, z))));
    let farthest = |direction: DVec3| {
        let reach = |index: usize| points[index].dot(direction).max(mirrored(points[index]).dot(direction));
        // The first of the farthest: `max_by` alone would take the last.
        (0..points.len()).rev().max_by(|a, b| reach(*a).total_cmp(&reach(*b)))
    };
    directions.filter(|direction| *direction != DVec3::ZERO).filter_map(farthest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::retarget::human_clip::HumanClip;
    use crate::synthetic::{SyntheticWalk, database_of, idle, recorded, walk};

    #[test]
    fn limited_set_keeps_walk_idle_and_farthest() {
        // Different cadences: no two of the clips are duplicates.
        let clip = |name: &str, speed_mps, turn_rate_rad_s, period_s| {
            walk(name, SyntheticWalk { period_s, ..SyntheticWalk::at(speed_mps, turn_rate_rad_s, 0.0) })
        };
        let speeds_mps = [0.5, 0.7, 0.9, 1.1, 1.2, 1.3, 1.5];
        let mut clips: Vec<HumanClip> =
            speeds_mps.iter().map(|speed| clip(&format!("v{speed}"), *speed, 0.0, 1.5 - 0.4 * speed)).collect();
        clips.extend([clip("turn", 0.6, 0.9, 1.0), clip("bend", 0.6, 0.5, 1.2), idle("idle", 3.0)]);
        for (most, kept) in [(1, &["v1.2"][..]), (2, &["idle", "v1.2"]), (4, &["idle", "turn", "v1.2", "v1.5"])] {
            let db = database_of(clips.clone(), most);
            let found: Vec<&str> = recorded(&db).iter().map(|example| example.name.as_str()).collect();
            assert_eq!(found, kept);
            let is_left_out = |found: &&Diagnostic| matches!(found, Diagnostic::Note(Note::ExampleLeftOut { .. }));
            let left_out = db.sources.iter().flat_map(|source| &source.diagnostics).filter(is_left_out);
            assert_eq!(left_out.count(), 10 - most);
        }
        assert_eq!(recorded(&database_of(clips, 10)).len(), 10);
    }
}
