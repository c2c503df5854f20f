//! The strip of an agent: its body at several times, side by side, as an animator looks at a clip. A row shows it from its
//! right side and, below, from its front; the text under both names the time, the speed, and the turn since the first time.
//!
//! Both views are those of the first time, so that a body that turns is seen to turn. Bodies walk on the spot. World of a
//! view, metres: the body stands on the x axis, and the eye looks along y.

use std::f32::consts::FRAC_PI_2;
use std::path::PathBuf;

use fbcrowd_sim::AgentId;
use fbcrowd_sim::recording::{AgentFrame, ExtraFrame, Header, Recording, sample, sample_extra};
use fbcrowd_sim::scenario::{Scenario, ShotSpec};
use glam::{Vec2, Vec3};
use motiondb::body::{Joint, Root};
use motiondb::character::Character;
use tiny_skia::{Pixmap, PixmapPaint, Transform};

use crate::camera::{CameraView, ColourBy, Quality, Shot};
use crate::error::RenderError;
use crate::plots::chart::axis::number;
use crate::plots::chart::figure::PlotFigure;
use crate::raster::palette::INK;
use crate::raster::png_frame;
use crate::raster::text::TextAnchor;
use crate::top_view::FrameRange;
use crate::top_view::sequence::{frame_numbers, frame_times, make_folder};
use crate::visibility::{Lens, SamplePattern};

/// Greatest number of times in a row, and in a strip.
const TIMES: [usize; 2] = [16, 256];
/// Width of a body's cell (that of the ground grid, whose lines part the bodies), and least height of a view, m.
const CELL_M: Vec2 = Vec2::new(1.0, 2.1);
/// Height of the part of a view below the ground, m.
const BELOW_M: f32 = 0.11;
/// Least height of the part of a view above the crown, m: hair.
const ABOVE_M: f32 = 0.12;
/// Pixels of a metre.
const SCALE_PX_M: f32 = 150.0;
/// Height of the text under the views, of the title, and margin at the sides, pixels.
const TEXT_PX: f32 = 70.0;
const TITLE_PX: f32 = 70.0;
const MARGIN_PX: f32 = 24.0;
/// Distance of lines of the text, pixels.
const LINE_PX: f32 = 24.0;
/// Distance of the eye, m, and the height that it looks down, as a share of that distance.
const EYE_M: f32 = 20.0;
const ELEVATION: f32 = 0.07;
/// Facing of a body that shows its right side, and of one that shows its front, rad.
const FACINGS_RAD: [f32; 2] = [0.0, -FRAC_PI_2];

/// What strips show.
#[derive(Clone, Debug)]
pub struct StripOptions {
    /// Output folder; made if missing.
    pub folder: PathBuf,
    /// Indices of the agents; each has a strip of its own, `NAME.agentN.png`.
    pub agents: Vec<usize>,
    /// Frames to be drawn; `None` for all.
    pub frames: Option<FrameRange>,
    /// Times and numbers of the frames, instead of the recorded scenario's.
    pub shot: Option<ShotSpec>,
    /// The characters of the recording, in its order.
    pub characters: Vec<Character>,
}

/// Paths of the strips that [`write_agent_strips`] writes with the same options, in order.
pub fn strip_paths(recording: &Recording, options: &StripOptions) -> Vec<PathBuf> {
    let name = &recording.header().scenario.name;
    options.agents.iter().map(|agent| options.folder.join(format!("{name}.agent{agent}.png"))).collect()
}

/// Draws a strip of each agent of the options, and returns the files in order.
///
/// # Errors
/// If an agent does not exist or is not present at some time, there are no times or too many, the recording is damaged, or
/// a file cannot be written.
pub fn write_agent_strips(recording: &Recording, options: &StripOptions) -> Result<Vec<PathBuf>, RenderError> {
    let times = frame_times(recording, options.shot.as_ref());
    let numbers = frame_numbers(recording, &times, options.frames.as_ref())?;
    let times_s: Vec<f64> = numbers.into_iter().map(|number| times.time_s(number)).collect();
    let paths = strip_paths(recording, options);
    let strips: Vec<Pixmap> = options
        .agents
        .iter()
        .map(|&agent| agent_strip(recording, &options.characters, agent, &times_s))
        .collect::<Result<_, _>>()?;
    make_folder(&options.folder)?;
    paths.iter().zip(&strips).try_for_each(|(path, strip)| png_frame::write(path, strip))?;
    Ok(paths)
}

/// The strip of one agent, given by id, at some times, s.
///
/// # Errors
/// If the agent does not exist or is not present at a time, the times are too many, or the recording is damaged.
pub fn agent_strip(
    recording: &Recording,
    characters: &[Character],
    agent: usize,
    times_s: &[f64],
) -> Result<Pixmap, RenderError> {
    let count = recording.population().agents.len();
    if agent >= count {
        return Err(RenderError::NoSuchAgent { agent, count });
    }
    if times_s.len() > TIMES[1] {
        return Err(RenderError::TooManyTimes { requested: times_s.len(), room: TIMES[1] });
    }
    let moments: Vec<Moment> =
        times_s.iter().map(|&time_s| Moment::new(recording, agent.into(), time_s)).collect::<Result<_, _>>()?;
    let columns = moments.len().clamp(1, TIMES[0]);
    let height_m = CELL_M.y.max(BELOW_M + top_m(recording, agent, &moments) + ABOVE_M);
    let view_px = (SCALE_PX_M * Vec2::new(CELL_M.x * columns as f32, height_m)).round();
    let (row_px, rows) = (2.0 * view_px.y + TEXT_PX, moments.len().div_ceil(columns));
    let size_px = [view_px.x + 2.0 * MARGIN_PX, TITLE_PX + rows as f32 * row_px];
    let mut figure = PlotFigure::new(size_px.map(|side_px| side_px as u32));
    figure.title(&format!("{}, agent {agent}", recording.header().scenario.name), Vec2::new(MARGIN_PX, 48.0));
    let header = without_scene(recording.header());
    let quality = Quality { samples: SamplePattern::Sixteen, ..Quality::default() };
    let view = CameraView::new(&header, recording.population(), quality, ColourBy::Agent).with_characters(characters);
    for (row, shown) in moments.chunks(columns).enumerate() {
        let top_px = TITLE_PX + row as f32 * row_px;
        for (index, facing_rad) in FACINGS_RAD.into_iter().enumerate() {
            let turn_rad = facing_rad - moments[0].frame.root.facing_rad;
            let picture = draw_view(&view, shown, turn_rad, view_px);
            let at_px = [MARGIN_PX, top_px + index as f32 * view_px.y].map(|side_px| side_px.round() as i32);
            let paint = PixmapPaint::default();
            figure.pixmap.draw_pixmap(at_px[0], at_px[1], picture.as_ref(), &paint, Transform::identity(), None);
        }
        for (column, moment) in shown.iter().enumerate() {
            let middle_px = MARGIN_PX + (column as f32 + 0.5) * SCALE_PX_M * CELL_M.x;
            let below_px = Vec2::new(middle_px, top_px + 2.0 * view_px.y + LINE_PX);
            draw_text(&mut figure, moment, &moments[0], below_px);
        }
    }
    Ok(figure.pixmap)
}

/// An agent at a time.
struct Moment {
    time_s: f64,
    frame: AgentFrame,
    extra: ExtraFrame,
    /// Velocity of the root, m/s.
    velocity_mps: Vec2,
}

impl Moment {
    fn new(recording: &Recording, agent: AgentId, time_s: f64) -> Result<Self, RenderError> {
        let at = |time_s: f64| -> Result<Option<AgentFrame>, RenderError> {
            Ok(sample(recording, time_s)?.into_iter().find(|frame| frame.id == agent))
        };
        let absent = || RenderError::AbsentAgent { agent: agent.0, time_s };
        let frame = at(time_s)?.ok_or_else(absent)?;
        let step_s = recording.header().scenario.dt_s;
        let before = at(time_s - f64::from(step_s))?.unwrap_or(frame);
        let velocity_mps = (frame.root.position_m - before.root.position_m) / step_s;
        Ok(Self { time_s, frame, extra: sample_extra(recording, time_s)?, velocity_mps })
    }
}

/// Greatest height of an agent's head above the ground, m.
fn top_m(recording: &Recording, agent: usize, moments: &[Moment]) -> f32 {
    let (skeleton, head) = (recording.header().skeleton(), Joint::Head.index());
    let head_m = |moment: &Moment| {
        let joints = moment.frame.pose.forward_kinematics(skeleton);
        (joints.positions_m[head] + joints.orientations[head] * skeleton.segment_ends_m[head]).z
    };
    recording.population().agents[agent].stature * moments.iter().map(head_m).fold(0.0, f32::max)
}

/// The header without what stands on the ground.
fn without_scene(header: &Header) -> Header {
    let Scenario { name, dt_s, characters, styles, .. } = header.scenario.clone();
    Header { scenario: Scenario { name, dt_s, characters, styles, ..Scenario::of(Vec::new()) }, ..header.clone() }
}

/// The bodies of a row side by side, turned by an angle.
fn draw_view(view: &CameraView<'_>, shown: &[Moment], turn_rad: f32, size_px: Vec2) -> Pixmap {
    let width_m = size_px.x / SCALE_PX_M;
    let direction = Vec3::new(0.0, 1.0, -ELEVATION);
    let middle_m = Vec3::new(0.5 * width_m, 0.0, 0.5 * size_px.y / SCALE_PX_M - BELOW_M);
    let size = [size_px.x as u32, size_px.y as u32];
    let lens = Lens::orthographic(size, middle_m - EYE_M * direction, direction, width_m);
    let shot = |time_s: f64| Shot { lens, time_s, eyes_of: None, fog_m: None };
    let parts = |(column, moment): (usize, &Moment)| {
        let position_m = Vec2::new((column as f32 + 0.5) * CELL_M.x, 0.0);
        let facing_rad = moment.frame.root.facing_rad + turn_rad;
        let frame = AgentFrame { root: Root { position_m, facing_rad }, ..moment.frame };
        view.scene(&shot(moment.time_s), &[frame], &moment.extra)
    };
    let mut bodies = shown.iter().enumerate().map(parts);
    let mut scene = bodies.next().unwrap_or_default();
    bodies.for_each(|body| scene.extend(&body));
    view.draw_scene(&shot(0.0), &scene).to_display()
}

/// Writes time, speed and turn of a moment below its body.
fn draw_text(figure: &mut PlotFigure, moment: &Moment, first: &Moment, at_px: Vec2) {
    let [from, to] = [first, moment].map(|moment| Vec2::from_angle(moment.frame.root.facing_rad));
    let turn_rad = from.angle_to(to);
    let moving = format!("{} m/s, {}°", number(moment.velocity_mps.length(), 2), number(turn_rad.to_degrees(), 0));
    for (line, text) in [format!("{:.2} s", moment.time_s), moving].iter().enumerate() {
        figure.note(text, at_px + Vec2::new(0.0, LINE_PX * line as f32), TextAnchor::Centre, INK);
    }
}
