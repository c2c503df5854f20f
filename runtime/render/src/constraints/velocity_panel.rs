//! A panel: the velocity space of one agent in one step (`FbCrowd` Figs. 3–5), with the constraints of its body, its
//! stance foot, walls and neighbours, and its preferred, adapted, planned and actual velocities.
//!
//! World axes, m/s, origin in the middle: directions are those of the scene. A half-plane is a line with hatching on
//! its forbidden side, thick if the planned velocity is on it, dashed if it had to yield. The feasible region is pale
//! green; if a half-plane had to yield, the region of the others is pale orange. Social forces have no half-planes: a
//! force is an arrow from the current velocity, of the length that it would add within the relaxation time. The driving
//! force, drawn in this form, would end at v_pref.

use fbcrowd_sim::planning::orca::{HalfPlane, HalfPlaneSource};
use fbcrowd_sim::planning::{Planner, VelocitySet};
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::constraints::constraint_style::{ACTUAL, ADAPTED, PLANNED, PREFERRED, source_colour, source_name};
use crate::constraints::explained_step::ExplainedStep;
use crate::constraints::feasible_region::feasible_region_mps;
use crate::constraints::legend;
use crate::plots::chart::axis::PlotAxis;
use crate::plots::chart::figure::{LineStyle, PlotFigure, PlotPanel};
use crate::raster::palette::{self, INK, Rgb, SHARP_TURN_EDGES};

/// Height of the reference panel, panel units; a unit is a pixel there, and in proportion in other panels.
const REFERENCE_HEIGHT: f32 = 720.0;
/// Width of a panel, panel units.
const WIDTH: f32 = 940.0;
/// Size of letters, as a multiple of the usual one in plots.
const LETTERS: f32 = 0.62;
/// Left end of the title's baseline, panel units.
const TITLE: Vec2 = Vec2::new(66.0, 36.0);
/// Left, top, width, height of the axes, panel units.
const AXES: [f32; 4] = [66.0, 80.0, 578.0, 578.0];
/// Left, top, width of legend and numbers, panel units.
const LEGEND: [f32; 3] = [666.0, 80.0, 256.0];

/// Colour of the feasible region if no half-plane had to yield: a pale green.
const FEASIBLE: Rgb = Rgb::new(0.74, 0.91, 0.70);
/// Colour of the region if a half-plane had to yield: a pale orange.
const RELAXED: Rgb = Rgb::new(0.99, 0.85, 0.62);
/// Colour of forbidden velocities: a pale grey.
const FORBIDDEN: Rgb = Rgb::new(0.945, 0.943, 0.94);

/// Distance up to which a half-plane's line is at the edge of the feasible region, m/s.
const TOUCHES_MPS: f32 = 1e-3;
/// Opacity of half-planes that do not touch the feasible region.
const FAINT: f32 = 0.35;
/// Distance and length of the strokes of a hatching, panel units.
const HATCH: [f32; 2] = [13.0, 10.0];
/// Length and half the width of an arrow's head, panel units.
const ARROW_HEAD: [f32; 2] = [13.0, 5.0];
/// Distance of names from the frame, panel units.
const NAME_INSET: f32 = 16.0;
/// Radius of the body at the origin, panel units.
const BODY_RADIUS: f32 = 9.0;
/// Number of corners of a disc: it looks like a circle.
const DISC_CORNERS: usize = 96;

/// Width of a panel of a height, pixels.
pub(crate) fn width_px(height_px: u32) -> u32 {
    (height_px as f32 * WIDTH / REFERENCE_HEIGHT).round() as u32
}

/// Picture of a panel, opaque.
pub(crate) fn draw(explained: &ExplainedStep, height_px: u32) -> Pixmap {
    let unit_px = height_px as f32 / REFERENCE_HEIGHT;
    let mut figure = PlotFigure::with_letters([width_px(height_px), height_px], LETTERS * unit_px);
    let start_s = explained.step.frame as f32 * explained.step.header().scenario.dt_s;
    figure.title(&format!("Agent {} at {start_s:.2} s", explained.id(explained.agent).0), unit_px * TITLE);
    let reach = explained.axis_limit_mps;
    let axis = |name: &str| PlotAxis::new(&format!("velocity along {name}, m/s"), [-reach, reach]);
    let panel = figure.panel(AXES.map(|side| unit_px * side), [axis("x"), axis("y")]);
    let region_mps = feasible_region(explained);
    let mut space = VelocitySpace { figure, panel, explained, unit_px, region_mps };
    space.draw_region();
    space.draw_sets();
    space.draw_half_planes();
    space.draw_forces();
    space.draw_body();
    space.draw_velocities();
    space.draw_names();
    let VelocitySpace { mut figure, .. } = space;
    legend::draw(&mut figure, explained, LEGEND.map(|side| unit_px * side), unit_px);
    figure.pixmap
}

/// A panel that is being drawn.
struct VelocitySpace<'a> {
    figure: PlotFigure,
    panel: PlotPanel,
    explained: &'a ExplainedStep<'a>,
    /// Length of a panel unit, pixels.
    unit_px: f32,
    /// Corners of the region that all half-planes permit which did not have to yield, m/s.
    region_mps: Vec<Vec2>,
}

impl VelocitySpace<'_> {
    /// Length of some panel units in the velocity space, m/s.
    fn mps(&self, units: f32) -> f32 {
        units * self.unit_px * 2.0 * self.explained.axis_limit_mps / self.panel.rect_px[2]
    }

    /// A solid line of a width in panel units.
    fn solid(&self, colour: Rgb, width: f32) -> LineStyle {
        LineStyle::solid(colour, width * self.unit_px)
    }

    fn forward(&self) -> Vec2 {
        self.explained.step.world().forward(self.explained.agent)
    }

    fn half_planes(&self) -> impl Iterator<Item = &HalfPlane> {
        self.explained.explanation.half_planes.iter()
    }

    /// Fills the feasible region, and greys the rest.
    fn draw_region(&mut self) {
        if self.explained.planner() == Planner::SocialForce {
            return;
        }
        let has_yielded = self.half_planes().any(|half_plane| self.explained.explanation.has_yielded(half_plane));
        let colour = if has_yielded { RELAXED } else { FEASIBLE };
        let without_outline = LineStyle { opacity: 0.0, ..self.solid(FORBIDDEN, 1.0) };
        self.figure.polygon(&self.panel, square(self.explained.axis_limit_mps), 0.7, without_outline);
        let region_mps = self.region_mps.iter().copied();
        self.figure.polygon(&self.panel, region_mps, 0.9, LineStyle { colour, ..without_outline });
    }

    /// Whether a half-plane's line touches the feasible region.
    fn touches(&self, half_plane: &HalfPlane) -> bool {
        self.region_mps.iter().any(|corner_mps| half_plane.violation_mps(*corner_mps).abs() <= TOUCHES_MPS)
    }

    /// Draws turning set, holding set (the active one stronger), sharp-turn edges and the greatest speed.
    fn draw_sets(&mut self) {
        let hull = self.explained.step.velocity_hull(self.explained.agent);
        let (forward, factor) = (self.forward(), self.explained.step.speed_factor(self.explained.agent));
        let sets = [(VelocitySet::Holding, &hull.holding_mps), (VelocitySet::Turning, &hull.turning_mps)];
        for (set, corners_mps) in sets {
            let source = HalfPlaneSource::from(set);
            let in_force = self.half_planes().any(|half_plane| half_plane.source == source);
            let (fill, width, opacity) = if in_force { (0.10, 3.0, 1.0) } else { (0.03, 1.2, 0.6) };
            let outline = LineStyle { opacity, ..self.solid(source_colour(source), width) };
            self.figure.polygon(
                &self.panel,
                corners_mps.iter().map(|corner| forward.rotate(factor * *corner)),
                fill,
                outline,
            );
        }
        let edge = LineStyle { opacity: 0.7, ..self.solid(SHARP_TURN_EDGES, 1.6) };
        for ends in &hull.sharp_turn_edges_mps {
            self.figure.polyline(&self.panel, ends.map(|end| forward.rotate(factor * end)), edge);
        }
        if let Some(limit_mps) = speed_limit_mps(self.explained) {
            let corners_mps = disc(limit_mps);
            let circle = corners_mps.iter().chain(corners_mps.first()).copied();
            self.figure.polyline(&self.panel, circle, self.solid(INK, 1.5));
        }
    }

    /// Draws the half-planes that are not an edge of a set, with hatching on the forbidden side.
    fn draw_half_planes(&mut self) {
        let explanation = &self.explained.explanation;
        let lines = self.half_planes().filter(|half_plane| !is_hull(half_plane.source));
        for half_plane in lines.copied().collect::<Vec<_>>() {
            let Some([from, to]) = chord(&half_plane, self.explained.axis_limit_mps) else { continue };
            let (binds, is_dashed) = (explanation.binds(&half_plane), explanation.has_yielded(&half_plane));
            let opacity = if binds || is_dashed || self.touches(&half_plane) { 1.0 } else { FAINT };
            let colour = source_colour(half_plane.source);
            let style = LineStyle { opacity, is_dashed, ..self.solid(colour, if binds { 3.2 } else { 1.8 }) };
            self.figure.polyline(&self.panel, [from, to], style);
            let [gap, length] = HATCH.map(|units| self.mps(units));
            let hatch = length * (-half_plane.direction.perp() - half_plane.direction).normalize();
            let count = (from.distance(to) / gap) as usize;
            let starts = (0..=count).map(|index| from + index as f32 * gap * half_plane.direction);
            let hatching = LineStyle { opacity: 0.6 * opacity, ..self.solid(colour, 1.1) };
            self.figure.hatching(&self.panel, starts.map(|start| [start, start + hatch]), hatching);
        }
    }

    /// Draws the social forces.
    fn draw_forces(&mut self) {
        let relaxation_s = self.explained.step.header().scenario.params.social_force.relaxation_s;
        let from = self.explained.step.world().velocities_mps[self.explained.agent];
        for force in &self.explained.explanation.forces {
            let style = self.solid(source_colour(force.source), 2.0);
            self.draw_arrow(from, from + relaxation_s * force.acceleration_mps2, style);
        }
    }

    /// Draws a body from above at the origin, and rays along its facing and its planned facing.
    fn draw_body(&mut self) {
        let (forward, radius) = (self.forward(), self.mps(BODY_RADIUS));
        let length = 2.0 * self.explained.axis_limit_mps;
        let planned = Vec2::from_angle(self.explained.explanation.plan.facing_rad);
        let ray = LineStyle { opacity: 0.45, ..self.solid(INK, 1.2) };
        self.figure.polyline(&self.panel, [Vec2::ZERO, length * forward], ray);
        self.figure.polyline(&self.panel, [Vec2::ZERO, length * planned], LineStyle { is_dashed: true, ..ray });
        let outline = self.solid(palette::look(self.explained.id(self.explained.agent).index()).shirt, 1.5);
        let nose = [Vec2::new(1.7, 0.0), Vec2::new(0.75, 0.65), Vec2::new(0.75, -0.65)];
        self.figure.polygon(&self.panel, nose.map(|corner| forward.rotate(radius * corner)), 1.0, outline);
        self.figure.polygon(&self.panel, disc(radius), 1.0, outline);
    }

    /// Draws v_pref, v_op and v_i as arrows, the actual velocities before and after the step as dots.
    fn draw_velocities(&mut self) {
        let ExplainedStep { step, agent, explanation, .. } = self.explained;
        let world = step.world();
        self.draw_arrow(Vec2::ZERO, world.preferred_mps[*agent], self.solid(PREFERRED, 5.0));
        if self.explained.planner() == Planner::Mcn {
            self.draw_arrow(Vec2::ZERO, explanation.adapted_mps, self.solid(ADAPTED, 3.5));
        }
        self.draw_arrow(Vec2::ZERO, explanation.plan.velocity_mps, self.solid(PLANNED, 2.5));
        let (before_mps, after_mps) = (world.velocities_mps[*agent], step.actual_mps(*agent));
        let dot = |centre: Vec2, radius: f32| disc(radius).into_iter().map(move |corner| centre + corner);
        self.figure.polygon(&self.panel, dot(before_mps, self.mps(4.5)), 0.0, self.solid(ACTUAL, 2.0));
        self.figure.polygon(&self.panel, dot(after_mps, self.mps(4.5)), 1.0, self.solid(ACTUAL, 1.0));
    }

    fn draw_arrow(&mut self, from: Vec2, to: Vec2, style: LineStyle) {
        let [length, half_width] = ARROW_HEAD.map(|units| self.mps(units));
        // A short arrow has no shaft.
        let head = (to - from).clamp_length_max(length);
        let side = half_width / length * head.perp();
        self.figure.polyline(&self.panel, [from, to - 0.8 * head], style);
        let tip = LineStyle { width_px: 1.0, ..style };
        self.figure.polygon(&self.panel, [to, to - head + side, to - head - side], 1.0, tip);
    }

    /// Writes the source of each half-plane where its line meets the frame, and of each force at its arrow's tip.
    fn draw_names(&mut self) {
        let inset = self.explained.axis_limit_mps - self.mps(NAME_INSET);
        let lines = self.half_planes().filter(|half_plane| !is_hull(half_plane.source));
        let mut names: Vec<(Vec2, String)> = lines
            .filter_map(|half_plane| Some((chord(half_plane, inset)?[1], source_name(half_plane.source))))
            .collect();
        let relaxation_s = self.explained.step.header().scenario.params.social_force.relaxation_s;
        let from = self.explained.step.world().velocities_mps[self.explained.agent];
        let forces = self.explained.explanation.forces.iter().filter_map(|force| {
            let arrow = relaxation_s * force.acceleration_mps2;
            let is_visible = arrow.length() > self.mps(ARROW_HEAD[0]);
            is_visible.then(|| (from + arrow.clamp_length_max(inset), source_name(force.source)))
        });
        names.extend(forces);
        let names: Vec<(Vec2, &str)> = names.iter().map(|(at, name)| (*at, name.as_str())).collect();
        self.figure.names(&self.panel, &names);
    }
}

/// Region that all half-planes permit which did not have to yield, within the speed limit or the axes.
fn feasible_region(explained: &ExplainedStep) -> Vec<Vec2> {
    let explanation = &explained.explanation;
    let all_mps = speed_limit_mps(explained).map_or(square(explained.axis_limit_mps), disc);
    let in_force = explanation.half_planes.iter().filter(|half_plane| !explanation.has_yielded(half_plane));
    feasible_region_mps(&all_mps, in_force)
}

/// Greatest speed of any direction, m/s; only the ORCA planner has one.
fn speed_limit_mps(explained: &ExplainedStep) -> Option<f32> {
    let params = &explained.step.header().scenario.params;
    (explained.planner() == Planner::Orca).then_some(params.orca.speed_max_mps)
}

fn is_hull(source: HalfPlaneSource) -> bool {
    matches!(source, HalfPlaneSource::TurningHull | HalfPlaneSource::HoldingHull)
}

/// All velocities on the axes: a square around the origin, counter-clockwise.
fn square(axis_limit_mps: f32) -> Vec<Vec2> {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|corner| axis_limit_mps * Vec2::from(corner)).to_vec()
}

/// A regular polygon around the origin, counter-clockwise.
fn disc(radius_mps: f32) -> Vec<Vec2> {
    let corner = |index: usize| {
        let (sin, cos) = libm::sincosf(std::f32::consts::TAU * index as f32 / DISC_CORNERS as f32);
        radius_mps * Vec2::new(cos, sin)
    };
    (0..DISC_CORNERS).map(corner).collect()
}

/// Ends of a half-plane's line within a square around the origin, in the line's direction; `None` outside.
fn chord(half_plane: &HalfPlane, axis_limit_mps: f32) -> Option<[Vec2; 2]> {
    let HalfPlane { point_mps, direction, .. } = *half_plane;
    let (mut first, mut last) = (f32::NEG_INFINITY, f32::INFINITY);
    for (at, along) in point_mps.to_array().into_iter().zip(direction.to_array()) {
        if along == 0.0 {
            if at.abs() > axis_limit_mps {
                return None;
            }
            continue;
        }
        let [one, other] = [-axis_limit_mps, axis_limit_mps].map(|side| (side - at) / along);
        (first, last) = (first.max(one.min(other)), last.min(one.max(other)));
    }
    (first < last).then(|| [first, last].map(|distance| point_mps + distance * direction))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_at_the_frame() {
        let ends = |point: [f32; 2], outward: [f32; 2]| {
            chord(&HalfPlane::behind(Vec2::from(point), Vec2::from(outward), HalfPlaneSource::Stance), 2.0)
        };
        assert_eq!(ends([1.0, 9.0], [1.0, 0.0]), Some([Vec2::new(1.0, -2.0), Vec2::new(1.0, 2.0)]));
        assert_eq!(ends([3.0, 0.0], [1.0, 0.0]), None);
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let [from, to] = ends([1.0, 1.0], [half, half]).unwrap();
        assert!(from.distance(Vec2::new(2.0, 0.0)) < 1e-5 && to.distance(Vec2::new(0.0, 2.0)) < 1e-5);
    }
}
