//! Polygons with holes from well-known text (WKT, OGC 06-103r4): POLYGON, MULTIPOLYGON, and GEOMETRYCOLLECTION of them.
//! Metres. A mistake is shown at its place in the text.

use std::ops::Range;
use std::str::FromStr;

use glam::Vec2;
use motiondb::files::SourceText;
use wkt::Wkt;
use wkt::types::{Coord, LineString, Polygon};

use crate::route::mesh::WalkablePolygon;
use crate::scenario::error::Invalid;

/// Greatest depth of brackets: a collection of collections of multipolygons. The parser calls itself at each.
const BRACKETS_MAX: usize = 16;
/// How to mend a geometry that is no polygon.
const POLYGONS_ONLY: &str = "give POLYGON, MULTIPOLYGON, or a GEOMETRYCOLLECTION of them";

/// What is wrong with a text, and how to mend it.
type WktFault = (String, &'static str);

/// The polygons of a text, in order.
pub(crate) fn wkt_polygons(source: &SourceText) -> Result<Vec<WalkablePolygon>, Invalid> {
    // Texts of one line of a megabyte are usual.
    let invalid =
        |at: usize, (message, help): WktFault| Invalid { is_quotable: false, ..source.invalid(at..at, message, help) };
    let brackets = brackets(&source.text).map_err(|(at, fault)| invalid(at, fault))?;
    let geometry = Wkt::<f64>::from_str(source.text.trim()).map_err(|message| {
        let fault = (format!("this is no well-known text: {message}"), POLYGONS_ONLY);
        invalid(brackets.wrong.unwrap_or_default(), fault)
    })?;
    let mut polygons = Vec::new();
    let mut rings = 0;
    add_polygons(geometry, &mut polygons, &mut rings).map_err(|fault| {
        let at = brackets.innermost.get(rings).map_or(0, |ring| ring.start);
        invalid(at, fault)
    })?;
    if polygons.is_empty() {
        return Err(invalid(0, ("there is no polygon".into(), POLYGONS_ONLY)));
    }
    Ok(polygons)
}

/// The brackets of a text.
#[derive(Debug, Default)]
struct Brackets {
    /// Those without brackets inside: the rings of polygons, and of other geometries before the first that is none.
    innermost: Vec<Range<usize>>,
    /// The first bracket without its other one.
    wrong: Option<usize>,
}

fn brackets(text: &str) -> Result<Brackets, (usize, WktFault)> {
    let (mut open, mut found) = (Vec::new(), Brackets::default());
    let mut last_open = None;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => {
                open.push(at);
                last_open = Some(at);
            }
            b')' => match open.pop() {
                Some(begin) => found.innermost.extend(last_open.take().map(|_| begin..at)),
                None => found.wrong = found.wrong.or(Some(at)),
            },
            _ => {}
        }
        if open.len() > BRACKETS_MAX {
            return Err((at, (format!("brackets are nested more than {BRACKETS_MAX} deep"), POLYGONS_ONLY)));
        }
    }
    found.wrong = found.wrong.or(open.first().copied());
    Ok(found)
}

/// Adds the polygons of a geometry; `rings` counts the rings before a mistake.
fn add_polygons(geometry: Wkt<f64>, polygons: &mut Vec<WalkablePolygon>, rings: &mut usize) -> Result<(), WktFault> {
    match geometry {
        Wkt::Polygon(polygon) => add_polygon(&polygon, polygons, rings),
        Wkt::MultiPolygon(all) => all.polygons().iter().try_for_each(|polygon| add_polygon(polygon, polygons, rings)),
        Wkt::GeometryCollection(all) => {
            all.geometries().iter().try_for_each(|geometry| add_polygons(geometry.clone(), polygons, rings))
        }
        _ => Err(("a geometry is no polygon".into(), POLYGONS_ONLY)),
    }
}

fn add_polygon(polygon: &Polygon<f64>, polygons: &mut Vec<WalkablePolygon>, rings: &mut usize) -> Result<(), WktFault> {
    let mut rings_m = Vec::new();
    for ring in polygon.rings() {
        rings_m.push(ring_m(ring)?);
        *rings += 1;
    }
    let mut rings_m = rings_m.into_iter();
    // POLYGON EMPTY has no ring.
    if let Some(outline_m) = rings_m.next() {
        polygons.push(WalkablePolygon { outline_m, holes_m: rings_m.collect() });
    }
    Ok(())
}

/// The corners of a ring, without the first one again at the end.
fn ring_m(ring: &LineString<f64>) -> Result<Vec<Vec2>, WktFault> {
    let position_m = |coord: &Coord<f64>| match coord {
        Coord { x, y, z: None, m: None } => Ok(Vec2::new(*x as f32, *y as f32)),
        _ => Err(("a position has a third coordinate".into(), "give x and y alone; the ground is flat")),
    };
    let mut corners_m = ring.coords().iter().map(position_m).collect::<Result<Vec<_>, WktFault>>()?;
    if corners_m.len() > 1 && corners_m.first() == corners_m.last() {
        corners_m.pop();
    }
    Ok(corners_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> SourceText {
        SourceText { path: "a.wkt".into(), text: text.to_owned() }
    }

    #[test]
    fn mistakes_are_shown_at_their_line() {
        for (text, place) in [
            ("\nPOLYGON (\n(0 0, 1 0, 1 1, 0 0)", "a.wkt:2:"),
            (
                "GEOMETRYCOLLECTION (POLYGON ((0 0, 1 0, 1 1, 0 0)),\nPOLYGON Z ((0 0 1, 1 0 1, 1 1 1, 0 0 1)))",
                "a.wkt:2:",
            ),
            ("GEOMETRYCOLLECTION (POLYGON ((0 0, 1 0, 1 1, 0 0)),\nPOINT (1 2))", "a.wkt:2:"),
        ] {
            let message = wkt_polygons(&source(text)).expect_err(text).to_string();
            assert!(message.contains(place), "{message}");
        }
    }

    #[test]
    fn polygons_and_their_collections_are_read() {
        let square = "((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 1))";
        for text in [
            format!("POLYGON {square}"),
            format!("MULTIPOLYGON ({square})"),
            format!("GEOMETRYCOLLECTION (POLYGON {square})"),
        ] {
            let polygons = wkt_polygons(&source(&text)).expect("well-known text");
            assert_eq!((polygons.len(), polygons[0].outline_m.len(), polygons[0].holes_m[0].len()), (1, 4, 3));
        }
    }

    #[test]
    fn other_geometries_and_third_coordinates_are_errors() {
        let deep = "GEOMETRYCOLLECTION(".repeat(100_000);
        for (text, what) in [
            ("POINT (1 2)", "no polygon"),
            ("POLYGON Z ((0 0 1, 1 0 1, 1 1 1, 0 0 1))", "third coordinate"),
            ("POLYGON ((0 0, 1 0", "well-known text"),
            ("GEOMETRYCOLLECTION EMPTY", "no polygon"),
            (&deep, "nested"),
        ] {
            let message = wkt_polygons(&source(text)).expect_err("no polygons").message;
            assert!(message.contains(what), "{message}");
        }
    }
}
