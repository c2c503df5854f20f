//! DXF drawings in text: closed polylines are obstacles; those of a layer whose name contains "walkable" are ground.
//!
//! Read are the unit of the header, `LWPOLYLINE`, and `POLYLINE` with its `VERTEX`; arcs become chords. All else is
//! counted in a note: a plan is drawn by closed polylines.

use std::collections::BTreeMap;
use std::path::Path;

use motiondb::files::SourceText;

use crate::error::SceneError;
use crate::geometry::polygon::distance_m;
use crate::plans::dxf_pairs::{Pair, fault, pairs, read_text};
use crate::plans::rings_of_plan::{move_near_origin, ring};
use crate::scene::{Point, Scene, SceneObstacle, Walkable};

/// Angle of a chord of an arc, rad: 15°.
const CHORD_RAD: f64 = std::f64::consts::PI / 12.0;
/// Part of the name of a layer that holds the ground.
const WALKABLE: &str = "walkable";
/// Group code of the x of a vertex.
const X: i32 = 10;
/// Group code of the y of a vertex.
const Y: i32 = 20;
/// Group code of a layer's name.
const LAYER: i32 = 8;
/// Group code of flags; the lowest bit of a polyline's: it is closed.
const FLAGS: i32 = 70;
/// Group code of the number of vertices of an `LWPOLYLINE`.
const VERTICES: i32 = 90;
/// Group code of the bulge after a vertex: the tangent of a quarter of the arc's angle.
const BULGE: i32 = 42;
/// Group code of the z of the extrusion; a negative one mirrors x.
const EXTRUSION_Z: i32 = 230;

/// Unit of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// Metre.
    Metres,
    /// Centimetre.
    Centimetres,
    /// Millimetre.
    Millimetres,
    /// Inch.
    Inches,
    /// Foot.
    Feet,
}

impl Units {
    /// The unit of a short name: m, cm, mm, in, ft.
    pub fn of_name(name: &str) -> Option<Self> {
        Some(match name {
            "m" => Self::Metres,
            "cm" => Self::Centimetres,
            "mm" => Self::Millimetres,
            "in" => Self::Inches,
            "ft" => Self::Feet,
            _ => return None,
        })
    }

    /// The unit of `$INSUNITS`.
    fn of_header(code: &str) -> Option<Self> {
        Some(match code {
            "1" => Self::Inches,
            "2" => Self::Feet,
            "4" => Self::Millimetres,
            "5" => Self::Centimetres,
            "6" => Self::Metres,
            _ => return None,
        })
    }

    fn metres(self) -> f64 {
        match self {
            Self::Metres => 1.0,
            Self::Centimetres => 0.01,
            Self::Millimetres => 0.001,
            Self::Inches => 0.0254,
            Self::Feet => 0.3048,
        }
    }
}

/// A polyline.
#[derive(Default)]
struct Polyline<'a> {
    layer: &'a str,
    line: usize,
    is_closed: bool,
    is_mirrored: bool,
    /// Number of vertices that the drawing states.
    stated: Option<f64>,
    /// Vertices, and the bulge of the edge behind each; in units of the drawing.
    vertices: Vec<(Point, f64)>,
}

/// Reads a plan; `units` overrides the header.
pub(crate) fn read(path: &Path, units: Option<Units>) -> Result<Scene, SceneError> {
    let source = read_text(path)?;
    let pairs = pairs(&source)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut scene = Scene { kind: "DXF plan", source: name, ..Scene::default() };
    let Some(units) = units.or_else(|| header_units(&pairs)) else {
        let message = "the drawing states no unit".to_owned();
        return Err(fault(&source, 1, message, "give it with --units m, cm, mm, in or ft"));
    };
    for polyline in polylines(&source, &pairs, &mut scene)? {
        add(&source, &polyline, units.metres(), &mut scene)?;
    }
    if scene.walkable.is_empty() && scene.obstacles.is_empty() {
        let help = "draw each wall and room as a closed LWPOLYLINE or POLYLINE";
        return Err(fault(&source, 1, "the drawing has no closed polyline".into(), help));
    }
    move_near_origin(&mut scene).map_err(|(message, help)| fault(&source, 1, message, help))?;
    Ok(scene)
}

fn header_units(pairs: &[Pair<'_>]) -> Option<Units> {
    let at = pairs.iter().position(|pair| pair.code == 9 && pair.value == "$INSUNITS")?;
    Units::of_header(pairs.get(at + 1)?.value)
}

/// The polylines of the section of entities; all other entities are noted.
fn polylines<'a>(source: &SourceText, pairs: &[Pair<'a>], scene: &mut Scene) -> Result<Vec<Polyline<'a>>, SceneError> {
    let (mut found, mut others): (Vec<Polyline<'a>>, BTreeMap<&str, (usize, usize)>) = Default::default();
    let (mut section, mut entity) = ("", "");
    for (index, pair) in pairs.iter().enumerate() {
        let Pair { code, value, line } = *pair;
        if code == 0 {
            entity = value;
            match value {
                "SECTION" => section = pairs.get(index + 1).map_or("", |name| name.value),
                "ENDSEC" => section = "",
                "LWPOLYLINE" | "POLYLINE" if section == "ENTITIES" => {
                    found.push(Polyline { line, ..Polyline::default() });
                }
                "VERTEX" | "SEQEND" => {}
                other if section == "ENTITIES" => others.entry(other).or_insert((line, 0)).1 += 1,
                _ => {}
            }
            if value == "VERTEX"
                && let Some(polyline) = found.last_mut()
            {
                polyline.vertices.push(([0.0; 2], 0.0));
            }
            continue;
        }
        if let Some(polyline) = found.last_mut().filter(|_| section == "ENTITIES") {
            read_pair(source, entity, *pair, polyline)?;
        }
    }
    let shown = scene.source.clone();
    for (kind, (line, count)) in others {
        scene.notes.add(&shown, line, format!("{count} × {kind} left out; only closed polylines are read"), true);
    }
    Ok(found)
}

/// Reads a pair of a polyline or of one of its vertices.
fn read_pair<'a>(
    source: &SourceText,
    entity: &str,
    Pair { code, value, line }: Pair<'a>,
    polyline: &mut Polyline<'a>,
) -> Result<(), SceneError> {
    let number = || {
        let number = value.parse::<f64>().ok().filter(|number| number.is_finite());
        number.ok_or_else(|| fault(source, line, "this is no finite number".into(), "write the drawing anew"))
    };
    match (entity, code, polyline.vertices.last_mut()) {
        ("LWPOLYLINE" | "POLYLINE", LAYER, _) => polyline.layer = value,
        ("LWPOLYLINE" | "POLYLINE", FLAGS, _) => polyline.is_closed = number()? as i64 & 1 == 1,
        ("LWPOLYLINE" | "POLYLINE", EXTRUSION_Z, _) => polyline.is_mirrored = number()? < 0.0,
        ("LWPOLYLINE", VERTICES, _) => polyline.stated = Some(number()?),
        ("LWPOLYLINE", X, _) => polyline.vertices.push(([number()?, 0.0], 0.0)),
        ("VERTEX", X, Some((vertex, _))) => vertex[0] = number()?,
        ("LWPOLYLINE" | "VERTEX", Y, Some((vertex, _))) => vertex[1] = number()?,
        ("LWPOLYLINE" | "VERTEX", BULGE, Some((_, bulge))) => *bulge = number()?,
        _ => {}
    }
    Ok(())
}

fn add(source: &SourceText, polyline: &Polyline<'_>, metres: f64, scene: &mut Scene) -> Result<(), SceneError> {
    let (shown, count) = (scene.source.clone(), polyline.vertices.len());
    if let Some(stated) = polyline.stated.filter(|stated| *stated != count as f64) {
        let message = format!("the polyline states {stated} vertices (group 90) and has {count}");
        return Err(fault(source, polyline.line, message, "export the drawing anew"));
    }
    if !polyline.is_closed && !ends_where_it_begins(polyline) {
        scene.notes.add(&shown, polyline.line, "open polylines are left out; close them", true);
        return Ok(());
    }
    let corners_m = corners_m(polyline, metres);
    let polygon_m = ring(&corners_m).map_err(|(message, help)| fault(source, polyline.line, message, help))?;
    let origin = format!("{shown}:{}, layer {}", polyline.line, polyline.layer);
    if polyline.layer.to_lowercase().contains(WALKABLE) {
        scene.walkable.push(Walkable { polygon_m, holes_m: Vec::new(), origin });
    } else {
        scene.obstacles.push(SceneObstacle { polygon_m, is_enclosure: false, origin });
    }
    Ok(())
}

fn ends_where_it_begins(polyline: &Polyline<'_>) -> bool {
    let ends = polyline.vertices.first().zip(polyline.vertices.last());
    polyline.vertices.len() > 3 && ends.is_some_and(|((first, _), (last, _))| first == last)
}

/// The corners, arcs as chords.
fn corners_m(polyline: &Polyline<'_>, metres: f64) -> Vec<Point> {
    let mut corners_m = Vec::new();
    let next = polyline.vertices.iter().cycle().skip(1);
    for (&(from, bulge), &(to, _)) in polyline.vertices.iter().zip(next) {
        corners_m.push(from);
        let angle_rad = 4.0 * libm::atan(bulge);
        let chords = (angle_rad.abs() / CHORD_RAD).ceil() as usize;
        let chord = distance_m(from, to);
        if chords < 2 || chord <= 0.0 {
            continue;
        }
        // The centre lies beside the middle of the chord.
        let beside = 0.5 * chord / libm::tan(0.5 * angle_rad) / chord;
        let along = [to[0] - from[0], to[1] - from[1]];
        let centre = [0.5 * (from[0] + to[0]) - beside * along[1], 0.5 * (from[1] + to[1]) + beside * along[0]];
        for index in 1..chords {
            let (sin, cos) = libm::sincos(angle_rad * index as f64 / chords as f64);
            let arm = [from[0] - centre[0], from[1] - centre[1]];
            corners_m.push([centre[0] + cos * arm[0] - sin * arm[1], centre[1] + sin * arm[0] + cos * arm[1]]);
        }
    }
    let sign = if polyline.is_mirrored { -1.0 } else { 1.0 };
    let rounded = |length: f64| (length * metres * 1e4).round() / 1e4;
    corners_m.into_iter().map(|[x, y]| [rounded(sign * x), rounded(y)]).collect()
}
