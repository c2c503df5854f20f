//! From the tables of transitions to [`Transition`]: conditions and targets.

use toml::Spanned;

use crate::behaviour::{Bound, Condition, Target, Transition};
use crate::scenario::fault::TableFault;
use crate::scenario::file::behaviour::names::{Resolving, TRANSITIONS_MAX};
use crate::scenario::file::behaviour::numbers::DistributionValue;
use crate::scenario::file::behaviour::placed_fault::{At, DURATION_MAX_S, PlacedFault, fault};
use crate::scenario::file::behaviour::tables::{BACK, ThenTable, ToValue, WhenTable};

impl Resolving<'_> {
    /// One transition.
    pub(crate) fn transition(&mut self, then: &Spanned<ThenTable>) -> Result<Transition, PlacedFault> {
        let (span, table) = (then.span(), then.get_ref());
        let condition = self.condition(&table.when).at(&span)?;
        let to = table.to.span();
        let target = match table.to.get_ref() {
            ToValue::State(name) if name == BACK => Target::Back,
            ToValue::State(name) => Target::States(vec![(self.state_index(name).at(&to)?, 1.0)]),
            ToValue::Weights(weights) => {
                let weighted = |(name, &weight): (&String, &f32)| Ok((self.state_index(name)?, weight));
                let states: Vec<(u32, f32)> = weights.iter().map(weighted).collect::<Result<_, _>>().at(&to)?;
                let sum: f32 = states.iter().map(|(_, weight)| weight).sum();
                let are_weights = states.iter().all(|(_, weight)| *weight >= 0.0) && sum > 0.0 && sum.is_finite();
                if !are_weights {
                    let message = format!("the weights add up to {sum}, or one is negative");
                    return Err(fault(&to, message, "give weights of 0 or more, one of them above 0"));
                }
                Target::States(states)
            }
        };
        Ok(Transition { condition, target })
    }

    /// All keys of a table together.
    pub(crate) fn condition(&mut self, when: &WhenTable) -> Result<Condition, TableFault> {
        let too_many = || (format!("the scenario has more than {TRANSITIONS_MAX} conditions"), "give fewer");
        self.left = self.left.checked_sub(1).ok_or_else(too_many)?;
        let mut parts = Vec::new();
        if let Some(reached_m) = when.reached_m {
            if !(0.0..=1e4).contains(&reached_m) {
                return Err((format!("`reached_m` is {reached_m}"), "give a distance in metres; 0 means inside"));
            }
            parts.push(Condition::Reached(reached_m));
        }
        let duration = |name, value: DistributionValue| value.resolve(name, [0.0, DURATION_MAX_S]);
        if let Some(after_s) = when.after_s {
            parts.push(Condition::After(duration("`after_s`", after_s)?));
        }
        if let Some(served_s) = when.served_s {
            parts.push(Condition::Served(duration("`served_s`", served_s)?));
        }
        if let Some(area) = &when.inside {
            parts.push(Condition::Inside(self.areas.index(area)?));
        }
        if let Some(signal) = &when.green {
            parts.push(Condition::Green(self.signals.index(signal)?));
        }
        if let Some(number) = &when.number {
            let area = self.areas.index(&number.inside)?;
            parts.push(Condition::Number(area, bound(number.at_least, number.at_most)?));
        }
        if let Some(population) = &when.population {
            let state = self.state_index(&population.state)? as usize;
            parts.push(Condition::Population(state, bound(population.at_least, population.at_most)?));
        }
        let mut all = |tables: &[WhenTable]| -> Result<Vec<Condition>, TableFault> {
            tables.iter().map(|table| self.condition(table)).collect()
        };
        if let Some(tables) = &when.all {
            parts.push(Condition::All(all(tables)?));
        }
        if let Some(tables) = &when.any {
            parts.push(Condition::Any(all(tables)?));
        }
        if let Some(table) = &when.not {
            parts.push(Condition::Not(Box::new(self.condition(table)?)));
        }
        Ok(match parts.len() {
            0 => Condition::Always,
            1 => parts.remove(0),
            _ => Condition::All(parts),
        })
    }
}

fn bound(at_least: Option<u32>, at_most: Option<u32>) -> Result<Bound, TableFault> {
    let bound = Bound { at_least: at_least.unwrap_or(0), at_most: at_most.unwrap_or(u32::MAX) };
    if bound.at_least <= bound.at_most && (at_least.is_some() || at_most.is_some()) {
        return Ok(bound);
    }
    Err(("a number needs `at_least`, `at_most` or both, the former no greater".into(), "write `at_most = 2`"))
}
