//! Who is near, or soon will be: a search over grids that follow the crowd's density.
//!
//! Agents lie in cell order as structures of arrays, so a row of cells is one run of memory and is ranked several
//! agents at once. A search visits squares of cells from the inside out and stops when no cell outside can hold a
//! better neighbour. The answer does not depend on the grids.
//!
//! The nearest ten by distance alone can drop the fast approacher (which `FbCrowd` §4.4 leaves open). So agents are
//! ranked by how near they come within the next T seconds if all walk on, where to come later costs a little:
//!
//! ```text
//! rank² = min { |p − t v|² + (c t)² : 0 <= t <= T }      p = p_j − p_i,  v = v_i − v_j
//! ```
//!
//! The time to collision itself does not serve. It jumps to infinity as soon as an agent is avoided, who then would
//! drop out, be met again, and so on in turns.
//!
//! The grids are laid over where everybody will be at T/2: within T nobody is farther from there than half of its
//! path, so a search reaches hardly farther than one by distance alone, which is that of T = 0. World, metres, seconds.

pub(crate) mod grid;
pub(crate) mod rank;
#[cfg(test)]
pub(crate) mod tests;

use std::ops::Range;

use glam::Vec2;

use crate::world::neighbour_lanes::Around;
use crate::world::neighbours::grid::{Grid, Layout, Run, Window};
use crate::world::neighbours::rank::{NOBODY, VECTOR, key, offer, squared_of};

/// Neighbours taken: as many as RVO2's own examples take (van den Berg et al. 2011).
pub const NEIGHBOUR_COUNT: usize = 10;
/// T of MCN, s: of two at equal distance, one who comes straight on at walking speed, 1.33 m/s against ours, ranks as
/// if nearer by up to 4 m. Of 0.5, 1, 1.2 and 1.5 s, tried with a hundred people who cross 0.8 m and 1 m apart, A was
/// least with the last.
pub const AHEAD_S: f32 = 1.5;
/// c², m²/s²: of those who would be met, who is met sooner comes first. 0.14 of eight values from 0.12 to 0.36: with it
/// every bar of `fbcrowd bench table1`, `rimea` and `emergence` is met, while others miss one of them by chance.
const LATER_SQUARED_M2PS2: f32 = 0.14;
/// What is guessed of the square of the worst rank, as a multiple of the last searcher's: a quarter farther.
const GUESS: f32 = 1.25 * 1.25;
/// What rounding may shift a place by, as a share of the greatest coordinate: some units in the last place of f32.
const ROUNDING: f32 = 1e-6;

/// One neighbour found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// Index of the agent.
    pub agent: u32,
    /// p_j − p_i.
    pub offset_m: Vec2,
    /// v_i − v_j: what closes the offset.
    pub velocity_mps: Vec2,
    /// r_i + r_j.
    pub radius_m: f32,
    /// Between the centres.
    pub distance_m: f32,
    /// Between the discs at their present velocities; infinite where they do not meet, 0 where they overlap.
    pub time_to_collision_s: f32,
}

/// At most [`NEIGHBOUR_COUNT`] neighbours, best rank first, ties by index.
#[derive(Clone, Debug, Default)]
pub struct Nearest {
    keys: [u64; NEIGHBOUR_COUNT],
    found: Vec<Neighbour>,
    around: Around,
    /// Working memory.
    ranks: Vec<f32>,
}

/// The agents, sorted by the cells of their places at T/2.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    /// T.
    ahead_s: f32,
    layout: Layout,
    /// Place of each agent in cell order, by index.
    places: Vec<u32>,
    // In cell order, and a vector more that is nowhere.
    x_m: Vec<f32>,
    y_m: Vec<f32>,
    velocities_x_mps: Vec<f32>,
    velocities_y_mps: Vec<f32>,
    radii_m: Vec<f32>,
    speed_max_mps: f32,
    /// The greatest coordinate of any place at T/2.
    extent_m: f32,
    /// Working memory.
    halfway_m: Vec<Vec2>,
}

/// A search under way.
struct Search<'a> {
    query: &'a Query,
    /// The searcher's place at T/2.
    centre_m: Vec2,
    /// The farthest that anybody comes nearer than at T/2, and what rounding may add.
    half_path_m: f32,
    /// The best so far.
    keys: &'a mut [u64; NEIGHBOUR_COUNT],
    /// Working memory.
    ranks: &'a mut Vec<f32>,
}

/// Who searches.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    /// Left out of the answer.
    pub agent: usize,
    /// Centre of the search.
    pub position_m: Vec2,
    /// For ranks and times to collision.
    pub velocity_mps: Vec2,
    /// For the times to collision.
    pub radius_m: f32,
    /// No neighbour lies farther.
    pub range_m: f32,
}

impl Nearest {
    /// What its lists hold in memory, bytes.
    pub(crate) fn lists_bytes(&self) -> usize {
        self.found.capacity() * size_of::<Neighbour>() + self.ranks.capacity() * size_of::<f32>()
    }

    /// Best rank first.
    pub fn as_slice(&self) -> &[Neighbour] {
        &self.found
    }

    /// The same in lanes.
    pub fn around(&self) -> &Around {
        &self.around
    }

    /// The square of the worst rank found.
    fn worst(&self) -> f32 {
        squared_of(self.keys[NEIGHBOUR_COUNT - 1])
    }
}

impl Neighbours {
    /// Sorts the agents into cells, to be ranked by how near they come within `ahead`; at 0, by distance.
    pub fn rebuild(&mut self, positions_m: &[Vec2], velocities_mps: &[Vec2], radii_m: &[f32], ahead_s: f32) {
        self.ahead_s = ahead_s;
        self.halfway_m.clear();
        let moving = positions_m.iter().zip(velocities_mps);
        self.halfway_m.extend(moving.map(|(&position_m, &velocity_mps)| position_m + 0.5 * ahead_s * velocity_mps));
        self.extent_m = self.halfway_m.iter().map(|halfway_m| halfway_m.abs().max_element()).fold(0.0, f32::max);
        self.layout.rebuild(&self.halfway_m);
        let agents = &self.layout.agents;
        self.places.resize(agents.len(), 0);
        for (place, &agent) in agents.iter().enumerate() {
            self.places[agent as usize] = place as u32;
        }
        gather(&mut self.x_m, agents, |agent| positions_m[agent].x);
        gather(&mut self.y_m, agents, |agent| positions_m[agent].y);
        gather(&mut self.velocities_x_mps, agents, |agent| velocities_mps[agent].x);
        gather(&mut self.velocities_y_mps, agents, |agent| velocities_mps[agent].y);
        gather(&mut self.radii_m, agents, |agent| radii_m[agent]);
        self.speed_max_mps = velocities_mps.iter().map(|velocity| velocity.length()).fold(0.0, f32::max);
    }

    /// All agents in cell order. Whoever takes them in this order finds the neighbours of one in the cache for the
    /// next.
    pub fn in_cell_order(&self) -> &[u32] {
        &self.layout.agents
    }

    /// The best-ranked agents within range.
    ///
    /// Whoever asked last with the same working memory was most likely near: its worst rank is a good guess of how far
    /// to look for approachers. Where it was too low, the search is made again without.
    pub fn nearest(&self, query: &Query, nearest: &mut Nearest) {
        let guess = if self.ahead_s > 0.0 { GUESS * nearest.worst() } else { 0.0 };
        let centre_m = query.position_m + 0.5 * self.ahead_s * query.velocity_mps;
        let speeds_mps = query.velocity_mps.length_squared().sqrt() + self.speed_max_mps;
        let half_path_m = (1.0 + ROUNDING) * 0.5 * self.ahead_s * speeds_mps + ROUNDING * self.extent_m;
        let mut ranks = std::mem::take(&mut nearest.ranks);
        for nobody in [key(guess, u32::MAX), NOBODY].into_iter().filter(|&nobody| squared_of(nobody) > 0.0) {
            nearest.keys = [nobody; NEIGHBOUR_COUNT];
            let mut search = Search { query, centre_m, half_path_m, keys: &mut nearest.keys, ranks: &mut ranks };
            self.search(0, nobody < NOBODY, &mut search);
            if nearest.keys[NEIGHBOUR_COUNT - 1] < nobody {
                break;
            }
        }
        nearest.ranks = ranks;
        self.tell(query, nearest);
    }

    /// What there is to know of those found.
    fn tell(&self, query: &Query, nearest: &mut Nearest) {
        nearest.around = Around::default();
        let found = nearest.keys.iter().take_while(|&&key| key < NOBODY).count();
        for lane in 0..found {
            let place = self.places[nearest.keys[lane] as u32 as usize] as usize;
            let offset_m = Vec2::new(self.x_m[place], self.y_m[place]) - query.position_m;
            let velocity_mps =
                query.velocity_mps - Vec2::new(self.velocities_x_mps[place], self.velocities_y_mps[place]);
            nearest.around.put(lane, offset_m, velocity_mps, query.radius_m + self.radii_m[place]);
        }
        let times_s = nearest.around.times_to_collision_s(Vec2::ZERO);
        nearest.found.clear();
        nearest
            .found
            .extend((0..found).map(|lane| nearest.around.neighbour(lane, nearest.keys[lane] as u32, times_s[lane])));
    }

    /// Visits ever larger squares of a grid's cells around the query, until no cell outside can hold a better
    /// candidate. As soon as enough are found, or `guessed`, it is known how far the last one has to reach.
    fn search(&self, grid: usize, guessed: bool, search: &mut Search) {
        let Some(grid) = self.layout.grids.get(grid) else { return };
        let centre_m = search.centre_m;
        if grid.distance_m(centre_m) > search.reach_m() {
            return;
        }
        let reached = grid.within(centre_m, search.reach_m());
        let nearby = Window::around(grid.cell_of(centre_m), 1);
        let (mut square, mut visited) = (if guessed { reached } else { nearby }, None);
        loop {
            let reached = grid.within(centre_m, search.reach_m());
            self.visit(grid, &reached.and(&square), visited, search);
            let reached = grid.within(centre_m, search.reach_m());
            if reached.and(&square) == reached {
                return;
            }
            let enough = search.keys[NEIGHBOUR_COUNT - 1] < NOBODY;
            (square, visited) = (if enough { reached } else { square.doubled() }, Some(square));
        }
    }

    /// Offers whoever is in the cells of a window that were not visited.
    fn visit(&self, grid: &Grid, window: &Window, visited: Option<Window>, search: &mut Search) {
        for row in window.rows[0]..=window.rows[1] {
            for columns in unvisited(window.columns, row, visited) {
                self.layout.runs(grid, row, columns, |run| match run {
                    Run::Places(places) => self.scan(places, search),
                    Run::Grid(inner) => self.search(inner, false, search),
                });
            }
        }
    }

    /// Offers the agents of a run of places.
    fn scan(&self, places: Range<usize>, search: &mut Search) {
        let mut worst = search.worst();
        self.rank_all(&places, search.query, search.ranks);
        let ranks = search.ranks.chunks_exact(VECTOR);
        for (ranks, first) in ranks.zip(places.clone().step_by(VECTOR)) {
            // Nearly always nobody is better, which is told for all at once.
            let mut better = rank::better(ranks, worst) & ((1 << (places.end - first).min(VECTOR)) - 1);
            while better != 0 {
                let lane = better.trailing_zeros() as usize;
                better &= better - 1;
                let agent = self.layout.agents[first + lane];
                if agent as usize != search.query.agent {
                    offer(search.keys, key(ranks[lane], agent));
                    worst = search.worst();
                }
            }
        }
    }

    /// Ranks of the agents of a run of places, and of a few more: what a vector leaves over would be ranked one by one.
    fn rank_all(&self, places: &Range<usize>, query: &Query, ranks: &mut Vec<f32>) {
        let places = places.start..places.start + places.len().next_multiple_of(VECTOR);
        let (x_m, y_m) = (&self.x_m[places.clone()], &self.y_m[places.clone()]);
        ranks.resize(places.len(), 0.0);
        if self.ahead_s > 0.0 {
            let velocities = (&self.velocities_x_mps[places.clone()], &self.velocities_y_mps[places]);
            rank::by_approach((x_m, y_m), velocities, query, self.ahead_s, ranks);
        } else {
            rank::by_distance(x_m, y_m, query, ranks);
        }
    }
}

impl Search<'_> {
    /// The square of the rank that a candidate must not exceed.
    fn worst(&self) -> f32 {
        squared_of(self.keys[NEIGHBOUR_COUNT - 1])
    }

    /// Beyond this distance at T/2 nobody is in range and beats the worst candidate, even straight on and as fast as
    /// the fastest.
    fn reach_m(&self) -> f32 {
        (1.0 + ROUNDING) * self.worst().sqrt().min(self.query.range_m) + self.half_path_m
    }
}

/// The columns of a row that were not visited: those left and those right of a window, or all.
fn unvisited([first, last]: [i32; 2], row: i32, visited: Option<Window>) -> impl Iterator<Item = [i32; 2]> {
    let crossed = visited.filter(|window| (window.rows[0]..=window.rows[1]).contains(&row));
    let sides = match crossed {
        Some(Window { columns: [left, right], .. }) => [[first, last.min(left - 1)], [first.max(right + 1), last]],
        None => [[first, last], [0, -1]],
    };
    sides.into_iter().filter(|[first, last]| first <= last)
}

/// A figure of the agents in cell order, and a vector of nobody's.
fn gather(sorted: &mut Vec<f32>, agents: &[u32], value: impl Fn(usize) -> f32) {
    sorted.clear();
    sorted.extend(agents.iter().map(|&agent| value(agent as usize)).chain([0.0; VECTOR]));
}
