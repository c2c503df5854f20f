//! What every scenario must keep, however it was made: numbers in range (`ranges`), obstacles that are
//! simple polygons, agents that stand apart from each other and outside obstacles, and goals that lie outside them and
//! can be reached. World, metres.

use glam::{DVec2, Vec2};

use crate::maths::polygon::{closest_distance_m, contains, is_simple, signed_area_m2};
use crate::maths::sweep::sort_along_longer_side;
use crate::route::arrival::ARRIVAL_M;
use crate::scenario::ranges::check_ranges;
use crate::scenario::{AgentSpec, Scenario};

/// The test for self-intersection looks at every pair of edges.
const CORNERS_MAX: usize = 1_000;
/// Thinner slivers have no inside, m².
const AREA_MIN_M2: f64 = 1e-4;
/// No disc whose centre is farther than this from an obstacle's box touches it, m.
const NEAR_M: f32 = 1.0;
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
    /// `name`
    Name,
    /// `duration_s`
    Duration,
    /// `dt_s`
    Step,
    /// `[view]`
    View,
    /// A tunable: section and key.
    Parameter(String, String),
    /// Where an agent starts or goes, by its index.
    Journey(usize),
    /// What else is said of an agent, by its index: disc, speed and facing.
    Agent(usize),
    /// An obstacle, by index.
    Obstacle(usize),
    /// All agents together.
    Agents,
}

impl Place {
    /// That this part breaks a rule.
    pub(crate) fn fault<T>(&self, message: String, help: &'static str) -> Result<T, Fault> {
        Err(Fault { place: self.clone(), message, help })
    }
}

/// Every rule, cheapest first.
///
/// # Errors
/// The first rule broken.
pub fn check(scenario: &Scenario) -> Result<(), Fault> {
    check_ranges(scenario)?;
    check_obstacles(&scenario.obstacles_m)?;
    check_agents_clear_of_obstacles(scenario)?;
    check_agents_apart(&scenario.agents)
}

fn check_obstacles(obstacles_m: &[Vec<Vec2>]) -> Result<(), Fault> {
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
    let agents = Abreast::new(&scenario.agents);
    for (obstacle, polygon_m) in scenario.obstacles_m.iter().enumerate() {
        let low_m = polygon_m.iter().copied().fold(Vec2::INFINITY, Vec2::min) - NEAR_M;
        let high_m = polygon_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max) + NEAR_M;
        let near = |point_m: Vec2| point_m.cmpge(low_m).all() && point_m.cmple(high_m).all();
        for index in agents.between(low_m, high_m) {
            let agent = &scenario.agents[index];
            if near(agent.position_m) {
                check_start(index, agent, obstacle, polygon_m)?;
            }
            if agent.goals_m.iter().any(|goal_m| near(*goal_m) && contains(polygon_m, *goal_m)) {
                let message = format!("a goal of agent {index} lies inside obstacle {obstacle}");
                return Place::Journey(index).fault(message, "move the goal to free ground");
            }
            if let Some(goal_m) = agent.goals_m.last().filter(|goal_m| near(**goal_m)) {
                check_reach(index, agent, obstacle, closest_distance_m(polygon_m, *goal_m))?;
            }
        }
    }
    Ok(())
}

/// Agents by where they start and go along the scene's longer side: of a million agents and ten thousand obstacles only
/// those that lie abreast are held against each other.
struct Abreast {
    axis: usize,
    /// Along it, m, and whose; in order.
    places: Vec<(f32, usize)>,
}

impl Abreast {
    fn new(agents: &[AgentSpec]) -> Self {
        let mut all: Vec<(Vec2, usize)> = Vec::new();
        for (index, agent) in agents.iter().enumerate() {
            all.extend([&agent.position_m].into_iter().chain(&agent.goals_m).map(|&at_m| (at_m, index)));
        }
        let mut order: Vec<usize> = (0..all.len()).collect();
        let along_m = |place: usize, axis: usize| f64::from(all[place].0[axis]);
        let axis = sort_along_longer_side(&mut order, all.iter().map(|place| place.0), along_m);
        Self { axis, places: order.into_iter().map(|place| (all[place].0[axis], all[place].1)).collect() }
    }

    /// Those, in order, that start or go between two corners of a box, or beside it.
    fn between(&self, low_m: Vec2, high_m: Vec2) -> Vec<usize> {
        let from = self.places.partition_point(|place| place.0 < low_m[self.axis]);
        let to = self.places.partition_point(|place| place.0 <= high_m[self.axis]);
        let mut agents: Vec<usize> = self.places[from..to].iter().map(|place| place.1).collect();
        agents.sort_unstable();
        agents.dedup();
        agents
    }
}

fn check_start(index: usize, agent: &AgentSpec, obstacle: usize, polygon_m: &[Vec2]) -> Result<(), Fault> {
    let overlap_m = f64::from(agent.radius_m) - closest_distance_m(polygon_m, agent.position_m);
    let help = "move it until its whole disc stands on free ground";
    if contains(polygon_m, agent.position_m) {
        Place::Journey(index).fault(format!("agent {index} stands inside obstacle {obstacle}"), help)
    } else if overlap_m > TOUCH_M {
        Place::Journey(index).fault(format!("agent {index} reaches {overlap_m:.2} m into obstacle {obstacle}"), help)
    } else {
        Ok(())
    }
}

fn check_reach(index: usize, agent: &AgentSpec, obstacle: usize, clear_m: f64) -> Result<(), Fault> {
    let radius_m = f64::from(agent.radius_m);
    if radius_m - clear_m < ARRIVAL_M {
        return Ok(());
    }
    let message = format!(
        "agent {index}, of radius {radius_m:.2} m, cannot come within {ARRIVAL_M} m of its goal, which lies {clear_m:.2} m from obstacle {obstacle}"
    );
    Place::Journey(index).fault(message, "move the goal away from the wall")
}

fn check_agents_apart(agents: &[AgentSpec]) -> Result<(), Fault> {
    let low_m = |index: usize, axis: usize| agents[index].position_m[axis] - agents[index].radius_m;
    let mut order: Vec<usize> = (0..agents.len()).collect();
    let places_m = agents.iter().map(|agent| agent.position_m);
    let axis = sort_along_longer_side(&mut order, places_m, |index, axis| low_m(index, axis).into());
    for (rank, &a) in order.iter().enumerate() {
        let high_m = agents[a].position_m[axis] + agents[a].radius_m;
        for &b in order[rank + 1..].iter().take_while(|&&b| low_m(b, axis) < high_m) {
            let overlap_m = overlap_m(&agents[a], &agents[b]);
            if overlap_m > TOUCH_M {
                let message = format!("agents {} and {} overlap by {overlap_m:.2} m", a.min(b), a.max(b));
                return Place::Journey(a.max(b)).fault(message, "start them at least the sum of their radii apart");
            }
        }
    }
    Ok(())
}

fn overlap_m(a: &AgentSpec, b: &AgentSpec) -> f64 {
    let distance_m = DVec2::from(a.position_m).distance(DVec2::from(b.position_m));
    f64::from(a.radius_m) + f64::from(b.radius_m) - distance_m
}
