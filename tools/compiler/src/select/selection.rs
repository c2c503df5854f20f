//! Which steady windows become examples: of near-equal ones the best, and of all at most so many.
//!
//! 1. Of the windows of one clip that lie in one cell of a grid in (v_f, ω_t, ω_s) the one with the fewest flaws stays:
//!    least open between its ends, least slide, closest to the cell's middle, mean of the most strides. The longest of
//!    what stays is the clip's own example, whatever else the set holds: the user gave it.
//! 2. What else a clip holds must add to the set: by its flaws, the best first, a window stays that is near-equal to no
//!    example so far.
//! 3. Of a limited number, m_sp, one that stands and the ends of the set come first, so that it reaches as far as it
//!    can; then whatever lies farthest from all that is kept and its mirrors. Distances: axes divided by their ranges.

use std::f64::consts::PI;
use std::num::NonZeroUsize;

use glam::DVec3;
use motiondb::diagnostic::{Diagnostic, Note};
use motiondb::motion::SourceRecord;

use crate::cycle::analysis::{Analyzed, LeftOut, Motion, SteadyWindow};
use crate::cycle::foot_slide;
use crate::cycle::mean_stride::{GaitCycle, NamedCycle};
use crate::database::correspondence;
use crate::gait::stride::{STRIDE_GAP_M, Stride};
use crate::ground::arc::Rates;
use crate::retarget::human_clip::HumanBody;

/// A cell of the grid: twice what strides of one steady window may differ from their mean ([`crate::gait::steady_window`]).
/// Two windows of one cell say no more than two strides of one window.
const CELL_SPEED_MPS: f64 = 0.25;
const CELL_TURN_RAD_S: f64 = 30.0 * PI / 180.0;
/// A rest of this length is as good as a lone stride.
const REST_S: f64 = 1.0;

/// The flaws of a mean stride, a term each for what it leaves open before it is closed, for slide, for its distance
/// from the cell's middle and for the strides that it is not the mean of; each is 1 where it could hardly be worse.
pub(crate) fn flaws_of_strides(strides: &[Stride], cycle: &GaitCycle, body: &HumanBody) -> f64 {
    let count = strides.len() as f64;
    let gap_m = strides.iter().map(|stride| stride.gap_m).sum::<f64>() / count;
    gap_m / STRIDE_GAP_M + foot_slide::relative_slide(cycle, body) + off_middle(&cycle.rates) + 1.0 / count
}

/// The distance from the cell's middle, 1 at its border.
pub(crate) fn off_middle(rates: &Rates) -> f64 {
    2.0 * (in_cells(rates) - cell(rates)).abs().max_element()
}

/// The flaws of a rest: the longer, the calmer its calmest part.
pub(crate) fn flaws_of_rest(duration_s: f64) -> f64 {
    REST_S / duration_s
}

/// Keeps the first window and of the others those that are beyond doubt, and of each cell the best. They stay in their
/// order, the longest first.
pub(crate) fn keep_best(windows: &mut Vec<SteadyWindow>) -> LeftOut {
    let found = windows.len();
    let mut index = 0..;
    windows.retain(|window| index.next() == Some(0) || !window.is_doubtful);
    let clean = windows.len();
    let cells: Vec<(bool, DVec3)> = windows.iter().map(|window| (is_standing(window), cell(&window.rates()))).collect();
    let flaws: Vec<f64> = windows.iter().map(|window| window.flaws).collect();
    let is_best = |index: usize| {
        let rivals = (0..clean).filter(|other| cells[*other] == cells[index]);
        rivals.min_by(|a, b| flaws[*a].total_cmp(&flaws[*b])) == Some(index)
    };
    let mut index = 0..;
    windows.retain(|_| index.next().is_some_and(is_best));
    LeftOut { doubtful: found - clean, near_equal: clean - windows.len() }
}

/// Drops of all clips the windows that add nothing to the set; counts them.
pub(crate) fn keep_what_adds(clips: &mut [Analyzed]) {
    let mut kept: Vec<[usize; 2]> =
        (0..clips.len()).filter(|&clip| !clips[clip].windows.is_empty()).map(|clip| [clip, 0]).collect();
    let mut others: Vec<[usize; 2]> =
        (0..clips.len()).flat_map(|clip| (1..clips[clip].windows.len()).map(move |window| [clip, window])).collect();
    let window = |[clip, window]: [usize; 2]| &clips[clip].windows[window];
    others.sort_by(|a, b| window(*a).flaws.total_cmp(&window(*b).flaws).then(a.cmp(b)));
    for other in others {
        if !kept.iter().any(|kept| near_equal(window(*kept), window(other))) {
            kept.push(other);
        }
    }
    kept.sort_unstable();
    for (clip, analyzed) in clips.iter_mut().enumerate() {
        let found = analyzed.windows.len();
        let mut index = 0..;
        analyzed.windows.retain(|_| index.next().is_some_and(|window| kept.binary_search(&[clip, window]).is_ok()));
        analyzed.left_out.near_equal += found - analyzed.windows.len();
    }
}

fn is_standing(window: &SteadyWindow) -> bool {
    matches!(window.motion, Motion::Stands(_))
}

fn near_equal(a: &SteadyWindow, b: &SteadyWindow) -> bool {
    is_standing(a) == is_standing(b) && near_equal_rates(&a.rates(), &b.rates())
}

/// Whether rates differ by no more than half a cell in every axis, wherever the cells' borders lie.
pub(crate) fn near_equal_rates(a: &Rates, b: &Rates) -> bool {
    (in_cells(a) - in_cells(b)).abs().max_element() <= 0.5
}

fn in_cells(rates: &Rates) -> DVec3 {
    let cells = DVec3::new(CELL_SPEED_MPS, CELL_TURN_RAD_S, CELL_SPEED_MPS);
    DVec3::new(rates.speed_mps, rates.turn_rate_rad_s, rates.strafe_mps) / cells
}

/// The middle of the cell of some rates. Straight ahead and standing are middles.
fn cell(rates: &Rates) -> DVec3 {
    in_cells(rates).round()
}

/// Keeps at most so many cycles; the sources of the others have a note.
pub(crate) fn limit(cycles: &mut Vec<NamedCycle>, most: Option<NonZeroUsize>, sources: &mut [SourceRecord]) {
    let Some(most) = most.map(NonZeroUsize::get).filter(|most| *most < cycles.len()) else { return };
    let keeps = spread(cycles, most);
    let mut index = 0..;
    cycles.retain(|named| {
        let keep = index.next().is_some_and(|index: usize| keeps.contains(&index));
        if !keep {
            let left_out = Note::ExampleLeftOut { example: named.name.clone(), max_examples: most as u32 };
            sources[named.source as usize].diagnostics.push(Diagnostic::Note(left_out));
        }
        keep
    });
}

/// So many of the cycles: m_sp, one that stands, the ends of the set, then the rest, each time the one farthest from
/// all before and their mirrors.
fn spread(cycles: &[NamedCycle], most: usize) -> Vec<usize> {
    let places = normalised(cycles);
    let ends = ends(&places);
    let first = [semi_procedural(cycles), best(cycles, |named| !named.cycle.steps)].into_iter().flatten();
    let mut kept = Vec::new();
    let mut is_kept = vec![false; cycles.len()];
    let mut gaps = vec![f64::INFINITY; cycles.len()];
    let mut first = first.take(most).collect::<Vec<usize>>().into_iter();
    while kept.len() < most {
        let farthest = |pool: &dyn Fn(usize) -> bool| {
            let left = (0..cycles.len()).filter(|&index| !is_kept[index] && pool(index));
            // The first of the farthest: `max_by` alone would take the last.
            left.rev().max_by(|a, b| gaps[*a].total_cmp(&gaps[*b]).then(cycles[*b].flaws.total_cmp(&cycles[*a].flaws)))
        };
        let next = first.next().or_else(|| farthest(&|index| ends.contains(&index))).or_else(|| farthest(&|_| true));
        let Some(next) = next else { break };
        kept.push(next);
        is_kept[next] = true;
        for (gap, place) in gaps.iter_mut().zip(&places) {
            *gap = gap.min(place.distance(places[next])).min(place.distance(mirrored(places[next])));
        }
    }
    kept
}

/// The manifest's m_sp, else the one that the compiler would take.
fn semi_procedural(cycles: &[NamedCycle]) -> Option<usize> {
    let stepping: Vec<usize> = (0..cycles.len()).filter(|index| cycles[*index].cycle.steps).collect();
    let rates: Vec<Rates> = stepping.iter().map(|&index| cycles[index].cycle.rates).collect();
    let chosen = cycles.iter().position(|named| named.choices.is_semi_procedural);
    chosen.or_else(|| correspondence::semi_procedural(&rates).map(|index| stepping[index]))
}

/// The cycle with the fewest flaws of those that are meant.
fn best(cycles: &[NamedCycle], meant: impl Fn(&NamedCycle) -> bool) -> Option<usize> {
    let indices = (0..cycles.len()).filter(|index| meant(&cycles[*index]));
    indices.min_by(|a, b| cycles[*a].flaws.total_cmp(&cycles[*b].flaws))
}

/// (v_f, ω_t, ω_s) of each cycle, divided by the ranges over all of them and their mirrors; 0 where all lie within a
/// cell, which is no range.
fn normalised(cycles: &[NamedCycle]) -> Vec<DVec3> {
    let places: Vec<DVec3> = cycles.iter().map(|named| in_cells(&named.cycle.rates)).collect();
    let both = || places.iter().flat_map(|place| [*place, mirrored(*place)]);
    let ranges = both().fold(DVec3::NEG_INFINITY, DVec3::max) - both().fold(DVec3::INFINITY, DVec3::min);
    let scale = ranges.map(|range| if range > 1.0 { 1.0 / range } else { 0.0 });
    places.iter().map(|place| *place * scale).collect()
}

fn mirrored(place: DVec3) -> DVec3 {
    place * DVec3::new(1.0, -1.0, -1.0)
}

/// The cycles that go farthest, themselves or by their mirrors, in any of 26 directions: along the axes and between
/// them.
fn ends(places: &[DVec3]) -> Vec<usize> {
    let has_range = |axis: usize| places.iter().any(|place| place[axis] != 0.0);
    let signs = |axis: usize| if has_range(axis) { &[-1.0, 0.0, 1.0][..] } else { &[0.0] };
    let directions = signs(0)
        .iter()
        .flat_map(|&x| signs(1).iter().flat_map(move |&y| signs(2).iter().map(move |&z| DVec3::new(x, y, z))));
    let farthest = |direction: DVec3| {
        let reach = |index: usize| places[index].dot(direction).max(mirrored(places[index]).dot(direction));
        // The first of the farthest: `max_by` alone would take the last.
        (0..places.len()).rev().max_by(|a, b| reach(*a).total_cmp(&reach(*b)))
    };
    directions.filter(|direction| *direction != DVec3::ZERO).filter_map(farthest).collect()
}

#[cfg(test)]
mod tests {
    use motiondb::motion::{MotionDb, MotionExample};

    use super::*;
    use crate::retarget::human_clip::HumanClip;
    use crate::synthetic::{Walk, idle, performance, walk};
    use crate::{Options, compile};

    fn walking(speed_mps: f64, turn_rate_rad_s: f64, duration_s: f64) -> HumanClip {
        let rates = Rates { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 };
        walk("part", Walk { rates, duration_s, ..Walk::default() })
    }

    /// Another walk of that name, with a cadence of its own: no second copy of the same take.
    fn named(name: &str, speed_mps: f64, turn_rate_rad_s: f64, period_s: f64) -> HumanClip {
        let rates = Rates { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 };
        walk(name, Walk { rates, period_s, ..Walk::default() })
    }

    fn compiled(clips: Vec<HumanClip>, most: usize) -> MotionDb {
        let options = Options { max_examples: NonZeroUsize::new(most), ..Options::default() };
        compile(clips, &options, &|_| ()).unwrap()
    }

    fn recorded(db: &MotionDb) -> Vec<&MotionExample> {
        db.examples.iter().filter(|example| !example.mirrored).collect()
    }

    fn check(example: &MotionExample, name: &str, parameters: [f32; 3], window_s: [f32; 2]) {
        assert_eq!(example.name, name);
        let found = example.parameters.to_vec3().to_array();
        assert!(found.iter().zip(parameters).all(|(found, wanted)| (found - wanted).abs() < 0.04), "{example:?}");
        let [start_s, end_s] = example.window_s;
        assert!(start_s >= window_s[0] - 0.1 && end_s <= window_s[1] + 0.1, "{example:?}");
        assert!(end_s - start_s > 0.4 * (window_s[1] - window_s[0]), "{example:?}");
    }

    #[test]
    fn a_performance_gives_an_example_of_each_steady_part_named_by_its_second() {
        let parts = [walking(0.7, 0.0, 6.0), idle("part", 3.0), walking(1.3, 0.0, 5.0), walking(0.8, 0.8, 4.0)];
        let db = compiled(vec![performance("capture", &parts)], 0);
        let [slow, rest, fast, turn] = recorded(&db)[..] else { panic!("{:#?}", db.examples) };
        check(slow, "capture", [0.7, 0.0, 0.0], [0.0, 6.0]);
        check(rest, &format!("capture@{:04.1}s", rest.window_s[0]), [0.0; 3], [6.0, 9.0]);
        check(fast, &format!("capture@{:04.1}s", fast.window_s[0]), [1.3, 0.0, 0.0], [9.0, 14.1]);
        check(turn, &format!("capture@{:04.1}s", turn.window_s[0]), [0.8, 0.8, 0.0], [14.0, 18.1]);
        assert_eq!(rest.key_times_s, None);
        assert!(db.examples.iter().any(|example| example.name == format!("{}_mirrored", turn.name)));
    }

    /// A walk at 1.2 m/s whose root gets ahead of its feet.
    fn sliding(duration_s: f64) -> HumanClip {
        let mut clip = walking(1.2, 0.0, duration_s);
        let ahead_m = clip.frames[1].pelvis_m - clip.frames[0].pelvis_m;
        let ahead_m = ahead_m.with_z(0.0).normalize() * 0.1 / clip.frame_rate_hz;
        clip.frames.iter_mut().enumerate().for_each(|(frame, pose)| pose.pelvis_m += ahead_m * frame as f64);
        clip
    }

    #[test]
    fn of_near_equal_windows_the_one_with_the_fewest_flaws_stays() {
        let between = walking(0.7, 0.9, 4.0);
        for parts in
            [[walking(1.2, 0.0, 4.0), between.clone(), sliding(5.0)], [sliding(5.0), between, walking(1.2, 0.0, 4.0)]]
        {
            let db = compiled(vec![performance("capture", &parts)], 0);
            let straight: Vec<_> = recorded(&db).into_iter().filter(|e| e.parameters.turn_rate_rad_s == 0.0).collect();
            assert_eq!(straight.len(), 1, "{straight:#?}");
            assert!(straight[0].planted_slide_cm_s < 2.0, "{straight:?}");
            let left_out = Diagnostic::Note(Note::WindowsLeftOut { near_equal: 1, doubtful: 0 });
            assert!(db.sources[0].diagnostics.contains(&left_out), "{:?}", db.sources);
        }
    }

    #[test]
    fn clips_keep_their_own_examples_but_windows_beyond_them_must_add_to_the_set() {
        let capture = performance("capture", &[walking(1.2, 0.0, 6.0), walking(0.7, 0.9, 4.0)]);
        let clips = [named("walk", 1.2, 0.0, 1.0), named("same", 1.25, 0.0, 1.2), named("turn", 0.7, 0.85, 1.0)];
        let db = compiled([capture].into_iter().chain(clips).collect(), 0);
        let names: Vec<&str> = recorded(&db).iter().map(|example| example.name.as_str()).collect();
        assert_eq!(names, ["capture", "same", "turn", "walk"]);
    }

    #[test]
    fn a_limited_set_keeps_the_walk_the_idle_and_what_reaches_farthest() {
        let speeds = [0.5, 0.7, 0.9, 1.1, 1.2, 1.3, 1.5];
        let mut clips: Vec<HumanClip> = speeds
            .iter()
            .map(|speed_mps| named(&format!("v{speed_mps}"), *speed_mps, 0.0, 1.5 - 0.4 * speed_mps))
            .collect();
        clips.extend([named("turn", 0.6, 0.9, 1.0), named("bend", 0.6, 0.5, 1.2)]);
        clips.push(idle("idle", 3.0));
        for (most, wanted) in [(1, &["v1.2"][..]), (2, &["idle", "v1.2"]), (4, &["idle", "turn", "v1.2", "v1.5"])] {
            let db = compiled(clips.clone(), most);
            let found: Vec<&str> = recorded(&db).iter().map(|example| example.name.as_str()).collect();
            assert_eq!(found, wanted);
            let is_left_out = |found: &&Diagnostic| matches!(found, Diagnostic::Note(Note::ExampleLeftOut { .. }));
            let left_out = db.sources.iter().flat_map(|source| &source.diagnostics).filter(is_left_out);
            assert_eq!(left_out.count(), 10 - most);
        }
        assert_eq!(recorded(&compiled(clips, 10)).len(), 10);
    }
}
