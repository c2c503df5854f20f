//! The choice of the default camera: of all candidates the one with the best score, the first of equals. World, metres.
//!
//! The score of a candidate is the geometric mean over moments of [`coarse_picture::score`], times its weight. All are
//! scored by a few bodies at few moments; the best ones of each elevation again by more, in rounds.
//!
//! A camera stands still; it moves with the middle of the crowd where the crowd is seen better so, and no wall is in its
//! way. Both are judged as they film, at all moments.

use fbcrowd_sim::recording::Recording;
use fbcrowd_sim::scenario::{CameraKey, CameraSpec, KeyLine, Scenario};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::camera::default_camera::candidates::{Candidate, ELEVATION_COUNT, candidates, candidates_of_parts};
use crate::camera::default_camera::coarse_picture::{self, coarse_size_px};
use crate::camera::default_camera::crowd::{
    CrowdMoment, CrowdMoments, filmed_moving, filmed_still, read_moments, thinned,
};
use crate::camera::default_camera::framing::{FramedBodies, Framing};
use crate::camera::default_camera::path::{best_path, greatest};
use crate::camera::default_camera::walls::Walls;
use crate::camera::placement::keyed_eye_and_target_m;
use crate::error::RenderError;
use crate::visibility::Lens;

/// Name of the camera in captions.
pub(crate) const DEFAULT_NAME: &str = "default";
/// Number of moments, and of bodies of each, by which places are framed, about.
const FRAMED: [usize; 2] = [12, 20];
/// Rounds of the choice: number of moments, and of bodies of each, by which candidates are scored, about; and the number
/// of the best ones of each elevation that are left.
const ROUNDS: [([usize; 2], usize); 2] = [([3, 40], 64), ([6, 120], 8)];
/// Number of moments, and of bodies of each, by which those that are left are scored, about.
const LAST_ROUND: [usize; 2] = [36, 250];
/// Number of bodies by which a moving camera aims and is scored, about.
const PATH_BODIES: [usize; 2] = [20, 120];
/// Added to the score of each moment, so that one without a body does not decide alone.
const UNSEEN: f32 = 0.02;
/// Focal length where no body is ever present, mm.
const EMPTY_MM: f32 = 35.0;
/// What the score of a moving camera counts.
const MOVING: f32 = 0.85;
/// Number of parts between two keys of a moving camera that are tested against walls.
const PARTS: u8 = 8;

/// The camera of a recording without one, for pictures of a size and frames from a time on, s.
///
/// # Errors
/// If a frame cannot be read.
pub(crate) fn default_camera(
    recording: &Recording,
    start_s: f64,
    size_px: [u32; 2],
) -> Result<CameraSpec, RenderError> {
    let crowd = read_moments(recording, start_s)?;
    Ok(best_camera(&recording.header().scenario, &crowd, size_px))
}

/// What all candidates are judged by.
struct Filmed<'a> {
    walls: &'a Walls<'a>,
    crowd: CrowdMoments,
    /// Height of the bodies, m.
    height_m: f32,
    size_px: [u32; 2],
}

/// The best camera, for the bodies at each moment.
fn best_camera(scenario: &Scenario, crowd: &CrowdMoments, size_px: [u32; 2]) -> CameraSpec {
    let (walls, size_px, height_m) = (Walls::new(scenario), coarse_size_px(size_px), crowd.height_m());
    let [still, moving] =
        [filmed_still, filmed_moving].map(|filmed| Filmed { walls: &walls, crowd: filmed(crowd), height_m, size_px });
    let place = still.best_place();
    let of_still = still.camera(&place);
    let score = still.score_as_filmed(&of_still, &place) / MOVING;
    let better = |path: Vec<Candidate>| {
        let camera = moving.free_camera(&path)?;
        (moving.score_as_filmed(&camera, &path) > score).then_some(camera)
    };
    moving.best_path(score).and_then(better).unwrap_or(of_still)
}

impl Filmed<'_> {
    /// Positions by which places are framed, from the middle of the crowd, m.
    fn framed_offsets_m(&self) -> Vec<Vec2> {
        thinned(&self.key_moments(), FRAMED).iter().flat_map(offsets_m).collect()
    }

    fn framed<'a>(&self, positions_m: &'a [Vec2]) -> FramedBodies<'a> {
        FramedBodies { positions_m, height_m: self.height_m }
    }

    fn key_moments(&self) -> Vec<CrowdMoment> {
        self.crowd.keys().into_iter().map(|key| self.crowd.moments[key].clone()).collect()
    }

    /// The best candidate for all keys, at each of them.
    fn best_place(&self) -> Vec<Candidate> {
        let mut candidates = candidates_of_parts(&self.framed(&self.framed_offsets_m()), self.size_px);
        let keys = self.key_moments();
        for (counts, left) in ROUNDS {
            let scores = self.scores(&candidates, &thinned(&keys, counts));
            let mut order: Vec<usize> = (0..candidates.len()).collect();
            order.sort_by(|a, b| scores[*b].total_cmp(&scores[*a]));
            let mut ranks = [0; ELEVATION_COUNT];
            order.retain(|at| {
                let rank = &mut ranks[candidates[*at].elevation];
                *rank += 1;
                *rank <= left
            });
            order.sort_unstable();
            candidates = order.into_iter().map(|at| candidates[at]).collect();
        }
        let scores = self.scores(&candidates, &thinned(&keys, LAST_ROUND));
        vec![candidates[greatest(&scores)]; keys.len()]
    }

    /// The best candidates along the way of the crowd, one a key, with one focal length. They aim at the bodies about
    /// their key. None where the crowd is hardly seen better than with a score.
    fn best_path(&self, score: f32) -> Option<Vec<Candidate>> {
        let mut candidates = candidates(&self.framed(&self.framed_offsets_m()), self.size_px);
        let logarithms = self.logarithms(&candidates, &thinned(&self.key_moments(), ROUNDS[1].0));
        let greatest_at = |moment: usize| logarithms.iter().map(|of| of[moment]).fold(f32::NEG_INFINITY, f32::max);
        let moment_count = logarithms[0].len();
        let most = score_of((0..moment_count).map(greatest_at).sum::<f32>() / moment_count.max(1) as f32);
        if most <= score {
            return None;
        }
        let few = thinned(&self.crowd.moments, [self.crowd.moments.len().max(1), PATH_BODIES[1]]);
        let keys = self.crowd.keys();
        let sums: Vec<f32> = logarithms.iter().map(|of| of.iter().sum()).collect();
        let Framing { focal_mm, .. } = candidates[greatest(&sums)].framing;
        candidates.iter_mut().for_each(|candidate| candidate.framing.focal_mm = focal_mm);
        let fewer = thinned(&few, [few.len().max(1), PATH_BODIES[0]]);
        let aimed = |key: &usize| -> Vec<Candidate> {
            let [before, after] = [key.saturating_sub(self.crowd.of_key), (key + self.crowd.of_key).min(few.len() - 1)];
            let bodies = [before, *key, after].into_iter().flat_map(|at| &fewer[at].bodies);
            let offsets_m: Vec<Vec2> = bodies.map(|body| body.position_m - few[*key].centre_m).collect();
            candidates.iter().map(|candidate| candidate.aimed(&self.framed(&offsets_m))).collect()
        };
        let aimed: Vec<Vec<Candidate>> = keys.par_iter().map(aimed).collect();
        let of_key = |(key, aimed): (&usize, &Vec<Candidate>)| -> Vec<f32> {
            let first = key.saturating_sub(self.crowd.of_key / 2);
            let about = &few[first..(first + self.crowd.of_key).min(few.len())];
            aimed.iter().map(|candidate| mean(&self.logarithms_of(candidate, about))).collect()
        };
        let logarithms: Vec<Vec<f32>> = keys.par_iter().zip(&aimed).map(of_key).collect();
        let path = best_path(&candidates, &self.key_moments(), &logarithms, self.walls);
        Some(path.into_iter().zip(&aimed).map(|(at, aimed)| aimed[at]).collect())
    }

    /// Scores of candidates by some moments.
    fn scores(&self, candidates: &[Candidate], moments: &[CrowdMoment]) -> Vec<f32> {
        // The geometric mean: a crowd that is seen all the time counts more than one that is seen well for half of it.
        self.logarithms(candidates, moments).iter().map(|of_moments| score_of(mean(of_moments))).collect()
    }

    /// Logarithms of the scores of each candidate at each of some moments.
    fn logarithms(&self, candidates: &[Candidate], moments: &[CrowdMoment]) -> Vec<Vec<f32>> {
        candidates.par_iter().map(|candidate| self.logarithms_of(candidate, moments)).collect()
    }

    fn logarithms_of(&self, candidate: &Candidate, moments: &[CrowdMoment]) -> Vec<f32> {
        let lens = |moment: &CrowdMoment| candidate.framing.lens(eye_m(moment, candidate), self.size_px);
        moments.iter().map(|moment| self.logarithm(&lens(moment), candidate.weight, moment)).collect()
    }

    /// The score of a camera with a key for each of some candidates, at all moments.
    fn score_as_filmed(&self, camera: &CameraSpec, choice: &[Candidate]) -> f32 {
        let Some(tangent) = camera.width_tangent() else { return 0.0 };
        let logarithm = |(index, moment): (usize, &CrowdMoment)| {
            let [eye_m, target_m] = match camera.eye_m.zip(camera.look_at_m) {
                Some((eye_m, target_m)) => [eye_m, target_m],
                None => keyed_eye_and_target_m(camera, moment.time_s as f32),
            };
            let lens = Lens::perspective(self.size_px, eye_m, target_m, tangent);
            let nearest = ((index + self.crowd.of_key / 2) / self.crowd.of_key).min(choice.len() - 1);
            self.logarithm(&lens, choice[nearest].weight, moment)
        };
        let logarithms: Vec<f32> = self.crowd.moments.par_iter().enumerate().map(logarithm).collect();
        score_of(mean(&logarithms))
    }

    /// Logarithm of the score of a lens at a moment.
    fn logarithm(&self, lens: &Lens, weight: f32, moment: &CrowdMoment) -> f32 {
        libm::logf(weight * coarse_picture::score(lens, self.walls, moment) + UNSEEN)
    }

    /// The camera of a path: smooth where no wall is in its way, else in straight lines; none where a wall is in their way, too.
    fn free_camera(&self, path: &[Candidate]) -> Option<CameraSpec> {
        let camera = self.camera(path);
        let lines = [KeyLine::Smooth, KeyLine::Straight].map(|key_line| CameraSpec { key_line, ..camera.clone() });
        lines.into_iter().find(|camera| self.is_free(camera))
    }

    /// Whether no wall is on the path of a camera.
    fn is_free(&self, camera: &CameraSpec) -> bool {
        let is_free_between = |keys: &[CameraKey]| {
            let eye_m = |part: u8| {
                let share = f32::from(part) / f32::from(PARTS);
                keyed_eye_and_target_m(camera, keys[0].time_s + share * (keys[1].time_s - keys[0].time_s))[0]
            };
            !(0..PARTS).any(|part| self.walls.block(eye_m(part), eye_m(part + 1)))
        };
        camera.keys.windows(2).all(is_free_between)
    }

    /// The camera of a choice: still, where it has one eye.
    fn camera(&self, choice: &[Candidate]) -> CameraSpec {
        let camera = CameraSpec { name: DEFAULT_NAME.to_owned(), ..CameraSpec::default() };
        let key = |(moment, candidate): (&CrowdMoment, &Candidate)| {
            let eye_m = eye_m(moment, candidate);
            let look_at_m = eye_m + candidate.distance_m * candidate.framing.direction;
            CameraKey { time_s: moment.time_s as f32, eye_m, look_at_m, up: None }
        };
        let keys: Vec<CameraKey> = self.key_moments().iter().zip(choice).map(key).collect();
        let Some((first, candidate)) = keys.first().copied().zip(choice.first()) else {
            return CameraSpec { focal_mm: Some(EMPTY_MM), ..camera };
        };
        let camera = CameraSpec { focal_mm: Some(candidate.framing.focal_mm), ..camera };
        if keys.iter().all(|key| key.eye_m == first.eye_m) {
            return CameraSpec { eye_m: Some(first.eye_m), look_at_m: Some(first.look_at_m), ..camera };
        }
        CameraSpec { keys, ..camera }
    }
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len().max(1) as f32
}

/// The score of which the mean logarithm is given.
fn score_of(mean: f32) -> f32 {
    (libm::expf(mean) - UNSEEN).max(0.0)
}

/// Bodies of a moment from the middle of the crowd, m.
fn offsets_m(moment: &CrowdMoment) -> Vec<Vec2> {
    moment.bodies.iter().map(|body| body.position_m - moment.centre_m).collect()
}

fn eye_m(moment: &CrowdMoment, candidate: &Candidate) -> Vec3 {
    moment.centre_m.extend(0.0) + candidate.offset_m
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::camera::default_camera::crowd::CrowdBody;

    const SIZE_PX: [u32; 2] = [1280, 720];

    fn wall(low_m: [f32; 2], high_m: [f32; 2]) -> Vec<Vec2> {
        [low_m, [high_m[0], low_m[1]], high_m, [low_m[0], high_m[1]]].map(Vec2::from).to_vec()
    }

    fn block(first_m: Vec2, columns: usize, count: usize) -> Vec<Vec2> {
        (0..count).map(|index| first_m + Vec2::new((index % columns) as f32, (index / columns) as f32)).collect()
    }

    /// The camera of a crowd that faces east, a second between the moments.
    fn camera(scenario: &Scenario, moments_m: &[Vec<Vec2>]) -> CameraSpec {
        let body = |position_m: &Vec2| CrowdBody { position_m: *position_m, ahead: Vec2::X, height_m: 1.75 };
        let moment = |(index, positions_m): (usize, &Vec<Vec2>)| CrowdMoment {
            time_s: index as f64,
            centre_m: Vec2::ZERO,
            present: positions_m.len(),
            bodies: positions_m.iter().map(body).collect(),
        };
        let moments = moments_m.iter().enumerate().map(moment).collect();
        best_camera(scenario, &CrowdMoments { moments, of_key: 1 }, SIZE_PX)
    }

    /// The lens of a camera at each moment.
    fn lenses(camera: &CameraSpec, moments: usize) -> Vec<Lens> {
        let tangent = camera.width_tangent().unwrap();
        let lens = |[eye_m, target_m]: [Vec3; 2]| Lens::perspective(SIZE_PX, eye_m, target_m, tangent);
        match camera.eye_m.zip(camera.look_at_m) {
            Some((eye_m, target_m)) => vec![lens([eye_m, target_m]); moments],
            None => camera.keys.iter().map(|key| lens([key.eye_m, key.look_at_m])).collect(),
        }
    }

    #[test]
    fn the_camera_is_low_where_no_wall_hides_the_crowd() {
        let mut scenario = Scenario::of(Vec::new());
        let moments_m = vec![block(Vec2::ZERO, 6, 12)];
        let free = lenses(&camera(&scenario, &moments_m), 1)[0];
        assert!(free.eye_m.z < 5.0, "{free:?}");
        // All around, 30 m away: nothing is seen from behind them.
        let [low, high] = [-30.0, 30.0];
        scenario.obstacles_m = vec![
            wall([low, low], [high, low + 0.2]),
            wall([low, high - 0.2], [high, high]),
            wall([low, low], [low + 0.2, high]),
            wall([high - 0.2, low], [high, high]),
        ];
        let walled = lenses(&camera(&scenario, &moments_m), 1)[0];
        assert!(walled.eye_m.truncate().abs().max_element() < 30.0 || walled.eye_m.z > 3.0, "{walled:?}");
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
        let positions_m = block(Vec2::ZERO, 3, 9);
        let lens = lenses(&camera(&scenario, std::slice::from_ref(&positions_m)), 1)[0];
        let walls = Walls::new(&scenario);
        assert!(walls.hold(Vec3::new(low, low, 2.4)) && lens.eye_m.z > 3.5, "{lens:?}");
        let is_seen = |position_m: &&Vec2| walls.seen_from_m(lens.eye_m, **position_m, 1.75) < 1.3;
        assert_eq!(positions_m.iter().filter(is_seen).count(), 9, "{lens:?}");
    }

    #[test]
    fn no_body_of_a_stream_fills_the_picture() {
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
        for (lens, positions_m) in lenses(&camera(&scenario, &moments_m), 12).iter().zip(&moments_m) {
            for position_m in positions_m {
                let Some(px) = lens.to_px(position_m.extend(1.5)) else { continue };
                let is_seen = px.cmpge(Vec2::ZERO).all() && px.cmple(lens.size()).all();
                let height_px = 1.75 / lens.pixel_m(lens.to_camera(position_m.extend(1.5)).z);
                assert!(!is_seen || height_px < 0.7 * lens.size().y, "{position_m}: {height_px} px from {lens:?}");
            }
        }
    }

    #[test]
    fn most_of_a_crowd_that_crosses_is_always_framed() {
        // Over twelve metres.
        let moments_m: Vec<Vec<Vec2>> =
            (0..7).map(|moment| block(Vec2::new(-6.0 + 2.0 * moment as f32, 0.0), 3, 9)).collect();
        let lenses = lenses(&camera(&Scenario::of(Vec::new()), &moments_m), moments_m.len());
        for (lens, positions_m) in lenses.iter().zip(&moments_m) {
            let is_framed = |position_m: &&Vec2| {
                lens.to_px(position_m.extend(1.0)).is_some_and(|px| (0.0..lens.size().x).contains(&px.x))
            };
            let framed = positions_m.iter().filter(is_framed).count();
            assert!(3 * framed > 2 * positions_m.len(), "{framed} from {lens:?}: {positions_m:?}");
        }
    }

    #[test]
    fn the_camera_goes_with_a_body_that_goes_far() {
        // Along a lane of 1 m between walls, and round its corner.
        let mut scenario = Scenario::of(Vec::new());
        scenario.obstacles_m = vec![
            wall([-1.0, -1.0], [31.0, -0.5]),
            wall([-1.0, 0.5], [30.0, 1.0]),
            wall([31.0, -1.0], [31.5, 30.0]),
            wall([29.5, 0.5], [30.0, 30.0]),
        ];
        let along =
            |step: u16| if step < 24 { [1.27 * f32::from(step), 0.0] } else { [30.5, 1.3 * f32::from(step - 24)] };
        let moments_m: Vec<Vec<Vec2>> = (0..44).map(|step| vec![Vec2::from(along(step))]).collect();
        let camera = camera(&scenario, &moments_m);
        assert_eq!(camera.keys.len(), moments_m.len());
        let mut hidden = 0;
        for (lens, positions_m) in lenses(&camera, 44).iter().zip(&moments_m) {
            let chest_m = positions_m[0].extend(1.3);
            hidden += usize::from(Walls::new(&scenario).seen_from_m(lens.eye_m, positions_m[0], 1.75) > 1.3);
            let is_in = lens.to_px(chest_m).is_some_and(|px| px.cmpge(Vec2::ZERO).all() && px.cmple(lens.size()).all());
            assert!(is_in, "{chest_m} from {lens:?}");
        }
        // The corner hides it for a moment, while the camera turns.
        assert!(hidden <= 2, "{hidden}");
        for keys in camera.keys.windows(2) {
            assert!(keys[0].eye_m.distance(keys[1].eye_m) < 4.5, "{keys:?}");
        }
    }

    #[test]
    fn no_wall_is_in_the_way_of_a_moving_camera() {
        // Along a street between blocks, past a wall across all of it but a gate.
        let mut scenario = Scenario::of(Vec::new());
        scenario.obstacles_m = vec![
            wall([-5.0, 5.0], [65.0, 9.0]),
            wall([-5.0, -9.0], [65.0, -5.0]),
            wall([30.0, 1.5], [30.4, 5.0]),
            wall([30.0, -5.0], [30.4, -1.5]),
        ];
        let moments_m: Vec<Vec<Vec2>> =
            (0..36).map(|step| block(Vec2::new(1.5 * f32::from(step as u8), -0.5), 2, 4)).collect();
        let camera = camera(&scenario, &moments_m);
        assert_eq!(camera.keys.len(), moments_m.len());
        let walls = Walls::new(&scenario);
        for hundredth in 0..3_500_u16 {
            let [eye_m, _] = keyed_eye_and_target_m(&camera, 0.01 * f32::from(hundredth));
            assert!(!walls.hold(eye_m), "{eye_m} after {hundredth} hundredths of a second");
        }
    }

    #[test]
    fn a_recording_without_bodies_has_a_camera() {
        assert!(camera(&Scenario::of(Vec::new()), &[]).width_tangent().is_some());
    }
}
