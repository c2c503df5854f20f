//! Who is near: a search over grids that follow the crowd's density.
//!
//! Agents lie in cell order as structures of arrays, so a row of cells is one run of memory and is ranked several
//! agents at once. A search visits squares of cells from the inside out and stops when no cell outside can hold a
//! better neighbour. The answer does not depend on the grids.
//!
//! The nearest ten by distance alone can drop the fast approacher (`FbCrowd` §4.4, **Open**), so the speed at which the
//! distance closes has a say: agents are ranked by a time, distance / (closing speed + 1 m/s). The time to collision
//! itself does not serve. It jumps to infinity as soon as an agent is avoided, who then would drop out, be met again,
//! and so on in turns. World, metres, seconds.

mod grid;

use std::cmp::Ordering;
use std::ops::Range;

use glam::Vec2;

use self::grid::{Layout, Run, Window};
use crate::mcn::time_to_collision::disc_with_disc;

/// Neighbours taken: the number of the benchmark protocol and of RVO2 (`facts/planning.md` §3).
pub const NEIGHBOUR_COUNT: usize = 10;
/// Speed at which those who keep their distance might come, m/s. Of two at equal distance, one who comes straight on at
/// walking speed, 1.33 m/s against ours, ranks as if nearer by a factor of 3.7.
const APPROACH_MPS: f32 = 1.0;
/// Agents ranked at once: two vectors of the narrowest x86-64.
const LANES: usize = 8;
/// The key of nobody: after every key of finite rank.
const NOBODY: u64 = key(f32::INFINITY, 0);

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
}

/// The agents, sorted by cell.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    layout: Layout,
    /// Place of each agent in cell order, by index.
    places: Vec<u32>,
    // In cell order, and LANES more that are nowhere.
    x_m: Vec<f32>,
    y_m: Vec<f32>,
    velocities_x_mps: Vec<f32>,
    velocities_y_mps: Vec<f32>,
    radii_m: Vec<f32>,
    speed_max_mps: f32,
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
    /// Who comes first.
    pub ranking: Ranking,
}

/// What makes one neighbour matter more than another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ranking {
    /// Distance / (closing speed + 1 m/s): MCN.
    Approach,
    /// Distance alone: what RVO2 does.
    Distance,
}

/// Rank and index in one number, so that ties are broken by comparing once: ranks are not negative, and such floats
/// stand in the order of their bits.
const fn key(rank: f32, agent: u32) -> u64 {
    ((rank.to_bits() as u64) << 32) | agent as u64
}

impl Nearest {
    /// Best rank first.
    pub fn as_slice(&self) -> &[Neighbour] {
        &self.found
    }

    /// Puts those first that are met first (`FbCrowd` §4.4); those never met stay in order of distance. Ties by index.
    pub fn sort_by_time_to_collision(&mut self) {
        let key = |neighbour: &Neighbour| (neighbour.time_to_collision_s, neighbour.distance_m, neighbour.agent);
        self.found.sort_unstable_by(|a, b| key(a).partial_cmp(&key(b)).unwrap_or(Ordering::Equal));
    }

    /// Takes a key in where it belongs, if it does: each place keeps its own key, takes the new one, or its
    /// predecessor's.
    fn offer(&mut self, key: u64) {
        for place in (1..NEIGHBOUR_COUNT).rev() {
            self.keys[place] = self.keys[place - 1].max(self.keys[place].min(key));
        }
        self.keys[0] = self.keys[0].min(key);
    }

    /// The rank that a candidate must not exceed.
    fn worst(&self) -> f32 {
        f32::from_bits((self.keys[NEIGHBOUR_COUNT - 1] >> 32) as u32)
    }
}

impl Neighbours {
    /// Sorts the agents into cells.
    pub fn rebuild(&mut self, positions_m: &[Vec2], velocities_mps: &[Vec2], radii_m: &[f32]) {
        self.layout.rebuild(positions_m);
        let agents = &self.layout.agents;
        self.places.resize(agents.len(), 0);
        for (place, &agent) in agents.iter().enumerate() {
            self.places[agent as usize] = place as u32;
        }
        gather(&mut self.x_m, agents, |agent| positions_m[agent].x, f32::INFINITY);
        gather(&mut self.y_m, agents, |agent| positions_m[agent].y, f32::INFINITY);
        gather(&mut self.velocities_x_mps, agents, |agent| velocities_mps[agent].x, 0.0);
        gather(&mut self.velocities_y_mps, agents, |agent| velocities_mps[agent].y, 0.0);
        gather(&mut self.radii_m, agents, |agent| radii_m[agent], 0.0);
        self.speed_max_mps = velocities_mps.iter().map(|velocity| velocity.length()).fold(0.0, f32::max);
    }

    /// All agents in cell order. Whoever takes them in this order finds the neighbours of one in the cache for the
    /// next.
    pub fn in_cell_order(&self) -> &[u32] {
        &self.layout.agents
    }

    /// The best-ranked agents within range.
    pub fn nearest(&self, query: &Query, nearest: &mut Nearest) {
        nearest.keys = [NOBODY; NEIGHBOUR_COUNT];
        if !self.places.is_empty() {
            self.search(0, query, nearest);
        }
        nearest.found.clear();
        let found = nearest.keys.iter().take_while(|&&key| key < NOBODY);
        nearest.found.extend(found.map(|&key| self.neighbour(key as u32, query)));
    }

    /// Visits ever larger squares of a grid's cells around the query, until no cell outside can hold a better
    /// candidate.
    fn search(&self, grid: usize, query: &Query, nearest: &mut Nearest) {
        let grid = &self.layout.grids[grid];
        if grid.distance_m(query.position_m) > self.reach_m(query, nearest) {
            return;
        }
        let centre = grid.cell_of(query.position_m);
        let (mut ring, mut visited) = (1, None);
        loop {
            let square = Window::around(centre, ring);
            let reached = square.and(&grid.within(query.position_m, self.reach_m(query, nearest)));
            for row in reached.rows[0]..=reached.rows[1] {
                for columns in unvisited(reached.columns, row, visited) {
                    self.layout.runs(grid, row, columns, |run| match run {
                        Run::Places(places) => self.scan(places, query, nearest),
                        Run::Grid(inner) => self.search(inner, query, nearest),
                    });
                }
            }
            let within = grid.within(query.position_m, self.reach_m(query, nearest));
            if within.and(&square) == within {
                return;
            }
            (ring, visited) = (2 * ring, Some(square));
        }
    }

    /// Offers the agents of some places, a few at a time.
    fn scan(&self, places: Range<usize>, query: &Query, nearest: &mut Nearest) {
        for first in places.clone().step_by(LANES) {
            let ranks = self.ranks(first, query);
            let worst = nearest.worst();
            // Those whom nobody of the own place can beat: agents in one place stand in order of index.
            if worst == 0.0 {
                return;
            }
            if !ranks.iter().any(|&rank| rank <= worst) {
                continue;
            }
            for (place, rank) in (first..places.end).zip(ranks) {
                let agent = self.layout.agents[place];
                if rank <= nearest.worst() && agent as usize != query.agent {
                    nearest.offer(key(rank, agent));
                }
            }
        }
    }

    /// Ranks of the agents from a place on: a time in s, or a squared distance in m²; infinite beyond the range.
    #[inline]
    fn ranks(&self, first: usize, query: &Query) -> [f32; LANES] {
        let lanes = |values: &[f32]| -> [f32; LANES] { std::array::from_fn(|lane| values[first..first + LANES][lane]) };
        let x_m = lanes(&self.x_m).map(|x_m| x_m - query.position_m.x);
        let y_m = lanes(&self.y_m).map(|y_m| y_m - query.position_m.y);
        let squared: [f32; LANES] = std::array::from_fn(|lane| x_m[lane] * x_m[lane] + y_m[lane] * y_m[lane]);
        let ranks = match query.ranking {
            Ranking::Distance => squared,
            Ranking::Approach => {
                let vx_mps = lanes(&self.velocities_x_mps).map(|x_mps| query.velocity_mps.x - x_mps);
                let vy_mps = lanes(&self.velocities_y_mps).map(|y_mps| query.velocity_mps.y - y_mps);
                std::array::from_fn(|lane| {
                    approach_s(squared[lane], x_m[lane] * vx_mps[lane] + y_m[lane] * vy_mps[lane])
                })
            }
        };
        let range_squared = query.range_m * query.range_m;
        std::array::from_fn(|lane| if squared[lane] <= range_squared { ranks[lane] } else { f32::INFINITY })
    }

    /// Beyond this distance nobody beats the worst candidate, even straight on and as fast as the fastest.
    fn reach_m(&self, query: &Query, nearest: &Nearest) -> f32 {
        let worst = nearest.worst();
        let reach_m = match query.ranking {
            Ranking::Distance => worst.sqrt(),
            Ranking::Approach => worst * (query.velocity_mps.length() + self.speed_max_mps + APPROACH_MPS),
        };
        // A hair more, for rounding.
        (1.000_001 * reach_m).min(query.range_m)
    }

    /// What there is to know of one chosen.
    fn neighbour(&self, agent: u32, query: &Query) -> Neighbour {
        let place = self.places[agent as usize] as usize;
        let offset_m = Vec2::new(self.x_m[place], self.y_m[place]) - query.position_m;
        let velocity_mps = query.velocity_mps - Vec2::new(self.velocities_x_mps[place], self.velocities_y_mps[place]);
        let radius_m = query.radius_m + self.radii_m[place];
        Neighbour {
            agent,
            offset_m,
            velocity_mps,
            radius_m,
            distance_m: offset_m.length(),
            time_to_collision_s: disc_with_disc(offset_m, velocity_mps, radius_m),
        }
    }
}

/// Distance / (closing speed + 1 m/s), s, multiplied out so that nobody in the same place has a rank but 0: the square
/// of the distance, and offset · velocity.
fn approach_s(distance_squared: f32, closing: f32) -> f32 {
    let closing = if closing > 0.0 { closing } else { 0.0 };
    let across = closing + APPROACH_MPS * distance_squared.sqrt();
    distance_squared / if across > f32::MIN_POSITIVE { across } else { f32::MIN_POSITIVE }
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

/// The values of the agents in cell order, and [`LANES`] times `beyond`.
fn gather(sorted: &mut Vec<f32>, agents: &[u32], value: impl Fn(usize) -> f32, beyond: f32) {
    sorted.clear();
    sorted.extend(agents.iter().map(|&agent| value(agent as usize)).chain([beyond; LANES]));
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn by_brute_force(query: &Query, positions_m: &[Vec2], velocities_mps: &[Vec2]) -> Vec<u32> {
        let mut ranked: Vec<(f32, u32)> = (0..positions_m.len())
            .filter(|&other| other != query.agent)
            .map(|other| (positions_m[other] - query.position_m, other))
            .filter(|(offset_m, _)| offset_m.length_squared() <= query.range_m * query.range_m)
            .map(|(offset_m, other)| {
                let closing = (query.velocity_mps - velocities_mps[other]).dot(offset_m);
                let rank = match query.ranking {
                    Ranking::Approach => approach_s(offset_m.length_squared(), closing),
                    Ranking::Distance => offset_m.length_squared(),
                };
                (rank, other as u32)
            })
            .collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        ranked.into_iter().take(NEIGHBOUR_COUNT).map(|(_, other)| other).collect()
    }

    fn check(positions_m: &[Vec2], velocities_mps: &[Vec2], range_m: f32) {
        check_ranked(Ranking::Approach, positions_m, velocities_mps, range_m);
        check_ranked(Ranking::Distance, positions_m, velocities_mps, range_m);
    }

    fn check_ranked(ranking: Ranking, positions_m: &[Vec2], velocities_mps: &[Vec2], range_m: f32) {
        let radii_m = vec![0.25; positions_m.len()];
        let mut neighbours = Neighbours::default();
        neighbours.rebuild(positions_m, velocities_mps, &radii_m);
        let mut nearest = Nearest::default();
        for agent in 0..positions_m.len() {
            let query = Query {
                agent,
                position_m: positions_m[agent],
                velocity_mps: velocities_mps[agent],
                radius_m: radii_m[agent],
                range_m,
                ranking,
            };
            neighbours.nearest(&query, &mut nearest);
            let found: Vec<u32> = nearest.as_slice().iter().map(|neighbour| neighbour.agent).collect();
            assert_eq!(found, by_brute_force(&query, positions_m, velocities_mps));
        }
    }

    fn vectors(bound: f32, count: usize) -> impl Strategy<Value = Vec<Vec2>> {
        proptest::collection::vec((-bound..bound, -bound..bound).prop_map(Vec2::from), count)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn finds_what_a_full_search_finds(
            positions in vectors(15.0, 120), velocities in vectors(1.5, 120), range in 1.0f32..12.0,
        ) {
            check(&positions, &velocities, range);
        }

        #[test]
        fn finds_the_same_in_a_crowd_with_stragglers(
            mut positions in vectors(2.0, 60), velocities in vectors(1.5, 60), far in vectors(300.0, 3),
        ) {
            positions[..3].copy_from_slice(&far);
            check(&positions, &velocities, 10.0);
        }
    }

    #[test]
    fn breaks_ties_by_index_and_bears_coinciding_agents() {
        check(&[Vec2::ZERO; 30], &[Vec2::ZERO; 30], 10.0);
        check(&[], &[], 10.0);
        check(&[Vec2::new(1e4, -7.0)], &[Vec2::X], 10.0);
    }

    #[test]
    fn prefers_the_fast_approacher_to_a_nearer_companion() {
        let mut positions_m: Vec<Vec2> = (0..11).map(|index| Vec2::new(0.0, 1.0 + 0.4 * index as f32)).collect();
        let mut velocities_mps = vec![Vec2::X; 11];
        positions_m[0] = Vec2::ZERO;
        positions_m.push(Vec2::new(6.0, 0.0));
        velocities_mps.push(-Vec2::X);
        let mut neighbours = Neighbours::default();
        neighbours.rebuild(&positions_m, &velocities_mps, &[0.25; 12]);
        for (ranking, taken) in [(Ranking::Approach, true), (Ranking::Distance, false)] {
            let (position_m, velocity_mps) = (Vec2::ZERO, Vec2::X);
            let query = Query { agent: 0, position_m, velocity_mps, radius_m: 0.25, range_m: 10.0, ranking };
            let mut nearest = Nearest::default();
            neighbours.nearest(&query, &mut nearest);
            assert_eq!(nearest.as_slice().iter().any(|neighbour| neighbour.agent == 11), taken);
        }
    }
}
