//! Well-known text (WKT, OGC 06-103r4), as JuPedSim writes its geometries: POLYGON, MULTIPOLYGON, GEOMETRYCOLLECTION.
//! Metres.

use std::ops::Range;
use std::path::Path;
use std::str::FromStr;

use wkt::Wkt;
use wkt::types::{Coord, LineString, Polygon};

use crate::error::{SceneError, read_text};
use crate::plans::rings_of_plan::{PlanFault, move_near_origin, ring as ring_of_plan, walkable};
use crate::scene::{Point, Scene};

/// Greatest depth of brackets: a collection of collections of multipolygons. The parser calls itself at each.
const BRACKETS_MAX: usize = 16;
/// How to mend a geometry that is no polygon.
const POLYGONS_ONLY: &str = "give POLYGON, MULTIPOLYGON, or a GEOMETRYCOLLECTION of them, with x and y alone";

/// Reads a plan.
pub(crate) fn read(path: &Path) -> Result<Scene, SceneError> {
    let source = read_text(path)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut scene = Scene { kind: "WKT plan", source: name, ..Scene::default() };
    let fault = |(message, help): PlanFault| {
        let invalid = source.invalid(0..0, message, help);
        SceneError::from(motiondb::files::Invalid { is_quotable: false, ..invalid })
    };
    check_depth(&source.text).map_err(fault)?;
    let geometry = Wkt::<f64>::from_str(source.text.trim())
        .map_err(|message| fault((format!("this is no well-known text: {message}"), POLYGONS_ONLY)))?;
    let mut ring = 0;
    add(&geometry, &mut scene, &mut ring).map_err(|(message, help)| {
        let invalid = source.invalid(ring_place(&source.text, ring), message, help);
        SceneError::from(motiondb::files::Invalid { is_quotable: false, ..invalid })
    })?;
    if scene.walkable.is_empty() {
        return Err(fault(("there is no polygon".into(), POLYGONS_ONLY)));
    }
    move_near_origin(&mut scene).map_err(fault)?;
    Ok(scene)
}

fn check_depth(text: &str) -> Result<(), PlanFault> {
    let mut depth = 0_usize;
    for byte in text.bytes() {
        depth = match byte {
            b'(' => depth + 1,
            b')' => depth.saturating_sub(1),
            _ => depth,
        };
        if depth > BRACKETS_MAX {
            return Err((format!("brackets are nested more than {BRACKETS_MAX} deep"), POLYGONS_ONLY));
        }
    }
    Ok(())
}

/// The first byte of a ring of a polygon, by its number among all rings of polygons.
fn ring_place(text: &str, ring: usize) -> Range<usize> {
    let (mut word, mut kind) = (0..0, "");
    let (mut open, mut rings) = (None, 0);
    for (at, letter) in text.char_indices() {
        match letter {
            _ if letter.is_ascii_alphabetic() => {
                word = if word.end == at { word.start..at + 1 } else { at..at + 1 };
                // `POLYGON Z` and `POLYGON M` are polygons too.
                let is_dimension = ["Z", "M", "ZM"].contains(&&text[word.clone()]);
                kind = if is_dimension { kind } else { &text[word.clone()] };
            }
            '(' => open = Some(at),
            ')' => {
                let is_polygon = ["POLYGON", "MULTIPOLYGON"].iter().any(|name| kind.eq_ignore_ascii_case(name));
                if let Some(begin) = open.take().filter(|_| is_polygon) {
                    if rings == ring {
                        return begin..begin;
                    }
                    rings += 1;
                }
            }
            _ => {}
        }
    }
    0..0
}

/// Adds a geometry; `ring` counts the rings before, on a mistake those before the wrong one.
fn add(geometry: &Wkt<f64>, scene: &mut Scene, ring: &mut usize) -> Result<(), PlanFault> {
    match geometry {
        Wkt::Polygon(polygon) => add_polygon(polygon, scene, ring),
        Wkt::MultiPolygon(all) => all.polygons().iter().try_for_each(|polygon| add_polygon(polygon, scene, ring)),
        Wkt::GeometryCollection(all) => all.geometries().iter().try_for_each(|geometry| add(geometry, scene, ring)),
        _ => {
            let source = scene.source.clone();
            scene.notes.add(&source, 0, "points and lines are left out; polygons are the ground", true);
            Ok(())
        }
    }
}

fn add_polygon(polygon: &Polygon<f64>, scene: &mut Scene, ring: &mut usize) -> Result<(), PlanFault> {
    let mut rings_m: Vec<Vec<Point>> = Vec::new();
    for line in polygon.rings() {
        let ring_m = positions_m(line)?;
        ring_of_plan(&ring_m)?;
        rings_m.push(ring_m);
        *ring += 1;
    }
    scene.walkable.extend(walkable(&rings_m, "")?);
    Ok(())
}

fn positions_m(ring: &LineString<f64>) -> Result<Vec<Point>, PlanFault> {
    let position_m = |coord: &Coord<f64>| match coord {
        Coord { x, y, z: None, m: None } => Ok([*x, *y]),
        _ => Err(("a position has a third coordinate".to_owned(), "give x and y alone; the ground is flat")),
    };
    ring.coords().iter().map(position_m).collect()
}
