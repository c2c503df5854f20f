//! Comparison of two clips: whether they show one take, and how one lies on the other.
//!
//! 1. Lay one clip over the other, as it is and mirrored, at each lag in rows ([`signature`]) that covers most of the
//!    shorter clip; then between the rows about the best lag.
//! 2. Two clips are one take where their unlikeness r ([`crate::dedup::correlation`]) is small, both turn alike, and
//!    both carry trunk and arms alike: r shows neither a steady turn nor how a limb is held.
//!
//! Over all pairs of 149 clips of 14 sources, retargeted copies have r up to 0.19 (a run of 1.4 s, CMU 02_03, on two
//! skeletons). The nearest different takes are a left turn and a mirrored right turn of one performer (0.275).

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::dedup::alignment::Alignment;
use crate::dedup::correlation::{Series, squared_unlikeness};
use crate::dedup::signature::{self, FACING, RATE_HZ, Row};
use crate::retarget::human_clip::HumanClip;

/// Greatest r of one take: copies reach 0.19, captured different takes begin at 0.275. Nearer to the copies, because
/// generated gaits of one cadence are alike (`docs/tuning.md`).
const UNLIKENESS_MAX: f64 = 0.21;
/// Greatest r at the nearest lag in rows. Half a row, 25 ms, costs a run of two strides a second 0.3.
const UNLIKENESS_OF_ROWS_MAX: f32 = 0.45;
/// Overlap below which the greatest r shrinks in proportion, s: about a stride is alike for many performers.
const FULL_LIMIT_OVERLAP_S: f64 = 1.2;
/// Greatest r of a mirror image over that of the clip as it is: a symmetric walk is its own mirror image, half a stride
/// later.
const MIRROR_SHARE_MAX: f64 = 0.7;
/// Greatest difference of the turn rates of one take, rad/s: 3 °/s, below which turning is gait noise.
const TURN_DIFFERENCE_RAD_S: f64 = 3.0 * PI / 180.0;
/// Greatest difference of the turns over a short overlap, rad: 15°, the sway of less than two strides.
const TURN_DIFFERENCE_RAD: f64 = 15.0 * PI / 180.0;
/// Number of lags tried between two rows: steps of 1/120 s.
const LAGS_PER_ROW: i32 = 6;
/// Frames of one clip per frame of the other that are tried where the frame counts fit and the frame times do not.
const FRAME_RATIOS: [f64; 3] = [0.5, 1.0, 2.0];
/// Greatest relative difference of frame counts that fit: ends may be trimmed.
const COUNT_TOLERANCE: f64 = 0.1;
/// Least relative difference of frame times that do not fit.
const TIME_TOLERANCE: f64 = 0.05;

/// How two clips are one take.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Match {
    /// The second clip on the first.
    pub(crate) alignment: Alignment,
    /// Unlikeness r of both clips.
    pub(crate) unlikeness: f64,
}

/// A clip, ready for comparison.
pub(crate) struct ComparedClip {
    frame_count: usize,
    frame_rate_hz: f64,
    /// Signatures of the clip and of its mirror image.
    signatures: [Series; 2],
}

impl ComparedClip {
    /// Computes the signatures of a clip.
    pub(crate) fn of(clip: &HumanClip) -> Self {
        Self::of_rows(clip.frames.len(), clip.frame_rate_hz, &signature::rows(clip))
    }

    /// A clip whose signature is known.
    pub(crate) fn of_rows(frame_count: usize, frame_rate_hz: f64, rows: &[Row]) -> Self {
        let signatures = [Series::of(rows), Series::of(&signature::mirrored(rows))];
        Self { frame_count, frame_rate_hz, signatures }
    }

    /// Paces of another clip on this one at which both have the same frames, where their stated frame times differ.
    fn paces_of_same_frames(&self, other: &Self) -> impl Iterator<Item = f64> {
        let counts = other.frame_count as f64 / self.frame_count as f64;
        let rates = other.frame_rate_hz / self.frame_rate_hz;
        let fits = move |ratio: &f64| {
            (counts / ratio - 1.0).abs() < COUNT_TOLERANCE && (rates / ratio - 1.0).abs() > TIME_TOLERANCE
        };
        FRAME_RATIOS.into_iter().filter(fits).map(move |ratio| rates / ratio)
    }
}

/// The best match of a clip on a better one; `None` where they are two takes.
///
/// The clip has its stated frame time or, where both clips have the same frames, the frame time of the better one.
pub(crate) fn compare(better: &ComparedClip, other: &ComparedClip) -> Option<Match> {
    let [one, _] = &better.signatures;
    let faster = |series: &Series, pace: f64| Series::about_mean(&signature::faster(&series.rows, pace));
    let stated = best_overlay(one, &other.signatures, 1.0);
    let retimed = better.paces_of_same_frames(other).filter_map(|pace| match pace < 1.0 {
        true => best_overlay(one, &other.signatures.each_ref().map(|other| faster(other, 1.0 / pace)), pace),
        false => best_overlay(&faster(one, pace), &other.signatures, pace),
    });
    stated.into_iter().chain(retimed).min_by(|a, b| a.unlikeness.total_cmp(&b.unlikeness))
}

/// The better match of a clip, as it is or mirrored. `pace`: seconds of the first clip per second of the other.
fn best_overlay(one: &Series, others: &[Series; 2], pace: f64) -> Option<Match> {
    let overlay = |mirrored: bool| {
        let other = &others[usize::from(mirrored)];
        let (unlikeness, lag) = match one.rows.len() < other.rows.len() {
            true => nearest_lag(one, other).map(|(unlikeness, lag)| (unlikeness, -lag))?,
            false => nearest_lag(other, one)?,
        };
        // The series of the slower clip was sampled at `pace` times the rate.
        let start_s = lag / RATE_HZ * pace.max(1.0);
        Some(Match { alignment: Alignment { mirrored, start_s, pace }, unlikeness })
    };
    match (overlay(false), overlay(true)) {
        (Some(as_it_is), Some(mirror)) if mirror.unlikeness >= MIRROR_SHARE_MAX * as_it_is.unlikeness => Some(as_it_is),
        (as_it_is, mirror) => mirror.or(as_it_is),
    }
}

/// r of a shorter clip on a longer one, and the row of the longer clip at which the shorter begins; `None` where they
/// are two takes.
fn nearest_lag(shorter: &Series, longer: &Series) -> Option<(f64, f64)> {
    let (mut limit, mut nearest) = (UNLIKENESS_OF_ROWS_MAX * UNLIKENESS_OF_ROWS_MAX, None);
    for lag in longer.lags_of(shorter) {
        if let Some(squared) = squared_unlikeness(shorter, longer, lag, limit) {
            (limit, nearest) = (squared, Some(lag));
        }
    }
    let lag = nearest?;
    let [from, longer_from] = [(-lag).max(0) as usize, lag.max(0) as usize];
    let count = (shorter.rows.len() - from).min(longer.rows.len() - longer_from);
    let (a, b) = (&shorter.rows[from..from + count], &longer.rows[longer_from..longer_from + count]);
    if !turn_alike(a, b) || !carried_alike(shorter.mean_of(from, count), longer.mean_of(longer_from, count)) {
        return None;
    }
    let (unlikeness, later) = nearest_between_rows(a, b)?;
    Some((unlikeness, lag as f64 + later))
}

/// r at the best lag between rows, and that lag; `None` where it exceeds the limit of one take.
fn nearest_between_rows(a: &[Row], b: &[Row]) -> Option<(f64, f64)> {
    let overlap_s = a.len() as f64 / RATE_HZ;
    let limit = UNLIKENESS_MAX * (overlap_s / FULL_LIMIT_OVERLAP_S).min(1.0);
    let found = (-LAGS_PER_ROW / 2..=LAGS_PER_ROW / 2).filter_map(|step| {
        let later = f64::from(step) / f64::from(LAGS_PER_ROW);
        // Both lie equally far from their rows, so interpolation smooths both alike.
        let [a, b] = [(a, 0.5 - 0.5 * later), (b, 0.5 + 0.5 * later)]
            .map(|(rows, share)| Series::about_mean(&signature::between(rows, share)));
        let squared = squared_unlikeness(&a, &b, 0, (limit * limit) as f32)?;
        Some((libm::sqrt(f64::from(squared)), later))
    });
    found.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Whether both bodies carry trunk and arms alike. Retimed series have no mean; carriages are not compared there.
fn carried_alike(a: Option<Row>, b: Option<Row>) -> bool {
    let Some((a, b)) = a.zip(b) else { return true };
    signature::carriage(&a).is_like(&signature::carriage(&b))
}

/// Whether the facings turn alike: slope of their difference by least squares.
fn turn_alike(a: &[Row], b: &[Row]) -> bool {
    let middle = 0.5 * (a.len() - 1) as f64;
    let (mut squares, mut products) = (0.0, 0.0);
    for (row, (a, b)) in a.iter().zip(b).enumerate() {
        let from_middle = row as f64 - middle;
        squares += from_middle * from_middle;
        products += from_middle * f64::from(a[FACING] - b[FACING]);
    }
    let overlap_s = a.len() as f64 / RATE_HZ;
    (products / squares * RATE_HZ).abs() <= TURN_DIFFERENCE_RAD_S.max(TURN_DIFFERENCE_RAD / overlap_s)
}
