//! Two clips → whether they show one take, and how.
//!
//! A pair is screened by the legs' directions ([`crate::performance`]) at all lags that leave most of the shorter clip
//! covered; what comes near is compared exactly, in steps of 1/120 s. Two clips are one take where limbs, trunk and head
//! move alike *and* the facing turns and swings alike: the first alone cannot tell made-up walks, the second alone no
//! regular walkers.
//!
//! Measured over all pairs of 151 clips of 14 sources: retargeted copies have r up to 0.19 (a run of 1.4 s, CMU 02_03, on
//! two skeletons), all others up to 0.07. Of different takes the nearest are two made-up straight walks (0.26, but their
//! facings swing in antiphase), a left and a right turn of one performer (0.28) and walks of one performer (0.29 and
//! more). The limit lies in the middle of the gap.

use std::f64::consts::PI;

use crate::outline::{Outline, SCREEN_MAX, nearest_lag};
use crate::performance::{self, Likeness, Performance};

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
/// And turn alike within what the whole clip's turn rate is judged by (`definitions.md`): 3 °/s or 15° over the clip.
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
    pub(crate) mirrored: bool,
    pub(crate) times_differ: bool,
    pub(crate) unlikeness: f64,
}

/// A clip, ready for screening.
pub(crate) struct Entry {
    performance: Performance,
    /// At the screening's rate.
    coarse: Performance,
    /// As it is and mirrored.
    outlines: [Outline; 2],
}

impl Entry {
    pub(crate) fn new(performance: Performance) -> Self {
        let coarse = performance.sampled(SCREEN_HZ);
        Self { outlines: [Outline::of(&coarse), Outline::of(&coarse.mirrored())], coarse, performance }
    }
}

/// A clip that others are searched for; at other frame times, too, as the others ask for them.
pub(crate) struct Sought<'a> {
    told: &'a Entry,
    retimed: Vec<Entry>,
}

impl<'a> Sought<'a> {
    pub(crate) fn new(told: &'a Entry) -> Self {
        Self { told, retimed: Vec::new() }
    }

    /// The most alike of all ways to lay this clip over another, where that is one take. The other's frame time is the
    /// one that is believed.
    pub(crate) fn compare(&mut self, one: &Entry) -> Option<Match> {
        let retimed = self.retime(&one.performance);
        let others = std::iter::once((self.told, false)).chain(retimed.iter().map(|&at| (&self.retimed[at], true)));
        let ways =
            others.flat_map(|(other, times_differ)| [false, true].map(|mirrored| (other, mirrored, times_differ)));
        let laid = ways.filter_map(|(other, mirrored, times_differ)| {
            let found = laid_over(one, other, mirrored).filter(is_one_take)?;
            Some(Match { mirrored, times_differ, unlikeness: found.unlikeness })
        });
        laid.min_by(|a, b| a.unlikeness.total_cmp(&b.unlikeness))
    }

    /// Where this clip is kept at the rates that its frames have if they are the other's, where its own frame time says
    /// otherwise.
    fn retime(&mut self, one: &Performance) -> Vec<usize> {
        let told = &self.told.performance;
        let counts = [one, told].map(|performance| performance.directions.len() as f64);
        let fits = |ratio: &f64| {
            let count_off = (counts[1] / (ratio * counts[0]) - 1.0).abs();
            let time_off = (told.rate_hz / (ratio * one.rate_hz) - 1.0).abs();
            count_off < COUNT_TOLERANCE && time_off > TIME_TOLERANCE
        };
        let rates_hz = FRAME_RATIOS.into_iter().filter(fits).map(|ratio| ratio * one.rate_hz);
        let kept = &mut self.retimed;
        rates_hz
            .map(|rate_hz| {
                kept.iter().position(|entry| entry.performance.rate_hz == rate_hz).unwrap_or_else(|| {
                    kept.push(Entry::new(Performance { rate_hz, ..told.clone() }));
                    kept.len() - 1
                })
            })
            .collect()
    }
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

/// The exact likeness at the best lag; none where the screening finds none.
fn laid_over(one: &Entry, other: &Entry, mirrored: bool) -> Option<Likeness> {
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
    let found = around.filter_map(|lag| performance::compare(&one, &other, lag));
    found.min_by(|a, b| a.unlikeness.total_cmp(&b.unlikeness))
}
