//! Lane formation in opposed flows (`FbCrowd` §7): the order parameter of Nowak and Schadschneider 2012 (Phys. Rev. E
//! 85, 066128), after Rex and Löwen 2007.
//!
//! In an agent's band, itself included, `same` agents walk in its direction and `opposite` ones against it; φ is the
//! mean over all agents of ((same − opposite)/(same + opposite))². It is 1 for perfect lanes. A crowd without order has
//! some by chance, φ_0; the reduced parameter (φ − φ_0)/(1 − φ_0) is 0 there, and negative in a crowd that is mixed
//! better than by chance. Metres.

/// Half the width of a band, m: the radius of a disc, so that a band is as wide as an agent.
const BAND_HALF_M: f32 = 0.25;

/// An agent in a measured section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaneWalker {
    /// Position across the corridor, m.
    pub across_m: f32,
    /// Which of the two directions it walks in.
    pub goes_forward: bool,
}

/// Lane order at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaneOrder {
    /// φ, 0 to 1.
    pub order: f64,
    /// φ_0: expected order where each agent of a band walks in either direction by chance, at the directions' shares of
    /// the crowd.
    pub by_chance: f64,
}

impl LaneOrder {
    /// (φ − φ_0)/(1 − φ_0); none where chance alone gives perfect order, because no two agents share a band.
    pub fn reduced(self) -> Option<f64> {
        (self.by_chance < 1.0).then(|| (self.order - self.by_chance) / (1.0 - self.by_chance))
    }
}

/// The lane order of some agents; none of no agents.
pub fn lane_order(walkers: &[LaneWalker]) -> Option<LaneOrder> {
    let all = walkers.len() as f64;
    let forward = walkers.iter().filter(|walker| walker.goes_forward).count() as f64;
    let (mut order, mut by_chance) = (0.0, 0.0);
    for walker in walkers {
        let band = || walkers.iter().filter(|other| (other.across_m - walker.across_m).abs() <= BAND_HALF_M);
        let same = band().filter(|other| other.goes_forward == walker.goes_forward).count() as f64;
        let count = band().count() as f64;
        order += (2.0 * same / count - 1.0) * (2.0 * same / count - 1.0);
        let own = if walker.goes_forward { forward } else { all - forward };
        by_chance += squared_by_chance(count - 1.0, own / all);
    }
    (all > 0.0).then(|| LaneOrder { order: order / all, by_chance: by_chance / all })
}

/// Expectation of ((same − opposite)/(same + opposite))² for an agent and `others`, each of which walks in its
/// direction with a probability: the difference is 1 for the agent and ± 1 for each other.
fn squared_by_chance(others: f64, same_direction: f64) -> f64 {
    let mean = 1.0 + others * (2.0 * same_direction - 1.0);
    let variance = 4.0 * others * same_direction * (1.0 - same_direction);
    (mean * mean + variance) / ((others + 1.0) * (others + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maths::random::SplitMix64;

    fn walkers(count: usize, goes_forward: impl Fn(usize, f32) -> bool) -> Vec<LaneWalker> {
        let mut random = SplitMix64::new(1, 0);
        let mut walker = |index| {
            let across_m = random.within(3.0) as f32;
            LaneWalker { across_m, goes_forward: goes_forward(index, across_m) }
        };
        (0..count).map(&mut walker).collect()
    }

    #[test]
    fn halves_are_ordered_random_crowd_is_not() {
        let halves = lane_order(&walkers(200, |_, across_m| across_m > 0.0)).unwrap();
        assert!(halves.reduced().unwrap() > 0.9, "{halves:?}");
        let mixed: f64 = (0..20)
            .map(|seed| {
                let directions: Vec<bool> = {
                    let mut random = SplitMix64::new(seed, 7);
                    (0..200).map(|_| random.within(1.0) > 0.0).collect()
                };
                lane_order(&walkers(200, |index, _| directions[index])).unwrap().reduced().unwrap()
            })
            .sum();
        assert!(mixed.abs() / 20.0 < 0.02, "{mixed}");
    }

    #[test]
    fn a_lone_agent_has_no_reduced_order() {
        let alone = LaneWalker { across_m: 0.0, goes_forward: true };
        assert_eq!(lane_order(&[alone]).unwrap(), LaneOrder { order: 1.0, by_chance: 1.0 });
        assert_eq!(lane_order(&[alone]).unwrap().reduced(), None);
        assert_eq!(lane_order(&[]), None);
        let against = LaneWalker { across_m: 0.2, goes_forward: false };
        assert_eq!(lane_order(&[alone, against]).unwrap(), LaneOrder { order: 0.0, by_chance: 0.5 });
    }
}
