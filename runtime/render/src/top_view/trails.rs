//! Tracks of all agents (root positions over a whole recording), and the fading ribbon behind each body.
//!
//! Tracks are in world metres, ribbons in pixels.

use fbcrowd_sim::AgentId;
use fbcrowd_sim::recording::AgentFrame;
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::raster::palette::Rgb;
use crate::raster::pixels::{PixelWindow, Strip, blend, pixels_mut};
use crate::top_view::framing::Framing;

/// Width of a trail at the body and at its end, m.
const WIDTH_M: [f32; 2] = [0.075, 0.025];
/// Least width of a trail, pixels: narrower ones break into dots.
const MIN_WIDTH_PX: f32 = 1.2;
/// Opacity at the body; it decreases to 0 at the end.
const OPACITY: f32 = 0.60;
/// Length of the pieces of a trail, pixels: bends of a walk then show no corners.
const PIECE_PX: f32 = 6.0;
/// Speed by which [`PIECE_PX`] becomes a number of frames, m/s: a brisk walk.
const BRISK_MPS: f32 = 1.5;

/// Root positions of all agents at uniform times from 0 on, by id.
///
/// ```
/// use fbcrowd_render::Tracks;
/// use fbcrowd_sim::AgentId;
/// use glam::Vec2;
///
/// // The first agent walks in two frames; the other one is born in the second frame.
/// let mut tracks = Tracks::new(0.5);
/// tracks.push([(AgentId(0), Vec2::ZERO)]);
/// tracks.push([(AgentId(0), Vec2::new(0.5, 0.0)), (AgentId(1), Vec2::Y)]);
/// assert_eq!((tracks.frame_count, tracks.agents.len()), (2, 2));
/// assert_eq!([tracks.position_m(1, 0), tracks.position_m(1, 1)], [None, Some(Vec2::Y)]);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tracks {
    /// Time between frames, s.
    pub dt_s: f32,
    /// Number of frames.
    pub frame_count: usize,
    /// The track of each agent, by id.
    pub agents: Vec<Track>,
    /// Box of all positions of a recording of which the tracks hold a part; none where they hold all.
    pub bounds_m: Option<[Vec2; 2]>,
}

/// Root positions of one agent in the frames in which it is present.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Index of the first frame.
    pub first_frame: usize,
    /// Positions in the world, frame by frame, metres.
    pub positions_m: Vec<Vec2>,
}

impl Tracks {
    /// No frames yet.
    pub fn new(dt_s: f32) -> Self {
        Self { dt_s, ..Self::default() }
    }

    /// No frames yet, the first one of which has an index.
    pub(crate) fn starting_at(dt_s: f32, first_frame: usize) -> Self {
        Self { frame_count: first_frame, ..Self::new(dt_s) }
    }

    /// Adds a frame: the root of each present agent, world, metres.
    pub fn push(&mut self, roots_m: impl IntoIterator<Item = (AgentId, Vec2)>) {
        for (id, root_m) in roots_m {
            if id.index() >= self.agents.len() {
                self.agents.resize(id.index() + 1, Track::default());
            }
            let track = &mut self.agents[id.index()];
            if track.positions_m.is_empty() {
                track.first_frame = self.frame_count;
            }
            track.positions_m.push(root_m);
        }
        self.frame_count += 1;
    }

    /// Adds a frame of a recording or simulation.
    pub fn push_frame(&mut self, agents: &[AgentFrame]) {
        self.push(agents.iter().map(|agent| (agent.id, agent.root.position_m)));
    }

    /// Position of an agent in a frame, world, metres; none where it is not present.
    pub fn position_m(&self, agent: usize, frame: usize) -> Option<Vec2> {
        let track = self.agents.get(agent)?;
        track.positions_m.get(frame.checked_sub(track.first_frame)?).copied()
    }

    /// All positions of all agents, world, metres.
    pub fn positions_m(&self) -> impl Iterator<Item = Vec2> {
        self.agents.iter().flat_map(|track| track.positions_m.iter().copied())
    }
}

/// The trail of one agent at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trail {
    /// Id of the agent.
    pub(crate) agent: usize,
    /// Time of the picture, s.
    pub(crate) time_s: f32,
    /// Position of the agent at that time, world, m.
    pub(crate) position_m: Vec2,
    /// Duration that the trail shows, s.
    pub(crate) length_s: f32,
    /// Colour of the ribbon.
    pub(crate) colour: Rgb,
}

/// One corner of a ribbon.
#[derive(Clone, Copy, Debug)]
struct RibbonCorner {
    at_px: Vec2,
    /// Age of the position: 0 at the body, 1 at the trail's end.
    age: f32,
}

/// Draws a trail over a strip of an opaque picture.
pub(crate) fn draw(pixmap: &mut Pixmap, strip: &Strip, framing: &Framing, tracks: &Tracks, trail: &Trail) {
    let corners = corners(framing, tracks, trail);
    for index in 1..corners.len() {
        let before = index.checked_sub(2).map(|before| corners[before].at_px);
        let after = corners.get(index + 1).map(|corner| corner.at_px);
        let piece = RibbonPiece::new(framing, [corners[index - 1], corners[index]], [before, after]);
        piece.paint(pixmap, strip, trail.colour);
    }
}

/// Corners from the body backward. They are at fixed frames of the tracks, so that the ribbon does not crawl from
/// picture to picture.
fn corners(framing: &Framing, tracks: &Tracks, trail: &Trail) -> Vec<RibbonCorner> {
    let Trail { agent, time_s, length_s, .. } = *trail;
    let stride = ((PIECE_PX / (BRISK_MPS * tracks.dt_s * framing.scale_px_m)).round() as usize).max(1);
    let newest = ((time_s / tracks.dt_s) as usize).min(tracks.frame_count.saturating_sub(1));
    let oldest = ((time_s - length_s).max(0.0) / tracks.dt_s).ceil() as usize;
    let mut corners = vec![RibbonCorner { at_px: framing.to_px(trail.position_m), age: 0.0 }];
    for frame in (oldest..=newest).rev().filter(|frame| frame % stride == 0) {
        let Some(position_m) = tracks.position_m(agent, frame) else { break };
        let at_px = framing.to_px(position_m);
        let age = (time_s - frame as f32 * tracks.dt_s) / length_s;
        let moved = corners.last().is_none_or(|last| last.at_px.distance_squared(at_px) > 0.01);
        if moved && at_px.is_finite() {
            corners.push(RibbonCorner { at_px, age });
        }
    }
    corners
}

/// The ribbon between two corners. The bisector of their directions separates two pieces, so that no pixel is painted
/// twice.
struct RibbonPiece {
    ends: [RibbonCorner; 2],
    direction: Vec2,
    length_px: f32,
    /// Normals of the lines at which the piece begins and ends, in its direction.
    borders: [Vec2; 2],
    /// Half the width at the trail's start and end, pixels.
    half_px: [f32; 2],
}

impl RibbonPiece {
    /// The piece between two corners; `around` are the corners before and after it.
    fn new(framing: &Framing, ends: [RibbonCorner; 2], around: [Option<Vec2>; 2]) -> Self {
        let [start, end] = ends.map(|corner| corner.at_px);
        let direction = (end - start).normalize_or_zero();
        // Where the path reverses, there is no useful bisector: the piece is cut straight.
        let bisector = |other: Option<Vec2>| {
            let sum = direction + other.map_or(Vec2::ZERO, Vec2::normalize_or_zero);
            if sum.dot(direction) > 0.2 { sum } else { direction }
        };
        let [before, after] = [around[0].map(|before| start - before), around[1].map(|after| after - end)];
        Self {
            ends,
            direction,
            length_px: start.distance(end),
            borders: [bisector(before), bisector(after)],
            half_px: WIDTH_M.map(|width_m| 0.5 * (width_m * framing.scale_px_m).max(MIN_WIDTH_PX)),
        }
    }

    fn paint(&self, pixmap: &mut Pixmap, strip: &Strip, colour: Rgb) {
        let [start, end] = self.ends.map(|corner| corner.at_px);
        let reach = Vec2::splat(self.half_px[0] + 1.0);
        let [low, high] = [start.min(end) - reach, start.max(end) + reach];
        let window = PixelWindow::between(low, high, strip);
        let pixels = pixels_mut(pixmap);
        for y in window.rows() {
            let row = strip.row_start(y);
            for x in window.columns() {
                let opacity = self.opacity(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
                if opacity > 0.0 {
                    blend(&mut pixels[row + x], colour, opacity);
                }
            }
        }
    }

    fn opacity(&self, point: Vec2) -> f32 {
        let [start, end] = self.ends.map(|corner| corner.at_px);
        if self.borders[0].dot(point - start) < 0.0 || self.borders[1].dot(point - end) >= 0.0 {
            return 0.0;
        }
        let along = (self.direction.dot(point - start) / self.length_px).clamp(0.0, 1.0);
        let age = (self.ends[0].age + along * (self.ends[1].age - self.ends[0].age)).clamp(0.0, 1.0);
        let half_px = self.half_px[0] + age * (self.half_px[1] - self.half_px[0]);
        let coverage = (half_px + 0.5 - self.direction.perp_dot(point - start).abs()).clamp(0.0, 1.0);
        OPACITY * (1.0 - age) * coverage
    }
}
