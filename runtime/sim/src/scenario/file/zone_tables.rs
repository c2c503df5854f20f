//! The `[[zones]]` tables: an area (`rect_m`, `circle_m`, `polygon_m`), its `speed_factor`, the direction in which
//! agents pass it (`one_way_deg`), and the profiles (`closed_to`) and states (`closed_in`) of agents that do not enter it.
//! World, metres.

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::scenario::error::ScenarioError;
use crate::scenario::fault::TableFault;
use crate::scenario::file::behaviour::{AreaKeys, StateNames};
use crate::scenario::file::profile_tables::Profiles;
use crate::scenario::places::zone_spec::ZoneSpec;
use crate::scenario::point::Point;

/// Greatest number of zones that are closed to some agents: the bits of a u32.
const CLOSED_MAX: u32 = u32::BITS;

/// One `[[zones]]` table, as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ZoneTable {
    circle_m: Option<[f32; 3]>,
    rect_m: Option<[f32; 4]>,
    polygon_m: Option<Vec<Point>>,
    speed_factor: Option<f32>,
    one_way_deg: Option<f32>,
    closed_to: Option<Spanned<ClosedTo>>,
    closed_in: Option<Spanned<Vec<Spanned<String>>>>,
}

/// The value of `closed_to`.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "a list of profiles as in `[\"visitor\"]`")]
enum ClosedTo {
    Word(String),
    Profiles(Vec<String>),
}

/// The zones of all tables. Notes in each profile which zones are closed to it.
pub(crate) fn zones(
    source: &SourceText,
    tables: &[Spanned<ZoneTable>],
    profiles: &mut Profiles<'_>,
    states: &StateNames<'_>,
) -> Result<Vec<ZoneSpec>, ScenarioError> {
    let (mut zones, mut closed) = (Vec::new(), 0);
    for table in tables {
        let wrong = |span, (message, help): TableFault| ScenarioError::from(source.invalid(span, message, help));
        let at_table = |fault: TableFault| wrong(table.span(), fault);
        let &ZoneTable { circle_m, rect_m, speed_factor, one_way_deg, ref closed_to, ref closed_in, .. } =
            table.get_ref();
        let polygon_m = table.get_ref().polygon_m.as_deref();
        let area = AreaKeys { point_m: None, circle_m, rect_m, polygon_m }.area().map_err(at_table)?;
        let is_closed = closed_to.is_some() || closed_in.is_some();
        if speed_factor.is_none() && one_way_deg.is_none() && !is_closed {
            let message = "a zone needs `speed_factor`, `one_way_deg`, `closed_to` or `closed_in`".to_owned();
            let help = "write `speed_factor = 0.5`, `one_way_deg = 90`, or `closed_to = [\"PROFILE\"]`";
            return Err(at_table((message, help)));
        }
        if is_closed && closed == CLOSED_MAX {
            return Err(at_table((format!("more than {CLOSED_MAX} zones are closed"), "give fewer")));
        }
        if let Some(closed_to) = closed_to {
            let at_key = |fault: TableFault| wrong(closed_to.span(), fault);
            profiles_of(closed_to.get_ref())
                .and_then(|names| names.iter().try_for_each(|name| profiles.close_zone(name, closed)))
                .map_err(at_key)?;
        }
        let closed_in = closed_in.as_ref().map_or(Ok(Vec::new()), |names| states_of(source, names, states))?;
        closed += u32::from(is_closed);
        zones.push(ZoneSpec { area, speed_factor: speed_factor.unwrap_or(1.0), is_closed, closed_in, one_way_deg });
    }
    Ok(zones)
}

fn states_of(
    source: &SourceText,
    names: &Spanned<Vec<Spanned<String>>>,
    states: &StateNames<'_>,
) -> Result<Vec<u32>, ScenarioError> {
    if names.get_ref().is_empty() {
        let message = "`closed_in` names no state".to_owned();
        return Err(source.invalid(names.span(), message, "name one, or remove the key").into());
    }
    if states.behaviour.states.is_empty() {
        let help = "add `[states.NAME]`, or write `closed_to` with profiles";
        return Err(source.invalid(names.span(), "the scenario has no states".to_owned(), help).into());
    }
    names.get_ref().iter().map(|name| states.index(Some(name), source)).collect()
}

fn profiles_of(closed_to: &ClosedTo) -> Result<&[String], TableFault> {
    match closed_to {
        ClosedTo::Profiles(names) if !names.is_empty() => Ok(names),
        ClosedTo::Profiles(_) => Err(("`closed_to` names no profile".into(), "name one, or remove the key")),
        ClosedTo::Word(word) if word == "all" => {
            let message = "a zone that is closed to all agents is an obstacle".to_owned();
            Err((message, "write its polygon as `[[obstacles]]` with `polygon_m`"))
        }
        ClosedTo::Word(word) => {
            Err((format!("`closed_to` is `{word}`, not a list"), "write a list of profiles: `[\"NAME\"]`"))
        }
    }
}
