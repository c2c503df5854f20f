//! Who is near: a search over grids that follow the crowd's density.
//!
//! Agents lie in cell order as structures of arrays, so a row of cells is one run of memory and is ranked several
//! agents at once. A search visits squares of cells from the inside out and stops when no cell outside can hold a
//! better neighbour. The answer does not depend on the grids.
//!
//! The nearest ten by distance alone can drop the fast approacher (which `FbCrowd` §4.4 leaves open), so the speed at
//! which the distance closes has a say: agents are ranked by a time, distance / (closing speed + 1 m/s). The time to
//! collision itself does not serve. It jumps to infinity as soon as an agent is avoided, who then would drop out, be
//! met again, and so on in turns. World, metres, seconds.

mod grid;
mod rank;

use std::ops::Range;

use glam::Vec2;

use self::grid::{Grid, Layout, Run, Window};
use self::rank::{NOBODY, VECTOR, key, offer, rank_of};
use crate::around::Around;

/// Neighbours taken: as many as RVO2's own examples take (van den Berg et al. 2011).
pub const NEIGHBOUR_COUNT: usize = 10;
/// Speed at which those who keep their distance might come, m/s. Of two at equal distance, one who comes straight on at
/// walking speed, 1.33 m/s against ours, ranks as if nearer by a factor of 3.7.
pub(crate) const APPROACH_MPS: f32 = 1.0;
/// What is guessed of the worst rank, as a multiple of the last searcher's.
const GUESS: f32 = 1.25;

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

/// The agents, sorted by cell.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
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
}

/// A search under way.
struct Search<'a> {
    query: &'a Query,
    /// Greatest speed at which anybody might come nearer, and [`APPROACH_MPS`].
    closing_mps: f32,
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

    /// The same in lanes.
    pub fn around(&self) -> &Around {
        &self.around
    }

    /// The worst rank found.
    fn worst(&self) -> f32 {
        rank_of(self.keys[NEIGHBOUR_COUNT - 1])
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
    /// Approachers are searched for far around, and whoever asked last with the same working memory was most likely
    /// near: its worst rank is a good guess of how far to look. Where it was too low, the search is made again without.
    pub fn nearest(&self, query: &Query, nearest: &mut Nearest) {
        let guess = match query.ranking {
            Ranking::Approach => GUESS * nearest.worst(),
            Ranking::Distance => 0.0,
        };
        let mut ranks = std::mem::take(&mut nearest.ranks);
        for nobody in [key(guess, u32::MAX), NOBODY].into_iter().filter(|&nobody| rank_of(nobody) > 0.0) {
            nearest.keys = [nobody; NEIGHBOUR_COUNT];
            let closing_mps = query.velocity_mps.length_squared().sqrt() + self.speed_max_mps + APPROACH_MPS;
            let mut search = Search { query, closing_mps, keys: &mut nearest.keys, ranks: &mut ranks };
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
        let position_m = search.query.position_m;
        if grid.distance_m(position_m) > search.reach_m() {
            return;
        }
        let reached = grid.within(position_m, search.reach_m());
        let nearby = Window::around(grid.cell_of(position_m), 1);
        let (mut square, mut visited) = (if guessed { reached } else { nearby }, None);
        loop {
            let reached = grid.within(position_m, search.reach_m());
            self.visit(grid, &reached.and(&square), visited, search);
            let reached = grid.within(position_m, search.reach_m());
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
        // All those found are in the query's own place, and agents in one place stand in order of index.
        if worst == 0.0 {
            return;
        }
        self.rank_all(&places, search.query, search.ranks);
        let ranks = search.ranks.chunks_exact(VECTOR);
        for (ranks, first) in ranks.zip(places.clone().step_by(VECTOR)) {
            // Nearly always nobody is better, which is told for all at once.
            if !ranks.iter().fold(false, |any, &rank| any | (rank <= worst)) {
                continue;
            }
            for (&rank, place) in ranks.iter().zip(first..places.end) {
                let agent = self.layout.agents[place];
                if rank <= worst && agent as usize != search.query.agent {
                    offer(search.keys, key(rank, agent));
                    worst = rank_of(search.keys[NEIGHBOUR_COUNT - 1]);
                }
            }
        }
    }

    /// Ranks of the agents of a run of places, and of a few more: what a vector leaves over would be ranked one by one.
    fn rank_all(&self, places: &Range<usize>, query: &Query, ranks: &mut Vec<f32>) {
        let places = places.start..places.start + places.len().next_multiple_of(VECTOR);
        let (x_m, y_m) = (&self.x_m[places.clone()], &self.y_m[places.clone()]);
        ranks.resize(places.len(), 0.0);
        match query.ranking {
            Ranking::Distance => rank::by_distance(x_m, y_m, query, ranks),
            Ranking::Approach => {
                let velocities = (&self.velocities_x_mps[places.clone()], &self.velocities_y_mps[places]);
                rank::by_approach((x_m, y_m), velocities, query, ranks);
            }
        }
    }
}

impl Search<'_> {
    /// The rank that a candidate must not exceed.
    fn worst(&self) -> f32 {
        rank_of(self.keys[NEIGHBOUR_COUNT - 1])
    }

    /// Beyond this distance nobody beats the worst candidate, even straight on and as fast as the fastest.
    fn reach_m(&self) -> f32 {
        let reach_m = match self.query.ranking {
            Ranking::Distance => self.worst().sqrt(),
            Ranking::Approach => self.worst() * self.closing_mps,
        };
        // A hair more, for rounding.
        (1.000_001 * reach_m).min(self.query.range_m)
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
                    Ranking::Approach => rank::approach_s(offset_m.length_squared(), closing),
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

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn finds_the_same_in_a_pile_and_among_the_fast(
            mut positions in vectors(15.0, 260), mut velocities in vectors(1.5, 260), fast in vectors(1e4, 2),
            pile in vectors(0.05, 200),
        ) {
            // More than a cell of the outer grid bears, so they get a grid of their own.
            positions[60..].copy_from_slice(&pile);
            velocities[59..61].copy_from_slice(&fast);
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
