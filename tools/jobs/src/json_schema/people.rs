//! Mirrors of the measures of people.

#![allow(dead_code, reason = "mirrors are never made")]

use schemars::JsonSchema;

/// Mirror of [`fbcrowd_sim::measures::people::PeopleMeasures`].
#[derive(JsonSchema)]
#[schemars(
    rename = "PeopleMeasures",
    description = "The measures of people of one recording, under the keys of `fbcrowd measure --people --json`."
)]
pub struct PeopleMeasuresMirror {
    /// Time before arrival, agent-minutes.
    agent_minutes: f64,
    /// Phase order at 1, 3 and 8 s.
    phase_order: Vec<PhaseOrderMirror>,
    /// First steps after the start.
    first_steps: FirstStepsMirror,
    /// Cadence at equal speed.
    cadence: CadenceSpreadMirror,
    /// Swings of steps of 15–30 cm and of 30–60 cm.
    swings: Vec<SwingClassMirror>,
    /// Starts from rest.
    starts: StartsMirror,
    /// Stops.
    stops: StopsMirror,
    /// Standing bodies.
    standing: StandingBodiesMirror,
    /// Lurches of the pelvis.
    pelvis_lurches: PelvisLurchesMirror,
    /// Shanks that come too near.
    shank_gaps: ShankGapsMirror,
    /// Turns as no person makes them.
    turning: TurningMirror,
    /// Time in queues.
    queues: QueuesMirror,
    /// Head and wrists in walks.
    upper_bodies: UpperBodiesMirror,
    /// Pivots of flat feet.
    foot_pivots: FootPivotsMirror,
    /// Slide of planted feet before arrival.
    slide: SoleSlideMirror,
}

/// Mirror of [`fbcrowd_sim::measures::people::PhaseOrder`].
#[derive(JsonSchema)]
#[schemars(rename = "PhaseOrder", description = "Phase order at one time.")]
pub struct PhaseOrderMirror {
    /// Time after the start, s.
    time_s: f64,
    /// Number of agents that are faster than 0.5 m/s.
    agents: usize,
    /// R; null where fewer than two agents count.
    order: Option<f64>,
    /// R of as many phases at random, √(π/4N).
    random: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::FirstSteps`].
#[derive(JsonSchema)]
#[schemars(rename = "FirstSteps", description = "The first steps of a crowd.")]
pub struct FirstStepsMirror {
    /// Number of agents that begin with the left foot.
    left: usize,
    /// Number of agents that begin with the right foot.
    right: usize,
    /// Greatest number of agents that lift the same foot within 10 ms.
    together: usize,
    /// Time between the tenth and the ninetieth percentile of the first steps, s; null without steps.
    spread_s: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::CadenceSpread`].
#[derive(JsonSchema)]
#[schemars(rename = "CadenceSpread", description = "Cadence of a crowd at equal speed.")]
pub struct CadenceSpreadMirror {
    /// Number of agents with at least two straight strides.
    agents: usize,
    /// Mean cadence, steps per minute; null without strides.
    mean_steps_per_min: Option<f64>,
    /// Coefficient of variation over agents at equal speed; null of fewer than three agents.
    variation: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::SwingClass`].
#[derive(JsonSchema)]
#[schemars(rename = "SwingClass", description = "The swings of one class.")]
pub struct SwingClassMirror {
    /// Least and greatest length of the steps, m.
    lengths_m: [f32; 2],
    /// Number of swings.
    count: usize,
    /// Median clearance, cm; null without swings.
    clearance_cm: Option<f64>,
    /// Median duration, s; null without swings.
    duration_s: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::Starts`].
#[derive(JsonSchema)]
#[schemars(rename = "Starts", description = "The starts of a crowd.")]
pub struct StartsMirror {
    /// Number of starts.
    count: usize,
    /// Median duration up to 90 % of the walking speed, s; null without starts.
    duration_s: Option<f64>,
    /// Median of the mean acceleration, m/s²; null without starts.
    acceleration_mps2: Option<f64>,
    /// Median of the peak acceleration, m/s²; null without starts.
    peak_mps2: Option<f64>,
    /// Median lean, degrees per m/s²; null without starts.
    lean_deg_per_mps2: Option<f64>,
    /// Share of the starts that play a recorded transition for more than half of their duration; null without starts.
    recorded_share: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::Stops`].
#[derive(JsonSchema)]
#[schemars(rename = "Stops", description = "The stops of a crowd.")]
pub struct StopsMirror {
    /// Number of stops.
    count: usize,
    /// Median duration from 90 % of the walking speed to rest, s; null without stops.
    duration_s: Option<f64>,
    /// Median of the peak deceleration, m/s²; null without stops.
    peak_mps2: Option<f64>,
    /// Median time of creeping, s; null without stops.
    creep_s: Option<f64>,
    /// Mean speed of creeping, m/s; null where no body creeps.
    creep_mps: Option<f64>,
    /// Median duration of the closing step, s; null where no foot swings.
    closing_step_s: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::StandingBodies`].
#[derive(JsonSchema)]
#[schemars(rename = "StandingBodies", description = "Standing bodies of a crowd.")]
pub struct StandingBodiesMirror {
    /// Time for which bodies stand, for 2 s and more, minutes.
    minutes: f64,
    /// Median angle between the upper bodies of two bodies that stand, degrees; null where no two stand at once.
    likeness_deg: Option<f64>,
    /// Median sway of the pelvis in 6 s, mm; null where no body stands as long.
    sway_mm: Option<f64>,
    /// Median duration after which a standing body repeats its motion, s; null where none repeats it.
    repeat_s: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::PelvisLurches`].
#[derive(JsonSchema)]
#[schemars(rename = "PelvisLurches", description = "Lurches of a crowd.")]
pub struct PelvisLurchesMirror {
    /// Number of lurches.
    count: usize,
    /// Lurches per minute in which an agent walks; null where none walks.
    per_minute: Option<f64>,
    /// Greatest vertical acceleration, m/s².
    greatest_mps2: f64,
}

/// Mirror of [`fbcrowd_sim::measures::people::ShankGaps`].
#[derive(JsonSchema)]
#[schemars(rename = "ShankGaps", description = "Shanks of a crowd that come too near.")]
pub struct ShankGapsMirror {
    /// Number of events.
    count: usize,
    /// Events per agent-minute before arrival; null of a crowd that has arrived.
    per_minute: Option<f64>,
    /// Least distance of the axes, divided by the sum of the radii of the shanks; null without frames.
    least_over_radii: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::Turning`].
#[derive(JsonSchema)]
#[schemars(
    rename = "Turning",
    description = "Turns of a crowd, per agent-minute before arrival; none of a crowd that has arrived."
)]
pub struct TurningMirror {
    /// Sudden turns per agent-minute.
    sudden_per_minute: Option<f64>,
    /// Turns to and fro per agent-minute.
    to_and_fro_per_minute: Option<f64>,
    /// Fast turns of the head per agent-minute.
    fast_head_per_minute: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::Queues`].
#[derive(JsonSchema)]
#[schemars(rename = "Queues", description = "Agents in queues.")]
pub struct QueuesMirror {
    /// Time in queues, agent-minutes.
    minutes: f64,
    /// Share of that time in which an agent goes backward; null where no agent queues.
    backward_share: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::UpperBodies`].
#[derive(JsonSchema)]
#[schemars(rename = "UpperBodies", description = "Head and wrists of a crowd that walks.")]
pub struct UpperBodiesMirror {
    /// Number of intervals of 2 s.
    intervals: usize,
    /// Standard deviation of the head's roll, degrees; null without intervals.
    head_roll_deg: Option<f64>,
    /// Standard deviation of the head's pitch, degrees; null without intervals.
    head_pitch_deg: Option<f64>,
    /// Root mean square of the wrists' angular acceleration, rad/s²; null without intervals.
    wrist_acceleration_rad_s2: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::FootPivots`].
#[derive(JsonSchema)]
#[schemars(rename = "FootPivots", description = "Pivots of the flat feet of bodies that turn.")]
pub struct FootPivotsMirror {
    /// Number of contacts.
    contacts: usize,
    /// Mean turn rate of the bodies, degrees/s; null without contacts.
    turn_rate_deg_s: Option<f64>,
    /// Median size of the pivot, degrees; null without contacts.
    pivot_deg: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::people::SoleSlide`].
#[derive(JsonSchema)]
#[schemars(rename = "SoleSlide", description = "Slide of planted feet, cm/s; none where no foot is planted.")]
pub struct SoleSlideMirror {
    /// Slide of the lowest of heel, ball and toe tip on the sole, cm/s.
    at_soles_cm_s: Option<f64>,
    /// Slide of the lowest of ankle, ball and toe tip at the joints, each over its height when planted, cm/s.
    at_joints_cm_s: Option<f64>,
    /// Share of feet and frames that are planted.
    planted_share: f64,
}
