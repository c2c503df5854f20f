//! AnalyzedClips → the same without doubtful cycles that clean ones replace.
//!
//! The feet of a doubtful cycle slide or are hardly planted. Blended into a crowd, it drags the feet of all bodies, so
//! it gives an example only where no blend of clean cycles of its gait reaches its parameters.

use glam::DVec3;
use motiondb::diagnostic::{Diagnostic, Unfit};
use motiondb::quality::example_quality::usual_planted_share;
use motiondb::velocity_sets::velocity_hull::goes_straight;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::rate_cells::in_cells;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::HumanClip;
use crate::select::named_cycles::is_chosen;
use crate::select::rate_hull::is_near_hull;

/// Distance within which a blend reaches parameters, in widths of a cell: that of near-equal ones.
const REACH_CELLS: f64 = 0.5;

/// Drops the doubtful cycles of clips of one style that clean cycles reach; not the one that a manifest chose as m_sp.
pub(crate) fn without_reached_doubtful(clips: &[HumanClip], mut analyzed: Vec<AnalyzedClip>) -> Vec<AnalyzedClip> {
    let clean = clean_rates(clips, &analyzed);
    for (clip, found) in clips.iter().zip(&mut analyzed) {
        drop_reached(clip, found, &clean);
    }
    analyzed
}

/// The rates of all cycles with clean feet of an upright body that steps.
fn clean_rates(clips: &[HumanClip], analyzed: &[AnalyzedClip]) -> Vec<Rates> {
    let of_clip = |(clip, found): (&HumanClip, &AnalyzedClip)| {
        let is_clean = |window: &&SteadyCycle| !window.is_doubtful && clip.is_upright_in(window.window_s);
        let rates = |window: &SteadyCycle| window.stepping().map(|cycle| cycle.rates);
        found.windows.iter().filter(is_clean).filter_map(rates).collect::<Vec<Rates>>()
    };
    clips.iter().zip(analyzed).flat_map(of_clip).collect()
}

/// Drops the doubtful cycles of a clip that clean cycles of these rates reach. A clip without cycles then keeps the
/// warnings of the first.
fn drop_reached(clip: &HumanClip, found: &mut AnalyzedClip, clean: &[Rates]) {
    let is_kept = |window: &SteadyCycle| !window.is_doubtful || !is_reached(&window.rates(), clean);
    let kept: Vec<bool> = found.windows.iter().map(is_kept).collect();
    let left = || found.windows.iter().zip(&kept).filter(|(_, is_kept)| **is_kept).map(|(window, _)| window);
    let has_chosen = left().enumerate().any(|(index, window)| is_chosen(clip, index, window.window_s));
    let dropped = kept.iter().filter(|is_kept| !**is_kept).count();
    if dropped == 0 || clip.choices.is_semi_procedural && !has_chosen {
        return;
    }
    if dropped < kept.len() {
        found.left_out.doubtful += dropped;
    } else {
        let is_warning = |found: &&Diagnostic| matches!(found, Diagnostic::Warning(_));
        found.diagnostics.push(Diagnostic::NoExample(Unfit::CleanerClips));
        found.diagnostics.extend(found.windows[0].diagnostics.iter().filter(is_warning).cloned());
    }
    let mut index = 0..;
    found.windows.retain(|_| index.next().is_some_and(|index: usize| kept[index]));
}

/// Whether a blend of clean cycles of the same gait, their mirrors and standing comes near these rates. For a body that
/// goes straight, cycles that turn or side-step do not count: without a straight cycle there is no base walk.
fn is_reached(rates: &Rates, clean: &[Rates]) -> bool {
    let gait = |rates: &Rates| usual_planted_share(rates.speed_over_ground_mps() as f32).0;
    let is_straight = |rates: &Rates| goes_straight(&rates.to_parameters());
    let counts = |other: &&Rates| gait(other) == gait(rates) && (is_straight(other) || !is_straight(rates));
    let cells: Vec<DVec3> = clean.iter().filter(counts).map(in_cells).collect();
    if cells.is_empty() {
        return false;
    }
    let mirrors = cells.iter().map(|cell| *cell * DVec3::new(1.0, -1.0, -1.0));
    let corners: Vec<DVec3> = cells.iter().copied().chain(mirrors).chain([DVec3::ZERO]).collect();
    is_near_hull(in_cells(rates), &corners, REACH_CELLS)
}

#[cfg(test)]
mod tests {
    use motiondb::diagnostic::{Note, Warning};
    use motiondb::motion::MotionDb;

    use super::*;
    use crate::synthetic::{SyntheticWalk, database_of, performance, recorded, walk};
    use crate::{Options, compile};

    fn at(name: &str, speed_mps: f64, turn_rate_rad_s: f64, period_s: f64) -> HumanClip {
        walk(name, SyntheticWalk { period_s, ..SyntheticWalk::at(speed_mps, turn_rate_rad_s, 0.0) })
    }

    /// A walk whose feet are in the air for three quarters of the cycle.
    fn airborne(name: &str, speed_mps: f64) -> HumanClip {
        walk(name, SyntheticWalk { period_s: 0.9, planted_share: 0.25, ..SyntheticWalk::at(speed_mps, 0.0, 0.0) })
    }

    fn is_left_out(db: &MotionDb, name: &str) -> bool {
        let source = db.sources.iter().find(|source| source.file == format!("{name}.bvh")).unwrap();
        source.diagnostics.contains(&Diagnostic::NoExample(Unfit::CleanerClips))
    }

    #[track_caller]
    fn check(clips: Vec<HumanClip>, names: &[&str]) -> MotionDb {
        let db = database_of(clips, 0);
        let found: Vec<&str> = recorded(&db).iter().map(|example| example.name.as_str()).collect();
        assert_eq!(found, names, "{:?}", db.sources);
        db
    }

    #[test]
    fn a_doubtful_walk_beside_a_clean_one_gives_no_example() {
        let db = check(vec![at("clean", 1.4, 0.0, 1.1), airborne("airborne", 0.8)], &["clean"]);
        assert!(is_left_out(&db, "airborne"), "{:?}", db.sources);
        let is_warning = |found: &Diagnostic| matches!(found, Diagnostic::Warning(Warning::FeetHardlyPlanted { .. }));
        assert!(db.sources.iter().any(|source| source.diagnostics.iter().any(is_warning)), "{:?}", db.sources);
    }

    #[test]
    fn a_doubtful_walk_stays_where_no_clean_one_reaches() {
        let clean = || at("clean", 0.8, 0.0, 1.1);
        check(vec![airborne("airborne", 1.0)], &["airborne"]);
        check(vec![clean(), airborne("airborne", 1.3)], &["airborne", "clean"]);
        check(vec![at("turn", 1.4, 0.9, 1.1), airborne("airborne", 0.8)], &["airborne", "turn"]);
        let run = walk("run", SyntheticWalk { period_s: 0.9, ..SyntheticWalk::at(2.2, 0.0, 0.0) });
        check(vec![run, airborne("airborne", 1.3)], &["airborne", "run"]);
    }

    #[test]
    fn a_doubtful_walk_that_is_to_be_kept_stays() {
        let clips = vec![at("clean", 1.4, 0.0, 1.1), airborne("airborne", 0.8)];
        let options = Options { keep_doubtful: true, ..Options::default() };
        let db = compile(clips, &options, &|_| ()).unwrap();
        assert_eq!(recorded(&db).len(), 2, "{:?}", db.sources);
    }

    #[test]
    fn a_doubtful_walk_that_a_manifest_chose_stays() {
        let mut chosen = airborne("airborne", 0.8);
        chosen.choices.is_semi_procedural = true;
        check(vec![at("clean", 1.4, 0.0, 1.1), chosen], &["airborne", "clean"]);
    }

    #[test]
    fn clean_parts_of_a_clip_replace_its_doubtful_one() {
        let long =
            walk("part", SyntheticWalk { planted_share: 0.25, duration_s: 8.0, ..SyntheticWalk::at(0.8, 0.0, 0.0) });
        let parts = [long, at("part", 0.9, 0.9, 1.1), at("part", 1.3, 0.0, 1.1)];
        let db = database_of(vec![performance("capture", &parts)], 0);
        let [first, further] = recorded(&db)[..] else { panic!("{:#?}", db.examples) };
        assert!(first.window_s[0] > 7.5 && further.window_s[0] > 7.5, "{first:?}, {further:?}");
        let left_out = Diagnostic::Note(Note::WindowsLeftOut { near_equal: 0, doubtful: 2 });
        assert!(db.sources[0].diagnostics.contains(&left_out), "{:?}", db.sources);
    }
}
