//! Worlds that no scenario would make, for tests and `bench soak`: what planner does not lose its head in them?
//!
//! A few agents and polygons, drawn at random: crowded, piled on one spot, ten kilometres off, fast beyond measure, at
//! rest to the last bit, of tiny and of huge radii, on an edge, inside a wall. [`WildWorld::fault`] plans every agent
//! by each planner, moves it as a disc, and tells what is wrong, if anything. World, metres, seconds.

use glam::{DVec2, Vec2};
use motiondb::body::Root;
use motiondb::velocity_sets::velocity_hull::VelocityHull;

use crate::coupling::body_to_disc::{as_planned, outside_walls};
use crate::maths::polygon;
use crate::maths::random::SplitMix64;
use crate::params::Params;
use crate::planning::baselines::social_force::RESPONSE_S;
use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::orca::half_plane::{HalfPlane, HalfPlaneSource};
use crate::planning::plan::{Plan, Stance, StanceFoot, VelocitySet};
use crate::planning::planner::{self, Planner, PlannerMemory};
use crate::planning::world_view::WorldView;
use crate::world::neighbours::NeighbourSearch;
use crate::world::obstacles::Obstacles;

/// Agents of a world.
const AGENTS: std::ops::RangeInclusive<usize> = 2..=30;
const POLYGONS_MAX: usize = 4;
/// Where most of it happens: a square of twice this, m.
const PLACE_M: f64 = 6.0;
/// Far off, m; also beyond measure fast, m/s.
const FAR: f64 = 1e4;
/// Rounding of a plan's speed, as a share of its limit.
const SPEED_SLACK: f32 = 1e-3;

/// Everything that a [`WorldView`] borrows.
#[derive(Clone, Debug)]
pub struct WildWorld {
    positions_m: Vec<Vec2>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    radii_m: Vec<f32>,
    preferred_mps: Vec<Vec2>,
    stances: Vec<Stance>,
    strafing_s: Vec<f32>,
    stepping_back_s: Vec<f32>,
    polygons_m: Vec<Vec<Vec2>>,
    dt_s: f32,
}

impl WildWorld {
    /// The same for the same seed.
    pub fn drawn(seed: u64, stream: u64) -> Self {
        let mut draw = Draw(SplitMix64::new(seed, stream));
        let polygons_m: Vec<Vec<Vec2>> = (0..draw.below(POLYGONS_MAX + 1)).map(|_| draw.polygon_m()).collect();
        let count = AGENTS.start() + draw.below(AGENTS.end() - AGENTS.start() + 1);
        let mut positions_m: Vec<Vec2> = Vec::new();
        for _ in 0..count {
            let position_m = draw.position_m(&positions_m, &polygons_m);
            positions_m.push(position_m);
        }
        Self {
            velocities_mps: (0..count).map(|_| draw.velocity_mps()).collect(),
            facings_rad: (0..count).map(|_| draw.within(4.0)).collect(),
            radii_m: (0..count).map(|_| draw.radius_m()).collect(),
            preferred_mps: (0..count).map(|_| draw.velocity_mps()).collect(),
            stances: (0..count).map(|_| draw.stance()).collect(),
            strafing_s: (0..count).map(|_| draw.within(2.0).max(0.0)).collect(),
            stepping_back_s: (0..count).map(|_| draw.within(3.0).max(0.0)).collect(),
            dt_s: [1.0 / 120.0, 1.0 / 30.0, 0.1][draw.below(3)],
            positions_m,
            polygons_m,
        }
    }

    /// What is wrong with what is planned in this world, by which planner; none where all is well.
    pub fn fault(&self, hull: &VelocityHull, params: &Params) -> Option<(Planner, &'static str)> {
        let obstacles = Obstacles::new(&self.polygons_m);
        let constraints = MotionConstraints::new(hull);
        let (mut neighbours, mut scratch) = (NeighbourSearch::default(), PlannerMemory::default());
        let planners = [Planner::Mcn, Planner::Orca, Planner::SocialForce];
        planners.into_iter().find_map(|planner| {
            let ahead_s = planner::ranking_horizon_s(planner, params);
            neighbours.rebuild(&self.positions_m, &self.velocities_mps, &self.radii_m, ahead_s);
            let world = self.world(&neighbours, &obstacles, &constraints);
            (0..self.positions_m.len()).find_map(|agent| {
                let plan = planner::plan(planner, &world, agent, params, &mut scratch);
                let limit_mps = speed_limit_mps(planner, &world, agent, params);
                let judged = self.judged(agent, &plan, limit_mps, &obstacles);
                Some((planner, judged.or_else(|| misled(planner, &plan, scratch.half_planes(planner)))?))
            })
        })
    }

    fn world<'a>(
        &'a self,
        neighbours: &'a NeighbourSearch,
        obstacles: &'a Obstacles,
        constraints: &'a MotionConstraints,
    ) -> WorldView<'a> {
        WorldView {
            positions_m: &self.positions_m,
            velocities_mps: &self.velocities_mps,
            facings_rad: &self.facings_rad,
            radii_m: &self.radii_m,
            preferred_mps: &self.preferred_mps,
            stances: &self.stances,
            strafing_s: &self.strafing_s,
            stepping_back_s: &self.stepping_back_s,
            neighbours,
            obstacles,
            constraints,
            dt_s: self.dt_s,
            bodies: true,
        }
    }

    /// What is wrong with a plan, or with where it leads.
    fn judged(&self, agent: usize, plan: &Plan, limit_mps: f32, obstacles: &Obstacles) -> Option<&'static str> {
        let is_number = plan.velocity_mps.is_finite() && plan.facing_rad.is_finite() && plan.density.is_finite();
        if !is_number || plan.time_to_collision_s.is_nan() {
            return Some("plans what is no number");
        }
        if plan.velocity_mps.length() > limit_mps * (1.0 + SPEED_SLACK) {
            return Some("plans a speed beyond its limit");
        }
        let root = Root { position_m: self.positions_m[agent], facing_rad: self.facings_rad[agent] };
        let moved = as_planned(root, plan, self.dt_s);
        let ended = outside_walls(root.position_m, moved, self.radii_m[agent], obstacles);
        if !ended.position_m.is_finite() {
            return Some("is put nowhere by the walls");
        }
        self.polygons_m
            .iter()
            .any(|corners_m| passes(corners_m, root.position_m, ended.position_m))
            .then_some("goes through a wall")
    }
}

/// What is wrong with the half-planes that are told with a plan.
fn misled(planner: Planner, plan: &Plan, half_planes: &[HalfPlane]) -> Option<&'static str> {
    let other = match plan.set {
        VelocitySet::Turning => HalfPlaneSource::HoldingHull,
        VelocitySet::Holding => HalfPlaneSource::TurningHull,
    };
    let has = |wanted: HalfPlaneSource| half_planes.iter().any(|half_plane| half_plane.source == wanted);
    let of_the_set = planner != Planner::Mcn || has(plan.set.into());
    (!of_the_set || has(other)).then_some("tells the half-planes of another velocity set than its plan's")
}

/// The fastest that a planner may let an agent walk, m/s; social forces only accelerate it so much.
fn speed_limit_mps(planner: Planner, world: &WorldView, agent: usize, params: &Params) -> f32 {
    match planner {
        Planner::Mcn => {
            let of = |set| world.constraints.set(set).speed_max_mps;
            of(VelocitySet::Turning).max(of(VelocitySet::Holding))
        }
        Planner::Orca => params.orca.speed_max_mps,
        Planner::SocialForce => {
            world.velocities_mps[agent].length() + params.social_force.acceleration_max_mps2 * world.lead_s(RESPONSE_S)
        }
    }
}

/// Whether somebody who was not in a polygon gets into it or through it. By all of its edges and in f64, so without
/// what [`Obstacles`] do.
fn passes(corners_m: &[Vec2], from_m: Vec2, to_m: Vec2) -> bool {
    if polygon::contains(corners_m, from_m) {
        return false;
    }
    let ends = corners_m.iter().zip(corners_m.iter().cycle().skip(1)).map(|(&a, &b)| [DVec2::from(a), DVec2::from(b)]);
    let (from, to) = (DVec2::from(from_m), DVec2::from(to_m));
    let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    let mut crossed =
        ends.filter(|&[a, b]| side(a, b, from) * side(a, b, to) < 0.0 && side(from, to, a) * side(from, to, b) < 0.0);
    crossed.next().is_some() || polygon::contains(corners_m, to_m)
}

/// Random numbers of a world.
struct Draw(SplitMix64);

impl Draw {
    fn below(&mut self, limit: usize) -> usize {
        (self.0.next_u64() % limit as u64) as usize
    }

    fn within(&mut self, range: f64) -> f32 {
        self.0.within(range) as f32
    }

    fn vector(&mut self, range: f64) -> Vec2 {
        Vec2::new(self.within(range), self.within(range))
    }

    /// Anywhere, on somebody, beside somebody, on a corner or an edge, in the middle of a polygon, or far off.
    fn position_m(&mut self, others_m: &[Vec2], polygons_m: &[Vec<Vec2>]) -> Vec2 {
        let other_m = if others_m.is_empty() { Vec2::ZERO } else { others_m[self.below(others_m.len())] };
        let edge_m = (!polygons_m.is_empty()).then(|| {
            let corners_m = &polygons_m[self.below(polygons_m.len())];
            let corner = self.below(corners_m.len());
            [corners_m[corner], corners_m[(corner + 1) % corners_m.len()]]
        });
        match (self.below(12), edge_m) {
            (0, _) => other_m,
            (1, _) => other_m + self.vector(1e-4),
            (2, _) => other_m + self.vector(0.5),
            (3, Some([from_m, _])) => from_m,
            (4, Some([from_m, to_m])) => from_m.midpoint(to_m),
            (5, Some([from_m, to_m])) => from_m.lerp(to_m, self.within(1.0).abs()) + self.vector(0.3),
            (6, _) => self.vector(FAR),
            _ => self.vector(PLACE_M),
        }
    }

    /// Of a walker mostly, none to the last bit, next to none, or beyond measure.
    fn velocity_mps(&mut self) -> Vec2 {
        match self.below(10) {
            0 | 1 => Vec2::ZERO,
            2 => self.vector(1e-6),
            3 => self.vector(FAR),
            4 => Vec2::new(self.within(2.0), 0.0),
            _ => self.vector(1.5),
        }
    }

    fn radius_m(&mut self) -> f32 {
        match self.below(10) {
            0 => 1e-4,
            1 => 3.0,
            _ => 0.1 + self.within(0.4).abs(),
        }
    }

    /// On one foot, every other time; a foot may be a point.
    fn stance(&mut self) -> Stance {
        let size_m = if self.below(8) == 0 { 0.0 } else { 0.3 };
        let mut point_m = || self.vector(size_m);
        let [heel_m, ball_m, toe_m, swing_m] = [point_m(), point_m(), point_m(), point_m()];
        let (side, time_to_landing_s) = (self.below(2), self.within(0.6).max(0.0));
        let foot = StanceFoot { side, heel_m, ball_m, toe_m, swing_m, time_to_landing_s };
        Stance { foot: (self.below(2) == 0).then_some(foot) }
    }

    /// A star of three to eight corners about a place: blocks, splinters, and niches.
    fn polygon_m(&mut self) -> Vec<Vec2> {
        let (centre_m, corners) = (self.vector(PLACE_M), 3 + self.below(6));
        let stretch = Vec2::new(1.0, [1.0, 1.0, 0.01, 5.0][self.below(4)]);
        let corner_m = |corner: usize| {
            let (sin, cos) = libm::sincosf(std::f32::consts::TAU * corner as f32 / corners as f32);
            centre_m + stretch * (0.2 + self.within(2.0).abs()) * Vec2::new(cos, sin)
        };
        (0..corners).map(corner_m).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    #[test]
    fn no_planner_loses_its_head_in_a_wild_world() {
        let (hull, params) = (test_db().velocity_hull, Params::default());
        for seed in 0..4000 {
            let fault = WildWorld::drawn(seed, 0).fault(&hull, &params);
            assert!(fault.is_none(), "seed {seed}: {fault:?}");
        }
    }
}
