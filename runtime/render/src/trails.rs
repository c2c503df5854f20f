//! Where everyone has walked: all root positions of a recording, and the fading ribbon behind each body.

use glam::Vec2;
use tiny_skia::Pixmap;

use crate::cone::{self, Window};
use crate::framing::Framing;
use crate::palette::Rgb;

/// Width of a trail at the body and at its end, m.
const WIDTH_M: [f32; 2] = [0.075, 0.025];
/// Least width, pixels: below it a trail would break into dots.
const MIN_WIDTH_PX: f32 = 1.2;
/// Opacity at the body; it falls to none at the end.
const OPACITY: f32 = 0.60;
/// Shortest piece worth drawing, pixels: bends of a walk show no corners at it.
const PIECE_PX: f32 = 6.0;
/// A brisk walk, m/s, by which [`PIECE_PX`] becomes a number of frames.
const BRISK_MPS: f32 = 1.5;

/// Root positions of every agent in every recorded frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Tracks {
    /// Agents in each frame.
    pub agent_count: usize,
    /// Seconds between recorded frames.
    pub dt_s: f32,
    /// Frame after frame, in each the agents by index; world, metres.
    pub positions_m: Vec<Vec2>,
}

impl Tracks {
    /// Number of recorded frames.
    pub fn frame_count(&self) -> usize {
        self.positions_m.len().checked_div(self.agent_count).unwrap_or(0)
    }

    /// All agents in one frame.
    pub fn frame_m(&self, frame: usize) -> &[Vec2] {
        &self.positions_m[frame * self.agent_count..][..self.agent_count]
    }

    /// One agent over all frames.
    pub fn agent_m(&self, agent: usize) -> impl Iterator<Item = Vec2> {
        self.positions_m.iter().skip(agent).step_by(self.agent_count.max(1)).copied()
    }
}

/// One corner of a ribbon.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at_px: Vec2,
    /// 0 at the body, 1 at the trail's end.
    age: f32,
}

/// Draws the trail of one agent: its last `trail_s` seconds before `time_s`, up to where it stands now.
pub fn draw(
    pixmap: &mut Pixmap,
    framing: &Framing,
    tracks: &Tracks,
    agent: usize,
    now: (f32, Vec2),
    trail_s: f32,
    colour: Rgb,
) {
    let corners = corners(framing, tracks, agent, now, trail_s);
    for index in 1..corners.len() {
        let before = index.checked_sub(2).map(|before| corners[before].at_px);
        let after = corners.get(index + 1).map(|corner| corner.at_px);
        draw_piece(pixmap, framing, [corners[index - 1], corners[index]], [before, after], colour);
    }
}

/// From the body backwards. Corners sit on fixed recorded frames, so that the ribbon does not crawl from picture to picture.
fn corners(framing: &Framing, tracks: &Tracks, agent: usize, now: (f32, Vec2), trail_s: f32) -> Vec<Corner> {
    let (time_s, position_m) = now;
    let stride = ((PIECE_PX / (BRISK_MPS * tracks.dt_s * framing.scale_px_m)).round() as usize).max(1);
    let newest = ((time_s / tracks.dt_s) as usize).min(tracks.frame_count().saturating_sub(1));
    let oldest = ((time_s - trail_s).max(0.0) / tracks.dt_s).ceil() as usize;
    let mut corners = vec![Corner { at_px: framing.to_px(position_m), age: 0.0 }];
    for frame in (oldest..=newest).rev().filter(|frame| frame % stride == 0) {
        let at_px = framing.to_px(tracks.frame_m(frame)[agent]);
        let age = (time_s - frame as f32 * tracks.dt_s) / trail_s;
        let moved = corners.last().is_none_or(|last| last.at_px.distance_squared(at_px) > 0.01);
        if moved && at_px.is_finite() {
            corners.push(Corner { at_px, age });
        }
    }
    corners
}

/// One piece between two corners. Where pieces meet, the bisector of their directions parts them, so that no pixel is painted twice.
fn draw_piece(pixmap: &mut Pixmap, framing: &Framing, ends: [Corner; 2], around: [Option<Vec2>; 2], colour: Rgb) {
    let [start, end] = ends.map(|corner| corner.at_px);
    let direction = (end - start).normalize_or_zero();
    let bisector = |other: Option<Vec2>| {
        let sum = other.map_or(Vec2::ZERO, |other| other.normalize_or_zero()) + direction;
        if sum.dot(direction) > 0.2 { sum } else { direction }
    };
    let [enter, leave] =
        [bisector(around[0].map(|before| start - before)), bisector(around[1].map(|after| after - end))];
    let half_px = |age: f32| {
        let width_m = WIDTH_M[0] + age * (WIDTH_M[1] - WIDTH_M[0]);
        0.5 * (width_m * framing.scale_px_m).max(MIN_WIDTH_PX)
    };
    let reach = Vec2::splat(half_px(0.0) + 1.0);
    let window = Window::between(start.min(end) - reach, start.max(end) + reach, pixmap.width(), pixmap.height());
    let width = pixmap.width() as usize;
    let length = start.distance(end);
    let pixels = cone::pixels_mut(pixmap);
    for y in window.rows() {
        for x in window.columns() {
            let point = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            if enter.dot(point - start) < 0.0 || leave.dot(point - end) >= 0.0 {
                continue;
            }
            let along = (direction.dot(point - start) / length).clamp(0.0, 1.0);
            let age = ends[0].age + along * (ends[1].age - ends[0].age);
            let coverage = (half_px(age) + 0.5 - direction.perp_dot(point - start).abs()).clamp(0.0, 1.0);
            let opacity = OPACITY * (1.0 - age).clamp(0.0, 1.0) * coverage;
            if opacity > 0.0 {
                let pixel = &mut pixels[y * width + x];
                *pixel = cone::to_pixel(cone::to_vec(*pixel).lerp(colour, opacity));
            }
        }
    }
}
