//! Who is near: a grid sorted by cell, whose cell follows the crowd's density.
//!
//! Agents lie in cell order as structures of arrays, so a row of cells is one run of memory. A search visits square
//! rings of cells from the inside out and stops when no farther ring can hold a better neighbour. The answer does not
//! depend on the grid.
//!
//! The nearest ten by distance alone can drop the fast approacher (`FbCrowd` §4.4, **Open**), so the speed at which the
//! distance closes has a say: agents are ranked by a time, distance / (closing speed + 1 m/s). The time to collision
//! itself does not serve. It jumps to infinity as soon as an agent is avoided, who then would drop out, be met again,
//! and so on in turns. World, metres, seconds.

use std::cmp::Ordering;

use glam::Vec2;

use crate::mcn::time_to_collision::disc_with_disc;

/// Neighbours taken: the number of the benchmark protocol and of RVO2 (`facts/planning.md` §3).
pub const NEIGHBOUR_COUNT: usize = 10;
/// Speed at which those who keep their distance might come, m/s. Of two at equal distance, one who comes straight on at
/// walking speed, 1.33 m/s against ours, ranks as if nearer by a factor of 3.7.
const APPROACH_MPS: f32 = 1.0;
/// Agents to a cell, on average; from 1 to 3 the time of a search hardly changes.
const AGENTS_PER_CELL: f32 = 2.0;
/// Least side of a cell, m: the diameter of a body.
const CELL_MIN_M: f32 = 0.5;

/// One neighbour found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// Index of the agent.
    pub agent: u32,
    /// Between the discs at their present velocities; infinite where they do not meet, 0 where they overlap.
    pub time_to_collision_s: f32,
    /// Between the centres.
    pub distance_m: f32,
}

/// At most [`NEIGHBOUR_COUNT`] neighbours, best rank first, ties by index.
#[derive(Clone, Debug, Default)]
pub struct Nearest {
    found: Vec<Neighbour>,
    candidates: Vec<Candidate>,
}

/// All that the search itself needs to know of an agent.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    rank_s: f32,
    agent: u32,
    /// Index in cell order.
    place: u32,
}

/// The agents, sorted by cell.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    origin_m: Vec2,
    cell_m: f32,
    columns: usize,
    rows: usize,
    /// Index of each cell's first agent, row by row, and the number of agents.
    starts: Vec<u32>,
    /// Cell of each agent, in index order.
    cells: Vec<u32>,
    /// From here on in cell order.
    agents: Vec<u32>,
    positions_m: Vec<Vec2>,
    velocities_mps: Vec<Vec2>,
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
    /// For the times to collision.
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

    /// Takes a candidate in where it belongs.
    fn offer(&mut self, candidate: Candidate) {
        let before = |other: &Candidate| (other.rank_s, other.agent) < (candidate.rank_s, candidate.agent);
        let place = self.candidates.iter().rposition(before).map_or(0, |index| index + 1);
        if place < NEIGHBOUR_COUNT {
            self.candidates.truncate(NEIGHBOUR_COUNT - 1);
            self.candidates.insert(place, candidate);
        }
    }

    /// Rank that a candidate has to beat, s.
    fn worst_s(&self) -> f32 {
        if self.candidates.len() < NEIGHBOUR_COUNT {
            f32::INFINITY
        } else {
            self.candidates[NEIGHBOUR_COUNT - 1].rank_s
        }
    }
}

impl Neighbours {
    /// Sorts the agents into cells.
    pub fn rebuild(&mut self, positions_m: &[Vec2], velocities_mps: &[Vec2], radii_m: &[f32]) {
        self.lay_out(positions_m);
        self.sort(positions_m);
        let agents = &self.agents;
        gather(&mut self.positions_m, agents, positions_m);
        gather(&mut self.velocities_mps, agents, velocities_mps);
        gather(&mut self.radii_m, agents, radii_m);
        self.speed_max_mps = velocities_mps.iter().map(|velocity| velocity.length()).fold(0.0, f32::max);
    }

    /// Chooses the cell: the box of all agents, [`AGENTS_PER_CELL`] to a cell on average.
    fn lay_out(&mut self, positions_m: &[Vec2]) {
        let least_m = positions_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let most_m = positions_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        let size_m = (most_m - least_m).max(Vec2::ZERO);
        let count = positions_m.len().max(1) as f32;
        let by_density_m = (size_m.x * size_m.y * AGENTS_PER_CELL / count).sqrt();
        // A long file of agents has no area; its length over their number bounds the number of cells.
        let by_length_m = (size_m.x + size_m.y) / count;
        self.cell_m = by_density_m.max(by_length_m).max(CELL_MIN_M);
        self.origin_m = if positions_m.is_empty() { Vec2::ZERO } else { least_m };
        self.columns = (size_m.x / self.cell_m) as usize + 1;
        self.rows = (size_m.y / self.cell_m) as usize + 1;
    }

    /// Counting sort by cell; within a cell the agents stay in order of index.
    fn sort(&mut self, positions_m: &[Vec2]) {
        self.cells.clear();
        for &position_m in positions_m {
            let [column, row] = self.cell_of(position_m);
            self.cells.push((row * self.columns + column) as u32);
        }
        self.starts.clear();
        self.starts.resize(self.columns * self.rows + 1, 0);
        for &cell in &self.cells {
            self.starts[cell as usize + 1] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        // Each start runs through its cell, until it is the next one's; one place to the right, all are right again.
        self.agents.clear();
        self.agents.resize(self.cells.len(), 0);
        for (agent, &cell) in self.cells.iter().enumerate() {
            let place = &mut self.starts[cell as usize];
            self.agents[*place as usize] = agent as u32;
            *place += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// Column and row of a position; positions outside the grid belong to its border.
    fn cell_of(&self, position_m: Vec2) -> [usize; 2] {
        let cell = (position_m - self.origin_m) / self.cell_m;
        [(cell.x as usize).min(self.columns - 1), (cell.y as usize).min(self.rows - 1)]
    }

    /// The best-ranked agents within range.
    pub fn nearest(&self, query: &Query, nearest: &mut Nearest) {
        nearest.candidates.clear();
        self.search(query, nearest);
        nearest.found.clear();
        nearest.found.extend(nearest.candidates.iter().map(|candidate| self.neighbour(candidate, query)));
    }

    /// Visits the rings of cells around the query, until none can hold a better candidate.
    fn search(&self, query: &Query, nearest: &mut Nearest) {
        if self.agents.is_empty() {
            return;
        }
        let [column, row] = self.cell_of(query.position_m);
        let closing_mps = match query.ranking {
            Ranking::Approach => query.velocity_mps.length() + self.speed_max_mps,
            Ranking::Distance => 0.0,
        };
        for ring in 0..self.columns.max(self.rows) {
            // A ring's cells lie behind all rings inside it.
            let closest_m = ring.saturating_sub(1) as f32 * self.cell_m;
            if closest_m > reach_m(query, closing_mps, nearest) {
                break;
            }
            let rows = row.saturating_sub(ring)..=(row + ring).min(self.rows - 1);
            for visited in rows {
                if visited.abs_diff(row) == ring {
                    let columns = [column.saturating_sub(ring), (column + ring).min(self.columns - 1)];
                    self.scan(visited, columns, query, closing_mps, nearest);
                } else {
                    let sides = [column.checked_sub(ring), Some(column + ring).filter(|&side| side < self.columns)];
                    for side in sides.into_iter().flatten() {
                        self.scan(visited, [side, side], query, closing_mps, nearest);
                    }
                }
            }
        }
    }

    /// Offers the agents of a run of cells of one row.
    fn scan(&self, row: usize, columns: [usize; 2], query: &Query, closing_mps: f32, nearest: &mut Nearest) {
        let [first, last] = columns.map(|column| row * self.columns + column);
        let mut reach_m = reach_m(query, closing_mps, nearest);
        for place in self.starts[first] as usize..self.starts[last + 1] as usize {
            let offset_m = self.positions_m[place] - query.position_m;
            let distance_squared = offset_m.length_squared();
            if distance_squared > reach_m * reach_m {
                continue;
            }
            let velocity_mps = match query.ranking {
                Ranking::Approach => query.velocity_mps - self.velocities_mps[place],
                Ranking::Distance => Vec2::ZERO,
            };
            let rank_s = rank_s(offset_m, distance_squared.sqrt(), velocity_mps);
            let agent = self.agents[place];
            if rank_s <= nearest.worst_s() && agent as usize != query.agent {
                nearest.offer(Candidate { rank_s, agent, place: place as u32 });
                reach_m = self::reach_m(query, closing_mps, nearest);
            }
        }
    }

    /// What there is to know of a chosen candidate.
    fn neighbour(&self, candidate: &Candidate, query: &Query) -> Neighbour {
        let place = candidate.place as usize;
        let offset_m = self.positions_m[place] - query.position_m;
        let velocity_mps = query.velocity_mps - self.velocities_mps[place];
        Neighbour {
            agent: candidate.agent,
            time_to_collision_s: disc_with_disc(offset_m, velocity_mps, query.radius_m + self.radii_m[place]),
            distance_m: offset_m.length(),
        }
    }
}

/// Beyond this distance nobody beats the worst candidate, even straight on and as fast as the fastest.
fn reach_m(query: &Query, closing_mps: f32, nearest: &Nearest) -> f32 {
    (nearest.worst_s() * (closing_mps + APPROACH_MPS)).min(query.range_m)
}

/// Distance / (closing speed + 1 m/s); `velocity` is the searcher's against the other's.
fn rank_s(offset_m: Vec2, distance_m: f32, velocity_mps: Vec2) -> f32 {
    let closing_mps = (velocity_mps.dot(offset_m) / distance_m.max(f32::MIN_POSITIVE)).max(0.0);
    distance_m / (closing_mps + APPROACH_MPS)
}

/// The values of the agents in cell order.
fn gather<T: Copy>(sorted: &mut Vec<T>, agents: &[u32], values: &[T]) {
    sorted.clear();
    sorted.extend(agents.iter().map(|&agent| values[agent as usize]));
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
                let velocity_mps = match query.ranking {
                    Ranking::Approach => query.velocity_mps - velocities_mps[other],
                    Ranking::Distance => Vec2::ZERO,
                };
                (rank_s(offset_m, offset_m.length(), velocity_mps), other as u32)
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
