//! Agents of a scene: numbers by name, groups at the start, sources of agents that come later.

use crate::random::Random;
use crate::scene::drawn_number::DrawnNumber;
use crate::scene::shape::{Point, Shape, round_to_mm};

/// Numbers of agents, by name.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneProfile {
    /// Name of the profile.
    pub name: String,
    /// Profile whose numbers hold where this one states none.
    pub inherits: Option<String>,
    /// Preferred speed, m/s.
    pub preferred_speed_mps: Option<DrawnNumber>,
    /// Radius of the disc, m.
    pub radius_m: Option<DrawnNumber>,
    /// Position in the source, "file:line".
    pub origin: String,
}

/// Agents that begin alike.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneAgents {
    /// Positions at the start.
    pub starts: Starts,
    /// Profiles with weights; one: all agents have it.
    pub profiles: Vec<(String, f64)>,
    /// State in which they begin.
    pub state: Option<String>,
    /// Greatest radius that an agent of the group draws, m.
    pub radius_max_m: f64,
    /// Radius of the disc that walls hold, m, where it is not the default.
    pub wall_radius_m: Option<f64>,
    /// Which coordinates of an agent's start its own goal mirrors, x and y; none: it has no goal of its own.
    pub own_goal_mirrors: Option<[bool; 2]>,
    /// Position in the source, "file:line".
    pub origin: String,
}

/// Positions of agents at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum Starts {
    /// Rows and columns.
    Grid(Grid),
    /// Any positions, m.
    Points(Vec<Point>),
    /// A number of agents spread over a shape.
    Spread {
        /// The shape.
        shape: Shape,
        /// Number of agents.
        count: usize,
    },
}

/// Agents in rows and columns along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Distance between neighbours, m.
    pub spacing_m: f64,
    /// Middle of the grid, m.
    pub centre_m: Point,
    /// Half the side of the square in which each agent is displaced, m.
    pub jitter_m: f64,
}

/// Agents that come later.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSource {
    /// Shape in which they appear.
    pub shape: Shape,
    /// When they are due.
    pub times: SourceTimes,
    /// State in which they begin.
    pub state: Option<String>,
    /// Profile of the agents.
    pub profile: Option<String>,
    /// Position in the source file, "file:line" or a name.
    pub origin: String,
}

/// When the agents of a source are due.
#[derive(Clone, Debug, PartialEq)]
pub enum SourceTimes {
    /// Random times at a rate.
    Rate {
        /// Mean number of agents per second.
        rate_per_s: f64,
        /// Time from which agents are due, s.
        from_s: f64,
        /// Time until which agents are due, s.
        to_s: f64,
        /// Greatest number of agents.
        count: Option<u64>,
    },
    /// Times, s, in order, and the number of agents at each.
    Stated(Vec<(f64, u64)>),
}

impl SceneAgents {
    /// The goal of its own of an agent, where it has one.
    pub fn own_goal_m(&self, start_m: Point) -> Option<Point> {
        let mirrors = self.own_goal_mirrors?;
        Some([0, 1].map(|axis| if mirrors[axis] { -start_m[axis] } else { start_m[axis] }))
    }
}

impl Starts {
    /// Number of agents.
    pub fn count(&self) -> usize {
        match self {
            Self::Grid(grid) => grid.columns * grid.rows,
            Self::Points(points_m) => points_m.len(),
            Self::Spread { count, .. } => *count,
        }
    }

    /// Whether a rule holds for all positions; those of a shape are its middle.
    pub fn all(&self, holds: impl Fn(Point) -> bool) -> bool {
        match self {
            Self::Grid(grid) => grid.positions_m().all(holds),
            Self::Points(points_m) => points_m.iter().all(|&point_m| holds(point_m)),
            Self::Spread { shape, .. } => holds(shape.middle_m()),
        }
    }
}

impl Grid {
    /// The positions, each displaced by random numbers of its own, m.
    pub(crate) fn drawn_m(&self) -> Vec<Point> {
        let mut random = Random::new(self.columns as u64);
        let mut displaced_m = |metres: f64| round_to_mm(metres + self.jitter_m * (2.0 * random.unit() - 1.0));
        self.positions_m().map(|at_m| at_m.map(&mut displaced_m)).collect()
    }

    /// The positions without displacement, row by row from the lower left, m.
    pub fn positions_m(&self) -> impl Iterator<Item = Point> + '_ {
        let Self { columns, rows, spacing_m, centre_m, .. } = *self;
        let along = move |index: usize, count: usize, middle_m: f64| {
            middle_m + spacing_m * (index as f64 - 0.5 * (count as f64 - 1.0))
        };
        (0..columns * rows)
            .map(move |index| [along(index % columns, columns, centre_m[0]), along(index / columns, rows, centre_m[1])])
    }
}
