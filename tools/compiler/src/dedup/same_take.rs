//! Two clips → whether they show one take, and how.
//!
//! A pair is screened by the legs' directions ([`crate::dedup::performance`]) at all lags that leave most of the shorter clip
//! covered; what comes near is compared exactly, in steps of 1/120 s. Two clips are one take where limbs, trunk and
//! head move alike *and* the facing turns and swings alike: the first alone cannot tell made-up walks, the second alone
//! no regular walkers.
//!
//! Measured over all pairs of 151 clips of 14 sources: retargeted copies have r up to 0.19 (a run of 1.4 s, CMU 02_03,
//! on two skeletons), all others up to 0.07. Of different takes the nearest are two made-up straight walks (0.26, but
//! their facings swing in antiphase), a left and a right turn of one performer (0.28) and walks of one performer (0.29
//! and more). The limit lies in the middle of the gap.

use std::f64::consts::PI;

use crate::dedup::alignment::Alignment;
use crate::dedup::outline::{self, Outline, SCREEN_MAX, nearest_lag};
use crate::dedup::performance::{self, Likeness, Performance};
use crate::dedup::stir::Stirs;

/// Rate at which pairs are screened, Hz, and exact lags in one of its steps.
pub(crate) const SCREEN_HZ: f64 = 20.0;
const EXACT_STEPS: isize = 6;
/// Greatest r of one take.
const UNLIKENESS_MAX: f64 = 0.23;
/// Shorter overlaps must be the more alike, in proportion, s: about a stride tells little of a performer.
const SURE_S: f64 = 1.2;
/// Clips that stir less have no course to compare: 0.2°.
const MOVEMENT_MIN_RAD: f64 = 0.2 * PI / 180.0;
/// Facings of one take: retargeting changes the size of their swing, hardly its course (0.97 and more); at the lags of
/// the screening less.
const FACING_CORRELATION_MIN: f64 = 0.9;
const SCREEN_CORRELATION_MIN: f64 = 0.75;
/// And turn alike within what the whole clip's turn rate is judged by ([`crate::truth`]): 3 °/s or 15° over the clip.
const TURN_DIFFERENCE_RAD_S: f64 = 3.0 * PI / 180.0;
const TURN_DIFFERENCE_RAD: f64 = 15.0 * PI / 180.0;
/// Frames of one clip per frame of the other that are tried where the frame counts fit and the times do not.
const FRAME_RATIOS: [f64; 3] = [0.5, 1.0, 2.0];
/// How far counts may be off (trimmed ends), and how far times must be, as a share.
const COUNT_TOLERANCE: f64 = 0.1;
const TIME_TOLERANCE: f64 = 0.05;

/// How two clips are one take.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Match {
    /// The other on the better one.
    pub(crate) alignment: Alignment,
    /// r of [`crate::dedup::performance`].
    pub(crate) unlikeness: f64,
}

/// A clip, ready for screening.
pub(crate) struct Entry {
    performance: Performance,
    /// At the screening's rate.
    coarse: Performance,
    /// As it is and mirrored.
    outlines: [Outline; 2],
    stirs: Stirs,
}

impl Entry {
    pub(crate) fn new(performance: Performance) -> Self {
        let coarse = performance.sampled(SCREEN_HZ);
        let outlines = [Outline::of(&coarse), Outline::of(&coarse.mirrored())];
        Self { outlines, stirs: Stirs::of(&coarse, outline::covered), coarse, performance }
    }
}

/// The most alike of all ways to lay a clip over a better one, where that is one take. The better one's frame time is
/// believed.
pub(crate) fn compare(better: &Entry, other: &Entry) -> Option<Match> {
    let told = ways(better, other, 1.0);
    let rate_hz = other.performance.rate_hz;
    let retimed = rates_of_same_frames(better, other).filter_map(|rate| {
        ways(better, &Entry::new(Performance { rate_hz: rate, ..other.performance.clone() }), rate_hz / rate)
    });
    told.into_iter().chain(retimed).min_by(|a, b| a.unlikeness.total_cmp(&b.unlikeness))
}

/// The better way of two to lay a clip over another: as it is or mirrored.
fn ways(one: &Entry, other: &Entry, pace: f64) -> Option<Match> {
    let laid = [false, true].into_iter().filter_map(|mirrored| {
        let (found, start_s) = laid_over(one, other, mirrored).filter(|(found, _)| is_one_take(found))?;
        let alignment = Alignment { mirrored, start_s, pace };
        Some(Match { alignment, unlikeness: found.unlikeness })
    });
    laid.min_by(|a, b| a.unlikeness.total_cmp(&b.unlikeness))
}

/// The rates that a clip's frames have if they are the other's, where its own frame time says otherwise.
fn rates_of_same_frames(one: &Entry, told: &Entry) -> impl Iterator<Item = f64> {
    let may_be = [false, true].into_iter().any(|mirrored| told.stirs.may_have_the_same_frames(&one.stirs, mirrored));
    let (one, told) = (&one.performance, &told.performance);
    let counts = [one, told].map(|performance| performance.directions.len() as f64);
    let (one_hz, told_hz) = (one.rate_hz, told.rate_hz);
    let fits = move |ratio: &f64| {
        let count_off = (counts[1] / (ratio * counts[0]) - 1.0).abs();
        let time_off = (told_hz / (ratio * one_hz) - 1.0).abs();
        may_be && count_off < COUNT_TOLERANCE && time_off > TIME_TOLERANCE
    };
    FRAME_RATIOS.into_iter().filter(fits).map(move |ratio| ratio * one_hz)
}

fn is_one_take(found: &Likeness) -> bool {
    let limit = UNLIKENESS_MAX * (found.overlap_s / SURE_S).min(1.0);
    found.unlikeness <= limit
        && found.movement_rad >= MOVEMENT_MIN_RAD
        && found.facing_correlation.is_none_or(|correlation| correlation >= FACING_CORRELATION_MIN)
        && turn_alike(found)
}

fn turn_alike(found: &Likeness) -> bool {
    found.turn_difference_rad_s <= TURN_DIFFERENCE_RAD_S.max(TURN_DIFFERENCE_RAD / found.overlap_s)
}

/// The exact likeness at the best lag, and that lag in seconds; none where the screening finds none.
fn laid_over(one: &Entry, other: &Entry, mirrored: bool) -> Option<(Likeness, f64)> {
    if !other.stirs.may_be_alike(&one.stirs, mirrored) {
        return None;
    }
    let lag = nearest_lag(&one.outlines[0], &other.outlines[usize::from(mirrored)])?;
    let turned = |told: &Performance| if mirrored { told.mirrored() } else { told.clone() };
    let coarse = performance::compare(&one.coarse, &turned(&other.coarse), lag)?;
    let swings_alike = coarse.facing_correlation.is_none_or(|correlation| correlation > SCREEN_CORRELATION_MIN);
    if coarse.unlikeness > SCREEN_MAX || !swings_alike || !turn_alike(&coarse) {
        return None;
    }
    let rate_hz = SCREEN_HZ * EXACT_STEPS as f64;
    let (one, other) = (one.performance.sampled(rate_hz), turned(&other.performance).sampled(rate_hz));
    let around = (lag - 1) * EXACT_STEPS..=(lag + 1) * EXACT_STEPS;
    let found = around.filter_map(|lag| Some((performance::compare(&one, &other, lag)?, lag as f64 / rate_hz)));
    found.min_by(|(a, _), (b, _)| a.unlikeness.total_cmp(&b.unlikeness))
}
