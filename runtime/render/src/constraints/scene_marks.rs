//! Marks of one agent's constraints in the scene (`FbCrowd` Fig. 4): its disc, the dashed disc that walls hold, links to
//! its neighbours, walls, and its stance foot with the line that the swing foot must not cross.
//!
//! Links and walls are thick if they bind the planned velocity, dashed if their half-plane had to yield. Everything is
//! at its position at the start of the step. World, metres.

use fbcrowd_sim::planning::mcn::{StanceForm, stance_half_plane};
use fbcrowd_sim::planning::orca::HalfPlaneSource;
use fbcrowd_sim::planning::{Planner, Stance, StanceFoot};
use glam::Vec2;
use tiny_skia::{LineCap, Path, Pixmap, Stroke};

use crate::constraints::constraint_style::{STANCE, source_colour};
use crate::constraints::explained_step::ExplainedStep;
use crate::raster::paint::{circle, dashes, paint, path_of_lines, stroke};
use crate::raster::palette::{INK, OBSTACLE_RIM, PAPER, Rgb, line_colour};
use crate::top_view::captions::Captions;
use crate::top_view::framing::Framing;

/// Height of the reference picture, pixels; line widths in other pictures are in proportion.
const REFERENCE_HEIGHT_PX: f32 = 720.0;
/// Width of links and circles in the reference picture, pixels.
const LINK_PX: f32 = 1.6;
/// Width of links and circles that bind, in the reference picture, pixels.
const BINDING_PX: f32 = 3.4;
/// Width of the agent's outer ring in the reference picture, pixels.
const RING_PX: f32 = 2.6;
/// Distance of the agent's outer ring from its disc, m.
const RING_GAP_M: f32 = 0.08;
/// Additional width of the pale rim below each mark, in the reference picture, pixels: marks stand out from bodies.
const RIM_PX: f32 = 1.6;
/// Half the length of the line along the stance foot, m.
const STANCE_LINE_M: f32 = 0.45;
/// Length of that line's hatching, m.
const STANCE_HATCH_M: f32 = 0.09;
/// Number of strokes of that hatching.
const STANCE_HATCHES: usize = 9;

/// Draws marks in the scenes of one sequence.
#[derive(Clone, Debug)]
pub(crate) struct SceneMarks {
    framing: Framing,
    captions: Captions,
    /// Length of a pixel of the reference picture, pixels.
    unit_px: f32,
}

/// Style of a mark.
#[derive(Clone, Copy)]
struct MarkPen {
    colour: Rgb,
    /// Width in the reference picture, pixels.
    width_px: f32,
    is_dashed: bool,
}

impl SceneMarks {
    /// Marks for scenes of one framing.
    pub(crate) fn new(framing: &Framing) -> Self {
        let unit_px = (framing.height_px as f32 / REFERENCE_HEIGHT_PX).max(0.5);
        Self { framing: *framing, captions: Captions::new(framing), unit_px }
    }

    /// Draws all marks of one agent over a scene.
    pub(crate) fn draw(&self, scene: &mut Pixmap, explained: &ExplainedStep) {
        let world = explained.step.world();
        let (centre_m, radius_m) = (world.positions_m[explained.agent], world.radii_m[explained.agent]);
        self.draw_walls(scene, explained);
        self.draw_links(scene, explained);
        let own =
            MarkPen { colour: line_colour(explained.id(explained.agent).index()), width_px: LINK_PX, is_dashed: false };
        self.draw_circle(scene, centre_m, radius_m, own);
        let at_walls = MarkPen { colour: OBSTACLE_RIM, is_dashed: true, ..own };
        self.draw_circle(scene, centre_m, world.wall_radii_m[explained.agent], at_walls);
        self.draw_circle(scene, centre_m, radius_m + RING_GAP_M, MarkPen { colour: INK, width_px: RING_PX, ..own });
        if let Some(foot) = &world.stances[explained.agent].foot {
            self.draw_stance(scene, centre_m, foot, explained);
        }
        if !explained.step.header().scenario.view.labels {
            let neighbours = explained.explanation.neighbours.iter().map(|neighbour| neighbour.agent as usize);
            for index in neighbours.chain([explained.agent]) {
                self.captions.draw_label(scene, 0, explained.id(index), world.positions_m[index]);
            }
        }
    }

    /// Draws the obstacle edges that gave half-planes or forces.
    fn draw_walls(&self, scene: &mut Pixmap, explained: &ExplainedStep) {
        let of_half_planes = explained.explanation.half_planes.iter().map(|half_plane| half_plane.source);
        let of_forces = explained.explanation.forces.iter().map(|force| force.source);
        for source in of_half_planes.chain(of_forces) {
            if let HalfPlaneSource::Obstacle(edge) = source {
                let pen = MarkPen { colour: INK, ..pen(explained, source) };
                self.draw_lines(scene, &[explained.step.world().walls_of(explained.agent).ends_m(edge)], pen);
            }
        }
    }

    /// Draws the discs of all neighbours that were taken into account, and a line to each, from disc to disc.
    fn draw_links(&self, scene: &mut Pixmap, explained: &ExplainedStep) {
        let world = explained.step.world();
        let (from_m, radius_m) = (world.positions_m[explained.agent], world.radii_m[explained.agent]);
        for neighbour in &explained.explanation.neighbours {
            let other = neighbour.agent as usize;
            let direction = neighbour.offset_m.normalize_or_zero();
            let ends_m = [from_m + radius_m * direction, world.positions_m[other] - world.radii_m[other] * direction];
            let pen = pen(explained, HalfPlaneSource::Agent(explained.id(other).0));
            self.draw_circle(scene, world.positions_m[other], world.radii_m[other], pen);
            if neighbour.distance_m > neighbour.radius_m {
                self.draw_lines(scene, &[ends_m], pen);
            }
        }
    }

    /// Draws the stance foot's sole from heel over ball to toe and, if the planner obeys it, the line that the swing
    /// foot must not cross.
    fn draw_stance(&self, scene: &mut Pixmap, centre_m: Vec2, foot: &StanceFoot, explained: &ExplainedStep) {
        let sole_m =
            [[foot.heel_m, foot.ball_m], [foot.ball_m, foot.toe_m]].map(|ends_m| ends_m.map(|end_m| centre_m + end_m));
        self.draw_lines(scene, &sole_m, MarkPen { colour: STANCE, width_px: 2.0 * RING_PX, is_dashed: false });
        let params = &explained.step.header().scenario.params.planner;
        if explained.planner() != Planner::Mcn || params.parts.stance != StanceForm::Landing {
            return;
        }
        let stance = Stance { foot: Some(*foot) };
        if let Some(half_plane) = stance_half_plane(&stance, params.stance_twist_rad) {
            let lines_m = hatched_line_m(centre_m + foot.ball_m, half_plane.direction);
            self.draw_lines(scene, &lines_m, pen(explained, HalfPlaneSource::Stance));
        }
    }

    fn draw_circle(&self, scene: &mut Pixmap, centre_m: Vec2, radius_m: f32, pen: MarkPen) {
        let path = circle(self.framing.to_px(centre_m), radius_m * self.framing.scale_px_m);
        self.stroke(scene, path.as_ref(), pen);
    }

    fn draw_lines(&self, scene: &mut Pixmap, lines_m: &[[Vec2; 2]], pen: MarkPen) {
        let path = path_of_lines(lines_m.iter().map(|ends_m| ends_m.map(|end_m| self.framing.to_px(end_m))));
        self.stroke(scene, path.as_ref(), pen);
    }

    /// Strokes a path over its pale rim.
    fn stroke(&self, scene: &mut Pixmap, path: Option<&Path>, pen: MarkPen) {
        let Some(path) = path else { return };
        let width = self.unit_px * pen.width_px;
        let dash = pen.is_dashed.then(|| dashes(width)).flatten();
        let rim = self.unit_px * RIM_PX;
        for (width, colour, opacity) in [(width + rim, PAPER, 0.6), (width, pen.colour, 1.0)] {
            let pen = Stroke { width, dash: dash.clone(), line_cap: LineCap::Round, ..Stroke::default() };
            stroke(scene, path, &paint(colour, opacity), &pen, None);
        }
    }
}

/// A line centred at a point, with hatching to the right of its direction.
fn hatched_line_m(middle_m: Vec2, direction: Vec2) -> Vec<[Vec2; 2]> {
    let hatch_m = STANCE_HATCH_M * (-direction.perp() - direction).normalize_or_zero();
    let along_m = STANCE_LINE_M * direction;
    let hatches_m = (0..STANCE_HATCHES).map(|index| {
        let share = 2.0 * index as f32 / (STANCE_HATCHES - 1) as f32 - 1.0;
        let start_m = middle_m + share * along_m;
        [start_m, start_m + hatch_m]
    });
    hatches_m.chain([[middle_m - along_m, middle_m + along_m]]).collect()
}

/// Style of the mark of a source: thick if a half-plane of it binds, dashed if one had to yield.
fn pen(explained: &ExplainedStep, source: HalfPlaneSource) -> MarkPen {
    let explanation = &explained.explanation;
    let of_source = || explanation.half_planes.iter().filter(move |half_plane| half_plane.source == source);
    let binds = of_source().any(|half_plane| explanation.binds(half_plane));
    let is_dashed = of_source().any(|half_plane| explanation.has_yielded(half_plane));
    MarkPen { colour: source_colour(source), width_px: if binds { BINDING_PX } else { LINK_PX }, is_dashed }
}
