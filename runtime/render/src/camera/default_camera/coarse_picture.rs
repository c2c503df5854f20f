//! How well a lens shows a crowd at a moment, by a picture of some thousand cells. A body is an upright rectangle of two
//! strips, left and right, each as high as walls leave it seen. World, metres.
//!
//! The score grows with the number of bodies that are seen well, S, as S / (S + constant): some tens fill a picture, and
//! of a small crowd all are wanted. S is the sum over bodies of the share that is seen, times weights that grow with the
//! body's size in the picture, and as it faces the eye. Bodies that the picture's edge cuts lower the score.

use glam::Vec2;

use crate::camera::default_camera::cell_rows::CellRows;
use crate::camera::default_camera::crowd::{CrowdBody, CrowdMoment};
use crate::camera::default_camera::walls::Walls;
use crate::visibility::Lens;

/// Number of cells of a picture, about.
const CELLS: f32 = 2304.0;
/// Greatest number of cells along a side.
const SIDE_MAX: f32 = 256.0;
/// Breadth of a body over its height.
const BREADTH: f32 = 0.28;
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
    let seen = SeenBodies::new(lens, walls, bodies);
    let value = |index: usize| {
        let share = seen.shares[index];
        let to_eye = (lens.eye_m.truncate() - bodies[index].position_m).normalize_or_zero();
        let facing = BACK + (1.0 - BACK) * (0.5 + 0.5 * bodies[index].ahead.dot(to_eye));
        let height = seen.heights_px[index] / lens.size().y;
        let weight = height * height / (height * height + HALF_WEIGHT * HALF_WEIGHT);
        weight * facing * share
    };
    let mean = (0..bodies.len()).map(value).sum::<f32>() / bodies.len().max(1) as f32;
    let present = moment.present as f32;
    // 1 where all are seen well.
    let count = mean * (present + HALF_COUNT) / (mean * present + HALF_COUNT);
    let whole = 1.0 - CUT_LOSS * seen.cut_share;
    let balance = 1.0 - UNBALANCED_LOSS * seen.middle.abs().max_element();
    count * whole * whole * balance * seen.spread / (seen.spread + HALF_SPREAD)
}

/// Bodies in a coarse picture.
struct SeenBodies {
    /// Height of each body; 0 where it is not before the eye.
    heights_px: Vec<f32>,
    /// Share of each body that is in the picture, and behind neither walls nor other bodies.
    shares: Vec<f32>,
    /// Share of the bodies that the picture's edge cuts, weighted by their height.
    cut_share: f32,
    /// Middle of all cells in which bodies are seen, from that of the picture, of half its size.
    middle: Vec2,
    /// Standard deviation of their height in the picture, of its height.
    spread: f32,
}

/// A body in a picture, walls aside.
struct BodyOutline {
    index: usize,
    depth_m: f32,
    low_px: Vec2,
    high_px: Vec2,
}

impl BodyOutline {
    /// None where it is not before the eye.
    fn new(lens: &Lens, index: usize, body: &CrowdBody) -> Option<Self> {
        let CrowdBody { position_m, height_m, .. } = *body;
        let depth_m = lens.to_camera(position_m.extend(0.5 * height_m)).z;
        let [feet, head] = [lens.to_px(position_m.extend(0.0))?, lens.to_px(position_m.extend(height_m))?];
        let half = 0.5 * BREADTH * height_m / lens.pixel_m(depth_m);
        let middle = 0.5 * (feet.x + head.x);
        // Seen from above, a body is not lower than broad.
        let top = head.y.min(feet.y - 2.0 * half);
        Some(Self { index, depth_m, low_px: Vec2::new(middle - half, top), high_px: Vec2::new(middle + half, feet.y) })
    }

    fn height_px(&self) -> f32 {
        self.high_px.y - self.low_px.y
    }

    /// Whether an edge of the picture cuts it.
    fn is_cut(&self, lens: &Lens) -> bool {
        let least = CUT * (self.high_px - self.low_px);
        self.low_px.cmplt(-least).any() || self.high_px.cmpgt(lens.size() + least).any()
    }
}

impl SeenBodies {
    fn new(lens: &Lens, walls: &Walls, bodies: &[CrowdBody]) -> Self {
        let [mut heights_px, mut shares] = [(); 2].map(|()| vec![0.0; bodies.len()]);
        let outline = |(index, body)| BodyOutline::new(lens, index, body);
        let mut outlines: Vec<BodyOutline> = bodies.iter().enumerate().filter_map(outline).collect();
        outlines.sort_unstable_by(|a, b| a.depth_m.total_cmp(&b.depth_m));
        let mut picture = CellRows::new(lens.size_px);
        let (mut cut_px, mut all_px) = (0.0, 0.0);
        for outline in &outlines {
            let body = &bodies[outline.index];
            let [columns, rows] = [0, 1].map(|axis| cells(outline.low_px[axis], outline.high_px[axis]));
            heights_px[outline.index] = outline.height_px();
            if !picture.holds_any(columns, rows) {
                continue;
            }
            let middle = columns[0].midpoint(columns[1]).floor();
            let strips = [[columns[0], middle], [middle, columns[1]]].into_iter().filter(|[from, to]| from < to);
            let (mut is_seen, mut covered) = (false, 0);
            for strip in strips {
                // Where its middle is across the body, of the breadth.
                let across =
                    (0.5 * (strip[0] + strip[1]) - 0.5 * (columns[0] + columns[1])) / (columns[1] - columns[0]);
                let aside_m = across * BREADTH * body.height_m * lens.right.truncate();
                let hidden_m = walls.seen_from_m(lens.eye_m, body.position_m + aside_m, body.height_m);
                let seen = 1.0 - hidden_m / body.height_m;
                if seen > 0.0 {
                    is_seen = true;
                    covered += picture.cover(strip, [rows[0], rows[0] + (seen * (rows[1] - rows[0])).round()]);
                }
            }
            shares[outline.index] = covered as f32 / ((columns[1] - columns[0]) * (rows[1] - rows[0]));
            if is_seen {
                all_px += outline.height_px();
                cut_px += if outline.is_cut(lens) { outline.height_px() } else { 0.0 };
            }
        }
        let (middle, spread) = picture.middle_and_spread();
        let cut_share = if all_px > 0.0 { cut_px / all_px } else { 0.0 };
        Self { heights_px, shares, cut_share, middle, spread }
    }
}

/// First cell of a range and the one after its last, at least one cell.
fn cells(low: f32, high: f32) -> [f32; 2] {
    let first = low.round();
    [first, high.round().max(first + 1.0)]
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
            positions_m.iter().map(|position_m| CrowdBody { position_m: *position_m, ahead, height_m: 1.75 }).collect();
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
        // A kerb hides the shins only: up to 0.63 m of 1.75 m.
        scenario.obstacle_heights_m = vec![Some(0.8)];
        let over_kerb = score_of(&scenario, &[Vec2::ZERO]) / alone;
        assert!((over_kerb - 0.64).abs() < 0.1, "{over_kerb}");
        // A wall before the left half of the body hides this half.
        scenario.obstacles_m = vec![[[-9.0, -1.0], [0.0, -1.0], [0.0, -0.9], [-9.0, -0.9]].map(Vec2::from).to_vec()];
        scenario.obstacle_heights_m = vec![Some(2.4)];
        let right_half = score_of(&scenario, &[Vec2::ZERO]) / alone;
        assert!((right_half - 0.5).abs() < 0.1, "{right_half}");
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
