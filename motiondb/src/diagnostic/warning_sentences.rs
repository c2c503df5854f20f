//! The sentences of warnings, for people.

use std::fmt;

use crate::diagnostic::{ClipEnd, HeldPart, Warning, and_left_out, and_mirrored, of_example};

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
            Self::FrameCountWrong { stated, rows } => frame_count_wrong(out, *stated, *rows),
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
            Self::FramesDropped { share } => frames_dropped(out, *share),
            Self::FramesRepeated { share } => frames_repeated(out, *share),
            Self::ForwardAgainstFeet { forward } => write!(
                out,
                "both feet point away from {forward}, so the body walks backward; correct `forward` in the manifest.toml"
            ),
            Self::CarriageUnlike { part, angle_deg, from_s } => carriage_unlike(out, *part, *angle_deg, *from_s),
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

fn frame_count_wrong(out: &mut fmt::Formatter<'_>, stated: f64, rows: u32) -> fmt::Result {
    let again = if f64::from(rows) < stated { "export the whole file again, or " } else { "" };
    write!(out, "`Frames:` states {stated}, but the file has {rows} rows, which are used; {again}correct the header")
}

fn frames_dropped(out: &mut fmt::Formatter<'_>, share: f32) -> fmt::Result {
    write!(
        out,
        "about {:.0} % of the frames are missing, so the motion is too fast by as much; record or export the clip again \
         without gaps",
        100.0 * share
    )
}

fn frames_repeated(out: &mut fmt::Formatter<'_>, share: f32) -> fmt::Result {
    write!(
        out,
        "{:.0} % of the frames repeat the one before; if the motion is too slow by as much, state the right `frame_rate_hz` \
         in a manifest.toml, else export the clip without repeated frames",
        100.0 * share
    )
}

fn carriage_unlike(out: &mut fmt::Formatter<'_>, part: HeldPart, angle_deg: f32, from_s: Option<f32>) -> fmt::Result {
    write!(
        out,
        "{} is held {angle_deg:.0}° off how the other walks hold it{}; to keep this manner apart, give the clip a `style` in a \
         manifest.toml",
        part.name(),
        of_example(from_s)
    )
}
