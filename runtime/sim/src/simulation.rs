//! One step of the simulation, in the order of the paper's Fig. 2 (`FbCrowd` §3).
//!
//! 1. route: the preferred velocity of each agent, v_pref;
//! 2. neighbours: the agents near each agent;
//! 3. planning (MCN, §4): v_pref becomes a velocity that satisfies the constraints of body, stance foot and crowd;
//! 4. synthesis (HMS, §5): the body follows its plan;
//! 5. coupling (CNS, §3.4): the disc takes the body's position; the step is recorded.
//!
//! Every plan is made from the world as the last step left it, and each body follows its own plan alone. So neither the
//! order of agents nor the number of threads changes a bit. The simulation reads no clock; an observer receives the end
//! of each stage.
//!
//! World frame; metres, seconds, radians.

use std::sync::Arc;

use motiondb::motion::MotionDb;
use rayon::prelude::*;

use crate::agents::Agents;
use crate::coupling::{body_to_disc, decoupled};
use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::plan_all::{self, plan_all};
use crate::planning::planner::ranking_horizon_s;
use crate::planning::world_view::WorldView;
use crate::recording::frame::AgentFrame;
use crate::route::crowd_routes::CrowdRoutes;
use crate::route::path::{self, Braking, RouteView};
use crate::scenario::Scenario;
use crate::scenario::coupling::Coupling;
use crate::synthesis::{HmsParams, SynthesisContext, TimeStep};
use crate::world::neighbours::NeighbourSearch;
use crate::world::obstacles::Obstacles;

/// Bodies that one thread takes at a time, at least: enough to outweigh the hand-over, few enough to share out 100.
const BODIES_PER_TASK_MIN: usize = 16;

/// Routes that one thread takes at a time, at least.
const ROUTES_PER_TASK_MIN: usize = 256;

/// Memory of an agent in the sorted grids of [`NeighbourSearch`], bytes: position, velocity, radius, rank and cells,
/// some of them twice.
const GRID_BYTES: usize = 64;

/// A stage of a step, for measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Preferred velocities.
    Route,
    /// The grid of agents.
    Neighbours,
    /// MCN: plans.
    Planning,
    /// HMS: bodies.
    Synthesis,
    /// CNS, and the recorded frame.
    Coupling,
}

/// A running simulation.
#[derive(Clone, Debug)]
pub struct Simulation {
    context: SynthesisContext,
    scenario: Scenario,
    obstacles: Obstacles,
    routes: CrowdRoutes,
    constraints: MotionConstraints,
    neighbours: NeighbourSearch,
    planning: plan_all::CrowdPlanningMemory,
    agents: Agents,
}

impl Simulation {
    /// At time 0: every agent stands at its start.
    pub fn new(db: Arc<MotionDb>, scenario: &Scenario) -> Self {
        let params = HmsParams { modes: scenario.modes(), ..scenario.params.synthesis.clone() };
        let context = SynthesisContext::new(db, params);
        let agents = Agents::new(scenario, &context);
        let mut simulation = Self {
            obstacles: Obstacles::new(&scenario.obstacles_m),
            // Coordinates are in range in every checked scenario; without a mesh, agents walk straight.
            routes: CrowdRoutes::new(&scenario.agents, &scenario.obstacles_m).unwrap_or_default(),
            constraints: MotionConstraints::new(&context.db.velocity_hull),
            neighbours: NeighbourSearch::default(),
            planning: plan_all::CrowdPlanningMemory::default(),
            scenario: scenario.clone(),
            agents,
            context,
        };
        simulation.record();
        simulation
    }

    /// The database that bodies move by: the given one, augmented where it lacks what a crowd needs.
    pub fn database(&self) -> &MotionDb {
        &self.context.db
    }

    /// The recorded frame of each agent at the present time.
    pub fn frames(&self) -> &[AgentFrame] {
        &self.agents.frames
    }

    /// Memory per agent, bytes: its elements in all arrays, its start and its waypoints.
    pub fn bytes_per_agent(&self) -> usize {
        let specs = &self.scenario.agents;
        let goals: usize = specs.iter().map(|agent| size_of_val(&*agent.goals_m)).sum();
        let held = self.agents.size_bytes() + self.planning.size_bytes() + size_of_val(&**specs) + goals;
        held / specs.len().max(1) + GRID_BYTES
    }

    /// Advances by the scenario's dt; `finished` receives each stage at its end.
    pub fn step(&mut self, finished: &mut dyn FnMut(Stage)) {
        self.follow_paths();
        finished(Stage::Route);
        let Agents { positions_m, velocities_mps, radii_m, .. } = &self.agents;
        let Scenario { planner, params, .. } = &self.scenario;
        self.neighbours.rebuild(positions_m, velocities_mps, radii_m, ranking_horizon_s(*planner, params));
        finished(Stage::Neighbours);
        self.plan();
        finished(Stage::Planning);
        self.synthesize();
        finished(Stage::Synthesis);
        body_to_disc::synchronize(&mut self.agents, &self.context, self.scenario.dt_s);
        self.record();
        finished(Stage::Coupling);
    }

    fn follow_paths(&mut self) {
        let braking = match self.scenario.coupling {
            Coupling::TwoWay | Coupling::Decoupled => Braking::Evenly,
            Coupling::Discs => Braking::Within(self.scenario.dt_s),
        };
        let view = RouteView { routes: &self.routes, obstacles: &self.obstacles, braking };
        let Agents { positions_m, progress, route_memory, preferred_mps, .. } = &mut self.agents;
        let remembered = progress.par_iter_mut().zip(route_memory).with_min_len(ROUTES_PER_TASK_MIN);
        let agents = self.scenario.agents.par_iter().zip(positions_m).zip(preferred_mps);
        agents.zip(remembered).for_each(|(((spec, position_m), preferred_mps), (progress, memory))| {
            *preferred_mps = path::preferred_mps(spec, *position_m, &view, progress, memory);
        });
    }

    /// The view of the world that planners read. The neighbours are those of the last step's beginning.
    pub fn world(&self) -> WorldView<'_> {
        let agents = &self.agents;
        WorldView {
            positions_m: &agents.positions_m,
            velocities_mps: &agents.velocities_mps,
            facings_rad: &agents.facings_rad,
            radii_m: &agents.radii_m,
            wall_radii_m: &agents.wall_radii_m,
            preferred_mps: &agents.preferred_mps,
            stances: &agents.stances,
            strafing_s: &agents.strafing_s,
            stepping_back_s: &agents.stepping_back_s,
            neighbours: &self.neighbours,
            obstacles: &self.obstacles,
            constraints: &self.constraints,
            dt_s: self.scenario.dt_s,
            bodies: self.scenario.coupling.plans_for_bodies(),
        }
    }

    fn plan(&mut self) {
        let mut plans = std::mem::take(&mut self.agents.plans);
        let mut planning = std::mem::take(&mut self.planning);
        let Scenario { planner, params, .. } = &self.scenario;
        plan_all(*planner, &self.world(), params, &mut planning, &mut plans);
        (self.agents.plans, self.planning) = (plans, planning);
    }

    fn synthesize(&mut self) {
        let (context, agents, obstacles) = (&self.context, &mut self.agents, &self.obstacles);
        let Scenario { coupling, dt_s, .. } = self.scenario;
        let time_step = TimeStep::new(dt_s);
        let bodies = agents.bodies.par_iter_mut().with_min_len(BODIES_PER_TASK_MIN);
        let bodies = bodies.zip(&mut agents.stances).zip(&mut agents.frames);
        bodies.zip(&agents.plans).zip(&agents.wall_radii_m).for_each(
            |((((body, stance), frame), plan), &wall_radius_m)| {
                let from = body.root;
                match coupling {
                    Coupling::TwoWay => body.advance(context, plan, &time_step),
                    Coupling::Discs | Coupling::Decoupled => body.root = body_to_disc::as_planned(from, plan, dt_s),
                }
                let kept = body_to_disc::outside_walls(from.position_m, body.root, wall_radius_m, obstacles);
                body.place_root(from.position_m, kept, dt_s);
                let output = match coupling {
                    Coupling::TwoWay => body.synthesize(context, &time_step),
                    Coupling::Decoupled => decoupled::follow(body, context, from, dt_s),
                    Coupling::Discs => return,
                };
                *stance = output.stance;
                frame.show(&output);
            },
        );
    }

    fn record(&mut self) {
        let agents = &mut self.agents;
        for (index, frame) in agents.frames.iter_mut().enumerate() {
            let (body, plan) = (&agents.bodies[index], &agents.plans[index]);
            *frame = AgentFrame {
                root: body.root,
                preferred_mps: agents.preferred_mps[index],
                planned_mps: plan.velocity_mps,
                phase: body.motion.phase,
                mode: body.motion.mode,
                set: plan.set,
                strafing_s: plan.strafing_s,
                stepping_back_s: plan.stepping_back_s,
                ..*frame
            };
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use glam::Vec2;

    use super::*;
    use crate::maths::angle::wrap_rad;
    use crate::planning::planner::Planner;
    use crate::scenario::AgentSpec;
    use crate::synthesis::Mode;
    use crate::synthesis::blending::BlendDomain;
    use crate::test_db::test_db;

    /// Agents on a circle; the goal of each is the opposite point.
    pub(crate) fn antipodal(count: usize, radius_m: f32) -> Scenario {
        let agent = |index: usize| {
            let angle_rad = std::f32::consts::TAU * index as f32 / count as f32;
            let position_m = Vec2::from_angle(angle_rad) * radius_m;
            AgentSpec {
                position_m,
                facing_rad: angle_rad + std::f32::consts::PI,
                goals_m: vec![-position_m],
                radius_m: 0.25,
                wall_radius_m: 0.2,
                preferred_speed_mps: 1.3,
            }
        };
        Scenario { name: "antipodal".into(), duration_s: 30.0, ..Scenario::of((0..count).map(agent).collect()) }
    }

    fn simulated(scenario: &Scenario, steps: usize) -> Vec<AgentFrame> {
        let mut simulation = Simulation::new(Arc::new(test_db()), scenario);
        (0..steps).for_each(|_| simulation.step(&mut |_| {}));
        simulation.frames().to_vec()
    }

    #[test]
    fn one_and_two_threads_give_equal_bits() {
        let mut scenario = antipodal(100, 14.0);
        scenario.obstacles_m = vec![[(-3.0, -0.5), (3.0, -0.5), (3.0, 0.5), (-3.0, 0.5)].map(Vec2::from).to_vec()];
        let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let both = [pool(1), pool(2)];
        let mut simulations = [0, 1].map(|_| Simulation::new(Arc::new(test_db()), &scenario));
        for step in 0..300 {
            for (simulation, pool) in simulations.iter_mut().zip(&both) {
                pool.install(|| simulation.step(&mut |_| {}));
            }
            assert!(simulations[0].frames() == simulations[1].frames(), "step {step}");
        }
    }

    #[test]
    fn all_agents_cross_the_circle_and_stand() {
        let scenario = antipodal(17, 8.0);
        let frames = simulated(&scenario, 900);
        for (frame, agent) in frames.iter().zip(&scenario.agents) {
            let off_m = frame.root.position_m.distance(agent.goals_m[0]);
            assert!(off_m < 0.5, "{off_m} m");
            assert_eq!(frame.contacts, [1.0; 2]);
        }
    }

    #[test]
    fn bodies_start_with_every_planner_and_step() {
        for planner in [Planner::Mcn, Planner::Orca, Planner::SocialForce] {
            for dt_s in [1.0 / 120.0, 1.0 / 60.0, 0.1] {
                let scenario = Scenario { planner, dt_s, ..antipodal(1, 4.0) };
                let [frame] = simulated(&scenario, (2.0 / dt_s) as usize)[..] else { unreachable!() };
                let walked_m = frame.root.position_m.distance(scenario.agents[0].position_m);
                assert!(walked_m > 1.0, "{planner:?} in steps of {dt_s} s: {walked_m} m");
            }
        }
    }

    #[test]
    fn no_root_enters_a_wall() {
        let mut scenario = antipodal(1, 4.0);
        let wall = [(-0.5, -6.0), (0.5, -6.0), (0.5, 6.0), (-0.5, 6.0)];
        scenario.obstacles_m = vec![wall.map(Vec2::from).to_vec()];
        let mut simulation = Simulation::new(Arc::new(test_db()), &scenario);
        for _ in 0..300 {
            simulation.step(&mut |_| {});
            assert!(simulation.frames()[0].root.position_m.x >= 0.5 + 0.2);
        }
    }

    #[test]
    fn discs_move_as_planned_outside_walls() {
        let mut scenario = antipodal(6, 4.0);
        scenario.coupling = Coupling::Discs;
        scenario.obstacles_m = vec![[(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(Vec2::from).to_vec()];
        let mut simulation = Simulation::new(Arc::new(test_db()), &scenario);
        for _ in 0..300 {
            let before = simulation.frames().to_vec();
            simulation.step(&mut |_| {});
            for (before, after) in before.iter().zip(simulation.frames()) {
                let planned_m = before.root.position_m + scenario.dt_s * after.planned_mps;
                let position_m = after.root.position_m;
                let is_near = planned_m.abs().max_element() < 0.8;
                assert!(is_near || position_m == planned_m, "{position_m} instead of {planned_m}");
                let depth_m = simulation.obstacles.depth_m(position_m, 0.2);
                assert!(depth_m == 0.0, "{position_m} lies {depth_m} m in the wall");
            }
        }
    }

    #[test]
    fn decoupled_bodies_follow_their_discs_exactly() {
        let mut scenario = antipodal(17, 4.0);
        (scenario.planner, scenario.coupling) = (Planner::Orca, Coupling::Decoupled);
        let db = test_db();
        let turn_max_rad = BlendDomain::new(&db).turn_rate_max_rad_s * scenario.dt_s;
        let mut simulation = Simulation::new(Arc::new(db), &scenario);
        for _ in 0..300 {
            let before = simulation.frames().to_vec();
            simulation.step(&mut |_| {});
            for (before, after) in before.iter().zip(simulation.frames()) {
                assert_eq!(after.root.position_m, before.root.position_m + scenario.dt_s * after.planned_mps);
                let turned_rad = wrap_rad(after.root.facing_rad - before.root.facing_rad);
                assert!(turned_rad.abs() <= 1.001 * turn_max_rad && after.mode == Mode::Blending);
            }
        }
    }

    #[test]
    fn stages_end_in_the_order_of_the_paper() {
        let mut stages = Vec::new();
        Simulation::new(Arc::new(test_db()), &antipodal(2, 3.0)).step(&mut |stage| stages.push(stage));
        assert_eq!(stages, [Stage::Route, Stage::Neighbours, Stage::Planning, Stage::Synthesis, Stage::Coupling]);
    }
}
