//! What a scenario's `[[measure]]` tables state: lines, areas and the egress, measured frame by frame.
//!
//! Enters: the frames of a recording. Leaves: a [`PlaceMeasures`] for each table.
//!
//! Read `line_flow` (passages, N–t, flow), `area_density` (density, speed, level of service) with `voronoi_cell` and
//! `cell_part`, then
//! `egress`. World, metres, seconds.

pub(crate) mod area_density;
pub(crate) mod cell_part;
pub(crate) mod egress;
pub(crate) mod line_flow;
pub(crate) mod voronoi_cell;

use serde::Serialize;

pub use area_density::{AreaMeasures, AreaMoment, LEVELS_OF_SERVICE};
pub use egress::EgressMeasures;
pub use line_flow::{LineMeasures, Passages};

use crate::measures::frame_pairs::FramePairs;
use crate::measures::places::area_density::MeasuredArea;
use crate::measures::places::cell_part::CellWalls;
use crate::measures::places::line_flow::MeasuredLine;
use crate::population::Population;
use crate::recording::frame::AgentFrame;
use crate::scenario::{MeasuredPlace, Scenario};

/// The measures of one `[[measure]]` table; exactly one of the three is there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlaceMeasures {
    /// Name of the table.
    pub name: String,
    /// Passages over a line.
    pub line: Option<LineMeasures>,
    /// Density and speed in an area.
    pub area: Option<AreaMeasures>,
    /// Times of removal.
    pub egress: Option<EgressMeasures>,
}

/// The measures of all tables while frames come.
#[derive(Debug)]
pub(crate) struct MeasuredPlaces {
    dt_s: f64,
    places: Vec<(String, PlaceState)>,
    /// The scenario, where it has doors.
    with_doors: Option<Scenario>,
    /// Whether each door is closed in the present frame, by index.
    closed: Vec<bool>,
}

#[derive(Debug)]
enum PlaceState {
    Line(MeasuredLine),
    Area(MeasuredArea),
    Egress,
}

impl MeasuredPlaces {
    /// The tables of a scenario, the agents at their start, and whether each door is closed then, by index.
    pub(crate) fn new(scenario: &Scenario, start: &[AgentFrame], closed: Vec<bool>) -> Self {
        let dt_s = f64::from(scenario.dt_s);
        let walls = CellWalls::new(scenario, &closed);
        let state = |place: &MeasuredPlace| match place {
            MeasuredPlace::Line(ends_m) => PlaceState::Line(MeasuredLine::new(*ends_m)),
            MeasuredPlace::Area(area) => PlaceState::Area(MeasuredArea::new(area, dt_s, walls.clone(), start)),
            MeasuredPlace::Egress => PlaceState::Egress,
        };
        Self {
            dt_s,
            places: scenario.measures.iter().map(|spec| (spec.name.clone(), state(&spec.place))).collect(),
            with_doors: (!scenario.doors.is_empty()).then(|| scenario.clone()),
            closed,
        }
    }

    /// Takes whether each door is closed in the next frame, by index.
    pub(crate) fn set_doors(&mut self, closed: &[bool]) {
        let Some(scenario) = self.with_doors.as_ref().filter(|_| self.closed != closed) else { return };
        let walls = CellWalls::new(scenario, closed);
        self.closed = closed.to_vec();
        for (_, place) in &mut self.places {
            if let PlaceState::Area(area) = place {
                area.set_walls(&walls);
            }
        }
    }

    /// Adds the step that ends in a frame, given the agents before and after it.
    pub(crate) fn push(&mut self, frame: u32, pairs: &FramePairs<'_>, after: &[AgentFrame]) {
        for (_, place) in &mut self.places {
            match place {
                PlaceState::Line(line) => line.push(f64::from(frame) * self.dt_s, self.dt_s, pairs),
                PlaceState::Area(area) => area.push(frame, pairs, after),
                PlaceState::Egress => {}
            }
        }
    }

    /// The measures after the last frame.
    pub(crate) fn finish(self, population: &Population) -> Vec<PlaceMeasures> {
        let dt_s = self.dt_s;
        let finish = |(name, place)| {
            let nothing = PlaceMeasures { name, line: None, area: None, egress: None };
            match place {
                PlaceState::Line(line) => PlaceMeasures { line: Some(line.finish()), ..nothing },
                PlaceState::Area(area) => PlaceMeasures { area: Some(area.finish()), ..nothing },
                PlaceState::Egress => PlaceMeasures { egress: Some(EgressMeasures::of(population, dt_s)), ..nothing },
            }
        };
        self.places.into_iter().map(finish).collect()
    }
}
