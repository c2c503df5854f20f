//! Flaws of a steady window: how far it is from a clean cycle. The window with the fewest flaws is kept of near-equal
//! ones.
//!
//! A sum without unit. Each term is 1 where it could hardly be worse.

use motiondb::quality::planted_feet::FootSlide;
use motiondb::statistics::mean;

use crate::cycle::rest::Rest;
use crate::cycle::{foot_slide, rate_cells};
use crate::gait::stride::{STRIDE_GAP_M, Stride};
use crate::ground::root_arc::Rates;

/// Duration of a rest as flawed as a lone stride, s.
const REST_S: f64 = 1.0;

/// The flaws of a mean stride: the gap before it is closed, slide, distance from the middle of its cell
/// ([`rate_cells`]), and fewness of strides.
pub(crate) fn flaws_of_strides(strides: &[Stride], rates: &Rates, slide: &FootSlide) -> f64 {
    let gap_m = mean(strides.iter().map(|stride| stride.gap_m)).unwrap_or(0.0);
    gap_m / STRIDE_GAP_M
        + foot_slide::relative_slide(rates, slide)
        + rate_cells::distance_from_middle(rates)
        + 1.0 / strides.len() as f64
}

/// The flaws of a rest: the longer it is, the calmer is its calmest part; arms that hang suit every crowd, an aimed gun
/// none.
pub(crate) fn flaws_of_rest(rest: &Rest) -> f64 {
    REST_S / rest.duration_s + rest.arms_raised
}
