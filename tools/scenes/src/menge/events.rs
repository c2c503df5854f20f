//! Events: the number of agents in a state makes the agents of another state change theirs.

use std::collections::BTreeMap;

use crate::error::SceneError;
use crate::menge::transitions::{States, state_name};
use crate::menge::xml::Element;
use crate::scene::{Scene, SceneCondition, SceneTarget, SceneTransition};

/// Reads all events. Each that a scenario can state becomes a transition of the agents that it targets, before their
/// others.
pub(crate) fn read_events<'a>(
    root: &Element<'a>,
    states: &States<'a>,
    transitions: &mut BTreeMap<&'a str, Vec<SceneTransition>>,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    for system in root.named("EventSystem") {
        for event in system.named("Event") {
            read_event(&system, &event, states, transitions, scene)?;
        }
    }
    Ok(())
}

fn read_event<'a>(
    system: &Element<'a>,
    event: &Element<'a>,
    states: &States<'a>,
    transitions: &mut BTreeMap<&'a str, Vec<SceneTransition>>,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    let named = |kind: &'static str, name: &str| system.named(kind).find(|part| part.text("name") == Some(name));
    let Some(when) = trigger(event, states)? else {
        let what = "an event whose trigger is not a level of `state_population` is left out";
        scene.notes.add(&event.file.shown, event.line(), what, true);
        return Ok(());
    };
    for response in event.named("Response") {
        let (effect, target) = (response.required("effect")?, response.required("target")?);
        let part = |kind, name: &str, attribute| {
            named(kind, name).ok_or_else(|| {
                let message = format!("there is no <{kind} name=\"{name}\">");
                response.attribute_fault(attribute, message, "correct the name")
            })
        };
        let (effect, target) = (part("Effect", effect, "effect")?, part("Target", target, "target")?);
        let is_member = target.kind() == "named_state_member" && target.flag("is_member", true)?;
        if !["set_agent_state", "change_state"].contains(&effect.kind()) || !is_member {
            let what = "an effect other than a change of state, or a target other than a state, is left out";
            scene.notes.add(&response.file.shown, response.line(), what, true);
            continue;
        }
        let to = SceneTarget::State(state_name(&effect, "state", states)?);
        let of = state_name(&target, "state", states)?;
        let what = "the event holds as long as its number does, not at the moment when the number is reached";
        scene.notes.add(&response.file.shown, response.line(), what, true);
        if let Some((&of, _)) = states.get_key_value(of.as_str()) {
            transitions.entry(of).or_default().insert(0, SceneTransition { when: when.clone(), to });
        }
    }
    Ok(())
}

/// The trigger of an event, where a scenario can state it.
fn trigger(event: &Element<'_>, states: &States<'_>) -> Result<Option<SceneCondition>, SceneError> {
    let trigger = event.child("Trigger");
    let trigger = trigger.ok_or_else(|| event.fault("the event has no <Trigger>", "add one"))?;
    if trigger.kind() != "state_population" {
        return Ok(None);
    }
    let state = state_name(&trigger, "state", states)?;
    let threshold = trigger.count("threshold")?.filter(|threshold| *threshold < u64::from(u32::MAX));
    Ok(match (trigger.text("behavior"), threshold) {
        (Some("rise_to"), Some(count)) => Some(SceneCondition::Population(state, Some(count), None)),
        (Some("while_higher"), Some(count)) => Some(SceneCondition::Population(state, Some(count + 1), None)),
        (Some("drop_to"), Some(count)) => Some(SceneCondition::Population(state, None, Some(count))),
        (Some("while_lower"), Some(count)) => {
            Some(SceneCondition::Population(state, None, Some(count.saturating_sub(1))))
        }
        _ => None,
    })
}
