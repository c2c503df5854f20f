//! A scenario → what its simulation will need, and what its walls close, without simulating it.

use std::path::Path;

use fbcrowd_render::plots::crowd::scene_plan;
use fbcrowd_render::raster::png_frame;
use fbcrowd_sim::route::mesh::RouteMesh;
use fbcrowd_sim::route::{ClosedToAgents, CrowdRoutes, closed_to_agents};
use fbcrowd_sim::scenario::{BarredGoals, Scenario, SourceSpec};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::JobError;
use crate::simulation::AGENT_BYTES;

/// Bytes of an agent in a frame of a recording; measured on the bundled scenarios: 148.
const RECORDED_AGENT_BYTES: u64 = 150;
/// Bytes of a MiB.
const MIB: f64 = (1 << 20) as f64;
/// Bytes of a frame of a recording, its chunk and its entry in the index included.
const RECORDED_FRAME_BYTES: u64 = 40;

/// What is known of a scenario before its simulation.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SceneFigures {
    /// Name of the scenario.
    pub name: String,
    /// Number of agents at the start.
    pub agents: usize,
    /// Number of agents that are due at sources until the end.
    pub due_agents: usize,
    /// Number of sources.
    pub sources: usize,
    /// Number of obstacles.
    pub obstacles: usize,
    /// Number of walkable polygons; without any the ground is open.
    pub walkable: usize,
    /// Simulated time, s.
    pub duration_s: f32,
    /// Time step, s.
    pub dt_s: f32,
    /// Number of time steps.
    pub steps: usize,
    /// The meshes that routes use, one for each class of wall radii; none on open ground.
    pub meshes: Vec<MeshFigures>,
    /// Passages that are too narrow for agents: those that separate parts of the ground first, the widest first.
    pub closed_passages: Vec<ClosedPassageFigures>,
    /// Goals that some agents never reach, because zones are closed to them.
    pub barred_goals: Vec<BarredGoalsFigures>,
    /// What the scenario states without effect, a sentence each: states that no agent enters, conditions that never
    /// hold, doors that never open, and the like.
    pub notes: Vec<String>,
    /// Memory that the simulation needs beside its database, MiB: an estimate.
    pub memory_mib: f64,
    /// Size of the recording if no agent leaves, MiB: an estimate.
    pub recording_mib: f64,
}

/// A mesh for routes.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MeshFigures {
    /// Distance that the mesh keeps from walls, m.
    pub wall_radius_m: f32,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of parts; no route leads from one to another.
    pub parts: u32,
}

/// A passage that is too narrow for agents.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ClosedPassageFigures {
    /// Middle of the passage, world x and y, m.
    pub at_m: [f32; 2],
    /// Width of the passage, m.
    pub width_m: f32,
    /// Wall radius of the agents to which it is closed, m.
    pub wall_radius_m: f32,
    /// Whether it separates parts of the ground; otherwise a detour leads around it.
    pub separates: bool,
}

/// Goals of a state whose areas all lie in zones that are closed to some of its agents.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BarredGoalsFigures {
    /// Name of the state.
    pub state: String,
    /// Name of the goals.
    pub goals: String,
    /// Indices of the zones.
    pub zones: Vec<usize>,
    /// The same as a sentence.
    pub text: String,
}

/// A scenario that has been checked.
pub struct SceneCheck {
    /// The scenario.
    pub scenario: Scenario,
    /// Its routes.
    pub routes: CrowdRoutes,
    /// Passages that are too narrow for its agents.
    pub closed: Vec<ClosedToAgents>,
    /// Its figures.
    pub figures: SceneFigures,
}

impl SceneCheck {
    /// Draws walls, mesh, routes, sources, goals and closed passages.
    ///
    /// # Errors
    /// If the picture cannot be written.
    pub fn draw(&self, path: &Path) -> Result<(), JobError> {
        Ok(png_frame::write(path, &scene_plan(&self.scenario, &self.routes, &self.closed))?)
    }
}

/// Finds the routes of a scenario, the passages that its walls close, and what its simulation will need.
///
/// # Errors
/// If no mesh can be made of its ground.
pub fn check_scene(scenario: Scenario) -> Result<SceneCheck, JobError> {
    let routes = CrowdRoutes::new(&scenario)?;
    let closed = closed_to_agents(&scenario);
    let figures = figures(&scenario, &routes, &closed);
    Ok(SceneCheck { scenario, routes, closed, figures })
}

fn figures(scenario: &Scenario, routes: &CrowdRoutes, closed: &[ClosedToAgents]) -> SceneFigures {
    let due = due_times_s(scenario);
    let agents = scenario.agents.len();
    let frames = |from_s: f64| ((f64::from(scenario.duration_s) - from_s) / f64::from(scenario.dt_s)) as u64 + 1;
    let agent_frames = agents as u64 * frames(0.0) + due.iter().map(|&due_s| frames(due_s)).sum::<u64>();
    let memory_bytes = routes.bytes() + (agents + due.len()) * AGENT_BYTES;
    let recording_bytes = agent_frames * RECORDED_AGENT_BYTES + frames(0.0) * RECORDED_FRAME_BYTES;
    let barred = |barred: BarredGoals| {
        let text = barred.to_string();
        let BarredGoals { state, goals, zones } = barred;
        BarredGoalsFigures { state, goals, zones, text }
    };
    let mesh = |(wall_radius_m, mesh): (f32, &RouteMesh)| MeshFigures {
        wall_radius_m,
        triangles: mesh.triangle_count(),
        parts: mesh.part_count(),
    };
    SceneFigures {
        name: scenario.name.clone(),
        agents,
        due_agents: due.len(),
        sources: scenario.sources.len(),
        obstacles: scenario.obstacles_m.len() + scenario.enclosures_m.len() + scenario.doors.len(),
        walkable: scenario.walkable_m.len(),
        duration_s: scenario.duration_s,
        dt_s: scenario.dt_s,
        steps: scenario.steps(),
        meshes: routes.meshes().map(mesh).collect(),
        closed_passages: closed_passages(closed),
        barred_goals: scenario.barred_goals().into_iter().map(barred).collect(),
        notes: scenario.notes(),
        memory_mib: memory_bytes as f64 / MIB,
        recording_mib: recording_bytes as f64 / MIB,
    }
}

/// Times at which agents are due at all sources, s.
fn due_times_s(scenario: &Scenario) -> Vec<f64> {
    let until_s = f64::from(scenario.duration_s);
    let of_source = |(index, source): (usize, &SourceSpec)| {
        source.due_times(scenario.seed, index).take_while(move |due_s| *due_s <= until_s).collect::<Vec<_>>()
    };
    scenario.sources.iter().enumerate().flat_map(of_source).collect()
}

fn closed_passages(closed: &[ClosedToAgents]) -> Vec<ClosedPassageFigures> {
    let of_radius = closed.iter().flat_map(|&ClosedToAgents { wall_radius_m, ref passages }| {
        passages.iter().map(move |passage| ClosedPassageFigures {
            at_m: passage.at_m.to_array(),
            width_m: passage.width_m,
            wall_radius_m,
            separates: passage.separates,
        })
    });
    of_radius.collect()
}
