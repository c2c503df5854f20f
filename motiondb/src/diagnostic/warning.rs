//! Warnings: doubtful facts about a clip that is used nevertheless.

use serde::{Deserialize, Serialize};

use crate::diagnostic::{ClipEnd, HeldPart};

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
