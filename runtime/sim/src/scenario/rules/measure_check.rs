//! The rules of lines and areas that are measured, and of zones. World, metres.

use crate::maths::polygon::signed_area_m2;
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::places::measure_spec::MeasuredPlace;
use crate::scenario::ranges::{check_name, check_points, within};
use crate::scenario::resolved::Scenario;
use crate::scenario::rules::behaviour_check::{FACTOR, check_area};

/// Greatest number of `[[measure]]` tables, and of zones: each takes time in every frame.
const TABLES_MAX: usize = 1_000;
/// Greatest number of different sets of zones that agents do not enter: each has walls and meshes of its own.
const SETS_MAX: usize = 16;
/// Least length of a line, and least extent of an area, that are measured, m.
const EXTENT_MIN_M: f32 = 0.01;
/// Least area of a zone that is closed to some agents, m².
const AREA_MIN_M2: f64 = 1e-4;

/// Checks lines and areas that are measured, and their names.
pub(crate) fn check_measures(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let measures = &scenario.measures;
    let first = &ScenarioPart::Measure(0);
    within(first, "the number of measures", measures.len(), &(0..=TABLES_MAX), "give fewer")?;
    for (index, spec) in measures.iter().enumerate() {
        let part = &ScenarioPart::Measure(index);
        check_name(&spec.name).map_err(|fault| ScenarioFault { part: part.clone(), ..fault })?;
        if measures[..index].iter().any(|other| other.name == spec.name) {
            return part.fault(format!("two measures have the name `{}`", spec.name), "choose another name");
        }
        match &spec.place {
            MeasuredPlace::Line(ends_m) => {
                check_points(part, ends_m)?;
                let length_m = ends_m[0].distance(ends_m[1]);
                check_extent(part, "the length of the line", length_m, "give two ends, in metres")?;
            }
            MeasuredPlace::Area(area) => {
                check_area(part, area)?;
                let size_m = area.bounds_m();
                let least_m = (size_m[1] - size_m[0]).min_element();
                check_extent(part, "the extent of the area", least_m, "give an area, in metres")?;
            }
            MeasuredPlace::Egress => {}
        }
    }
    Ok(())
}

/// Checks a length that has a least value alone; coordinates limit it.
fn check_extent(part: &ScenarioPart, name: &str, extent_m: f32, help: &'static str) -> Result<(), ScenarioFault> {
    match extent_m >= EXTENT_MIN_M {
        true => Ok(()),
        false => part.fault(format!("{name} is {extent_m} m, less than {EXTENT_MIN_M} m"), help),
    }
}

/// Checks areas and factors of zones.
pub(crate) fn check_zones(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let zones = &scenario.zones;
    within(&ScenarioPart::Zone(0), "the number of zones", zones.len(), &(0..=TABLES_MAX), "give fewer")?;
    for (index, zone) in zones.iter().enumerate() {
        let part = &ScenarioPart::Zone(index);
        check_area(part, &zone.area)?;
        within(part, "speed_factor", zone.speed_factor, &FACTOR, "1 changes nothing, 0.5 is half the speed")?;
        if zone.is_closed && signed_area_m2(&zone.area.outline_m()) < AREA_MIN_M2 {
            return part.fault("the zone has no area".into(), "give a zone with an inside");
        }
        check_one_way(scenario, index)?;
    }
    let sets = scenario.closed_zone_sets().len();
    within(&ScenarioPart::Zone(0), "the number of sets of closed zones", sets, &(0..=SETS_MAX), "close fewer zones")
}

/// Checks that a one-way zone is a rectangle along its direction, and apart from the other one-way zones.
fn check_one_way(scenario: &Scenario, index: usize) -> Result<(), ScenarioFault> {
    let (zone, part) = (&scenario.zones[index], ScenarioPart::Zone(index));
    let Some(one_way_deg) = zone.one_way_deg else { return Ok(()) };
    let help = "give a direction from +x, counter-clockwise, in degrees";
    within(&part, "one_way_deg", one_way_deg, &(-360.0..=360.0), help)?;
    let Some(one_way) = zone.one_way() else {
        return part.fault(
            format!("a one-way zone is a rectangle with two sides along `one_way_deg`; {one_way_deg}° is along none"),
            "with `rect_m` write 0, 90, 180 or 270; for other directions give four corners in `polygon_m`",
        );
    };
    for (other, spec) in scenario.zones[..index].iter().enumerate() {
        if spec.one_way().is_some_and(|spec| one_way.overlaps(&spec)) {
            let message = format!("the one-way zones {other} and {index} overlap");
            return part.fault(message, "move them apart until they touch at most");
        }
    }
    Ok(())
}
