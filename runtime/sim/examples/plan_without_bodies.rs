//! Plans a crowd of discs without bodies, and so without a motion database: 17 agents cross a circle with a pillar in
//! it.
//!
//! ```text
//! cargo run --release -p fbcrowd-sim --example plan_without_bodies
//! ```
//!
//! The loop is what [`fbcrowd_sim::Simulation`] does with `coupling = "discs"`: preferred velocities, neighbours,
//! plans, and discs that move as planned. MCN needs the velocities that bodies can realise, which a database would
//! give; here they come from a list of gaits. World, metres, seconds.

use std::f32::consts::{PI, TAU};

use fbcrowd_sim::planning::mcn::MotionConstraints;
use fbcrowd_sim::planning::{CrowdPlanningMemory, Stance, plan_all, ranking_horizon_s};
use fbcrowd_sim::route::{Braking, CrowdRoutes, KeepSide, PathProgress, RouteMemory, RouteView, preferred_motion};
use fbcrowd_sim::scenario::WALL_RADIUS_M;
use fbcrowd_sim::world::neighbours::NeighbourSearch;
use fbcrowd_sim::world::obstacles::Obstacles;
use fbcrowd_sim::{AgentSpec, Params, Plan, Planner, Scenario, WorldView};
use glam::Vec2;
use motiondb::motion::Parameters;
use motiondb::velocity_sets::velocity_hull::{self, Construction};

const AGENTS: usize = 17;
const RADIUS_M: f32 = 0.25;
const PREFERRED_SPEED_MPS: f32 = 1.33;
const DT_S: f32 = 0.1;

/// Gaits of a body: speed, turn rate and side speed.
const GAITS: [[f32; 3]; 9] = [
    [0.0, 0.0, 0.0],
    [1.8, 0.0, 0.0],
    [1.0, 1.2, 0.0],
    [1.0, -1.2, 0.0],
    [0.3, 2.6, 0.0],
    [0.3, -2.6, 0.0],
    [0.0, 0.0, 0.6],
    [0.0, 0.0, -0.6],
    [-0.7, 0.0, 0.0],
];

fn main() {
    let (planner, params) = (Planner::Mcn, Params::default());
    let gaits =
        GAITS.map(|[speed_mps, turn_rate_rad_s, strafe_mps]| Parameters { speed_mps, turn_rate_rad_s, strafe_mps });
    let constraints = MotionConstraints::new(&velocity_hull::build(&gaits, Construction::default()));
    let pillar_m = vec![Vec2::new(-0.4, 0.0), Vec2::new(0.0, -0.4), Vec2::new(0.4, 0.0), Vec2::new(0.0, 0.4)];
    let obstacles = Obstacles::new(std::slice::from_ref(&pillar_m));
    let agents: Vec<AgentSpec> = (0..AGENTS).map(on_circle).collect();
    let routes = CrowdRoutes::new(&Scenario { obstacles_m: vec![pillar_m], ..Scenario::of(agents.clone()) })
        .expect("all coordinates are small");
    let view = RouteView {
        routes: &routes,
        doors: None,
        obstacles: &obstacles,
        keep: KeepSide::Right,
        braking: Braking::Within(DT_S),
        coasting_mps: Vec2::ZERO,
    };
    let mut positions_m: Vec<Vec2> = agents.iter().map(|agent| agent.position_m).collect();
    let mut velocities_mps = vec![Vec2::ZERO; AGENTS];
    let mut facings_rad: Vec<f32> = agents.iter().map(|agent| agent.facing_rad).collect();
    let mut progress = [PathProgress::default(); AGENTS];
    let mut remembered = vec![RouteMemory::default(); AGENTS];
    let mut plans = vec![Plan::default(); AGENTS];
    let (mut neighbours, mut memory) = (NeighbourSearch::default(), CrowdPlanningMemory::default());

    let mut time_s = 0.0;
    while time_s < 60.0 && !are_at_goals(&agents, &positions_m) {
        let preferred_mps: Vec<Vec2> = (0..AGENTS)
            .map(|agent| {
                let (progress, remembered) = (&mut progress[agent], &mut remembered[agent]);
                preferred_motion(&agents[agent], positions_m[agent], &view, progress, remembered).velocity_mps
            })
            .collect();
        neighbours.rebuild(&positions_m, &velocities_mps, &[RADIUS_M; AGENTS], ranking_horizon_s(planner, &params));
        let world = WorldView {
            positions_m: &positions_m,
            velocities_mps: &velocities_mps,
            facings_rad: &facings_rad,
            radii_m: &[RADIUS_M; AGENTS],
            wall_radii_m: &[WALL_RADIUS_M; AGENTS],
            preferred_mps: &preferred_mps,
            free_speeds_mps: &[PREFERRED_SPEED_MPS; AGENTS],
            facing_offsets_rad: &[0.0; AGENTS],
            stances: &[Stance::default(); AGENTS],
            planned_mps: &velocities_mps,
            strafing_s: &plans.iter().map(|plan| plan.strafing_s).collect::<Vec<f32>>(),
            stepping_back_s: &plans.iter().map(|plan| plan.stepping_back_s).collect::<Vec<f32>>(),
            neighbours: &neighbours,
            obstacles: &obstacles,
            own_walls: None,
            one_way: &[],
            priorities: None,
            constraints: &constraints,
            own_constraints: None,
            speed_factors: None,
            dt_s: DT_S,
            bodies: false,
        };
        plan_all(planner, &world, &params, &mut memory, &mut plans);
        for (agent, plan) in plans.iter().enumerate() {
            let planned_m = positions_m[agent] + DT_S * plan.velocity_mps;
            let moved_m = obstacles.clamp_path(positions_m[agent], planned_m, WALL_RADIUS_M);
            velocities_mps[agent] = (moved_m - positions_m[agent]) / DT_S;
            (positions_m[agent], facings_rad[agent]) = (moved_m, plan.facing_rad);
        }
        time_s += DT_S;
    }
    println!("{AGENTS} agents were at their goals after {time_s:.1} s");
    for (index, position_m) in positions_m.iter().enumerate() {
        println!("agent {index:2}: {position_m:.2} m, facing {:.2} rad", facings_rad[index]);
    }
}

/// An agent on a circle of 4 m, bound for the opposite point.
fn on_circle(index: usize) -> AgentSpec {
    let angle_rad = TAU * index as f32 / AGENTS as f32;
    let position_m = 4.0 * Vec2::from_angle(angle_rad);
    AgentSpec {
        position_m,
        facing_rad: angle_rad + PI,
        goals_m: vec![-position_m],
        radius_m: RADIUS_M,
        wall_radius_m: WALL_RADIUS_M,
        preferred_speed_mps: PREFERRED_SPEED_MPS,
        ..AgentSpec::default()
    }
}

fn are_at_goals(agents: &[AgentSpec], positions_m: &[Vec2]) -> bool {
    agents.iter().zip(positions_m).all(|(agent, position_m)| position_m.distance(agent.goals_m[0]) < 0.5)
}
