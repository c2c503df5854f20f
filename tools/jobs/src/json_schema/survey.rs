//! Mirrors of the compiler's types.

#![allow(dead_code, reason = "mirrors are never made")]

use schemars::JsonSchema;

/// Mirror of [`motiondb_compiler::survey::SourceGait`].
#[derive(JsonSchema)]
#[schemars(rename = "Gait", description = "The gait of a whole clip.")]
pub struct SourceGaitMirror {
    /// What the clip shows.
    kind: GaitKindMirror,
    /// Why no example can be made of the clip; only where it is unsteady.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    /// Share of the clip in which a foot is planted, mean of both feet, 0 to 1.
    planted_share: f32,
    /// Contacts of the right foot, in order of time.
    right: Vec<ContactTimesMirror>,
    /// Contacts of the left foot, in order of time.
    left: Vec<ContactTimesMirror>,
}

/// Mirror of [`motiondb_compiler::survey::GaitKind`].
#[derive(JsonSchema)]
#[schemars(rename = "GaitKind", rename_all = "lowercase", description = "What a clip shows.")]
enum GaitKindMirror {
    /// Steady strides.
    Steps,
    /// A standing body.
    Stands,
    /// Neither: no example can be made of it.
    Unsteady,
}

/// Mirror of [`motiondb_compiler::survey::ContactTimes`].
#[derive(JsonSchema)]
#[schemars(rename = "Contact", description = "One contact of a foot with the ground.")]
struct ContactTimesMirror {
    /// Time of the heel strike from the file's first frame, s; null where the clip begins within the contact.
    strike_s: Option<f32>,
    /// Time of the toe-off from the file's first frame, s; null where the clip ends within the contact.
    toe_off_s: Option<f32>,
}
