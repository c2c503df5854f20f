//! The overlay picture: the scene at the left, one velocity panel per agent at the right (`FbCrowd` Figs. 3–5).
//!
//! A picture shows the step that begins at its frame; the last frame shows the last step. The step is planned again
//! from the recording alone ([`Replay`]).

use fbcrowd_sim::AgentId;
use fbcrowd_sim::recording::{Recording, Replay};
use tiny_skia::{Pixmap, PixmapPaint, Transform};

use crate::constraints::explained_step::ExplainedStep;
use crate::constraints::scene_marks::SceneMarks;
use crate::constraints::velocity_panel;
use crate::error::RenderError;
use crate::raster::paint::to_color;
use crate::raster::palette::PAPER;
use crate::raster::pixels::MAX_SIDE_PX;
use crate::top_view::framing::Framing;

/// Tolerance of a frame time, in steps: a picture up to this much before a step shows that step.
const STEP_TOLERANCE_STEPS: f64 = 1e-3;
/// Minimum height of a panel, px, also if the scene is smaller.
const MIN_HEIGHT_PX: u32 = 540;

/// Draws the overlay of one recording.
///
/// ```no_run
/// use std::path::Path;
///
/// use fbcrowd_render::top_view::{read_tracks, sample};
/// use fbcrowd_render::{ConstraintOverlay, RenderError, TopView, png_frame};
/// use fbcrowd_sim::Recording;
///
/// fn main() -> Result<(), RenderError> {
///     let recording = Recording::open(Path::new("crossing.fbrec"))?;
///     let tracks = read_tracks(&recording)?;
///     let top_view = TopView::new(recording.header(), &tracks)?.with_doors(recording.population());
///     let overlay = ConstraintOverlay::new(&recording, top_view.framing(), &[0, 1])?;
///     let agents = sample(&recording, 2.0)?;
///     let mut buffers = top_view.buffers();
///     let picture = overlay.draw(top_view.draw(&mut buffers, 2.0, &agents), 2.0)?;
///     png_frame::write(Path::new("constraints.png"), &picture)
/// }
/// ```
#[derive(Debug)]
pub struct ConstraintOverlay<'a> {
    replay: Replay<'a>,
    /// The agents, in the order of their panels.
    agents: Vec<AgentId>,
    marks: SceneMarks,
    /// Width and height of the scene, pixels.
    scene_px: [u32; 2],
}

impl<'a> ConstraintOverlay<'a> {
    /// The overlay of some agents, given by id; their panels are in this order.
    ///
    /// # Errors
    /// If an agent does not exist, no step was recorded, or the panels are too many for one picture.
    pub fn new(recording: &'a Recording, framing: &Framing, agents: &[usize]) -> Result<Self, RenderError> {
        let replay = Replay::new(recording);
        let count = recording.population().agents.len();
        if let Some(&agent) = agents.iter().find(|agent| **agent >= count) {
            return Err(RenderError::NoSuchAgent { agent, count });
        }
        if replay.step_count() == 0 {
            return Err(RenderError::NoStep);
        }
        let scene_px = [framing.width_px, framing.height_px];
        let height_px = scene_px[1].max(MIN_HEIGHT_PX);
        let room = (MAX_SIDE_PX.saturating_sub(scene_px[0]) / velocity_panel::width_px(height_px)) as usize;
        if agents.len() > room {
            return Err(RenderError::TooManyPanels { requested: agents.len(), room });
        }
        Ok(Self {
            replay,
            agents: agents.iter().map(|&agent| agent.into()).collect(),
            marks: SceneMarks::new(framing),
            scene_px,
        })
    }

    /// Number of pixels of a picture.
    pub(crate) fn pixel_count(&self) -> usize {
        let height_px = self.scene_px[1].max(MIN_HEIGHT_PX);
        let width_px = self.scene_px[0] + velocity_panel::width_px(height_px) * self.agents.len() as u32;
        width_px as usize * height_px as usize
    }

    /// Picture of a drawn scene with its marks and panels, opaque.
    ///
    /// # Errors
    /// If the recording is damaged.
    pub fn draw(&self, scene: &Pixmap, time_s: f64) -> Result<Pixmap, RenderError> {
        let step = self.replay.step(self.frame_at(time_s))?;
        let explain = |id: &AgentId| Some(ExplainedStep::new(&step, step.index_of(*id)?));
        let explained: Vec<Option<ExplainedStep>> = self.agents.iter().map(explain).collect();
        let mut marked = scene.clone();
        for explained in explained.iter().flatten() {
            self.marks.draw(&mut marked, explained);
        }
        let [scene_width_px, scene_height_px] = self.scene_px;
        let height_px = scene_height_px.max(MIN_HEIGHT_PX);
        let panel_px = velocity_panel::width_px(height_px);
        let width_px = scene_width_px + panel_px * explained.len() as u32;
        let mut picture = Pixmap::new(width_px, height_px).expect("`new` checked that the panels have room");
        picture.fill(to_color(PAPER, 1.0));
        copy(&mut picture, &marked, 0);
        for (index, explained) in explained.iter().enumerate() {
            let left_px = scene_width_px + panel_px * index as u32;
            // The panel of an agent that is not present stays empty.
            if let Some(explained) = explained {
                copy(&mut picture, &velocity_panel::draw(explained, height_px), left_px);
            }
        }
        Ok(picture)
    }

    /// The recorded frame in which the step of a picture begins.
    fn frame_at(&self, time_s: f64) -> usize {
        let steps = time_s / f64::from(self.replay.header().scenario.dt_s) + STEP_TOLERANCE_STEPS;
        (steps as usize).min(self.replay.step_count() - 1)
    }
}

/// Copies a part into a picture, at the top, `left_px` from the left.
fn copy(picture: &mut Pixmap, part: &Pixmap, left_px: u32) {
    picture.draw_pixmap(left_px as i32, 0, part.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
}
