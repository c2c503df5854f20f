//! Flaws of a steady window: how far it is from a clean cycle. The window with the fewest flaws is kept of near-equal
//! ones.
//!
//! A sum without unit. Each term is 1 where it could hardly be worse.

use motiondb::diagnostic::Diagnostic;
use motiondb::quality::planted_feet::FootSlide;
use motiondb::statistics::mean;

use crate::cycle::rest::Rest;
use crate::cycle::{foot_slide, rate_cells};
use crate::gait::standing::STANDING_JOINT_SPEED_MPS;
use crate::gait::stride::{STRIDE_GAP_M, Stride};
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::HumanClip;

/// Duration of a rest as flawed as a lone stride, s.
const REST_S: f64 = 1.0;
/// Greatest lean of the trunk of a rest without flaw, degrees.
const UPRIGHT_LEAN_DEG: f64 = 15.0;
/// Lean beyond [`UPRIGHT_LEAN_DEG`] that counts as one flaw, degrees.
const BENT_LEAN_DEG: f64 = 30.0;
/// Least height of the hips over the ankles of straight legs, leg lengths.
const STRAIGHT_LEGS: f64 = 0.9;
/// Height lost as flawed as a lone stride, leg lengths: a deep crouch loses .25.
const BENT_LEGS: f64 = 0.1;
/// Parts of the names of clips that show a body at ease.
const STANDING_NAMES: [&str; 6] = ["idle", "stand", "breath", "rest", "wait", "neutral"];
/// Flaws of a rest in a clip of another name: as much as arms that are half raised.
const OTHER_NAME_FLAWS: f64 = 0.5;
/// Flaws of a rest for each warning about its clip.
const WARNING_FLAWS: f64 = 0.25;

/// The flaws of a mean stride: the gap before it is closed, slide, distance from the middle of its cell
/// ([`rate_cells`]), and fewness of strides.
pub(crate) fn flaws_of_strides(strides: &[Stride], rates: &Rates, slide: &FootSlide) -> f64 {
    let gap_m = mean(strides.iter().map(|stride| stride.gap_m)).unwrap_or(0.0);
    gap_m / STRIDE_GAP_M
        + foot_slide::relative_slide(rates, slide)
        + rate_cells::distance_from_middle(rates)
        + 1.0 / strides.len() as f64
}

/// The flaws of a rest: it is short, its arms are raised, its trunk or its legs are bent, its joints move.
pub(crate) fn flaws_of_rest(rest: &Rest) -> f64 {
    let bent = (rest.lean_deg - UPRIGHT_LEAN_DEG).max(0.0) / BENT_LEAN_DEG;
    let bent = bent + (STRAIGHT_LEGS - rest.hips_legs).max(0.0) / BENT_LEGS;
    REST_S / rest.duration_s + rest.arms_raised + bent + rest.joint_speed_mps / STANDING_JOINT_SPEED_MPS
}

/// The flaws that every rest of a clip has: the clip's name does not say that the body stands, and the clip has warnings.
pub(crate) fn standing_flaws(clip: &HumanClip) -> f64 {
    let name = clip.name.to_lowercase();
    let is_named = STANDING_NAMES.iter().any(|word| name.contains(word));
    let is_warning = |found: &&Diagnostic| matches!(found, Diagnostic::Warning(_));
    let warnings = clip.source.diagnostics.iter().filter(is_warning).count() as f64;
    if is_named { WARNING_FLAWS * warnings } else { OTHER_NAME_FLAWS + WARNING_FLAWS * warnings }
}
