//! Scenes that are timed (`fbcrowd bench figure6`): antipodal circles, and crowds that meet from all sides.
//!
//! World, metres, seconds.

use std::f32::consts::TAU;
use std::sync::Arc;
use std::time::{Duration, Instant};

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use fbcrowd_sim::simulation::{Simulation, Stage};
use fbcrowd_sim::synthesis::Mode;
use glam::Vec2;
use motiondb::motion::MotionDb;

use crate::cmd::bench::figure6::TURNS;
use crate::cmd::bench::plan::{agent, disc};

/// Those of `assets/scenarios/table1`: places along the circle, their jitter, the least radius.
const SPACING_M: f32 = 1.5;
const JITTER: f64 = 0.1;
const RADIUS_MIN_M: f32 = 4.0;
/// A film's step.
const DT_S: f32 = 1.0 / 30.0;
/// Steps until all walk; a crowd is to have met too, as in `bench plan`.
const WARM_UP: usize = 30;
const CROWD_WARM_UP: usize = 90;
/// A circle of up to so many is followed over its whole crossing, of 36 s; larger ones would take minutes each.
const CROSSED: usize = 100;

/// A simulation that is timed in turns.
pub(super) struct Scene {
    db: Arc<MotionDb>,
    pub(super) scenario: Scenario,
    warm_up: usize,
    /// Steps between two turns.
    pub(super) between: usize,
    pub(super) simulation: Simulation,
    /// Until all are across.
    pub(super) left: usize,
}

impl Scene {
    /// An antipodal circle.
    pub(super) fn circle(db: &Arc<MotionDb>, agents: usize) -> Self {
        let radius_m = (agents as f32 * SPACING_M / TAU).max(RADIUS_MIN_M);
        let mut random = SplitMix64::new(1, agents as u64);
        let mut place = |index: usize| {
            let angle_rad = TAU * index as f32 / agents as f32 + random.within(JITTER) as f32 * SPACING_M / radius_m;
            agent(radius_m * Vec2::from_angle(angle_rad))
        };
        let places: Vec<AgentSpec> = (0..agents).map(&mut place).collect();
        let circle = Self::new(db, Scenario::of(places), WARM_UP);
        Self { between: if agents <= CROSSED { circle.left / TURNS } else { 0 }, ..circle }
    }

    /// A disc of people, each bound for the place of another: neighbours go every way, and meet at once.
    pub(super) fn crowd(db: &Arc<MotionDb>, agents: usize) -> Self {
        let mut scenario = disc(agents);
        let mut random = SplitMix64::new(1, agents as u64);
        let places_m = scenario.agents.iter().map(|agent| (random.within(1.0), agent.position_m));
        let mut drawn_m: Vec<(f64, Vec2)> = places_m.collect();
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
        let mut scene = Self { db: Arc::clone(db), scenario, warm_up, between: 0, simulation, left: 0 };
        scene.begin();
        scene
    }

    /// At the start, or anew; until all walk.
    pub(super) fn begin(&mut self) {
        let way_s = |agent: &AgentSpec| agent.position_m.distance(agent.goals_m[0]) / agent.preferred_speed_mps;
        let longest_s = self.scenario.agents.iter().map(way_s).fold(0.0, f32::max);
        self.simulation = Simulation::new(Arc::clone(&self.db), &self.scenario);
        self.left = (longest_s / DT_S) as usize;
        self.skip(self.warm_up);
    }

    /// Steps that are not timed.
    pub(super) fn skip(&mut self, steps: usize) {
        (0..steps).for_each(|_| self.simulation.step(&mut |_| ()));
        self.left = self.left.saturating_sub(steps);
    }

    /// One step; adds the time of planning, synthesis and coupling.
    pub(super) fn frame(&mut self, spent: &mut [Duration; 3]) {
        let mut last = Instant::now();
        self.simulation.step(&mut |stage| {
            let now = Instant::now();
            let index = match stage {
                Stage::Path | Stage::Neighbours | Stage::Planning => 0,
                Stage::Synthesis => 1,
                Stage::Coupling => 2,
            };
            spent[index] += now - last;
            last = now;
        });
        self.left = self.left.saturating_sub(1);
    }

    /// How many bodies semi-procedural locomotion moves now.
    pub(super) fn deformed_share(&self) -> f32 {
        let frames = self.simulation.frames();
        frames.iter().filter(|frame| frame.mode == Mode::SemiProcedural).count() as f32 / frames.len() as f32
    }
}
