//! The `[[measure]]` tables: `line_m = [[x, y], [x, y]]`, an area (`rect_m`, `circle_m`, `polygon_m`), or
//! `egress = true`, each with a name. World, metres.

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::scenario::error::ScenarioError;
use crate::scenario::fault::TableFault;
use crate::scenario::file::behaviour::AreaKeys;
use crate::scenario::places::measure_spec::{MeasureSpec, MeasuredPlace};
use crate::scenario::point::Point;

/// One `[[measure]]` table, as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeasureTable {
    name: String,
    line_m: Option<[Point; 2]>,
    circle_m: Option<[f32; 3]>,
    rect_m: Option<[f32; 4]>,
    polygon_m: Option<Vec<Point>>,
    egress: Option<bool>,
}

/// What all tables measure.
pub(crate) fn measures(
    source: &SourceText,
    tables: &[Spanned<MeasureTable>],
) -> Result<Vec<MeasureSpec>, ScenarioError> {
    let resolve = |table: &Spanned<MeasureTable>| {
        let at_table = |(message, help): TableFault| source.invalid(table.span(), message, help).into();
        table.get_ref().resolve().map_err(at_table)
    };
    tables.iter().map(resolve).collect()
}

impl MeasureTable {
    fn resolve(&self) -> Result<MeasureSpec, TableFault> {
        let Self { circle_m, rect_m, .. } = *self;
        let has_area = circle_m.is_some() || rect_m.is_some() || self.polygon_m.is_some();
        let place = match (&self.line_m, has_area, self.egress) {
            (Some([Point(first_m), Point(second_m)]), false, None) => MeasuredPlace::Line([*first_m, *second_m]),
            (None, true, None) => {
                let polygon_m = self.polygon_m.as_deref();
                MeasuredPlace::Area(AreaKeys { point_m: None, circle_m, rect_m, polygon_m }.area()?)
            }
            (None, false, Some(true)) => MeasuredPlace::Egress,
            _ => {
                let message = "a measure needs exactly one of `line_m`, an area and `egress = true`";
                return Err((message.into(), "write `line_m = [[x, y], [x, y]]` or `rect_m = [x, y, x, y]`"));
            }
        };
        Ok(MeasureSpec { name: self.name.clone(), place })
    }
}
