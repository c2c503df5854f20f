//! Egress: the times at which agents leave the scene. Seconds.

use serde::Serialize;

use crate::population::Population;

/// The times at which agents were removed. A percentile is the least time by which that share of the agents that left
/// has left (nearest rank).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EgressMeasures {
    /// Number of agents that left.
    pub left: usize,
    /// Number of agents that are still there at the end.
    pub remaining: usize,
    /// Time by which 10 % of those that left have left, s.
    pub percentile_10_s: Option<f64>,
    /// Time by which half of them have left, s.
    pub percentile_50_s: Option<f64>,
    /// Time by which 90 % of them have left, s.
    pub percentile_90_s: Option<f64>,
    /// Time by which 95 % of them have left, s.
    pub percentile_95_s: Option<f64>,
    /// Time at which the last of them left, s.
    pub last_s: Option<f64>,
    /// Times of all removals, ascending, s.
    pub times_s: Vec<f64>,
}

impl EgressMeasures {
    /// The egress of a population.
    pub(crate) fn of(population: &Population, dt_s: f64) -> Self {
        let frames = population.agents.iter().filter_map(|life| life.removed);
        let mut times_s: Vec<f64> = frames.map(|frame| f64::from(frame) * dt_s).collect();
        times_s.sort_by(f64::total_cmp);
        let percentile_s = |percent: usize| {
            let rank = (percent * times_s.len()).div_ceil(100).max(1);
            times_s.get(rank - 1).copied()
        };
        Self {
            left: times_s.len(),
            remaining: population.agents.len() - times_s.len(),
            percentile_10_s: percentile_s(10),
            percentile_50_s: percentile_s(50),
            percentile_90_s: percentile_s(90),
            percentile_95_s: percentile_s(95),
            last_s: percentile_s(100),
            times_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::population::AgentLife;
    use crate::scenario::AgentSpec;

    #[test]
    fn percentiles_are_those_of_the_nearest_rank() {
        let life = |removed| AgentLife { removed, ..AgentLife::new(AgentSpec::default(), None, 0) };
        let frames = (1..=20).rev().map(|frame| life(Some(10 * frame))).chain([life(None)]);
        let population = Population { agents: frames.collect(), ..Population::default() };
        let egress = EgressMeasures::of(&population, 0.1);
        assert_eq!((egress.left, egress.remaining), (20, 1));
        assert_eq!(
            [
                egress.percentile_10_s,
                egress.percentile_50_s,
                egress.percentile_90_s,
                egress.percentile_95_s,
                egress.last_s
            ],
            [2.0, 10.0, 18.0, 19.0, 20.0].map(Some)
        );
        let nothing = EgressMeasures::of(&Population::default(), 0.1);
        assert_eq!((nothing.left, nothing.last_s), (0, None));
    }
}
