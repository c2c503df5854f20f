//! Notes: facts about a clip that is used as intended. Nothing is to be mended.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::diagnostic::{ClipEnd, Posture, Unfit, and_left_out, and_mirrored, of_example, steady_windows};

/// A fact about a clip that is used as intended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Note {
    /// The first frame is a separate pose and is cut off.
    FirstPoseCut,
    /// A T-pose and the motion between it and the clip are cut off.
    TPoseCut {
        /// Number of frames that are cut off.
        frames: u32,
        /// Whether the T-pose is at the beginning or at the end.
        end: ClipEnd,
    },
    /// Text follows the motion of a BVH file.
    TextAfterMotion {
        /// First line of that text, from 1.
        line: u32,
    },
    /// The last row of a BVH file has too few values and is cut off.
    LastRowIncomplete {
        /// Line of that row, from 1.
        line: u32,
    },
    /// Channels of a glTF file that animate no node (`KHR_animation_pointer`) are not read.
    PointersNotRead,
    /// A turn rate within gait noise is set to 0.
    TurnRateSnapped {
        /// Measured turn rate, rad/s.
        turn_rate_rad_s: f32,
        /// Start of the example, s; `None` for the clip's first.
        from_s: Option<f32>,
    },
    /// A side speed within gait noise is set to 0.
    StrafeSnapped {
        /// Measured side speed, m/s.
        strafe_mps: f32,
        /// Start of the example, s; `None` for the clip's first.
        from_s: Option<f32>,
    },
    /// Some steady windows of the clip give no example.
    WindowsLeftOut {
        /// Number of windows that are near-equal to examples.
        near_equal: u32,
        /// Number of windows whose feet slide or are hardly planted.
        doubtful: u32,
    },
    /// An example is left out because of `max_examples`.
    ExampleLeftOut {
        /// Name of the example.
        example: String,
        /// Greatest number of examples, as the manifest states it.
        max_examples: u32,
    },
    /// The clip steps and stands, and gives only an example that stands.
    OnlyRestUsed {
        /// Reason why the steps give no example.
        reason: Unfit,
    },
    /// Another clip is a better copy of the same recording.
    SameTake {
        /// Name of the other clip, which gives the recording's examples.
        other: String,
        /// Whether one is the other's mirror image.
        mirrored: bool,
        /// Number of steady windows not used, because the other copy has a better version.
        windows_left_out: u32,
    },
    /// Two examples have the same parameters, and the other is the better one.
    CoincidentExample {
        /// Name of the example that is not blended.
        example: String,
        /// Name of the example that is blended in its place.
        blended: String,
    },
    /// In parts of the clip the body is not upright. They give no examples.
    LowPartsLeftOut {
        /// What the body does in the longest of them.
        posture: Posture,
        /// First and last second of the longest.
        longest_s: [f32; 2],
        /// Duration of all of them, s.
        total_s: f32,
        /// Number of the others.
        more: u32,
    },
    /// Two examples have the same parameters, but their poses differ; one of them is blended.
    CoincidentManners {
        /// Name of the example that is not blended.
        example: String,
        /// Name of the example that is blended in its place.
        blended: String,
        /// Mean distance of the joints over the cycle, cm.
        distance_cm: f32,
    },
    /// A style without an idle stands as this clip of another style does.
    IdleOfOtherStyle {
        /// The style that lacks an idle.
        style: String,
        /// The style of the clip; empty where it has none.
        lender: String,
    },
    /// The clip has no style, and no clip without a style steps: it belongs to another style.
    AddedToStyle {
        /// The style.
        style: String,
    },
    /// The body turns sharply while it walks, in no example and no transition.
    CornersUnused {
        /// First and last second of the greatest of these turns.
        window_s: [f32; 2],
        /// Its turn, rad; positive to the left.
        turn_rad: f32,
        /// Number of the others.
        more: u32,
    },
    /// Moving joints of hands, feet and limbs are neither roles nor kept beside them.
    JointsLeftOut {
        /// Number of these joints.
        moving: u32,
        /// Number of joints that are kept beside the roles.
        kept: u32,
    },
    /// Frames at one end in which nothing moves are cut off.
    HeldPoseCut {
        /// Number of frames that are cut off.
        frames: u32,
        /// Whether the frames are at the beginning or at the end.
        end: ClipEnd,
    },
    /// The clip gives transitions, and no example, since it shows no steady gait.
    OnlyTransitionsUsed {
        /// Why no example is made.
        reason: Unfit,
    },
    /// In parts of the clip the body stands in a bind pose or with raised arms. They give no example and no idle.
    RestsLeftOut {
        /// First and last second of the longest part.
        longest_s: [f32; 2],
        /// Reason why the longest is left out.
        reason: Unfit,
        /// Number of further such parts.
        more: u32,
    },
    /// Some steady windows of the clip give no example, since trunk, arms or legs are held otherwise than in another one of
    /// nearly the same velocity.
    CarriageLeftOut {
        /// Number of these windows.
        windows: u32,
        /// First and last second of the longest.
        longest_s: [f32; 2],
        /// First and last second of the window that gives the example.
        kept_s: [f32; 2],
    },
    /// The root does not travel, as on a treadmill: the speed is that of the feet over the ground.
    InPlace {
        /// That speed, m/s.
        speed_mps: f32,
    },
    /// Movements between rest and steps give no transition, since no clip of the style gives an idle.
    MovementsWithoutIdle {
        /// Number of these movements.
        movements: u32,
        /// First and last second of the first.
        first_s: [f32; 2],
    },
    /// No clip of the style stands for long: bodies stand as in a brief rest of this one.
    BriefRestUsed {
        /// First and last second of the rest.
        rest_s: [f32; 2],
    },
}

impl Note {
    /// Stable name of the note; see [`crate::diagnostic::Diagnostic::code`].
    pub fn code(&self) -> &'static str {
        match self {
            Self::FirstPoseCut => "first_pose_cut",
            Self::TPoseCut { .. } => "t_pose_cut",
            Self::TextAfterMotion { .. } => "text_after_motion",
            Self::LastRowIncomplete { .. } => "last_row_incomplete",
            Self::PointersNotRead => "pointers_not_read",
            Self::TurnRateSnapped { .. } => "turn_rate_snapped",
            Self::StrafeSnapped { .. } => "strafe_snapped",
            Self::WindowsLeftOut { .. } => "windows_left_out",
            Self::ExampleLeftOut { .. } => "example_left_out",
            Self::OnlyRestUsed { .. } => "only_rest_used",
            Self::SameTake { .. } => "same_take",
            Self::CoincidentExample { .. } => "coincident_example",
            Self::LowPartsLeftOut { .. } => "low_parts_left_out",
            Self::CoincidentManners { .. } => "coincident_manners",
            Self::IdleOfOtherStyle { .. } => "idle_of_other_style",
            Self::AddedToStyle { .. } => "added_to_style",
            Self::CornersUnused { .. } => "corners_unused",
            Self::JointsLeftOut { .. } => "joints_left_out",
            Self::HeldPoseCut { .. } => "held_pose_cut",
            Self::OnlyTransitionsUsed { .. } => "only_transitions_used",
            Self::CarriageLeftOut { .. } => "carriage_left_out",
            Self::InPlace { .. } => "in_place",
            Self::MovementsWithoutIdle { .. } => "movements_without_idle",
            Self::RestsLeftOut { .. } => "rests_left_out",
            Self::BriefRestUsed { .. } => "brief_rest_used",
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FirstPoseCut => out.write_str("the first frame is a separate pose and is not used"),
            Self::TPoseCut { frames, end: ClipEnd::First } => {
                write!(out, "the clip begins with {frames} frames of T-pose, which are not used")
            }
            Self::TPoseCut { frames, end: ClipEnd::Last } => {
                write!(out, "the clip ends with {frames} frames of T-pose, which are not used")
            }
            Self::HeldPoseCut { frames, end: ClipEnd::First } => {
                write!(out, "the clip begins with {frames} frames of a frozen pose, which are not used")
            }
            Self::HeldPoseCut { frames, end: ClipEnd::Last } => {
                write!(out, "the clip ends with {frames} frames of a frozen pose, which are not used")
            }
            Self::TextAfterMotion { line } => write!(out, "line {line}: the text after the motion is not used"),
            Self::LastRowIncomplete { line } => write!(out, "line {line}: the last row is cut short and is not used"),
            Self::PointersNotRead => {
                out.write_str("channels that animate something other than nodes (KHR_animation_pointer) are not used")
            }
            Self::TurnRateSnapped { turn_rate_rad_s, from_s } => {
                let turn_rate_deg_s = turn_rate_rad_s.to_degrees();
                write!(out, "the turn rate of {turn_rate_deg_s:.1} °/s{} is set to 0", of_example(*from_s))
            }
            Self::StrafeSnapped { strafe_mps, from_s } => {
                write!(out, "the side speed of {strafe_mps:.3} m/s{} is set to 0", of_example(*from_s))
            }
            Self::WindowsLeftOut { near_equal, doubtful } => windows_left_out(out, *near_equal, *doubtful),
            Self::ExampleLeftOut { example, max_examples } => {
                write!(out, "`{example}` is left out: max_examples = {max_examples}")
            }
            Self::OnlyRestUsed { reason } => {
                write!(out, "only the part that stands is used; of the part that steps: {reason}")
            }
            Self::OnlyTransitionsUsed { reason } => {
                write!(out, "the clip gives transitions, but no example of a gait: {reason}")
            }
            Self::RestsLeftOut { longest_s, reason, more } => rests_left_out(out, *longest_s, reason, *more),
            Self::CarriageLeftOut { windows, longest_s, kept_s } => carriage_left_out(out, *windows, *longest_s, *kept_s),
            Self::SameTake { other, mirrored, windows_left_out } => {
                write!(out, "the same take as {other}{}{}", and_mirrored(*mirrored), and_left_out(*windows_left_out))
            }
            Self::CoincidentExample { example, blended } => {
                write!(out, "`{example}` has the parameters of `{blended}`, which is blended in its place")
            }
            Self::CoincidentManners { example, blended, distance_cm } => write!(
                out,
                "`{example}` has the parameters of `{blended}`, which is blended in its place, but moves otherwise \
                 ({distance_cm:.0} cm a joint); to keep both, state a `style` in a manifest.toml"
            ),
            Self::IdleOfOtherStyle { style, lender } => {
                let lender = if lender.is_empty() { "a clip without style".to_owned() } else { format!("`{lender}`") };
                write!(out, "style `{style}` has no idle and stands as {lender} does; add a clip of it that stands")
            }
            Self::AddedToStyle { style } => {
                write!(out, "no clip without a style steps, so this one is used for style `{style}`")
            }
            Self::CornersUnused { window_s, turn_rad, more } => corners_unused(out, *window_s, *turn_rad, *more),
            Self::JointsLeftOut { moving: 1, .. } => out.write_str(
                "1 moving joint of hands, feet and limbs is not used: it is no finger, toe or twist bone by its name, or \
                 does not fit",
            ),
            Self::JointsLeftOut { moving, kept } => write!(
                out,
                "{moving} moving joints of hands, feet and limbs are not used: they are no fingers, toes or twist bones \
                 by their names, or more than fit; {kept} are kept"
            ),
            Self::InPlace { speed_mps } => write!(
                out,
                "the root does not travel, as on a treadmill; the speed, {speed_mps:.2} m/s, is estimated from the feet, and \
                 less accurate than that of a root that travels"
            ),
            Self::MovementsWithoutIdle { movements, first_s } => movements_without_idle(out, *movements, *first_s),
            Self::BriefRestUsed { rest_s: [first_s, last_s] } => write!(
                out,
                "bodies stand as from {first_s:.2} to {last_s:.2} s, since no clip stands for long; add an idle of some seconds"
            ),
            Self::LowPartsLeftOut { posture, longest_s, total_s, more } => {
                low_parts_left_out(out, *posture, *longest_s, *total_s, *more)
            }
        }
    }
}

fn windows_left_out(out: &mut fmt::Formatter<'_>, near_equal: u32, doubtful: u32) -> fmt::Result {
    let windows = steady_windows(near_equal + doubtful);
    match (near_equal, doubtful) {
        (_, 0) => write!(out, "left out: {windows}, near-equal to examples"),
        (0, _) => write!(out, "left out: {windows}, whose feet slide or are hardly planted"),
        _ => write!(
            out,
            "left out: {windows}, {near_equal} near-equal to examples and {doubtful} whose feet slide or are hardly planted"
        ),
    }
}

fn rests_left_out(out: &mut fmt::Formatter<'_>, [first_s, last_s]: [f32; 2], reason: &Unfit, more: u32) -> fmt::Result {
    let more = match more {
        0 => String::new(),
        1 => " (1 further part is left out, too)".to_owned(),
        _ => format!(" ({more} further parts are left out, too)"),
    };
    write!(out, "no idle is made from {first_s:.1} s to {last_s:.1} s{more}: {reason}")
}

fn corners_unused(out: &mut fmt::Formatter<'_>, [first_s, last_s]: [f32; 2], turn_rad: f32, more: u32) -> fmt::Result {
    let (turn_deg, side) = (turn_rad.abs().to_degrees(), if turn_rad > 0.0 { "left" } else { "right" });
    let rate_deg_s = turn_deg / (last_s - first_s).max(f32::EPSILON);
    write!(
        out,
        "from {first_s:.1} s to {last_s:.1} s the body walks and turns by {turn_deg:.0}° to the {side} \
         ({rate_deg_s:.0} °/s); no example and no transition shows this"
    )?;
    match more {
        0 => Ok(()),
        1 => out.write_str(", nor 1 further turn"),
        _ => write!(out, ", nor {more} further turns"),
    }
}

fn movements_without_idle(out: &mut fmt::Formatter<'_>, movements: u32, [first_s, last_s]: [f32; 2]) -> fmt::Result {
    match movements {
        1 => write!(out, "a start, stop, turn or step from {first_s:.1} s to {last_s:.1} s gives")?,
        _ => write!(
            out,
            "{movements} starts, stops, turns or steps, the first from {first_s:.1} s to {last_s:.1} s, give"
        )?,
    }
    out.write_str(" no transition, since no clip of this style gives an idle: a body that stands for 2 s")
}

fn low_parts_left_out(
    out: &mut fmt::Formatter<'_>,
    posture: Posture,
    [first_s, last_s]: [f32; 2],
    total_s: f32,
    more: u32,
) -> fmt::Result {
    write!(out, "from {first_s:.1} s to {last_s:.1} s the body {posture}")?;
    if more > 0 {
        write!(out, ", and in {more} more parts it is not upright ({total_s:.1} s in all)")?;
    }
    out.write_str("; this gives no example (state `posture = \"any\"` in a manifest.toml to use it)")
}

fn carriage_left_out(
    out: &mut fmt::Formatter<'_>,
    windows: u32,
    [first_s, last_s]: [f32; 2],
    [kept_first_s, kept_last_s]: [f32; 2],
) -> fmt::Result {
    write!(
        out,
        "left out: {}, the longest from {first_s:.1} s to {last_s:.1} s: trunk, arms or legs are held otherwise than from \
         {kept_first_s:.1} s to {kept_last_s:.1} s, which gives the example of nearly the same velocity. To use both, cut \
         them out by `frames` in a manifest.toml and give them a `style` each",
        steady_windows(windows)
    )
}
