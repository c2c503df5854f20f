//! Marks: shapes of points in plots and of entries in legends. Pixels, y down.

use glam::Vec2;
use tiny_skia::{LineCap, Path, PathBuilder, Pixmap, Stroke};

use crate::raster::paint::{fill, paint, stroke};
use crate::raster::palette::Rgb;

/// Width of strokes, radii.
const STROKE_SHARE: f32 = 0.42;

/// Shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlotMark {
    /// A filled disc.
    Disc,
    /// An open ring.
    Ring,
    /// Two crossed strokes.
    Cross,
    /// A filled square on one corner.
    Diamond,
    /// An open square on one corner.
    OpenDiamond,
    /// A dashed line, in legends.
    Dashes,
    /// A thick line, in legends.
    Bar,
}

impl PlotMark {
    /// Draws the mark around a point.
    pub(crate) fn draw(self, pixmap: &mut Pixmap, centre: Vec2, radius: f32, colour: Rgb) {
        let Some(path) = self.path(centre, radius) else { return };
        let paint = paint(colour, 1.0);
        match self {
            Self::Disc | Self::Diamond | Self::Bar => fill(pixmap, &path, &paint, None),
            Self::Ring | Self::OpenDiamond | Self::Cross | Self::Dashes => {
                let pen = Stroke { width: STROKE_SHARE * radius, line_cap: LineCap::Round, ..Stroke::default() };
                stroke(pixmap, &path, &paint, &pen, None);
            }
        }
    }

    fn path(self, centre: Vec2, radius: f32) -> Option<Path> {
        let mut path = PathBuilder::new();
        if matches!(self, Self::Disc | Self::Ring) {
            path.push_circle(centre.x, centre.y, radius);
        }
        for stroke in self.strokes() {
            for (index, [x, y]) in stroke.iter().enumerate() {
                let (x, y) = (centre.x + x * radius, centre.y + y * radius);
                if index == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
            }
        }
        path.finish()
    }

    /// Corners of the strokes, relative to the centre, radii; circles have none.
    const fn strokes(self) -> &'static [&'static [[f32; 2]]] {
        match self {
            Self::Disc | Self::Ring => &[],
            Self::Cross => &[&[[-0.8, -0.8], [0.8, 0.8]], &[[-0.8, 0.8], [0.8, -0.8]]],
            Self::Diamond | Self::OpenDiamond => &[&[[0.0, -1.2], [1.2, 0.0], [0.0, 1.2], [-1.2, 0.0], [0.0, -1.2]]],
            Self::Dashes => &[&[[-1.2, 0.0], [-0.4, 0.0]], &[[0.4, 0.0], [1.2, 0.0]]],
            Self::Bar => &[&[[-1.2, -0.3], [1.2, -0.3], [1.2, 0.3], [-1.2, 0.3]]],
        }
    }
}
