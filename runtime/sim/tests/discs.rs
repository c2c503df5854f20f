//! Claims about the planners on discs without bodies: arrivals, overlaps, accelerations.
//!
//! Scenes and protocol of `assets/scenarios/table1`, and encounters of identical agents, which could deadlock. A lag
//! and a turn rate stand in for the body.

#[path = "discs/crowd.rs"]
mod crowd;

use std::f32::consts::TAU;

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::world::obstacles::Obstacles;
use glam::Vec2;
use motiondb::velocity_sets::velocity_hull::{Construction, VelocityHull};

use crate::crowd::{CrowdFigures, CrowdSetting, DiscCrowd, DiscResponse, RADIUS_M, bundled_scene};

const DT_S: f32 = 1.0 / 30.0;
/// Response of a body: a third of a second to a new velocity, a right angle in three quarters of a second.
const LIKE_A_BODY: DiscResponse = DiscResponse::Lagging(0.3, 2.0);

/// Velocity sets of a modest set of clips.
fn hull() -> VelocityHull {
    let corners = |corners: &[[f32; 2]]| corners.iter().copied().map(Vec2::from).collect::<Vec<Vec2>>();
    let left = corners(&[[-0.1, 0.1], [0.0, 0.7]]);
    let right = corners(&[[0.0, -0.7], [-0.1, -0.1]]);
    VelocityHull {
        construction: Construction::default(),
        turning_mps: corners(&[
            [1.9, 0.0],
            [1.2, -1.0],
            [0.0, -0.7],
            [-0.4, -0.1],
            [-0.4, 0.1],
            [0.0, 0.7],
            [1.2, 1.0],
        ]),
        holding_mps: corners(&[[1.9, 0.0], [0.0, -0.8], [-0.8, 0.0], [0.0, 0.8]]),
        sharp_turn_edges_mps: vec![[left[0], left[1]], [right[0], right[1]]],
    }
}

/// Walls, and the door through which all agents walk.
#[derive(Default)]
struct Building {
    walls: Obstacles,
    door_m: Option<Vec2>,
}

/// MCN at a step of 1/30 s.
fn setting<'a>(params: &'a Params, hull: &'a VelocityHull, walls: &'a Obstacles) -> CrowdSetting<'a> {
    CrowdSetting { planner: Planner::Mcn, params, hull, walls, response: LIKE_A_BODY, dt_s: DT_S }
}

/// A run of MCN with its default tunables.
fn simulate(agents: &[(Vec2, Vec2)], building: &Building, duration_s: f32) -> CrowdFigures {
    let (params, hull) = (Params::default(), hull());
    DiscCrowd::new(agents, building.door_m).run(&setting(&params, &hull, &building.walls), duration_s)
}

/// Duration of a checked run, s.
const CHECKED_S: f32 = 60.0;

/// Checks that all agents arrive, none stalls, and discs overlap on average by at most `collisions` (Eq. 17).
fn check(name: &str, agents: &[(Vec2, Vec2)], building: &Building, collisions: f32) -> CrowdFigures {
    let figures = simulate(agents, building, CHECKED_S);
    assert_eq!(figures.arrived, agents.len(), "{name}: not all arrive");
    assert_eq!(figures.stalled, 0, "{name}: some stall");
    // A run ends when all are at their goals. C is that of the whole duration, as if they stood there.
    let of_duration = figures.collisions * figures.trails_m.len() as f32 * DT_S / CHECKED_S;
    assert!(of_duration <= collisions, "{name}: C = {of_duration}");
    figures
}

fn check_scenes(names: &[&str], collisions: f32) {
    for name in names {
        check(name, &bundled_scene(name), &Building::default(), collisions);
    }
}

fn antipodal(count: usize, radius_m: f32) -> Vec<(Vec2, Vec2)> {
    let start_m = |index: usize| {
        let (sin, cos) = libm::sincosf(TAU * index as f32 / count as f32);
        radius_m * Vec2::new(cos, sin)
    };
    (0..count).map(|index| (start_m(index), -start_m(index))).collect()
}

fn rectangle(least: [f32; 2], most: [f32; 2]) -> Vec<Vec2> {
    [[least[0], least[1]], [most[0], least[1]], [most[0], most[1]], [least[0], most[1]]].map(Vec2::from).to_vec()
}

#[test]
fn all_agents_cross_the_antipodal_circle() {
    check_scenes(&["circle_17", "table1/circle_17_s1", "table1/circle_17_s2"], 0.001);
}

#[test]
fn all_agents_cross_in_two_and_four_directions() {
    check_scenes(&["table1/cross2_30_s1", "table1/bidir_53_s1", "table1/bidir_53_s2", "table1/cross4_100_s1"], 0.003);
}

#[test]
fn symmetric_encounters_resolve() {
    let none = Building::default();
    check("two head-on", &antipodal(2, 4.0), &none, 0.0);
    check("four in a cross", &antipodal(4, 4.0), &none, 0.001);
    check("a circle of 17", &antipodal(17, 4.06), &none, 0.001);
}

#[test]
fn agent_facing_away_turns_and_arrives() {
    let (params, walls) = (Params::default(), Obstacles::default());
    let forward_only = VelocityHull {
        construction: Construction::default(),
        turning_mps: vec![Vec2::ZERO, Vec2::new(1.6, 0.0)],
        holding_mps: vec![Vec2::ZERO, Vec2::new(1.6, 0.0)],
        sharp_turn_edges_mps: Vec::new(),
    };
    for hull in [hull(), forward_only] {
        let mut crowd = DiscCrowd::new(&[(Vec2::ZERO, Vec2::new(6.0, 0.0))], None).turned_about();
        let figures = crowd.run(&setting(&params, &hull, &walls), 20.0);
        assert_eq!((figures.arrived, figures.stalled), (1, 0));
    }
}

#[test]
fn opposing_walkers_pass_on_the_right() {
    let figures = simulate(&antipodal(2, 4.0), &Building::default(), 60.0);
    let lowest_m = figures.trails_m.iter().map(|step| step[1].y).fold(0.0, f32::max);
    let highest_m = figures.trails_m.iter().map(|step| step[0].y).fold(0.0, f32::max);
    // Agent 0 walks towards −x, so its right is +y.
    assert!(highest_m > 0.1 && lowest_m < 0.1, "{highest_m} {lowest_m}");
}

/// Start of an agent in a column three abreast at x < 0.
fn in_column(index: usize) -> Vec2 {
    Vec2::new(-4.0 - 1.2 * (index / 3) as f32, 0.8 * (index % 3) as f32 - 0.8)
}

fn check_walls(name: &str, agents: &[(Vec2, Vec2)], building: &Building) {
    let figures = check(name, agents, building, 0.01);
    check_outside(name, &figures, &building.walls);
}

fn check_outside(name: &str, figures: &CrowdFigures, walls: &Obstacles) {
    for position_m in figures.trails_m.iter().flatten() {
        let depth_m = walls.depth_m(*position_m, RADIUS_M);
        assert!(depth_m < 0.05, "{name}: {position_m} lies {depth_m} m in a wall");
    }
}

#[test]
fn two_agents_pass_head_on_in_a_narrow_corridor() {
    let walls = Obstacles::new(&[rectangle([-6.0, 0.6], [6.0, 1.0]), rectangle([-6.0, -1.0], [6.0, -0.6])]);
    check_walls("corridor of 1.2 m", &antipodal(2, 4.0), &Building { walls, door_m: None });
}

/// Checks that plans alone keep immediate discs, in steps of 0.1 s, out of a wall that hides their goals.
fn check_kept_before(name: &str, wall_m: Vec<Vec2>, agents: &[(Vec2, Vec2)]) {
    let (params, hull, walls) = (Params::default(), hull(), Obstacles::new(&[wall_m]));
    let setting = CrowdSetting { response: DiscResponse::Immediate, dt_s: 0.1, ..setting(&params, &hull, &walls) };
    let figures = DiscCrowd::new(agents, None).run(&setting, 15.0);
    check_outside(name, &figures, &walls);
    assert!(figures.trails_m.iter().flatten().all(|position_m| position_m.x < 0.0), "{name}: an agent passes the wall");
}

#[test]
fn plans_avoid_thin_walls_and_corners() {
    let abreast = [-0.6, 0.0, 0.6].map(|y| (Vec2::new(-3.0, y), Vec2::new(3.0, y)));
    check_kept_before("thin wall", rectangle([0.0, -8.0], [0.02, 8.0]), &abreast);
    let corner = [[-6.0, 0.0], [0.0, 0.0], [0.0, -6.0], [0.5, -6.0], [0.5, 0.5], [-6.0, 0.5]].map(Vec2::from).to_vec();
    let into_it = [[-3.0, -3.0], [-2.2, -3.0], [-3.0, -2.2]].map(|from| (Vec2::from(from), Vec2::new(3.0, 3.0)));
    check_kept_before("concave corner", corner, &into_it);
}

#[test]
fn opposed_columns_pass_a_corridor_outside_its_walls() {
    let walls = Obstacles::new(&[rectangle([-12.0, 1.5], [12.0, 2.0]), rectangle([-12.0, -2.0], [12.0, -1.5])]);
    let across = Vec2::new(-1.0, 1.0);
    let there = (0..9).map(|index| (in_column(index), in_column(index) * across));
    let back = (0..9).map(|index| (in_column(index) * across, in_column(index)));
    check_walls("corridor", &there.chain(back).collect::<Vec<_>>(), &Building { walls, door_m: None });
}

#[test]
fn a_column_passes_a_door_outside_its_walls() {
    let walls = Obstacles::new(&[rectangle([-0.2, 0.5], [0.2, 6.0]), rectangle([-0.2, -6.0], [0.2, -0.5])]);
    let agents: Vec<_> = (0..15).map(|index| (in_column(index), in_column(index) + Vec2::new(14.0, 0.0))).collect();
    check_walls("door", &agents, &Building { walls, door_m: Some(Vec2::new(0.3, 0.0)) });
}

/// C, A and the standard deviation of A over the five seeds of a scene, of discs that move as planned.
fn baseline_figures(scene: &str, planner: Planner, params: &Params) -> [f32; 3] {
    let (hull, walls) = (hull(), Obstacles::default());
    let response = DiscResponse::Immediate;
    let setting = CrowdSetting { planner, params, hull: &hull, walls: &walls, response, dt_s: 0.1 };
    let agents = |seed: u32| bundled_scene(&format!("table1/{scene}_s{seed}"));
    let runs: Vec<CrowdFigures> = (1..=5).map(|seed| DiscCrowd::new(&agents(seed), None).run(&setting, 60.0)).collect();
    let mean = |value: &dyn Fn(&CrowdFigures) -> f32| runs.iter().map(value).sum::<f32>() / runs.len() as f32;
    let acceleration_mps2 = mean(&|figures| figures.acceleration_mps2);
    let deviation_mps2 = |figures: &CrowdFigures| figures.acceleration_mps2 - acceleration_mps2;
    let variance = mean(&|figures| deviation_mps2(figures) * deviation_mps2(figures));
    let collisions = mean(&|figures| figures.collisions);
    [collisions, acceleration_mps2, variance.sqrt()]
}

fn check_baseline(planner: Planner, expected: [(&str, [f32; 2], [f32; 2]); 3]) {
    for (scene, collisions, acceleration_mps2) in expected {
        let [found_collisions, found_mps2, found_spread_mps2] = baseline_figures(scene, planner, &Params::default());
        assert!((found_collisions - collisions[0]).abs() <= collisions[1], "{scene}: C = {found_collisions}");
        // Both are means over five chaotic runs.
        let spread_mps2 = acceleration_mps2[1] + found_spread_mps2;
        assert!((found_mps2 - acceleration_mps2[0]).abs() <= spread_mps2, "{scene}: A = {found_mps2}");
    }
}

// Mean and spread over seeds of RVO2 itself under this protocol, as in `fbcrowd bench table1 --discs`; C has four
// digits.
#[test]
fn orca_gives_the_figures_of_rvo2() {
    check_baseline(
        Planner::Orca,
        [
            ("cross2_30", [0.0, 5e-5], [0.31, 0.13]),
            ("bidir_53", [0.0, 5e-5], [0.35, 0.10]),
            ("cross4_100", [0.0005, 0.0002], [0.36, 0.04]),
        ],
    );
}

#[test]
fn social_forces_give_the_figures_of_the_authors_law() {
    check_baseline(
        Planner::SocialForce,
        [
            ("cross2_30", [0.0004, 0.0004], [1.75, 0.16]),
            ("bidir_53", [0.0015, 0.0011], [3.25, 0.31]),
            ("cross4_100", [0.0041, 0.0010], [4.16, 0.27]),
        ],
    );
}

/// A thousand agents on a jittered lattice of 0.3 agents/m² in a disc, each bound for the opposite point.
fn lattice_disc() -> Vec<(Vec2, Vec2)> {
    let (spacing_m, mut random) = (0.3_f32.sqrt().recip(), SplitMix64::new(1, 0));
    let on_axis_m = |index: i32| spacing_m * (index as f32 + 0.5);
    let lattice = (-20..20).flat_map(|x| (-20..20).map(move |y| Vec2::new(on_axis_m(x), on_axis_m(y))));
    let mut starts_m: Vec<Vec2> = lattice.collect();
    starts_m.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let mut jitter_m = || spacing_m * random.within(0.2) as f32;
    let starts_m = starts_m.into_iter().take(1000).map(|start_m| start_m + Vec2::new(jitter_m(), jitter_m()));
    starts_m.map(|start_m| (start_m, -start_m)).collect()
}

#[test]
fn a_thousand_agents_in_a_disc_keep_walking() {
    let agents = lattice_disc();
    let figures = simulate(&agents, &Building::default(), 15.0);
    let advanced_m = |index: usize| {
        let last_m = figures.trails_m[figures.trails_m.len() - 1][index];
        agents[index].0.distance(agents[index].1) - last_m.distance(agents[index].1)
    };
    let mean_m = (0..agents.len()).map(advanced_m).sum::<f32>() / agents.len() as f32;
    assert!(figures.collisions < 0.042 && mean_m > 14.0, "C = {}, {mean_m} m", figures.collisions);
}
