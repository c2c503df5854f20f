//! How an agent chooses one of the areas that have room for it. World, metres, seconds.

use serde::{Deserialize, Serialize};

use crate::behaviour::goals::GoalSet;
use crate::maths::random::SplitMix64;

/// Agents that pass a metre of an exit in a second, as handbooks count; real exits pass 1.3 to 2.5.
const PASSING_PER_M_S: f32 = 2.0;
/// Least width of an exit, m: one agent wide.
const EXIT_WIDTH_MIN_M: f32 = 0.5;

/// How an agent chooses an area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Choice {
    /// The area with the shortest route.
    #[default]
    Nearest,
    /// The area with the longest route.
    Farthest,
    /// Any, with equal chances.
    Random,
    /// Any, with chances in proportion to the weights.
    Weighted,
    /// The nearest of a number of areas drawn by weight.
    NearestOf(u32),
    /// The area with the least time to reach and pass it: route over speed, and agents ahead over its width.
    LeastBusy,
}

/// What a choice depends on.
pub(crate) struct Options<'a> {
    pub(crate) set: &'a GoalSet,
    /// Indices of the areas with room, ascending.
    pub(crate) free: &'a [usize],
    /// Number of agents on a shorter route to an area, given the length of this agent's, m.
    pub(crate) ahead: &'a dyn Fn(usize, f32) -> usize,
    /// Length of the route to an area, m; none where there is no route.
    pub(crate) route_m: &'a dyn Fn(usize) -> Option<f32>,
    /// Speed of the agent, m/s.
    pub(crate) speed_mps: f32,
}

impl Choice {
    /// Index of the chosen area; none where no area with room can be reached.
    pub(crate) fn choose(self, options: &Options, random: &mut SplitMix64) -> Option<usize> {
        let reachable = |&area: &usize| (options.route_m)(area).is_some();
        match self {
            Self::Nearest => least(options.free, |area| (options.route_m)(area)),
            Self::Farthest => least(options.free, |area| (options.route_m)(area).map(|route_m| -route_m)),
            Self::LeastBusy => least(options.free, |area| options.time_s(area)),
            Self::Random => {
                let areas: Vec<usize> = options.free.iter().copied().filter(reachable).collect();
                draw(&areas, |_| 1.0, random)
            }
            Self::Weighted => {
                let areas: Vec<usize> = options.free.iter().copied().filter(reachable).collect();
                draw(&areas, |area| options.set.areas[area].weight, random)
            }
            Self::NearestOf(count) => {
                let mut areas: Vec<usize> = options.free.iter().copied().filter(reachable).collect();
                let mut drawn = Vec::new();
                for _ in 0..count {
                    let Some(area) = draw(&areas, |area| options.set.areas[area].weight, random) else { break };
                    areas.retain(|&other| other != area);
                    drawn.push(area);
                }
                drawn.sort_unstable();
                least(&drawn, |area| (options.route_m)(area))
            }
        }
    }
}

impl Options<'_> {
    /// Time until an agent that goes to an area has passed it, s; none where there is no route.
    pub(crate) fn time_s(&self, area: usize) -> Option<f32> {
        let width_m = self.set.areas[area].area.width_m().max(EXIT_WIDTH_MIN_M);
        let route_m = (self.route_m)(area)?;
        let waiting_s = (self.ahead)(area, route_m) as f32 / (PASSING_PER_M_S * width_m);
        Some(route_m / self.speed_mps.max(f32::MIN_POSITIVE) + waiting_s)
    }
}

/// The area with the least cost; the first of equals.
fn least(areas: &[usize], cost: impl Fn(usize) -> Option<f32>) -> Option<usize> {
    let costs = areas.iter().filter_map(|&area| Some((cost(area)?, area)));
    costs.reduce(|a, b| if b.0 < a.0 { b } else { a }).map(|(_, area)| area)
}

/// An item drawn with chances in proportion to weights that are not negative; none where all weigh nothing.
pub(crate) fn draw(items: &[usize], weight: impl Fn(usize) -> f32, random: &mut SplitMix64) -> Option<usize> {
    let weight = |item| f64::from(weight(item));
    let mut left = random.unit() * items.iter().map(|&item| weight(item)).sum::<f64>();
    let with_weight = items.iter().copied().filter(|&item| weight(item) > 0.0);
    let mut drawn = None;
    for item in with_weight {
        drawn = Some(item);
        left -= weight(item);
        if left < 0.0 {
            break;
        }
    }
    drawn
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::behaviour::area::Area;
    use crate::behaviour::goals::GoalArea;

    /// Four exits of 1 m at 10, 20, 30 and 40 m; there is no route to the last.
    fn chosen(choice: Choice, ahead: [usize; 4], seed: u64) -> Option<usize> {
        let exit = |index: usize| GoalArea {
            area: Area::rectangle(Vec2::new(index as f32, 0.0), Vec2::new(index as f32 + 1.0, 0.2)),
            facing_rad: None,
            capacity: None,
            weight: [1.0, 0.0, 3.0, 9.0][index],
        };
        let set = GoalSet { name: "exits".into(), areas: (0..4).map(exit).collect(), queue: false };
        let route_m = |area: usize| (area < 3).then_some(10.0 * (area + 1) as f32);
        let ahead = |area: usize, _| ahead[area];
        let options = Options { set: &set, free: &[0, 1, 2, 3], ahead: &ahead, route_m: &route_m, speed_mps: 1.0 };
        choice.choose(&options, &mut SplitMix64::new(seed, 0))
    }

    /// Shares of the areas in many choices.
    fn shares(choice: Choice) -> [f32; 4] {
        let mut counts = [0.0; 4];
        (0..8000).for_each(|seed| counts[chosen(choice, [0; 4], seed).unwrap()] += 1.0 / 8000.0);
        counts
    }

    fn check_shares(choice: Choice, expected: [f32; 4]) {
        let shares = shares(choice);
        let is_near = shares.iter().zip(expected).all(|(share, expected)| (share - expected).abs() < 0.02);
        assert!(is_near, "{choice:?}: {shares:?}");
    }

    #[test]
    fn only_reachable_areas_are_chosen() {
        assert_eq!(chosen(Choice::Nearest, [0; 4], 1), Some(0));
        assert_eq!(chosen(Choice::Farthest, [0; 4], 1), Some(2));
    }

    #[test]
    fn draws_follow_the_weights() {
        check_shares(Choice::Random, [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.0]);
        check_shares(Choice::Weighted, [0.25, 0.0, 0.75, 0.0]);
        check_shares(Choice::NearestOf(1), [0.25, 0.0, 0.75, 0.0]);
        check_shares(Choice::NearestOf(5), [1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn a_busy_exit_is_left_for_a_farther_one() {
        assert_eq!(chosen(Choice::LeastBusy, [10, 0, 0, 0], 1), Some(0));
        assert_eq!(chosen(Choice::LeastBusy, [30, 0, 0, 0], 1), Some(1));
    }
}
