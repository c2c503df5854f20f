//! Alignment of two clips of one take: the map from the time of one clip to the time of the other. Seconds from the
//! first frame of each.

use serde::{Deserialize, Serialize};

use crate::ground::root_arc::Rates;

/// Relative difference below which two frame times are equal: 23.976 and 24 frames a second, 29.97 and 30.
const SAME_PACE: f64 = 0.01;

/// Map of a clip's time t to another clip's time `start_s + pace · t`, at which both show the same pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Alignment {
    /// One clip is the other's mirror image.
    pub mirrored: bool,
    /// Time of the other clip at which this clip begins, s; negative where this clip begins earlier.
    pub start_s: f64,
    /// Seconds of the other clip per second of this clip: 1 unless a frame time is wrong.
    pub pace: f64,
}

impl Alignment {
    /// A clip on itself.
    pub(crate) const IDENTITY: Self = Self { mirrored: false, start_s: 0.0, pace: 1.0 };

    /// Whether the clips have different frame times.
    pub fn times_differ(&self) -> bool {
        (self.pace - 1.0).abs() > SAME_PACE
    }

    /// Times of this clip in the other's time.
    pub(crate) fn at(&self, times_s: [f64; 2]) -> [f64; 2] {
        times_s.map(|time_s| self.start_s + self.pace * time_s)
    }

    /// Rates of this clip as the other shows them.
    pub(crate) fn rates(&self, rates: &Rates) -> Rates {
        let side = if self.mirrored { -1.0 } else { 1.0 };
        Rates {
            speed_mps: rates.speed_mps / self.pace,
            turn_rate_rad_s: side * rates.turn_rate_rad_s / self.pace,
            strafe_mps: side * rates.strafe_mps / self.pace,
        }
    }

    /// The other clip on this clip.
    pub(crate) fn inverse(&self) -> Self {
        Self { mirrored: self.mirrored, start_s: -self.start_s / self.pace, pace: 1.0 / self.pace }
    }

    /// This clip on a third one, from the other clip's alignment on the third.
    pub(crate) fn then(&self, next: &Self) -> Self {
        Self {
            mirrored: self.mirrored != next.mirrored,
            start_s: next.start_s + next.pace * self.start_s,
            pace: next.pace * self.pace,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_is_the_same_time() {
        let there = Alignment { mirrored: true, start_s: 3.0, pace: 0.5 };
        let again = Alignment { start_s: -1.0, pace: 4.0, ..there };
        assert_eq!(there.then(&there.inverse()), Alignment::IDENTITY);
        assert_eq!(again.at(there.at([1.0, 2.0])), there.then(&again).at([1.0, 2.0]));
    }
}
