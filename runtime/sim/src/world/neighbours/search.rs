//! The search for the best-ranked neighbours, over grids that follow the crowd's density (`FbCrowd` §4.4).
//!
//! The paper leaves open which neighbours count. The nearest ten by distance can drop a fast approacher, so MCN ranks
//! by approach (`rank`). The time to collision itself does not serve as a rank: it jumps to infinity as soon as the
//! agents avoid each other, so the neighbour drops out, is met again, and so on in turns.
//!
//! Agents lie in cell order as structures of arrays: a row of cells is one run of memory, of which several agents are
//! ranked at once. The cells are laid over the agents' midpoints, their positions at T/2. Within T no agent is farther
//! from its midpoint than half of its path, so a search by approach reaches hardly farther than one by distance.
//! A search visits squares of cells from the inside out and stops when no cell outside can hold a better neighbour. The
//! result does not depend on the cells. World, metres, seconds.

use std::ops::Range;

use glam::Vec2;

use crate::world::neighbours::cell_layout::{CellGrid, CellLayout, CellRun, CellWindow};
use crate::world::neighbours::neighbour::{NEIGHBOUR_COUNT, Neighbour, NeighbourQuery};
use crate::world::neighbours::neighbour_lanes::NeighbourLanes;
use crate::world::neighbours::rank::{self, NO_KEY, VECTOR, insert, key, squared_of};

/// Guess of the worst squared rank, as a multiple of the last query's: a quarter farther.
const GUESS: f32 = 1.25 * 1.25;
/// Shift of a position by rounding, as a share of the greatest coordinate: some units in the last place of f32.
const ROUNDING: f32 = 1e-6;

/// The agents of a crowd, sorted into cells for queries; rebuilt every step.
#[derive(Clone, Debug, Default)]
pub struct NeighbourSearch {
    /// T: ranking horizon, s.
    horizon_s: f32,
    /// Cells over the agents' midpoints.
    layout: CellLayout,
    /// Slot of each agent in cell order, by index.
    slots: Vec<u32>,
    // In cell order, padded by one vector.
    x_m: Vec<f32>,
    y_m: Vec<f32>,
    velocities_x_mps: Vec<f32>,
    velocities_y_mps: Vec<f32>,
    radii_m: Vec<f32>,
    /// Greatest speed of any agent, m/s.
    speed_max_mps: f32,
    /// Greatest coordinate of any midpoint, m.
    extent_m: f32,
    /// Midpoints by agent, m: working memory.
    midpoints_m: Vec<Vec2>,
}

/// The result of a query: at most [`NEIGHBOUR_COUNT`] neighbours, best rank first, ties by index.
#[derive(Clone, Debug, Default)]
pub struct NearestNeighbours {
    keys: [u64; NEIGHBOUR_COUNT],
    found: Vec<Neighbour>,
    lanes: NeighbourLanes,
    /// Squared ranks of one run of agents, m²: working memory.
    ranks: Vec<f32>,
}

/// The state of one query.
struct OngoingQuery<'a> {
    query: &'a NeighbourQuery,
    /// The searcher's midpoint, m.
    midpoint_m: Vec2,
    /// Greatest distance by which an agent comes nearer than at T/2, and rounding, m.
    half_path_m: f32,
    /// The best keys so far, sorted.
    keys: &'a mut [u64; NEIGHBOUR_COUNT],
    /// Working memory.
    ranks: &'a mut Vec<f32>,
}

impl NearestNeighbours {
    /// Bytes that the lists hold on the heap.
    pub(crate) fn heap_bytes(&self) -> usize {
        self.found.capacity() * size_of::<Neighbour>() + self.ranks.capacity() * size_of::<f32>()
    }

    /// The neighbours, best rank first.
    pub fn as_slice(&self) -> &[Neighbour] {
        &self.found
    }

    /// The same neighbours in the same order, as arrays.
    pub fn lanes(&self) -> &NeighbourLanes {
        &self.lanes
    }

    /// Keeps the neighbours of which `is_kept` holds.
    pub(crate) fn retain(&mut self, is_kept: impl Fn(&Neighbour) -> bool) {
        let before = self.found.len();
        self.found.retain(is_kept);
        if self.found.len() < before {
            self.lanes = NeighbourLanes::default();
            for (lane, neighbour) in self.found.iter().enumerate() {
                self.lanes.set(lane, neighbour.offset_m, neighbour.relative_mps, neighbour.radius_m);
            }
        }
    }

    /// Square of the worst rank found, m².
    fn worst(&self) -> f32 {
        squared_of(self.keys[NEIGHBOUR_COUNT - 1])
    }
}

impl NeighbourSearch {
    /// Sorts the agents into cells, to be ranked by approach within `horizon_s`; by distance where that is 0.
    pub fn rebuild(&mut self, positions_m: &[Vec2], velocities_mps: &[Vec2], radii_m: &[f32], horizon_s: f32) {
        self.horizon_s = horizon_s;
        self.midpoints_m.clear();
        let moving = positions_m.iter().zip(velocities_mps);
        self.midpoints_m.extend(moving.map(|(&position_m, &velocity_mps)| position_m + 0.5 * horizon_s * velocity_mps));
        self.extent_m = self.midpoints_m.iter().map(|midpoint_m| midpoint_m.abs().max_element()).fold(0.0, f32::max);
        self.layout.rebuild(&self.midpoints_m);
        let agents = &self.layout.agents;
        self.slots.resize(agents.len(), 0);
        for (slot, &agent) in agents.iter().enumerate() {
            self.slots[agent as usize] = slot as u32;
        }
        gather(&mut self.x_m, agents, |agent| positions_m[agent].x);
        gather(&mut self.y_m, agents, |agent| positions_m[agent].y);
        gather(&mut self.velocities_x_mps, agents, |agent| velocities_mps[agent].x);
        gather(&mut self.velocities_y_mps, agents, |agent| velocities_mps[agent].y);
        gather(&mut self.radii_m, agents, |agent| radii_m[agent]);
        self.speed_max_mps = velocities_mps.iter().map(|velocity| velocity.length()).fold(0.0, f32::max);
    }

    /// All agents in cell order. In this order, the neighbours of one agent are in the cache for the next.
    pub fn in_cell_order(&self) -> &[u32] {
        &self.layout.agents
    }

    /// Finds the best-ranked agents within range.
    ///
    /// The last query with the same working memory was most likely near, so its worst rank guesses how far to look for
    /// approachers. Where the guess was too low, the search starts again without it.
    pub fn nearest(&self, query: &NeighbourQuery, nearest: &mut NearestNeighbours) {
        let guess = if self.horizon_s > 0.0 { GUESS * nearest.worst() } else { 0.0 };
        let midpoint_m = query.position_m + 0.5 * self.horizon_s * query.velocity_mps;
        let speeds_mps = query.velocity_mps.length_squared().sqrt() + self.speed_max_mps;
        let half_path_m = (1.0 + ROUNDING) * 0.5 * self.horizon_s * speeds_mps + ROUNDING * self.extent_m;
        let mut ranks = std::mem::take(&mut nearest.ranks);
        for empty in [key(guess, u32::MAX), NO_KEY].into_iter().filter(|&empty| squared_of(empty) > 0.0) {
            nearest.keys = [empty; NEIGHBOUR_COUNT];
            let mut ongoing =
                OngoingQuery { query, midpoint_m, half_path_m, keys: &mut nearest.keys, ranks: &mut ranks };
            self.search(0, empty < NO_KEY, &mut ongoing);
            if nearest.keys[NEIGHBOUR_COUNT - 1] < empty {
                break;
            }
        }
        nearest.ranks = ranks;
        self.describe(query, nearest);
    }

    /// Fills in offsets, velocities and times to collision of the keys found.
    fn describe(&self, query: &NeighbourQuery, nearest: &mut NearestNeighbours) {
        nearest.lanes = NeighbourLanes::default();
        let count = nearest.keys.iter().take_while(|&&key| key < NO_KEY).count();
        for lane in 0..count {
            let slot = self.slots[nearest.keys[lane] as u32 as usize] as usize;
            let offset_m = Vec2::new(self.x_m[slot], self.y_m[slot]) - query.position_m;
            let relative_mps = query.velocity_mps - Vec2::new(self.velocities_x_mps[slot], self.velocities_y_mps[slot]);
            nearest.lanes.set(lane, offset_m, relative_mps, query.radius_m + self.radii_m[slot]);
        }
        let times_s = nearest.lanes.times_to_collision_s(Vec2::ZERO);
        nearest.found.clear();
        nearest
            .found
            .extend((0..count).map(|lane| nearest.lanes.neighbour(lane, nearest.keys[lane] as u32, times_s[lane])));
    }

    /// Visits ever larger squares of a grid's cells around the query, until no cell outside can hold a better
    /// candidate. With enough candidates, or a guess, the worst of them bounds the reach.
    fn search(&self, grid: usize, guessed: bool, ongoing: &mut OngoingQuery) {
        let Some(grid) = self.layout.grids.get(grid) else { return };
        let midpoint_m = ongoing.midpoint_m;
        if grid.distance_m(midpoint_m) > ongoing.reach_m() {
            return;
        }
        let reached = grid.within(midpoint_m, ongoing.reach_m());
        let nearby = CellWindow::around(grid.cell_of(midpoint_m), 1);
        let (mut square, mut visited) = (if guessed { reached } else { nearby }, None);
        loop {
            let reached = grid.within(midpoint_m, ongoing.reach_m());
            self.visit(grid, &reached.and(&square), visited, ongoing);
            let reached = grid.within(midpoint_m, ongoing.reach_m());
            if reached.and(&square) == reached {
                return;
            }
            let enough = ongoing.keys[NEIGHBOUR_COUNT - 1] < NO_KEY;
            (square, visited) = (if enough { reached } else { square.doubled() }, Some(square));
        }
    }

    /// Scans the cells of a window that were not visited.
    fn visit(&self, grid: &CellGrid, window: &CellWindow, visited: Option<CellWindow>, ongoing: &mut OngoingQuery) {
        for row in window.rows[0]..=window.rows[1] {
            for columns in unvisited(window.columns, row, visited) {
                self.layout.runs(grid, row, columns, |run| match run {
                    CellRun::Slots(slots) => self.scan(slots, ongoing),
                    CellRun::Grid(inner) => self.search(inner, false, ongoing),
                });
            }
        }
    }

    /// Inserts the agents of a run of slots that are better than the worst so far.
    fn scan(&self, slots: Range<usize>, ongoing: &mut OngoingQuery) {
        let mut worst = ongoing.worst();
        self.rank_all(&slots, ongoing.query, ongoing.ranks);
        let ranks = ongoing.ranks.chunks_exact(VECTOR);
        for (ranks, first) in ranks.zip(slots.clone().step_by(VECTOR)) {
            // Nearly always no agent is better, which one test of the whole vector shows.
            let mut better = rank::better(ranks, worst) & ((1 << (slots.end - first).min(VECTOR)) - 1);
            while better != 0 {
                let lane = better.trailing_zeros() as usize;
                better &= better - 1;
                let agent = self.layout.agents[first + lane];
                if agent as usize != ongoing.query.agent {
                    insert(ongoing.keys, key(ranks[lane], agent));
                    worst = ongoing.worst();
                }
            }
        }
    }

    /// Squared ranks of a run of slots, rounded up to whole vectors: a remainder would be ranked one by one.
    fn rank_all(&self, slots: &Range<usize>, query: &NeighbourQuery, ranks: &mut Vec<f32>) {
        let slots = slots.start..slots.start + slots.len().next_multiple_of(VECTOR);
        let (x_m, y_m) = (&self.x_m[slots.clone()], &self.y_m[slots.clone()]);
        ranks.resize(slots.len(), 0.0);
        if self.horizon_s > 0.0 {
            let velocities = (&self.velocities_x_mps[slots.clone()], &self.velocities_y_mps[slots]);
            rank::by_approach((x_m, y_m), velocities, query, self.horizon_s, ranks);
        } else {
            rank::by_distance(x_m, y_m, query, ranks);
        }
    }
}

impl OngoingQuery<'_> {
    /// Square of the rank that a candidate must not exceed, m².
    fn worst(&self) -> f32 {
        squared_of(self.keys[NEIGHBOUR_COUNT - 1])
    }

    /// Beyond this distance of midpoints no agent is in range and beats the worst candidate, not even one that comes
    /// straight on at the greatest speed, m.
    fn reach_m(&self) -> f32 {
        (1.0 + ROUNDING) * self.worst().sqrt().min(self.query.range_m) + self.half_path_m
    }
}

/// The columns of a row that were not visited: left and right of the visited window, or all.
fn unvisited([first, last]: [i32; 2], row: i32, visited: Option<CellWindow>) -> impl Iterator<Item = [i32; 2]> {
    let crossed = visited.filter(|window| (window.rows[0]..=window.rows[1]).contains(&row));
    let sides = match crossed {
        Some(CellWindow { columns: [left, right], .. }) => [[first, last.min(left - 1)], [first.max(right + 1), last]],
        None => [[first, last], [0, -1]],
    };
    sides.into_iter().filter(|[first, last]| first <= last)
}

/// One value of every agent in cell order, padded by a vector of zeros.
fn gather(sorted: &mut Vec<f32>, agents: &[u32], value: impl Fn(usize) -> f32) {
    sorted.clear();
    sorted.extend(agents.iter().map(|&agent| value(agent as usize)).chain([0.0; VECTOR]));
}
