//! Framing: the part of the world that a picture shows, and the map from metres to pixels. The scenario's view gives
//! it; what the view leaves open is fitted to all agents, goals and obstacles.
//!
//! World: x right, y up in the picture, metres. Pixels: x right, y down, (0, 0) the picture's upper left corner.

use fbcrowd_sim::recording::Header;
use fbcrowd_sim::scenario::{ScenarioFault, View, check_view};
use glam::Vec2;

use crate::error::RenderError;

/// Margin around every fitted position, m: half an arm span, so that no body is cut at the picture's edge.
const BODY_MARGIN_M: f32 = 0.7;
/// Further margin, share of the fitted width.
const AIR_SHARE: f32 = 0.02;
/// Least fitted width, m: a single standing body does not fill the picture.
const MIN_WIDTH_M: f32 = 4.0;

/// A window onto the ground, seen from straight above.
///
/// ```
/// use fbcrowd_render::Framing;
/// use glam::Vec2;
///
/// let framing = Framing { width_px: 640, height_px: 360, centre_m: Vec2::new(5.0, 0.0), scale_px_m: 40.0 };
/// assert_eq!(framing.to_px(Vec2::new(6.0, 1.0)), Vec2::new(360.0, 140.0));
/// assert_eq!(framing.to_world(Vec2::new(320.0, 180.0)), Vec2::new(5.0, 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// Width of the picture, pixels.
    pub width_px: u32,
    /// Height of the picture, pixels.
    pub height_px: u32,
    /// Point of the world at the picture's centre, m.
    pub centre_m: Vec2,
    /// Scale of the picture, pixels per metre.
    pub scale_px_m: f32,
}

impl Framing {
    /// A point of the world in the picture, pixels.
    pub fn to_px(&self, point_m: Vec2) -> Vec2 {
        let from_centre = (point_m - self.centre_m) * Vec2::new(self.scale_px_m, -self.scale_px_m);
        from_centre + 0.5 * self.size_px()
    }

    /// A point of the picture in the world, m.
    pub fn to_world(&self, point_px: Vec2) -> Vec2 {
        let from_centre = (point_px - 0.5 * self.size_px()) / self.scale_px_m;
        self.centre_m + Vec2::new(from_centre.x, -from_centre.y)
    }

    /// Width and height of the picture, pixels.
    pub fn size_px(&self) -> Vec2 {
        Vec2::new(self.width_px as f32, self.height_px as f32)
    }
}

/// The framing of a recording. What the view leaves open is fitted to `positions_m` (of the whole recording, so that
/// the picture does not move), to goals and to obstacles.
///
/// # Errors
/// If the view is out of range; the view of an opened recording is not.
pub(crate) fn frame_recording(
    header: &Header,
    positions_m: impl Iterator<Item = Vec2>,
) -> Result<Framing, RenderError> {
    let view = &header.scenario.view;
    check_view(view).map_err(|ScenarioFault { message, help, .. }| RenderError::View { message, help })?;
    let agents = &header.scenario.agents;
    let starts = agents.iter().map(|agent| agent.position_m);
    let goals = agents.iter().flat_map(|agent| agent.goals_m.iter().copied());
    let sources = &header.scenario.sources;
    let areas = sources.iter().flat_map(|source| [source.low_m, source.high_m]);
    let goals = goals.chain(sources.iter().flat_map(|source| source.goals_m.iter().copied())).chain(areas);
    let corners = header.scenario.obstacles_m.iter().flatten().copied();
    let shown = positions_m.chain(starts).chain(goals).chain(corners);
    Ok(fit(view, bounds_m(shown)))
}

/// Least and greatest corner of the box around points, m; the origin without points.
pub(crate) fn bounds_m(points: impl Iterator<Item = Vec2>) -> [Vec2; 2] {
    points
        .filter(|point| point.is_finite())
        .map(|point| [point, point])
        .reduce(|[low, high], [point, _]| [low.min(point), high.max(point)])
        .unwrap_or_default()
}

fn fit(view: &View, [low_m, high_m]: [Vec2; 2]) -> Framing {
    let centre_m = view.centre_m.unwrap_or(0.5 * (low_m + high_m));
    // The centre may be given: then the farthest point decides on both sides.
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
    fn given_centre_and_width_are_kept() {
        let view = View { centre_m: Some(Vec2::new(2.0, 3.0)), width_m: Some(64.0), ..View::default() };
        let framing = fit(&view, [Vec2::ZERO, Vec2::ONE]);
        assert_eq!(framing.to_px(Vec2::new(2.0, 3.0)), Vec2::new(640.0, 360.0));
        assert_eq!(framing.scale_px_m, 20.0);
    }
}
