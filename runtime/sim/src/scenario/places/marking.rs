//! Markings of the ground, and labels of places: what pictures show besides walls and agents. They change no motion.
//! World, metres.

use std::f32::consts::TAU;

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::behaviour::Area;

/// Corners of the polygon that shows a disc.
const DISC_CORNERS: u8 = 48;

/// A marking of the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Marking {
    /// Its shape.
    pub shape: MarkingShape,
    /// Its colour.
    pub colour: MarkingColour,
}

/// The shape of a marking.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MarkingShape {
    /// An area.
    Area(Area),
    /// A straight line with square ends; with dashes as wide as a lane, a zebra crossing.
    Line {
        /// Both ends, world, m.
        ends_m: [Vec2; 2],
        /// Width of the line, m.
        width_m: f32,
        /// Length of a dash and of the gap after it, m; none of a solid line.
        dash_m: Option<[f32; 2]>,
    },
}

/// The colour of a marking.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MarkingColour {
    /// Red, green and blue, sRGB, 0 to 255.
    Fixed([u8; 3]),
    /// Green or red, as a signal is; the signal by index.
    Signal(u32),
}

/// A text at a place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaceLabel {
    /// The text, one line.
    pub text: String,
    /// Its middle, world, m.
    pub at_m: Vec2,
}

impl MarkingShape {
    /// The simple polygons that show it, m.
    pub fn polygons_m(&self) -> Vec<Vec<Vec2>> {
        match self {
            Self::Area(Area::Polygon(corners_m)) => vec![corners_m.clone()],
            Self::Area(Area::Disc { centre_m, radius_m }) => {
                let angles_rad = (0..DISC_CORNERS).map(|corner| TAU * f32::from(corner) / f32::from(DISC_CORNERS));
                let around =
                    angles_rad.map(libm::sincosf).map(|(sin, cos)| *centre_m + *radius_m * Vec2::new(cos, sin));
                vec![around.collect()]
            }
            Self::Line { ends_m: [from_m, to_m], width_m, dash_m } => {
                let (length_m, along) = (from_m.distance(*to_m), (*to_m - *from_m).normalize_or_zero());
                let beside_m = 0.5 * *width_m * along.perp();
                let [dash_m, gap_m] = dash_m.unwrap_or([length_m, 0.0]);
                let count = dash_count(length_m, dash_m + gap_m);
                let dashes = (0..count).map(|index| {
                    let begin_m = index as f32 * (dash_m + gap_m);
                    let [a_m, b_m] = [begin_m, (begin_m + dash_m).min(length_m)].map(|at_m| *from_m + at_m * along);
                    vec![a_m - beside_m, b_m - beside_m, b_m + beside_m, a_m + beside_m]
                });
                dashes.collect()
            }
        }
    }

    /// Number of its polygons.
    pub(crate) fn polygon_count(&self) -> usize {
        match self {
            Self::Area(_) | Self::Line { dash_m: None, .. } => 1,
            Self::Line { ends_m: [from_m, to_m], dash_m: Some([dash_m, gap_m]), .. } => {
                dash_count(from_m.distance(*to_m), dash_m + gap_m)
            }
        }
    }

    /// Its middle, m.
    pub(crate) fn centre_m(&self) -> Vec2 {
        match self {
            Self::Area(area) => area.centre_m(),
            Self::Line { ends_m: [from_m, to_m], .. } => from_m.midpoint(*to_m),
        }
    }
}

/// Number of dashes on a line; a last one shorter than a millimetre is none.
fn dash_count(length_m: f32, period_m: f32) -> usize {
    ((length_m - 1e-3) / period_m).ceil().max(1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zebra(length_m: f32, dash_m: Option<[f32; 2]>) -> MarkingShape {
        MarkingShape::Line { ends_m: [Vec2::new(1.0, 2.0), Vec2::new(1.0, 2.0 + length_m)], width_m: 4.0, dash_m }
    }

    #[test]
    fn a_zebra_crossing_has_bars_across_its_line() {
        let bars_m = zebra(2.0, Some([0.5, 0.5])).polygons_m();
        assert_eq!(bars_m.len(), zebra(2.0, Some([0.5, 0.5])).polygon_count());
        let box_m = |bar_m: &Vec<Vec2>| Area::Polygon(bar_m.clone()).bounds_m();
        let expected_m = [[2.0, 2.5], [3.0, 3.5]].map(|[low, high]| [Vec2::new(-1.0, low), Vec2::new(3.0, high)]);
        assert_eq!(bars_m.iter().map(box_m).collect::<Vec<_>>(), expected_m);
    }

    #[test]
    fn the_last_dash_ends_with_its_line() {
        let ends_m = |shape: MarkingShape| {
            let corners_m = shape.polygons_m();
            corners_m.iter().flatten().map(|corner_m| corner_m.y).fold(0.0, f32::max)
        };
        assert_eq!([zebra(2.2, Some([0.5, 0.5])), zebra(2.2, None)].map(ends_m), [4.2, 4.2]);
        assert_eq!(zebra(2.2, Some([0.5, 0.5])).polygon_count(), 3);
    }
}
