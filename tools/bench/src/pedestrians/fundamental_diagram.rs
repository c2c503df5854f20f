//! RiMEA test 4: speed and density of a crowd that goes one way, against Weidmann's curve. World, metres, seconds.

use std::path::Path;

use fbcrowd_render::plots::crowd::{FundamentalDiagram, fundamental_diagram};
use fbcrowd_render::raster::png_frame;
use fbcrowd_sim::measures::{MeasuredSection, weidmann_mps};
use fbcrowd_sim::scenario::MeasuredPlace;
use glam::Vec2;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::report::Criterion;
use crate::kit::scenario_run::ScenarioRun;
use crate::pedestrians::case::{CaseOutcome, figure};

/// Name of the scenario.
pub(crate) const DIAGRAM_SCENARIO: &str = "04_fundamental_diagram";
/// Greatest difference from Weidmann's curve, m/s. Between 0.5 and 3 people/m² the lines of Fruin 1971 (1.43 − 0.35 ρ)
/// and of the SFPE handbook (1.40 − 0.372 ρ) lie up to 0.12 from it; the short measurement adds a little.
const TOLERANCE_MPS: f64 = 0.15;
/// Start and end of the measurement, s.
const SECTION_TIME_S: [f64; 2] = [5.0, 12.0];
/// Densities at which the curve begins and ends in the picture, 1/m².
const DRAWN_PER_M2: [f64; 2] = [0.2, 3.9];
/// Number of pieces of the curve in the picture.
const DRAWN_PIECES: usize = 64;

/// A point of the fundamental diagram: one measured place of a corridor.
#[derive(Clone, Copy, Debug, JsonSchema, Serialize)]
pub struct DiagramPoint {
    /// Density, agents per square metre.
    pub per_m2: f64,
    /// Mean speed, m/s.
    pub speed_mps: f64,
    /// Speed at this density by Weidmann 1993, m/s.
    pub weidmann_mps: f64,
}

/// Density and speed in each place that the scenario measures.
pub(crate) fn diagram_points(run: &ScenarioRun) -> Vec<DiagramPoint> {
    let areas = run.scenario.measures.iter().filter_map(|measure| match &measure.place {
        MeasuredPlace::Area(area) => Some(area.bounds_m()),
        _ => None,
    });
    let mut sections: Vec<MeasuredSection> = areas.map(|[low_m, high_m]| MeasuredSection::new(low_m, high_m)).collect();
    let [from_s, to_s] = SECTION_TIME_S;
    for step in run.steps().filter(|step| (from_s..=to_s).contains(&step.end_s)) {
        sections.iter_mut().for_each(|section| section.push(&step.before_m, &step.after_m, run.dt_s()));
    }
    let measured = sections.iter().filter_map(MeasuredSection::means);
    let point = measured.map(|measured| DiagramPoint {
        per_m2: measured.per_m2,
        speed_mps: measured.speed_mps,
        weidmann_mps: weidmann_mps(measured.per_m2),
    });
    point.collect()
}

/// Judges the only run.
pub(crate) fn judge(runs: &[ScenarioRun]) -> CaseOutcome {
    let points = diagram_points(&runs[0]);
    let name =
        |point: &DiagramPoint| format!("speed at {:.2}/m², m/s; Weidmann {:.3}", point.per_m2, point.weidmann_mps);
    let off_mps = points.iter().map(|point| (point.speed_mps - point.weidmann_mps).abs()).reduce(f64::max);
    CaseOutcome {
        figures: points.iter().map(|point| figure(name(point), point.speed_mps)).collect(),
        criteria: vec![Criterion::at_most("RiMEA 4: farthest from Weidmann's curve, m/s", TOLERANCE_MPS, off_mps)],
    }
}

/// Draws the points beside Weidmann's curve.
pub(crate) fn draw(path: &Path, points: &[DiagramPoint]) -> Result<(), BenchError> {
    let [low, high] = DRAWN_PER_M2;
    let density_per_m2 = |piece: usize| low + (high - low) * piece as f64 / DRAWN_PIECES as f64;
    let drawn = |per_m2: f64, speed_mps: f64| Vec2::new(per_m2 as f32, speed_mps as f32);
    let curve = (0..=DRAWN_PIECES).map(density_per_m2).map(|per_m2| drawn(per_m2, weidmann_mps(per_m2)));
    let picture = fundamental_diagram(&FundamentalDiagram {
        title: "Fundamental diagram: agents that all go one way",
        across: "density, agents/m²",
        up: "speed, m/s",
        curve: ("Weidmann 1993", curve.collect()),
        points: ("simulated", points.iter().map(|point| drawn(point.per_m2, point.speed_mps)).collect()),
    });
    Ok(png_frame::write(path, &picture)?)
}
