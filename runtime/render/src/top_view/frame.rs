//! One frame, seen from straight above, in layers from bottom to top: ground, trails, shade, bodies, captions.
//!
//! Enters: recorded roots and poses, world metres. Leaves: an opaque sRGB picture. [`TopView::new`] prepares what all
//! frames share. [`TopView::draw`] depends only on time and bodies, so frames can be drawn in any order and thread.

use fbcrowd_sim::recording::{AgentFrame, Header};
use glam::{Vec2, Vec3};
use tiny_skia::Pixmap;

use crate::error::RenderError;
use crate::raster::drawn_body::{self, Detail, DrawnPart};
use crate::raster::palette::look;
use crate::raster::tapered_capsule::Canvas;
use crate::top_view::captions::Captions;
use crate::top_view::framing::{Framing, frame_recording};
use crate::top_view::ground;
use crate::top_view::shade::ShadeMask;
use crate::top_view::trails::{self, Tracks, Trail};

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
/// let top_view = TopView::new(recording.header(), &tracks)?;
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
    captions: Captions,
}

/// Memory that consecutive frames share: to allocate a megapixel takes longer than to draw on it.
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
        let framing = frame_recording(header, tracks.positions_m())?;
        let background = ground::background(header, &framing);
        Ok(Self { header, tracks, framing, background, captions: Captions::new(&framing) })
    }

    /// Part of the world that is shown.
    pub fn framing(&self) -> &Framing {
        &self.framing
    }

    /// Memory for drawing frames one after the other.
    pub fn buffers(&self) -> FrameBuffers {
        FrameBuffers { canvas: Canvas::new(self.background.clone()), shade: ShadeMask::new(&self.framing) }
    }

    /// Picture of all agents at a time, opaque. The former content of the buffers has no influence.
    pub fn draw<'b>(&self, buffers: &'b mut FrameBuffers, time_s: f32, agents: &[AgentFrame]) -> &'b Pixmap {
        let FrameBuffers { canvas, shade } = buffers;
        canvas.reset(&self.background);
        let parts = self.parts(agents);
        self.draw_trails(&mut canvas.pixmap, time_s, agents);
        self.draw_shade(&mut canvas.pixmap, shade, &parts);
        self.draw_bodies(canvas, &parts);
        self.draw_captions(&mut canvas.pixmap, time_s, agents);
        &canvas.pixmap
    }

    /// Parts of every body in the picture, from the lowest to the highest.
    fn parts(&self, agents: &[AgentFrame]) -> Vec<DrawnPart> {
        let detail = Detail::at_scale(self.framing.scale_px_m);
        let mut parts = Vec::new();
        for agent in agents {
            if self.shows(agent.root.position_m) {
                let look = look(agent.id.index());
                drawn_body::append_parts(&mut parts, self.header.skeleton(), agent, look, detail);
            }
        }
        // A stable sort: parts of equal height keep the order of agents.
        parts.sort_by(|one, other| one.top_m.total_cmp(&other.top_m));
        parts
    }

    fn shows(&self, position_m: Vec2) -> bool {
        let reach = Vec2::splat(REACH_M * self.framing.scale_px_m);
        let px = self.framing.to_px(position_m);
        (px + reach).cmpge(Vec2::ZERO).all() && (px - reach).cmple(self.framing.size_px()).all()
    }

    fn draw_trails(&self, pixmap: &mut Pixmap, time_s: f32, agents: &[AgentFrame]) {
        let length_s = self.header.scenario.view.trail_s;
        if length_s <= 0.0 {
            return;
        }
        for frame in agents {
            let (agent, position_m) = (frame.id.index(), frame.root.position_m);
            let trail = Trail { agent, time_s, position_m, length_s, colour: look(agent).shirt };
            trails::draw(pixmap, &self.framing, self.tracks, &trail);
        }
    }

    fn draw_shade(&self, pixmap: &mut Pixmap, shade: &mut ShadeMask, parts: &[DrawnPart]) {
        shade.clear();
        for part in parts.iter().filter(|part| part.radii_m[0] * self.framing.scale_px_m >= MIN_SHADE_RADIUS_PX) {
            shade.add_part(&self.framing, part);
        }
        shade.apply(pixmap);
    }

    fn draw_bodies(&self, canvas: &mut Canvas, parts: &[DrawnPart]) {
        let scale = self.framing.scale_px_m;
        let rim_px = Some(RIM_M * scale).filter(|rim_px| *rim_px >= MIN_RIM_PX).unwrap_or(0.0).min(MAX_RIM_PX);
        let to_px = |end: Vec3| self.framing.to_px(end.truncate()).extend((end.z + BELOW_GROUND_M) * scale);
        for part in parts {
            canvas.paint(&part.to_capsule(to_px, scale), part.colour, rim_px);
        }
    }

    fn draw_captions(&self, pixmap: &mut Pixmap, time_s: f32, agents: &[AgentFrame]) {
        if self.header.scenario.view.labels {
            self.captions.draw_labels(pixmap, agents);
        }
        self.captions.draw_scale_bar(pixmap);
        self.captions.draw_time(pixmap, time_s);
    }
}
