//! Mirrors of the simulation's types.

#![allow(dead_code, reason = "mirrors are never made")]

use schemars::JsonSchema;

/// The measures of one recording. Times and accelerations are those of the synthesised root, without the gait's sway.
/// Mirror of [`fbcrowd_sim::measures::Measures`].
#[derive(JsonSchema)]
#[schemars(rename = "Measures", description = "The measures of one recording.")]
pub struct MeasuresMirror {
    /// Number of agents that were present at any time, N.
    agents: usize,
    /// Number of agents that were born after the start or came from a source.
    born: usize,
    /// Number of agents that were removed; they do not count from then on.
    removed: usize,
    /// Number of agents that were due at sources at the end and had had no room.
    waiting: usize,
    /// Time during which a source had no room for an agent that was due, summed over sources, s.
    source_blocked_s: f64,
    /// Number of time steps, T.
    steps: usize,
    /// Time step, s.
    dt_s: f32,
    /// C (Eq. 17): overlap of discs as a share of both radii, summed over pairs, per step and present agent.
    collision_rate: f64,
    /// Least distance between the centres of two discs, between frames too (Eq. 16), m; null with a single agent.
    minimum_separation_m: Option<f64>,
    /// A (Eq. 18): mean acceleration of the roots over all steps and present agents, from rest at their starts, m/s².
    mean_acceleration_mps2: f64,
    /// Mean acceleration of the roots over the steps before each agent's arrival, m/s².
    mean_acceleration_before_arrival_mps2: f64,
    /// Number of agents that came within 0.5 m of their last goal after their waypoints.
    arrived: usize,
    /// Number of agents that stayed under 0.1 m/s for 5 s before arrival.
    stalled: usize,
    /// Mean time from birth until arrival, s; null where no agent arrived.
    mean_time_to_goal_s: Option<f64>,
    /// Length of the path until arrival, divided by that of the straight line along the waypoints; mean over the agents
    /// that arrived; null where no agent arrived.
    path_over_straight_line: Option<f64>,
    /// Share of the steps before arrival in which an agent walks sideways at held facing, 0 to 1.
    strafing_share: f64,
    /// Share of the steps before arrival in which an agent walks backward at held facing, 0 to 1.
    stepping_back_share: f64,
    /// Deepest overlap of two bodies' capsules (trunk, head, limbs), summed over pairs, per agent and step, mm.
    body_penetration_mm: f64,
    /// Mean depth over the pairs and steps in which bodies touch, mm; null where no bodies touch.
    body_penetration_touching_mm: Option<f64>,
    /// Greatest depth of two bodies in each other, mm.
    body_penetration_max_mm: f64,
    /// Share of agents and steps in which a body touches another, 0 to 1.
    body_touching_share: f64,
    /// Share of agents and steps in which a wall holds the disc, 0 to 1.
    wall_disc_share: f64,
    /// Share of agents and steps in which the body reaches into a wall, 0 to 1.
    wall_body_share: f64,
    /// Greatest depth of a body in a wall, mm.
    wall_body_max_mm: f64,
    /// Mean speed of planted feet before arrival, cm/s; null where no foot is planted.
    planted_slide_cm_s: Option<f64>,
    /// Mean speed of planted feet in the examples in use, over the same contacts, cm/s; null where no foot is planted.
    examples_slide_cm_s: Option<f64>,
    /// Share of feet and steps before arrival that are planted, 0 to 1.
    planted_share: f64,
    /// Mean distance between the position to which a step's planned velocity leads and the root, m.
    root_tracking_error_m: f64,
    /// Greatest distance between the position to which a step's planned velocity leads and the root, m.
    root_tracking_worst_m: f64,
    /// Mean angle between facing and travel before arrival, where an agent walks without side-stepping or stepping
    /// back, degrees.
    heading_error_deg: f64,
    /// Mean angle between facing and travel before arrival, wherever an agent walks, degrees.
    walking_heading_error_deg: f64,
}

/// Kinds of synthesis that a body may use. Mirror of [`fbcrowd_sim::synthesis::Modes`].
#[derive(JsonSchema)]
#[schemars(rename = "Synthesis", rename_all = "snake_case", description = "Kinds of synthesis that a body may use.")]
pub enum ModesMirror {
    /// Blending and semi-procedural locomotion.
    Hybrid,
    /// Blending alone.
    Blending,
    /// Semi-procedural locomotion alone; standing bodies are blended.
    SemiProcedural,
}
