//! Actions of states: properties of agents, teleports, obstacle sets; and the speed of `const_dir`.

use std::collections::BTreeMap;

use crate::error::SceneError;
use crate::menge::profiles::{MengeProfile, PRIORITIES_UNUSED};
use crate::menge::transitions::States;
use crate::menge::xml::Element;
use crate::scene::{DrawnNumber, Notes, Scene, SceneMovement, SceneSettings, SceneState, Shape, round_to_mm};

/// Preferred speeds that a scenario takes, m/s.
const SPEEDS_MPS: [f64; 2] = [0.1, 10.0];
/// Factors of a speed that a scenario takes.
const FACTORS: [f64; 2] = [1e-3, 10.0];
/// Radii that a scenario takes, m.
const RADII_M: [f64; 2] = [0.1, 1.0];
/// Properties that change nothing in a scenario.
const IDLE: [&str; 5] = ["max_speed", "max_accel", "max_angle_vel", "neighbor_dist", "max_neighbors"];

/// The profiles of agents that may get into each state.
pub(crate) type ProfilesByState<'a> = BTreeMap<String, Vec<&'a MengeProfile>>;

/// Reads the actions of all states.
pub(crate) fn apply_actions(
    elements: &States<'_>,
    by_state: &ProfilesByState<'_>,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    let Scene { states, notes, .. } = scene;
    for state in states {
        let Some(element) = elements.get(state.name.as_str()) else { continue };
        let profiles = by_state.get(&state.name).map_or(&[][..], Vec::as_slice);
        walk_at_preferred_speed(state, element, profiles, notes);
        let mut resets = Vec::new();
        for action in element.named("Action") {
            if read_action(&action, profiles, &mut state.settings, notes)? {
                resets.push(action.flag("exit_reset", true)?);
            }
        }
        for modifier in element.named("VelModifier").filter(|modifier| modifier.kind() == "scale") {
            let factor = DrawnNumber::Constant(modifier.required_number("scale")?);
            set_factor(&mut state.settings, factor, &modifier, notes);
            resets.push(true);
        }
        state.settings.remain = resets.first() == Some(&false);
        if resets.iter().any(|reset| reset != &resets[0]) {
            let what = "of actions that end with the state and actions that remain, all do as the first";
            notes.add(&element.file.shown, element.line(), what, true);
        }
    }
    Ok(())
}

/// A state of `const_dir` walks at the preferred speed of its agents.
fn walk_at_preferred_speed(
    state: &mut SceneState,
    element: &Element<'_>,
    profiles: &[&MengeProfile],
    notes: &mut Notes,
) {
    let is_direction = element.child("VelComponent").is_some_and(|component| component.kind() == "const_dir");
    let SceneMovement::Walk([x, y]) = &mut state.movement else { return };
    if !is_direction || profiles.is_empty() {
        return;
    }
    let mean_mps = profiles.iter().map(|profile| profile.speed_mps.mean()).sum::<f64>() / profiles.len() as f64;
    if profiles.iter().any(|profile| profile.speed_mps.constant() != Some(mean_mps)) {
        let what = format!("all agents of state `{}` walk at the mean speed {mean_mps:.2} m/s", state.name);
        notes.add(&element.file.shown, element.line(), what, true);
    }
    (*x, *y) = (round_to_mm(*x * mean_mps), round_to_mm(*y * mean_mps));
}

/// Reads one action. Returns whether it may be undone on leaving the state.
fn read_action(
    action: &Element<'_>,
    profiles: &[&MengeProfile],
    settings: &mut SceneSettings,
    notes: &mut Notes,
) -> Result<bool, SceneError> {
    let (shown, line) = (&action.file.shown, action.line());
    match action.kind() {
        "teleport" => {
            settings.teleport = Some(teleport(action, notes)?);
            Ok(false)
        }
        kind @ ("set_property" | "scale_property" | "offset_property") => {
            let drawn = action.drawn("")?;
            let drawn = drawn.ok_or_else(|| action.fault("the action has no `dist`", "write `dist=\"c\"`"))?;
            match action.required("property")? {
                "pref_speed" => set_speed(kind, drawn, profiles, settings, action, notes),
                "r" => set_radius(kind, drawn, profiles, settings, action, notes),
                "priority" => {
                    notes.add(shown, line, PRIORITIES_UNUSED, false);
                    return Ok(false);
                }
                property => {
                    let what = format!("a change of the property `{property}` is not used");
                    notes.add(shown, line, what, !IDLE.contains(&property));
                    return Ok(false);
                }
            }
            Ok(true)
        }
        // `obstacle_sets` reads them.
        "set_obstacle" | "add_obstacle" | "remove_obstacle" => Ok(false),
        kind => {
            notes.add(shown, line, format!("the action \"{kind}\" is unknown"), true);
            Ok(false)
        }
    }
}

fn teleport(action: &Element<'_>, notes: &mut Notes) -> Result<Shape, SceneError> {
    match action.text("dist") {
        Some("u") => Ok(Shape::rect(action.point("min_x", "min_y")?, action.point("max_x", "max_y")?)),
        Some("c") => Ok(Shape::Point(action.point("x_value", "y_value")?)),
        Some("n") => {
            let what = "a teleport to a normal distribution leads to its mean";
            notes.add(&action.file.shown, action.line(), what, true);
            Ok(Shape::Point(action.point("mean_x", "mean_y")?))
        }
        _ => Err(action.fault("the teleport has no known distribution", "write `dist=\"u\"`")),
    }
}

fn set_speed(
    kind: &str,
    drawn: DrawnNumber,
    profiles: &[&MengeProfile],
    settings: &mut SceneSettings,
    action: &Element<'_>,
    notes: &mut Notes,
) {
    let speed_mps = match kind {
        "scale_property" => return set_factor(settings, drawn, action, notes),
        "set_property" => Some(drawn),
        _ => common_constant(profiles, |profile| profile.speed_mps).map(|base_mps| drawn.shifted(base_mps)),
    };
    settings.preferred_speed_mps = in_range(speed_mps, SPEEDS_MPS, action, notes).or(settings.preferred_speed_mps);
}

fn set_factor(settings: &mut SceneSettings, drawn: DrawnNumber, action: &Element<'_>, notes: &mut Notes) {
    settings.speed_factor = in_range(Some(drawn), FACTORS, action, notes).or(settings.speed_factor);
}

fn set_radius(
    kind: &str,
    drawn: DrawnNumber,
    profiles: &[&MengeProfile],
    settings: &mut SceneSettings,
    action: &Element<'_>,
    notes: &mut Notes,
) {
    let base_m = || common_constant(profiles, |profile| profile.radius_m);
    let radius_m = match kind {
        "set_property" => Some(drawn),
        "scale_property" => base_m().map(|base_m| drawn.scaled(base_m)),
        _ => base_m().map(|base_m| drawn.shifted(base_m)),
    };
    settings.radius_m = in_range(radius_m, RADII_M, action, notes).or(settings.radius_m);
}

/// The number of all profiles, where it is fixed and the same.
fn common_constant(profiles: &[&MengeProfile], number: impl Fn(&MengeProfile) -> DrawnNumber) -> Option<f64> {
    let first = number(profiles.first()?).constant()?;
    profiles.iter().all(|profile| number(profile).constant() == Some(first)).then_some(first)
}

/// A number in the range of scenario files; none with a note where it depends on each agent's own.
fn in_range(
    drawn: Option<DrawnNumber>,
    [least, greatest]: [f64; 2],
    action: &Element<'_>,
    notes: &mut Notes,
) -> Option<DrawnNumber> {
    let (shown, line) = (&action.file.shown, action.line());
    let Some(drawn) = drawn else {
        notes.add(shown, line, "a change that depends on each agent's own number is not used", true);
        return None;
    };
    let Some(cut) = drawn.cut(least, greatest) else { return Some(drawn) };
    let [low, high] = drawn.bounds();
    let what = format!("numbers from {low} to {high} are cut to the range from {least} to {greatest}");
    notes.add(shown, line, what, true);
    Some(cut)
}
