//! Invariants of the simplices and the correspondence times (`FbCrowd` §5, Eq. 10).

use crate::blend_space::tiling::tiling_fault;
use crate::motion::motion_db::MotionDb;
use crate::motion::parameters::Parameters;
use crate::validate::{CheckResult, ensure};

/// The simplices are disjoint and fill the convex hull of the examples' parameters; see [`crate::blend_space::tiling`].
pub(crate) fn simplices_tile_the_hull(db: &MotionDb) -> CheckResult {
    let parameters: Vec<Parameters> = db.parameters().collect();
    tiling_fault(&db.blend_space, &parameters).map_or(Ok(()), Err)
}

/// If two examples step, there are correspondences between two of these. The pairs lie in their cycles, rise in t_sp,
/// and rise in t_mb except at one wrap. Each step of m_sp has at least one pair.
pub(crate) fn correspondences_are_cyclic(db: &MotionDb) -> CheckResult {
    let stepping = db.examples.iter().filter(|example| example.key_times_s.is_some()).count();
    let Some(found) = &db.correspondence else {
        return ensure(stepping < 2, || format!("there are no pairs, but {stepping} examples step"));
    };
    let [first, second] = [found.semi_procedural, found.blending].map(|index| &db.examples[index as usize]);
    let step = first.key_times_s.is_some() && second.key_times_s.is_some();
    ensure(step && first.name != second.name, || {
        format!("m_sp {} and m_mb {} are not two examples that step", first.name, second.name)
    })?;
    let (first_s, second_s) = (first.phase_map.period_s, second.phase_map.period_s);
    let pairs = &found.pairs_s;
    let inside = pairs.iter().all(|[sp, mb]| (0.0..first_s).contains(sp) && (0.0..second_s).contains(mb));
    ensure(inside, || format!("pairs {pairs:?} s exceed the periods {first_s} s and {second_s} s"))?;
    let left_s = first.phase_map.time_s(0.5);
    let right_step = pairs.iter().any(|[sp, _]| *sp < left_s);
    let left_step = pairs.iter().any(|[sp, _]| *sp >= left_s);
    ensure(right_step && left_step, || format!("a step of m_sp has none of the pairs {pairs:?} s"))?;
    let next = |k: usize| pairs[(k + 1) % pairs.len()];
    let falls = |axis: usize| (0..pairs.len()).filter(|&k| next(k)[axis] <= pairs[k][axis]).count();
    let rises = pairs.windows(2).all(|pair| pair[0][0] < pair[1][0]);
    ensure(rises && falls(1) == 1, || format!("pairs {pairs:?} s are not cyclic"))
}
