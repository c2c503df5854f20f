//! What every scenario must keep, however it was made: numbers in range, agents apart, obstacles simple polygons that nobody stands in.

use std::ops::RangeInclusive;

use glam::{DVec2, Vec2};

use crate::params::Params;
use crate::polygon::{closest_distance_m, contains, is_simple, signed_area_m2};
use crate::scenario::{AgentSpec, Scenario};

/// A day; longer runs are a slip of the unit.
const DURATION_S: RangeInclusive<f32> = 1e-3..=86_400.0;
/// Coarser than half a second no gait is left between two steps.
const STEP_S: RangeInclusive<f32> = 1e-3..=0.5;
/// Beyond, f32 positions resolve no millimetre.
const COORDINATE_MAX_M: f32 = 10_000.0;
/// From a child to a person with luggage.
const RADIUS_M: RangeInclusive<f32> = 0.1..=1.0;
/// From the slowest shuffle to a sprint.
const SPEED_MPS: RangeInclusive<f32> = 0.1..=10.0;
/// Ten times the largest crowd that other simulators show.
pub const AGENTS_MAX: usize = 1_000_000;
const GOALS_MAX: usize = 10_000;
const OBSTACLES_MAX: usize = 10_000;
/// The test for self-intersection looks at every pair of edges.
const CORNERS_MAX: usize = 1_000;
/// Thinner slivers have no inside, m².
const AREA_MIN_M2: f64 = 1e-4;
/// No tunable of a human body comes near, in any unit.
const TUNABLE_MAX: f64 = 1e6;
/// The shortest step; nothing is timed finer.
const TIME_MIN_S: f64 = 1e-3;
const PICTURE_PIXELS: RangeInclusive<u32> = 16..=16_384;
const FRAME_RATE_HZ: RangeInclusive<f32> = 0.1..=1_000.0;
/// Rounding of positions that are meant to touch, m.
const TOUCH_M: f64 = 1e-4;

/// A rule that a scenario breaks.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// What breaks it.
    pub place: Place,
    /// How.
    pub message: String,
    /// What to do.
    pub help: &'static str,
}

/// A part of a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// `duration_s`
    Duration,
    /// `dt_s`
    Step,
    /// `[view]`
    View,
    /// A tunable: section and key.
    Parameter(String, String),
    /// An agent, by index.
    Agent(usize),
    /// An obstacle, by index.
    Obstacle(usize),
    /// No part in particular.
    Whole,
}

impl Place {
    fn fault<T>(&self, message: String, help: &'static str) -> Result<T, Fault> {
        Err(Fault { place: self.clone(), message, help })
    }
}

/// Every rule, cheapest first.
///
/// # Errors
/// The first rule broken.
pub fn check(scenario: &Scenario) -> Result<(), Fault> {
    check_numbers(scenario)?;
    check_obstacles(&scenario.obstacles_m)?;
    check_agents_clear_of_obstacles(scenario)?;
    check_agents_apart(&scenario.agents)
}

/// That no number is out of range: all that reading, measuring and drawing a scenario rely on.
///
/// # Errors
/// The first number that is.
pub fn check_numbers(scenario: &Scenario) -> Result<(), Fault> {
    check_time(scenario)?;
    check_view(scenario)?;
    check_params(&scenario.params)?;
    let count = scenario.agents.len();
    if count == 0 {
        return Place::Whole.fault("there is nobody to simulate".into(), "add at least one agent");
    }
    if count > AGENTS_MAX {
        return Place::Whole.fault(format!("{count} agents are more than {AGENTS_MAX}"), "simulate fewer");
    }
    for (index, agent) in scenario.agents.iter().enumerate() {
        check_agent(&Place::Agent(index), index, agent)?;
    }
    for (index, polygon_m) in scenario.obstacles_m.iter().enumerate() {
        check_points(&Place::Obstacle(index), polygon_m)?;
    }
    Ok(())
}

fn check_time(scenario: &Scenario) -> Result<(), Fault> {
    let Scenario { duration_s, dt_s, .. } = scenario;
    if !DURATION_S.contains(duration_s) {
        let message =
            format!("duration_s is {duration_s}, not between {} and {}", DURATION_S.start(), DURATION_S.end());
        return Place::Duration.fault(message, "give the simulated time in seconds");
    }
    if !STEP_S.contains(dt_s) {
        let message = format!("dt_s is {dt_s}, not between {} and {}", STEP_S.start(), STEP_S.end());
        return Place::Step.fault(message, "leave it out for 1/30 s");
    }
    if dt_s > duration_s {
        return Place::Duration.fault("duration_s is shorter than one step".into(), "give at least dt_s");
    }
    Ok(())
}

fn check_view(scenario: &Scenario) -> Result<(), Fault> {
    let view = &scenario.view;
    let wrong = |message: &str, help| Place::View.fault(message.into(), help);
    if !PICTURE_PIXELS.contains(&view.width) || !PICTURE_PIXELS.contains(&view.height) {
        return wrong("width and height must lie between 16 and 16384 pixels", "leave them out for 1280 × 720");
    }
    if !FRAME_RATE_HZ.contains(&view.frame_rate_hz) {
        return wrong("frame_rate_hz must lie between 0.1 and 1000", "leave it out for 30");
    }
    if !view.centre_m.is_none_or(is_on_the_map) {
        return wrong("centre_m is no place within 10 km of the origin", "leave it out for automatic framing");
    }
    if !view.width_m.is_none_or(|width_m| (0.01..=2.0 * COORDINATE_MAX_M).contains(&width_m)) {
        return wrong("width_m must lie between 0.01 and 20000", "leave it out for automatic framing");
    }
    if !(0.0..=*DURATION_S.end()).contains(&view.trail_s) {
        return wrong("trail_s must be 0 or more seconds", "0 draws no trails");
    }
    Ok(())
}

/// Names carry their units, so one rule serves all tunables: finite, times at least a millisecond (they divide), only angles negative.
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
            if !(least..=TUNABLE_MAX).contains(&number) {
                return Place::Parameter(section.clone(), key.clone()).fault(
                    format!("{key} is {number}, not between {least} and {TUNABLE_MAX}"),
                    "leave it out for its default",
                );
            }
        }
    }
    Ok(())
}

fn check_agent(place: &Place, index: usize, agent: &AgentSpec) -> Result<(), Fault> {
    check_points(place, &[agent.position_m])?;
    check_points(place, &agent.goals_m)?;
    let (radius_m, speed_mps) = (agent.radius_m, agent.preferred_speed_mps);
    if agent.goals_m.is_empty() || agent.goals_m.len() > GOALS_MAX {
        return place.fault(format!("agent {index} has {} goals", agent.goals_m.len()), "give 1 to 10000");
    }
    if !agent.facing_rad.is_finite() {
        return place.fault(format!("agent {index} faces nowhere"), "leave facing_deg out to face the first goal");
    }
    if !RADIUS_M.contains(&radius_m) {
        let message = format!("radius_m is {radius_m}, not between {} and {}", RADIUS_M.start(), RADIUS_M.end());
        return place.fault(message, "give the radius of a body's disc in metres");
    }
    if !SPEED_MPS.contains(&speed_mps) {
        let message =
            format!("preferred_speed_mps is {speed_mps}, not between {} and {}", SPEED_MPS.start(), SPEED_MPS.end());
        return place.fault(message, "people walk at about 1.3 m/s");
    }
    Ok(())
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

fn check_obstacles(obstacles_m: &[Vec<Vec2>]) -> Result<(), Fault> {
    if obstacles_m.len() > OBSTACLES_MAX {
        return Place::Whole.fault(format!("{} obstacles are too many", obstacles_m.len()), "give 10000 at most");
    }
    for (index, polygon_m) in obstacles_m.iter().enumerate() {
        let wrong = |what: String, help| Place::Obstacle(index).fault(format!("obstacle {index} {what}"), help);
        let corners = polygon_m.len();
        if !(3..=CORNERS_MAX).contains(&corners) {
            return wrong(
                format!("has {corners} corners"),
                "a polygon has 3 to 1000, the last not repeating the first",
            );
        }
        if !is_simple(polygon_m) {
            return wrong(
                "crosses or touches itself".into(),
                "name each corner once, in order around it, and give walls a thickness",
            );
        }
        if signed_area_m2(polygon_m).abs() < AREA_MIN_M2 {
            return wrong("has no area".into(), "give walls a thickness");
        }
    }
    Ok(())
}

fn check_agents_clear_of_obstacles(scenario: &Scenario) -> Result<(), Fault> {
    for (obstacle, polygon_m) in scenario.obstacles_m.iter().enumerate() {
        let low_m = polygon_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let high_m = polygon_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        for (index, agent) in scenario.agents.iter().enumerate() {
            let near = |point_m: Vec2| point_m.cmpge(low_m - 1.0).all() && point_m.cmple(high_m + 1.0).all();
            if near(agent.position_m) {
                check_start(index, agent, obstacle, polygon_m)?;
            }
            if agent.goals_m.iter().any(|goal_m| near(*goal_m) && contains(polygon_m, *goal_m)) {
                let message = format!("a goal of agent {index} lies inside obstacle {obstacle}");
                return Place::Agent(index).fault(message, "move the goal to free ground");
            }
        }
    }
    Ok(())
}

fn check_start(index: usize, agent: &AgentSpec, obstacle: usize, polygon_m: &[Vec2]) -> Result<(), Fault> {
    let overlap_m = f64::from(agent.radius_m) - closest_distance_m(polygon_m, agent.position_m);
    let help = "move it until its whole disc stands on free ground";
    if contains(polygon_m, agent.position_m) {
        Place::Agent(index).fault(format!("agent {index} stands inside obstacle {obstacle}"), help)
    } else if overlap_m > TOUCH_M {
        Place::Agent(index).fault(format!("agent {index} reaches {overlap_m:.2} m into obstacle {obstacle}"), help)
    } else {
        Ok(())
    }
}

/// Sweeps along x, so that a crowd of thousands is quick.
fn check_agents_apart(agents: &[AgentSpec]) -> Result<(), Fault> {
    let left_m = |index: usize| agents[index].position_m.x - agents[index].radius_m;
    let mut order: Vec<usize> = (0..agents.len()).collect();
    order.sort_by(|&a, &b| left_m(a).total_cmp(&left_m(b)).then(a.cmp(&b)));
    for (rank, &a) in order.iter().enumerate() {
        let right_m = agents[a].position_m.x + agents[a].radius_m;
        for &b in order[rank + 1..].iter().take_while(|&&b| left_m(b) < right_m) {
            let overlap_m = overlap_m(&agents[a], &agents[b]);
            if overlap_m > TOUCH_M {
                let message = format!("agents {} and {} overlap by {overlap_m:.2} m", a.min(b), a.max(b));
                return Place::Agent(a.max(b)).fault(message, "start them at least the sum of their radii apart");
            }
        }
    }
    Ok(())
}

fn overlap_m(a: &AgentSpec, b: &AgentSpec) -> f64 {
    let distance_m = DVec2::from(a.position_m).distance(DVec2::from(b.position_m));
    f64::from(a.radius_m) + f64::from(b.radius_m) - distance_m
}
