//! The scene file: profiles, groups of agents, obstacle sets, elevation.

use crate::error::SceneError;
use crate::menge::files::ProjectFiles;
use crate::menge::generators::read_starts;
use crate::menge::nav_mesh::NavMesh;
use crate::menge::obstacle_sets::read_obstacle_set;
use crate::menge::profiles::Profiles;
use crate::menge::xml::Element;
use crate::scene::{
    Scene, SceneAgents, SceneCondition, SceneMovement, SceneSettings, SceneState, SceneTarget, SceneTransition,
};

/// Radius of the disc that walls hold where a scenario states none, m.
const WALL_RADIUS_M: f64 = 0.2;
/// Greatest number of agents, as in scenario files.
pub(crate) const AGENTS_MAX: usize = 1_000_000;

/// Reads the scene file into the scene; the numbers of its profiles are needed by the behaviour.
pub(crate) fn read_scene(
    files: &mut ProjectFiles,
    project: &Element<'_>,
    scene: &mut Scene,
) -> Result<Profiles, SceneError> {
    let file = files.xml(project, "scene")?;
    let document = file.document()?;
    let experiment = file.root(&document, "Experiment")?;
    let mut profiles = Profiles::default();
    for profile in experiment.named("AgentProfile") {
        profiles.read(&profile, scene)?;
    }
    for group in experiment.named("AgentGroup") {
        read_group(files, &group, &mut profiles, scene)?;
    }
    scene.profiles = profiles.used();
    for set in experiment.named("ObstacleSet") {
        read_obstacle_set(files, &set, &mut profiles, scene)?;
    }
    for elevation in experiment.named("Elevation") {
        read_elevation(files, &elevation, scene)?;
    }
    if let Some(common) = experiment.child("Common")
        && let Some(step_s) = common.number("time_step")?
    {
        let what = format!("the time step of {step_s} s is not used; bodies need the default of 1/30 s");
        scene.notes.add(&common.file.shown, common.line(), what, false);
    }
    for query in experiment.named("SpatialQuery").filter(|query| query.kind() != "kd-tree") {
        let what = "the spatial query is not used; agents see each other within a range, through walls too";
        scene.notes.add(&query.file.shown, query.line(), what, false);
    }
    Ok(profiles)
}

fn read_group(
    files: &mut ProjectFiles,
    group: &Element<'_>,
    profiles: &mut Profiles,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    let part = |name: &'static str| {
        group.child(name).ok_or_else(|| group.fault(format!("the group has no <{name}>"), "add it"))
    };
    let selected = selected_profiles(&part("ProfileSelector")?, scene)?;
    let states = selected_states(&part("StateSelector")?, scene)?;
    part("Generator")?;
    let mut shares: Vec<(String, f64)> = Vec::new();
    let (mut radius_max_m, mut radii_m) = (0.0_f64, Vec::new());
    for (name, weight, selector) in &selected {
        let profile = profiles.use_named(name, selector)?;
        radius_max_m = radius_max_m.max(profile.radius_m.bounds()[1]);
        radii_m.push(profile.radius_m.constant());
        match shares.iter_mut().find(|(shown, _)| *shown == profile.shown) {
            Some((_, share)) => *share += weight,
            None => shares.push((profile.shown.clone(), *weight)),
        }
    }
    let state = start_state(&states, group, scene);
    profiles.begin_in(&state, &selected);
    // The discs of the source hold walls too.
    let wall_radius_m = radii_m[0].filter(|radius_m| radii_m.iter().all(|other_m| *other_m == Some(*radius_m)));
    // Each generator adds its agents.
    let has_several = group.named("Generator").count() > 1;
    for generator in group.named("Generator") {
        let room = AGENTS_MAX - scene.agent_count();
        let starts = read_starts(files, &generator, room, scene)?;
        scene.agents.push(SceneAgents {
            starts,
            profiles: shares.clone(),
            state: Some(state.clone()),
            radius_max_m,
            wall_radius_m: wall_radius_m.filter(|radius_m| *radius_m > WALL_RADIUS_M),
            own_goal_mirrors: None,
            origin: if has_several { generator.origin() } else { group.origin() },
        });
    }
    Ok(())
}

/// Name, weight and element of each profile that a selector names.
type Selected<'a> = Vec<(String, f64, Element<'a>)>;

fn selected_profiles<'a>(selector: &Element<'a>, scene: &mut Scene) -> Result<Selected<'a>, SceneError> {
    selected(selector, "Profile", scene)
}

fn selected_states<'a>(selector: &Element<'a>, scene: &mut Scene) -> Result<Selected<'a>, SceneError> {
    selected(selector, "State", scene)
}

fn selected<'a>(selector: &Element<'a>, item: &'static str, scene: &mut Scene) -> Result<Selected<'a>, SceneError> {
    if selector.kind() == "const" {
        return Ok(vec![(selector.required("name")?.to_owned(), 1.0, *selector)]);
    }
    let is_weighted = selector.kind() == "weighted";
    if !is_weighted && selector.kind() != "random" {
        let what = format!("the selector \"{}\" is unknown; each of its items is as likely", selector.kind());
        scene.notes.add(&selector.file.shown, selector.line(), what, true);
    }
    let mut items = Vec::new();
    for child in selector.named(item) {
        let weight = if is_weighted { child.required_number("weight")?.max(0.0) } else { 1.0 };
        items.push((child.required("name")?.to_owned(), weight, child));
    }
    if items.is_empty() || items.iter().map(|(_, weight, _)| weight).sum::<f64>() <= 0.0 {
        return Err(selector.fault(format!("the selector has no <{item}> with a weight"), "add one"));
    }
    Ok(items)
}

/// The state in which a group begins; several become the targets of a state of their own.
fn start_state(states: &Selected<'_>, group: &Element<'_>, scene: &mut Scene) -> String {
    if let [(only, ..)] = &states[..] {
        return only.clone();
    }
    let name = format!("begin_line_{}", group.line());
    let weights = states.iter().map(|(name, weight, _)| (name.clone(), *weight)).collect();
    scene.states.push(SceneState {
        name: name.clone(),
        movement: SceneMovement::Stand,
        settings: SceneSettings::default(),
        transitions: vec![SceneTransition { when: SceneCondition::Always, to: SceneTarget::Weights(weights) }],
        comment: "draws the first state".to_owned(),
    });
    name
}

fn read_elevation(files: &mut ProjectFiles, elevation: &Element<'_>, scene: &mut Scene) -> Result<(), SceneError> {
    let (shown, line) = (&elevation.file.shown, elevation.line());
    match elevation.kind() {
        "flat" => {}
        "nav_mesh" => {
            let text = files.text(elevation, "file_name")?;
            let mesh = NavMesh::parse(&text)?;
            let what = match mesh.sloped_nodes {
                0 => "the elevation is flat everywhere".to_owned(),
                count => format!("the ground is made flat; {count} of {} nodes are sloped", mesh.node_count()),
            };
            scene.notes.add(shown, line, what, mesh.sloped_nodes > 0);
        }
        kind => scene.notes.add(shown, line, format!("the elevation \"{kind}\" is made flat"), true),
    }
    Ok(())
}
