//! Which part of the world a picture shows: metres to pixels, chosen by the view or fitted to all that moves and
//! stands.
//!
//! World: x right, y up in the picture. Pixels: x right, y down, (0, 0) the picture's upper left corner.

use fbcrowd_sim::recording::Header;
use fbcrowd_sim::scenario::{ScenarioFault, View, check_view};
use glam::Vec2;

use crate::error::RenderError;

/// Largest picture side, pixels: 16k film scans; beyond it a frame would take gigabytes.
pub(crate) const MAX_SIDE_PX: u32 = 16_384;
/// Room around every fitted position: half an arm span, so that no body is cut at the picture's edge, m.
const BODY_MARGIN_M: f32 = 0.7;
/// Further room, share of the fitted width.
const AIR_SHARE: f32 = 0.02;
/// Least fitted width: one body that stands still is not blown up to the whole picture, m.
const MIN_WIDTH_M: f32 = 4.0;

/// A window onto the ground, seen straight from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// Pixels.
    pub width_px: u32,
    /// Pixels.
    pub height_px: u32,
    /// The point of the world in the picture's centre, m.
    pub centre_m: Vec2,
    /// Pixels a metre.
    pub scale_px_m: f32,
}

impl Framing {
    /// A world point in the picture, pixels.
    pub fn to_px(&self, point_m: Vec2) -> Vec2 {
        let from_centre = (point_m - self.centre_m) * Vec2::new(self.scale_px_m, -self.scale_px_m);
        from_centre + 0.5 * self.size_px()
    }

    /// A picture point in the world, m.
    pub fn to_world(&self, point_px: Vec2) -> Vec2 {
        let from_centre = (point_px - 0.5 * self.size_px()) / self.scale_px_m;
        self.centre_m + Vec2::new(from_centre.x, -from_centre.y)
    }

    /// Width and height, pixels.
    pub fn size_px(&self) -> Vec2 {
        Vec2::new(self.width_px as f32, self.height_px as f32)
    }
}

/// The framing that a recording's view asks for; what the view leaves open is fitted to `positions_m` (of the whole
/// recording, so that the picture does not move), to goals and to obstacles.
///
/// # Errors
/// Where the view is out of range: that of a recording that was opened is not.
pub(crate) fn frame_recording(header: &Header, positions_m: &[Vec2]) -> Result<Framing, RenderError> {
    let view = &header.scenario.view;
    check_view(view).map_err(|ScenarioFault { message, help, .. }| RenderError::View { message, help })?;
    let agents = &header.scenario.agents;
    let starts = agents.iter().map(|agent| agent.position_m);
    let goals = agents.iter().flat_map(|agent| agent.goals_m.iter().copied());
    let corners = header.scenario.obstacles_m.iter().flatten().copied();
    let shown = positions_m.iter().copied().chain(starts).chain(goals).chain(corners);
    Ok(fit(view, bounds_m(shown)))
}

/// Least and greatest corner; a point at the origin where there is nothing.
pub(crate) fn bounds_m(points: impl Iterator<Item = Vec2>) -> [Vec2; 2] {
    points
        .filter(|point| point.is_finite())
        .map(|point| [point, point])
        .reduce(|[low, high], [point, _]| [low.min(point), high.max(point)])
        .unwrap_or_default()
}

fn fit(view: &View, [low_m, high_m]: [Vec2; 2]) -> Framing {
    let centre_m = view.centre_m.unwrap_or(0.5 * (low_m + high_m));
    // About a centre that was asked for, what lies farthest off decides on both sides.
    let reach_m = (high_m - centre_m).max(centre_m - low_m) + BODY_MARGIN_M;
    let aspect = view.width as f32 / view.height as f32;
    let fitted_m = (2.0 * reach_m.x).max(2.0 * reach_m.y * aspect) * (1.0 + AIR_SHARE);
    let width_m = view.width_m.unwrap_or(fitted_m.max(MIN_WIDTH_M));
    Framing { width_px: view.width, height_px: view.height, centre_m, scale_px_m: view.width as f32 / width_m }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fitted_framing_shows_every_point_with_its_body() {
        for (width, height) in [(1280, 720), (720, 1280), (500, 500)] {
            let view = View { width, height, ..View::default() };
            let points = [Vec2::new(-3.0, 1.0), Vec2::new(9.0, 2.0), Vec2::new(4.0, -7.0)];
            let framing = fit(&view, bounds_m(points.into_iter()));
            for point in points {
                let margin = BODY_MARGIN_M * framing.scale_px_m;
                let px = framing.to_px(point);
                assert!(px.min_element() >= margin - 1e-3, "{px}");
                assert!((framing.size_px() - px).min_element() >= margin - 1e-3, "{px}");
                assert!((framing.to_world(px) - point).length() < 1e-4);
            }
        }
    }

    #[test]
    fn asked_centre_and_width_are_kept() {
        let view = View { centre_m: Some(Vec2::new(2.0, 3.0)), width_m: Some(64.0), ..View::default() };
        let framing = fit(&view, [Vec2::ZERO, Vec2::ONE]);
        assert_eq!(framing.to_px(Vec2::new(2.0, 3.0)), Vec2::new(640.0, 360.0));
        assert_eq!(framing.scale_px_m, 20.0);
    }
}
