//! Colours and names of velocities and half-planes, in panels and in the scene.

use fbcrowd_sim::planning::orca::HalfPlaneSource;

use crate::raster::palette::{HOLDING_SET, INK, OBSTACLE_RIM, Rgb, SHARP_TURN_EDGES, TURNING_SET, line_colour};

/// Colour of v_pref: a grey.
pub(crate) const PREFERRED: Rgb = Rgb::new(0.50, 0.50, 0.53);
/// Colour of v_op: a teal.
pub(crate) const ADAPTED: Rgb = Rgb::new(0.00, 0.52, 0.58);
/// Colour of the planned velocity.
pub(crate) const PLANNED: Rgb = INK;
/// Colour of the actual velocities before and after the step: a green.
pub(crate) const ACTUAL: Rgb = Rgb::new(0.22, 0.64, 0.26);
/// Colour of the stance foot: a magenta.
pub(crate) const STANCE: Rgb = Rgb::new(0.76, 0.08, 0.56);

/// Colour of a half-plane or force, by its source.
pub(crate) fn source_colour(source: HalfPlaneSource) -> Rgb {
    match source {
        HalfPlaneSource::Obstacle(_) | HalfPlaneSource::OneWay(_) | HalfPlaneSource::Queue => OBSTACLE_RIM,
        HalfPlaneSource::Stance => STANCE,
        HalfPlaneSource::SharpTurn => SHARP_TURN_EDGES,
        HalfPlaneSource::TurningHull => TURNING_SET,
        HalfPlaneSource::HoldingHull => HOLDING_SET,
        HalfPlaneSource::Agent(agent) => line_colour(agent as usize),
    }
}

/// Name of a half-plane or force, by its source; an agent's is its id.
pub(crate) fn source_name(source: HalfPlaneSource) -> String {
    match source {
        HalfPlaneSource::Obstacle(_) => "wall".to_owned(),
        HalfPlaneSource::OneWay(_) => "one-way zone".to_owned(),
        HalfPlaneSource::Stance => "stance foot".to_owned(),
        HalfPlaneSource::SharpTurn => "sharp turn".to_owned(),
        HalfPlaneSource::TurningHull => "turning set".to_owned(),
        HalfPlaneSource::HoldingHull => "holding set".to_owned(),
        HalfPlaneSource::Queue => "queue".to_owned(),
        HalfPlaneSource::Agent(agent) => agent.to_string(),
    }
}
