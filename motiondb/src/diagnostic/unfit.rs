//! Reasons why a clip, or a steady window of it, gives no example. The stage that finds a reason returns it as a value;
//! later stages match on it.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::body::skeleton::Side;
use crate::diagnostic::{Posture, and_mirrored};
use crate::motion::parameters::Parameters;

/// Greatest difference in speed between two halves of a steady lone stride, m/s.
const HALF_SPEED_MPS: f64 = 0.2;
/// The same as a share of their mean; the greater of both limits counts.
const HALF_SPEED_SHARE: f64 = 0.25;
/// Greatest difference in turn rate between the two steps of a steady lone stride, rad/s: 60 °/s; a straight run sways
/// by it.
pub const STEP_TURN_RAD_S: f64 = 60.0 * std::f64::consts::PI / 180.0;

/// Greatest difference in speed between two halves of a steady lone stride of these least and greatest speeds, m/s.
pub fn half_speed_limit_mps([least_mps, greatest_mps]: [f64; 2]) -> f64 {
    HALF_SPEED_MPS.max(HALF_SPEED_SHARE * 0.5 * (least_mps + greatest_mps))
}

/// Reason why a clip gives no example.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unfit {
    /// The body does not stand along the axis that the manifest states to be up.
    UpContradicted {
        /// Axis that the manifest states: `+X` … `-Z`.
        stated: String,
        /// Axis along which the body stands.
        found: String,
    },
    /// The steps are not human: the frame time is wrong, and with it all speeds.
    InhumanGait {
        /// Median length of a step, cm.
        step_cm: f32,
        /// Median number of steps a minute.
        steps_per_min: f32,
    },
    /// No foot both lands and leaves, and the body does not stand.
    NoStep,
    /// Feet step, but not one after the other.
    NoWholeStride,
    /// There are strides, but none is steady. Databases of earlier compilers hold it; [`Unfit::StridesUneven`] has taken
    /// its place.
    NoSteadyStride,
    /// The pelvis leaves the reach of the legs.
    PelvisOutOfReach,
    /// Feet are planted for less of the cycle than in any gait.
    FeetHardlyPlanted {
        /// Share of the cycle, mean of both feet.
        planted_share: f32,
    },
    /// Planted feet slide so much that they show no stance.
    FeetSlide {
        /// Mean slide over the cycle, cm/s.
        slide_cm_s: f32,
    },
    /// A foot has no contact where its mid-stance should be.
    NoMidStance {
        /// Side of the foot.
        foot: Side,
    },
    /// The middle of a foot's contact is not at the phase that defines its mid-stance.
    MidStanceOff {
        /// Side of the foot.
        foot: Side,
        /// Distance between both, as a share of the cycle.
        share: f32,
    },
    /// The root does not move as the planted feet show.
    RootContradicted {
        /// Parameters of the root's motion.
        root: Parameters,
        /// Parameters that the planted feet imply.
        feet: Parameters,
        /// Misfit between both, m/s.
        misfit_mps: f32,
        /// Greatest misfit that is accepted, m/s.
        limit_mps: f32,
    },
    /// Another clip is a better copy of the same recording.
    SameTake {
        /// Name of the other clip, which gives the recording's examples.
        other: String,
        /// Whether one is the other's mirror image.
        mirrored: bool,
        /// Whether the two copies have different frame times: then one of them is wrong.
        frame_times_differ: bool,
    },
    /// The body is not upright.
    NotUpright {
        /// What the body does instead.
        posture: Posture,
    },
    /// The body stands in a T-pose.
    TPose,
    /// The body moves along the line from its feet to its shoulders.
    MovesLengthwise,
    /// There are strides, but the body starts, stops or turns in all of them.
    StridesUneven {
        /// Of the steadiest stride: least and greatest speed over half of its period, m/s.
        speeds_mps: [f32; 2],
        /// Of the steadiest stride: turn rates of its two steps, rad/s.
        turn_rates_rad_s: [f32; 2],
    },
    /// The body stands with straight arms that point away from it, as in a bind pose.
    ArmsOut,
    /// The body stands with a raised arm, as one that aims.
    ArmRaised,
    /// The last pose of the closed cycle turns a joint to the first faster than any pose within it.
    CycleOpen {
        /// Turn from the last pose to the first, rad.
        seam_rad: f32,
        /// Greatest turn from pose to pose within the cycle, rad.
        largest_rad: f32,
    },
    /// Feet slide or are hardly planted, and a blend of clips with cleaner feet reaches the same parameters.
    CleanerClips,
    /// The manifest states that the clip shows a transition.
    StatedTransition,
    /// The body lies: it stretches along another axis than the same rig where it walks.
    LiesDown {
        /// Axis along which the body stretches: `+X` … `-Z`.
        found: String,
        /// Axes that are up where the rig walks.
        walks: Vec<String>,
    },
}

impl Unfit {
    /// Stable name of the reason; see [`crate::diagnostic::Diagnostic::code`].
    pub fn code(&self) -> &'static str {
        match self {
            Self::UpContradicted { .. } => "up_contradicted",
            Self::InhumanGait { .. } => "inhuman_gait",
            Self::NoStep => "no_step",
            Self::NoWholeStride => "no_whole_stride",
            Self::NoSteadyStride => "no_steady_stride",
            Self::PelvisOutOfReach => "pelvis_out_of_reach",
            Self::FeetHardlyPlanted { .. } => "feet_hardly_planted",
            Self::FeetSlide { .. } => "feet_slide",
            Self::NoMidStance { .. } => "no_mid_stance",
            Self::MidStanceOff { .. } => "mid_stance_off",
            Self::RootContradicted { .. } => "root_contradicted",
            Self::SameTake { .. } => "same_take",
            Self::NotUpright { .. } => "not_upright",
            Self::TPose => "t_pose",
            Self::MovesLengthwise => "moves_lengthwise",
            Self::StridesUneven { .. } => "strides_uneven",
            Self::ArmsOut => "arms_out",
            Self::ArmRaised => "arm_raised",
            Self::CycleOpen { .. } => "cycle_open",
            Self::CleanerClips => "cleaner_clips",
            Self::StatedTransition => "stated_transition",
            Self::LiesDown { .. } => "lies_down",
        }
    }
}

impl fmt::Display for Unfit {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UpContradicted { stated, found } => write!(
                out,
                "the manifest states that up is {stated}, but the body stands along {found}; correct `up`, or remove it"
            ),
            Self::InhumanGait { step_cm, steps_per_min } => write!(
                out,
                "steps of {step_cm:.0} cm, {steps_per_min:.0} a minute, are not a human gait; state the right \
                 `frame_rate_hz` in a manifest.toml"
            ),
            Self::NoStep => out.write_str(
                "no foot was found that both lands and leaves the ground, and the body does not stand; use a clip of a \
                 steady gait, at least a stride and a half (1.5 to 2 s of a walk)",
            ),
            Self::NoWholeStride => out.write_str(
                "no whole stride, a step of each foot, was found; use at least a stride and a half (1.5 to 2 s of a walk), \
                 or a loop whose last pose leads into its first",
            ),
            Self::NoSteadyStride => out
                .write_str("no steady stride was found: each differs from its neighbours; use a clip of a steady gait"),
            Self::PelvisOutOfReach => {
                out.write_str("the pelvis leaves the reach of the legs; correct the root's motion")
            }
            Self::FeetHardlyPlanted { planted_share } => write!(
                out,
                "feet are planted for only {:.0} % of the cycle; repair the clip, or use another one",
                100.0 * planted_share
            ),
            Self::FeetSlide { slide_cm_s } => {
                write!(out, "planted feet slide by {slide_cm_s:.0} cm/s; repair the clip, or use another one")
            }
            Self::NoMidStance { foot } => {
                write!(out, "the {} foot has no contact about its mid-stance; use another clip", side_name(*foot))
            }
            Self::MidStanceOff { foot, share } => write!(
                out,
                "the {} foot's contact is {:.0} % of the cycle off its mid-stance; use another clip",
                side_name(*foot),
                100.0 * share
            ),
            Self::RootContradicted { root, feet, misfit_mps, limit_mps } => write!(
                out,
                "the root moves at {}, but the planted feet show {}: {misfit_mps:.3} m/s apart, above {limit_mps:.3}; \
                 correct the root's motion",
                parameter_text(*root),
                parameter_text(*feet)
            ),
            Self::SameTake { other, mirrored, frame_times_differ } => {
                same_take(out, other, *mirrored, *frame_times_differ)
            }
            Self::NotUpright { posture } => write!(
                out,
                "the body {posture}; use a clip of an upright body, or state `posture = \"any\"` in a manifest.toml"
            ),
            Self::TPose => out.write_str("the body stands in a T-pose; use a clip of a body that stands at ease"),
            Self::ArmsOut => out.write_str(
                "the body stands with its arms spread, as in a bind pose; use a clip of a body that stands at ease",
            ),
            Self::ArmRaised => out.write_str(
                "the body stands with a raised arm, as one that aims; use a clip of a body that stands at ease",
            ),
            Self::CycleOpen { seam_rad, largest_rad } => write!(
                out,
                "the closed stride jumps: its end turns a joint by {:.0}° to its beginning, other poses by {:.0}° at most; \
                 use a steadier part",
                seam_rad.to_degrees(),
                largest_rad.to_degrees()
            ),
            Self::CleanerClips => out.write_str(
                "clips with cleaner feet reach its speed and give the examples in its place; repair its feet, or leave it \
                 out",
            ),
            Self::StatedTransition => out.write_str(
                "the manifest states that it shows a transition, which joins examples of other clips, of walking and of \
                 standing",
            ),
            Self::LiesDown { found, walks } => write!(
                out,
                "the body lies: it stretches along {found}, but the same rig walks with {} up; leave it out, or state `up` \
                 in a manifest.toml if it stands",
                walks.join(" or ")
            ),
            Self::MovesLengthwise => out.write_str(
                "the body moves along its own length, as in a jump, a climb or a crawl, or in kneeling down and rising; use a \
                 clip of walking or standing",
            ),
            Self::StridesUneven { speeds_mps, turn_rates_rad_s } => {
                strides_uneven(out, *speeds_mps, turn_rates_rad_s.map(f32::to_degrees))
            }
        }
    }
}

fn same_take(out: &mut fmt::Formatter<'_>, other: &str, mirrored: bool, frame_times_differ: bool) -> fmt::Result {
    write!(out, "the same take as {other}{}, which gives the example", and_mirrored(mirrored))?;
    if frame_times_differ {
        out.write_str(", but at another frame time; state the right `frame_rate_hz` in a manifest.toml")?;
    }
    Ok(())
}

fn strides_uneven(
    out: &mut fmt::Formatter<'_>,
    speeds_mps: [f32; 2],
    [first_deg_s, second_deg_s]: [f32; 2],
) -> fmt::Result {
    let [least_mps, greatest_mps] = speeds_mps;
    write!(
        out,
        "no steady stride was found: in the steadiest one the speed varies from {least_mps:.2} to {greatest_mps:.2} m/s \
         (at most {:.2} apart), and its steps turn by {first_deg_s:.0} and {second_deg_s:.0} °/s (at most {:.0} apart); \
         use a clip of a steady gait",
        half_speed_limit_mps(speeds_mps.map(f64::from)),
        STEP_TURN_RAD_S.to_degrees()
    )
}

fn side_name(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

fn parameter_text(Parameters { speed_mps, turn_rate_rad_s, strafe_mps }: Parameters) -> String {
    format!("{speed_mps:.2} m/s, {:.0} °/s and {strafe_mps:.2} m/s to the left", turn_rate_rad_s.to_degrees())
}
