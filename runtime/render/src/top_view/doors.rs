//! Doors in a top view: a closed door is drawn as an obstacle, an open one as a dashed outline.
//!
//! Enters: doors and their phases, world metres; they change from frame to frame, so they lie over the static layer.

use fbcrowd_sim::population::DoorPhases;
use fbcrowd_sim::scenario::Scenario;
use tiny_skia::{FillRule, LineJoin, Path, Pixmap, Stroke, StrokeDash, Transform};

use crate::raster::paint::{paint, path_through};
use crate::raster::palette;
use crate::raster::pixels::Strip;
use crate::top_view::framing::Framing;

/// Width of a door's rim, m: that of an obstacle.
const RIM_M: f32 = 0.035;
/// Length of a dash of an open door's outline, m.
const DASH_M: f32 = 0.1;
/// Opacity of an open door's outline.
const OPEN_OPACITY: f32 = 0.55;

/// The doors of a recording as paths in the picture.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawnDoors<'a> {
    doors: Vec<(Path, &'a DoorPhases)>,
    dt_s: f32,
    scale_px_m: f32,
}

impl<'a> DrawnDoors<'a> {
    /// The doors of a scenario, with their phases by index.
    pub(crate) fn new(scenario: &Scenario, phases: &'a [DoorPhases], framing: &Framing) -> Self {
        let doors = scenario.doors.iter().zip(phases).filter_map(|(door, phases)| {
            let outline = path_through(door.polygon_m.iter().map(|corner_m| framing.to_px(*corner_m)), true)?;
            Some((outline, phases))
        });
        Self { doors: doors.collect(), dt_s: scenario.dt_s, scale_px_m: framing.scale_px_m }
    }

    /// Draws the doors at a time into the rows of a strip.
    pub(crate) fn draw(&self, pixmap: &mut Pixmap, strip: &Strip, time_s: f32) {
        // A frame that is shown unchanged has its doors.
        let frame = (time_s / self.dt_s + 1e-3) as u32;
        let to_strip = Transform::from_translate(0.0, -(strip.top_px as f32));
        let rim = Stroke {
            width: (RIM_M * self.scale_px_m).clamp(1.0, 4.0),
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        for (outline, phases) in &self.doors {
            if phases.is_closed(frame) {
                pixmap.fill_path(outline, &paint(palette::OBSTACLE, 1.0), FillRule::Winding, to_strip, None);
                pixmap.stroke_path(outline, &paint(palette::OBSTACLE_RIM, 1.0), &rim, to_strip, None);
            } else {
                let dash = (DASH_M * self.scale_px_m).max(2.0);
                let dashed = Stroke { dash: StrokeDash::new(vec![dash; 2], 0.0), ..rim.clone() };
                pixmap.stroke_path(outline, &paint(palette::OBSTACLE_RIM, OPEN_OPACITY), &dashed, to_strip, None);
            }
        }
    }
}
