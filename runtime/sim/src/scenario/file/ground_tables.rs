//! The `[[obstacles]]` and `[[walkable]]` tables of a scenario file. World, metres.

use std::path::{Path, PathBuf};

use glam::Vec2;
use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::behaviour::Behaviour;
use crate::maths::polygon::signed_area_m2;
use crate::route::mesh::WalkablePolygon;
use crate::scenario::door::DoorSpec;
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::TableFault;
use crate::scenario::file::behaviour::Names;
use crate::scenario::file::wkt_polygons::wkt_polygons;
use crate::scenario::point::Point;
use crate::scenario::resolved::Scenario;

/// One `[[obstacles]]` table.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ObstacleTable {
    pub(crate) polygon_m: Vec<Point>,
    #[serde(default)]
    kind: KindName,
    /// Name of the signal that opens the obstacle while it is green.
    open: Option<Spanned<String>>,
}

/// The value of `kind`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum KindName {
    #[default]
    Solid,
    Enclosure,
}

/// What the polygon of an obstacle is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ObstacleKind {
    /// A solid.
    Solid,
    /// Ground with a wall around.
    Enclosure,
    /// A solid that is absent while a signal is green.
    Door,
}

impl ObstacleTable {
    fn kind(&self) -> ObstacleKind {
        match (self.kind, &self.open) {
            (KindName::Enclosure, _) => ObstacleKind::Enclosure,
            (KindName::Solid, Some(_)) => ObstacleKind::Door,
            (KindName::Solid, None) => ObstacleKind::Solid,
        }
    }
}

/// One `[[walkable]]` table: a polygon with holes, or a WKT file of polygons.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WalkableTable {
    polygon_m: Option<Vec<Point>>,
    #[serde(default)]
    holes_m: Vec<Vec<Point>>,
    file: Option<Spanned<String>>,
}

/// The ground of a scenario file.
#[derive(Debug)]
pub(crate) struct PlacedGround {
    /// A scenario with this ground and its behaviour, without agents.
    pub(crate) scenario: Scenario,
    /// Index of the table of each walkable polygon.
    pub(crate) tables: Vec<usize>,
}

impl PlacedGround {
    /// The polygons of all tables.
    pub(crate) fn new(
        source: &SourceText,
        obstacles: &[Spanned<ObstacleTable>],
        walkable: &[Spanned<WalkableTable>],
        behaviour: &Behaviour,
        signals: &Names<'_>,
    ) -> Result<Self, ScenarioError> {
        let (mut walkable_m, mut tables) = (Vec::new(), Vec::new());
        for (index, table) in walkable.iter().enumerate() {
            let polygons = table.get_ref().polygons(source, table)?;
            tables.extend(polygons.iter().map(|_| index));
            walkable_m.extend(polygons);
        }
        let obstacles_m = polygons_m(obstacles, ObstacleKind::Solid);
        let enclosures_m = polygons_m(obstacles, ObstacleKind::Enclosure);
        let doors = doors(source, obstacles, signals)?;
        let behaviour = behaviour.clone();
        let scenario = Scenario { obstacles_m, doors, enclosures_m, walkable_m, behaviour, ..Scenario::of(Vec::new()) };
        Ok(Self { scenario, tables })
    }
}

impl WalkableTable {
    /// The file that the table names.
    pub(crate) fn file(&self, source: &SourceText) -> Option<PathBuf> {
        self.file.as_ref().map(|name| source.beside(Path::new(name.get_ref())))
    }

    fn polygons(&self, source: &SourceText, table: &Spanned<Self>) -> Result<Vec<WalkablePolygon>, ScenarioError> {
        match (&self.polygon_m, &self.file) {
            (Some(outline_m), None) => {
                let holes_m = self.holes_m.iter().map(|hole_m| positions_m(hole_m)).collect();
                Ok(vec![WalkablePolygon { outline_m: positions_m(outline_m), holes_m }])
            }
            (None, Some(name)) if self.holes_m.is_empty() => {
                let path = source.beside(Path::new(name.get_ref()));
                let wrong = |message: String, help| source.invalid(name.span(), message, help).into();
                let text = SourceText::read(&path).map_err(|error| {
                    wrong(format!("{} cannot be read: {error}", path.display()), "give a path relative to this file")
                })?;
                wkt_polygons(&text.text)
                    .map_err(|(message, help)| wrong(format!("{}: {message}", path.display()), help))
            }
            _ => {
                let message = "a walkable area needs either `polygon_m` or `file`";
                let help = "write `polygon_m = [[x, y], …]`, with `holes_m` where there are any, or `file = \"x.wkt\"`";
                Err(source.invalid(table.span(), message, help).into())
            }
        }
    }
}

/// The polygons of the obstacles of a kind, counter-clockwise.
fn polygons_m(tables: &[Spanned<ObstacleTable>], kind: ObstacleKind) -> Vec<Vec<Vec2>> {
    tables_of(tables, kind).map(|table| counter_clockwise(&table.get_ref().polygon_m)).collect()
}

/// The doors.
fn doors(
    source: &SourceText,
    tables: &[Spanned<ObstacleTable>],
    signals: &Names<'_>,
) -> Result<Vec<DoorSpec>, ScenarioError> {
    let mut doors = Vec::new();
    for table in tables.iter().map(Spanned::get_ref) {
        let Some(open) = &table.open else { continue };
        let wrong = |(message, help): TableFault| ScenarioError::from(source.invalid(open.span(), message, help));
        if table.kind() != ObstacleKind::Door {
            let message = "an enclosure cannot open: its wall has no thickness".to_owned();
            return Err(wrong((message, "remove `open`, or write obstacles with thickness around the polygon")));
        }
        let signal = signals.index(open.get_ref()).map_err(wrong)? as u32;
        doors.push(DoorSpec { polygon_m: counter_clockwise(&table.polygon_m), signal });
    }
    Ok(doors)
}

/// The tables of the obstacles of a kind.
pub(crate) fn tables_of(
    tables: &[Spanned<ObstacleTable>],
    kind: ObstacleKind,
) -> impl Iterator<Item = &Spanned<ObstacleTable>> {
    tables.iter().filter(move |table| table.get_ref().kind() == kind)
}

fn counter_clockwise(polygon_m: &[Point]) -> Vec<Vec2> {
    let mut corners_m = positions_m(polygon_m);
    if signed_area_m2(&corners_m) < 0.0 {
        corners_m.reverse();
    }
    corners_m
}

fn positions_m(points: &[Point]) -> Vec<Vec2> {
    points.iter().map(|&Point(position_m)| position_m).collect()
}
