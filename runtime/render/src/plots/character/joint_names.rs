//! Marks on the joints of a character that have a role, lines between them, and their names in two columns. Pixels.

use glam::Vec2;
use motiondb::body::{JOINT_COUNT, Joint, Side};
use motiondb::character::Character;
use tiny_skia::Pixmap;

use crate::raster::paint::{circle, fill, fill_rect, paint, path_through, round_stroke, stroke};
use crate::raster::palette::{INK, PAPER, Rgb, SIDES};
use crate::raster::text::{TextAnchor, Typeface};

/// Width of a column of names, pixels.
pub(super) const NAMES_PX: f32 = 330.0;
/// Height of letters, and distance of lines.
pub(super) const LETTERS_PX: [f32; 2] = [19.0, 27.0];
/// Radius of a joint's mark, and of its rim.
const MARK_PX: [f32; 2] = [4.5, 6.0];
/// Opacity of the lines between joints.
const BONE_OPACITY: f32 = 0.75;

/// Marks the joints of a figure.
pub(super) fn draw_joints(picture: &mut Pixmap, character: &Character, joints_px: &[Option<Vec2>; JOINT_COUNT]) {
    let px = |role: Joint| joints_px[role.index()];
    for role in Joint::ALL {
        let above = character.role_above(role).and_then(px);
        if let (Some(from), Some(to)) = (above, px(role))
            && let Some(path) = path_through([from, to], false)
        {
            stroke(picture, &path, &paint(PAPER, BONE_OPACITY), &round_stroke(2.0), None);
        }
    }
    for role in Joint::ALL {
        for (radius, colour) in [(MARK_PX[1], PAPER), (MARK_PX[0], colour(role))] {
            if let Some(path) = px(role).and_then(|at| circle(at, radius)) {
                fill(picture, &path, &paint(colour, 1.0), None);
            }
        }
    }
}

/// Colour of a role: that of its side; ink in the middle.
fn colour(role: Joint) -> Rgb {
    let is_of = |side: &Side| role.name().starts_with(if *side == Side::Left { "left" } else { "right" });
    Side::BOTH.into_iter().find(is_of).map_or(INK, |side| SIDES[side.index()])
}

/// Writes role and joint beside a figure that faces the eye, with a line to each joint. `columns_px` are the right end of
/// the left column and the left end of the right one.
pub(super) fn draw_names(
    picture: &mut Pixmap,
    character: &Character,
    joints_px: &[Option<Vec2>; JOINT_COUNT],
    columns_px: [f32; 2],
) {
    let face = Typeface::new(LETTERS_PX[0]);
    let (mut left, mut right) = (Vec::new(), Vec::new());
    for role in Joint::ALL {
        let Some((joint, px)) = character.joint(role).zip(joints_px[role.index()]) else { continue };
        let text = format!("{}: {}", role.name(), character.joints[joint].name);
        // Its right side is on the picture's left. The trunk fills the shorter column.
        let is_left = if colour(role) == INK { left.len() <= right.len() } else { colour(role) == SIDES[1] };
        if is_left { &mut left } else { &mut right }.push((px, text, colour(role)));
    }
    for (mut column, (x, anchor)) in
        [left, right].into_iter().zip(columns_px.into_iter().zip([TextAnchor::Right, TextAnchor::Left]))
    {
        column.sort_by(|(one, ..), (other, ..)| one.y.total_cmp(&other.y));
        let wished: Vec<f32> = column.iter().map(|(px, ..)| px.y).collect();
        let lines = spread(&wished, LETTERS_PX[1], picture.height() as f32 - LETTERS_PX[0]);
        for ((px, text, colour), y) in column.into_iter().zip(lines) {
            let end = Vec2::new(x, y);
            if let Some(path) = path_through([end, px], false) {
                stroke(picture, &path, &paint(colour, 0.45), &round_stroke(1.2), None);
            }
            draw_text(picture, &face, &face.fitted(&text, NAMES_PX), end, anchor);
        }
    }
}

/// Writes a text on a strip of paper, its end or middle at a point.
pub(super) fn draw_text(picture: &mut Pixmap, face: &Typeface, text: &str, at_px: Vec2, anchor: TextAnchor) {
    let (width, height) = (face.width_px(text) + 12.0, LETTERS_PX[1] - 2.0);
    let share = match anchor {
        TextAnchor::Left => 0.0,
        TextAnchor::Centre => 0.5,
        TextAnchor::Right => 1.0,
    };
    let left = at_px.x - share * width;
    fill_rect(picture, [left, at_px.y - 0.5 * height, width, height], PAPER, 0.82);
    face.draw(picture, text, Vec2::new(left + 6.0, at_px.y + 0.33 * LETTERS_PX[0]), TextAnchor::Left, INK);
}

/// Heights near wished ones, which rise, at least a step apart, and at most `most`.
fn spread(wished: &[f32], step: f32, most: f32) -> Vec<f32> {
    let mut heights = wished.to_vec();
    for index in 1..heights.len() {
        heights[index] = heights[index].max(heights[index - 1] + step);
    }
    // What was pushed down comes half the distance back up.
    let excess: f32 = heights.iter().zip(wished).map(|(height, wish)| height - wish).fold(0.0, f32::max);
    let lift = (0.5 * excess).max(heights.last().map_or(0.0, |last| last - most));
    heights.iter_mut().for_each(|height| *height -= lift);
    for index in (0..heights.len().saturating_sub(1)).rev() {
        heights[index] = heights[index].min(heights[index + 1] - step);
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lie_a_line_apart_and_in_the_picture() {
        let heights = spread(&[100.0, 102.0, 103.0, 390.0, 398.0], 20.0, 400.0);
        assert!(heights.windows(2).all(|pair| pair[1] - pair[0] >= 20.0 - 1e-3), "{heights:?}");
        assert!(heights[0] > 60.0 && heights[4] <= 400.0, "{heights:?}");
        assert_eq!(spread(&[10.0, 50.0], 20.0, 400.0), [10.0, 50.0]);
    }
}
