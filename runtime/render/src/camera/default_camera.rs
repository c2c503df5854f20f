//! A camera for a recording whose scenario states none: at eye height, with the sun behind it, where it sees most of the
//! crowd. A few frames are read. World, metres.

use fbcrowd_sim::recording::{Recording, duration_s, sample};
use fbcrowd_sim::scenario::{CameraSpec, Scenario};
use glam::Vec2;

use crate::error::RenderError;

/// Name of the camera in captions.
pub(crate) const DEFAULT_NAME: &str = "default";
/// Height of the eyes of an adult, m.
const EYE_HEIGHT_M: f32 = 1.65;
/// Height that the camera looks at, m.
const TARGET_HEIGHT_M: f32 = 1.15;
/// Focal length on 36 mm film, mm: a slight wide angle.
const FOCAL_MM: f32 = 35.0;
/// Number of moments that are read, from the first to the last frame.
const MOMENTS: u32 = 7;
/// Share of the picture's width within which a body is framed.
const FRAMED: f32 = 0.86;
/// Directions that are tried, from the middle of the crowd to the camera: the sun stands in the south-west.
const DIRECTIONS: [Vec2; 7] = [
    Vec2::new(-0.12, -1.0),
    Vec2::new(-0.7, -0.7),
    Vec2::new(0.6, -0.8),
    Vec2::new(-1.0, -0.1),
    Vec2::new(1.0, -0.2),
    Vec2::new(-0.8, 0.6),
    Vec2::new(0.6, 0.8),
];
/// Share of its score that a direction after another must exceed.
const BETTER: f32 = 1.15;
/// Distances that are tried, in extents of the crowd.
const EXTENTS: [f32; 5] = [1.1, 0.75, 1.6, 2.2, 0.5];
/// Least and greatest distance of the camera from the middle of the crowd, m: farther away people are specks.
const DISTANCE_M: [f32; 2] = [4.5, 32.0];
/// Distance at which a body counts half as much as a near one, m.
const FAR_M: f32 = 14.0;
/// Least distance of bodies from the camera, m.
const CLEAR_M: f32 = 2.0;

/// The camera of a recording without one, for frames from a time on, s.
///
/// # Errors
/// If a frame cannot be read.
pub(crate) fn default_camera(recording: &Recording, start_s: f64) -> Result<CameraSpec, RenderError> {
    let (end_s, mut moments_m) = (duration_s(recording), Vec::new());
    for moment in 0..MOMENTS {
        let share = f64::from(moment) / f64::from(MOMENTS - 1);
        let agents = sample(recording, start_s + share * (end_s - start_s).max(0.0))?;
        if !agents.is_empty() {
            moments_m.push(agents.iter().map(|agent| agent.root.position_m).collect());
        }
    }
    let [eye_m, target_m] = eye_and_target_m(&recording.header().scenario, &moments_m);
    Ok(CameraSpec {
        name: DEFAULT_NAME.to_owned(),
        eye_m: Some(eye_m.extend(EYE_HEIGHT_M)),
        look_at_m: Some(target_m.extend(TARGET_HEIGHT_M)),
        focal_mm: Some(FOCAL_MM),
        ..CameraSpec::default()
    })
}

/// Where the camera stands and looks, for the positions of bodies at each moment.
fn eye_and_target_m(scenario: &Scenario, moments_m: &[Vec<Vec2>]) -> [Vec2; 2] {
    let [low_m, high_m] = middle_box_m(&moments_m.concat());
    let target_m = low_m.midpoint(high_m);
    let extent_m = (high_m - low_m).max_element();
    let mut best = (0.0, [target_m - Vec2::Y * DISTANCE_M[0], target_m]);
    for extents in EXTENTS {
        for direction in DIRECTIONS {
            let distance_m = (extents * extent_m).clamp(DISTANCE_M[0], DISTANCE_M[1]);
            let eye_m = target_m + distance_m * direction.normalize();
            let score = score(scenario, moments_m, eye_m, target_m);
            if score > BETTER * best.0 {
                best = (score, [eye_m, target_m]);
            }
        }
    }
    best.1
}

/// The box that holds all but the outermost tenth of the positions on each side, m.
fn middle_box_m(positions_m: &[Vec2]) -> [Vec2; 2] {
    let range = |axis: usize| {
        let mut along: Vec<f32> = positions_m.iter().map(|position_m| position_m[axis]).collect();
        along.sort_by(f32::total_cmp);
        let cut = along.len() / 10;
        let end = along.len().saturating_sub(1);
        [along.get(cut).copied().unwrap_or(0.0), along.get(end - cut.min(end)).copied().unwrap_or(0.0)]
    };
    let ([left, right], [front, back]) = (range(0), range(1));
    [Vec2::new(left, front), Vec2::new(right, back)]
}

/// How well a crowd is seen over all moments: the mean share of bodies that are seen, near ones counting more, and the
/// share that the worst moment frames; 0 from within a wall.
fn score(scenario: &Scenario, moments_m: &[Vec<Vec2>], eye_m: Vec2, target_m: Vec2) -> f32 {
    let solids = || scenario.obstacles_m.iter().chain(scenario.doors.iter().map(|door| &door.polygon_m));
    if solids().any(|corners_m| is_near(corners_m, eye_m)) {
        return 0.0;
    }
    let ahead = (target_m - eye_m).normalize_or_zero();
    let half_tangent = FRAMED * 0.5 * 36.0 / FOCAL_MM;
    // Whether a body is framed, and how much it counts.
    let seen = |position_m: &Vec2| {
        let offset = *position_m - eye_m;
        let depth_m = offset.dot(ahead);
        if offset.length() < CLEAR_M {
            return (0.0, -1.5);
        }
        let is_framed = depth_m > CLEAR_M && offset.perp_dot(ahead).abs() < half_tangent * depth_m;
        if !is_framed || solids().any(|corners_m| crosses(corners_m, eye_m, *position_m)) {
            return (0.0, 0.0);
        }
        (1.0, FAR_M / (FAR_M + depth_m))
    };
    let (mut worst, mut sum) = (1.0_f32, 0.0);
    for positions_m in moments_m {
        // At most some hundred bodies decide, at even steps.
        let step = (positions_m.len() * moments_m.len() / 400).max(1);
        let bodies = || positions_m.iter().step_by(step);
        let (framed, weight) = bodies().map(seen).fold((0.0, 0.0), |sum, body| (sum.0 + body.0, sum.1 + body.1));
        let count = bodies().count() as f32;
        worst = worst.min(framed / count);
        sum += weight / count;
    }
    (sum * (0.25 + 0.75 * worst)).max(0.0)
}

fn edges(corners_m: &[Vec2]) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    (0..corners_m.len()).map(|index| [corners_m[index], corners_m[(index + 1) % corners_m.len()]])
}

/// Whether a point lies in a polygon or within half a metre of it.
fn is_near(corners_m: &[Vec2], point_m: Vec2) -> bool {
    let mut is_inside = false;
    for [from, to] in edges(corners_m) {
        let edge = to - from;
        let share = ((point_m - from).dot(edge) / edge.length_squared().max(1e-9)).clamp(0.0, 1.0);
        if point_m.distance(from + share * edge) < 0.5 {
            return true;
        }
        if (from.y > point_m.y) != (to.y > point_m.y) {
            is_inside ^= from.x + (point_m.y - from.y) / (to.y - from.y) * edge.x > point_m.x;
        }
    }
    is_inside
}

/// Whether the segment between two points crosses an edge.
fn crosses(corners_m: &[Vec2], eye_m: Vec2, at_m: Vec2) -> bool {
    let ray = at_m - eye_m;
    edges(corners_m).any(|[from, to]| {
        let (side_from, side_to) = (ray.perp_dot(from - eye_m), ray.perp_dot(to - eye_m));
        let edge = to - from;
        let (side_eye, side_at) = (edge.perp_dot(eye_m - from), edge.perp_dot(at_m - from));
        side_from * side_to < 0.0 && side_eye * side_at < 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_stands_where_no_wall_hides_the_crowd() {
        let mut scenario = Scenario::of(Vec::new());
        let positions_m: Vec<Vec2> = (0..30).map(|index| Vec2::new((index % 6) as f32, (index / 6) as f32)).collect();
        let [free_m, _] = eye_and_target_m(&scenario, std::slice::from_ref(&positions_m));
        assert!(free_m.y < 0.0, "{free_m}");
        scenario.obstacles_m.push([[-40.0, -3.0], [40.0, -3.0], [40.0, -2.0], [-40.0, -2.0]].map(Vec2::from).to_vec());
        let [eye_m, target_m] = eye_and_target_m(&scenario, &[positions_m]);
        assert!(eye_m.y > -2.0, "{eye_m} looks at {target_m}");
    }

    #[test]
    fn a_crowd_that_crosses_the_scene_is_framed_at_its_start_and_end() {
        // From the left to the right over twelve metres.
        let at = |x: f32| (0..9).map(|index| Vec2::new(x + (index % 3) as f32, (index / 3) as f32)).collect();
        let moments_m: Vec<Vec<Vec2>> = (0..7).map(|moment| at(-6.0 + 2.0 * moment as f32)).collect();
        let [eye_m, target_m] = eye_and_target_m(&Scenario::of(Vec::new()), &moments_m);
        let ahead = (target_m - eye_m).normalize();
        for position_m in moments_m.concat() {
            let offset = position_m - eye_m;
            let across = offset.perp_dot(ahead).abs() / offset.dot(ahead);
            assert!((0.0..0.9 * 18.0 / FOCAL_MM).contains(&across), "{position_m}: {across}, from {eye_m}");
        }
    }
}
