//! A camera for a recording whose scenario states none: of many places round the crowd, the one from which the crowd is
//! seen best over the whole recording, by [`CoarseScene::score`]. A few frames are read. World, metres.
//!
//! The eye is as high as an adult's where the crowd is seen from there; above heads or walls where much more is seen.

use fbcrowd_sim::recording::{Recording, duration_s, sample};
use fbcrowd_sim::scenario::{CameraSpec, Scenario};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::camera::coarse_picture::{CoarseScene, coarse_size_px};
use crate::error::RenderError;
use crate::shading::light::TO_SUN;
use crate::visibility::Lens;

/// Name of the camera in captions.
pub(crate) const DEFAULT_NAME: &str = "default";
/// Height that the camera looks at, m.
const TARGET_HEIGHT_M: f32 = 1.15;
/// Focal length on film of 36 mm, mm: a slight wide angle.
const FOCAL_MM: f32 = 35.0;
/// Width of the picture over its distance.
const WIDTH_TANGENT: f32 = 36.0 / FOCAL_MM;
/// Number of moments that are read, from the first to the last frame.
const MOMENTS: u32 = 12;
/// Greatest number of bodies of a moment, at even steps.
const BODIES_MAX: usize = 1_000;
/// Share of the picture's width within which bodies are framed.
const FRAMED: f32 = 0.86;
/// Share of the positions that are framed.
const FRAMED_BODIES: f32 = 0.95;
/// Number of directions that are tried, from the middle of the crowd to the camera.
const DIRECTIONS: usize = 16;
/// Distances that are tried, of the one that frames the crowd.
const DISTANCES: [f32; 5] = [1.0, 0.75, 0.5, 0.35, 1.3];
/// Least and greatest distance of the camera from the middle of the crowd, m: farther away people are specks.
const DISTANCE_M: [f32; 2] = [4.5, 40.0];
/// Heights of the eye that are tried, m, and what a score counts there: the first is an adult's.
const HEIGHTS: [(f32, f32); 6] = [(1.65, 1.0), (2.6, 0.97), (4.2, 0.92), (7.0, 0.86), (11.0, 0.78), (18.0, 0.7)];
/// What a score counts against the sun.
const AGAINST_SUN: f32 = 0.85;

/// The camera of a recording without one, for pictures of a size and frames from a time on, s.
///
/// # Errors
/// If a frame cannot be read.
pub(crate) fn default_camera(
    recording: &Recording,
    start_s: f64,
    size_px: [u32; 2],
) -> Result<CameraSpec, RenderError> {
    let (end_s, mut moments_m) = (duration_s(recording), Vec::new());
    for moment in 0..MOMENTS {
        let share = f64::from(moment) / f64::from(MOMENTS - 1);
        let agents = sample(recording, start_s + share * (end_s - start_s).max(0.0))?;
        let step = agents.len().div_ceil(BODIES_MAX).max(1);
        if !agents.is_empty() {
            moments_m.push(agents.iter().step_by(step).map(|agent| agent.root.position_m).collect());
        }
    }
    let [eye_m, target_m] = eye_and_target_m(&recording.header().scenario, &moments_m, size_px);
    Ok(CameraSpec {
        name: DEFAULT_NAME.to_owned(),
        eye_m: Some(eye_m),
        look_at_m: Some(target_m),
        focal_mm: Some(FOCAL_MM),
        ..CameraSpec::default()
    })
}

/// Where the camera is and looks, for the positions of bodies at each moment: the best place, the first of equals.
fn eye_and_target_m(scenario: &Scenario, moments_m: &[Vec<Vec2>], size_px: [u32; 2]) -> [Vec3; 2] {
    let positions_m = moments_m.concat();
    let target_m = middle_m(&positions_m).extend(TARGET_HEIGHT_M);
    let scene = CoarseScene::new(scenario, moments_m);
    let size_px = coarse_size_px(size_px);
    let places: Vec<(Vec3, f32)> = places(&positions_m, target_m.truncate());
    let score = |(eye_m, weight): &(Vec3, f32)| {
        weight * scene.score(&Lens::perspective(size_px, *eye_m, target_m, WIDTH_TANGENT))
    };
    let scores: Vec<f32> = places.par_iter().map(score).collect();
    let best = (1..places.len()).fold(0, |best, at| if scores[at] > scores[best] { at } else { best });
    [places[best].0, target_m]
}

/// Places round a target, with the weight of their scores.
fn places(positions_m: &[Vec2], target_m: Vec2) -> Vec<(Vec3, f32)> {
    let mut places = Vec::new();
    for index in 0..DIRECTIONS {
        // From the south, so that a lone body is seen from there.
        let turns = index as f32 / DIRECTIONS as f32 - 0.25;
        let (sin, cos) = libm::sincosf(std::f32::consts::TAU * turns);
        let direction = Vec2::new(cos, sin);
        let whole_m = framing_distance_m(positions_m, target_m, direction);
        let with_sun = 0.5 + 0.5 * direction.dot(TO_SUN.truncate().normalize());
        let light = AGAINST_SUN + (1.0 - AGAINST_SUN) * with_sun;
        for share in DISTANCES {
            let distance_m = (share * whole_m).clamp(DISTANCE_M[0], DISTANCE_M[1]);
            let on_ground_m = target_m + distance_m * direction;
            places.extend(HEIGHTS.map(|(height_m, weight)| {
                // A steep view shows the tops of heads.
                let level = distance_m / Vec2::new(distance_m, height_m - TARGET_HEIGHT_M).length();
                (on_ground_m.extend(height_m), weight * level * light)
            }));
        }
    }
    places
}

/// Distance in a direction from a target at which most positions are between the sides of the picture.
fn framing_distance_m(positions_m: &[Vec2], target_m: Vec2, direction: Vec2) -> f32 {
    let slope = FRAMED * 0.5 * WIDTH_TANGENT;
    let needed_m = |position_m: &Vec2| {
        let offset_m = *position_m - target_m;
        offset_m.dot(direction) + offset_m.perp_dot(direction).abs() / slope
    };
    let mut distances_m: Vec<f32> = positions_m.iter().map(needed_m).collect();
    distances_m.sort_by(f32::total_cmp);
    let at = (FRAMED_BODIES * distances_m.len() as f32) as usize;
    distances_m.get(at).copied().unwrap_or(DISTANCE_M[0])
}

/// Middle of the box that holds all but the outermost tenth of the positions on each side, m.
fn middle_m(positions_m: &[Vec2]) -> Vec2 {
    let middle = |axis: usize| {
        let mut along: Vec<f32> = positions_m.iter().map(|position_m| position_m[axis]).collect();
        along.sort_by(f32::total_cmp);
        let cut = along.len() / 10;
        let end = along.len().saturating_sub(1);
        let at = |index: usize| along.get(index).copied().unwrap_or(0.0);
        at(cut).midpoint(at(end - cut.min(end)))
    };
    Vec2::new(middle(0), middle(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE_PX: [u32; 2] = [1280, 720];

    fn wall(low_m: [f32; 2], high_m: [f32; 2]) -> Vec<Vec2> {
        [low_m, [high_m[0], low_m[1]], high_m, [low_m[0], high_m[1]]].map(Vec2::from).to_vec()
    }

    fn block(first_m: Vec2, columns: usize, count: usize) -> Vec<Vec2> {
        (0..count).map(|index| first_m + Vec2::new((index % columns) as f32, (index / columns) as f32)).collect()
    }

    #[test]
    fn the_camera_is_at_eye_height_where_no_wall_hides_the_crowd() {
        let mut scenario = Scenario::of(Vec::new());
        let positions_m = vec![block(Vec2::ZERO, 6, 18)];
        let [free_m, _] = eye_and_target_m(&scenario, &positions_m, SIZE_PX);
        assert!(free_m.y < 0.0 && free_m.z < 3.0, "{free_m}");
        scenario.obstacles_m.push(wall([-40.0, -3.0], [40.0, -2.0]));
        let [eye_m, target_m] = eye_and_target_m(&scenario, &positions_m, SIZE_PX);
        assert!(eye_m.y > -2.0 || eye_m.z > 4.0, "{eye_m} looks at {target_m}");
    }

    #[test]
    fn the_camera_rises_above_walls_all_around() {
        let mut scenario = Scenario::of(Vec::new());
        let [low, high] = [-1.5, 3.5];
        scenario.obstacles_m = vec![
            wall([low, low], [high, low + 0.2]),
            wall([low, high - 0.2], [high, high]),
            wall([low, low], [low + 0.2, high]),
            wall([high - 0.2, low], [high, high]),
        ];
        let [eye_m, _] = eye_and_target_m(&scenario, &[block(Vec2::ZERO, 3, 9)], SIZE_PX);
        assert!(eye_m.z > 4.0, "{eye_m}");
    }

    #[test]
    fn no_body_of_a_stream_passes_close_before_the_camera() {
        // A corridor 6 m wide, full of bodies that walk along it.
        let mut scenario = Scenario::of(Vec::new());
        scenario.obstacles_m = vec![wall([-60.0, -3.3], [60.0, -3.0]), wall([-60.0, 3.0], [60.0, 3.3])];
        let moment_m = |moment: usize| -> Vec<Vec2> {
            let shift = 0.4 * moment as f32;
            let at =
                |index: usize| Vec2::new(-20.0 + 1.3 * (index / 4) as f32 + shift, -2.1 + 1.4 * (index % 4) as f32);
            (0..120).map(at).collect()
        };
        let moments_m: Vec<Vec<Vec2>> = (0..12).map(moment_m).collect();
        let [eye_m, target_m] = eye_and_target_m(&scenario, &moments_m, SIZE_PX);
        let lens = Lens::perspective(SIZE_PX, eye_m, target_m, WIDTH_TANGENT);
        for position_m in moments_m.concat() {
            let face_m = position_m.extend(1.5);
            let is_seen =
                lens.to_px(face_m).is_some_and(|px| px.cmpge(Vec2::ZERO).all() && px.cmple(lens.size()).all());
            assert!(!is_seen || lens.to_camera(face_m).z > 2.5, "{position_m} from {eye_m}");
        }
    }

    #[test]
    fn most_of_a_crowd_that_crosses_is_always_framed() {
        // From the left to the right over twelve metres.
        let moments_m: Vec<Vec<Vec2>> =
            (0..7).map(|moment| block(Vec2::new(-6.0 + 2.0 * moment as f32, 0.0), 3, 9)).collect();
        let [eye_m, target_m] = eye_and_target_m(&Scenario::of(Vec::new()), &moments_m, SIZE_PX);
        let lens = Lens::perspective(SIZE_PX, eye_m, target_m, WIDTH_TANGENT);
        let is_framed = |position_m: &&Vec2| {
            lens.to_px(position_m.extend(1.0)).is_some_and(|px| (0.0..lens.size().x).contains(&px.x))
        };
        for positions_m in &moments_m {
            let framed = positions_m.iter().filter(is_framed).count();
            assert!(2 * framed > positions_m.len(), "{framed} from {eye_m}: {positions_m:?}");
        }
    }
}
