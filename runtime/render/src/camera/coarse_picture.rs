//! How well a lens shows a crowd, by pictures of some thousand cells: bodies are upright rectangles, walls are edges with a
//! height. World, metres.
//!
//! The score of a moment is the mean over bodies of the share that is seen, times a weight that grows with the body's size
//! in the picture. What is close before the eye lowers the score by the cells that it covers.

use fbcrowd_sim::maths::polygon;
use fbcrowd_sim::scenario::Scenario;
use glam::{Vec2, Vec3};

use crate::camera::blocks::solids;
use crate::visibility::Lens;

/// Number of cells of a picture, about.
const CELLS: f32 = 2304.0;
/// Greatest number of cells along a side.
const SIDE_MAX: f32 = 256.0;
/// Breadth and height of a body, m.
const BODY_M: Vec2 = Vec2::new(0.5, 1.75);
/// Depth below which bodies and walls are close before the eye, m: a body is about as high as the picture.
const CLOSE_M: f32 = 3.5;
/// Least distance of the eye from walls, m.
const WALL_GAP_M: f32 = 0.5;
/// Heights at which a body is tested against walls, m: shins and chest.
const TESTED_M: [f32; 2] = [0.4, 1.4];
/// Number of bodies of a moment that are tested against walls and counted, about.
const JUDGED: usize = 40;
/// Share of the picture's height at which a body weighs half as much as a large one.
const HALF_WEIGHT: f32 = 0.16;
/// Added to the score of each moment, so that one without a body does not decide alone.
const UNSEEN: f32 = 0.02;
/// Number of rays, from the left to the right edge, that look for close walls.
const RAYS: usize = 9;

/// An obstacle, a door or a fence.
struct Wall<'a> {
    corners_m: &'a [Vec2],
    height_m: f32,
    /// Least and greatest coordinates.
    low_m: Vec2,
    high_m: Vec2,
}

/// Crowd and walls, ready to be seen through any lens.
pub(crate) struct CoarseScene<'a> {
    walls: Vec<Wall<'a>>,
    moments_m: &'a [Vec<Vec2>],
}

/// Size of a coarse picture with the proportions of another one.
pub(crate) fn coarse_size_px(size_px: [u32; 2]) -> [u32; 2] {
    let [width, height] = size_px.map(|side| side.max(1) as f32);
    let scale = (CELLS / (width * height)).sqrt();
    [width, height].map(|side| (scale * side).round().clamp(1.0, SIDE_MAX) as u32)
}

impl<'a> CoarseScene<'a> {
    /// The walls of a scenario, and the positions of bodies at each moment.
    pub(crate) fn new(scenario: &'a Scenario, moments_m: &'a [Vec<Vec2>]) -> Self {
        let wall = |(corners_m, height_m): (&'a [Vec2], f32)| {
            let low_m = corners_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
            let high_m = corners_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
            Wall { corners_m, height_m, low_m, high_m }
        };
        Self { walls: solids(scenario).map(wall).collect(), moments_m }
    }

    /// How well a lens shows the crowd, 0 to 1; 0 from within a wall.
    pub(crate) fn score(&self, lens: &Lens) -> f32 {
        if self.walls.iter().any(|wall| wall.holds(lens.eye_m)) {
            return 0.0;
        }
        // The geometric mean: a crowd that is seen all the time counts more than one that is seen well for half of it.
        let logarithm = |positions_m: &Vec<Vec2>| libm::logf(self.moment_score(lens, positions_m) + UNSEEN);
        let mean = self.moments_m.iter().map(logarithm).sum::<f32>() / self.moments_m.len().max(1) as f32;
        (libm::expf(mean) - UNSEEN).max(0.0) * self.open_share(lens)
    }

    /// Share of the rays across the picture that meet no wall close before the eye.
    fn open_share(&self, lens: &Lens) -> f32 {
        let is_open = |ray: &usize| {
            let across = lens.size().x * (*ray as f32 + 0.5) / RAYS as f32;
            let uv = lens.to_uv(Vec2::new(across, 0.5 * lens.size().y));
            !self.hides(lens.eye_m, lens.to_world(lens.at_depth(uv, CLOSE_M)))
        };
        (0..RAYS).filter(is_open).count() as f32 / RAYS as f32
    }

    fn moment_score(&self, lens: &Lens, positions_m: &[Vec2]) -> f32 {
        let seen = SeenBodies::new(lens, positions_m);
        let step = positions_m.len().div_ceil(JUDGED).max(1);
        let value = |body: usize| {
            let share = seen.share(body);
            if share == 0.0 {
                return 0.0;
            }
            let points_m = TESTED_M.map(|height_m| positions_m[body].extend(height_m));
            let free = points_m.iter().filter(|point_m| !self.hides(lens.eye_m, **point_m)).count();
            let height = seen.heights_px[body] / lens.size().y;
            let weight = height * height / (height * height + HALF_WEIGHT * HALF_WEIGHT);
            weight * share * free as f32 / TESTED_M.len() as f32
        };
        let judged = (0..positions_m.len()).step_by(step);
        let mean = judged.clone().map(value).sum::<f32>() / judged.len().max(1) as f32;
        let open = 1.0 - seen.close_share;
        mean * open * open
    }

    /// Whether a wall is between two points.
    fn hides(&self, eye_m: Vec3, at_m: Vec3) -> bool {
        self.walls.iter().any(|wall| wall.hides(eye_m, at_m))
    }
}

impl Wall<'_> {
    /// Whether a point is in the wall or close to it.
    fn holds(&self, point_m: Vec3) -> bool {
        let on_ground_m = point_m.truncate();
        let is_near = |[from, to]: [Vec2; 2]| {
            let edge = to - from;
            let share = ((on_ground_m - from).dot(edge) / edge.length_squared().max(1e-9)).clamp(0.0, 1.0);
            on_ground_m.distance(from + share * edge) < WALL_GAP_M
        };
        point_m.z < self.height_m + WALL_GAP_M
            && (polygon::contains(self.corners_m, on_ground_m) || edges(self.corners_m).any(is_near))
    }

    /// Whether the segment between two points passes through an edge below its top.
    fn hides(&self, eye_m: Vec3, at_m: Vec3) -> bool {
        let (from_m, to_m) = (eye_m.truncate(), at_m.truncate());
        let is_apart = from_m.max(to_m).cmplt(self.low_m).any() || from_m.min(to_m).cmpgt(self.high_m).any();
        let ray = to_m - from_m;
        let crosses = |[from, to]: [Vec2; 2]| {
            let (side_from, side_to) = (ray.perp_dot(from - from_m), ray.perp_dot(to - from_m));
            let edge = to - from;
            let (side_eye, side_at) = (edge.perp_dot(from_m - from), edge.perp_dot(to_m - from));
            let share = side_eye / (side_eye - side_at);
            side_from * side_to < 0.0
                && side_eye * side_at < 0.0
                && eye_m.z + share * (at_m.z - eye_m.z) < self.height_m
        };
        !is_apart && edges(self.corners_m).any(crosses)
    }
}

fn edges(corners_m: &[Vec2]) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    (0..corners_m.len()).map(|index| [corners_m[index], corners_m[(index + 1) % corners_m.len()]])
}

/// Bodies in a coarse picture, without walls.
struct SeenBodies {
    /// Height of each body; 0 where it is not before the eye.
    heights_px: Vec<f32>,
    /// Cells that each body would cover alone, in a picture of any size.
    whole: Vec<f32>,
    /// Cells in which each body is the nearest.
    seen: Vec<u32>,
    /// Share of the picture that bodies close before the eye cover.
    close_share: f32,
}

impl SeenBodies {
    fn new(lens: &Lens, positions_m: &[Vec2]) -> Self {
        let count = positions_m.len();
        let mut bodies =
            Self { heights_px: vec![0.0; count], whole: vec![0.0; count], seen: vec![0; count], close_share: 0.0 };
        let [width, height] = lens.size_px.map(|side| side as usize);
        // Depth and index of the nearest body of each cell.
        let mut nearest = vec![(f32::INFINITY, usize::MAX); width * height];
        for (body, position_m) in positions_m.iter().enumerate() {
            let head_m = position_m.extend(BODY_M.y);
            let depth_m = lens.to_camera(position_m.extend(0.5 * BODY_M.y)).z;
            let (Some(feet), Some(head)) = (lens.to_px(position_m.extend(0.0)), lens.to_px(head_m)) else { continue };
            let half = 0.5 * BODY_M.x / lens.pixel_m(depth_m);
            let middle = 0.5 * (feet.x + head.x);
            // Seen from above, a body is not lower than broad.
            let top = head.y.min(feet.y - 2.0 * half);
            let columns = cells(middle - half, middle + half);
            let rows = cells(top, feet.y);
            bodies.heights_px[body] = feet.y - top;
            bodies.whole[body] = (columns[1] - columns[0]) * (rows[1] - rows[0]);
            let [columns, rows] = [inside(columns, width), inside(rows, height)];
            for row in rows {
                for cell in &mut nearest[row * width..][columns.clone()] {
                    if depth_m < cell.0 {
                        *cell = (depth_m, body);
                    }
                }
            }
        }
        let covered = nearest.iter().filter(|(_, body)| *body != usize::MAX);
        covered.clone().for_each(|(_, body)| bodies.seen[*body] += 1);
        let close = covered.filter(|(depth_m, _)| *depth_m < CLOSE_M).count();
        bodies.close_share = close as f32 / nearest.len() as f32;
        bodies
    }

    /// Share of a body that is in the picture and not behind others.
    fn share(&self, body: usize) -> f32 {
        self.seen[body] as f32 / self.whole[body].max(1.0)
    }
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
    use super::*;

    /// From 6 m south of the origin, at eye height.
    fn lens() -> Lens {
        Lens::perspective(coarse_size_px([1280, 720]), Vec3::new(0.0, -6.0, 1.65), Vec3::new(0.0, 0.0, 1.15), 1.0)
    }

    fn score(scenario: &Scenario, positions_m: &[Vec2]) -> f32 {
        CoarseScene::new(scenario, &[positions_m.to_vec()]).score(&lens())
    }

    #[test]
    fn bodies_and_walls_before_a_body_hide_it() {
        let mut scenario = Scenario::of(Vec::new());
        let alone = score(&scenario, &[Vec2::ZERO]);
        assert!(alone > 0.6, "{alone}");
        let [hidden, beside] = [0.0, 1.0].map(|x| score(&scenario, &[Vec2::ZERO, Vec2::new(x, -1.0)]));
        assert!(hidden < 0.6 * beside, "{hidden}, {beside}");
        let close = score(&scenario, &[Vec2::ZERO, Vec2::new(0.0, -5.0)]);
        assert!(close < 0.5 * hidden, "{close}, {hidden}");
        scenario.obstacles_m.push([[-9.0, -1.0], [9.0, -1.0], [9.0, -0.9], [-9.0, -0.9]].map(Vec2::from).to_vec());
        let behind = score(&scenario, &[Vec2::ZERO]);
        assert!(behind < 1e-6, "{behind}");
        // A kerb hides the shins only.
        scenario.obstacle_heights_m = vec![Some(0.8)];
        assert!((score(&scenario, &[Vec2::ZERO]) / alone - 0.5).abs() < 1e-3);
    }

    #[test]
    fn coarse_pictures_have_the_proportions_of_fine_ones() {
        assert_eq!(coarse_size_px([1280, 720]), [64, 36]);
        assert_eq!(coarse_size_px([720, 1280]), [36, 64]);
        assert_eq!(coarse_size_px([100_000, 1]), [256, 1]);
    }
}
