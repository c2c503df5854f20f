//! The `[shot]` table: which moments of a simulation become frames, and how long the shutter is open.
//!
//! ```toml
//! [shot]
//! preroll_s = 4                       # simulated, not rendered
//! first_frame = 1001                  # number of the first file
//! fps = 24                            # also 23.976 (24000/1001); default: `frame_rate_hz` of `[view]`
//! samples_per_frame = 8               # moments that a frame blends: motion blur
//! shutter_deg = 180                   # 360 is a whole frame
//! ```

use serde::{Deserialize, Serialize};

/// Number of a sequence's first frame, as film tools expect it.
pub const FIRST_FRAME: u32 = 1001;

/// A shot, as written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ShotSpec {
    /// Simulated time before the first frame, s.
    pub preroll_s: f32,
    /// Number of the first frame.
    pub first_frame: u32,
    /// Frames per second; the view's frame rate where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fps: Option<f32>,
    /// Number of moments that a frame blends; 1 is sharp.
    pub samples_per_frame: u32,
    /// Time for which the shutter is open, degrees: 360 is the time of a frame.
    pub shutter_deg: f32,
}

impl Default for ShotSpec {
    fn default() -> Self {
        Self { preroll_s: 0.0, first_frame: FIRST_FRAME, fps: None, samples_per_frame: 1, shutter_deg: 180.0 }
    }
}

/// A frame rate as a fraction, frames per second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRate {
    /// Numerator.
    pub frames: u32,
    /// Denominator.
    pub seconds: u32,
}

impl FrameRate {
    /// A whole number, a broadcast rate n·1000/1001, thousandths, or else millionths.
    ///
    /// ```
    /// use fbcrowd_sim::scenario::FrameRate;
    ///
    /// assert_eq!(FrameRate::of(23.976), FrameRate { frames: 24_000, seconds: 1001 });
    /// assert_eq!(FrameRate::of(25.0).time_s(50), 2.0);
    /// ```
    pub fn of(rate_hz: f32) -> Self {
        let (whole, broadcast) = (rate_hz.round(), (rate_hz * 1.001).round());
        let thousandths = (rate_hz * 1000.0).round();
        if (rate_hz - whole).abs() < 1e-4 && whole > 0.0 {
            Self { frames: whole as u32, seconds: 1 }
        } else if (rate_hz * 1.001 - broadcast).abs() < 1e-3 && broadcast > 0.0 {
            Self { frames: broadcast as u32 * 1000, seconds: 1001 }
        } else if (rate_hz * 1000.0 - thousandths).abs() < 1e-2 {
            Self { frames: thousandths as u32, seconds: 1000 }
        } else {
            Self { frames: (rate_hz * 1e6).round() as u32, seconds: 1_000_000 }
        }
    }

    /// Time of a number of frames, s.
    pub fn time_s(self, frames: u32) -> f64 {
        f64::from(frames) * f64::from(self.seconds) / f64::from(self.frames)
    }

    /// Frames per second.
    pub fn hz(self) -> f64 {
        f64::from(self.frames) / f64::from(self.seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_rates_become_exact_fractions() {
        let cases = [
            (30.0, (30, 1)),
            (29.97, (30_000, 1001)),
            (23.976, (24_000, 1001)),
            (59.94, (60_000, 1001)),
            (12.5, (12_500, 1000)),
            (0.12345, (123_450, 1_000_000)),
        ];
        for (rate_hz, (frames, seconds)) in cases {
            assert_eq!(FrameRate::of(rate_hz), FrameRate { frames, seconds }, "{rate_hz}");
        }
    }
}
