//! Whether anything is wrong with the simulation of a random scenario file that is accepted.
//!
//! Checked in every step: all numbers are finite; ids rise, none comes twice; the agents of a frame are those that the
//! population has as present, no other; no root is moved through a wall or off the ground, and none passes a
//! one-way zone from its exit to its entry. World, metres.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fbcrowd_sim::measures::Measuring;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::scenario::{self, Scenario, StateZones};
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::world::obstacles::{Obstacles, ZoneWalls};
use motiondb::files::SourceText;
use motiondb::motion::MotionDb;

use crate::soak::generated::one_way_passages::OneWayPassages;
use crate::soak::generated::scenario_text::scenario_text;
use crate::soak::tally::CopyOutcome;

/// Simulated steps.
const STEPS: u32 = 150;

/// Reads and simulates the scenario of a seed; writes the text of a faulty one to a folder.
pub(crate) fn simulated(db: &Arc<MotionDb>, seed: u64, faulty: Option<&Path>) -> CopyOutcome {
    let source = SourceText { path: PathBuf::from("generated.toml"), text: scenario_text(seed) };
    let Ok((scenario, _)) = scenario::parse(&source) else { return CopyOutcome::Rejected };
    let fault = match fault(db, &scenario) {
        Ok(()) => return CopyOutcome::Used,
        Err(None) => return CopyOutcome::Rejected,
        Err(Some(fault)) => fault,
    };
    if let Some(folder) = faulty {
        // The fault is reported whether or not the text can be written.
        let _ = fs::write(folder.join(format!("{seed:x}.toml")), format!("# {fault}\n{}", source.text));
    }
    CopyOutcome::Harmful(fault)
}

/// Simulates a scenario.
///
/// # Errors
/// The first fault; none where the simulation itself reports transitions without end, and is stopped.
fn fault(db: &Arc<MotionDb>, scenario: &Scenario) -> Result<(), Option<&'static str>> {
    let mut walls = FrameWalls::new(scenario, Vec::new());
    let mut passages = OneWayPassages::new(scenario.one_way_zones());
    let mut simulation = Simulation::new(Arc::clone(db), scenario);
    let mut measuring = Measuring::new(&db.skeleton, scenario, simulation.population(), simulation.frames());
    let mut before = simulation.frames().to_vec();
    for frame in 1..=STEPS {
        simulation.step(&mut |_| ());
        let closed = simulation.population().closed_doors(frame);
        if walls.closed != closed {
            walls = FrameWalls::new(scenario, closed);
        }
        let fault = fault_of_frame(&simulation, frame)
            .or_else(|| fault_of_step(&simulation, &before, frame, &walls))
            .or_else(|| fault_of_passages(&simulation, &before, frame, &mut passages));
        if simulation.endless_transitions().is_some() {
            return Err(None);
        }
        if fault.is_some() {
            return Err(fault);
        }
        measuring.push(simulation.population(), simulation.frames());
        before = simulation.frames().to_vec();
    }
    let measures = measuring.finish(simulation.population());
    let kept = measures.agents - measures.removed == simulation.frames().len();
    if kept { Ok(()) } else { Err(Some("counts other agents than came and left")) }
}

/// The walls of a frame.
struct FrameWalls {
    /// Whether each door is closed, by index.
    closed: Vec<bool>,
    of_all: Obstacles,
    /// The walls of agents that do not enter some zones.
    of_zones: ZoneWalls,
    of_states: StateZones,
}

impl FrameWalls {
    fn new(scenario: &Scenario, closed: Vec<bool>) -> Self {
        let (of_all, of_zones) = (scenario.walls_with(&closed), scenario.zone_walls(&closed));
        Self { of_all, of_zones, of_states: StateZones::new(scenario), closed }
    }
}

/// What is wrong with the agents of a frame.
fn fault_of_frame(simulation: &Simulation, frame: u32) -> Option<&'static str> {
    let (frames, lives) = (simulation.frames(), &simulation.population().agents);
    let is_finite = |agent: &AgentFrame| {
        agent.root.position_m.is_finite()
            && agent.root.facing_rad.is_finite()
            && agent.preferred_mps.is_finite()
            && agent.planned_mps.is_finite()
            && agent.pose.pelvis_m.is_finite()
    };
    if !frames.iter().all(is_finite) {
        return Some("moves a body by no finite number");
    }
    if !frames.windows(2).all(|pair| pair[0].id < pair[1].id) {
        return Some("has an agent twice");
    }
    let present = lives.iter().enumerate().filter(|(_, life)| life.is_present(frame)).map(|(id, _)| id);
    let is_kept = present.eq(frames.iter().map(|agent| agent.id.index()));
    (!is_kept).then_some("loses an agent")
}

/// What is wrong with the way of the agents from one frame to the next.
fn fault_of_step(
    simulation: &Simulation,
    before: &[AgentFrame],
    frame: u32,
    walls: &FrameWalls,
) -> Option<&'static str> {
    let lives = &simulation.population().agents;
    simulation.frames().iter().find_map(|agent| {
        let to_m = agent.root.position_m;
        let life = &lives[agent.id.index()];
        let (own, state) = (life.spec.closed_zones, usize::from(agent.state));
        let closed_zones = walls.of_states.for_walls(own, state, to_m, life.wall_radius_m(frame));
        let walls = walls.of_zones.of(closed_zones).unwrap_or(&walls.of_all);
        if walls.contains(to_m) {
            return Some("leads an agent into a wall");
        }
        let from = before.binary_search_by_key(&agent.id, |other| other.id).ok()?;
        let is_free = lives[agent.id.index()].is_teleported(frame) || walls.is_free(before[from].root.position_m, to_m);
        (!is_free).then_some("leads an agent through a wall")
    })
}

/// Whether an agent has passed a one-way zone the wrong way.
fn fault_of_passages(
    simulation: &Simulation,
    before: &[AgentFrame],
    frame: u32,
    passages: &mut OneWayPassages,
) -> Option<&'static str> {
    let lives = &simulation.population().agents;
    let is_against = |agent: &AgentFrame| {
        let index = agent.id.index();
        if lives[index].is_teleported(frame) {
            passages.forget(index);
            return false;
        }
        let from = before.binary_search_by_key(&agent.id, |other| other.id);
        from.is_ok_and(|from| passages.is_against(index, before[from].root.position_m, agent.root.position_m))
    };
    let mut frames = simulation.frames().iter();
    frames.any(is_against).then_some("passes a one-way zone from its exit to its entry")
}
