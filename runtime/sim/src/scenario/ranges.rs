//! The range of every number in a scenario, on which reading, simulating, measuring and drawing rely.

use std::fmt::Display;
use std::ops::RangeInclusive;

use glam::Vec2;

use crate::params::Params;
use crate::scenario::agent_spec::AgentSpec;
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::resolved::Scenario;
use crate::scenario::social_group::GroupSizes;
use crate::scenario::view::View;

/// Greatest length of a name, bytes: with a frame number and an ending it still names a file.
const NAME_MAX_BYTES: usize = 200;
/// Simulated time, s: up to a day; a longer one is a slip of the unit.
pub(crate) const DURATION_S: RangeInclusive<f32> = 1e-3..=86_400.0;
/// Time step, s. In coarser steps agents meet before they react and planted feet slide (ten agents on a circle: 0.1
/// cm/s at 0.2 s, 23 cm/s at 0.5 s).
pub const STEP_RANGE_S: RangeInclusive<f32> = 1e-3..=0.25;
/// Greatest coordinate, m: beyond it f32 positions resolve no millimetre.
pub(crate) const COORDINATE_MAX_M: f32 = 10_000.0;
/// Radius of a disc, m: from a child to a person with luggage.
pub(crate) const RADIUS_M: RangeInclusive<f32> = 0.1..=1.0;
/// Preferred speed, m/s: from the slowest shuffle to a sprint.
pub(crate) const SPEED_MPS: RangeInclusive<f32> = 0.1..=10.0;
/// Time for which an agent stands before it begins, s: up to a day.
pub(crate) const PRE_MOVEMENT_S: RangeInclusive<f32> = 0.0..=86_400.0;
/// Size of a body, relative to the database's skeleton: from a child of two years to a giant.
pub(crate) const STATURE: RangeInclusive<f32> = 0.4..=1.5;
/// Right of way; only differences count, up to 1.
pub(crate) const PRIORITY: RangeInclusive<f32> = -100.0..=100.0;
/// Distance between members of a group that walk abreast, m: from shoulder to shoulder to two arms apart.
const GROUP_SPACING_M: RangeInclusive<f32> = 0.4..=3.0;
/// Facing, degrees: up to ten turns either way.
const FACING_DEG: RangeInclusive<f32> = -3_600.0..=3_600.0;
/// Greatest number of agents: ten times the largest crowd that other simulators show.
pub(crate) const AGENTS_MAX: usize = 1_000_000;
/// Greatest number of goals of an agent.
pub(crate) const GOALS_MAX: usize = 10_000;
/// Greatest number of waypoints of all agents: ten for each of the largest crowd, 80 MB.
pub(crate) const WAYPOINTS_MAX: usize = 10 * AGENTS_MAX;
/// Greatest value of a tunable, in any unit; none of a human body comes near.
const TUNABLE_MAX: f64 = 1e6;
/// Least time among the tunables, s: the shortest step.
const TIME_MIN_S: f64 = 1e-3;
/// Sub-steps of social forces: up to thousandths of a step.
const SUBSTEPS: RangeInclusive<u32> = 1..=1_000;
/// Width and height of a picture, pixels: up to more than 8K, since each thread holds a picture or two.
const PICTURE_PIXELS: RangeInclusive<u32> = 16..=8_192;
/// Width of the ground in a picture, m.
const PICTURE_WIDTH_M: RangeInclusive<f32> = 0.01..=2.0 * COORDINATE_MAX_M;
/// Frame rate of a sequence, Hz.
const FRAME_RATE_HZ: RangeInclusive<f32> = 0.1..=1_000.0;
/// How to mend an optional key.
pub(crate) const REMOVE: &str = "remove the key to use its default";

/// Checks that every number is in range.
///
/// # Errors
/// The first number that is not.
pub(crate) fn check_ranges(scenario: &Scenario) -> Result<(), ScenarioFault> {
    check_name(&scenario.name)?;
    let (duration, step) = (&ScenarioPart::Duration, &ScenarioPart::Step);
    within(duration, "duration_s", scenario.duration_s, &DURATION_S, "give the simulated time in seconds")?;
    within(step, "dt_s", scenario.dt_s, &STEP_RANGE_S, "remove the key to use 1/30 s")?;
    if scenario.dt_s > scenario.duration_s {
        return duration.fault("duration_s is shorter than one step".into(), "give at least dt_s");
    }
    check_view(&scenario.view)?;
    check_params(&scenario.params)?;
    let agents = &scenario.agents;
    let help = "give at least one, at most a million";
    let least = usize::from(scenario.sources.is_empty());
    within(&ScenarioPart::Agents, "the number of agents", agents.len(), &(least..=AGENTS_MAX), help)?;
    agents.iter().enumerate().try_for_each(|(index, agent)| check_agent(index, agent))
}

/// Checks one number; NaN is in no range.
pub(crate) fn within<T: PartialOrd + Display>(
    part: &ScenarioPart,
    name: &str,
    value: T,
    range: &RangeInclusive<T>,
    help: &'static str,
) -> Result<(), ScenarioFault> {
    if range.contains(&value) {
        return Ok(());
    }
    part.fault(format!("{name} is {value}, not between {} and {}", range.start(), range.end()), help)
}

/// Checks that a name can name files, which must stay in their folder.
pub(crate) fn check_name(name: &str) -> Result<(), ScenarioFault> {
    let is_plain = |letter: char| !letter.is_control() && !['/', '\\'].contains(&letter);
    if (1..=NAME_MAX_BYTES).contains(&name.len()) && !name.starts_with('.') && name.chars().all(is_plain) {
        return Ok(());
    }
    let shown: String = name.chars().take(NAME_MAX_BYTES).collect();
    let help = "set `name` to letters and digits, at most 200 bytes, without `/`, `\\` or a leading dot";
    ScenarioPart::Name.fault(format!("{shown:?} cannot name a file"), help)
}

/// Checks that a view can be drawn.
///
/// # Errors
/// The first number that is out of range.
pub fn check_view(view: &View) -> Result<(), ScenarioFault> {
    let part = &ScenarioPart::View;
    within(part, "width", view.width, &PICTURE_PIXELS, REMOVE)?;
    within(part, "height", view.height, &PICTURE_PIXELS, REMOVE)?;
    within(part, "frame_rate_hz", view.frame_rate_hz, &FRAME_RATE_HZ, REMOVE)?;
    within(part, "trail_s", view.trail_s, &(0.0..=*DURATION_S.end()), "0 draws no trails")?;
    if let Some(width_m) = view.width_m {
        within(part, "width_m", width_m, &PICTURE_WIDTH_M, "remove the key for automatic framing")?;
    }
    check_points(part, view.centre_m.as_slice())
}

/// Checks the tunables. Their names end in their units, so one rule serves all: finite, times at least a millisecond
/// (they divide), only angles negative.
fn check_params(params: &Params) -> Result<(), ScenarioFault> {
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
            let part = ScenarioPart::Parameter(section.clone(), key.clone());
            within(&part, key, number, &(least..=TUNABLE_MAX), REMOVE)?;
        }
    }
    let substeps = ScenarioPart::Parameter("social_force".into(), "substeps".into());
    within(&substeps, "substeps", params.social_force.substeps, &SUBSTEPS, REMOVE)
}

pub(crate) fn check_agent(index: usize, agent: &AgentSpec) -> Result<(), ScenarioFault> {
    let (journey, part) = (&ScenarioPart::Journey(index), &ScenarioPart::Agent(index));
    check_points(journey, &[agent.position_m])?;
    check_points(journey, &agent.goals_m)?;
    let help = "give the goal, and waypoints before it";
    let least = usize::from(agent.state == 0);
    within(journey, "the number of goals", agent.goals_m.len(), &(least..=GOALS_MAX), help)?;
    check_facing(part, agent.facing_rad)?;
    within(part, "pre_movement_s", agent.pre_movement_s, &PRE_MOVEMENT_S, REMOVE)?;
    within(part, "priority", agent.priority, &PRIORITY, REMOVE)?;
    within(part, "stature", agent.stature, &STATURE, REMOVE)?;
    agent.group.map_or(Ok(()), |group| check_spacing(part, group.spacing_m))?;
    check_disc_and_speed(part, agent.radius_m, agent.wall_radius_m, agent.preferred_speed_mps)
}

pub(crate) fn check_facing(part: &ScenarioPart, facing_rad: f32) -> Result<(), ScenarioFault> {
    // In degrees as in the file: radians are rounded.
    let facing_deg = (10.0 * facing_rad.to_degrees()).round() / 10.0;
    within(part, "facing_deg", facing_deg, &FACING_DEG, "remove the key to face the first goal")
}

pub(crate) fn check_disc_and_speed(
    part: &ScenarioPart,
    radius_m: f32,
    wall_radius_m: f32,
    preferred_speed_mps: f32,
) -> Result<(), ScenarioFault> {
    within(part, "radius_m", radius_m, &RADIUS_M, "give the radius of the agent's disc in metres")?;
    let help = "give at most radius_m, or remove the key; a door narrower than twice this is closed";
    within(part, "wall_radius_m", wall_radius_m, &(*RADIUS_M.start()..=radius_m), help)?;
    let help = "people walk at about 1.3 m/s; an agent that stands has its start as its goal";
    within(part, "preferred_speed_mps", preferred_speed_mps, &SPEED_MPS, help)
}

/// Checks the distance between members.
pub(crate) fn check_spacing(part: &ScenarioPart, spacing_m: f32) -> Result<(), ScenarioFault> {
    within(part, "group_spacing_m", spacing_m, &GROUP_SPACING_M, "give the distance between two members in metres")
}

/// Checks the sizes of groups.
pub(crate) fn check_sizes(part: &ScenarioPart, sizes: &GroupSizes) -> Result<(), ScenarioFault> {
    const HELP: &str = "give shares of 0 or more, one of them above 0, as in `groups = { 1 = 0.6, 2 = 0.4 }`";
    let sum: f32 = sizes.shares.iter().sum();
    within(part, "the sum of the shares in `groups`", sum, &(f32::MIN_POSITIVE..=f32::MAX), HELP)?;
    sizes.shares.iter().try_for_each(|&share| within(part, "a share in `groups`", share, &(0.0..=f32::MAX), HELP))?;
    check_spacing(part, sizes.spacing_m)
}

pub(crate) fn check_points(part: &ScenarioPart, points_m: &[Vec2]) -> Result<(), ScenarioFault> {
    match points_m.iter().find(|point_m| !is_in_range(**point_m)) {
        None => Ok(()),
        Some(point_m) => part.fault(
            format!("[{}, {}] is not within 10 km of the origin", point_m.x, point_m.y),
            "give finite coordinates in metres, near the origin",
        ),
    }
}

fn is_in_range(point_m: Vec2) -> bool {
    // Written so that NaN fails.
    point_m.abs().max_element() <= COORDINATE_MAX_M && point_m.is_finite()
}
