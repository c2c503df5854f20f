//! Why strides make no window: there is none, or the steadiest is still uneven. Times in frames of the clip.

use std::ops::Range;

use motiondb::diagnostic::Unfit;

use crate::gait::steady_strides::{ClipSteps, unevenness};
use crate::gait::stride::Stride;

/// Why no window of strides was found in these frames.
pub(crate) fn why_unsteady(steps: &ClipSteps, frames: &Range<usize>) -> Unfit {
    if steps.landmarks.is_empty() {
        return Unfit::NoStep;
    }
    let is_within =
        |stride: &&Stride| stride.first_frame() >= frames.start as f64 && stride.last_frame() <= frames.end as f64;
    let strides = steps.strides.iter().flatten().filter(is_within);
    strides.min_by(|a, b| unevenness(a).total_cmp(&unevenness(b))).map_or(Unfit::NoWholeStride, |steadiest| {
        Unfit::StridesUneven {
            speeds_mps: steadiest.half_speeds_mps.map(|speed| speed as f32),
            turn_rates_rad_s: steadiest.step_turn_rates_rad_s.map(|rate| rate as f32),
        }
    })
}

#[cfg(test)]
mod tests {
    use motiondb::body::Side;

    use super::*;
    use crate::gait::stride::Landmark;

    #[test]
    fn the_steadiest_of_uneven_strides_is_reported() {
        let landmark = |side, frame| Landmark { side, frame };
        let stride = |half_speeds_mps| Some(Stride { half_speeds_mps, ..Stride::default() });
        let steps = |strides| ClipSteps { landmarks: vec![landmark(Side::Left, 1.0)], strides };
        let uneven = why_unsteady(&steps(vec![stride([0.1, 1.0]), None, stride([0.4, 0.9])]), &(0..9));
        assert_eq!(uneven, Unfit::StridesUneven { speeds_mps: [0.4, 0.9], turn_rates_rad_s: [0.0; 2] });
        assert_eq!(why_unsteady(&steps(vec![None]), &(0..9)), Unfit::NoWholeStride);
    }
}
