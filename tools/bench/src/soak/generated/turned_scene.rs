//! Random scenes that are turned and moved: plans must not depend on position and direction of a scene.
//!
//! Ordinary states: a few agents close together, walls beside them, on one foot or two, side-stepping or not. Each
//! scene is turned and moved by random amounts. The velocity that MCN or ORCA plans must turn with it, to within 1e−4
//! m/s, or to within what the plan changes where its agent is moved by 1 µm, the rounding of a position that was turned
//! and moved: 25 of a million scenes are so near to where a plan changes. Social forces are left out: with them that is
//! ten times as frequent, since their law grows without bound towards a graze and is 0 beyond it. World, metres, seconds.

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::mcn::MotionConstraints;
use fbcrowd_sim::planning::{Plan, Planner, PlannerMemory, Stance, StanceFoot, WorldView, plan, ranking_horizon_s};
use fbcrowd_sim::world::neighbours::NeighbourSearch;
use fbcrowd_sim::world::obstacles::Obstacles;
use glam::Vec2;
use motiondb::velocity_sets::velocity_hull::VelocityHull;

/// Number of agents; the first one plans.
const AGENTS: usize = 8;
/// Half the side of the square in which they walk, m.
const SQUARE_M: f64 = 3.0;
/// Speed that all agents prefer on a free path, m/s.
const FREE_SPEED_MPS: f32 = 1.3;
/// Greatest displacement of a scene along each axis, m.
const MOVED_M: f64 = 5.0;
/// Greatest difference of the turned velocity, m/s.
const SLACK_MPS: f32 = 1e-4;
/// Rounding of a position that was turned and moved, m.
const ROUNDING_M: f32 = 1e-6;

/// A scene, as it is or turned and moved.
#[derive(Clone, Debug)]
struct Scene {
    positions_m: Vec<Vec2>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    preferred_mps: Vec<Vec2>,
    facing_offsets_rad: Vec<f32>,
    stances: Vec<Stance>,
    /// Durations of side-stepping and of stepping back, s.
    held_s: [Vec<f32>; 2],
    polygons_m: Vec<Vec<Vec2>>,
}

/// The fault of the plans in a random scene; none where nothing is wrong.
pub fn fault(hull: &VelocityHull, seed: u64, stream: u64) -> Option<&'static str> {
    let mut random = SplitMix64::new(seed, stream);
    let scene = Scene::random(&mut random);
    let turn_rad = random.within(std::f64::consts::PI) as f32;
    let turned = scene.turned(turn_rad, vector(&mut random, MOVED_M));
    let differs = |planner: &Planner| {
        let [here_mps, there_mps] = [&scene, &turned].map(|scene| scene.planned(*planner, hull).velocity_mps);
        let off_mps = Vec2::from_angle(turn_rad).rotate(here_mps).distance(there_mps);
        off_mps > SLACK_MPS && off_mps > scene.change_mps(*planner, hull)
    };
    [Planner::Mcn, Planner::Orca].iter().any(differs).then_some("is planned differently when it is turned")
}

fn vector(random: &mut SplitMix64, range: f64) -> Vec2 {
    Vec2::new(random.within(range) as f32, random.within(range) as f32)
}

impl Scene {
    fn random(random: &mut SplitMix64) -> Self {
        let mut each = |range: f64| -> Vec<Vec2> { (0..AGENTS).map(|_| vector(random, range)).collect() };
        let (positions_m, velocities_mps, preferred_mps) = (each(SQUARE_M), each(1.2), each(1.2));
        let held_s = [each(1.0), each(1.0)].map(|held| held.iter().map(|held_s| held_s.x.max(0.0)).collect());
        let [facings_rad, facing_offsets_rad] =
            [std::f64::consts::PI, 2.0].map(|range| each(range).iter().map(|angle| angle.x).collect());
        let stances = (0..AGENTS).map(|_| stance(random)).collect();
        let polygons_m = (0..2).map(|_| block_m(vector(random, SQUARE_M), vector(random, 1.0))).collect();
        Self {
            positions_m,
            velocities_mps,
            facings_rad,
            preferred_mps,
            facing_offsets_rad,
            stances,
            held_s,
            polygons_m,
        }
    }

    fn turned(&self, turn_rad: f32, moved_m: Vec2) -> Self {
        let turn = Vec2::from_angle(turn_rad);
        let turned = |vectors: &[Vec2]| vectors.iter().map(|vector| turn.rotate(*vector)).collect::<Vec<Vec2>>();
        let moved =
            |points_m: &[Vec2]| turned(points_m).iter().map(|point_m| *point_m + moved_m).collect::<Vec<Vec2>>();
        Self {
            positions_m: moved(&self.positions_m),
            velocities_mps: turned(&self.velocities_mps),
            facings_rad: self.facings_rad.iter().map(|facing_rad| facing_rad + turn_rad).collect(),
            preferred_mps: turned(&self.preferred_mps),
            facing_offsets_rad: self.facing_offsets_rad.clone(),
            stances: self.stances.iter().map(|stance| turned_stance(stance, turn)).collect(),
            held_s: self.held_s.clone(),
            polygons_m: self.polygons_m.iter().map(|polygon_m| moved(polygon_m)).collect(),
        }
    }

    /// Greatest change of the first agent's plan where it is moved by the rounding, m/s.
    fn change_mps(&self, planner: Planner, hull: &VelocityHull) -> f32 {
        let planned_mps = |moved_m: Vec2| {
            let mut scene = self.clone();
            scene.positions_m[0] += moved_m;
            scene.planned(planner, hull).velocity_mps
        };
        let here_mps = planned_mps(Vec2::ZERO);
        let towards = [Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y];
        towards.map(|towards| planned_mps(ROUNDING_M * towards).distance(here_mps)).into_iter().fold(0.0, f32::max)
    }

    /// The plan of the first agent.
    fn planned(&self, planner: Planner, hull: &VelocityHull) -> Plan {
        let (radii_m, obstacles) = (vec![0.25; AGENTS], Obstacles::new(&self.polygons_m));
        let (params, mut neighbours) = (Params::default(), NeighbourSearch::default());
        neighbours.rebuild(&self.positions_m, &self.velocities_mps, &radii_m, ranking_horizon_s(planner, &params));
        let constraints = MotionConstraints::new(hull);
        let world = WorldView {
            positions_m: &self.positions_m,
            velocities_mps: &self.velocities_mps,
            facings_rad: &self.facings_rad,
            radii_m: &radii_m,
            wall_radii_m: &radii_m,
            preferred_mps: &self.preferred_mps,
            free_speeds_mps: &vec![FREE_SPEED_MPS; self.preferred_mps.len()],
            facing_offsets_rad: &self.facing_offsets_rad,
            stances: &self.stances,
            planned_mps: &self.velocities_mps,
            strafing_s: &self.held_s[0],
            stepping_back_s: &self.held_s[1],
            neighbours: &neighbours,
            obstacles: &obstacles,
            own_walls: None,
            one_way: &[],
            priorities: None,
            constraints: &constraints,
            own_constraints: None,
            speed_factors: None,
            dt_s: 0.1,
            bodies: true,
        };
        plan(planner, &world, 0, &params, &mut PlannerMemory::default())
    }
}

/// A stance on one foot every other time.
fn stance(random: &mut SplitMix64) -> Stance {
    let mut point_m = || vector(random, 0.3);
    let [heel_m, ball_m, toe_m, swing_m] = [point_m(), point_m(), point_m(), point_m()];
    let (side, time_to_landing_s) = ((random.next_u64() % 2) as usize, 0.1 + random.within(0.3).abs() as f32);
    let foot = StanceFoot { side, heel_m, ball_m, toe_m, swing_m, time_to_landing_s };
    Stance { foot: random.next_u64().is_multiple_of(2).then_some(foot) }
}

fn turned_stance(stance: &Stance, turn: Vec2) -> Stance {
    let turned = |foot: StanceFoot| StanceFoot {
        heel_m: turn.rotate(foot.heel_m),
        ball_m: turn.rotate(foot.ball_m),
        toe_m: turn.rotate(foot.toe_m),
        swing_m: turn.rotate(foot.swing_m),
        ..foot
    };
    Stance { foot: stance.foot.map(turned) }
}

/// A block of 1 m by 0.4 m about a point, along a direction.
fn block_m(centre_m: Vec2, along: Vec2) -> Vec<Vec2> {
    let along = along.normalize_or(Vec2::X);
    [(-0.5, -0.2), (0.5, -0.2), (0.5, 0.2), (-0.5, 0.2)].map(|corner| centre_m + along.rotate(corner.into())).to_vec()
}
