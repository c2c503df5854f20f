//! Targets become goals; each list of targets that agents still have before them becomes a state.

use std::collections::{BTreeMap, BTreeSet};

use crate::scene::{
    Choose, DrawnNumber, GoalPlace, Scene, SceneCondition, SceneGoals, SceneMovement, SceneSettings, SceneState,
    SceneTarget, SceneTransition, Shape,
};
use crate::vadere::shapes::{PlacedFault, VadereFault, at_item, check_shape};
use crate::vadere::vadere_file::{VadereDistribution, VadereTarget};

/// Greatest number of targets that agents visit in order.
const VISITS_MAX: usize = 100;
/// Greatest number of states; that of scenario files.
const STATES_MAX: usize = 4_000;
/// The state of agents that leave.
const GONE: &str = "gone";

/// What an agent does at a target.
struct TargetPlace {
    shape: Shape,
    /// Distance from which it counts as reached, m.
    reached_m: f64,
    absorbs: bool,
    waits_s: Option<DrawnNumber>,
}

/// All targets, and the lists of targets that agents have before them.
pub(crate) struct Targets {
    places: BTreeMap<i64, TargetPlace>,
    lists: BTreeSet<Vec<i64>>,
}

impl Targets {
    /// Reads the targets.
    pub(crate) fn read(targets: &[VadereTarget], scene: &mut Scene) -> Result<Self, PlacedFault> {
        let source = scene.source.clone();
        let mut places = BTreeMap::new();
        for (index, target) in targets.iter().enumerate() {
            let shape = target.shape.shape();
            check_shape(&shape).map_err(at_item("targets", index))?;
            if target.parallel_waiters > 0 || target.parallel_events > 0 {
                let what = format!("target {}: all agents wait at once, not one after the other", target.id);
                scene.notes.add(&source, 0, what, true);
            }
            let waits_s = match &target.waiter {
                Some(waiter) if waiter.enabled => waiter.distribution.as_ref().and_then(drawn),
                Some(_) => None,
                None => Some(DrawnNumber::Constant(target.waiting_time)).filter(|_| target.waiting_time > 0.0),
            };
            places.insert(
                target.id,
                TargetPlace {
                    shape,
                    reached_m: target
                        .absorber
                        .as_ref()
                        .map_or(0.0, |absorber| absorber.deletion_distance.clamp(0.0, 100.0)),
                    absorbs: target.absorber.as_ref().map_or(target.absorbing, |absorber| absorber.enabled),
                    waits_s: waits_s.map(|waits_s| waits_s.cut(0.0, 86_400.0).unwrap_or(waits_s)),
                },
            );
        }
        Ok(Self { places, lists: BTreeSet::new() })
    }

    /// The state of agents that have a list of targets before them; none where the list is empty.
    pub(crate) fn state(&mut self, list: &[i64], what: &str) -> Result<Option<String>, VadereFault> {
        if let Some(missing) = list.iter().find(|id| !self.places.contains_key(id)) {
            return Err((format!("{what} names target {missing}, which does not exist"), "correct its `targetIds`"));
        }
        if list.len() > VISITS_MAX {
            return Err((format!("{what} names more than {VISITS_MAX} targets"), "give fewer"));
        }
        for from in 0..list.len() {
            self.lists.insert(list[from..].to_vec());
        }
        // Each list has a state to go and at most one to wait.
        if 2 * self.lists.len() >= STATES_MAX {
            return Err((format!("agents visit targets in more than {} orders", STATES_MAX / 2), "give fewer"));
        }
        Ok((!list.is_empty()).then(|| name(list)))
    }

    /// Writes the goals and states that agents need.
    pub(crate) fn write_states(self, scene: &mut Scene) {
        let visited: BTreeSet<i64> = self.lists.iter().filter_map(|list| list.first().copied()).collect();
        for id in visited {
            let place = GoalPlace { shape: self.places[&id].shape.clone(), capacity: None, weight: 1.0 };
            scene.goals.push(SceneGoals {
                name: format!("target_{id}"),
                choose: Choose::Nearest,
                places: vec![place],
                origin: format!("target {id}"),
            });
        }
        let mut has_gone = false;
        for list in &self.lists {
            let Some((first, rest)) = list.split_first() else { continue };
            let place = &self.places[first];
            let after = match rest.is_empty() {
                false => Some(name(rest)),
                true => place.absorbs.then(|| GONE.to_owned()),
            };
            has_gone |= after.as_deref() == Some(GONE);
            let then = |when: SceneCondition, to: String| vec![SceneTransition { when, to: SceneTarget::State(to) }];
            let wait = format!("wait_{}", &name(list)["to_".len()..]);
            let next = if place.waits_s.is_some() { Some(wait.clone()) } else { after.clone() };
            let go = SceneMovement::Go { goals: format!("target_{first}"), remember: None };
            let reached = SceneCondition::Reached(place.reached_m);
            scene.states.push(state(name(list), go, next.map_or_else(Vec::new, |next| then(reached, next))));
            if let Some(waits_s) = place.waits_s {
                let waited = SceneCondition::After(waits_s);
                let transitions = after.map_or_else(Vec::new, |after| then(waited, after));
                scene.states.push(state(wait, SceneMovement::Stand, transitions));
            }
        }
        if has_gone {
            scene.states.push(state(GONE.to_owned(), SceneMovement::Remove, Vec::new()));
        }
    }
}

fn state(name: String, movement: SceneMovement, transitions: Vec<SceneTransition>) -> SceneState {
    SceneState { name, movement, settings: SceneSettings::default(), transitions, comment: String::new() }
}

/// Name of the state of agents that have a list of targets before them.
fn name(list: &[i64]) -> String {
    let ids: Vec<String> = list.iter().map(i64::to_string).collect();
    format!("to_{}", ids.join("_then_"))
}

/// A time that is fixed or drawn; none for kinds that are unknown.
pub(crate) fn drawn(distribution: &VadereDistribution) -> Option<DrawnNumber> {
    let kind = distribution.kind.rsplit('.').next().unwrap_or_default();
    let constant = distribution.update_frequency.or(distribution.value).map(DrawnNumber::Constant);
    match kind {
        "AttributesConstantDistribution" => constant,
        "AttributesUniformDistribution" => {
            let (a, b) = distribution.min.zip(distribution.max)?;
            Some(DrawnNumber::Uniform { from: a.min(b), to: a.max(b) })
        }
        "AttributesNormalDistribution" | "AttributesTruncatedNormalDistribution" => {
            let deviation = distribution.standard_deviation.or(distribution.sd).unwrap_or(0.0).abs();
            Some(DrawnNumber::Normal { mean: distribution.mean?, deviation, min: None, max: None })
        }
        _ => distribution.mean.map(DrawnNumber::Constant).or(constant),
    }
}
