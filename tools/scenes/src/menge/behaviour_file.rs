//! The behaviour file: goal sets, states, transitions, events.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::SceneError;
use crate::geometry::polygon::contains;
use crate::geometry::rings::with_holes;
use crate::menge::events::read_events;
use crate::menge::files::ProjectFiles;
use crate::menge::goal_sets::GoalSets;
use crate::menge::nav_mesh::NavMesh;
use crate::menge::obstacle_sets::settle_sets;
use crate::menge::profiles::Profiles;
use crate::menge::states::{give_own_goals, note_relative_goals, read_state, stop_where_they_are};
use crate::menge::transitions::read_transition;
use crate::menge::xml::Element;
use crate::scene::{Point, Remember, Scene, SceneMovement, Walkable};

/// Greatest number of states; that of scenario files.
const STATES_MAX: usize = 4_000;

/// Reads the behaviour file into the scene.
pub(crate) fn read_behaviour(
    files: &mut ProjectFiles,
    project: &Element<'_>,
    profiles: &Profiles,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    let file = files.xml(project, "behavior")?;
    let document = file.document()?;
    let root = file.root(&document, "BFSM")?;
    let mut goals = GoalSets::read(&root, scene)?;
    let elements = states(&root)?;
    let mut transitions: BTreeMap<&str, Vec<_>> = BTreeMap::new();
    for transition in root.named("Transition") {
        for (from, read) in read_transition(&transition, &elements, scene)? {
            transitions.entry(from).or_default().push(read);
        }
    }
    read_events(&root, &elements, &mut transitions, scene)?;
    let mut meshes = BTreeSet::new();
    let first = scene.states.len();
    for element in elements.values() {
        let mut state = read_state(files, element, &elements, &mut goals, scene, &mut meshes)?;
        state.transitions = transitions.remove(state.name.as_str()).unwrap_or_default();
        scene.states.push(state);
    }
    // In the order of the file.
    scene.states[first..].sort_by_key(|state| elements.get(state.name.as_str()).map(Element::line));
    check_starts(&elements, scene, &root)?;
    let by_state = profiles.by_state(&scene.states);
    crate::menge::actions::apply_actions(&elements, &by_state, scene)?;
    settle_sets(profiles, &elements, &by_state, scene)?;
    remember_shared(scene);
    give_own_goals(&elements, scene)?;
    note_relative_goals(&elements, scene);
    stop_where_they_are(scene);
    scene.goals = goals.into_used(scene.agent_count(), &mut scene.notes);
    read_outline(files, &meshes, scene)?;
    for element in root.children() {
        if !["GoalSet", "State", "Transition", "EventSystem"].contains(&element.name()) {
            let what = format!("<{}> is not used", element.name());
            scene.notes.add(&element.file.shown, element.line(), what, true);
        }
    }
    Ok(())
}

/// The states by name.
fn states<'a>(root: &Element<'a>) -> Result<BTreeMap<&'a str, Element<'a>>, SceneError> {
    let mut states = BTreeMap::new();
    for state in root.named("State") {
        let name = state.required("name")?;
        if states.insert(name, state).is_some() {
            return Err(state.attribute_fault("name", format!("a second state `{name}`"), "rename one"));
        }
        if states.len() > STATES_MAX {
            return Err(state.fault(format!("there are more than {STATES_MAX} states"), "give fewer"));
        }
    }
    Ok(states)
}

fn check_starts(elements: &BTreeMap<&str, Element<'_>>, scene: &Scene, root: &Element<'_>) -> Result<(), SceneError> {
    let named = scene.agents.iter().filter_map(|agents| agents.state.as_deref().map(|state| (state, &agents.origin)));
    let drawn = scene.states.iter().flat_map(|state| &state.transitions).flat_map(|transition| transition.to.states());
    let own = |name: &str| scene.states.iter().any(|state| state.name == name);
    let missing = named.map(|(name, origin)| (name, origin.as_str())).chain(drawn.map(|name| (name, "a group")));
    for (name, origin) in missing {
        if !elements.contains_key(name) && !own(name) {
            let message = format!("there is no state `{name}`, in which agents of {origin} begin");
            return Err(root.fault(message, "add the state, or correct its name in the scene file"));
        }
    }
    Ok(())
}

/// A state whose goal others share remembers it.
fn remember_shared(scene: &mut Scene) {
    let shared: BTreeSet<String> = scene
        .states
        .iter()
        .filter_map(|state| match &state.movement {
            SceneMovement::Go { remember: Some(Remember::Of(of)), .. } => Some(of.clone()),
            _ => None,
        })
        .collect();
    for state in scene.states.iter_mut().filter(|state| shared.contains(&state.name)) {
        if let SceneMovement::Go { remember: remember @ None, .. } = &mut state.movement {
            *remember = Some(Remember::Own);
        }
    }
}

/// The outline of the meshes on which agents find their routes, where it holds all starts and goals: routes stay inside.
fn read_outline(
    files: &mut ProjectFiles,
    meshes: &BTreeSet<std::path::PathBuf>,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    if !scene.walkable.is_empty() {
        return Ok(());
    }
    let mut outlines: Vec<Walkable> = Vec::new();
    for path in meshes {
        let text = crate::error::read_text(path)?;
        let mut walkable = with_holes(NavMesh::parse(&text)?.outlines_m(), &files.shown(path));
        // Obstacles stand in the holes.
        walkable.iter_mut().for_each(|walkable| walkable.holes_m.clear());
        outlines.append(&mut walkable);
    }
    let holds = |at_m: Point| outlines.iter().any(|outline| contains(&outline.polygon_m, at_m));
    let starts_inside = scene.agents.iter().all(|agents| agents.starts.all(holds));
    let mut places = scene.goals.iter().flat_map(|goals| &goals.places);
    if outlines.is_empty() || (starts_inside && places.all(|place| holds(place.shape.middle_m()))) {
        scene.walkable = outlines;
    } else {
        let what = "starts or goals lie outside the navigation mesh; its outline is not used, routes may leave it";
        scene.notes.add(&outlines[0].origin, 0, what, true);
    }
    Ok(())
}
