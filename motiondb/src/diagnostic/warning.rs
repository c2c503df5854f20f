//! Warnings: doubtful facts about a clip that is used nevertheless.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::diagnostic::{ClipEnd, HeldPart, and_left_out, and_mirrored, of_example};

/// A doubtful fact about a clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Warning {
    /// The legs are shorter or longer than any human's. If the unit is wrong, so are all speeds.
    InhumanSize {
        /// Length of thigh plus shank, m.
        leg_m: f32,
    },
    /// In the unit that the file format defines, the leg length is impossible; the compiler uses another unit.
    UnitRejected {
        /// Length of thigh plus shank in the format's unit, m.
        leg_m: f32,
    },
    /// Toes and knees contradict the sides that the joints' names state: left and right are exchanged.
    SidesExchanged,
    /// The body's position jumps between two frames.
    Leap {
        /// Distance of the first leap, m.
        distance_m: f32,
        /// Frame before the first leap, from 1.
        frame: u32,
        /// Number of further leaps in the clip.
        more: u32,
    },
    /// The ground rises or falls.
    Slope {
        /// Rise per step, cm; negative for a descent.
        rise_cm: f32,
    },
    /// On average over the source clip, feet that should carry the body slide over the ground. The compiler checks this
    /// before it cuts examples out of the clip; [`Warning::FeetSlide`] concerns the cycle of one example.
    Skating {
        /// Speed of the body, m/s.
        body_mps: f32,
        /// Speed of the feet on the ground, m/s.
        slide_mps: f32,
        /// Whether the feet step.
        steps: bool,
    },
    /// The body turns and makes no step.
    TurnWithoutStep {
        /// Turn rate, counter-clockwise positive, rad/s.
        turn_rate_rad_s: f32,
    },
    /// Both feet are off the ground, and the body makes no step.
    Jump {
        /// Height of the lower foot, cm.
        lift_cm: f32,
    },
    /// Planted feet slide in the cycle of one example; [`Warning::Skating`] concerns the whole source clip.
    FeetSlide {
        /// Mean slide over the cycle, cm/s.
        slide_cm_s: f32,
        /// Start of the example, s; `None` for the clip's first.
        from_s: Option<f32>,
    },
    /// Feet are hardly planted.
    FeetHardlyPlanted {
        /// Share of the cycle in which a foot is planted, mean of both feet.
        planted_share: f32,
        /// Start of the example, s; `None` for the clip's first.
        from_s: Option<f32>,
    },
    /// A BVH header states another number of frames than the file has.
    FrameCountWrong {
        /// Number that the header states.
        stated: f64,
        /// Number of rows in the file.
        rows: u32,
    },
    /// A T-pose is not cut off, because too little motion remains without it.
    TPoseKept {
        /// Number of frames of the T-pose and of the motion between it and the clip.
        frames: u32,
        /// Whether the T-pose is at the beginning or at the end.
        end: ClipEnd,
    },
    /// Two copies of one recording have different frame times: one of them is wrong.
    FrameTimesDiffer {
        /// Names of other copies.
        others: Vec<String>,
        /// Number of further copies, which are not named.
        more: u32,
        /// Whether one is the other's mirror image.
        mirrored: bool,
        /// Number of steady windows not used, because the other copy has a better version.
        windows_left_out: u32,
    },
    /// The clip is not compared with others: the set has too many clips to search all for duplicates.
    NotCompared {
        /// Number of clips that are compared; these are the longest.
        compared: u32,
    },
    /// Another unit may be the right one: it is nearly as likely, is more common, or fits this clip better than the unit of
    /// its rig. If the unit is wrong, so are all speeds.
    UnitDoubtful {
        /// Length of thigh plus shank in the unit used, m.
        leg_m: f32,
        /// Length of thigh plus shank in the other unit, m.
        other_leg_m: f32,
        /// The other unit, m.
        other_unit_m: f64,
    },
    /// The steps are those of a walk in slow motion. If the frame time is wrong, so are all speeds.
    FrameTimeDoubtful {
        /// Median length of a step, cm.
        step_cm: f32,
        /// Median number of steps a minute.
        steps_per_min: f32,
        /// Frame rate that is used, Hz.
        frame_rate_hz: f32,
    },
    /// The clips of a style give no example.
    StyleWithoutExample {
        /// The style.
        style: String,
    },
    /// No clip of a style walks, runs or steps.
    StyleWithoutStride {
        /// The style.
        style: String,
    },
    /// The pose jumps from one frame to the next, or within a thirtieth of a second.
    PoseJumps {
        /// Time of the greatest jump, s.
        at_s: f32,
        /// Greatest displacement of a joint in it, cm.
        distance_cm: f32,
        /// Number of further jumps in the clip.
        more: u32,
    },
    /// No foot steps, and joints hardly turn: the file's angles seem to be radians.
    RadiansLikely {
        /// Greatest turn of a joint since the first frame, rad.
        turned_rad: f32,
    },
    /// All frames hold the same pose.
    PoseFrozen,
    /// The steps are those of motion played too fast. If the frame time is wrong, so are all speeds.
    QuickMotion {
        /// Median length of a step, cm.
        step_cm: f32,
        /// Median number of steps a minute.
        steps_per_min: f32,
        /// Frame rate that is used, Hz.
        frame_rate_hz: f32,
    },
    /// The whole body leans to a side while it goes straight on, as on ground that is tilted.
    LeansAside {
        /// Mean angle from ankles to neck, degrees; positive to the left.
        lean_deg: f32,
        /// Start of the example, s; `None` for the clip's first.
        from_s: Option<f32>,
    },
    /// The body walks with its trunk bent.
    TrunkBent {
        /// Mean angle of the trunk off the vertical, degrees.
        lean_deg: f32,
        /// Start of the example, s; `None` for the clip's first.
        from_s: Option<f32>,
    },
    /// The frame rate differs from that of the rig's other clips, with which the steps would be usual. If it is wrong, so
    /// are all speeds.
    RareFrameRate {
        /// Frame rate that is used, Hz.
        frame_rate_hz: f32,
        /// Frame rate of the other clips, Hz.
        usual_hz: f32,
        /// Steps a minute at either rate.
        steps_per_min: [f32; 2],
    },
    /// The shoulders are turned against the hips throughout. The body faces between them, so that a walk straight ahead
    /// counts as one to the side.
    TrunkTwisted {
        /// Mean angle of the shoulders from the hips, degrees; positive to the left.
        twist_deg: f32,
        /// Start of the example, s; `None` for the clip's first.
        from_s: Option<f32>,
    },
    /// Frames are missing: the others are played as if none were, so all speeds are too high.
    FramesDropped {
        /// Share of the frames that are missing.
        share: f32,
    },
    /// Frames repeat the one before: if the time between them is that of the file, the motion is too slow.
    FramesRepeated {
        /// Share of the frames that repeat another one.
        share: f32,
    },
    /// Both feet point away from the facing that a manifest states.
    ForwardAgainstFeet {
        /// The stated axis.
        forward: String,
    },
    /// The body holds a part otherwise than in the other walks of its style.
    CarriageUnlike {
        /// The part.
        part: HeldPart,
        /// Angle between its mean direction and that in the other walks, degrees.
        angle_deg: f32,
        /// Start of the example, s; `None` for the clip's first.
        from_s: Option<f32>,
    },
}

impl Warning {
    /// Stable name of the warning; see [`crate::diagnostic::Diagnostic::code`].
    pub fn code(&self) -> &'static str {
        match self {
            Self::InhumanSize { .. } => "inhuman_size",
            Self::UnitRejected { .. } => "unit_rejected",
            Self::UnitDoubtful { .. } => "unit_doubtful",
            Self::SidesExchanged => "sides_exchanged",
            Self::Leap { .. } => "leap",
            Self::Slope { .. } => "slope",
            Self::Skating { .. } => "skating",
            Self::TurnWithoutStep { .. } => "turn_without_step",
            Self::Jump { .. } => "jump",
            Self::PoseJumps { .. } => "pose_jumps",
            Self::FeetSlide { .. } => "feet_slide",
            Self::FeetHardlyPlanted { .. } => "feet_hardly_planted",
            Self::FrameCountWrong { .. } => "frame_count_wrong",
            Self::TPoseKept { .. } => "t_pose_kept",
            Self::FrameTimesDiffer { .. } => "frame_times_differ",
            Self::NotCompared { .. } => "not_compared",
            Self::FrameTimeDoubtful { .. } => "frame_time_doubtful",
            Self::StyleWithoutExample { .. } => "style_without_example",
            Self::StyleWithoutStride { .. } => "style_without_stride",
            Self::RadiansLikely { .. } => "radians_likely",
            Self::PoseFrozen => "pose_frozen",
            Self::QuickMotion { .. } => "quick_motion",
            Self::LeansAside { .. } => "leans_aside",
            Self::TrunkBent { .. } => "trunk_bent",
            Self::RareFrameRate { .. } => "rare_frame_rate",
            Self::TrunkTwisted { .. } => "trunk_twisted",
            Self::FramesDropped { .. } => "frames_dropped",
            Self::FramesRepeated { .. } => "frames_repeated",
            Self::ForwardAgainstFeet { .. } => "forward_against_feet",
            Self::CarriageUnlike { .. } => "carriage_unlike",
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InhumanSize { leg_m } => write!(
                out,
                "thigh and shank are {leg_m:.2} m long, unlike any human's; if the unit is wrong, state \
                 `metres_per_unit` in a manifest.toml"
            ),
            Self::UnitRejected { leg_m } => write!(
                out,
                "thigh and shank would be {leg_m:.2} m long in the format's unit, so another unit is used; if that is \
                 wrong, state `metres_per_unit` in a manifest.toml"
            ),
            Self::UnitDoubtful { leg_m, other_leg_m, other_unit_m } => write!(
                out,
                "the unit is doubtful: thigh and shank are taken to be {leg_m:.2} m long; if they are {other_leg_m:.2} m \
                 long, state `metres_per_unit = {other_unit_m}` in a manifest.toml"
            ),
            Self::FrameTimeDoubtful { step_cm, steps_per_min, frame_rate_hz } => {
                let steps = format!("steps of {step_cm:.0} cm, only {steps_per_min:.0} a minute, look like slow motion");
                frame_rate_doubtful(out, &steps, *frame_rate_hz)
            }
            Self::QuickMotion { step_cm, steps_per_min, frame_rate_hz } => {
                let steps =
                    format!("steps of only {step_cm:.0} cm, {steps_per_min:.0} a minute, look like motion played too fast");
                frame_rate_doubtful(out, &steps, *frame_rate_hz)
            }
            Self::SidesExchanged => out.write_str(
                "toes and knees contradict the joints' names, so left and right are exchanged, as in a left-handed file; \
                 if the names are right, state `joints` in a manifest.toml",
            ),
            Self::Leap { distance_m, frame, more } => leap(out, *distance_m, *frame, *more),
            Self::Slope { rise_cm } => slope(out, *rise_cm),
            Self::Skating { body_mps, slide_mps, steps } => skating(out, *body_mps, *slide_mps, *steps),
            Self::TurnWithoutStep { turn_rate_rad_s } => write!(
                out,
                "the body turns at {:.0} °/s without a step, as on a turntable; correct the root's motion",
                turn_rate_rad_s.to_degrees()
            ),
            Self::PoseJumps { at_s, distance_cm, more } => pose_jumps(out, *at_s, *distance_cm, *more),
            Self::Jump { lift_cm } => write!(
                out,
                "the body jumps: both feet leave the ground by {lift_cm:.0} cm; select other `frames` in a manifest.toml"
            ),
            Self::FeetSlide { slide_cm_s, from_s } => write!(
                out,
                "planted feet slide by {slide_cm_s:.0} cm/s{}; repair the clip, or use another one",
                of_example(*from_s)
            ),
            Self::FeetHardlyPlanted { planted_share, from_s } => write!(
                out,
                "feet are planted for only {:.0} % of the cycle{}; repair the clip, or use another one",
                100.0 * planted_share,
                of_example(*from_s)
            ),
            Self::FrameCountWrong { stated, rows } => {
                let again = if f64::from(*rows) < *stated { "export the whole file again, or " } else { "" };
                write!(out, "`Frames:` states {stated}, but the file has {rows} rows, which are used; {again}correct the header")
            }
            Self::TPoseKept { frames, end } => t_pose(out, *frames, *end),
            Self::FrameTimesDiffer { others, more, mirrored, windows_left_out } => {
                frame_times_differ(out, others, *more, *mirrored, *windows_left_out)
            }
            Self::StyleWithoutExample { style } => style_without(out, style, "gives no example, so the database lacks it"),
            Self::StyleWithoutStride { style } => style_without(out, style, "has no stride, so its agents reach no goal"),
            Self::RadiansLikely { turned_rad } => write!(
                out,
                "no foot steps, and no joint turns by more than {:.1}°: the file seems to hold radians; export it with \
                 angles in degrees",
                turned_rad.to_degrees()
            ),
            Self::PoseFrozen => out.write_str(
                "all frames hold the same pose, so a body that stands in it does not move at all; use a clip of a body \
                 that stands at ease",
            ),
            Self::LeansAside { lean_deg, from_s } => leans_aside(out, *lean_deg, *from_s),
            Self::TrunkBent { lean_deg, from_s } => write!(
                out,
                "the trunk is bent by {lean_deg:.0}°{}; to keep this manner apart, give the clip a `style` in a manifest.toml",
                of_example(*from_s)
            ),
            Self::TrunkTwisted { twist_deg, from_s } => trunk_twisted(out, *twist_deg, *from_s),
            Self::FramesDropped { share } => write!(
                out,
                "about {:.0} % of the frames are missing, so the motion is too fast by as much; record or export the clip \
                 again without gaps",
                100.0 * share
            ),
            Self::FramesRepeated { share } => write!(
                out,
                "{:.0} % of the frames repeat the one before; if the motion is too slow by as much, state the right \
                 `frame_rate_hz` in a manifest.toml, else export the clip without repeated frames",
                100.0 * share
            ),
            Self::ForwardAgainstFeet { forward } => write!(
                out,
                "both feet point away from {forward}, so the body walks backward; correct `forward` in the manifest.toml"
            ),
            Self::CarriageUnlike { part, angle_deg, from_s } => write!(
                out,
                "{} is held {angle_deg:.0}° off how the other walks hold it{}; to keep this manner apart, give the clip a \
                 `style` in a manifest.toml",
                part.name(),
                of_example(*from_s)
            ),
            Self::RareFrameRate { frame_rate_hz, usual_hz, steps_per_min } => {
                rare_frame_rate(out, *frame_rate_hz, *usual_hz, *steps_per_min)
            }
            Self::NotCompared { compared } => write!(
                out,
                "duplicates of this clip are not searched for: only the {compared} longest clips are compared; compile \
                 fewer clips at once"
            ),
        }
    }
}

fn slope(out: &mut fmt::Formatter<'_>, rise_cm: f32) -> fmt::Result {
    let verb = if rise_cm > 0.0 { "climbs" } else { "descends" };
    write!(out, "the body {verb} {:.0} cm a step; use a clip on level ground", rise_cm.abs())
}

fn skating(out: &mut fmt::Formatter<'_>, body_mps: f32, slide_mps: f32, steps: bool) -> fmt::Result {
    let feet = if steps { "stance feet" } else { "feet take no step and" };
    write!(
        out,
        "the body moves at {body_mps:.1} m/s, but its {feet} slide over the ground at {slide_mps:.1} m/s; correct the \
         root's motion"
    )
}

fn frame_times_differ(
    out: &mut fmt::Formatter<'_>,
    others: &[String],
    more: u32,
    mirrored: bool,
    windows_left_out: u32,
) -> fmt::Result {
    let more = if more == 0 { String::new() } else { format!(" and {more} more") };
    write!(
        out,
        "the same take as {}{more}{}, but at another frame time{}; state the right `frame_rate_hz` in a manifest.toml",
        others.join(", "),
        and_mirrored(mirrored),
        and_left_out(windows_left_out)
    )
}

fn leap(out: &mut fmt::Formatter<'_>, distance_m: f32, frame: u32, more: u32) -> fmt::Result {
    let next = u64::from(frame) + 1;
    let more = match more {
        0 => String::new(),
        1 => " (1 further leap in the clip)".to_owned(),
        _ => format!(" ({more} further leaps in the clip)"),
    };
    write!(
        out,
        "the body leaps by {distance_m:.1} m from frame {frame} to frame {next}{more}, so its mean speeds are wrong; cut \
         the file there, or select `frames` in a manifest.toml"
    )
}

fn pose_jumps(out: &mut fmt::Formatter<'_>, at_s: f32, distance_cm: f32, more: u32) -> fmt::Result {
    let more = match more {
        0 => String::new(),
        1 => ", and at one other time by less".to_owned(),
        _ => format!(", and at {more} other times by less"),
    };
    write!(
        out,
        "the pose jumps by {distance_cm:.0} cm at {at_s:.2} s{more}; no example and no transition is made across; repair \
         the motion there"
    )
}

fn t_pose(out: &mut fmt::Formatter<'_>, frames: u32, end: ClipEnd) -> fmt::Result {
    let verb = match end {
        ClipEnd::First => "begins",
        ClipEnd::Last => "ends",
    };
    write!(
        out,
        "the clip {verb} with {frames} frames of T-pose; they are kept, because too little motion remains without them; \
         use a longer clip"
    )
}

/// Steps that another frame rate would explain.
fn frame_rate_doubtful(out: &mut fmt::Formatter<'_>, steps: &str, frame_rate_hz: f32) -> fmt::Result {
    write!(
        out,
        "{steps}; if the clip was recorded at another rate than {frame_rate_hz:.0} Hz, state the right \
         `frame_rate_hz` in a manifest.toml"
    )
}

fn rare_frame_rate(
    out: &mut fmt::Formatter<'_>,
    frame_rate_hz: f32,
    usual_hz: f32,
    [steps, at_usual]: [f32; 2],
) -> fmt::Result {
    write!(
        out,
        "{steps:.0} steps a minute at the stated {frame_rate_hz:.0} Hz are unusual; at {usual_hz:.0} Hz, the rate of the \
         rig's other clips, they are {at_usual:.0}; state the right `frame_rate_hz` in a manifest.toml"
    )
}

fn trunk_twisted(out: &mut fmt::Formatter<'_>, twist_deg: f32, from_s: Option<f32>) -> fmt::Result {
    let (twist_deg, side) = (twist_deg.abs(), if twist_deg > 0.0 { "left" } else { "right" });
    write!(
        out,
        "the shoulders are turned by {twist_deg:.0}° to the {side} of the hips{}; the body faces between both, so that a walk \
         straight ahead counts as one to the side. If it carries something or looks aside, give the clip a `style` in a \
         manifest.toml",
        of_example(from_s)
    )
}

fn leans_aside(out: &mut fmt::Formatter<'_>, lean_deg: f32, from_s: Option<f32>) -> fmt::Result {
    write!(
        out,
        "the whole body leans by {:.0}° to the {}{}, although it goes straight on: the ground seems to be tilted, or the \
         body carries something; bodies of the crowd lean, too. Turn the clip upright in another program, or leave it out",
        lean_deg.abs(),
        if lean_deg > 0.0 { "left" } else { "right" },
        of_example(from_s)
    )
}

fn style_without(out: &mut fmt::Formatter<'_>, style: &str, lack: &str) -> fmt::Result {
    write!(
        out,
        "style `{style}` {lack}; add a steady walk of this style, or state `style = \"\"` for its clips in a manifest.toml"
    )
}
