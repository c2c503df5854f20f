//! The constraint overlay: beside the scene, for each agent asked for, the velocity space of one step, as the paper's
//! Figs. 3 to 5.
//!
//! The step that begins in the picture's frame is planned again from the recording alone ([`Replay`]), so a picture
//! shows what the planner went by, not what is remembered of it. The scene, marked (`overlay_scene.rs`), stands
//! at the left; panels (`velocity_panel.rs`) follow to its right, one an agent. In the last frame, from which no
//! step leads on, the step that led there is shown.

use fbcrowd_sim::planning::{Planner, Reasons};
use fbcrowd_sim::recording::{RecordedStep, Recording, Replay};
use glam::Vec2;
use tiny_skia::{Pixmap, PixmapPaint, Transform};

use crate::constraints::scene_marks::SceneMarks;
use crate::constraints::velocity_panel;
use crate::error::RenderError;
use crate::raster::palette::PAPER;
use crate::top_view::framing::{Framing, MAX_SIDE_PX};
use crate::top_view::ground::to_color;

/// A picture's time this near the next step, in steps, shows it already.
const SAME_STEP: f64 = 1e-3;
/// Lower panels could not be read, pixels: beside a smaller scene they are taller than it.
const MIN_HEIGHT_PX: u32 = 540;
/// How far velocities are shown, as multiples of the preferred speed: as far as the database goes, within these bounds.
const REACH_OF_PREFERRED: [f32; 2] = [1.5, 1.75];
/// A person who wants to stand is shown in the space of a slow walk, m/s.
const MIN_PREFERRED_MPS: f32 = 0.5;
/// Room beyond the fastest velocity.
const ROOM: f32 = 1.08;

/// Draws the overlay of one recording.
#[derive(Debug)]
pub struct ConstraintOverlay<'a> {
    replay: Replay<'a>,
    agents: Vec<usize>,
    marks: SceneMarks,
    scene_px: [u32; 2],
}

/// One agent in one step, planned again: what panel and marks are drawn from.
#[derive(Debug)]
pub(crate) struct Planned<'a> {
    pub(crate) step: &'a RecordedStep<'a>,
    pub(crate) agent: usize,
    pub(crate) reasons: Reasons,
    /// Velocities are shown so far from standing, m/s.
    pub(crate) reach_mps: f32,
}

impl Planned<'_> {
    /// Who planned.
    pub(crate) fn planner(&self) -> Planner {
        self.step.header().scenario.planner
    }
}

impl<'a> ConstraintOverlay<'a> {
    /// The overlay of some agents, in the order in which they were asked for.
    ///
    /// # Errors
    /// Where an agent does not exist, no step was recorded, or so many panels make no picture.
    pub fn new(recording: &'a Recording, framing: &Framing, agents: &[usize]) -> Result<Self, RenderError> {
        let replay = Replay::new(recording);
        let count = replay.header().scenario.agents.len();
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
            return Err(RenderError::TooManyPanels { asked: agents.len(), room });
        }
        Ok(Self { replay, agents: agents.to_vec(), marks: SceneMarks::new(framing), scene_px })
    }

    /// The scene, drawn already, with its marks and panels, opaque.
    ///
    /// # Errors
    /// Where the recording is damaged.
    pub fn draw(&self, scene: &Pixmap, time_s: f64) -> Result<Pixmap, RenderError> {
        let step = self.replay.step(self.frame_at(time_s))?;
        let planned: Vec<Planned> = self.agents.iter().map(|&agent| planned(&step, agent)).collect();
        let mut marked = scene.clone();
        for planned in &planned {
            self.marks.draw(&mut marked, planned);
        }
        let [scene_width_px, scene_height_px] = self.scene_px;
        let height_px = scene_height_px.max(MIN_HEIGHT_PX);
        let panel_px = velocity_panel::width_px(height_px);
        let width_px = scene_width_px + panel_px * planned.len() as u32;
        let mut picture = Pixmap::new(width_px, height_px).expect("so many panels have room, as was checked");
        picture.fill(to_color(PAPER, 1.0));
        place(&mut picture, &marked, 0);
        for (index, planned) in planned.iter().enumerate() {
            let left_px = scene_width_px + panel_px * index as u32;
            place(&mut picture, &velocity_panel::draw(planned, height_px), left_px);
        }
        Ok(picture)
    }

    /// The frame in which the step begins that a picture shows.
    fn frame_at(&self, time_s: f64) -> usize {
        let steps = time_s / f64::from(self.replay.header().scenario.dt_s) + SAME_STEP;
        (steps as usize).min(self.replay.step_count() - 1)
    }
}

fn planned<'a>(step: &'a RecordedStep<'a>, agent: usize) -> Planned<'a> {
    let scenario = &step.header().scenario;
    let reasons = Reasons::new(scenario.planner, &step.world(), agent, &scenario.params);
    Planned { step, agent, reasons, reach_mps: reach_mps(step, agent) }
}

/// The same in all pictures of a sequence, and whatever the facing.
fn reach_mps(step: &RecordedStep, agent: usize) -> f32 {
    let hull = &step.header().velocity_hull;
    let corners_mps = hull.turning_mps.iter().chain(&hull.holding_mps);
    let fastest_mps = corners_mps.map(|corner_mps: &Vec2| corner_mps.length()).fold(0.0, f32::max);
    let preferred_mps = step.header().scenario.agents[agent].preferred_speed_mps.max(MIN_PREFERRED_MPS);
    let [least, most] = REACH_OF_PREFERRED.map(|factor| factor * preferred_mps);
    ROOM * fastest_mps.clamp(least, most)
}

fn place(picture: &mut Pixmap, part: &Pixmap, left_px: u32) {
    picture.draw_pixmap(left_px as i32, 0, part.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
}
