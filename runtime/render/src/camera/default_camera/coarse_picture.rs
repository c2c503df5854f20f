//! How well a lens shows a crowd at a moment, by a picture of some thousand cells: bodies are upright rectangles, walls
//! are edges with a height. World, metres.
//!
//! The score grows with the number of bodies that are seen well, S, as S / (S + constant): some tens fill a picture, and
//! of a small crowd all are wanted. S is the sum over bodies of the share that is seen, times weights that grow with the
//! body's size in the picture, and as it faces the eye. Bodies that the picture's edge cuts lower the score.

use glam::Vec2;

use crate::camera::default_camera::crowd::{CrowdBody, CrowdMoment};
use crate::camera::default_camera::walls::Walls;
use crate::visibility::Lens;

/// Number of cells of a picture, about.
const CELLS: f32 = 2304.0;
/// Greatest number of cells along a side.
const SIDE_MAX: f32 = 256.0;
/// Breadth and height of a body, m.
const BODY_M: Vec2 = Vec2::new(0.5, 1.75);
/// Heights at which a body is tested against walls, m: shins and chest.
const TESTED_M: [f32; 2] = [0.4, 1.4];
/// Number of bodies, seen well, that make half a picture of a large crowd.
const HALF_COUNT: f32 = 20.0;
/// Share of the picture's height at which a body weighs half as much as a large one.
const HALF_WEIGHT: f32 = 0.17;
/// What a body counts that turns its back.
const BACK: f32 = 0.65;
/// What the score loses where edges of the picture cut all bodies.
const CUT_LOSS: f32 = 0.6;
/// Least part of a body beyond an edge that cuts it, of its height or breadth.
const CUT: f32 = 0.08;
/// What the score loses where all bodies are at an edge.
const UNBALANCED_LOSS: f32 = 0.5;
/// Spread of what is seen, standard deviation over the picture's height, at which the score is halved: a thin line of
/// bodies leaves the picture empty.
const HALF_SPREAD: f32 = 0.03;

/// Size of a coarse picture with the proportions of another one.
pub(super) fn coarse_size_px(size_px: [u32; 2]) -> [u32; 2] {
    let [width, height] = size_px.map(|side| side.max(1) as f32);
    let scale = (CELLS / (width * height)).sqrt();
    [width, height].map(|side| (scale * side).round().clamp(1.0, SIDE_MAX) as u32)
}

/// How well a lens shows a crowd between walls, 0 to 1; 0 from within a wall.
pub(super) fn score(lens: &Lens, walls: &Walls, moment: &CrowdMoment) -> f32 {
    let bodies = &moment.bodies;
    if walls.hold(lens.eye_m) {
        return 0.0;
    }
    let seen = SeenBodies::new(lens, bodies);
    let value = |index: usize| {
        let share = seen.share(index);
        if share == 0.0 {
            return 0.0;
        }
        let position_m = bodies[index].position_m;
        let points_m = TESTED_M.map(|height_m| position_m.extend(height_m));
        let free = points_m.iter().filter(|point_m| !walls.hide(lens.eye_m, **point_m)).count();
        let to_eye = (lens.eye_m.truncate() - position_m).normalize_or_zero();
        let facing = BACK + (1.0 - BACK) * (0.5 + 0.5 * bodies[index].ahead.dot(to_eye));
        let height = seen.heights_px[index] / lens.size().y;
        let weight = height * height / (height * height + HALF_WEIGHT * HALF_WEIGHT);
        weight * facing * share * free as f32 / TESTED_M.len() as f32
    };
    let mean = (0..bodies.len()).map(value).sum::<f32>() / bodies.len().max(1) as f32;
    let present = moment.present as f32;
    // 1 where all are seen well.
    let count = mean * (present + HALF_COUNT) / (mean * present + HALF_COUNT);
    let whole = 1.0 - CUT_LOSS * seen.cut_share;
    let balance = 1.0 - UNBALANCED_LOSS * seen.middle.abs().max_element();
    count * whole * whole * balance * seen.spread / (seen.spread + HALF_SPREAD)
}

/// Bodies in a coarse picture, without walls.
struct SeenBodies {
    /// Height of each body; 0 where it is not before the eye.
    heights_px: Vec<f32>,
    /// Cells that each body would cover alone, in a picture of any size.
    whole: Vec<f32>,
    /// Cells in which each body is the nearest.
    seen: Vec<u32>,
    /// Share of the bodies that the picture's edge cuts, weighted by their height.
    cut_share: f32,
    /// Middle of all cells in which bodies are seen, from that of the picture, of half its size.
    middle: Vec2,
    /// Standard deviation of their height in the picture, of its height.
    spread: f32,
}

impl SeenBodies {
    fn new(lens: &Lens, bodies: &[CrowdBody]) -> Self {
        let count = bodies.len();
        let mut drawn = Self {
            heights_px: vec![0.0; count],
            whole: vec![0.0; count],
            seen: vec![0; count],
            cut_share: 0.0,
            middle: Vec2::ZERO,
            spread: 0.0,
        };
        let [width, height] = lens.size_px.map(|side| side as usize);
        // Depth and index of the nearest body of each cell.
        let mut nearest = vec![(f32::INFINITY, usize::MAX); width * height];
        let (mut cut_px, mut all_px) = (0.0, 0.0);
        for (index, CrowdBody { position_m, .. }) in bodies.iter().enumerate() {
            let depth_m = lens.to_camera(position_m.extend(0.5 * BODY_M.y)).z;
            let [feet, head] = [0.0, BODY_M.y].map(|height_m: f32| lens.to_px(position_m.extend(height_m)));
            let (Some(feet), Some(head)) = (feet, head) else { continue };
            let half = 0.5 * BODY_M.x / lens.pixel_m(depth_m);
            let middle = 0.5 * (feet.x + head.x);
            // Seen from above, a body is not lower than broad.
            let top = head.y.min(feet.y - 2.0 * half);
            let columns = cells(middle - half, middle + half);
            let rows = cells(top, feet.y);
            let height_px = feet.y - top;
            drawn.heights_px[index] = height_px;
            drawn.whole[index] = (columns[1] - columns[0]) * (rows[1] - rows[0]);
            let [columns, rows] = [inside(columns, width), inside(rows, height)];
            if !columns.is_empty() && !rows.is_empty() {
                all_px += height_px;
                if is_cut(lens, Vec2::new(middle - half, top), Vec2::new(middle + half, feet.y)) {
                    cut_px += height_px;
                }
            }
            for row in rows {
                for cell in &mut nearest[row * width..][columns.clone()] {
                    if depth_m < cell.0 {
                        *cell = (depth_m, index);
                    }
                }
            }
        }
        let (mut covered, mut sum, mut squares) = (0.0, Vec2::ZERO, 0.0);
        for (cell, (_, index)) in nearest.iter().enumerate().filter(|(_, (_, index))| *index != usize::MAX) {
            drawn.seen[*index] += 1;
            let at = (Vec2::new((cell % width) as f32, (cell / width) as f32) + 0.5) / lens.size();
            (covered, sum, squares) = (covered + 1.0, sum + at, squares + at.y * at.y);
        }
        if covered > 0.0 {
            let mean = sum / covered;
            drawn.middle = 2.0 * mean - 1.0;
            drawn.spread = (squares / covered - mean.y * mean.y).max(0.0).sqrt();
        }
        drawn.cut_share = if all_px > 0.0 { cut_px / all_px } else { 0.0 };
        drawn
    }

    /// Share of a body that is in the picture and not behind others.
    fn share(&self, index: usize) -> f32 {
        self.seen[index] as f32 / self.whole[index].max(1.0)
    }
}

/// Whether an edge of the picture cuts a body with these corners.
fn is_cut(lens: &Lens, low: Vec2, high: Vec2) -> bool {
    let least = CUT * (high - low);
    low.cmplt(-least).any() || high.cmpgt(lens.size() + least).any()
}

/// First cell of a range and the one after its last, at least one cell.
fn cells(low: f32, high: f32) -> [f32; 2] {
    let first = low.round();
    [first, high.round().max(first + 1.0)]
}

/// The part of a range of cells that is in a picture.
fn inside([first, end]: [f32; 2], side: usize) -> std::ops::Range<usize> {
    let end = (end.max(0.0) as usize).min(side);
    (first.max(0.0) as usize).min(end)..end
}

#[cfg(test)]
mod tests {
    use fbcrowd_sim::scenario::Scenario;
    use glam::Vec3;

    use super::*;

    /// From 6 m south of the origin, at eye height.
    fn lens() -> Lens {
        Lens::perspective(coarse_size_px([1280, 720]), Vec3::new(0.0, -6.0, 1.65), Vec3::new(0.0, 0.0, 1.15), 1.0)
    }

    fn score_facing(scenario: &Scenario, positions_m: &[Vec2], ahead: Vec2) -> f32 {
        let bodies: Vec<CrowdBody> =
            positions_m.iter().map(|position_m| CrowdBody { position_m: *position_m, ahead }).collect();
        let moment = CrowdMoment { time_s: 0.0, centre_m: Vec2::ZERO, present: bodies.len(), bodies };
        score(&lens(), &Walls::new(scenario), &moment)
    }

    fn score_of(scenario: &Scenario, positions_m: &[Vec2]) -> f32 {
        score_facing(scenario, positions_m, Vec2::NEG_Y)
    }

    #[test]
    fn bodies_and_walls_before_a_body_hide_it() {
        let mut scenario = Scenario::of(Vec::new());
        let alone = score_of(&scenario, &[Vec2::ZERO]);
        assert!(alone > 0.6, "{alone}");
        let [hidden, beside] = [0.0, 1.0].map(|x| score_of(&scenario, &[Vec2::ZERO, Vec2::new(x, -1.0)]));
        assert!(hidden < 0.7 * beside, "{hidden}, {beside}");
        let close = score_of(&scenario, &[Vec2::ZERO, Vec2::new(0.0, -5.0)]);
        assert!(close < 0.5 * hidden, "{close}, {hidden}");
        scenario.obstacles_m.push([[-9.0, -1.0], [9.0, -1.0], [9.0, -0.9], [-9.0, -0.9]].map(Vec2::from).to_vec());
        let behind = score_of(&scenario, &[Vec2::ZERO]);
        assert!(behind < 1e-6, "{behind}");
        // A kerb hides the shins only.
        scenario.obstacle_heights_m = vec![Some(0.8)];
        assert!((score_of(&scenario, &[Vec2::ZERO]) / alone - 0.5).abs() < 0.02);
    }

    #[test]
    fn some_tens_of_bodies_fill_the_picture_of_a_large_crowd() {
        let walls = Scenario::of(Vec::new());
        let seen: Vec<Vec2> = (0..8).map(|index| Vec2::new(0.5 * f32::from(index as u8) - 1.75, 0.0)).collect();
        // As many again, and ten times as many, behind the eye.
        let score_with = |hidden: usize| score_of(&walls, &[seen.clone(), vec![Vec2::new(0.0, -9.0); hidden]].concat());
        let [all, half, tenth] = [0, 8, 72].map(score_with);
        assert!(half > 0.55 * all && tenth > 0.2 * all && tenth < half, "{all}, {half}, {tenth}");
    }

    #[test]
    fn backs_cut_bodies_and_corners_of_the_picture_count_less() {
        let scenario = Scenario::of(Vec::new());
        let middle = score_of(&scenario, &[Vec2::ZERO]);
        let back = score_facing(&scenario, &[Vec2::ZERO], Vec2::Y);
        assert!((back / middle - BACK).abs() < 0.02, "{back}, {middle}");
        let [aside, cut] = [2.4, 3.1].map(|x| score_of(&scenario, &[Vec2::new(x, 0.0)]));
        assert!(aside < 0.8 * middle && cut < 0.5 * aside, "{middle}, {aside}, {cut}");
    }

    #[test]
    fn coarse_pictures_have_the_proportions_of_fine_ones() {
        assert_eq!(coarse_size_px([1280, 720]), [64, 36]);
        assert_eq!(coarse_size_px([720, 1280]), [36, 64]);
        assert_eq!(coarse_size_px([100_000, 1]), [256, 1]);
    }
}
