//! The `[[zones]]` tables: an area (`rect_m`, `circle_m`, `polygon_m`) and its `speed_factor`. World, metres.

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::scenario::error::ScenarioError;
use crate::scenario::fault::TableFault;
use crate::scenario::file::behaviour::AreaKeys;
use crate::scenario::places::zone_spec::ZoneSpec;
use crate::scenario::point::Point;

/// One `[[zones]]` table, as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ZoneTable {
    circle_m: Option<[f32; 3]>,
    rect_m: Option<[f32; 4]>,
    polygon_m: Option<Vec<Point>>,
    speed_factor: f32,
}

/// The zones of all tables.
pub(crate) fn zones(source: &SourceText, tables: &[Spanned<ZoneTable>]) -> Result<Vec<ZoneSpec>, ScenarioError> {
    let resolve = |table: &Spanned<ZoneTable>| {
        let &ZoneTable { circle_m, rect_m, speed_factor, .. } = table.get_ref();
        let polygon_m = table.get_ref().polygon_m.as_deref();
        let at_table = |(message, help): TableFault| ScenarioError::from(source.invalid(table.span(), message, help));
        let area = AreaKeys { point_m: None, circle_m, rect_m, polygon_m }.area().map_err(at_table)?;
        Ok(ZoneSpec { area, speed_factor })
    };
    tables.iter().map(resolve).collect()
}
