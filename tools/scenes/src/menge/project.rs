//! The project file: what it names is read in order, scene, behaviour, view.

use std::path::{Path, PathBuf};

use crate::error::SceneError;
use crate::menge::behaviour_file::read_behaviour;
use crate::menge::files::ProjectFiles;
use crate::menge::scene_file::read_scene;
use crate::menge::xml::Element;
use crate::scene::Scene;

/// Simulated time of a project that states none, s; Menge's.
const DURATION_S: f64 = 400.0;
/// Greatest simulated time, s: a day, as in scenario files.
const DURATION_MAX_S: f64 = 86_400.0;
/// Width and height of a picture that a scenario takes, pixels.
const PICTURE_PIXELS: std::ops::RangeInclusive<u64> = 16..=8_192;

/// Reads a project. Returns its scene and the files that were read.
pub(crate) fn read(path: &Path, allow_outside: bool) -> Result<(Scene, Vec<PathBuf>), SceneError> {
    let mut files = ProjectFiles::new(path, allow_outside)?;
    let file = files.project(path)?;
    let document = file.document()?;
    let project = file.root(&document, "Project")?;
    let mut scene = Scene { kind: "Menge project", source: file.shown.clone(), ..Scene::default() };
    read_settings(&project, &mut scene)?;
    let profiles = read_scene(&mut files, &project, &mut scene)?;
    read_behaviour(&mut files, &project, &profiles, &mut scene)?;
    if project.text("view").is_some() {
        read_view(&mut files, &project, &mut scene)?;
    }
    Ok((scene, files.inputs))
}

fn read_settings(project: &Element<'_>, scene: &mut Scene) -> Result<(), SceneError> {
    let duration_s = project.number("duration")?.unwrap_or(DURATION_S);
    if !(0.1..=DURATION_MAX_S).contains(&duration_s) {
        let message = format!("`duration` is {duration_s} s");
        return Err(project.attribute_fault("duration", message, "give 0.1 s to a day"));
    }
    scene.duration_s = project.number("duration")?;
    scene.seed = project.count("random")?.filter(|seed| *seed > 0);
    if let Some(model) = project.text("model") {
        scene
            .remarks
            .push(format!("The project's pedestrian model is \"{model}\"; this scenario keeps the planner \"mcn\"."));
    }
    Ok(())
}

fn read_view(files: &mut ProjectFiles, project: &Element<'_>, scene: &mut Scene) -> Result<(), SceneError> {
    let file = files.xml(project, "view")?;
    let document = file.document()?;
    let view = file.root(&document, "View")?;
    if let (Some(width), Some(height)) = (view.count("width")?, view.count("height")?)
        && PICTURE_PIXELS.contains(&width)
        && PICTURE_PIXELS.contains(&height)
    {
        scene.picture = Some([width, height]);
    }
    if view.child("Camera").is_some() {
        let what = "cameras, lights and watermarks are not used; pictures frame the whole scene";
        scene.notes.add(&file.shown, view.line(), what, false);
    }
    Ok(())
}
