//! One frame seen from straight above: ground, trails, shade, bodies, writing, in the order in which they cover each
//! other.
//!
//! [`TopView::new`] does once what all frames of a sequence share; [`TopView::draw`] depends on time and bodies alone,
//! so that frames can be drawn in any order and on any thread.

use fbcrowd_sim::recording::{AgentFrame, Header};
use glam::{Vec2, Vec3};
use tiny_skia::Pixmap;

use crate::error::RenderError;
use crate::raster::body::{self, Detail, Part};
use crate::raster::palette::{Look, look};
use crate::raster::tapered_capsule::{Canvas, Cone};
use crate::top_view::framing::{Framing, frame_recording};
use crate::top_view::ground;
use crate::top_view::overlay::Overlay;
use crate::top_view::shade::ShadeMask;
use crate::top_view::trails::{self, Tracks, Trail};

/// Reach of a body and its shade about its root, m: bodies farther outside the picture are left out.
const REACH_M: f32 = 2.0;
/// A canvas counts heights from this far below the ground: a toe that sinks in by a millimetre is not hidden, m.
const BELOW_GROUND_M: f32 = 1.0;
/// Width of the dark rim under a limb, m.
const RIM_M: f32 = 0.025;
/// A narrower rim is left out: it would only dirty small bodies; pixels.
const MIN_RIM_PX: f32 = 0.6;
/// A wider rim would look like an outline, pixels.
const MAX_RIM_PX: f32 = 6.0;
/// Thinner parts (ears; in small pictures also arms) throw no shade that could be seen, pixels.
const MIN_SHADE_RADIUS_PX: f32 = 0.9;

/// What all frames of one recording share.
#[derive(Clone, Debug)]
pub struct TopView<'a> {
    header: &'a Header,
    tracks: &'a Tracks,
    framing: Framing,
    background: Pixmap,
    looks: Vec<Look>,
    overlay: Overlay,
}

/// Memory that consecutive frames share: a fresh megapixel costs more than drawing on it.
#[derive(Clone, Debug)]
pub struct FrameBuffers {
    canvas: Canvas,
    shade: ShadeMask,
}

impl<'a> TopView<'a> {
    /// Frames the recording as its view says and draws what stands still.
    ///
    /// # Errors
    /// Where the view asks for a picture that cannot be drawn.
    pub fn new(header: &'a Header, tracks: &'a Tracks) -> Result<Self, RenderError> {
        let framing = frame_recording(header, &tracks.positions_m)?;
        let background = ground::background(header, &framing);
        let looks = (0..header.scenario.agents.len()).map(look).collect();
        Ok(Self { header, tracks, framing, background, looks, overlay: Overlay::new(&framing) })
    }

    /// Which part of the world is shown.
    pub fn framing(&self) -> &Framing {
        &self.framing
    }

    /// Memory for drawing frames one after the other.
    pub fn buffers(&self) -> FrameBuffers {
        FrameBuffers { canvas: Canvas::new(self.background.clone()), shade: ShadeMask::new(&self.framing) }
    }

    /// The picture of all agents at a time, opaque. What the buffers held before has no influence.
    pub fn draw<'b>(&self, buffers: &'b mut FrameBuffers, time_s: f32, agents: &[AgentFrame]) -> &'b Pixmap {
        let FrameBuffers { canvas, shade } = buffers;
        canvas.reset(&self.background);
        let parts = self.parts(agents);
        self.draw_trails(&mut canvas.pixmap, time_s, agents);
        self.draw_shade(&mut canvas.pixmap, shade, &parts);
        self.draw_bodies(canvas, &parts);
        self.draw_writing(&mut canvas.pixmap, time_s, agents);
        &canvas.pixmap
    }

    /// The limbs of every body in the picture, from the lowest to the highest.
    fn parts(&self, agents: &[AgentFrame]) -> Vec<Part> {
        let detail = Detail::at_scale(self.framing.scale_px_m);
        let mut parts = Vec::new();
        for (agent, look) in agents.iter().zip(&self.looks) {
            if self.shows(agent.root.position_m) {
                body::append_parts(&mut parts, &self.header.skeleton, agent, *look, detail);
            }
        }
        // Stable, so that equal heights keep the order of agents.
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
        for (agent, (frame, look)) in agents.iter().zip(&self.looks).enumerate() {
            let trail = Trail { agent, time_s, position_m: frame.root.position_m, length_s, colour: look.shirt };
            trails::draw(pixmap, &self.framing, self.tracks, &trail);
        }
    }

    fn draw_shade(&self, pixmap: &mut Pixmap, shade: &mut ShadeMask, parts: &[Part]) {
        shade.clear();
        for part in parts.iter().filter(|part| part.radii_m[0] * self.framing.scale_px_m >= MIN_SHADE_RADIUS_PX) {
            shade.add_part(&self.framing, part);
        }
        shade.apply(pixmap);
    }

    fn draw_bodies(&self, canvas: &mut Canvas, parts: &[Part]) {
        let scale = self.framing.scale_px_m;
        let rim_px = Some(RIM_M * scale).filter(|rim_px| *rim_px >= MIN_RIM_PX).unwrap_or(0.0).min(MAX_RIM_PX);
        let to_px = |end: Vec3| self.framing.to_px(end.truncate()).extend((end.z + BELOW_GROUND_M) * scale);
        for part in parts {
            let cone = Cone { ends_px: part.ends_m.map(to_px), radii_px: part.radii_m.map(|radius| radius * scale) };
            canvas.paint(&cone, part.colour, rim_px);
        }
    }

    fn draw_writing(&self, pixmap: &mut Pixmap, time_s: f32, agents: &[AgentFrame]) {
        if self.header.scenario.view.labels {
            self.overlay.draw_labels(pixmap, agents);
        }
        self.overlay.draw_scale_bar(pixmap);
        self.overlay.draw_time(pixmap, time_s);
    }
}
