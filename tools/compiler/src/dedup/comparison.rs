//! Two clips → whether they show one take, and how one lies on the other.
//!
//! A clip is laid over another, as it is and mirrored, at each lag in rows ([`super::signature`]) that leaves most of
//! the shorter one covered; then between the rows about the best. One take it is where the unlikeness r
//! ([`super::correlation`]) is small and both turn alike, which directions in the frame of the facing do not show.
//!
//! Measured over all pairs of 151 clips of 14 sources: retargeted copies have r up to 0.19 (a run of 1.4 s, CMU 02_03,
//! on two skeletons), all others up to 0.16. The nearest different takes are two jumps of 0.4 s (0.24), walks of one
//! performer (0.27 and more) and a left and a right turn of one performer (0.28).

use std::f64::consts::PI;

use crate::dedup::alignment::Alignment;
use crate::dedup::correlation::{Series, squared_unlikeness};
use crate::dedup::signature::{self, FACING, RATE_HZ, Row};
use crate::retarget::human_clip::HumanClip;

/// Greatest r of one take: the middle of the gap.
const UNLIKENESS_MAX: f64 = 0.21;
/// Greatest r at the nearest lag in rows: half a row, 25 ms, costs a run of two strides a second 0.3.
const UNLIKENESS_OF_ROWS_MAX: f32 = 0.45;
/// Shorter overlaps must be the more alike, in proportion, s: about a stride tells little of a performer.
const SURE_S: f64 = 1.2;
/// Greatest difference of steady turning, rad/s, or of the turn over the whole overlap, rad: what the whole clip's turn
/// rate is judged by ([`crate::truth`]).
const TURN_DIFFERENCE_RAD_S: f64 = 3.0 * PI / 180.0;
const TURN_DIFFERENCE_RAD: f64 = 15.0 * PI / 180.0;
/// Lags that are tried between two rows: steps of 1/120 s.
const LAGS_A_ROW: i32 = 6;
/// Frames of one clip per frame of the other that are tried where the frame counts fit and the times do not.
const FRAME_RATIOS: [f64; 3] = [0.5, 1.0, 2.0];
/// How far counts may be off (trimmed ends), and how far times must be, as a share.
const COUNT_TOLERANCE: f64 = 0.1;
const TIME_TOLERANCE: f64 = 0.05;

/// How two clips are one take.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Match {
    /// The second on the first.
    pub(crate) alignment: Alignment,
    /// r.
    pub(crate) unlikeness: f64,
}

/// A clip, ready for comparison.
pub(crate) struct ComparedClip {
    frame_count: usize,
    frame_rate_hz: f64,
    /// As it is and mirrored.
    signatures: [Series; 2],
}

impl ComparedClip {
    pub(crate) fn of(clip: &HumanClip) -> Self {
        let rows = signature::rows(clip);
        let signatures = [Series::of(&rows), Series::of(&signature::mirrored(&rows))];
        Self { frame_count: clip.frames.len(), frame_rate_hz: clip.frame_rate_hz, signatures }
    }

    /// The paces of another clip on this one at which their frames are the same, where the stated times differ.
    fn paces_of_same_frames(&self, other: &Self) -> impl Iterator<Item = f64> {
        let counts = other.frame_count as f64 / self.frame_count as f64;
        let rates = other.frame_rate_hz / self.frame_rate_hz;
        let fits = move |ratio: &f64| {
            (counts / ratio - 1.0).abs() < COUNT_TOLERANCE && (rates / ratio - 1.0).abs() > TIME_TOLERANCE
        };
        FRAME_RATIOS.into_iter().filter(fits).map(move |ratio| rates / ratio)
    }
}

/// Lays a clip over a better one, whose frame time is believed: at the stated time, and where both have the same frames
/// at the time of the better one. The most alike of all, where that is one take.
pub(crate) fn compare(better: &ComparedClip, other: &ComparedClip) -> Option<Match> {
    let one = &better.signatures[0];
    let stated = laid_over(one, &other.signatures, 1.0);
    let faster = |series: &Series, pace: f64| Series::of(&signature::faster(&series.rows, pace));
    let retimed = better.paces_of_same_frames(other).filter_map(|pace| match pace < 1.0 {
        true => laid_over(one, &other.signatures.each_ref().map(|other| faster(other, 1.0 / pace)), pace),
        false => laid_over(&faster(one, pace), &other.signatures, pace),
    });
    stated.into_iter().chain(retimed).min_by(|a, b| a.unlikeness.total_cmp(&b.unlikeness))
}

/// The better match of two: of a clip as it is and mirrored. A second of it is `pace` seconds of the one below.
fn laid_over(one: &Series, others: &[Series; 2], pace: f64) -> Option<Match> {
    let laid = others.iter().zip([false, true]).filter_map(|(other, mirrored)| {
        let (unlikeness, lag) = match one.rows.len() < other.rows.len() {
            true => nearest(one, other).map(|(unlikeness, lag)| (unlikeness, -lag))?,
            false => nearest(other, one)?,
        };
        let start_s = lag / RATE_HZ * pace.max(1.0);
        Some(Match { alignment: Alignment { mirrored, start_s, pace }, unlikeness })
    });
    laid.min_by(|a, b| a.unlikeness.total_cmp(&b.unlikeness))
}

/// r where a longer clip is most alike to a shorter one, and the row of it at which the shorter one begins; none where
/// that is not one take.
fn nearest(shorter: &Series, longer: &Series) -> Option<(f64, f64)> {
    let (mut limit, mut nearest) = (UNLIKENESS_OF_ROWS_MAX * UNLIKENESS_OF_ROWS_MAX, None);
    for lag in longer.lags_of(shorter) {
        if let Some(squared) = squared_unlikeness(shorter, longer, lag, limit) {
            (limit, nearest) = (squared, Some(lag));
        }
    }
    let lag = nearest?;
    let (a, b) = (&shorter.rows[(-lag).max(0) as usize..], &longer.rows[lag.max(0) as usize..]);
    let count = a.len().min(b.len());
    let (a, b) = (&a[..count], &b[..count]);
    if turn_alike(a, b) { between_rows(a, b) } else { None }.map(|(unlikeness, later)| (unlikeness, lag as f64 + later))
}

/// r of one take at the best lag between rows, and that lag; none where it is not one take.
fn between_rows(a: &[Row], b: &[Row]) -> Option<(f64, f64)> {
    let limit = UNLIKENESS_MAX * (a.len() as f64 / RATE_HZ / SURE_S).min(1.0);
    let found = (-LAGS_A_ROW / 2..=LAGS_A_ROW / 2).filter_map(|step| {
        let later = f64::from(step) / f64::from(LAGS_A_ROW);
        // Both lie equally far from their rows: what interpolation takes from one it takes from the other.
        let [a, b] = [(a, 0.5 - 0.5 * later), (b, 0.5 + 0.5 * later)]
            .map(|(rows, share)| Series::of(&signature::between(rows, share)));
        let squared = squared_unlikeness(&a, &b, 0, (limit * limit) as f32)?;
        Some((libm::sqrt(f64::from(squared)), later))
    });
    found.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Whether the facings turn alike: the slope of their difference, by least squares.
fn turn_alike(a: &[Row], b: &[Row]) -> bool {
    let middle = 0.5 * (a.len() - 1) as f64;
    let (mut along, mut across) = (0.0, 0.0);
    for (row, (a, b)) in a.iter().zip(b).enumerate() {
        let from_middle = row as f64 - middle;
        along += from_middle * from_middle;
        across += from_middle * f64::from(a[FACING] - b[FACING]);
    }
    let overlap_s = a.len() as f64 / RATE_HZ;
    (across / along * RATE_HZ).abs() <= TURN_DIFFERENCE_RAD_S.max(TURN_DIFFERENCE_RAD / overlap_s)
}
