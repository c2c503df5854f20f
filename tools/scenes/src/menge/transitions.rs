//! Transitions: conditions and targets.

use std::collections::BTreeMap;

use crate::error::SceneError;
use crate::menge::xml::Element;
use crate::scene::{Scene, SceneArea, SceneCondition, SceneTarget, SceneTransition, Shape};

/// Deepest nesting of conditions.
const DEPTH_MAX: usize = 16;
/// Longest time that a scenario takes, s: a day.
const DURATION_MAX_S: f64 = 86_400.0;

/// The states of a behaviour by name.
pub(crate) type States<'a> = BTreeMap<&'a str, Element<'a>>;

/// Reads one transition: for each state from which it leads, what it says. None where its condition is unknown.
pub(crate) fn read_transition<'a>(
    transition: &Element<'a>,
    states: &States<'a>,
    scene: &mut Scene,
) -> Result<Vec<(&'a str, SceneTransition)>, SceneError> {
    let from = transition.required("from")?;
    let condition = transition.child("Condition");
    let condition = condition.ok_or_else(|| transition.fault("the transition has no <Condition>", "add one"))?;
    let to = target(transition, states, scene)?;
    let when = read_condition(&condition, scene, DEPTH_MAX)?;
    let mut read = Vec::new();
    for name in from.split(',').map(str::trim).filter(|name| !name.is_empty()) {
        let Some((&name, _)) = states.get_key_value(name) else {
            let message = format!("there is no state `{name}`");
            return Err(transition.attribute_fault("from", message, "correct the name"));
        };
        if let (Some(when), Some(to)) = (&when, &to) {
            read.push((name, SceneTransition { when: when.clone(), to: to.clone() }));
        }
    }
    Ok(read)
}

fn target(transition: &Element<'_>, states: &States<'_>, scene: &mut Scene) -> Result<Option<SceneTarget>, SceneError> {
    if transition.text("to").is_some() {
        return Ok(Some(SceneTarget::State(state_name(transition, "to", states)?)));
    }
    let target = transition.child("Target");
    let target = target.ok_or_else(|| transition.fault("the transition leads nowhere", "add `to` or a <Target>"))?;
    match target.kind() {
        "return" => Ok(Some(SceneTarget::Back)),
        "prob" => {
            let mut weights: Vec<(String, f64)> = Vec::new();
            for state in target.named("State") {
                let name = state_name(&state, "name", states)?;
                let weight = state.required_number("weight")?.max(0.0);
                match weights.iter_mut().find(|(other, _)| *other == name) {
                    Some((_, sum)) => *sum += weight,
                    None => weights.push((name, weight)),
                }
            }
            if weights.iter().map(|(_, weight)| weight).sum::<f64>() <= 0.0 {
                return Err(target.fault("the target has no state with a weight", "add one"));
            }
            Ok(Some(match weights.pop() {
                Some((only, _)) if weights.is_empty() => SceneTarget::State(only),
                last => SceneTarget::Weights(weights.into_iter().chain(last).collect()),
            }))
        }
        kind => {
            let what = format!("the target \"{kind}\" is unknown; the transition is left out");
            scene.notes.add(&target.file.shown, target.line(), what, true);
            Ok(None)
        }
    }
}

/// The state that an attribute names.
pub(crate) fn state_name(element: &Element<'_>, attribute: &str, states: &States<'_>) -> Result<String, SceneError> {
    let name = element.required(attribute)?;
    if states.contains_key(name) {
        return Ok(name.to_owned());
    }
    Err(element.attribute_fault(attribute, format!("there is no state `{name}`"), "correct the name"))
}

/// One condition; none where it is unknown.
fn read_condition(
    condition: &Element<'_>,
    scene: &mut Scene,
    depth: usize,
) -> Result<Option<SceneCondition>, SceneError> {
    if depth == 0 {
        let message = format!("conditions are nested deeper than {DEPTH_MAX}");
        return Err(condition.fault(message, "nest them less"));
    }
    let mut inner = Vec::new();
    for child in condition.named("Condition") {
        match read_condition(&child, scene, depth - 1)? {
            Some(read) => inner.push(read),
            None => return Ok(None),
        }
    }
    let read = match condition.kind() {
        "auto" => SceneCondition::Always,
        "goal_reached" => {
            let within_m = condition.number("distance")?.unwrap_or_default().max(0.0);
            SceneCondition::Reached(within_m.min(10_000.0))
        }
        "timer" => timer(condition, scene)?,
        "AABB" => {
            let corners_m = [condition.point("min_x", "min_y")?, condition.point("max_x", "max_y")?];
            area(condition, Shape::rect(corners_m[0], corners_m[1]), scene)?
        }
        "circle" => {
            let centre_m = condition.point("center_x", "center_y")?;
            area(condition, Shape::Circle(centre_m, condition.metres("radius")?.abs()), scene)?
        }
        "OBB" => {
            let (pivot_m, size_m) = (condition.point("pivot_x", "pivot_y")?, condition.point("width", "height")?);
            let angle_deg = condition.number("angle")?.unwrap_or_default();
            area(condition, Shape::turned_rect(pivot_m, size_m, angle_deg), scene)?
        }
        "and" if !inner.is_empty() => SceneCondition::All(inner),
        "or" if !inner.is_empty() => SceneCondition::Any(inner),
        "not" if inner.len() == 1 => SceneCondition::Not(Box::new(inner.remove(0))),
        kind @ ("and" | "or" | "not") => {
            let message = format!("\"{kind}\" has {} conditions inside", inner.len());
            return Err(condition.fault(message, "give `not` one condition, `and` and `or` two or more"));
        }
        kind => {
            let what = format!("the condition \"{kind}\" is unknown; its transition is left out");
            scene.notes.add(&condition.file.shown, condition.line(), what, true);
            return Ok(None);
        }
    };
    Ok(Some(read))
}

fn timer(condition: &Element<'_>, scene: &mut Scene) -> Result<SceneCondition, SceneError> {
    let drawn = condition.drawn("")?;
    let drawn_s = drawn.ok_or_else(|| condition.fault("the timer has no `dist`", "write `dist=\"c\"`"))?;
    if !condition.flag("per_agent", true)? && drawn_s.constant().is_none() {
        let what = "each agent draws its own time; the source draws one for all";
        scene.notes.add(&condition.file.shown, condition.line(), what, true);
    }
    Ok(SceneCondition::After(drawn_s.cut(0.0, DURATION_MAX_S).unwrap_or(drawn_s)))
}

/// Inside or outside an area, which gets a name of its own.
fn area(condition: &Element<'_>, shape: Shape, scene: &mut Scene) -> Result<SceneCondition, SceneError> {
    let name = match scene.areas.iter().find(|area| area.shape == shape) {
        Some(area) => area.name.clone(),
        None => {
            let name = format!("area_{}", scene.areas.len() + 1);
            scene.areas.push(SceneArea { name: name.clone(), shape });
            name
        }
    };
    let inside = SceneCondition::Inside(name);
    Ok(if condition.flag("inside", true)? { inside } else { SceneCondition::Not(Box::new(inside)) })
}
