//! Durations of the stages of a simulation's steps.

use std::time::{Duration, Instant};

use fbcrowd_sim::simulation::Stage;
use schemars::JsonSchema;
use serde::Serialize;

/// Durations of a whole simulation. They are not part of a recording.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct Timings {
    /// Number of agents; where agents come and go, the mean number in a step.
    pub agents: usize,
    /// Number of time steps.
    pub steps: usize,
    /// Number of threads.
    pub threads: usize,
    /// Route, neighbour search and planning, µs per agent and step.
    pub plan_microseconds_per_agent_step: f64,
    /// Synthesis of bodies, µs per agent and step.
    pub synthesis_microseconds_per_agent_step: f64,
    /// Coupling of discs and bodies, µs per agent and step.
    pub coupling_microseconds_per_agent_step: f64,
    /// Simulated time, divided by the duration of all stages; writing the recording does not count.
    pub times_real_time: f64,
    /// Agents that one core simulates in real time at this time step, if all threads were busy throughout.
    pub agents_per_core_in_real_time: f64,
}

/// Sums the durations of each stage over all steps.
#[derive(Debug, Default)]
pub struct StepStopwatch {
    last: Option<Instant>,
    planning: Duration,
    synthesis: Duration,
    coupling: Duration,
}

impl StepStopwatch {
    /// A step begins.
    pub fn start(&mut self) {
        self.last = Some(Instant::now());
    }

    /// A stage of the step ends. Route and neighbour search count as planning.
    pub fn lap(&mut self, stage: Stage) {
        let now = Instant::now();
        let spent = self.last.replace(now).map_or(Duration::ZERO, |last| now - last);
        match stage {
            Stage::Route | Stage::Neighbours | Stage::Planning => self.planning += spent,
            Stage::Synthesis => self.synthesis += spent,
            Stage::Coupling => self.coupling += spent,
        }
    }

    /// The durations of `steps` steps of `dt_s` seconds, given the number of agents summed over the steps.
    pub fn timings(&self, agent_steps: usize, steps: usize, dt_s: f32) -> Timings {
        let agents = (agent_steps + steps / 2) / steps.max(1);
        let agent_steps = agent_steps.max(1) as f64;
        let microseconds = |spent: Duration| spent.as_secs_f64() * 1e6 / agent_steps;
        let total = self.planning + self.synthesis + self.coupling;
        let threads = rayon::current_num_threads();
        let times_real_time = steps as f64 * f64::from(dt_s) / total.as_secs_f64().max(1e-9);
        Timings {
            agents,
            steps,
            threads,
            plan_microseconds_per_agent_step: microseconds(self.planning),
            synthesis_microseconds_per_agent_step: microseconds(self.synthesis),
            coupling_microseconds_per_agent_step: microseconds(self.coupling),
            times_real_time,
            agents_per_core_in_real_time: times_real_time * agents as f64 / threads as f64,
        }
    }
}
