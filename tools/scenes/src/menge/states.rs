//! States: goal selector and velocity component together become a movement of the scenario.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use crate::error::SceneError;
use crate::menge::files::ProjectFiles;
use crate::menge::goal_sets::{GoalSets, pick};
use crate::menge::xml::Element;
use crate::scene::{
    Point, Remember, Scene, SceneAgents, SceneCondition, SceneMovement, SceneSettings, SceneState, SceneTarget, Starts,
};

/// Distance to a goal beyond which an agent that stops does not go up to it, m.
const STOPS_AWAY_M: f64 = 0.5;
/// Greatest speed that a scenario takes, m/s.
const SPEED_MAX_MPS: f64 = 10.0;

/// Reads one state without its transitions; meshes on which it finds routes join `meshes`.
pub(crate) fn read_state(
    files: &mut ProjectFiles,
    state: &Element<'_>,
    states: &BTreeMap<&str, Element<'_>>,
    goals: &mut GoalSets,
    scene: &mut Scene,
    meshes: &mut BTreeSet<PathBuf>,
) -> Result<SceneState, SceneError> {
    let selector = state.child("GoalSelector");
    let component = state.child("VelComponent");
    if let Some(selector) = &selector {
        note_selector(files, selector, scene)?;
    }
    let selected = match &selector {
        Some(selector) => selected(selector, states, goals, scene, 0)?,
        None => SceneMovement::Stand,
    };
    let movement = match &component {
        None => SceneMovement::Stand,
        Some(component) => moved(files, component, selected, scene, meshes)?,
    };
    for modifier in state.named("VelModifier").filter(|modifier| modifier.kind() != "scale") {
        let what = format!("the velocity modifier \"{}\" is not used", modifier.kind());
        scene.notes.add(&modifier.file.shown, modifier.line(), what, true);
    }
    let comment = if state.flag("final", false)? { "final" } else { "" };
    Ok(SceneState {
        name: state.required("name")?.to_owned(),
        movement,
        settings: SceneSettings::default(),
        transitions: Vec::new(),
        comment: comment.to_owned(),
    })
}

/// Notes of a selector that a scenario does not follow to the letter.
fn note_selector(files: &mut ProjectFiles, selector: &Element<'_>, scene: &mut Scene) -> Result<(), SceneError> {
    let (shown, line) = (&selector.file.shown, selector.line());
    match selector.kind() {
        "nearest" | "farthest" if !scene.obstacles.is_empty() || !scene.walkable.is_empty() => {
            let what = "nearest and farthest goals are found by the length of routes, not by straight lines";
            scene.notes.add(shown, line, what, false);
        }
        "nearest_nav_mesh" | "farthest_nav_mesh" => {
            files.find(selector, "file_name")?;
        }
        _ => {}
    }
    Ok(())
}

/// Where a selector leads an agent.
fn selected(
    selector: &Element<'_>,
    states: &BTreeMap<&str, Element<'_>>,
    goals: &GoalSets,
    scene: &mut Scene,
    depth: usize,
) -> Result<SceneMovement, SceneError> {
    let persistent = selector.flag("persistent", false)?;
    if let Some(picked) = pick(selector)? {
        return Ok(SceneMovement::Go { goals: goals.name(picked), remember: persistent.then_some(Remember::Own) });
    }
    match selector.kind() {
        "identity" => Ok(SceneMovement::Stand),
        "mirror" => mirrored(selector),
        "offset" => {
            let by_m = match selector.text("dist") {
                Some("c") => selector.point("x_value", "y_value")?,
                Some("u") => {
                    let what = "an offset that is drawn becomes its mean";
                    scene.notes.add(&selector.file.shown, selector.line(), what, true);
                    let [a, b] = [selector.point("min_x", "min_y")?, selector.point("max_x", "max_y")?];
                    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
                }
                _ => return Err(selector.fault("the offset has no known distribution", "write `dist=\"c\"`")),
            };
            Ok(SceneMovement::Offset(by_m))
        }
        "shared" => {
            let name = selector.required("state_name")?;
            let other = states.get(name).and_then(|state| state.child("GoalSelector"));
            let Some(other) = other.filter(|_| depth < states.len()) else {
                let message = format!("there is no goal selector in a state `{name}` to share");
                return Err(selector.attribute_fault("state_name", message, "correct the name"));
            };
            Ok(match selected(&other, states, goals, scene, depth + 1)? {
                SceneMovement::Go { goals, remember: Some(Remember::Of(of)) } => {
                    SceneMovement::Go { goals, remember: Some(Remember::Of(of)) }
                }
                SceneMovement::Go { goals, .. } => {
                    SceneMovement::Go { goals, remember: Some(Remember::Of(name.to_owned())) }
                }
                other => other,
            })
        }
        kind => {
            let what = format!("the goal selector \"{kind}\" is unknown; agents stand");
            scene.notes.add(&selector.file.shown, selector.line(), what, true);
            Ok(SceneMovement::Stand)
        }
    }
}

/// Through the origin, or along one axis: then each agent has a goal of its own.
fn mirrored(selector: &Element<'_>) -> Result<SceneMovement, SceneError> {
    Ok(match mirrors(selector)? {
        [true, true] => SceneMovement::Mirror([0.0, 0.0]),
        [false, false] => SceneMovement::Stand,
        _ => SceneMovement::OwnPath,
    })
}

fn mirrors(selector: &Element<'_>) -> Result<[bool; 2], SceneError> {
    Ok([selector.flag("mirror_x", true)?, selector.flag("mirror_y", true)?])
}

/// Gives agents that begin in a state with a mirror along one axis their goals.
pub(crate) fn give_own_goals(states: &BTreeMap<&str, Element<'_>>, scene: &mut Scene) -> Result<(), SceneError> {
    for state in scene.states.iter().filter(|state| state.movement == SceneMovement::OwnPath) {
        let Some(selector) = states.get(state.name.as_str()).and_then(|state| state.child("GoalSelector")) else {
            continue;
        };
        let mirrors = mirrors(&selector)?;
        let begins = |agents: &&mut SceneAgents| agents.state.as_ref() == Some(&state.name);
        for agents in scene.agents.iter_mut().filter(begins) {
            agents.own_goal_mirrors = Some(mirrors);
            if let Starts::Grid(grid) = &agents.starts {
                agents.starts = Starts::Points(grid.drawn_m());
            }
        }
    }
    Ok(())
}

/// How a velocity component moves an agent to its goal.
fn moved(
    files: &mut ProjectFiles,
    component: &Element<'_>,
    selected: SceneMovement,
    scene: &mut Scene,
    meshes: &mut BTreeSet<PathBuf>,
) -> Result<SceneMovement, SceneError> {
    let (shown, line) = (&component.file.shown, component.line());
    let mut note = |what: &str, changes: bool| scene.notes.add(shown, line, what, changes);
    match component.kind() {
        "goal" => {
            if !scene.obstacles.is_empty() && selected != SceneMovement::Stand {
                note("agents go round obstacles by the shortest route, not straight ahead", false);
            }
            Ok(selected)
        }
        "zero" => Ok(SceneMovement::Stand),
        "nav_mesh" => {
            meshes.insert(files.find(component, "file_name")?);
            note("routes are found between the obstacles and the mesh's outline, not on the mesh", false);
            Ok(selected)
        }
        "road_map" => {
            files.find(component, "file_name")?;
            note("routes are found between the obstacles, not on the road map", false);
            Ok(selected)
        }
        "vel_field" => {
            files.find(component, "file_name")?;
            note("agents go to their goals by routes, not along the vector field", true);
            Ok(selected)
        }
        "const" => Ok(SceneMovement::Walk(velocity(component, component.point("x", "y")?)?)),
        // Its length is the preferred speed, which `actions` knows.
        "const_dir" => {
            let [x, y] = component.point("x", "y")?;
            let length = (x * x + y * y).sqrt();
            if length < 1e-9 {
                return Ok(SceneMovement::Stand);
            }
            Ok(SceneMovement::Walk([x / length, y / length]))
        }
        kind => {
            note(&format!("the velocity component \"{kind}\" is unknown; agents go to their goals by routes"), true);
            Ok(selected)
        }
    }
}

fn velocity(component: &Element<'_>, [x, y]: Point) -> Result<Point, SceneError> {
    if (x * x + y * y).sqrt() <= SPEED_MAX_MPS {
        return Ok([x, y]);
    }
    Err(component.fault(format!("the velocity is faster than {SPEED_MAX_MPS} m/s"), "give m/s"))
}

/// Agents that stop far from a goal stay where they are: a state in which agents stand would lead them up to it.
pub(crate) fn stop_where_they_are(scene: &mut Scene) {
    let is_far = |when: &SceneCondition| matches!(when, SceneCondition::Reached(within_m) if *within_m > STOPS_AWAY_M);
    let far: BTreeSet<String> = scene
        .states
        .iter()
        .flat_map(|state| &state.transitions)
        .filter(|transition| is_far(&transition.when))
        .filter_map(|transition| match &transition.to {
            SceneTarget::State(name) => Some(name.clone()),
            _ => None,
        })
        .collect();
    for state in scene.states.iter_mut().filter(|state| far.contains(&state.name)) {
        if state.movement == SceneMovement::Stand {
            state.movement = SceneMovement::Walk([0.0, 0.0]);
            let comma = if state.comment.is_empty() { "" } else { ", " };
            state.comment = format!("{}{comma}stops where it is", state.comment);
        }
    }
}

/// Mirrors and offsets count from an agent's start; in the source from its position when it enters the state.
pub(crate) fn note_relative_goals(states: &BTreeMap<&str, Element<'_>>, scene: &mut Scene) {
    let all = || scene.states.iter().flat_map(|state| &state.transitions);
    let is_entered = |name: &str| all().any(|transition| transition.to.states().contains(&name));
    let is_relative = |movement: &SceneMovement| {
        matches!(movement, SceneMovement::Mirror(_) | SceneMovement::Offset(_) | SceneMovement::OwnPath)
    };
    let relative = scene.states.iter().filter(|state| is_relative(&state.movement) && is_entered(&state.name));
    let elements: Vec<Element<'_>> = relative.filter_map(|state| states.get(state.name.as_str()).copied()).collect();
    for element in elements {
        let what = "mirrors and offsets count from an agent's start, not from its position when it enters this state";
        scene.notes.add(&element.file.shown, element.line(), what, true);
    }
}
