//! Polygons with holes from well-known text (WKT, OGC 06-103r4): POLYGON, MULTIPOLYGON, and GEOMETRYCOLLECTION of them.
//! Metres.

use std::str::FromStr;

use glam::Vec2;
use wkt::Wkt;
use wkt::types::{Coord, LineString, Polygon};

use crate::route::mesh::WalkablePolygon;

/// Greatest depth of brackets: a collection of collections of multipolygons. The parser calls itself at each.
const BRACKETS_MAX: usize = 16;
/// How to mend a geometry that is no polygon.
const POLYGONS_ONLY: &str = "give POLYGON, MULTIPOLYGON, or a GEOMETRYCOLLECTION of them";

/// What is wrong with a text, and how to mend it.
type WktFault = (String, &'static str);

/// The polygons of a text, in order.
pub(crate) fn wkt_polygons(text: &str) -> Result<Vec<WalkablePolygon>, WktFault> {
    check_depth(text)?;
    let geometry = Wkt::<f64>::from_str(text)
        .map_err(|message| (format!("this is no well-known text: {message}"), POLYGONS_ONLY))?;
    let mut polygons = Vec::new();
    add_polygons(geometry, &mut polygons)?;
    if polygons.is_empty() {
        return Err(("there is no polygon".into(), POLYGONS_ONLY));
    }
    Ok(polygons)
}

fn check_depth(text: &str) -> Result<(), WktFault> {
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

fn add_polygons(geometry: Wkt<f64>, polygons: &mut Vec<WalkablePolygon>) -> Result<(), WktFault> {
    match geometry {
        Wkt::Polygon(polygon) => add_polygon(&polygon, polygons),
        Wkt::MultiPolygon(all) => all.polygons().iter().try_for_each(|polygon| add_polygon(polygon, polygons)),
        Wkt::GeometryCollection(all) => {
            all.geometries().iter().try_for_each(|geometry| add_polygons(geometry.clone(), polygons))
        }
        _ => Err(("a geometry is no polygon".into(), POLYGONS_ONLY)),
    }
}

fn add_polygon(polygon: &Polygon<f64>, polygons: &mut Vec<WalkablePolygon>) -> Result<(), WktFault> {
    let mut rings_m = polygon.rings().iter().map(ring_m).collect::<Result<Vec<_>, _>>()?.into_iter();
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

    #[test]
    fn polygons_and_their_collections_are_read() {
        let square = "((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 1))";
        for text in [
            format!("POLYGON {square}"),
            format!("MULTIPOLYGON ({square})"),
            format!("GEOMETRYCOLLECTION (POLYGON {square})"),
        ] {
            let polygons = wkt_polygons(&text).expect("well-known text");
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
            let (message, _) = wkt_polygons(text).expect_err(text);
            assert!(message.contains(what), "{message}");
        }
    }
}
