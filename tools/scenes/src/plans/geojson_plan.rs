//! GeoJSON (RFC 7946): Polygon, MultiPolygon, collections and features of them. Coordinates are taken as metres.

use std::path::Path;
use std::str::FromStr;

use geojson::{GeoJson, Geometry, GeometryValue, Position};
use motiondb::files::{Invalid, SourceText};

use crate::error::{SceneError, read_text};
use crate::geometry::polygon::bounds_m;
use crate::json_place::{JsonStep, place, shown};
use crate::plans::coordinate_system::{CoordinateSystem, PROJECT_IT};
use crate::plans::rings_of_plan::{PlanFault, move_near_origin, ring, walkable};
use crate::scene::{Point, Scene};

/// Extent below which a plan is surely in degrees, m: smaller than a room.
const DEGREES_M: f64 = 0.5;
/// Deepest nesting of collections.
const DEPTH_MAX: usize = 16;

/// Reads a plan.
pub(crate) fn read(path: &Path) -> Result<Scene, SceneError> {
    let source = read_text(path)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut scene = Scene { kind: "GeoJSON plan", source: name, ..Scene::default() };
    let fault = |(message, help): PlanFault| {
        let invalid = source.invalid(0..0, message, help);
        SceneError::from(Invalid { is_quotable: false, ..invalid })
    };
    let help = "give a Polygon, MultiPolygon, or a collection or features of them";
    let json =
        GeoJson::from_str(&source.text).map_err(|error| fault((format!("this is no GeoJSON: {error}"), help)))?;
    note_coordinates(&source, &json, &mut scene)?;
    let geometries: Vec<(Vec<JsonStep>, &Geometry)> = match &json {
        GeoJson::Geometry(geometry) => vec![(Vec::new(), geometry)],
        GeoJson::Feature(feature) => {
            feature.geometry.iter().map(|geometry| (vec![JsonStep::Key("geometry")], geometry)).collect()
        }
        GeoJson::FeatureCollection(all) => {
            let path = |index| vec![JsonStep::Key("features"), JsonStep::Item(index), JsonStep::Key("geometry")];
            let features = all.features.iter().enumerate();
            features.filter_map(|(index, feature)| Some((path(index), feature.geometry.as_ref()?))).collect()
        }
    };
    let mut positions_m = Vec::new();
    geometries.iter().for_each(|(_, geometry)| collect_positions(&geometry.value, &mut positions_m));
    check_metres(&positions_m).map_err(fault)?;
    for (mut path, geometry) in geometries {
        add(&geometry.value, &mut scene, &mut path, DEPTH_MAX).map_err(|(message, help)| {
            let message = if path.is_empty() { message } else { format!("{}: {message}", shown(&path)) };
            let invalid = source.invalid(place(&source.text, &path), message, help);
            SceneError::from(Invalid { is_quotable: false, ..invalid })
        })?;
    }
    if scene.walkable.is_empty() {
        return Err(fault(("there is no polygon".into(), help)));
    }
    move_near_origin(&mut scene).map_err(fault)?;
    Ok(scene)
}

/// Refuses a coordinate system in degrees; notes any other.
fn note_coordinates(source: &SourceText, json: &GeoJson, scene: &mut Scene) -> Result<(), SceneError> {
    let Some(CoordinateSystem { name, is_in_degrees, stretch }) = CoordinateSystem::of(json) else {
        let shown = scene.source.clone();
        scene.notes.add(&shown, 0, "coordinates are taken as metres", false);
        return Ok(());
    };
    let at = place(&source.text, &[JsonStep::Key("crs")]);
    if is_in_degrees {
        let invalid = source.invalid(at, format!("the coordinates are degrees of {name}"), PROJECT_IT);
        return Err(Invalid { is_quotable: false, ..invalid }.into());
    }
    let line = 1 + source.text[..at.start].matches('\n').count();
    let shown = scene.source.clone();
    scene.notes.add(&shown, line, format!("coordinates of {name} are taken as metres{stretch}"), !stretch.is_empty());
    Ok(())
}

/// GeoJSON states degrees; plans of rooms are drawn in metres all the same.
fn check_metres(positions_m: &[Point]) -> Result<(), PlanFault> {
    let [low_m, high_m] = bounds_m(positions_m);
    if !positions_m.is_empty() && (0..2).all(|axis| high_m[axis] - low_m[axis] < DEGREES_M) {
        return Err(("the plan is less than 0.5 m across, so its coordinates are degrees".into(), PROJECT_IT));
    }
    Ok(())
}

/// Collects x and y of all positions of polygons. The parser bounds the nesting.
fn collect_positions(geometry: &GeometryValue, positions_m: &mut Vec<Point>) {
    let mut add = |rings: &[Vec<Position>]| {
        let first_two = |position: &Position| Some([*position.as_slice().first()?, *position.as_slice().get(1)?]);
        positions_m.extend(rings.iter().flatten().filter_map(first_two));
    };
    match geometry {
        GeometryValue::Polygon { coordinates } => add(coordinates),
        GeometryValue::MultiPolygon { coordinates } => coordinates.iter().for_each(|rings| add(rings)),
        GeometryValue::GeometryCollection { geometries } => {
            geometries.iter().for_each(|geometry| collect_positions(&geometry.value, positions_m));
        }
        _ => {}
    }
}

/// Adds a geometry; on a mistake, the path leads to it.
fn add(geometry: &GeometryValue, scene: &mut Scene, path: &mut Vec<JsonStep>, depth: usize) -> Result<(), PlanFault> {
    if depth == 0 {
        return Err((format!("collections are nested deeper than {DEPTH_MAX}"), "nest them less"));
    }
    let before = path.len();
    match geometry {
        GeometryValue::Polygon { coordinates } => {
            path.push(JsonStep::Key("coordinates"));
            add_polygon(coordinates, scene, path)?;
        }
        GeometryValue::MultiPolygon { coordinates } => {
            for (index, polygon) in coordinates.iter().enumerate() {
                path.truncate(before);
                path.extend([JsonStep::Key("coordinates"), JsonStep::Item(index)]);
                add_polygon(polygon, scene, path)?;
            }
        }
        GeometryValue::GeometryCollection { geometries } => {
            for (index, geometry) in geometries.iter().enumerate() {
                path.truncate(before);
                path.extend([JsonStep::Key("geometries"), JsonStep::Item(index)]);
                add(&geometry.value, scene, path, depth - 1)?;
            }
        }
        _ => {
            let source = scene.source.clone();
            scene.notes.add(&source, 0, "points and lines are left out; polygons are the ground", true);
        }
    }
    path.truncate(before);
    Ok(())
}

fn add_polygon(rings: &[Vec<Position>], scene: &mut Scene, path: &mut Vec<JsonStep>) -> Result<(), PlanFault> {
    let mut rings_m: Vec<Vec<Point>> = Vec::new();
    for (index, positions) in rings.iter().enumerate() {
        path.push(JsonStep::Item(index));
        let mut ring_m = Vec::new();
        for (index, position) in positions.iter().enumerate() {
            let [x, y] = *position.as_slice() else {
                path.push(JsonStep::Item(index));
                return Err(("a position has a third coordinate".to_owned(), "give x and y alone; the ground is flat"));
            };
            ring_m.push([x, y]);
        }
        ring(&ring_m)?;
        rings_m.push(ring_m);
        path.pop();
    }
    let origin = format!("{}: {}", scene.source, shown(path));
    scene.walkable.extend(walkable(&rings_m, &origin)?);
    Ok(())
}
