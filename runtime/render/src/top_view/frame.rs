//! One frame, seen from straight above, in layers from bottom to top: ground, doors, signals, trails, shade, bodies,
//! captions.
//!
//! Enters: recorded roots and poses, world metres. Leaves: an opaque sRGB picture. [`TopView::new`] prepares what all
//! frames share. [`TopView::draw`] depends only on time and bodies, so frames can be drawn in any order and thread.

use fbcrowd_sim::Population;
use fbcrowd_sim::recording::{AgentFrame, Header};
use glam::{Vec2, Vec3};
use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::error::RenderError;
use crate::raster::drawn_body::{self, Detail, DrawnPart};
use crate::raster::palette::look;
use crate::raster::pixels::Strip;
use crate::raster::scan_lines::STRIP_STEP;
use crate::raster::strips::PictureStrips;
use crate::raster::tapered_capsule::Canvas;
use crate::top_view::captions::Captions;
use crate::top_view::doors::DrawnDoors;
use crate::top_view::framing::{Framing, frame_recording};
use crate::top_view::ground;
use crate::top_view::shade::ShadeMask;
use crate::top_view::signals::draw_signals;
use crate::top_view::trails::{self, Tracks, Trail};

/// Greatest number of pixels of a strip, which take 9 bytes each: a frame of up to 2560 × 1440 is one strip.
pub(crate) const STRIP_PIXELS: u32 = 4 << 20;
/// Number of rows by which strips begin: those of EXR files do.
const BLOCK_ROWS: u32 = STRIP_STEP as u32;
/// Reach of a body and its shade from its root, m: bodies farther outside the picture are left out.
const REACH_M: f32 = 2.0;
/// Depth below the ground at which a canvas has height 0, m: a toe slightly below the ground is not hidden.
const BELOW_GROUND_M: f32 = 1.0;
/// Width of the dark rim around a limb, m.
const RIM_M: f32 = 0.025;
/// Least width of a rim that is drawn, pixels: narrower ones only darken small bodies.
const MIN_RIM_PX: f32 = 0.6;
/// Greatest width of a rim, pixels: wider ones look like an outline.
const MAX_RIM_PX: f32 = 6.0;
/// Least radius of a part whose shade is visible, pixels: ears, and arms in small pictures, are thinner.
const MIN_SHADE_RADIUS_PX: f32 = 0.9;

/// The top view of one recording: what all its frames share.
///
/// ```no_run
/// use std::path::Path;
///
/// use fbcrowd_render::top_view::{read_tracks, sample};
/// use fbcrowd_render::{RenderError, TopView, png_frame};
/// use fbcrowd_sim::Recording;
///
/// let recording = Recording::open(Path::new("crossing.fbrec"))?;
/// let tracks = read_tracks(&recording)?;
/// let top_view = TopView::new(recording.header(), &tracks)?.with_doors(recording.population());
/// let mut buffers = top_view.buffers();
/// let agents = sample(&recording, 2.0)?;
/// png_frame::write(Path::new("at_2_s.png"), top_view.draw(&mut buffers, 2.0, &agents))?;
/// # Ok::<(), RenderError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TopView<'a> {
    header: &'a Header,
    tracks: &'a Tracks,
    framing: Framing,
    background: Pixmap,
    doors: DrawnDoors<'a>,
    /// What events have made of signals; none where only their phases are known.
    population: Option<&'a Population>,
    captions: Captions,
}

/// Memory for one strip of a frame, which strips and consecutive frames share: to allocate a megapixel takes longer than
/// to draw on it.
#[derive(Clone, Debug)]
pub struct FrameBuffers {
    canvas: Canvas,
    shade: ShadeMask,
}

impl<'a> TopView<'a> {
    /// The top view of a recording, framed by its view.
    ///
    /// # Errors
    /// If the view is out of range.
    pub fn new(header: &'a Header, tracks: &'a Tracks) -> Result<Self, RenderError> {
        let framing = match tracks.bounds_m {
            Some(corners_m) => frame_recording(header, corners_m.into_iter())?,
            None => frame_recording(header, tracks.positions_m())?,
        };
        let background = ground::background(header, &framing);
        let (doors, captions) = (DrawnDoors::default(), Captions::new(&framing));
        Ok(Self { header, tracks, framing, background, doors, population: None, captions })
    }

    /// The same with the doors of the recording, as they open and close, its signals, as events change them, and bodies
    /// of their own size.
    pub fn with_doors(self, population: &'a Population) -> Self {
        let doors = DrawnDoors::new(&self.header.scenario, &population.doors, &self.framing);
        Self { doors, population: Some(population), ..self }
    }

    /// Part of the world that is shown.
    pub fn framing(&self) -> &Framing {
        &self.framing
    }

    /// Memory for drawing whole frames one after the other.
    pub fn buffers(&self) -> FrameBuffers {
        self.buffers_of(self.framing.height_px)
    }

    /// Memory for drawing frames strip by strip.
    pub(crate) fn strip_buffers(&self) -> FrameBuffers {
        self.buffers_of(strip_rows(&self.framing))
    }

    fn buffers_of(&self, rows: u32) -> FrameBuffers {
        let width_px = self.framing.width_px;
        let pixmap = Pixmap::new(width_px, rows).expect("the framing's sides are checked");
        FrameBuffers { canvas: Canvas::new(pixmap), shade: ShadeMask::new(Strip::whole(width_px, rows)) }
    }

    /// Picture of all agents at a time, opaque. The former content of the buffers has no influence.
    pub fn draw<'b>(&self, buffers: &'b mut FrameBuffers, time_s: f32, agents: &[AgentFrame]) -> &'b Pixmap {
        self.draw_strip(buffers, 0, time_s, agents, &self.parts(agents));
        &buffers.canvas.pixmap
    }

    /// The same picture, strip by strip.
    pub(crate) fn strips<'b>(
        &'b self,
        buffers: &'b mut FrameBuffers,
        time_s: f32,
        agents: &'b [AgentFrame],
    ) -> FrameStrips<'b> {
        FrameStrips { view: self, buffers, time_s, agents, parts: self.parts(agents) }
    }

    fn draw_strip(
        &self,
        buffers: &mut FrameBuffers,
        top_px: u32,
        time_s: f32,
        agents: &[AgentFrame],
        parts: &[DrawnPart],
    ) {
        let FrameBuffers { canvas, shade } = buffers;
        canvas.reset(&self.background, top_px);
        self.doors.draw(&mut canvas.pixmap, &canvas.strip, time_s);
        let is_green = |signal: usize| match self.population {
            Some(population) => population.is_green(&self.header.scenario, signal, time_s.into()),
            None => self.header.scenario.behaviour.is_green(signal, time_s.into()),
        };
        draw_signals(&mut canvas.pixmap, &canvas.strip, &self.header.scenario, &self.framing, is_green);
        self.draw_trails(canvas, time_s, agents);
        self.draw_shade(canvas, shade, parts);
        self.draw_bodies(canvas, parts);
        self.draw_captions(canvas, time_s, agents);
    }

    /// Parts of every body in the picture, from the lowest to the highest.
    fn parts(&self, agents: &[AgentFrame]) -> Vec<DrawnPart> {
        let detail = Detail::at_scale(self.framing.scale_px_m);
        let mut parts = Vec::new();
        for agent in agents {
            if self.shows(agent.root.position_m) {
                let look = look(agent.id.index());
                let skeleton = self.header.skeleton();
                drawn_body::append_parts(&mut parts, skeleton, agent, self.stature(agent), look, detail);
            }
        }
        // A stable sort: parts of equal height keep the order of agents.
        parts.sort_by(|one, other| one.top_m.total_cmp(&other.top_m));
        parts
    }

    /// Size of an agent's body, relative to the skeleton.
    fn stature(&self, agent: &AgentFrame) -> f32 {
        self.population.and_then(|population| population.agents.get(agent.id.index())).map_or(1.0, |life| life.stature)
    }

    fn shows(&self, position_m: Vec2) -> bool {
        let reach = Vec2::splat(REACH_M * self.framing.scale_px_m);
        let px = self.framing.to_px(position_m);
        (px + reach).cmpge(Vec2::ZERO).all() && (px - reach).cmple(self.framing.size_px()).all()
    }

    fn draw_trails(&self, canvas: &mut Canvas, time_s: f32, agents: &[AgentFrame]) {
        let length_s = self.header.scenario.view.trail_s;
        if length_s <= 0.0 {
            return;
        }
        for frame in agents {
            let (agent, position_m) = (frame.id.index(), frame.root.position_m);
            let trail = Trail { agent, time_s, position_m, length_s, colour: look(agent).shirt };
            trails::draw(&mut canvas.pixmap, &canvas.strip, &self.framing, self.tracks, &trail);
        }
    }

    fn draw_shade(&self, canvas: &mut Canvas, shade: &mut ShadeMask, parts: &[DrawnPart]) {
        shade.clear(canvas.strip.top_px);
        for part in parts.iter().filter(|part| part.radii_m[0] * self.framing.scale_px_m >= MIN_SHADE_RADIUS_PX) {
            shade.add_part(&self.framing, part);
        }
        shade.apply(&mut canvas.pixmap);
    }

    fn draw_bodies(&self, canvas: &mut Canvas, parts: &[DrawnPart]) {
        let scale = self.framing.scale_px_m;
        let rim_px = Some(RIM_M * scale).filter(|rim_px| *rim_px >= MIN_RIM_PX).unwrap_or(0.0).min(MAX_RIM_PX);
        let to_px = |end: Vec3| self.framing.to_px(end.truncate()).extend((end.z + BELOW_GROUND_M) * scale);
        for part in parts {
            canvas.paint(&part.to_capsule(to_px, scale), part.colour, rim_px);
        }
    }

    fn draw_captions(&self, canvas: &mut Canvas, time_s: f32, agents: &[AgentFrame]) {
        let (pixmap, top_px) = (&mut canvas.pixmap, canvas.strip.top_px);
        if self.header.scenario.view.labels {
            self.captions.draw_labels(pixmap, top_px, agents);
        }
        self.captions.draw_scale_bar(pixmap, top_px);
        self.captions.draw_time(pixmap, top_px, time_s);
    }
}

/// Number of rows of a strip: as many as have at most [`STRIP_PIXELS`], in whole blocks.
fn strip_rows(framing: &Framing) -> u32 {
    if framing.width_px * framing.height_px <= STRIP_PIXELS {
        return framing.height_px;
    }
    (STRIP_PIXELS / framing.width_px / BLOCK_ROWS).max(1) * BLOCK_ROWS
}

/// A frame that is drawn strip by strip.
pub(crate) struct FrameStrips<'a> {
    view: &'a TopView<'a>,
    buffers: &'a mut FrameBuffers,
    time_s: f32,
    agents: &'a [AgentFrame],
    /// Parts of every body in the picture, from the lowest to the highest.
    parts: Vec<DrawnPart>,
}

impl PictureStrips for FrameStrips<'_> {
    fn size_px(&self) -> [u32; 2] {
        [self.view.framing.width_px, self.view.framing.height_px]
    }

    fn strip_rows(&self) -> u32 {
        self.buffers.canvas.strip.rows
    }

    fn draw(&mut self, top_px: u32) {
        self.view.draw_strip(self.buffers, top_px, self.time_s, self.agents, &self.parts);
    }

    fn pixels(&self) -> &[PremultipliedColorU8] {
        self.buffers.canvas.pixmap.pixels()
    }
}
