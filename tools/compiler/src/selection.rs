//! Which steady windows become examples: of near-equal ones the best (issue 3), and of all at most so many.
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
use motiondb::motion_db::SourceRecord;

use crate::analysis::{Analyzed, LeftOut, Motion, SteadyWindow};
use crate::arc::Rates;
use crate::correspondence;
use crate::cycle::{GaitCycle, NamedCycle};
use crate::foot_slide;
use crate::human_clip::HumanBody;
use crate::stride::{STRIDE_GAP_M, Stride};

/// A cell of the grid: twice what strides of one steady window may differ from their mean ([`crate::steady_window`]). Two
/// windows of one cell say no more than two strides of one window.
const CELL_SPEED_MPS: f64 = 0.25;
const CELL_TURN_RAD_S: f64 = 30.0 * PI / 180.0;
/// A rest of this length is as good as a lone stride.
const REST_S: f64 = 1.0;

/// The flaws of a mean stride, a term each for what it leaves open before it is closed, for slide, for its distance from
/// the cell's middle and for the strides that it is not the mean of; each is 1 where it could hardly be worse.
pub(crate) fn flaws_of_strides(strides: &[Stride], cycle: &GaitCycle, body: &HumanBody) -> f64 {
    let count = strides.len() as f64;
    let gap_m = strides.iter().map(|stride| stride.gap_m).sum::<f64>() / count;
    let off = in_cells(&cycle.rates) - cell(&cycle.rates);
    let slide = foot_slide::measure(cycle, body).slide_cm_s / foot_slide::suspect_slide_cm_s(cycle);
    gap_m / STRIDE_GAP_M + slide + 2.0 * off.abs().max_element() + 1.0 / count
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

/// Whether two windows differ by no more than half a cell in every axis, wherever the cells' borders lie.
fn near_equal(a: &SteadyWindow, b: &SteadyWindow) -> bool {
    is_standing(a) == is_standing(b) && (in_cells(&a.rates()) - in_cells(&b.rates())).abs().max_element() <= 0.5
}

fn in_cells(rates: &Rates) -> DVec3 {
    let scale = DVec3::new(CELL_SPEED_MPS, CELL_TURN_RAD_S, CELL_SPEED_MPS);
    axes(rates) / scale
}

/// The middle of the cell of some rates. Straight ahead and standing are middles.
fn cell(rates: &Rates) -> DVec3 {
    in_cells(rates).round()
}

fn axes(rates: &Rates) -> DVec3 {
    DVec3::new(rates.speed_mps, rates.turn_rate_rad_s, rates.strafe_mps)
}

/// Keeps at most so many cycles; the sources of the others say so.
pub(crate) fn limit(cycles: &mut Vec<NamedCycle>, most: Option<NonZeroUsize>, sources: &mut [SourceRecord]) {
    let Some(most) = most.map(NonZeroUsize::get).filter(|most| *most < cycles.len()) else { return };
    let keeps = spread(cycles, most);
    let mut index = 0..;
    cycles.retain(|named| {
        let keep = index.next().is_some_and(|index: usize| keeps.contains(&index));
        if !keep {
            let remark = format!("max_examples = {most}: {} left out", named.name);
            sources[named.source as usize].warnings.push(remark);
        }
        keep
    });
}

/// So many of the cycles: m_sp, one that stands, the ends of the set, then the rest, each time the one farthest from all
/// before and their mirrors.
fn spread(cycles: &[NamedCycle], most: usize) -> Vec<usize> {
    let places = normalised(cycles);
    let ends = ends(&places);
    let first = [semi_procedural(cycles), best(cycles, |named| !named.cycle.steps)].into_iter().flatten();
    let mut kept = Vec::new();
    let mut gaps = vec![f64::INFINITY; cycles.len()];
    let mut first = first.take(most).collect::<Vec<usize>>().into_iter();
    while kept.len() < most {
        let farthest = |pool: &dyn Fn(usize) -> bool| {
            let left = (0..cycles.len()).filter(|index| !kept.contains(index) && pool(*index));
            // The last of the greatest would be the worse name.
            left.rev().max_by(|a, b| gaps[*a].total_cmp(&gaps[*b]).then(cycles[*b].flaws.total_cmp(&cycles[*a].flaws)))
        };
        let next = first.next().or_else(|| farthest(&|index| ends.contains(&index))).or_else(|| farthest(&|_| true));
        let Some(next) = next else { break };
        kept.push(next);
        for (gap, place) in gaps.iter_mut().zip(&places) {
            let mirrored = places[next] * DVec3::new(1.0, -1.0, -1.0);
            *gap = gap.min(place.distance(places[next])).min(place.distance(mirrored));
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

/// (v_f, ω_t, ω_s) of each cycle, divided by the ranges over all of them.
fn normalised(cycles: &[NamedCycle]) -> Vec<DVec3> {
    let places: Vec<DVec3> = cycles.iter().map(|named| axes(&named.cycle.rates)).collect();
    let least = places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let ranges = places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max) - least;
    let scale = ranges.map(|range| if range > 0.0 { 1.0 / range } else { 0.0 });
    places.into_iter().map(|place| place * scale).collect()
}

/// The cycles that go farthest in any of 26 directions: along the axes and between them.
fn ends(places: &[DVec3]) -> Vec<usize> {
    let signs = [-1.0, 0.0, 1.0];
    let directions = signs.iter().flat_map(|&x| signs.iter().flat_map(move |&y| signs.map(|z| DVec3::new(x, y, z))));
    let farthest = |direction: DVec3| {
        (0..places.len()).rev().max_by(|a, b| places[*a].dot(direction).total_cmp(&places[*b].dot(direction)))
    };
    directions.filter(|direction| *direction != DVec3::ZERO).filter_map(farthest).collect()
}
