//! The rules of markings and labels: numbers in range, and few enough polygons to draw. World, metres.

use std::ops::RangeInclusive;

use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::places::marking::{MarkingColour, MarkingShape, PlaceLabel};
use crate::scenario::ranges::{check_points, within};
use crate::scenario::resolved::Scenario;
use crate::scenario::rules::behaviour_check::check_area;

/// Greatest number of markings, and of labels.
pub(crate) const MARKINGS_MAX: usize = 10_000;
/// Greatest number of polygons of all markings: a dashed line has one for each dash.
const POLYGONS_MAX: usize = 100_000;
/// Width of a line, length of a dash and of a gap, m: from a thin line to a runway.
const LENGTH_M: RangeInclusive<f32> = 0.01..=1_000.0;
/// Greatest length of a label, bytes.
const LABEL_MAX_BYTES: usize = 200;

/// Checks every marking and label.
pub(crate) fn check_markings(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let Scenario { markings, labels, behaviour, .. } = scenario;
    let counts = [("markings", markings.len()), ("labels", labels.len())];
    for (what, count) in counts {
        let name = format!("the number of {what}");
        within(&ScenarioPart::Marking(0), &name, count, &(0..=MARKINGS_MAX), "give fewer")?;
    }
    let mut polygons = 0;
    for (index, marking) in markings.iter().enumerate() {
        let part = &ScenarioPart::Marking(index);
        check_shape(part, &marking.shape)?;
        polygons += marking.shape.polygon_count();
        let name = "the number of dashes and areas of all markings";
        within(part, name, polygons, &(0..=POLYGONS_MAX), "give longer dashes, or fewer markings")?;
        if let MarkingColour::Signal(signal) = marking.colour
            && signal as usize >= behaviour.signals.len()
        {
            return part.fault(format!("there is no signal {signal}"), "name a signal of the scenario");
        }
    }
    labels.iter().enumerate().try_for_each(|(index, label)| check_label(&ScenarioPart::Label(index), label))
}

fn check_shape(part: &ScenarioPart, shape: &MarkingShape) -> Result<(), ScenarioFault> {
    match shape {
        MarkingShape::Area(area) => check_area(part, area),
        MarkingShape::Line { ends_m, width_m, dash_m } => {
            check_points(part, ends_m)?;
            within(part, "width_m", *width_m, &LENGTH_M, "give the width of the line in metres")?;
            dash_m.iter().flatten().try_for_each(|length_m| {
                within(part, "dash_m", *length_m, &LENGTH_M, "write `dash_m = [length of a dash, length of a gap]`")
            })
        }
    }
}

fn check_label(part: &ScenarioPart, label: &PlaceLabel) -> Result<(), ScenarioFault> {
    check_points(part, &[label.at_m])?;
    let bytes = label.text.len();
    if (1..=LABEL_MAX_BYTES).contains(&bytes) && !label.text.chars().any(char::is_control) {
        return Ok(());
    }
    part.fault(format!("a label has {bytes} bytes, or more than one line"), "write 1 to 200 bytes on one line")
}
