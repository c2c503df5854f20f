//! Conditions of transitions. World, metres, seconds.

use serde::{Deserialize, Serialize};

use crate::behaviour::distribution::Distribution;
use crate::maths::random::SplitMix64;

/// A condition of one agent in one state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Condition {
    /// Always holds.
    Always,
    /// The agent is within this distance of its goal's area, m; 0: inside it.
    Reached(f32),
    /// The agent has been in its state for a duration, drawn when it enters, s.
    After(Distribution),
    /// The agent has stood at the head of its queue for a duration, drawn when it enters the state, s.
    Served(Distribution),
    /// The agent is inside an area, by index.
    Inside(usize),
    /// A signal is green, by index.
    Green(usize),
    /// The number of agents inside an area, by index.
    Number(usize, Bound),
    /// The number of agents in a state, by index.
    Population(usize, Bound),
    /// All of these hold.
    All(Vec<Condition>),
    /// At least one of these holds.
    Any(Vec<Condition>),
    /// This does not hold.
    Not(Box<Condition>),
}

/// Bounds of a number of agents, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bound {
    /// Least number.
    pub at_least: u32,
    /// Greatest number.
    pub at_most: u32,
}

/// What conditions read of an agent and its crowd.
pub(crate) struct Facts<'a> {
    /// Distance to the area of its goal, m; none without a goal.
    pub(crate) to_goal_m: Option<f32>,
    /// Time in its state, s.
    pub(crate) in_state_s: f64,
    /// Time at the head of its queue, s; none elsewhere.
    pub(crate) at_head_s: Option<f64>,
    /// Whether it is inside an area, by index.
    pub(crate) is_inside: &'a dyn Fn(usize) -> bool,
    /// Whether each signal is green.
    pub(crate) green: &'a [bool],
    /// Number of agents in each area.
    pub(crate) numbers: &'a [u32],
    /// Number of agents in each state.
    pub(crate) populations: &'a [u32],
}

impl Condition {
    /// Whether the condition holds. Durations are drawn in the order of the text, from the same generator each time;
    /// so every part is evaluated, whatever the parts before it give.
    pub(crate) fn holds(&self, facts: &Facts, random: &mut SplitMix64) -> bool {
        match self {
            Self::Always => true,
            Self::Reached(within_m) => facts.to_goal_m.is_some_and(|to_goal_m| to_goal_m <= *within_m),
            Self::After(duration_s) => facts.in_state_s >= f64::from(duration_s.draw(random)),
            Self::Served(duration_s) => {
                let duration_s = f64::from(duration_s.draw(random));
                facts.at_head_s.is_some_and(|at_head_s| at_head_s >= duration_s)
            }
            Self::Inside(area) => (facts.is_inside)(*area),
            Self::Green(signal) => facts.green[*signal],
            Self::Number(area, bound) => bound.holds(facts.numbers[*area]),
            Self::Population(state, bound) => bound.holds(facts.populations[*state]),
            Self::All(parts) => holding(parts, facts, random) == parts.len(),
            Self::Any(parts) => holding(parts, facts, random) > 0,
            Self::Not(part) => !part.holds(facts, random),
        }
    }

    /// Whether the condition holds in every step, whatever happens: a chain of such transitions may never end.
    pub fn is_always_true(&self) -> bool {
        match self {
            Self::Always => true,
            Self::All(parts) => parts.iter().all(Self::is_always_true),
            Self::Any(parts) => parts.iter().any(Self::is_always_true),
            Self::After(duration_s) => duration_s.bounds()[1] <= 0.0,
            _ => false,
        }
    }
}

/// Number of conditions that hold; every one is evaluated.
fn holding(parts: &[Condition], facts: &Facts, random: &mut SplitMix64) -> usize {
    parts.iter().filter(|part| part.holds(facts, random)).count()
}

impl Bound {
    /// Whether a number lies within the bounds.
    pub fn holds(self, number: u32) -> bool {
        (self.at_least..=self.at_most).contains(&number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AFTER_1_S: Condition = Condition::After(Distribution::Constant(1.0));

    fn check(condition: &Condition, expected: bool) {
        let facts = Facts {
            to_goal_m: Some(0.5),
            in_state_s: 2.0,
            at_head_s: None,
            is_inside: &|area| area == 1,
            green: &[true, false],
            numbers: &[0, 7],
            populations: &[3],
        };
        assert_eq!(condition.holds(&facts, &mut SplitMix64::new(1, 0)), expected, "{condition:?}");
    }

    #[test]
    fn each_condition_reads_its_fact() {
        let bound = |at_least, at_most| Bound { at_least, at_most };
        check(&Condition::Reached(0.5), true);
        check(&Condition::Reached(0.4), false);
        check(&AFTER_1_S, true);
        check(&Condition::After(Distribution::Constant(2.5)), false);
        check(&Condition::Served(Distribution::Constant(0.0)), false);
        check(&Condition::Inside(0), false);
        check(&Condition::Inside(1), true);
        check(&Condition::Green(1), false);
        check(&Condition::Number(1, bound(7, 9)), true);
        check(&Condition::Population(0, bound(0, 2)), false);
    }

    #[test]
    fn parts_combine() {
        let not = |part| Condition::Not(Box::new(part));
        check(&Condition::All(vec![AFTER_1_S, Condition::Green(0)]), true);
        check(&Condition::All(vec![AFTER_1_S, Condition::Green(1)]), false);
        check(&Condition::Any(vec![Condition::Green(1), AFTER_1_S]), true);
        check(&not(Condition::Any(vec![])), true);
    }

    #[test]
    fn a_part_draws_the_same_whatever_others_give() {
        let third = |first: Condition| {
            let drawn = Condition::After(Distribution::Uniform { from: 0.0, to: 4.0 });
            let facts = |in_state_s| Facts {
                to_goal_m: None,
                in_state_s,
                at_head_s: None,
                is_inside: &|_| false,
                green: &[],
                numbers: &[],
                populations: &[],
            };
            let all = Condition::Any(vec![Condition::All(vec![first, drawn.clone()]), drawn]);
            (0..400).position(|step| all.holds(&facts(0.01 * f64::from(step)), &mut SplitMix64::new(9, 0)))
        };
        // The second duration alone decides: the first part never holds or holds only with its own draw.
        let never = Condition::Not(Box::new(Condition::Always));
        assert!(third(never).is_some_and(|step| third(Condition::Always).is_some_and(|other| other <= step)));
    }
}
