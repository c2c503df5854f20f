//! What the constraint overlay marks in the scene: the agent, whom and which walls it took into account, and the foot
//! that it stands on with the line that the swing foot must not land beyond (the paper's Fig. 4).
//!
//! Links go to neighbours in their colours, thick where the planned velocity is bound by them, dashed where their
//! half-plane had to yield. All is drawn where it was when the step began; world metres.

use fbcrowd_sim::planning::mcn::{StanceForm, stance_half_plane};
use fbcrowd_sim::planning::orca::HalfPlaneSource;
use fbcrowd_sim::planning::{Planner, Stance, StanceFoot};
use glam::Vec2;
use tiny_skia::{LineCap, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

use crate::constraints::overlay_constraints::Planned;
use crate::constraints::velocity_panel::{STANCE, colour};
use crate::raster::palette::{INK, PAPER, Rgb, line_colour};
use crate::top_view::framing::Framing;
use crate::top_view::ground::paint;
use crate::top_view::overlay::Overlay;

/// Widths in a picture of 720 lines, pixels; others in proportion.
const LINK_PX: f32 = 1.6;
const BINDING_PX: f32 = 3.4;
const RING_PX: f32 = 2.6;
/// The agent's own disc has a second ring so far outside, m.
const RING_GAP_M: f32 = 0.08;
/// What a pale rim adds on both sides, so that marks stand out from bodies.
const RIM_PX: f32 = 1.6;
/// Half the length of the line along the stance foot, and the length of its hatching, m.
const STANCE_LINE_M: f32 = 0.45;
const STANCE_HATCH_M: f32 = 0.09;
/// Strokes of that hatching.
const STANCE_HATCHES: usize = 9;

/// Pens and letters for one framing.
#[derive(Clone, Debug)]
pub(crate) struct SceneMarks {
    framing: Framing,
    overlay: Overlay,
    unit_px: f32,
}

/// How a mark is drawn.
#[derive(Clone, Copy)]
struct Pen {
    colour: Rgb,
    /// In a picture of 720 lines.
    width_px: f32,
    dashed: bool,
}

impl SceneMarks {
    pub(crate) fn new(framing: &Framing) -> Self {
        let unit_px = (framing.height_px as f32 / 720.0).max(0.5);
        Self { framing: *framing, overlay: Overlay::new(framing), unit_px }
    }

    /// Draws all marks of one agent over a scene.
    pub(crate) fn draw(&self, scene: &mut Pixmap, planned: &Planned) {
        let world = planned.step.world();
        let (centre_m, radius_m) = (world.positions_m[planned.agent], world.radii_m[planned.agent]);
        self.draw_walls(scene, planned);
        self.draw_links(scene, planned);
        let own = Pen { colour: line_colour(planned.agent), width_px: LINK_PX, dashed: false };
        self.draw_circle(scene, centre_m, radius_m, own);
        self.draw_circle(scene, centre_m, radius_m + RING_GAP_M, Pen { colour: INK, width_px: RING_PX, ..own });
        if let Some(foot) = &world.stances[planned.agent].foot {
            self.draw_stance(scene, centre_m, foot, planned);
        }
        if !planned.step.header().scenario.view.labels {
            let neighbours = planned.reasons.neighbours.iter().map(|neighbour| neighbour.agent as usize);
            for index in neighbours.chain([planned.agent]) {
                self.overlay.draw_label(scene, index, world.positions_m[index]);
            }
        }
    }

    /// The edges that gave half-planes or pushed.
    fn draw_walls(&self, scene: &mut Pixmap, planned: &Planned) {
        let of_half_planes = planned.reasons.half_planes.iter().map(|half_plane| half_plane.source);
        let of_forces = planned.reasons.forces.iter().map(|force| force.source);
        for source in of_half_planes.chain(of_forces) {
            if let HalfPlaneSource::Obstacle(edge) = source {
                let pen = Pen { colour: INK, ..pen(planned, source) };
                self.draw_lines(scene, &[planned.step.world().obstacles.ends_m(edge)], pen);
            }
        }
    }

    /// Lines to all neighbours taken, from disc to disc.
    fn draw_links(&self, scene: &mut Pixmap, planned: &Planned) {
        let world = planned.step.world();
        let (from_m, radius_m) = (world.positions_m[planned.agent], world.radii_m[planned.agent]);
        for neighbour in &planned.reasons.neighbours {
            let other = neighbour.agent as usize;
            let way = neighbour.offset_m.normalize_or_zero();
            let ends_m = [from_m + radius_m * way, world.positions_m[other] - world.radii_m[other] * way];
            let pen = pen(planned, HalfPlaneSource::Agent(neighbour.agent));
            self.draw_circle(scene, world.positions_m[other], world.radii_m[other], pen);
            if neighbour.distance_m > neighbour.radius_m {
                self.draw_lines(scene, &[ends_m], pen);
            }
        }
    }

    /// The sole from heel over ball to toe and, where the planner heeds it, the line beyond which the swing foot must
    /// not land.
    fn draw_stance(&self, scene: &mut Pixmap, centre_m: Vec2, foot: &StanceFoot, planned: &Planned) {
        let sole_m =
            [[foot.heel_m, foot.ball_m], [foot.ball_m, foot.toe_m]].map(|ends_m| ends_m.map(|end_m| centre_m + end_m));
        self.draw_lines(scene, &sole_m, Pen { colour: STANCE, width_px: 2.0 * RING_PX, dashed: false });
        let params = &planned.step.header().scenario.params.planner;
        if planned.planner() != Planner::Mcn || params.parts.stance != StanceForm::Landing {
            return;
        }
        let stance = Stance { foot: Some(*foot) };
        if let Some(half_plane) = stance_half_plane(&stance, params.stance_twist_rad) {
            let lines_m = hatched_line_m(centre_m + foot.ball_m, half_plane.direction);
            self.draw_lines(scene, &lines_m, pen(planned, HalfPlaneSource::Stance));
        }
    }

    fn draw_circle(&self, scene: &mut Pixmap, centre_m: Vec2, radius_m: f32, pen: Pen) {
        let centre = self.framing.to_px(centre_m);
        let mut path = PathBuilder::new();
        path.push_circle(centre.x, centre.y, radius_m * self.framing.scale_px_m);
        self.stroke(scene, path, pen);
    }

    fn draw_lines(&self, scene: &mut Pixmap, lines_m: &[[Vec2; 2]], pen: Pen) {
        let mut path = PathBuilder::new();
        for [from, to] in lines_m.iter().map(|ends_m| ends_m.map(|end_m| self.framing.to_px(end_m))) {
            path.move_to(from.x, from.y);
            path.line_to(to.x, to.y);
        }
        self.stroke(scene, path, pen);
    }

    /// With a pale rim below.
    fn stroke(&self, scene: &mut Pixmap, path: PathBuilder, pen: Pen) {
        let Some(path) = path.finish() else { return };
        let width = self.unit_px * pen.width_px;
        let dash = pen.dashed.then(|| StrokeDash::new(vec![4.0 * width, 3.0 * width], 0.0)).flatten();
        let rim = self.unit_px * RIM_PX;
        for (width, colour, opacity) in [(width + rim, PAPER, 0.6), (width, pen.colour, 1.0)] {
            let stroke = Stroke { width, dash: dash.clone(), line_cap: LineCap::Round, ..Stroke::default() };
            scene.stroke_path(&path, &paint(colour, opacity), &stroke, Transform::identity(), None);
        }
    }
}

/// A line about a point and, where its direction has its right, hatching.
fn hatched_line_m(middle_m: Vec2, direction: Vec2) -> Vec<[Vec2; 2]> {
    let beyond_m = STANCE_HATCH_M * (-direction.perp() - direction).normalize_or_zero();
    let along_m = STANCE_LINE_M * direction;
    let hatches_m = (0..STANCE_HATCHES).map(|index| {
        let share = 2.0 * index as f32 / (STANCE_HATCHES - 1) as f32 - 1.0;
        let foot_m = middle_m + share * along_m;
        [foot_m, foot_m + beyond_m]
    });
    hatches_m.chain([[middle_m - along_m, middle_m + along_m]]).collect()
}

/// Thick where it binds, dashed where it had to yield.
fn pen(planned: &Planned, source: HalfPlaneSource) -> Pen {
    let of_source = || planned.reasons.half_planes.iter().filter(move |half_plane| half_plane.source == source);
    let binds = of_source().any(|half_plane| planned.reasons.binds(half_plane));
    let dashed = of_source().any(|half_plane| planned.reasons.has_yielded(half_plane));
    Pen { colour: colour(source), width_px: if binds { BINDING_PX } else { LINK_PX }, dashed }
}
