//! The `[[markings]]` tables, and the keys `label` and `copies_m` that they share with obstacles and walkable ground.
//! World, metres.
//!
//! ```toml
//! [[markings]]                        # a zebra crossing, 4 m wide
//! line_m = [[0, -5], [0, 5]]          # or an area: `rect_m`, `circle_m`, `polygon_m`
//! width_m = 4
//! dash_m = [0.5, 0.5]
//! colour = "white"                    # a name, or "#rrggbb"; or signal = "crossing": green or red, as the signal is
//! ```

use std::ops::Range;

use glam::Vec2;
use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::behaviour::{Area, Behaviour};
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::TableFault;
use crate::scenario::file::behaviour::AreaKeys;
use crate::scenario::places::marking::{Marking, MarkingColour, MarkingShape, PlaceLabel};
use crate::scenario::point::Point;
use crate::scenario::rules::marking_check::MARKINGS_MAX;

/// Colours by name, sRGB: muted, so that agents stand out.
const COLOURS: [(&str, [u8; 3]); 8] = [
    ("white", [250, 249, 246]),
    ("yellow", [236, 205, 110]),
    ("red", [214, 132, 118]),
    ("green", [164, 196, 150]),
    ("blue", [158, 186, 212]),
    ("grey", [206, 203, 197]),
    ("asphalt", [172, 171, 171]),
    ("wood", [214, 192, 160]),
];
/// Greatest number of corners of all areas, 8 MB.
const CORNERS_MAX: usize = 1_000_000;
/// How to mend a colour.
const COLOUR_HELP: &str =
    "write \"white\", \"yellow\", \"red\", \"green\", \"blue\", \"grey\", \"asphalt\", \"wood\" or \"#rrggbb\"";
/// How to mend a shape.
const SHAPE_HELP: &str = "write `rect_m = [x, y, x, y]`, or `line_m = [[x, y], [x, y]]` with `width_m`";

/// One `[[markings]]` table, as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MarkingTable {
    circle_m: Option<[f32; 3]>,
    rect_m: Option<[f32; 4]>,
    polygon_m: Option<Vec<Point>>,
    line_m: Option<[Point; 2]>,
    width_m: Option<f32>,
    dash_m: Option<[f32; 2]>,
    colour: Option<String>,
    signal: Option<String>,
    copies_m: Option<Vec<Point>>,
    label: Option<LabelValue>,
}

/// The text of a table: one for all copies, or one for each.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "a text, or a list of texts, one for each of `copies_m`")]
pub(crate) enum LabelValue {
    One(String),
    Each(Vec<String>),
}

/// Labels, and for each the bytes of its table in the text.
#[derive(Debug, Default)]
pub(crate) struct PlacedLabels {
    pub(crate) labels: Vec<PlaceLabel>,
    pub(crate) spans: Vec<Range<usize>>,
}

/// Markings, and for each the index of its table.
#[derive(Debug, Default)]
pub(crate) struct PlacedMarkings {
    pub(crate) markings: Vec<Marking>,
    pub(crate) tables: Vec<usize>,
    /// Number of corners of all areas so far.
    corners: usize,
}

/// The offsets of the copies that a table makes.
pub(crate) fn offsets_m(copies_m: Option<&Vec<Point>>) -> Vec<Vec2> {
    copies_m.map_or_else(|| vec![Vec2::ZERO], |copies_m| copies_m.iter().map(|&Point(offset_m)| offset_m).collect())
}

impl PlacedLabels {
    /// Adds the label of a table at its middle, once for each copy.
    pub(crate) fn add(
        &mut self,
        label: Option<&LabelValue>,
        middle_m: Vec2,
        offsets_m: &[Vec2],
        span: &Range<usize>,
    ) -> Result<(), TableFault> {
        let text = |index: usize| match label {
            None => None,
            Some(LabelValue::One(text)) => Some(text),
            Some(LabelValue::Each(texts)) => Some(&texts[index]),
        };
        if let Some(LabelValue::Each(texts)) = label
            && texts.len() != offsets_m.len()
        {
            let message = format!("there are {} labels and {} copies", texts.len(), offsets_m.len());
            return Err((message, "give one text for all, or one for each of `copies_m`"));
        }
        for (index, offset_m) in offsets_m.iter().enumerate() {
            if let Some(text) = text(index) {
                self.labels.push(PlaceLabel { text: text.clone(), at_m: middle_m + offset_m });
                self.spans.push(span.clone());
            }
        }
        Ok(())
    }
}

impl PlacedMarkings {
    /// The markings of all tables; their labels follow those of the ground.
    pub(crate) fn new(
        source: &SourceText,
        tables: &[Spanned<MarkingTable>],
        behaviour: &Behaviour,
        labels: &mut PlacedLabels,
    ) -> Result<Self, ScenarioError> {
        let mut placed = Self::default();
        for (index, table) in tables.iter().enumerate() {
            let mut add = || placed.add(index, table, behaviour, labels);
            add().map_err(|(message, help)| ScenarioError::from(source.invalid(table.span(), message, help)))?;
        }
        Ok(placed)
    }

    fn add(
        &mut self,
        index: usize,
        table: &Spanned<MarkingTable>,
        behaviour: &Behaviour,
        labels: &mut PlacedLabels,
    ) -> Result<(), TableFault> {
        let (span, table) = (table.span(), table.get_ref());
        let (shape, colour) = (table.shape()?, table.colour(behaviour)?);
        let offsets_m = offsets_m(table.copies_m.as_ref());
        let count = self.markings.len() + offsets_m.len();
        self.corners += corner_count(&shape).saturating_mul(offsets_m.len());
        if count > MARKINGS_MAX || self.corners > CORNERS_MAX {
            let message = format!("with this table there are {count} markings with {} corners", self.corners);
            return Err((message, "give at most 10,000 markings with a million corners"));
        }
        labels.add(table.label.as_ref(), shape.centre_m(), &offsets_m, &span)?;
        for offset_m in offsets_m {
            self.markings.push(Marking { shape: moved(&shape, offset_m), colour });
            self.tables.push(index);
        }
        Ok(())
    }
}

fn corner_count(shape: &MarkingShape) -> usize {
    match shape {
        MarkingShape::Area(Area::Polygon(corners_m)) => corners_m.len(),
        MarkingShape::Area(Area::Disc { .. }) | MarkingShape::Line { .. } => 0,
    }
}

fn moved(shape: &MarkingShape, by_m: Vec2) -> MarkingShape {
    match shape {
        MarkingShape::Area(area) => MarkingShape::Area(area.moved(by_m)),
        &MarkingShape::Line { ends_m, width_m, dash_m } => {
            MarkingShape::Line { ends_m: ends_m.map(|end_m| end_m + by_m), width_m, dash_m }
        }
    }
}

impl MarkingTable {
    fn shape(&self) -> Result<MarkingShape, TableFault> {
        let Self { circle_m, rect_m, line_m, width_m, dash_m, .. } = *self;
        match (line_m, width_m) {
            (Some(ends_m), Some(width_m)) if circle_m.is_none() && rect_m.is_none() && self.polygon_m.is_none() => {
                Ok(MarkingShape::Line { ends_m: ends_m.map(|Point(end_m)| end_m), width_m, dash_m })
            }
            (None, None) if dash_m.is_none() => {
                let polygon_m = self.polygon_m.as_deref();
                Ok(MarkingShape::Area(AreaKeys { point_m: None, circle_m, rect_m, polygon_m }.area()?))
            }
            (None, _) => Err(("`width_m` and `dash_m` belong to `line_m`".into(), SHAPE_HELP)),
            (Some(_), None) => Err(("a line needs `width_m`".into(), SHAPE_HELP)),
            (Some(_), Some(_)) => Err(("a marking is either a line or an area".into(), SHAPE_HELP)),
        }
    }

    fn colour(&self, behaviour: &Behaviour) -> Result<MarkingColour, TableFault> {
        match (&self.colour, &self.signal) {
            (None, None) => Ok(MarkingColour::Fixed(COLOURS[0].1)),
            (Some(colour), None) => match colour_of(colour) {
                Some(rgb) => Ok(MarkingColour::Fixed(rgb)),
                None => Err((format!("there is no colour {colour:?}"), COLOUR_HELP)),
            },
            (None, Some(name)) => match behaviour.signals.iter().position(|signal| signal.name == *name) {
                Some(signal) => Ok(MarkingColour::Signal(signal as u32)),
                None => {
                    Err((format!("there is no signal `{name}`"), "correct the name, or add its table `[signals.NAME]`"))
                }
            },
            (Some(_), Some(_)) => Err(("a marking has either `colour` or `signal`".into(), "remove one of them")),
        }
    }
}

/// A colour by its name or its hexadecimal digits.
fn colour_of(text: &str) -> Option<[u8; 3]> {
    if let Some((_, rgb)) = COLOURS.iter().find(|(name, _)| *name == text) {
        return Some(*rgb);
    }
    let digits = text
        .strip_prefix('#')
        .filter(|digits| digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit()))?;
    let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).ok();
    Some([byte(0)?, byte(2)?, byte(4)?])
}

/// The middle of a polygon, for its label, m.
pub(crate) fn middle_m(corners_m: &[Vec2]) -> Vec2 {
    Area::Polygon(corners_m.to_vec()).centre_m()
}
