//! Scenes that are timed ([`crate::paper::figure6`]): antipodal circles, and crowds that meet from all sides. World,
//! metres, seconds.

use std::f32::consts::TAU;
use std::sync::Arc;
use std::time::{Duration, Instant};

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use fbcrowd_sim::simulation::{Simulation, Stage};
use fbcrowd_sim::synthesis::Mode;
use glam::Vec2;
use motiondb::motion::MotionDb;

use crate::kit::crowd::{agent_across, disc};

/// Number of turns in which a scene is timed.
pub(crate) const TURNS: usize = 25;
/// Spacing of the agents along a circle, m, as in `assets/scenarios/table1`.
const SPACING_M: f32 = 1.5;
/// Greatest distance of an agent from its point of the circle, as a share of the spacing.
const JITTER: f64 = 0.1;
/// Least radius of a circle, m.
const RADIUS_MIN_M: f32 = 4.0;
/// A film's time step, s.
const DT_S: f32 = 1.0 / 30.0;
/// Steps until all agents of a circle walk.
const WARM_UP: usize = 30;
/// Steps until the agents of a crowd have met, as in `bench plan`.
const CROWD_WARM_UP: usize = 90;
/// Most agents of a circle that is followed over its whole crossing, of 36 s; larger circles take minutes.
const CROSSED: usize = 100;

/// A simulation that is timed in turns.
pub(crate) struct Scene {
    db: Arc<MotionDb>,
    pub(crate) scenario: Scenario,
    /// Steps at the beginning that are not timed.
    warm_up: usize,
    /// Steps between two turns.
    pub(crate) between: usize,
    pub(crate) simulation: Simulation,
    /// Steps until all agents are across.
    pub(crate) steps_left: usize,
}

impl Scene {
    /// An antipodal circle.
    pub(crate) fn circle(db: &Arc<MotionDb>, agents: usize) -> Self {
        let radius_m = (agents as f32 * SPACING_M / TAU).max(RADIUS_MIN_M);
        let mut random = SplitMix64::new(1, agents as u64);
        let mut agent = |index: usize| {
            let angle_rad = TAU * index as f32 / agents as f32 + random.within(JITTER) as f32 * SPACING_M / radius_m;
            agent_across(radius_m * Vec2::from_angle(angle_rad))
        };
        let agents_on_circle: Vec<AgentSpec> = (0..agents).map(&mut agent).collect();
        let circle = Self::new(db, Scenario::of(agents_on_circle), WARM_UP);
        Self { between: if agents <= CROSSED { circle.steps_left / TURNS } else { 0 }, ..circle }
    }

    /// A disc of agents, each with another's position as its goal: neighbours go in all directions and meet at once.
    pub(crate) fn crowd(db: &Arc<MotionDb>, agents: usize) -> Self {
        let mut scenario = disc(agents);
        let mut random = SplitMix64::new(1, agents as u64);
        let positions_m = scenario.agents.iter().map(|agent| (random.within(1.0), agent.position_m));
        let mut drawn_m: Vec<(f64, Vec2)> = positions_m.collect();
        drawn_m.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (agent, (_, goal_m)) in scenario.agents.iter_mut().zip(drawn_m) {
            agent.goals_m = vec![goal_m];
            agent.facing_rad = (goal_m - agent.position_m).to_angle();
        }
        Self::new(db, scenario, CROWD_WARM_UP)
    }

    fn new(db: &Arc<MotionDb>, scenario: Scenario, warm_up: usize) -> Self {
        let scenario = Scenario { dt_s: DT_S, ..scenario };
        let simulation = Simulation::new(Arc::clone(db), &scenario);
        let mut scene = Self { db: Arc::clone(db), scenario, warm_up, between: 0, simulation, steps_left: 0 };
        scene.begin();
        scene
    }

    /// Begins, or begins again, and steps until all agents walk.
    pub(crate) fn begin(&mut self) {
        let duration_s = |agent: &AgentSpec| agent.position_m.distance(agent.goals_m[0]) / agent.preferred_speed_mps;
        let longest_s = self.scenario.agents.iter().map(duration_s).fold(0.0, f32::max);
        self.simulation = Simulation::new(Arc::clone(&self.db), &self.scenario);
        self.steps_left = (longest_s / DT_S) as usize;
        self.skip(self.warm_up);
    }

    /// Makes steps that are not timed.
    pub(crate) fn skip(&mut self, steps: usize) {
        (0..steps).for_each(|_| self.simulation.step(&mut |_| ()));
        self.steps_left = self.steps_left.saturating_sub(steps);
    }

    /// Makes one step; adds the durations of planning, synthesis and coupling.
    pub(crate) fn frame(&mut self, spent: &mut [Duration; 3]) {
        let mut last = Instant::now();
        self.simulation.step(&mut |stage| {
            let now = Instant::now();
            let index = match stage {
                Stage::Route | Stage::Neighbours | Stage::Planning => 0,
                Stage::Synthesis => 1,
                Stage::Coupling => 2,
            };
            spent[index] += now - last;
            last = now;
        });
        self.steps_left = self.steps_left.saturating_sub(1);
    }

    /// Share of bodies in semi-procedural locomotion, 0 to 1.
    pub(crate) fn deformed_share(&self) -> f32 {
        let frames = self.simulation.frames();
        frames.iter().filter(|frame| frame.mode == Mode::SemiProcedural).count() as f32 / frames.len() as f32
    }
}
