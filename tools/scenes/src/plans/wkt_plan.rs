//! Well-known text (WKT, OGC 06-103r4), as JuPedSim writes its geometries: POLYGON, MULTIPOLYGON, GEOMETRYCOLLECTION.
//! Metres.

use std::path::Path;
use std::str::FromStr;

use motiondb::files::{Invalid, SourceText};
use wkt::Wkt;
use wkt::types::{Coord, LineString, Polygon};

use crate::error::{SceneError, read_text};
use crate::plans::coordinate_system::{CoordinateSystem, PROJECT_IT};
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
        SceneError::from(Invalid { is_quotable: false, ..invalid })
    };
    check_depth(&source.text).map_err(fault)?;
    let text = without_system(&source, &mut scene)?;
    let geometry = Wkt::<f64>::from_str(text)
        .map_err(|message| fault((format!("this is no well-known text: {message}"), POLYGONS_ONLY)))?;
    let mut reader = PlanReader { scene, places: ring_places(&source.text), ring: 0 };
    reader.add(&geometry).map_err(|(message, help)| {
        let at = reader.places.get(reader.ring).map_or(0, |place| place.byte);
        let invalid = source.invalid(at..at, message, help);
        SceneError::from(Invalid { is_quotable: false, ..invalid })
    })?;
    let mut scene = reader.scene;
    if scene.walkable.is_empty() {
        return Err(fault(("there is no polygon".into(), POLYGONS_ONLY)));
    }
    move_near_origin(&mut scene).map_err(fault)?;
    Ok(scene)
}

/// The geometry of an extended text, which begins with `SRID=…;`: its coordinate system is noted.
fn without_system<'a>(source: &'a SourceText, scene: &mut Scene) -> Result<&'a str, SceneError> {
    let text = source.text.trim();
    let Some((system, geometry)) = text.split_once(';') else { return Ok(text) };
    let Some((_, code)) = system.split_once('=').filter(|(key, _)| key.trim().eq_ignore_ascii_case("SRID")) else {
        return Ok(text);
    };
    let CoordinateSystem { name, is_in_degrees, stretch } = CoordinateSystem::of_name(&format!("EPSG:{}", code.trim()));
    if is_in_degrees {
        let invalid = source.invalid(0..0, format!("the coordinates are degrees of {name}"), PROJECT_IT);
        return Err(Invalid { is_quotable: false, ..invalid }.into());
    }
    let shown = scene.source.clone();
    scene.notes.add(&shown, 1, format!("coordinates of {name} are taken as metres{stretch}"), !stretch.is_empty());
    Ok(geometry.trim())
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

/// Where a ring begins.
struct RingPlace {
    byte: usize,
    /// From 1.
    line: usize,
}

/// The places of all rings of polygons, in order.
fn ring_places(text: &str) -> Vec<RingPlace> {
    let (mut word, mut kind, mut line) = (0..0, "", 1);
    let (mut open, mut places) = (None, Vec::new());
    for (at, letter) in text.char_indices() {
        match letter {
            '\n' => line += 1,
            _ if letter.is_ascii_alphabetic() => {
                word = if word.end == at { word.start..at + 1 } else { at..at + 1 };
                // `POLYGON Z` and `POLYGON M` are polygons too.
                let is_dimension = ["Z", "M", "ZM"].contains(&&text[word.clone()]);
                kind = if is_dimension { kind } else { &text[word.clone()] };
            }
            '(' => open = Some(RingPlace { byte: at, line }),
            ')' => {
                let is_polygon = ["POLYGON", "MULTIPOLYGON"].iter().any(|name| kind.eq_ignore_ascii_case(name));
                places.extend(open.take().filter(|_| is_polygon));
            }
            _ => {}
        }
    }
    places
}

/// A scene as far as it is read.
struct PlanReader {
    scene: Scene,
    places: Vec<RingPlace>,
    /// Number of rings before; on a mistake, of those before the wrong one.
    ring: usize,
}

impl PlanReader {
    fn add(&mut self, geometry: &Wkt<f64>) -> Result<(), PlanFault> {
        match geometry {
            Wkt::Polygon(polygon) => self.add_polygon(polygon),
            Wkt::MultiPolygon(all) => all.polygons().iter().try_for_each(|polygon| self.add_polygon(polygon)),
            Wkt::GeometryCollection(all) => all.geometries().iter().try_for_each(|geometry| self.add(geometry)),
            _ => {
                let source = self.scene.source.clone();
                self.scene.notes.add(&source, 0, "points and lines are left out; polygons are the ground", true);
                Ok(())
            }
        }
    }

    fn add_polygon(&mut self, polygon: &Polygon<f64>) -> Result<(), PlanFault> {
        let source = &self.scene.source;
        let origin = self.places.get(self.ring).map_or_else(String::new, |place| format!("{source}:{}", place.line));
        let mut rings_m: Vec<Vec<Point>> = Vec::new();
        for line in polygon.rings() {
            let ring_m = positions_m(line)?;
            ring_of_plan(&ring_m)?;
            rings_m.push(ring_m);
            self.ring += 1;
        }
        self.scene.walkable.extend(walkable(&rings_m, &origin)?);
        Ok(())
    }
}

fn positions_m(ring: &LineString<f64>) -> Result<Vec<Point>, PlanFault> {
    let position_m = |coord: &Coord<f64>| match coord {
        Coord { x, y, z: None, m: None } => Ok([*x, *y]),
        _ => Err(("a position has a third coordinate".to_owned(), "give x and y alone; the ground is flat")),
    };
    ring.coords().iter().map(position_m).collect()
}
