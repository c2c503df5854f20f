//! The shapes that mark points in plots and stand for lines in legends. Pixels, y down.

use glam::Vec2;
use tiny_skia::{FillRule, LineCap, Path, PathBuilder, Pixmap, Stroke, Transform};

use crate::raster::palette::Rgb;
use crate::top_view::ground::paint;

/// Width of strokes, in radii.
const STROKE_SHARE: f32 = 0.42;

/// The shape that marks a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A filled disc.
    Disc,
    /// An open ring.
    Ring,
    /// Two crossed strokes.
    Cross,
    /// A filled square on its corner.
    Diamond,
    /// An open square on its corner.
    OpenDiamond,
    /// A dashed line, in legends.
    Dashes,
    /// A thick line, in legends.
    Bar,
}

impl Mark {
    /// Draws the mark about a place.
    pub fn draw(self, pixmap: &mut Pixmap, centre: Vec2, radius: f32, colour: Rgb) {
        let Some(path) = self.path(centre, radius) else { return };
        let (paint, identity) = (paint(colour, 1.0), Transform::identity());
        match self {
            Self::Disc | Self::Diamond | Self::Bar => {
                pixmap.fill_path(&path, &paint, FillRule::Winding, identity, None);
            }
            Self::Ring | Self::OpenDiamond | Self::Cross | Self::Dashes => {
                let stroke = Stroke { width: STROKE_SHARE * radius, line_cap: LineCap::Round, ..Stroke::default() };
                pixmap.stroke_path(&path, &paint, &stroke, identity, None);
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

    /// Corners of the strokes, radii from the centre; circles have none.
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
