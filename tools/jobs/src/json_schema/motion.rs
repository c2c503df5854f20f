//! Mirrors of the motion database's types.

#![allow(dead_code, reason = "mirrors are never made")]

use schemars::JsonSchema;

/// Mirror of [`motiondb::quality::example_quality::ExampleQuality`].
#[derive(JsonSchema)]
#[schemars(rename = "ExampleQuality", description = "Quality of an example's motion.")]
pub struct ExampleQualityMirror {
    /// Name of the example.
    example: String,
    /// Mean speed of planted feet, cm/s.
    planted_slide_cm_s: f32,
    /// Share of the cycle in which a foot is planted, mean of both feet, 0 to 1.
    planted_share: f32,
    /// Root mean square turn of the joints over the cycle's seam, divided by the median of all rows.
    seam_angle_ratio: f32,
    /// Root mean square change of the joints' angular velocity at the cycle's seam, divided by the median of all rows.
    seam_velocity_ratio: f32,
    /// Greatest depth of a sole under the ground, mm.
    penetration_mm: f32,
    /// Least flexion of a knee, degrees; negative where it is hyperextended.
    knee_flexion_min_deg: f32,
    /// Greatest distance from hip to ankle, divided by the length of thigh plus shank.
    leg_extension_max: f32,
    /// Greatest excess of a joint over the published human range, degrees; 0 within it.
    range_excess_deg: f32,
    /// Name of the joint with that excess.
    range_excess_joint: String,
}

/// Mirror of [`motiondb::quality::finding::Finding`].
#[derive(JsonSchema)]
#[schemars(rename = "Finding", description = "A quality measure beyond its threshold.")]
pub struct FindingMirror {
    /// Name of the example, or of the action.
    example: String,
    /// Name of the measure: a key of `quality[]`, of which actions have some.
    measure: String,
    /// The value, in `unit`.
    value: f32,
    /// The threshold of the measure, in `unit`.
    threshold: f32,
    /// Unit of measure and threshold; empty for ratios and shares.
    unit: String,
    /// The finding as a sentence.
    sentence: String,
}

/// Mirror of [`motiondb::motion::ActionKind`].
#[derive(JsonSchema)]
#[schemars(rename = "ActionKind", rename_all = "snake_case", description = "What a body does in an action.")]
pub enum ActionKindMirror {
    /// It stands; the last frame is the first one again.
    Idle,
    /// It stands, then walks or runs.
    Start,
    /// It walks or runs, then stands.
    Stop,
    /// It turns on the spot, and stands before and after.
    Turn,
    /// It makes one or two steps forward, backward or aside, and stands before and after.
    Step,
    /// It walks or runs, turns sharply within a few steps, and walks or runs on.
    Pivot,
}

/// Mirror of [`motiondb::quality::coverage::CoverageGap`].
#[derive(JsonSchema)]
#[schemars(rename = "CoverageGap", description = "A region of gaits that a set of examples covers thinly.")]
pub struct CoverageGapMirror {
    /// What the set lacks.
    lack: GapKindMirror,
    /// The gap as a sentence, with numbers and consequence.
    sentence: String,
}

/// Mirror of [`motiondb::quality::coverage::GapKind`].
#[derive(JsonSchema)]
#[schemars(rename = "GapKind", rename_all = "snake_case", description = "What a set of examples lacks.")]
enum GapKindMirror {
    /// No example stands.
    Standing,
    /// No straight example walks.
    Walking,
    /// No example runs.
    Running,
    /// No example goes backward.
    Backward,
    /// Turns while walking are wide, or there are none.
    WalkingTurns,
    /// No example turns in place, to one side or both.
    TurningInPlace,
    /// No example side-steps, to one side or both.
    SideSteps,
    /// Neighbouring speeds straight ahead are far apart.
    SpeedGap,
    /// Neighbouring turn rates are far apart.
    TurnGap,
    /// Neighbouring side speeds are far apart.
    SideGap,
}

/// Mirror of [`motiondb::diagnostic::Severity`].
#[derive(JsonSchema)]
#[schemars(rename = "Severity", rename_all = "snake_case", description = "Weight of a diagnostic.")]
pub enum SeverityMirror {
    /// Information that requires no action.
    Note,
    /// A defect of a clip that is used.
    Warning,
    /// Why a clip gives no example.
    NoExample,
}

/// Mirror of [`motiondb::velocity_sets::velocity_hull::VelocityHull`].
#[derive(JsonSchema)]
#[schemars(rename = "VelocitySets", description = "Velocities that the examples allow, in the agent's frame.")]
pub struct VelocityHullMirror {
    /// How the sets are built.
    construction: ConstructionMirror,
    /// Corners of the turning set, clockwise: x forward and y left, m/s.
    turning_mps: Vec<[f32; 2]>,
    /// Corners of the holding set, clockwise: x forward and y left, m/s.
    holding_mps: Vec<[f32; 2]>,
    /// Edges of the wrapping polygon for sharp turns, from one corner to the next, m/s.
    sharp_turn_edges_mps: Vec<[[f32; 2]; 2]>,
}

/// Mirror of [`motiondb::velocity_sets::velocity_hull::Construction`].
#[derive(JsonSchema)]
#[schemars(rename = "Construction", rename_all = "snake_case", description = "How velocity sets are built.")]
enum ConstructionMirror {
    /// One set for bodies that turn, and one for bodies that hold their facing.
    TurningAndHolding,
    /// The paper's construction alone.
    Paper,
}
