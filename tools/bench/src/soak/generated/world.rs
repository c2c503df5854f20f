//! Random worlds that no scenario describes, and what is wrong with the plans of any planner in them.
//!
//! A few agents and polygons: crowded, piled on one point, ten kilometres off, very fast, at rest to the last bit, of
//! tiny and of huge radii, on an edge, inside a wall. [`GeneratedWorld::fault`] plans every agent with each planner and
//! moves it as a disc. World, metres, seconds.

use fbcrowd_sim::coupling::{as_planned, outside_walls};
use fbcrowd_sim::maths::{SplitMix64, polygon};
use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::baselines::RESPONSE_S;
use fbcrowd_sim::planning::mcn::MotionConstraints;
use fbcrowd_sim::planning::orca::{HalfPlane, HalfPlaneSource};
use fbcrowd_sim::planning::{self, Plan, Planner, PlannerMemory, Stance, StanceFoot, VelocitySet, WorldView};
use fbcrowd_sim::world::neighbours::NeighbourSearch;
use fbcrowd_sim::world::obstacles::Obstacles;
use glam::{DVec2, Vec2};
use motiondb::body::Root;
use motiondb::velocity_sets::velocity_hull::VelocityHull;

/// Numbers of agents.
const AGENTS: std::ops::RangeInclusive<usize> = 2..=30;
/// Most polygons.
const POLYGONS_MAX: usize = 4;
/// Half the side of the square that holds most of a world, m.
const SQUARE_M: f64 = 6.0;
/// Greatest coordinate of an agent that is far off, m, and of a velocity that is too great, m/s.
const FAR: f64 = 1e4;
/// Speed that all agents prefer on a free path, m/s.
const FREE_SPEED_MPS: f32 = 1.3;
/// Rounding of a plan's speed, as a share of its limit.
const SPEED_SLACK: f32 = 1e-3;

/// Everything that a [`WorldView`] borrows.
#[derive(Clone, Debug)]
pub struct GeneratedWorld {
    positions_m: Vec<Vec2>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    radii_m: Vec<f32>,
    wall_radii_m: Vec<f32>,
    preferred_mps: Vec<Vec2>,
    free_speeds_mps: Vec<f32>,
    facing_offsets_rad: Vec<f32>,
    stances: Vec<Stance>,
    planned_mps: Vec<Vec2>,
    strafing_s: Vec<f32>,
    stepping_back_s: Vec<f32>,
    polygons_m: Vec<Vec<Vec2>>,
    dt_s: f32,
}

impl GeneratedWorld {
    /// The world of a seed.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut draw = WorldDraw(SplitMix64::new(seed, stream));
        let polygons_m: Vec<Vec<Vec2>> = (0..draw.below(POLYGONS_MAX + 1)).map(|_| draw.polygon_m()).collect();
        let count = AGENTS.start() + draw.below(AGENTS.end() - AGENTS.start() + 1);
        let mut positions_m: Vec<Vec2> = Vec::new();
        for _ in 0..count {
            let position_m = draw.position_m(&positions_m, &polygons_m);
            positions_m.push(position_m);
        }
        let radii_m: Vec<f32> = (0..count).map(|_| draw.radius_m()).collect();
        Self {
            velocities_mps: (0..count).map(|_| draw.velocity_mps()).collect(),
            facings_rad: (0..count).map(|_| draw.within(4.0)).collect(),
            wall_radii_m: radii_m.iter().map(|&radius_m| radius_m * (0.5 + draw.within(0.5).abs())).collect(),
            radii_m,
            preferred_mps: (0..count).map(|_| draw.velocity_mps()).collect(),
            free_speeds_mps: vec![FREE_SPEED_MPS; count],
            stances: (0..count).map(|_| draw.stance()).collect(),
            strafing_s: (0..count).map(|_| draw.within(2.0).max(0.0)).collect(),
            stepping_back_s: (0..count).map(|_| draw.within(3.0).max(0.0)).collect(),
            planned_mps: (0..count).map(|_| draw.velocity_mps()).collect(),
            dt_s: [1.0 / 120.0, 1.0 / 30.0, 0.1][draw.below(3)],
            facing_offsets_rad: (0..count).map(|_| draw.within(2.0)).collect(),
            positions_m,
            polygons_m,
        }
    }

    /// The fault of a plan in this world, with the planner; none where nothing is wrong.
    pub fn fault(&self, hull: &VelocityHull, params: &Params) -> Option<(Planner, &'static str)> {
        let obstacles = Obstacles::new(&self.polygons_m);
        let constraints = MotionConstraints::new(hull);
        let (mut neighbours, mut scratch) = (NeighbourSearch::default(), PlannerMemory::default());
        let planners = [Planner::Mcn, Planner::Orca, Planner::SocialForce];
        planners.into_iter().find_map(|planner| {
            let ahead_s = planning::ranking_horizon_s(planner, params);
            neighbours.rebuild(&self.positions_m, &self.velocities_mps, &self.radii_m, ahead_s);
            let world = self.world(&neighbours, &obstacles, &constraints);
            (0..self.positions_m.len()).find_map(|agent| {
                let plan = planning::plan(planner, &world, agent, params, &mut scratch);
                let limit_mps = speed_limit_mps(planner, &world, agent, params);
                let fault = self.plan_fault(agent, &plan, limit_mps, &obstacles);
                Some((planner, fault.or_else(|| reported_fault(planner, &plan, scratch.half_planes(planner)))?))
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
            wall_radii_m: &self.wall_radii_m,
            preferred_mps: &self.preferred_mps,
            free_speeds_mps: &self.free_speeds_mps,
            facing_offsets_rad: &self.facing_offsets_rad,
            stances: &self.stances,
            planned_mps: &self.planned_mps,
            strafing_s: &self.strafing_s,
            stepping_back_s: &self.stepping_back_s,
            neighbours,
            obstacles,
            own_walls: None,
            one_way: &[],
            priorities: None,
            constraints,
            own_constraints: None,
            speed_factors: None,
            dt_s: self.dt_s,
            bodies: true,
        }
    }

    /// The fault of a plan, or of the position to which it leads.
    fn plan_fault(&self, agent: usize, plan: &Plan, limit_mps: f32, obstacles: &Obstacles) -> Option<&'static str> {
        let is_number = plan.velocity_mps.is_finite() && plan.facing_rad.is_finite() && plan.density.is_finite();
        if !is_number || plan.time_to_collision_s.is_nan() {
            return Some("plans no number");
        }
        if plan.velocity_mps.length() > limit_mps * (1.0 + SPEED_SLACK) {
            return Some("plans a speed beyond its limit");
        }
        let root = Root { position_m: self.positions_m[agent], facing_rad: self.facings_rad[agent] };
        let moved = as_planned(root, plan, self.dt_s);
        let ended = outside_walls(root.position_m, moved, self.wall_radii_m[agent], obstacles);
        if !ended.position_m.is_finite() {
            return Some("is moved to no finite position by the walls");
        }
        self.polygons_m
            .iter()
            .any(|corners_m| passes(corners_m, root.position_m, ended.position_m))
            .then_some("goes through a wall")
    }
}

/// The fault of the half-planes that are reported with a plan.
fn reported_fault(planner: Planner, plan: &Plan, half_planes: &[HalfPlane]) -> Option<&'static str> {
    let other = match plan.set {
        VelocitySet::Turning => HalfPlaneSource::HoldingHull,
        VelocitySet::Holding => HalfPlaneSource::TurningHull,
    };
    let has = |wanted: HalfPlaneSource| half_planes.iter().any(|half_plane| half_plane.source == wanted);
    let of_the_set = planner != Planner::Mcn || has(plan.set.into());
    (!of_the_set || has(other)).then_some("reports the half-planes of another velocity set than its plan's")
}

/// Greatest speed of an agent with a planner, m/s; with social forces it follows from the greatest acceleration.
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

/// Whether an agent outside a polygon gets into it or through it: by all edges and in f64, independent of
/// [`Obstacles`].
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
struct WorldDraw(SplitMix64);

impl WorldDraw {
    fn below(&mut self, limit: usize) -> usize {
        (self.0.next_u64() % limit as u64) as usize
    }

    fn within(&mut self, range: f64) -> f32 {
        self.0.within(range) as f32
    }

    fn vector(&mut self, range: f64) -> Vec2 {
        Vec2::new(self.within(range), self.within(range))
    }

    /// A point anywhere, on another agent, beside one, on a corner or an edge, inside a polygon, or far off.
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
            _ => self.vector(SQUARE_M),
        }
    }

    /// A velocity of a walk, exactly 0, almost 0, or too great.
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

    /// A stance on one foot every other time; a foot may be a point.
    fn stance(&mut self) -> Stance {
        let size_m = if self.below(8) == 0 { 0.0 } else { 0.3 };
        let mut point_m = || self.vector(size_m);
        let [heel_m, ball_m, toe_m, swing_m] = [point_m(), point_m(), point_m(), point_m()];
        let (side, time_to_landing_s) = (self.below(2), self.within(0.6).max(0.0));
        let foot = StanceFoot { side, heel_m, ball_m, toe_m, swing_m, time_to_landing_s };
        Stance { foot: (self.below(2) == 0).then_some(foot) }
    }

    /// A star of three to eight corners about a point: blocks, splinters, and niches.
    fn polygon_m(&mut self) -> Vec<Vec2> {
        let (centre_m, corners) = (self.vector(SQUARE_M), 3 + self.below(6));
        let stretch = Vec2::new(1.0, [1.0, 1.0, 0.01, 5.0][self.below(4)]);
        let corner_m = |corner: usize| {
            let (sin, cos) = libm::sincosf(std::f32::consts::TAU * corner as f32 / corners as f32);
            centre_m + stretch * (0.2 + self.within(2.0).abs()) * Vec2::new(cos, sin)
        };
        (0..corners).map(corner_m).collect()
    }
}
