//! The order of reading: bounds, obstacles, targets, sources, agents. World, metres.

use std::path::Path;

use motiondb::files::{Invalid, SourceText};

use crate::error::{SceneError, read_text};
use crate::geometry::polygon::{CORNERS_MAX, is_simple, without_repeats};
use crate::geometry::walls::of_line;
use crate::json_place::{JsonStep, place, shown};
use crate::scene::{DrawnNumber, Point, Scene, SceneMeasure, SceneObstacle, SceneProfile, Shape, Walkable};
use crate::vadere::shapes::{PROFILE, PlacedFault, VadereFault, at_item, check_points, check_shape, corners_m};
use crate::vadere::sources::read_sources;
use crate::vadere::targets::Targets;
use crate::vadere::vadere_file::{VadereFile, VadereSimulation, VadereTopography};

/// Greatest number of obstacles, of targets and of sources.
const ITEMS_MAX: usize = 10_000;
/// Simulated times that a scenario takes, s.
const DURATIONS_S: [f64; 2] = [0.1, 86_400.0];
/// Releases whose files are tested.
const TESTED: [&str; 2] = ["2.4", "3.0"];

/// Reads a scenario.
pub(crate) fn read(path: &Path) -> Result<Scene, SceneError> {
    let source = read_text(path)?;
    let file: VadereFile = serde_json::from_str(&source.text).map_err(|error| unparsed(&source, &error))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut scene = Scene { kind: "Vadere scenario", source: name.clone(), ..Scene::default() };
    let release = file.release.as_deref().unwrap_or("without release");
    if !TESTED.contains(&release) {
        scene.notes.add(&name, 0, format!("release {release:.20} is not tested; 2.4 and 3.0 are"), false);
    }
    read_simulation(&file.scenario.attributes_simulation, &mut scene);
    let topography = &file.scenario.topography;
    read_topography(topography, &mut scene).map_err(|fault| misplaced(&source, fault))?;
    note_unsupported(topography, &mut scene);
    Ok(scene)
}

fn read_simulation(simulation: &VadereSimulation, scene: &mut Scene) {
    if let Some(finish_s) = simulation.finish_time {
        let [least, greatest] = DURATIONS_S;
        let duration_s = finish_s.clamp(least, greatest);
        if duration_s != finish_s {
            let source = scene.source.clone();
            let what = format!("`finishTime` {finish_s:e} s is cut to {duration_s} s");
            scene.notes.add(&source, 0, what, true);
        }
        scene.duration_s = Some(duration_s);
    }
    if simulation.use_fixed_seed {
        scene.seed = simulation.fixed_seed.map(i64::unsigned_abs);
    }
}

/// A mistake at the line of its item.
fn misplaced(source: &SourceText, (steps, (message, help)): PlacedFault) -> SceneError {
    let path = [&[JsonStep::Key("scenario"), JsonStep::Key("topography")], &steps[..]].concat();
    let invalid = source.invalid(place(&source.text, &path), format!("{}: {message}", shown(&path)), help);
    Invalid { is_quotable: false, ..invalid }.into()
}

fn unparsed(source: &SourceText, error: &serde_json::Error) -> SceneError {
    let lines = source.text.split_inclusive('\n').take(error.line().saturating_sub(1));
    let begin = lines.map(str::len).sum::<usize>();
    let message = format!("this is no scenario of Vadere: {error}");
    Invalid { is_quotable: false, ..source.invalid(begin..begin, message, "name a file of Vadere 2.4 or 3.0") }.into()
}

fn read_topography(topography: &VadereTopography, scene: &mut Scene) -> Result<(), PlacedFault> {
    let VadereTopography { obstacles, targets, sources, .. } = topography;
    if [obstacles.len(), targets.len(), sources.len()].iter().any(|count| *count > ITEMS_MAX) {
        return Err((Vec::new(), ("there are more than 10,000 obstacles, targets or sources".into(), "give fewer")));
    }
    let bounds = &topography.attributes;
    let [low_m, high_m] = bounds.bounds.corners_m();
    let at_bounds = |fault| (vec![JsonStep::Key("attributes"), JsonStep::Key("bounds")], fault);
    check_points(&[low_m, high_m]).map_err(at_bounds)?;
    if bounds.bounded {
        let wall_m = bounds.bounding_box_width.max(0.0);
        let [[left, low], [right, high]] = [low_m.map(|metres| metres + wall_m), high_m.map(|metres| metres - wall_m)];
        if !(left < right && low < high) {
            return Err(at_bounds(("the bounds hold no ground".into(), "give them a width and a height")));
        }
        let polygon_m = vec![[left, low], [right, low], [right, high], [left, high]];
        scene.walkable.push(Walkable { polygon_m, holes_m: Vec::new(), origin: "bounds".to_owned() });
    }
    for (index, obstacle) in obstacles.iter().enumerate() {
        let origin = format!("obstacle {}", obstacle.id);
        add_obstacle(&obstacle.shape.shape(), &origin, scene).map_err(at_item("obstacles", index))?;
    }
    let pedestrian = &topography.attributes_pedestrian;
    let within = |number: f64, least: f64, greatest: f64| number.clamp(least, greatest);
    let [least, greatest] = [pedestrian.minimum_speed, pedestrian.maximum_speed].map(|speed| within(speed, 0.1, 10.0));
    let radius_m = within(pedestrian.radius, 0.1, 1.0);
    scene.profiles.push(SceneProfile {
        name: PROFILE.to_owned(),
        inherits: None,
        preferred_speed_mps: Some(DrawnNumber::Normal {
            mean: within(pedestrian.speed_distribution_mean, 0.1, 10.0),
            deviation: within(pedestrian.speed_distribution_standard_deviation, 0.0, 10.0),
            min: Some(least.min(greatest)),
            max: Some(least.max(greatest)),
        }),
        radius_m: Some(DrawnNumber::Constant(radius_m)),
        origin: "attributesPedestrian".to_owned(),
    });
    let mut all = Targets::read(targets, scene)?;
    read_sources(topography, radius_m, &mut all, scene)?;
    all.write_states(scene);
    for (index, area) in topography.measurement_areas.iter().enumerate() {
        let shape = area.shape.shape();
        check_shape(&shape).map_err(at_item("measurementAreas", index))?;
        let before = topography.measurement_areas[..index].iter().filter(|other| other.id == area.id).count();
        let number = if before > 0 { format!(" ({})", before + 1) } else { String::new() };
        let name = format!("measurement area {}{number}", area.id);
        scene.measures.push(SceneMeasure { name, shape, origin: String::new() });
    }
    Ok(())
}

fn add_obstacle(shape: &Shape, origin: &str, scene: &mut Scene) -> Result<(), VadereFault> {
    let corners_m = corners_m(shape);
    check_points(&corners_m)?;
    let corners_m = without_repeats(&corners_m);
    if corners_m.len() > CORNERS_MAX {
        return Err((format!("{origin} has more than {CORNERS_MAX} corners"), "simplify it"));
    }
    let add = |polygon_m: Vec<Point>| SceneObstacle { polygon_m, is_enclosure: false, origin: origin.to_owned() };
    if is_simple(&corners_m) {
        scene.obstacles.push(add(corners_m));
    } else {
        let source = scene.source.clone();
        let what = format!("{origin} crosses itself; it becomes walls 2 cm thick along its edges");
        scene.notes.add(&source, 0, what, true);
        scene.obstacles.extend(of_line(&corners_m, true).into_iter().map(add));
    }
    Ok(())
}

fn note_unsupported(topography: &VadereTopography, scene: &mut Scene) {
    let source = scene.source.clone();
    let mut note = |count: usize, what: &str| {
        if count > 0 {
            scene.notes.add(&source, 0, format!("{count} {what}"), true);
        }
    };
    note(topography.stairs.len(), "stairs are level ground");
    note(topography.target_changers.len(), "target changers are left out");
    note(topography.absorbing_areas.len(), "absorbing areas are left out");
    let is_set = |value: &&serde_json::Value| !value.is_null();
    note(topography.teleporter.iter().filter(is_set).count(), "teleporter is left out");
}
