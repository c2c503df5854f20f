//! Plans do not depend on where a scene lies or how it is turned: for tests and `bench soak`.
//!
//! Everyday states, drawn at random: a few walkers close together, walls beside them, on one foot or two, side-stepping
//! or not. The scene is turned and moved by random amounts; the velocity that MCN or ORCA plans must turn with it, to
//! within 1e−4 m/s. Of a million scenes 25 are further off, all but one by less than 1e−3: each of them, unturned, is
//! planned still more differently where its agent is moved by 1 µm, the rounding of a place that was turned and moved.
//! Of social forces, which are not judged, that holds ten times as often: their law grows without bound towards a graze
//! and is 0 beyond it. World, metres, seconds.

use glam::Vec2;
use motiondb::velocity_sets::velocity_hull::VelocityHull;

use crate::maths::random::SplitMix64;
use crate::params::Params;
use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::plan::{Plan, Stance, StanceFoot};
use crate::planning::planner::{Planner, PlannerMemory, plan, ranking_horizon_s};
use crate::planning::world_view::WorldView;
use crate::world::neighbours::NeighbourSearch;
use crate::world::obstacles::Obstacles;

/// Agents of a scene, the planning one first.
const AGENTS: usize = 8;
/// Half the side of the square in which they walk, m.
const PLACE_M: f64 = 3.0;
/// How far the scene is moved, m.
const MOVED_M: f64 = 5.0;
/// How far off the turned velocity may be, m/s.
const SLACK_MPS: f32 = 1e-4;

/// A scene, or the same turned and moved.
#[derive(Clone, Debug)]
struct Scene {
    positions_m: Vec<Vec2>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    preferred_mps: Vec<Vec2>,
    stances: Vec<Stance>,
    held_s: [Vec<f32>; 2],
    polygons_m: Vec<Vec<Vec2>>,
}

/// What is wrong with the plans of the seed's scene; none where all is well.
pub fn fault(hull: &VelocityHull, seed: u64, stream: u64) -> Option<&'static str> {
    let mut random = SplitMix64::new(seed, stream);
    let scene = Scene::drawn(&mut random);
    let turn_rad = random.within(std::f64::consts::PI) as f32;
    let turned = scene.turned(turn_rad, vector(&mut random, MOVED_M));
    let differs = |planner: &Planner| {
        let [here, there] = [&scene, &turned].map(|scene| scene.planned(*planner, hull).velocity_mps);
        Vec2::from_angle(turn_rad).rotate(here).distance(there) > SLACK_MPS
    };
    [Planner::Mcn, Planner::Orca].iter().any(differs).then_some("is planned otherwise where it is turned")
}

fn vector(random: &mut SplitMix64, range: f64) -> Vec2 {
    Vec2::new(random.within(range) as f32, random.within(range) as f32)
}

impl Scene {
    fn drawn(random: &mut SplitMix64) -> Self {
        let mut each = |range: f64| -> Vec<Vec2> { (0..AGENTS).map(|_| vector(random, range)).collect() };
        let (positions_m, velocities_mps, preferred_mps) = (each(PLACE_M), each(1.2), each(1.2));
        let held_s = [each(1.0), each(1.0)].map(|held| held.iter().map(|held_s| held_s.x.max(0.0)).collect());
        let facings_rad = each(std::f64::consts::PI).iter().map(|facing| facing.x).collect();
        let stances = (0..AGENTS).map(|_| stance(random)).collect();
        let polygons_m = (0..2).map(|_| block_m(vector(random, PLACE_M), vector(random, 1.0))).collect();
        Self { positions_m, velocities_mps, facings_rad, preferred_mps, stances, held_s, polygons_m }
    }

    fn turned(&self, turn_rad: f32, moved_m: Vec2) -> Self {
        let turn = Vec2::from_angle(turn_rad);
        let turned = |vectors: &[Vec2]| vectors.iter().map(|vector| turn.rotate(*vector)).collect::<Vec<Vec2>>();
        let moved =
            |places_m: &[Vec2]| turned(places_m).iter().map(|place_m| *place_m + moved_m).collect::<Vec<Vec2>>();
        Self {
            positions_m: moved(&self.positions_m),
            velocities_mps: turned(&self.velocities_mps),
            facings_rad: self.facings_rad.iter().map(|facing_rad| facing_rad + turn_rad).collect(),
            preferred_mps: turned(&self.preferred_mps),
            stances: self.stances.iter().map(|stance| turned_stance(stance, turn)).collect(),
            held_s: self.held_s.clone(),
            polygons_m: self.polygons_m.iter().map(|polygon_m| moved(polygon_m)).collect(),
        }
    }

    /// The first agent's plan.
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
            preferred_mps: &self.preferred_mps,
            stances: &self.stances,
            strafing_s: &self.held_s[0],
            stepping_back_s: &self.held_s[1],
            neighbours: &neighbours,
            obstacles: &obstacles,
            constraints: &constraints,
            dt_s: 0.1,
            bodies: true,
        };
        plan(planner, &world, 0, &params, &mut PlannerMemory::default())
    }
}

/// On one foot, every other time.
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

/// A block of 1 m by 0.4 m about a place, along a direction.
fn block_m(centre_m: Vec2, along: Vec2) -> Vec<Vec2> {
    let along = along.normalize_or(Vec2::X);
    [(-0.5, -0.2), (0.5, -0.2), (0.5, 0.2), (-0.5, 0.2)].map(|corner| centre_m + along.rotate(corner.into())).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    #[test]
    fn plans_turn_and_move_with_the_scene() {
        let hull = test_db().velocity_hull;
        for seed in 0..10_000 {
            assert_eq!(fault(&hull, seed, 0), None, "seed {seed}");
        }
    }
}
