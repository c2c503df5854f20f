//! One scene of [`crate::paper::scenes`], simulated and measured: figures of the crowd, visits of states, agents that are
//! blocked, the time of a step, and frames at three moments. World, metres, seconds.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use fbcrowd_render::raster::png_frame;
use fbcrowd_render::top_view::{TopView, Tracks};
use fbcrowd_sim::measures::{Measures, Measuring};
use fbcrowd_sim::recording::{AgentFrame, Header};
use fbcrowd_sim::scenario::Scenario;
use fbcrowd_sim::simulation::Simulation;
use motiondb::motion::MotionDb;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::scenario_run::{create_parent, step_count};

/// Preferred speed from which an agent wants to walk, m/s.
const WANTS_MPS: f32 = 0.1;
/// An agent is blocked where it wants to walk for this time, s, and gets no farther than this distance, m: the net stall
/// of `docs/definitions.md`, which shuffling does not hide.
const BLOCKED_S: f32 = 5.0;
const BLOCKED_M: f32 = 0.5;
/// Moments of the pictures, as shares of the duration.
const MOMENTS: [f32; 3] = [0.15, 0.5, 0.85];

/// Figures of one scene with one seed.
#[derive(JsonSchema, Serialize)]
pub struct SceneFigures {
    /// Name of the scene.
    pub scene: String,
    /// Seed of everything random.
    pub seed: u64,
    /// Simulated time, s.
    pub duration_s: f32,
    /// Number of agents that were present at any time.
    pub agents: usize,
    /// Greatest number of agents that were present at once.
    pub most_at_once: usize,
    /// C: collision rate of discs.
    pub collision_rate: f64,
    /// A: mean acceleration, m/s².
    pub mean_acceleration_mps2: f64,
    /// Number of agents that arrived at their last goal, or left the scene.
    pub arrived: usize,
    /// Number of agents that left the scene.
    pub removed: usize,
    /// Number of agents that left the scene, per minute.
    pub removed_per_min: f64,
    /// Share of the agents of the start that left the scene.
    pub left_of_first: f64,
    /// Share of agent-steps with a capsule more than 1 cm inside a wall.
    pub wall_body_deep_share: f64,
    /// Greatest depth of a body in a wall, mm.
    pub wall_body_max_mm: f64,
    /// Deepest overlap of two bodies, summed over pairs and steps, per agent and step, mm.
    pub body_penetration_mm: f64,
    /// Share of agent-steps in which a body touches another.
    pub body_touching_share: f64,
    /// Number of times that an agent wanted to walk for 5 s and came no farther than 0.5 m.
    pub blocked: usize,
    /// The same per agent that is present and minute.
    pub blocked_per_agent_min: f64,
    /// Entries into each state of the behaviour.
    pub states: Vec<StateVisits>,
    /// Time of a step on one thread, divided by the number of agents, µs.
    pub agent_step_us: f64,
}

/// Entries into one state.
#[derive(JsonSchema, Serialize)]
pub struct StateVisits {
    /// Name of the state.
    pub state: String,
    /// Number of entries, without agents that began in it.
    pub entered: usize,
    /// Entries per agent that is present and minute.
    pub per_agent_min: f64,
    /// Number of times that an agent in this state was blocked.
    pub blocked: usize,
}

/// The roots of all agents, and the frames of the pictures with their times, s.
pub(crate) struct SceneMoments {
    tracks: Tracks,
    frames: Vec<(f32, Vec<AgentFrame>)>,
}

/// Agents that want to walk and are blocked.
struct BlockedAgents {
    /// Number of steps in which each agent has wanted to walk, by id.
    wanting_steps: Vec<usize>,
    /// Number of times that agents were blocked, by state.
    by_state: Vec<usize>,
    /// Number of steps after which an agent is blocked.
    limit_steps: usize,
}

/// Simulates a scene from start to end.
pub(crate) fn simulate(db: &Arc<MotionDb>, scenario: &Scenario) -> (SceneFigures, SceneMoments) {
    let mut simulation = Simulation::new(Arc::clone(db), scenario);
    let mut measuring = Measuring::new(&db.skeleton, scenario, simulation.population(), simulation.frames());
    let mut moments = SceneMoments { tracks: Tracks::new(scenario.dt_s), frames: Vec::new() };
    moments.tracks.push_frame(simulation.frames());
    let steps = step_count(scenario);
    let pictures = MOMENTS.map(|share| (share * steps as f32) as usize);
    let (mut stepping, mut agent_steps, mut most_at_once) = (Duration::ZERO, 0, simulation.frames().len());
    let mut entered = vec![0; scenario.behaviour.states.len()];
    let (mut before, mut blocked) = (simulation.frames().to_vec(), BlockedAgents::new(scenario));
    for step in 1..=steps {
        let start = Instant::now();
        simulation.step(&mut |_| {});
        stepping += start.elapsed();
        let frames = simulation.frames();
        measuring.push(simulation.population(), frames);
        moments.tracks.push_frame(frames);
        agent_steps += frames.len();
        most_at_once = most_at_once.max(frames.len());
        for [before, after] in pairs(&before, frames) {
            if before.state != after.state {
                entered[usize::from(after.state)] += 1;
            }
        }
        blocked.push(step, frames, &moments.tracks);
        if pictures.contains(&step) {
            moments.frames.push((step as f32 * scenario.dt_s, frames.to_vec()));
        }
        before.clear();
        before.extend_from_slice(frames);
    }
    let first = &simulation.population().agents[..scenario.agents.len()];
    let left_of_first = first.iter().filter(|life| life.removed.is_some()).count() as f64 / first.len() as f64;
    let measures = measuring.finish(simulation.population());
    let agent_min = agent_steps as f64 * f64::from(scenario.dt_s) / 60.0;
    let states = scenario.behaviour.states.iter().zip(entered.iter().zip(&blocked.by_state)).skip(1);
    let states = states.map(|(state, (&entered, &blocked))| StateVisits {
        state: state.name.clone(),
        entered,
        per_agent_min: entered as f64 / agent_min,
        blocked,
    });
    let blocked = blocked.by_state.iter().sum();
    let figures = SceneFigures {
        most_at_once,
        left_of_first,
        blocked,
        blocked_per_agent_min: blocked as f64 / agent_min,
        states: states.collect(),
        agent_step_us: 1e6 * stepping.as_secs_f64() / agent_steps.max(1) as f64,
        ..measured(scenario, &measures)
    };
    (figures, moments)
}

fn measured(scenario: &Scenario, measures: &Measures) -> SceneFigures {
    SceneFigures {
        scene: scenario.name.clone(),
        seed: scenario.seed,
        duration_s: scenario.duration_s,
        agents: measures.agents,
        most_at_once: 0,
        collision_rate: measures.collision_rate,
        mean_acceleration_mps2: measures.mean_acceleration_mps2,
        arrived: measures.arrived,
        removed: measures.removed,
        removed_per_min: 60.0 * measures.removed as f64 / f64::from(scenario.duration_s),
        left_of_first: 0.0,
        wall_body_deep_share: measures.wall_body_deep_share,
        wall_body_max_mm: measures.wall_body_max_mm,
        body_penetration_mm: measures.body_penetration_mm,
        body_touching_share: measures.body_touching_share,
        blocked: 0,
        blocked_per_agent_min: 0.0,
        states: Vec::new(),
        agent_step_us: 0.0,
    }
}

/// Frames of the agents that are present in both of two steps; both are in the order of ids.
fn pairs<'a>(before: &'a [AgentFrame], after: &'a [AgentFrame]) -> impl Iterator<Item = [&'a AgentFrame; 2]> {
    let mut rest = before.iter().peekable();
    after.iter().filter_map(move |after| {
        while rest.next_if(|before| before.id < after.id).is_some() {}
        rest.next_if(|before| before.id == after.id).map(|before| [before, after])
    })
}

impl BlockedAgents {
    fn new(scenario: &Scenario) -> Self {
        let limit_steps = (BLOCKED_S / scenario.dt_s).round() as usize;
        Self { wanting_steps: Vec::new(), by_state: vec![0; scenario.behaviour.states.len().max(1)], limit_steps }
    }

    /// Adds a frame, which the tracks hold already.
    fn push(&mut self, frame: usize, agents: &[AgentFrame], tracks: &Tracks) {
        self.wanting_steps.resize(tracks.agents.len(), 0);
        for agent in agents {
            let index = agent.id.index();
            let wanting_steps = &mut self.wanting_steps[index];
            *wanting_steps = if agent.preferred_mps.length() >= WANTS_MPS { *wanting_steps + 1 } else { 0 };
            if *wanting_steps < self.limit_steps {
                continue;
            }
            let before_m = tracks.position_m(index, frame.saturating_sub(self.limit_steps));
            if before_m.is_some_and(|before_m| before_m.distance(agent.root.position_m) < BLOCKED_M) {
                self.by_state[usize::from(agent.state)] += 1;
                *wanting_steps = 0;
            }
        }
    }
}

/// Draws the three moments from above.
pub(crate) fn draw(
    folder: &Path,
    db: &MotionDb,
    scenario: &Scenario,
    moments: &SceneMoments,
) -> Result<(), BenchError> {
    let header = Header::new(db, 0, scenario.clone());
    let top_view = TopView::new(&header, &moments.tracks)?;
    let mut buffers = top_view.buffers();
    for (time_s, agents) in &moments.frames {
        let path = folder.join(format!("{}_s{}_at_{time_s:.0}_s.png", scenario.name, scenario.seed));
        create_parent(&path)?;
        png_frame::write(&path, top_view.draw(&mut buffers, *time_s, agents))?;
    }
    Ok(())
}
