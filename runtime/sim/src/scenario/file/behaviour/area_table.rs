//! An area as written: `point_m = [x, y]`, `circle_m = [x, y, radius]`, `rect_m = [x, y, x, y]` between two opposite
//! corners, or `polygon_m = [[x, y], …]`. World, metres.

use glam::Vec2;
use serde::Deserialize;

use crate::behaviour::Area;
use crate::maths::polygon::is_simple;
use crate::scenario::fault::TableFault;
use crate::scenario::point::Point;

/// Greatest number of corners of an area: a coastline has fewer.
const CORNERS_MAX: usize = 10_000;

/// An area as written; exactly one key.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AreaTable {
    point_m: Option<Point>,
    circle_m: Option<[f32; 3]>,
    rect_m: Option<[f32; 4]>,
    polygon_m: Option<Vec<Point>>,
}

/// Keys of an area, for tables with more keys; `serde`'s flattening would lose positions and unknown keys.
pub(crate) struct AreaKeys<'a> {
    pub(crate) point_m: Option<Point>,
    pub(crate) circle_m: Option<[f32; 3]>,
    pub(crate) rect_m: Option<[f32; 4]>,
    pub(crate) polygon_m: Option<&'a [Point]>,
}

impl AreaTable {
    /// The area.
    pub(crate) fn area(&self) -> Result<Area, TableFault> {
        let Self { point_m, circle_m, rect_m, .. } = *self;
        AreaKeys { point_m, circle_m, rect_m, polygon_m: self.polygon_m.as_deref() }.area()
    }
}

impl AreaKeys<'_> {
    /// The area, if exactly one key is set.
    pub(crate) fn area(&self) -> Result<Area, TableFault> {
        let area = match (self.point_m, self.circle_m, self.rect_m, self.polygon_m) {
            (Some(Point(point_m)), None, None, None) => Area::point(point_m),
            (None, Some([x, y, radius_m]), None, None) => Area::Disc { centre_m: Vec2::new(x, y), radius_m },
            (None, None, Some(corners), None) => {
                let [a_m, b_m] = [Vec2::new(corners[0], corners[1]), Vec2::new(corners[2], corners[3])];
                Area::rectangle(a_m.min(b_m), a_m.max(b_m))
            }
            (None, None, None, Some(corners_m)) => Area::Polygon(corners_m.iter().map(|&Point(at_m)| at_m).collect()),
            _ => {
                let message = "an area needs exactly one of `point_m`, `circle_m`, `rect_m` and `polygon_m`";
                return Err((message.into(), "write `rect_m = [x, y, x, y]`, two opposite corners, in metres"));
            }
        };
        check(&area)?;
        Ok(area)
    }
}

fn check(area: &Area) -> Result<(), TableFault> {
    match area {
        Area::Disc { radius_m, .. } if radius_m.is_nan() || *radius_m < 0.0 => {
            Err((format!("the radius is {radius_m} m"), "write `circle_m = [x, y, radius]`, in metres"))
        }
        Area::Disc { .. } => Ok(()),
        Area::Polygon(corners_m) if corners_m.len() > CORNERS_MAX => {
            Err((format!("the area has {} corners, more than {CORNERS_MAX}", corners_m.len()), "simplify it"))
        }
        Area::Polygon(corners_m) if corners_m.len() < 3 || !is_simple(corners_m) => {
            Err(("the outline crosses or touches itself, or encloses nothing".into(), "list the corners in order"))
        }
        Area::Polygon(_) => Ok(()),
    }
}
