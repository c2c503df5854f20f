//! Where a camera is at a time, and what it looks at. World, metres, z up, seconds.

use std::f32::consts::TAU;

use fbcrowd_sim::AgentId;
use fbcrowd_sim::recording::{AgentFrame, Recording};
use fbcrowd_sim::scenario::{CameraFollow, CameraKey, CameraOrbit, CameraSpec, KeyLine};
use glam::{Vec2, Vec3};
use motiondb::body::{Joint, Skeleton};

use crate::error::RenderError;
use crate::top_view::sample;
use crate::visibility::Lens;

/// Height that a following camera looks at, m: the shoulders.
const FOLLOWED_M: f32 = 1.3;
/// Times around a frame over which a following camera is smoothed, s.
const SMOOTHING_S: [f64; 7] = [-0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6];
/// Distance of the eyes from the head's joint, forward and up, m.
const EYES_M: Vec2 = Vec2::new(0.09, 0.07);
/// Slope at which eyes look down.
const GAZE_SLOPE: f32 = -0.06;
/// Distance at which eyes look, m.
const GAZE_M: f32 = 10.0;

/// The lens of a camera at a time.
///
/// # Errors
/// If the agent of the camera is not present, or a frame cannot be read.
pub(crate) fn lens_at(
    recording: &Recording,
    spec: &CameraSpec,
    size_px: [u32; 2],
    time_s: f64,
) -> Result<Lens, RenderError> {
    let [eye_m, target_m] = eye_and_target_m(recording, spec, time_s)?;
    let lens = match (spec.width_tangent(), spec.width_m) {
        (Some(tangent), _) => Lens::perspective(size_px, eye_m, target_m, tangent),
        (None, width_m) => Lens::orthographic(size_px, eye_m, target_m - eye_m, width_m.unwrap_or(10.0)),
    };
    Ok(up_at(spec, time_s as f32).map_or(lens, |up| lens.with_up(up)))
}

/// The direction that is up in the picture; none where it is world z all the time.
fn up_at(spec: &CameraSpec, time_s: f32) -> Option<Vec3> {
    let up = |key: &CameraKey| key.up.unwrap_or(Vec3::Z);
    match &spec.keys[..] {
        [] => spec.up,
        keys if keys.iter().all(|key| key.up.is_none()) => None,
        keys => {
            let (from, to, share) = between(keys, time_s);
            Some(up(&keys[from]).lerp(up(&keys[to]), share))
        }
    }
}

/// The keys around a time, and the share of the time between them that has passed.
fn between(keys: &[CameraKey], time_s: f32) -> (usize, usize, f32) {
    let after = keys.partition_point(|key| key.time_s <= time_s);
    let (from, to) = (after.saturating_sub(1), after.min(keys.len() - 1));
    let span_s = keys[to].time_s - keys[from].time_s;
    (from, to, if span_s > 0.0 { (time_s - keys[from].time_s) / span_s } else { 0.0 })
}

fn eye_and_target_m(recording: &Recording, spec: &CameraSpec, time_s: f64) -> Result<[Vec3; 2], RenderError> {
    if let Some(orbit) = spec.orbit {
        return Ok([orbit_eye_m(&orbit, time_s as f32), orbit.centre_m]);
    }
    if let Some(follow) = spec.follow {
        return follow_m(recording, spec, &follow, time_s);
    }
    if let Some(agent) = spec.eyes_of {
        let bodies = sample(recording, time_s)?;
        let body = present(recording, &bodies, spec, agent, time_s)?;
        let stature = recording.population().agents[body.id.index()].stature;
        return Ok(eyes_m(body, recording.header().skeleton(), stature));
    }
    if !spec.keys.is_empty() {
        return Ok(keyed_eye_and_target_m(spec, time_s as f32));
    }
    Ok([spec.eye_m.unwrap_or(Vec3::Z), spec.look_at_m.unwrap_or(Vec3::Y)])
}

/// Eye and target of a camera with keys at a time.
pub(crate) fn keyed_eye_and_target_m(spec: &CameraSpec, time_s: f32) -> [Vec3; 2] {
    match spec.key_line {
        KeyLine::Smooth => keyed_m(&spec.keys, time_s),
        KeyLine::Straight => straight_m(&spec.keys, time_s),
    }
}

fn present<'a>(
    recording: &Recording,
    bodies: &'a [AgentFrame],
    spec: &CameraSpec,
    agent: u32,
    time_s: f64,
) -> Result<&'a AgentFrame, RenderError> {
    let (camera, count) = (spec.name.clone(), recording.population().agents.len());
    let found = bodies.binary_search_by_key(&AgentId(agent), |body| body.id);
    match found {
        Ok(index) => Ok(&bodies[index]),
        Err(_) if agent as usize >= count => Err(RenderError::UnknownCameraAgent { camera, agent, count }),
        Err(_) => Err(RenderError::CameraAgent { camera, agent, time_s }),
    }
}

fn orbit_eye_m(orbit: &CameraOrbit, time_s: f32) -> Vec3 {
    let turns = time_s / orbit.period_s;
    let angle_rad = TAU * (turns - turns.floor()) + orbit.start_deg.to_radians();
    let (sin, cos) = libm::sincosf(angle_rad);
    (orbit.centre_m.truncate() + orbit.radius_m * Vec2::new(cos, sin)).extend(orbit.height_m)
}

fn follow_m(
    recording: &Recording,
    spec: &CameraSpec,
    follow: &CameraFollow,
    time_s: f64,
) -> Result<[Vec3; 2], RenderError> {
    let bodies = sample(recording, time_s)?;
    let now = present(recording, &bodies, spec, follow.agent, time_s)?.root;
    let scenario = &recording.header().scenario;
    let last_s = recording.frame_count().saturating_sub(1) as f64 * f64::from(scenario.dt_s);
    let (mut at_m, mut ahead, mut count) = (Vec2::ZERO, Vec2::ZERO, 0.0);
    for shift_s in SMOOTHING_S {
        let bodies = sample(recording, (time_s + shift_s).clamp(0.0, last_s))?;
        let found = bodies.binary_search_by_key(&AgentId(follow.agent), |body| body.id);
        let root = found.map_or(now, |index| bodies[index].root);
        (at_m, ahead, count) = (at_m + root.position_m, ahead + root.forward(), count + 1.0);
    }
    let (at_m, ahead) = (at_m / count, ahead.try_normalize().unwrap_or_else(|| now.forward()));
    let eye_m = at_m - follow.behind_m * ahead + follow.left_m * ahead.perp();
    Ok([eye_m.extend(follow.height_m), at_m.extend(FOLLOWED_M)])
}

fn eyes_m(body: &AgentFrame, skeleton: &Skeleton, stature: f32) -> [Vec3; 2] {
    let joints = body.pose.forward_kinematics(skeleton).sized(stature);
    let head_m = body.root.to_world(joints.positions_m[Joint::Head.index()]);
    let ahead = body.root.forward();
    let eye_m = head_m + stature * (EYES_M.x * ahead).extend(EYES_M.y);
    [eye_m, eye_m + GAZE_M * ahead.extend(GAZE_SLOPE)]
}

/// Eye and target at a time: a cubic through all keys, with tangents from the neighbours (Catmull and Rom 1974, for
/// keys at any times).
fn keyed_m(keys: &[CameraKey], time_s: f32) -> [Vec3; 2] {
    let after = keys.partition_point(|key| key.time_s <= time_s);
    if after == 0 || after == keys.len() {
        let key = keys[after.min(keys.len() - 1)];
        return [key.eye_m, key.look_at_m];
    }
    let (from, to) = (after - 1, after);
    let span_s = keys[to].time_s - keys[from].time_s;
    let share = (time_s - keys[from].time_s) / span_s;
    let values = [|key: &CameraKey| key.eye_m, |key: &CameraKey| key.look_at_m];
    values.map(|value| {
        let tangent = |index: usize| {
            let (before, next) = (index.saturating_sub(1), (index + 1).min(keys.len() - 1));
            (value(&keys[next]) - value(&keys[before])) / (keys[next].time_s - keys[before].time_s)
        };
        let (start, end) = (value(&keys[from]), value(&keys[to]));
        let (square, cube) = (share * share, share * share * share);
        (2.0 * cube - 3.0 * square + 1.0) * start
            + (cube - 2.0 * square + share) * span_s * tangent(from)
            + (3.0 * square - 2.0 * cube) * end
            + (cube - square) * span_s * tangent(to)
    })
}

/// Eye and target at a time, in straight lines from key to key.
fn straight_m(keys: &[CameraKey], time_s: f32) -> [Vec3; 2] {
    let (from, to, share) = between(keys, time_s);
    let (from, to) = (&keys[from], &keys[to]);
    [from.eye_m.lerp(to.eye_m, share), from.look_at_m.lerp(to.look_at_m, share)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_keyed_camera_passes_its_keys_smoothly() {
        let key =
            |time_s: f32, x: f32| CameraKey { time_s, eye_m: Vec3::new(x, x * x, 1.6), look_at_m: Vec3::Y, up: None };
        let keys = [key(0.0, 0.0), key(1.0, 1.0), key(3.0, 2.5), key(4.0, 4.0)];
        for wanted in &keys {
            assert!(keyed_m(&keys, wanted.time_s)[0].distance(wanted.eye_m) < 1e-5);
        }
        assert_eq!(keyed_m(&keys, -1.0)[0], keys[0].eye_m);
        assert_eq!(keyed_m(&keys, 9.0)[0], keys[3].eye_m);
        // No jump of the velocity at a key.
        let speed = |time_s: f32| (keyed_m(&keys, time_s + 1e-3)[0] - keyed_m(&keys, time_s)[0]) / 1e-3;
        assert!(speed(0.998).distance(speed(1.001)) < 0.1);
    }

    #[test]
    fn straight_keys_turn_about_the_view_between_their_directions() {
        let key = |time_s: f32, up: Vec3| CameraKey { time_s, eye_m: Vec3::ZERO, look_at_m: Vec3::Y, up: Some(up) };
        let keys = vec![key(0.0, Vec3::Z), key(2.0, Vec3::X)];
        let spec = CameraSpec { keys, key_line: KeyLine::Straight, ..CameraSpec::default() };
        let lens = |time_s: f32| {
            Lens::orthographic([100, 100], Vec3::ZERO, Vec3::Y, 2.0).with_up(up_at(&spec, time_s).unwrap())
        };
        assert!(lens(-1.0).down.distance(-Vec3::Z) < 1e-6 && lens(9.0).down.distance(-Vec3::X) < 1e-6);
        assert!(lens(1.0).down.distance(-Vec3::new(1.0, 0.0, 1.0).normalize()) < 1e-6);
    }

    #[test]
    fn an_orbit_returns_after_its_period() {
        let orbit = CameraOrbit { centre_m: Vec3::X, radius_m: 3.0, height_m: 2.0, period_s: 8.0, start_deg: 90.0 };
        assert!(orbit_eye_m(&orbit, 0.0).distance(Vec3::new(1.0, 3.0, 2.0)) < 1e-5);
        assert!(orbit_eye_m(&orbit, 2.0).distance(Vec3::new(-2.0, 0.0, 2.0)) < 1e-5);
        assert!(orbit_eye_m(&orbit, 16.0).distance(orbit_eye_m(&orbit, 0.0)) < 1e-5);
    }
}
