//! The range of every number in a scenario: all that reading, simulating, measuring and drawing one rely on.

use std::fmt::Display;
use std::ops::RangeInclusive;

use glam::Vec2;

use crate::params::Params;
use crate::scenario::check::{Fault, Place};
use crate::scenario::{AgentSpec, Scenario, View};

/// Of a name in bytes: with a frame number and an ending it still names a file.
const NAME_MAX_BYTES: usize = 200;
/// A day; longer runs are a slip of the unit.
const DURATION_S: RangeInclusive<f32> = 1e-3..=86_400.0;
/// In coarser steps walkers meet before they have reacted and planted feet slide: ten on a circle by 0.1 cm/s at 0.2 s,
/// by 23 at 0.5 s.
const STEP_S: RangeInclusive<f32> = 1e-3..=0.25;
/// Beyond, f32 positions resolve no millimetre.
pub(crate) const COORDINATE_MAX_M: f32 = 10_000.0;
/// From a child to a person with luggage.
const RADIUS_M: RangeInclusive<f32> = 0.1..=1.0;
/// From the slowest shuffle to a sprint.
const SPEED_MPS: RangeInclusive<f32> = 0.1..=10.0;
/// Ten turns either way.
const FACING_DEG: RangeInclusive<f32> = -3_600.0..=3_600.0;
/// Ten times the largest crowd that other simulators show.
pub(crate) const AGENTS_MAX: usize = 1_000_000;
const GOALS_MAX: usize = 10_000;
const OBSTACLES_MAX: usize = 10_000;
/// No tunable of a human body comes near, in any unit.
const TUNABLE_MAX: f64 = 1e6;
/// The shortest step; nothing is timed finer.
const TIME_MIN_S: f64 = 1e-3;
/// Of social forces: from the step itself to hundredths of the shortest one.
const SUBSTEPS: RangeInclusive<u32> = 1..=1_000;
/// Past 8K; each thread holds a picture or two.
const PICTURE_PIXELS: RangeInclusive<u32> = 16..=8_192;
const PICTURE_WIDTH_M: RangeInclusive<f32> = 0.01..=2.0 * COORDINATE_MAX_M;
const FRAME_RATE_HZ: RangeInclusive<f32> = 0.1..=1_000.0;
/// What to do about a key that may be left out.
const DEFAULT: &str = "leave it out for its default";

/// That no number is out of range.
///
/// # Errors
/// The first number that is.
pub(crate) fn check_ranges(scenario: &Scenario) -> Result<(), Fault> {
    check_name(&scenario.name)?;
    within(&Place::Duration, "duration_s", scenario.duration_s, &DURATION_S, "give the simulated time in seconds")?;
    within(&Place::Step, "dt_s", scenario.dt_s, &STEP_S, "leave it out for 1/30 s")?;
    if scenario.dt_s > scenario.duration_s {
        return Place::Duration.fault("duration_s is shorter than one step".into(), "give at least dt_s");
    }
    check_view(&scenario.view)?;
    check_params(&scenario.params)?;
    let (agents, obstacles_m) = (&scenario.agents, &scenario.obstacles_m);
    within(
        &Place::Agents,
        "the number of agents",
        agents.len(),
        &(1..=AGENTS_MAX),
        "give at least one, at most a million",
    )?;
    within(&Place::Obstacle(0), "the number of obstacles", obstacles_m.len(), &(0..=OBSTACLES_MAX), "give fewer")?;
    for (index, agent) in agents.iter().enumerate() {
        check_agent(index, agent)?;
    }
    obstacles_m.iter().enumerate().try_for_each(|(index, polygon_m)| check_points(&Place::Obstacle(index), polygon_m))
}

/// NaN lies within nothing.
fn within<T: PartialOrd + Display>(
    place: &Place,
    name: &str,
    value: T,
    range: &RangeInclusive<T>,
    help: &'static str,
) -> Result<(), Fault> {
    if range.contains(&value) {
        return Ok(());
    }
    place.fault(format!("{name} is {value}, not between {} and {}", range.start(), range.end()), help)
}

/// Files are named after the scenario, and must stay where their folder is.
fn check_name(name: &str) -> Result<(), Fault> {
    let is_plain = |letter: char| !letter.is_control() && !['/', '\\'].contains(&letter);
    if (1..=NAME_MAX_BYTES).contains(&name.len()) && !name.starts_with('.') && name.chars().all(is_plain) {
        return Ok(());
    }
    let shown: String = name.chars().take(NAME_MAX_BYTES).collect();
    let help = "set `name` to letters and digits, at most 200 bytes of them, without `/`, `\\` or a dot in front";
    Place::Name.fault(format!("{shown:?} cannot name a file"), help)
}

/// That a view can be drawn.
///
/// # Errors
/// The first number that is out of range.
pub fn check_view(view: &View) -> Result<(), Fault> {
    within(&Place::View, "width", view.width, &PICTURE_PIXELS, DEFAULT)?;
    within(&Place::View, "height", view.height, &PICTURE_PIXELS, DEFAULT)?;
    within(&Place::View, "frame_rate_hz", view.frame_rate_hz, &FRAME_RATE_HZ, DEFAULT)?;
    within(&Place::View, "trail_s", view.trail_s, &(0.0..=*DURATION_S.end()), "0 draws no trails")?;
    if let Some(width_m) = view.width_m {
        within(&Place::View, "width_m", width_m, &PICTURE_WIDTH_M, "leave it out for automatic framing")?;
    }
    check_points(&Place::View, view.centre_m.as_slice())
}

/// Names carry their units, so one rule serves all tunables: finite, times at least a millisecond (they divide), only
/// angles negative.
fn check_params(params: &Params) -> Result<(), Fault> {
    let Ok(sections) = toml::Table::try_from(params) else { return Ok(()) };
    for (section, table) in &sections {
        for (key, value) in table.as_table().into_iter().flatten() {
            let Some(number) = value.as_float() else { continue };
            let least = if key.ends_with("_s") {
                TIME_MIN_S
            } else if key.ends_with("_rad") {
                -TUNABLE_MAX
            } else {
                0.0
            };
            within(&Place::Parameter(section.clone(), key.clone()), key, number, &(least..=TUNABLE_MAX), DEFAULT)?;
        }
    }
    let substeps = Place::Parameter("social_force".into(), "substeps".into());
    within(&substeps, "substeps", params.social_force.substeps, &SUBSTEPS, DEFAULT)
}

fn check_agent(index: usize, agent: &AgentSpec) -> Result<(), Fault> {
    let (journey, place) = (&Place::Journey(index), &Place::Agent(index));
    check_points(journey, &[agent.position_m])?;
    check_points(journey, &agent.goals_m)?;
    within(
        journey,
        "the number of goals",
        agent.goals_m.len(),
        &(1..=GOALS_MAX),
        "name the goal, and some waypoints before it",
    )?;
    // As it was written: radians are rounded.
    let facing_deg = (10.0 * agent.facing_rad.to_degrees()).round() / 10.0;
    within(place, "facing_deg", facing_deg, &FACING_DEG, "leave it out to face the first goal")?;
    within(place, "radius_m", agent.radius_m, &RADIUS_M, "give the radius of a body's disc in metres")?;
    within(
        place,
        "preferred_speed_mps",
        agent.preferred_speed_mps,
        &SPEED_MPS,
        "people walk at about 1.3 m/s; who stands has its start for a goal",
    )
}

fn check_points(place: &Place, points_m: &[Vec2]) -> Result<(), Fault> {
    match points_m.iter().find(|point_m| !is_on_the_map(**point_m)) {
        None => Ok(()),
        Some(point_m) => place.fault(
            format!("[{}, {}] is no place within 10 km of the origin", point_m.x, point_m.y),
            "give finite coordinates in metres, near the origin",
        ),
    }
}

fn is_on_the_map(point_m: Vec2) -> bool {
    // Written so that NaN fails.
    point_m.abs().max_element() <= COORDINATE_MAX_M && point_m.is_finite()
}
