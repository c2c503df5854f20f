//! Durations of the stages of a frame in one scene ([`crate::paper::figure6`]).

use std::time::Duration;

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::observer::Work;
use rayon::ThreadPool;
use schemars::JsonSchema;
use serde::Serialize;

use crate::kit::statistics::median;
use crate::paper::figure6_scene::{Scene, TURNS};

/// Least number of agents times steps in a turn.
const AGENT_STEPS: usize = 200;
/// Steps of a simulation for one frame of one thread and one of two.
const STEPS: usize = 4;

/// Median durations of one scene per frame.
#[derive(JsonSchema, Serialize)]
pub struct FrameTimes {
    /// Number of agents.
    pub agents: usize,
    /// Planning (MCN) on one thread, ms.
    pub mcn_ms: f32,
    /// Synthesis (HMS) on one thread, ms.
    pub hms_ms: f32,
    /// Coupling (CNS) on one thread, ms.
    pub cns_ms: f32,
    /// The whole frame on one thread, ms.
    pub frame_ms: f32,
    /// The whole frame on two threads, ms.
    pub frame_two_threads_ms: f32,
    /// Ratio of the speeds of two threads and of one.
    pub two_threads: f32,
    /// Share of bodies in semi-procedural locomotion, mean over the turns, 0 to 1.
    pub deformed_share: f32,
    #[serde(skip)]
    pub(crate) turns: Vec<Turn>,
}

/// Durations of one turn, per frame, and the share of deformed bodies at its end.
pub(crate) struct Turn {
    pub(crate) one_thread: StageTimes,
    pub(crate) two_threads: StageTimes,
    pub(crate) deformed_share: f32,
}

/// Durations of one frame by stage, ms.
#[derive(Clone, Copy, Default)]
pub(crate) struct StageTimes {
    pub(crate) mcn_ms: f32,
    pub(crate) hms_ms: f32,
    pub(crate) cns_ms: f32,
}

impl StageTimes {
    fn total_ms(&self) -> f32 {
        self.mcn_ms + self.hms_ms + self.cns_ms
    }
}

/// Times all scenes, turn by turn; returns the turns of each.
pub(crate) fn timed(mut scenes: Vec<&mut Scene>, pools: &[ThreadPool; 2], observer: &Observer) -> Vec<Vec<Turn>> {
    let mut turns: Vec<Vec<Turn>> = scenes.iter().map(|_| Vec::new()).collect();
    let work = Work::begin(observer, "turns", TURNS);
    for _ in 0..TURNS {
        for (scene, turns) in scenes.iter_mut().zip(&mut turns) {
            turns.push(turn(scene, pools));
            scene.skip(scene.between);
        }
        work.advance();
    }
    work.end();
    turns
}

/// Times frames of one thread and of two, one after the other.
fn turn(scene: &mut Scene, pools: &[ThreadPool; 2]) -> Turn {
    let repeats = AGENT_STEPS.div_ceil(scene.scenario.agents.len());
    let mut spent = [[Duration::ZERO; 3]; 2];
    for _ in 0..repeats {
        if scene.steps_left < STEPS {
            scene.begin();
        }
        for (pool, spent) in pools.iter().zip(&mut spent) {
            pool.install(|| {
                scene.skip(1);
                scene.frame(spent);
            });
        }
    }
    let [one_thread, two_threads] = spent.map(|stages| {
        let [mcn_ms, hms_ms, cns_ms] = stages.map(|spent| spent.as_secs_f32() * 1e3 / repeats as f32);
        StageTimes { mcn_ms, hms_ms, cns_ms }
    });
    Turn { one_thread, two_threads, deformed_share: scene.deformed_share() }
}

impl FrameTimes {
    /// Medians over the turns of a scene; none without turns.
    pub(crate) fn new(scene: &Scene, turns: Vec<Turn>) -> Option<Self> {
        let of = |figure: fn(&Turn) -> f32| median(turns.iter().map(figure));
        Some(Self {
            agents: scene.scenario.agents.len(),
            mcn_ms: of(|turn| turn.one_thread.mcn_ms)?,
            hms_ms: of(|turn| turn.one_thread.hms_ms)?,
            cns_ms: of(|turn| turn.one_thread.cns_ms)?,
            frame_ms: of(|turn| turn.one_thread.total_ms())?,
            frame_two_threads_ms: of(|turn| turn.two_threads.total_ms())?,
            two_threads: of(|turn| turn.one_thread.total_ms() / turn.two_threads.total_ms())?,
            deformed_share: turns.iter().map(|turn| turn.deformed_share).sum::<f32>() / turns.len() as f32,
            turns,
        })
    }

    /// A duration per frame, ms, as one per agent, µs.
    fn per_agent_us(&self, frame_ms: f32) -> f64 {
        f64::from(frame_ms) * 1e3 / self.agents as f64
    }

    /// Synthesis on one thread, µs per body.
    pub(crate) fn synthesis_us(&self) -> f64 {
        self.per_agent_us(self.hms_ms)
    }

    /// The whole step on one thread, µs per agent.
    pub(crate) fn step_us(&self) -> f64 {
        self.per_agent_us(self.frame_ms)
    }

    /// Frames per second on two threads.
    pub(crate) fn frames_hz(&self) -> f64 {
        1e3 / f64::from(self.frame_two_threads_ms)
    }
}
