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
    /// Number of agents that came within 0.5 m of their last goal after their waypoints; those that begin in a state:
    /// that entered a final state, or were removed.
    arrived: usize,
    /// Number of agents that wanted to walk and stayed under 0.1 m/s for 5 s before arrival.
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
    /// Share of agents and steps in which the body reaches more than 1 cm into a wall, 0 to 1.
    wall_body_deep_share: f64,
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
    /// The scenario's states, in their order.
    states: Vec<StateMeasuresMirror>,
    /// The scenario's `[[measure]]` tables, in their order.
    places: Vec<PlaceMeasuresMirror>,
    /// Names of the joints beside the 22 roles that the recording holds, such as `left_index_1`; left out where it holds
    /// none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    extra_joints: Vec<String>,
}

/// Mirror of [`fbcrowd_sim::measures::StateMeasures`].
#[derive(JsonSchema)]
#[schemars(rename = "StateMeasures", description = "Visits of one state.")]
pub struct StateMeasuresMirror {
    /// Name of the state.
    state: String,
    /// Number of agents that were in the state in any frame.
    visited: usize,
    /// Number of agents that are in the state in the last frame.
    at_end: usize,
    /// Mean time that an agent which was in the state spent there in all, s; null where no agent was.
    mean_time_s: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::PlaceMeasures`].
#[derive(JsonSchema)]
#[schemars(rename = "PlaceMeasures", description = "One `[[measure]]` table: a line, an area or the egress.")]
pub struct PlaceMeasuresMirror {
    /// Name of the table.
    name: String,
    /// Passages over a line.
    line: Option<LineMeasuresMirror>,
    /// Density and speed in an area.
    area: Option<AreaMeasuresMirror>,
    /// Times of removal.
    egress: Option<EgressMeasuresMirror>,
}

/// Mirror of [`fbcrowd_sim::measures::LineMeasures`].
#[derive(JsonSchema)]
#[schemars(rename = "LineMeasures", description = "Passages over a line, seen from its first end to its second.")]
pub struct LineMeasuresMirror {
    /// Length of the line, m.
    width_m: f64,
    /// Passages from the right of the line to its left.
    forward: PassagesMirror,
    /// Passages from the left of the line to its right.
    backward: PassagesMirror,
}

/// Mirror of [`fbcrowd_sim::measures::Passages`].
#[derive(JsonSchema)]
#[schemars(rename = "Passages", description = "Passages over a line in one direction.")]
pub struct PassagesMirror {
    /// Number of passages.
    count: usize,
    /// Passages per second between the first and the last; null of fewer than two.
    flow_per_s: Option<f64>,
    /// Flow over the length of the line, 1/(m s); null of fewer than two passages.
    specific_flow_per_m_s: Option<f64>,
    /// Times of all passages, ascending, s.
    times_s: Vec<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::AreaMeasures`].
#[derive(JsonSchema)]
#[schemars(rename = "AreaMeasures", description = "Density, speed and level of service in an area.")]
pub struct AreaMeasuresMirror {
    /// Size, m².
    size_m2: f64,
    /// Mean number of agents inside.
    mean_number: f64,
    /// Mean number of agents inside over the size, 1/m².
    mean_density_per_m2: f64,
    /// Greatest number of agents inside over the size, 1/m².
    greatest_density_per_m2: f64,
    /// Mean Voronoi density, 1/m².
    mean_voronoi_density_per_m2: f64,
    /// Greatest Voronoi density, 1/m².
    greatest_voronoi_density_per_m2: f64,
    /// Mean speed of the agents inside, over agents and moments, m/s; null where no agent was inside.
    mean_speed_mps: Option<f64>,
    /// Share of the moments at each of Fruin's levels of service for walkways, A to F, 0 to 1.
    level_of_service_shares: [f64; 6],
    /// The moments, half a second apart.
    moments: Vec<AreaMomentMirror>,
}

/// Mirror of [`fbcrowd_sim::measures::AreaMoment`].
#[derive(JsonSchema)]
#[schemars(rename = "AreaMoment", description = "An area at one moment.")]
pub struct AreaMomentMirror {
    /// Time, s.
    time_s: f64,
    /// Number of agents inside.
    number: usize,
    /// Number of agents inside over the size, 1/m².
    density_per_m2: f64,
    /// Voronoi density, 1/m².
    voronoi_density_per_m2: f64,
    /// Mean speed of the agents inside in the step before, m/s; null where no agent is inside.
    mean_speed_mps: Option<f64>,
}

/// Mirror of [`fbcrowd_sim::measures::EgressMeasures`].
#[derive(JsonSchema)]
#[schemars(rename = "EgressMeasures", description = "Times at which agents were removed, nearest rank.")]
pub struct EgressMeasuresMirror {
    /// Number of agents that left.
    left: usize,
    /// Number of agents that are still there at the end.
    remaining: usize,
    /// Time by which 10 % of those that left have left, s; null where none left.
    percentile_10_s: Option<f64>,
    /// Time by which half of them have left, s; null where none left.
    percentile_50_s: Option<f64>,
    /// Time by which 90 % of them have left, s; null where none left.
    percentile_90_s: Option<f64>,
    /// Time by which 95 % of them have left, s; null where none left.
    percentile_95_s: Option<f64>,
    /// Time at which the last of them left, s; null where none left.
    last_s: Option<f64>,
    /// Times of all removals, ascending, s.
    times_s: Vec<f64>,
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
