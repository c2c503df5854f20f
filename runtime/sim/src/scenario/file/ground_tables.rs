//! The `[[obstacles]]` and `[[walkable]]` tables of a scenario file, with their copies and labels. World, metres.

use std::path::{Path, PathBuf};

use glam::Vec2;
use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::behaviour::Behaviour;
use crate::maths::polygon::signed_area_m2;
use crate::route::mesh::WalkablePolygon;
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::TableFault;
use crate::scenario::file::behaviour::Names;
use crate::scenario::file::marking_tables::{LabelValue, PlacedLabels, middle_m, offsets_m};
use crate::scenario::file::wkt_polygons::wkt_polygons;
use crate::scenario::places::door::DoorSpec;
use crate::scenario::point::Point;
use crate::scenario::resolved::Scenario;
use crate::scenario::rules::ground_check::{
    CORNERS_MAX as WALKABLE_CORNERS_MAX, OBSTACLE_CORNERS_MAX, OBSTACLES_CORNERS_MAX, OBSTACLES_MAX,
};

/// One `[[obstacles]]` table.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ObstacleTable {
    polygon_m: Vec<Point>,
    #[serde(default)]
    kind: ObstacleKind,
    copies_m: Option<Vec<Point>>,
    label: Option<LabelValue>,
    /// Height in pictures, m.
    height_m: Option<f32>,
    /// Name of the signal that opens the obstacle while it is green.
    open: Option<Spanned<String>>,
}

/// What the polygon of an obstacle bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ObstacleKind {
    /// A solid.
    #[default]
    Solid,
    /// Ground with a wall around.
    Enclosure,
}

impl ObstacleTable {
    /// Index of the signal that opens the obstacle; none where it is always there.
    fn signal(&self, source: &SourceText, signals: &Names<'_>) -> Result<Option<u32>, ScenarioError> {
        let Some(open) = &self.open else { return Ok(None) };
        let wrong = |(message, help): TableFault| ScenarioError::from(source.invalid(open.span(), message, help));
        if self.kind == ObstacleKind::Enclosure {
            let message = "an enclosure cannot open: its wall has no thickness".to_owned();
            return Err(wrong((message, "remove `open`, or write obstacles with thickness around the polygon")));
        }
        signals.index(open.get_ref()).map(|signal| Some(signal as u32)).map_err(wrong)
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
    copies_m: Option<Vec<Point>>,
    label: Option<LabelValue>,
}

/// The ground of a scenario file.
#[derive(Debug)]
pub(crate) struct PlacedGround {
    /// A scenario with this ground and its behaviour, without agents.
    pub(crate) scenario: Scenario,
    /// Index of the table of each solid.
    pub(crate) solids: Vec<usize>,
    /// Index of the table of each enclosure.
    pub(crate) enclosures: Vec<usize>,
    /// Index of the table of each door.
    pub(crate) doors: Vec<usize>,
    /// Index of the table of each walkable polygon.
    pub(crate) walkable: Vec<usize>,
    /// Labels of these tables; the scenario has none yet.
    pub(crate) labels: PlacedLabels,
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
        let mut placed = Self {
            scenario: Scenario { behaviour: behaviour.clone(), ..Scenario::of(Vec::new()) },
            solids: Vec::new(),
            enclosures: Vec::new(),
            doors: Vec::new(),
            walkable: Vec::new(),
            labels: PlacedLabels::default(),
        };
        let mut corners = 0;
        for (index, table) in obstacles.iter().enumerate() {
            let signal = table.get_ref().signal(source, signals)?;
            let at_table = |(message, help): TableFault| source.invalid(table.span(), message, help);
            placed.add_obstacle(index, table, signal, &mut corners).map_err(at_table)?;
        }
        let mut corners = 0;
        for (index, table) in walkable.iter().enumerate() {
            placed.add_walkable(source, index, table, &mut corners)?;
        }
        Ok(placed)
    }

    /// Adds an obstacle and its copies; doors where a signal opens it.
    fn add_obstacle(
        &mut self,
        index: usize,
        table: &Spanned<ObstacleTable>,
        signal: Option<u32>,
        corners: &mut usize,
    ) -> Result<(), TableFault> {
        let (span, ObstacleTable { polygon_m, copies_m, label, height_m, .. }) = (table.span(), table.get_ref());
        let (corners_m, offsets_m) = (counter_clockwise(polygon_m), offsets_m(copies_m.as_ref()));
        let count = self.solids.len() + self.enclosures.len() + self.doors.len() + offsets_m.len();
        if count > OBSTACLES_MAX || (offsets_m.len() > 1 && corners_m.len() > OBSTACLE_CORNERS_MAX) {
            let message =
                format!("with this table there are {count} obstacles; this one has {} corners", corners_m.len());
            return Err((message, "give at most 10,000 obstacles, of 3 to 1000 corners"));
        }
        *corners += corners_m.len() * offsets_m.len();
        if *corners > OBSTACLES_CORNERS_MAX {
            let message = format!("with this table the obstacles have {corners} corners");
            return Err((message, "give at most 250,000 corners, with all copies"));
        }
        self.labels.add(label.as_ref(), middle_m(&corners_m), &offsets_m, &span)?;
        let Scenario { obstacles_m, obstacle_heights_m, enclosures_m, doors, .. } = &mut self.scenario;
        for offset_m in offsets_m {
            let polygon_m = moved(&corners_m, offset_m);
            match (signal, table.get_ref().kind) {
                (Some(signal), _) => {
                    doors.push(DoorSpec { polygon_m, signal });
                    self.doors.push(index);
                }
                (None, ObstacleKind::Solid) => {
                    if height_m.is_some() {
                        obstacle_heights_m.resize(obstacles_m.len(), None);
                        obstacle_heights_m.push(*height_m);
                    }
                    obstacles_m.push(polygon_m);
                    self.solids.push(index);
                }
                (None, ObstacleKind::Enclosure) => {
                    enclosures_m.push(polygon_m);
                    self.enclosures.push(index);
                }
            }
        }
        Ok(())
    }

    fn add_walkable(
        &mut self,
        source: &SourceText,
        index: usize,
        table: &Spanned<WalkableTable>,
        corners: &mut usize,
    ) -> Result<(), ScenarioError> {
        let polygons = table.get_ref().polygons(source, table)?;
        let at_table = |(message, help): TableFault| ScenarioError::from(source.invalid(table.span(), message, help));
        let offsets_m = offsets_m(table.get_ref().copies_m.as_ref());
        let of_table = polygons.iter().map(|polygon| polygon.outline_m.len() + polygon.holes_m.concat().len());
        *corners = corners.saturating_add(of_table.sum::<usize>().saturating_mul(offsets_m.len()));
        if *corners > WALKABLE_CORNERS_MAX {
            let message = format!("with this table the walkable polygons have {corners} corners");
            return Err(at_table((message, "give at most 200,000 corners, with all copies")));
        }
        let middle_m = polygons.first().map_or(Vec2::ZERO, |polygon| middle_m(&polygon.outline_m));
        self.labels.add(table.get_ref().label.as_ref(), middle_m, &offsets_m, &table.span()).map_err(at_table)?;
        for offset_m in offsets_m {
            for WalkablePolygon { outline_m, holes_m } in &polygons {
                let holes_m = holes_m.iter().map(|hole_m| moved(hole_m, offset_m)).collect();
                self.scenario.walkable_m.push(WalkablePolygon { outline_m: moved(outline_m, offset_m), holes_m });
                self.walkable.push(index);
            }
        }
        Ok(())
    }
}

fn moved(corners_m: &[Vec2], by_m: Vec2) -> Vec<Vec2> {
    corners_m.iter().map(|&corner_m| corner_m + by_m).collect()
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
                let wrong = |message: String, help| ScenarioError::from(source.invalid(name.span(), message, help));
                let text = SourceText::read(&path).map_err(|error| {
                    wrong(format!("{} cannot be read: {error}", path.display()), "give a path relative to this file")
                })?;
                wkt_polygons(&text).map_err(ScenarioError::from)
            }
            _ => {
                let message = "a walkable area needs either `polygon_m` or `file`";
                let help = "write `polygon_m = [[x, y], …]`, with `holes_m` where there are any, or `file = \"x.wkt\"`";
                Err(source.invalid(table.span(), message, help).into())
            }
        }
    }
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
