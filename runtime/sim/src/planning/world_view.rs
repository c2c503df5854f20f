//! What a planner may read: all agents and walls as the last step left them.
//!
//! The view is frozen while all agents are planned, so they may be planned in any order and on any thread. Slices are
//! by agent. World axes, metres, seconds, radians.

use glam::Vec2;

use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::orca::agent_half_planes::EQUAL_SHARE;
use crate::planning::orca::half_plane::{HalfPlane, HalfPlaneSource};
use crate::planning::plan::Stance;
use crate::world::disc::Disc;
use crate::world::neighbours::neighbour_lanes::{LANES, Lanes};
use crate::world::neighbours::{Neighbour, NeighbourSearch};
use crate::world::obstacles::{Obstacles, ZoneWalls};
use crate::world::one_way::OneWayZone;

/// Everything that a plan depends on, besides the planner's tunables.
///
/// One agent that walks along +x, planned by MCN with velocity sets made by hand:
///
/// ```
/// use fbcrowd_sim::planning::mcn::MotionConstraints;
/// use fbcrowd_sim::planning::{PlannerMemory, Stance, plan, ranking_horizon_s};
/// use fbcrowd_sim::world::neighbours::NeighbourSearch;
/// use fbcrowd_sim::world::obstacles::Obstacles;
/// use fbcrowd_sim::{Params, Planner, WorldView};
/// use glam::Vec2;
/// use motiondb::velocity_sets::velocity_hull::VelocityHull;
///
/// let (planner, params, walk_mps) = (Planner::Mcn, Params::default(), Vec2::new(1.3, 0.0));
/// // Corners in the agent's frame, clockwise: up to 1.8 m/s forward, 0.8 m/s to the sides, 0.5 m/s backward.
/// let corners_mps = [[1.8, 0.0], [0.0, -0.8], [-0.5, 0.0], [0.0, 0.8]].map(Vec2::from).to_vec();
/// let hull = VelocityHull { turning_mps: corners_mps.clone(), holding_mps: corners_mps, ..VelocityHull::default() };
/// let mut neighbours = NeighbourSearch::default();
/// neighbours.rebuild(&[Vec2::ZERO], &[walk_mps], &[0.25], ranking_horizon_s(planner, &params));
/// let world = WorldView {
///     positions_m: &[Vec2::ZERO],
///     velocities_mps: &[walk_mps],
///     facings_rad: &[0.0],
///     radii_m: &[0.25],
///     wall_radii_m: &[0.2],
///     preferred_mps: &[walk_mps],
///     free_speeds_mps: &[1.3],
///     facing_offsets_rad: &[0.0],
///     stances: &[Stance::default()],
///     planned_mps: &[walk_mps],
///     strafing_s: &[0.0],
///     stepping_back_s: &[0.0],
///     neighbours: &neighbours,
///     obstacles: &Obstacles::default(),
///     own_walls: None,
///     one_way: &[],
///     priorities: None,
///     constraints: &MotionConstraints::new(&hull),
///     own_constraints: None,
///     speed_factors: None,
///     dt_s: 0.1,
///     bodies: true,
/// };
/// let plan = plan(planner, &world, 0, &params, &mut PlannerMemory::default());
/// assert_eq!(plan.velocity_mps, walk_mps);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct WorldView<'a> {
    /// Positions of the synthesised roots, m.
    pub positions_m: &'a [Vec2],
    /// Velocities of the synthesised roots, m/s.
    pub velocities_mps: &'a [Vec2],
    /// Facings of the synthesised roots, rad.
    pub facings_rad: &'a [f32],
    /// Radii of the bounding discs, which agents see of each other, m.
    pub radii_m: &'a [f32],
    /// Radii of the discs that walls hold, m.
    pub wall_radii_m: &'a [f32],
    /// v_pref, m/s.
    pub preferred_mps: &'a [Vec2],
    /// Speeds that agents prefer on a free path, m/s.
    pub free_speeds_mps: &'a [f32],
    /// Angles from v_pref to the direction of the route, which agents face, counter-clockwise, rad.
    pub facing_offsets_rad: &'a [f32],
    /// How each body stands.
    pub stances: &'a [Stance],
    /// [`Plan::velocity_mps`](crate::planning::Plan::velocity_mps) of the last step.
    pub planned_mps: &'a [Vec2],
    /// [`Plan::strafing_s`](crate::planning::Plan::strafing_s) of the last step.
    pub strafing_s: &'a [f32],
    /// [`Plan::stepping_back_s`](crate::planning::Plan::stepping_back_s) of the last step.
    pub stepping_back_s: &'a [f32],
    /// The same positions, velocities and radii, sorted for the planner's
    /// [`ranking_horizon_s`](crate::planning::ranking_horizon_s).
    pub neighbours: &'a NeighbourSearch,
    /// The walls of agents that enter all zones.
    pub obstacles: &'a Obstacles,
    /// The walls of the other agents, and which agents these are; none where there are no such agents.
    pub own_walls: Option<OwnWalls<'a>>,
    /// Zones through which agents move one way: a plan within one has no part against its heading.
    pub one_way: &'a [OneWayZone],
    /// Priority of each agent: an agent leaves more of the avoiding to one of a lower priority. None: all are equal.
    pub priorities: Option<&'a [f32]>,
    /// Constraints of the database's velocity sets.
    pub constraints: &'a MotionConstraints,
    /// Constraints of the agents whose bodies move in another style; none where there are no such agents.
    pub own_constraints: Option<OwnConstraints<'a>>,
    /// Velocities of each body, divided by those of a body of the skeleton's size. None: all are 1.
    pub speed_factors: Option<&'a [f32]>,
    /// Time step, s.
    pub dt_s: f32,
    /// Whether bodies carry the plans out, which respond later than at the end of the step.
    pub bodies: bool,
}

/// The walls of agents that do not enter some zones.
#[derive(Clone, Copy, Debug)]
pub struct OwnWalls<'a> {
    /// The zones that each agent does not enter, by bits.
    pub closed_zones: &'a [u32],
    /// The walls for each set of zones.
    pub zone_walls: &'a ZoneWalls,
}

/// The constraints of each style's velocity sets.
#[derive(Clone, Copy, Debug)]
pub struct OwnConstraints<'a> {
    /// Style of each agent, by index.
    pub styles: &'a [u32],
    /// The constraints of each style.
    pub constraints: &'a [MotionConstraints],
}

impl<'a> WorldView<'a> {
    /// The constraints of an agent's body.
    pub fn constraints_of(&self, agent: usize) -> &'a MotionConstraints {
        let own = self.own_constraints.and_then(|own| own.constraints.get(own.styles[agent] as usize));
        own.unwrap_or(self.constraints)
    }

    /// The walls of an agent.
    pub fn walls_of(&self, agent: usize) -> &'a Obstacles {
        let own = self.own_walls.and_then(|own| own.zone_walls.of(own.closed_zones[agent]));
        own.unwrap_or(self.obstacles)
    }

    /// Velocities of an agent's body, divided by those of a body of the skeleton's size.
    pub(crate) fn speed_factor(&self, agent: usize) -> f32 {
        self.speed_factors.map_or(1.0, |factors| factors[agent])
    }

    /// The half-planes of the one-way zones that hold an agent.
    pub(crate) fn one_way_half_planes(&self, agent: usize) -> impl Iterator<Item = HalfPlane> + use<'a> {
        let position_m = self.positions_m[agent];
        let holding = self.one_way.iter().enumerate().filter(move |(_, zone)| zone.holds(position_m));
        holding.map(|(index, zone)| HalfPlane::behind(Vec2::ZERO, -zone.heading, HalfPlaneSource::OneWay(index as u32)))
    }

    /// How much of the avoiding an agent does against each of some neighbours: ½ among equals, all of it against a
    /// priority that is higher by 1, nothing against one that is lower by 1 (Curtis, Zafar, Gutub, Manocha 2013, "Right
    /// of way"). The shares of two agents add up to 1.
    pub(crate) fn shares(&self, agent: usize, neighbours: &[Neighbour]) -> Lanes {
        let mut shares = [EQUAL_SHARE; LANES];
        for (share, neighbour) in shares.iter_mut().zip(neighbours) {
            *share -= EQUAL_SHARE * self.precedence(agent, neighbour);
        }
        shares
    }

    /// Priority of an agent over that of a neighbour, from -1 to 1; 0 among equals.
    fn precedence(&self, agent: usize, neighbour: &Neighbour) -> f32 {
        let over = |priorities: &[f32]| priorities[agent] - priorities[neighbour.agent as usize];
        self.priorities.map_or(0.0, over).clamp(-1.0, 1.0)
    }

    /// An agent's velocity, and one of its neighbours, as the agent's half-plane takes them.
    ///
    /// The agent of the higher priority counts as if it had gained a share of its preferred velocity: all of it from a
    /// difference of 1 (Curtis et al. 2013). The half-plane of an agent that avoids nothing passes through its velocity;
    /// with the present one, an agent at rest could never begin to walk.
    pub(crate) fn with_right_of_way(&self, agent: usize, neighbour: &Neighbour) -> (Vec2, Neighbour) {
        let (own_mps, precedence) = (self.velocities_mps[agent], self.precedence(agent, neighbour));
        if precedence == 0.0 {
            return (own_mps, *neighbour);
        }
        let gain_mps = |of: usize| self.preferred_mps[of] - self.velocities_mps[of];
        let own_gain_mps = precedence.max(0.0) * gain_mps(agent);
        let other_gain_mps = (-precedence).max(0.0) * gain_mps(neighbour.agent as usize);
        (own_mps + own_gain_mps, neighbour.with_gains(own_gain_mps, other_gain_mps))
    }

    /// The disc of an agent that other agents see.
    pub fn disc(&self, agent: usize) -> Disc {
        Disc {
            position_m: self.positions_m[agent],
            velocity_mps: self.velocities_mps[agent],
            radius_m: self.radii_m[agent],
        }
    }

    /// The disc of an agent that walls hold.
    pub fn wall_disc(&self, agent: usize) -> Disc {
        Disc { radius_m: self.wall_radii_m[agent], ..self.disc(agent) }
    }

    /// Time for which a planner that keeps nothing from its last plan applies forces to the present velocity, s.
    ///
    /// Discs have their planned velocity at the end of the step. Bodies lag by about `response_s`: of what forces add
    /// within a fine step they would take up almost nothing, and a body that stands would never start to step.
    pub fn lead_s(&self, response_s: f32) -> f32 {
        if self.bodies { response_s.max(self.dt_s) } else { self.dt_s }
    }

    /// Unit vector along an agent's preferred velocity; zero where that is zero.
    pub(crate) fn preferred_direction(&self, agent: usize) -> Vec2 {
        self.preferred_mps[agent].normalize_or_zero()
    }

    /// An agent's preferred velocity, turned to the direction of its route, m/s.
    pub(crate) fn along_route_mps(&self, agent: usize) -> Vec2 {
        let (sin, cos) = libm::sincosf(self.facing_offsets_rad[agent]);
        Vec2::new(cos, sin).rotate(self.preferred_mps[agent])
    }

    /// Unit vector along an agent's facing.
    pub fn forward(&self, agent: usize) -> Vec2 {
        let (sin, cos) = libm::sincosf(self.facings_rad[agent]);
        Vec2::new(cos, sin)
    }

    /// The ends of a wall's edge, relative to an agent's centre, m.
    pub fn edge_m(&self, agent: usize, edge: u32) -> [Vec2; 2] {
        self.walls_of(agent).ends_m(edge).map(|end_m| end_m - self.positions_m[agent])
    }
}
