//! The velocity space of one agent in one step (the paper's Figs. 3 to 5): what its database, its stance foot, walls
//! and others permit, what it wanted, what was planned, and what the body then did.
//!
//! World axes, m/s, standing in the middle, so that directions are those of the scene beside it. A half-plane is a line
//! with hatching on its forbidden side; thick where the planned velocity lies on it, dashed where it had to yield. What
//! none of the others forbids is pale green, pale orange where some yielded. Social forces have no half-planes: their
//! pushes are arrows from the present velocity, as long as the velocity that they would add in the relaxation time, so
//! that the driving force, drawn alike, would end at v_pref.

use fbcrowd_sim::planning::orca::{HalfPlane, HalfPlaneSource};
use fbcrowd_sim::planning::{Planner, VelocitySet};
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::constraints::feasible_region::permitted_mps;
use crate::constraints::legend;
use crate::constraints::overlay_constraints::Planned;
use crate::plots::chart::axis::Axis;
use crate::plots::chart::plot::{Figure, Line, Panel, line};
use crate::plots::database::velocity_space::{HOLDING, SHARP_TURN, TURNING};
use crate::raster::palette::{self, INK, OBSTACLE_RIM, Rgb, line_colour};

/// Height for which all sizes here are told, pixels; other panels in proportion.
const DESIGN_HEIGHT_PX: f32 = 720.0;
const DESIGN_WIDTH_PX: f32 = 940.0;
/// Letters, as a multiple of the plots' usual ones.
const LETTERS: f32 = 0.62;
/// Left end of the title's baseline.
const TITLE_PX: Vec2 = Vec2::new(66.0, 36.0);
/// Left, top, width, height of the axes.
const PLOT_PX: [f32; 4] = [66.0, 80.0, 578.0, 578.0];
/// Upper left corner and width of legend and numbers.
const KEY_PX: [f32; 3] = [666.0, 80.0, 256.0];

/// v_pref: a grey.
pub(crate) const PREFERRED: Rgb = Rgb::new(0.50, 0.50, 0.53);
/// v_op: a teal.
pub(crate) const ADAPTED: Rgb = Rgb::new(0.00, 0.52, 0.58);
/// What was planned.
pub(crate) const PLANNED: Rgb = INK;
/// What was walked: a green.
pub(crate) const WALKED: Rgb = Rgb::new(0.22, 0.64, 0.26);
/// The stance foot: a magenta.
pub(crate) const STANCE: Rgb = Rgb::new(0.76, 0.08, 0.56);
/// What nobody forbids; where some had to yield; the rest.
const PERMITTED: [Rgb; 2] = [Rgb::new(0.74, 0.91, 0.70), Rgb::new(0.99, 0.85, 0.62)];
const FORBIDDEN: Rgb = Rgb::new(0.945, 0.943, 0.94);

/// Half-planes this near to what is permitted bound it, m/s.
const FELT_MPS: f32 = 1e-3;
/// Opacity of the others.
const FAINT: f32 = 0.35;
/// Hatching: distance and length of its strokes.
const HATCH_PX: [f32; 2] = [13.0, 10.0];
/// Length and half the width of an arrow's head.
const HEAD_PX: [f32; 2] = [13.0, 5.0];
/// A name stands so far inside the frame.
const NAME_INSIDE_PX: f32 = 16.0;
/// Radius of the body in the middle.
const BODY_PX: f32 = 9.0;
/// Corners of a disc that cannot be told from a circle.
const DISC_CORNERS: usize = 96;

/// Width of a panel beside a scene of some height, pixels.
pub(crate) fn width_px(height_px: u32) -> u32 {
    (height_px as f32 * DESIGN_WIDTH_PX / DESIGN_HEIGHT_PX).round() as u32
}

/// The panel, opaque.
pub(crate) fn draw(planned: &Planned, height_px: u32) -> Pixmap {
    let unit_px = height_px as f32 / DESIGN_HEIGHT_PX;
    let mut figure = Figure::with_letters(width_px(height_px), height_px, LETTERS * unit_px);
    let begins_s = planned.step.frame as f32 * planned.step.header().scenario.dt_s;
    figure.title(&format!("Agent {} at {begins_s:.2} s", planned.agent), unit_px * TITLE_PX);
    let reach = planned.reach_mps;
    let axis = |name: &str| Axis { label: format!("velocity along {name}, m/s"), low: -reach, high: reach };
    let panel = figure.panel(PLOT_PX.map(|place| unit_px * place), [axis("x"), axis("y")]);
    let permitted_mps = permitted(planned);
    let mut space = VelocitySpace { figure, panel, planned, unit_px, permitted_mps };
    space.draw_permitted();
    space.draw_sets();
    space.draw_half_planes();
    space.draw_pushes();
    space.draw_body();
    space.draw_velocities();
    space.draw_names();
    let VelocitySpace { mut figure, .. } = space;
    legend::draw(&mut figure, planned, KEY_PX.map(|place| unit_px * place), unit_px);
    figure.pixmap
}

/// The colour of whatever limits or pushes.
pub(crate) fn colour(source: HalfPlaneSource) -> Rgb {
    match source {
        HalfPlaneSource::Obstacle(_) => OBSTACLE_RIM,
        HalfPlaneSource::Stance => STANCE,
        HalfPlaneSource::SharpTurn => SHARP_TURN,
        HalfPlaneSource::TurningHull => TURNING,
        HalfPlaneSource::HoldingHull => HOLDING,
        HalfPlaneSource::Agent(agent) => line_colour(agent as usize),
    }
}

/// A panel in the making.
struct VelocitySpace<'a> {
    figure: Figure,
    panel: Panel,
    planned: &'a Planned<'a>,
    unit_px: f32,
    /// Corners of what is left by all that did not yield.
    permitted_mps: Vec<Vec2>,
}

impl VelocitySpace<'_> {
    /// So many m/s are a pixel of the design.
    fn mps(&self, design_px: f32) -> f32 {
        design_px * self.unit_px * 2.0 * self.planned.reach_mps / self.panel.rect_px[2]
    }

    fn line(&self, colour: Rgb, design_px: f32) -> Line {
        line(colour, design_px * self.unit_px)
    }

    fn forward(&self) -> Vec2 {
        self.planned.step.world().forward(self.planned.agent)
    }

    fn half_planes(&self) -> impl Iterator<Item = &HalfPlane> {
        self.planned.reasons.half_planes.iter()
    }

    /// The rest is greyed.
    fn draw_permitted(&mut self) {
        if self.planned.planner() == Planner::SocialForce {
            return;
        }
        let some_yielded = self.half_planes().any(|half_plane| self.planned.reasons.has_yielded(half_plane));
        let fill = PERMITTED[usize::from(some_yielded)];
        let unseen = Line { opacity: 0.0, ..self.line(FORBIDDEN, 1.0) };
        self.figure.polygon(&self.panel, square(self.planned.reach_mps), 0.7, unseen);
        self.figure.polygon(&self.panel, self.permitted_mps.iter().copied(), 0.9, Line { colour: fill, ..unseen });
    }

    /// Whether a half-plane's line runs along what is permitted.
    fn is_felt(&self, half_plane: &HalfPlane) -> bool {
        self.permitted_mps.iter().any(|corner_mps| half_plane.violation_mps(*corner_mps).abs() <= FELT_MPS)
    }

    /// Turning set, holding set and sharp-turn edges, the one in force stronger.
    fn draw_sets(&mut self) {
        let hull = &self.planned.step.header().velocity_hull;
        let forward = self.forward();
        let sets = [(VelocitySet::Holding, &hull.holding_mps), (VelocitySet::Turning, &hull.turning_mps)];
        for (set, corners_mps) in sets {
            let source = HalfPlaneSource::from(set);
            let in_force = self.half_planes().any(|half_plane| half_plane.source == source);
            let (fill, width_px, opacity) = if in_force { (0.10, 3.0, 1.0) } else { (0.03, 1.2, 0.6) };
            let outline = Line { opacity, ..self.line(colour(source), width_px) };
            self.figure.polygon(&self.panel, corners_mps.iter().map(|corner| forward.rotate(*corner)), fill, outline);
        }
        let edge = Line { opacity: 0.7, ..self.line(SHARP_TURN, 1.6) };
        for ends in &hull.sharp_turn_edges_mps {
            self.figure.polyline(&self.panel, ends.map(|end| forward.rotate(end)), edge);
        }
        if let Some(limit_mps) = speed_limit_mps(self.planned) {
            let corners_mps = disc(limit_mps);
            let circle = corners_mps.iter().chain(corners_mps.first()).copied();
            self.figure.polyline(&self.panel, circle, self.line(INK, 1.5));
        }
    }

    /// Every line that is no edge of a set, with hatching beyond it.
    fn draw_half_planes(&mut self) {
        let reasons = &self.planned.reasons;
        let lines = self.half_planes().filter(|half_plane| !is_hull(half_plane.source));
        for half_plane in lines.copied().collect::<Vec<_>>() {
            let Some([from, to]) = chord(&half_plane, self.planned.reach_mps) else { continue };
            let (binds, dashed) = (reasons.binds(&half_plane), reasons.has_yielded(&half_plane));
            let opacity = if binds || dashed || self.is_felt(&half_plane) { 1.0 } else { FAINT };
            let stroke = Line { opacity, ..self.line(colour(half_plane.source), if binds { 3.2 } else { 1.8 }) };
            self.figure.polyline(&self.panel, [from, to], Line { dashed, ..stroke });
            let [gap, length] = HATCH_PX.map(|design_px| self.mps(design_px));
            let beyond = length * (-half_plane.direction.perp() - half_plane.direction).normalize();
            let count = (from.distance(to) / gap) as usize;
            let feet = (0..=count).map(|index| from + index as f32 * gap * half_plane.direction);
            let hatching = Line { opacity: 0.6 * opacity, ..self.line(stroke.colour, 1.1) };
            self.figure.hatching(&self.panel, feet.map(|foot| [foot, foot + beyond]), hatching);
        }
    }

    /// Social forces.
    fn draw_pushes(&mut self) {
        let relaxation_s = self.planned.step.header().scenario.params.social_force.relaxation_s;
        let from = self.planned.step.world().velocities_mps[self.planned.agent];
        for force in &self.planned.reasons.forces {
            let push = self.line(colour(force.source), 2.0);
            self.draw_arrow(from, from + relaxation_s * force.acceleration_mps2, push);
        }
    }

    /// A body from above, and rays along its facing and the facing that was planned.
    fn draw_body(&mut self) {
        let (forward, radius) = (self.forward(), self.mps(BODY_PX));
        let reach = 2.0 * self.planned.reach_mps;
        let planned = Vec2::from_angle(self.planned.reasons.plan.facing_rad);
        let ray = Line { opacity: 0.45, ..self.line(INK, 1.2) };
        self.figure.polyline(&self.panel, [Vec2::ZERO, reach * forward], ray);
        self.figure.polyline(&self.panel, [Vec2::ZERO, reach * planned], Line { dashed: true, ..ray });
        let outline = self.line(palette::look(self.planned.agent).shirt, 1.5);
        let nose = [Vec2::new(1.7, 0.0), Vec2::new(0.75, 0.65), Vec2::new(0.75, -0.65)];
        self.figure.polygon(&self.panel, nose.map(|corner| forward.rotate(radius * corner)), 1.0, outline);
        self.figure.polygon(&self.panel, disc(radius), 1.0, outline);
    }

    /// v_pref, v_op, v, what was walked before and then.
    fn draw_velocities(&mut self) {
        let Planned { step, agent, reasons, .. } = self.planned;
        let (world, stop) = (step.world(), Vec2::ZERO);
        self.draw_arrow(stop, world.preferred_mps[*agent], self.line(PREFERRED, 5.0));
        if self.planned.planner() == Planner::Mcn {
            self.draw_arrow(stop, reasons.adapted_mps, self.line(ADAPTED, 3.5));
        }
        self.draw_arrow(stop, reasons.plan.velocity_mps, self.line(PLANNED, 2.5));
        let (before_mps, walked_mps) = (world.velocities_mps[*agent], step.actual_mps(*agent));
        let dot = |centre: Vec2, radius: f32| disc(radius).into_iter().map(move |corner| centre + corner);
        self.figure.polygon(&self.panel, dot(before_mps, self.mps(4.5)), 0.0, self.line(WALKED, 2.0));
        self.figure.polygon(&self.panel, dot(walked_mps, self.mps(4.5)), 1.0, self.line(WALKED, 1.0));
    }

    fn draw_arrow(&mut self, from: Vec2, to: Vec2, stroke: Line) {
        let [length, half_width] = HEAD_PX.map(|design_px| self.mps(design_px));
        // A short arrow is all head.
        let head = (to - from).clamp_length_max(length);
        let side = half_width / length * head.perp();
        self.figure.polyline(&self.panel, [from, to - 0.8 * head], stroke);
        let tip = Line { width_px: 1.0, ..stroke };
        self.figure.polygon(&self.panel, [to, to - head + side, to - head - side], 1.0, tip);
    }

    /// Who or what each line stands for, where it leaves the frame.
    fn draw_names(&mut self) {
        let inside = self.planned.reach_mps - self.mps(NAME_INSIDE_PX);
        let named = self.half_planes().filter(|half_plane| !is_hull(half_plane.source));
        let mut names: Vec<(Vec2, String)> =
            named.filter_map(|half_plane| Some((chord(half_plane, inside)?[1], name(half_plane.source)))).collect();
        let relaxation_s = self.planned.step.header().scenario.params.social_force.relaxation_s;
        let from = self.planned.step.world().velocities_mps[self.planned.agent];
        let pushes = self.planned.reasons.forces.iter().filter_map(|force| {
            let push = relaxation_s * force.acceleration_mps2;
            (push.length() > self.mps(HEAD_PX[0])).then(|| (from + push.clamp_length_max(inside), name(force.source)))
        });
        names.extend(pushes);
        let names: Vec<(Vec2, &str)> = names.iter().map(|(at, name)| (*at, name.as_str())).collect();
        self.figure.names(&self.panel, &names);
    }
}

/// What all half-planes that did not yield permit.
fn permitted(planned: &Planned) -> Vec<Vec2> {
    let reasons = &planned.reasons;
    let all_mps = speed_limit_mps(planned).map_or(square(planned.reach_mps), disc);
    permitted_mps(&all_mps, reasons.half_planes.iter().filter(|half_plane| !reasons.has_yielded(half_plane)))
}

/// Plain ORCA's body is a disc of speeds.
fn speed_limit_mps(planned: &Planned) -> Option<f32> {
    let params = &planned.step.header().scenario.params;
    (planned.planner() == Planner::Orca).then_some(params.orca.speed_max_mps)
}

/// What a reader calls it.
pub(crate) fn name(source: HalfPlaneSource) -> String {
    match source {
        HalfPlaneSource::Obstacle(_) => "wall".to_owned(),
        HalfPlaneSource::Stance => "stance foot".to_owned(),
        HalfPlaneSource::SharpTurn => "sharp turn".to_owned(),
        HalfPlaneSource::TurningHull => "turning set".to_owned(),
        HalfPlaneSource::HoldingHull => "holding set".to_owned(),
        HalfPlaneSource::Agent(agent) => agent.to_string(),
    }
}

fn is_hull(source: HalfPlaneSource) -> bool {
    matches!(source, HalfPlaneSource::TurningHull | HalfPlaneSource::HoldingHull)
}

/// All that is shown, counter-clockwise.
fn square(reach_mps: f32) -> Vec<Vec2> {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|corner| reach_mps * Vec2::from(corner)).to_vec()
}

/// A regular polygon about standing, counter-clockwise.
fn disc(radius_mps: f32) -> Vec<Vec2> {
    let corner = |index: usize| {
        let (sin, cos) = libm::sincosf(std::f32::consts::TAU * index as f32 / DISC_CORNERS as f32);
        radius_mps * Vec2::new(cos, sin)
    };
    (0..DISC_CORNERS).map(corner).collect()
}

/// The stretch of a half-plane's line within a square about standing, in the line's direction.
fn chord(half_plane: &HalfPlane, reach_mps: f32) -> Option<[Vec2; 2]> {
    let HalfPlane { point_mps, direction, .. } = *half_plane;
    let (mut first, mut last) = (f32::NEG_INFINITY, f32::INFINITY);
    for (at, along) in point_mps.to_array().into_iter().zip(direction.to_array()) {
        if along == 0.0 {
            if at.abs() > reach_mps {
                return None;
            }
            continue;
        }
        let [one, other] = [-reach_mps, reach_mps].map(|side| (side - at) / along);
        (first, last) = (first.max(one.min(other)), last.min(one.max(other)));
    }
    (first < last).then(|| [first, last].map(|place| point_mps + place * direction))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_shown_from_frame_to_frame_and_not_at_all_outside() {
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
