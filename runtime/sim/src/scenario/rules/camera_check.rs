//! The rules of cameras: one placement, one lens, numbers in range, names that differ. World, metres.

use std::ops::RangeInclusive;

use glam::Vec3;

use crate::scenario::Scenario;
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::places::camera_spec::{CameraFollow, CameraKey, CameraOrbit, CameraSpec};
use crate::scenario::ranges::{COORDINATE_MAX_M, DURATION_S, check_name, within};

/// Greatest number of cameras.
pub(crate) const CAMERAS_MAX: usize = 1_000;
/// Greatest number of keys of a camera: one for each frame of some hours.
const KEYS_MAX: usize = 1_000_000;
/// Focal length and width of the film, mm.
const LENGTH_MM: RangeInclusive<f32> = 1.0..=2_000.0;
/// Field of view, degrees.
const FOV_DEG: RangeInclusive<f32> = 0.5..=170.0;
/// Distances of a camera, m: to its subject, of fog, the width of an orthographic picture.
const DISTANCE_M: RangeInclusive<f32> = 0.05..=2.0 * COORDINATE_MAX_M;
/// Height and offsets of a camera that follows, m.
const OFFSET_M: RangeInclusive<f32> = -100.0..=100.0;
/// Height of an obstacle, m: from a kerb to a tower.
const HEIGHT_M: RangeInclusive<f32> = 0.01..=1_000.0;
/// How to state where a camera is.
const PLACEMENT_HELP: &str =
    "give `eye_m` with `look_at_m`, or `keys`, or `orbit`, or `follow`, or `eyes_of`, or `gltf`: one of them";
/// How to state a lens.
const LENS_HELP: &str = "give `focal_mm` (with `film_width_mm`, 36 by default), or `fov_deg`, or `width_m` for an orthographic picture: one of them";
/// How to place the target of a camera.
const TARGET_HELP: &str = "move `look_at_m` at least a centimetre from `eye_m`";

/// Checks the heights of obstacles in pictures.
pub(crate) fn check_heights(heights_m: &[Option<f32>]) -> Result<(), ScenarioFault> {
    for (index, height_m) in heights_m.iter().enumerate() {
        let part = &ScenarioPart::Obstacle(index);
        if let Some(height_m) = height_m {
            within(part, "height_m", *height_m, &HEIGHT_M, "give the height above the ground in metres")?;
        }
    }
    Ok(())
}

/// Checks every camera.
pub(crate) fn check_cameras(cameras: &[CameraSpec]) -> Result<(), ScenarioFault> {
    within(&ScenarioPart::Camera(0), "the number of cameras", cameras.len(), &(0..=CAMERAS_MAX), "give fewer")?;
    for (index, camera) in cameras.iter().enumerate() {
        let part = &ScenarioPart::Camera(index);
        check_name(&camera.name).map_err(|fault| ScenarioFault {
            part: part.clone(),
            help: "choose another `name`",
            ..fault
        })?;
        if cameras[..index].iter().any(|other| other.name == camera.name) {
            let help = "give each camera a `name` of its own";
            return part.fault(format!("two cameras are called {:?}", camera.name), help);
        }
        check_placement(part, camera)?;
        check_lens(part, camera)?;
    }
    Ok(())
}

/// Checks that the agents which cameras follow exist. Those of sources come later.
pub(crate) fn check_followed(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let agents = scenario.agents.len();
    let followed = |camera: &CameraSpec| camera.eyes_of.or(camera.follow.map(|follow| follow.agent));
    let is_missing = |camera: &CameraSpec| followed(camera).is_some_and(|agent| agent as usize >= agents);
    match scenario.cameras.iter().position(is_missing) {
        Some(index) if agents > 0 && scenario.sources.is_empty() => {
            let agent = followed(&scenario.cameras[index]).unwrap_or_default();
            let key = if scenario.cameras[index].eyes_of.is_some() { "eyes_of" } else { "follow" };
            let message = format!("{key}: there is no agent {agent}: the agents are 0 to {}", agents - 1);
            ScenarioPart::Camera(index).fault(message, "name one of them")
        }
        _ => Ok(()),
    }
}

fn check_placement(part: &ScenarioPart, camera: &CameraSpec) -> Result<(), ScenarioFault> {
    let CameraSpec { eye_m, look_at_m, up, keys, orbit, follow, eyes_of, gltf, node, .. } = camera;
    let is_still = eye_m.is_some() || look_at_m.is_some();
    let stated = [is_still, !keys.is_empty(), orbit.is_some(), follow.is_some(), eyes_of.is_some(), gltf.is_some()];
    match stated.iter().filter(|is_stated| **is_stated).count() {
        1 => {}
        0 => return part.fault("the camera has no position".into(), PLACEMENT_HELP),
        _ => return part.fault("the camera has several positions".into(), PLACEMENT_HELP),
    }
    if is_still {
        let (Some(eye_m), Some(look_at_m)) = (eye_m, look_at_m) else {
            return part.fault("a still camera needs both `eye_m` and `look_at_m`".into(), PLACEMENT_HELP);
        };
        check_view_line(part, *eye_m, *look_at_m)?;
        check_up(part, *eye_m, *look_at_m, *up)?;
    } else if up.is_some() {
        return part.fault("`up` belongs to a still camera".into(), "keys have an `up` of their own");
    }
    if node.is_some() && gltf.is_none() {
        return part.fault("`node` belongs to `gltf`".into(), "name the file by `gltf`, or remove the key");
    }
    check_keys(part, keys)?;
    orbit.as_ref().map_or(Ok(()), |orbit| check_orbit(part, orbit).map_err(|fault| under("orbit", fault)))?;
    follow.as_ref().map_or(Ok(()), |follow| check_follow(part, follow).map_err(|fault| under("follow", fault)))
}

/// The fault of a key in a table of the camera, with the name of the table.
fn under(table: &str, fault: ScenarioFault) -> ScenarioFault {
    ScenarioFault { message: format!("{table}: {}", fault.message), ..fault }
}

fn check_orbit(part: &ScenarioPart, orbit: &CameraOrbit) -> Result<(), ScenarioFault> {
    let CameraOrbit { centre_m, radius_m, height_m, period_s, start_deg } = *orbit;
    check_point(part, "centre_m", centre_m)?;
    within(part, "radius_m", radius_m, &DISTANCE_M, "give the distance from the centre in metres")?;
    within(part, "height_m", height_m, &(0.0..=COORDINATE_MAX_M), "give the height in metres")?;
    within(part, "period_s", period_s.abs(), &(0.1..=*DURATION_S.end()), "give the time of one turn in seconds")?;
    within(part, "start_deg", start_deg, &(-3_600.0..=3_600.0), "give an angle in degrees")
}

fn check_follow(part: &ScenarioPart, follow: &CameraFollow) -> Result<(), ScenarioFault> {
    let offsets_m = [("behind_m", follow.behind_m), ("left_m", follow.left_m), ("height_m", follow.height_m)];
    offsets_m
        .into_iter()
        .try_for_each(|(name, offset_m)| within(part, name, offset_m, &OFFSET_M, "give a distance in metres"))
}

fn check_keys(part: &ScenarioPart, keys: &[CameraKey]) -> Result<(), ScenarioFault> {
    within(part, "the number of keys", keys.len(), &(0..=KEYS_MAX), "give fewer keys")?;
    for (index, key) in keys.iter().enumerate() {
        within(part, "time_s", key.time_s, &(-DURATION_S.end()..=*DURATION_S.end()), "give the time in seconds")
            .and_then(|()| check_view_line(part, key.eye_m, key.look_at_m))
            .and_then(|()| check_up(part, key.eye_m, key.look_at_m, key.up))
            .map_err(|fault| under(&format!("keys, entry {}", index + 1), fault))?;
    }
    match keys.windows(2).find(|pair| pair[1].time_s <= pair[0].time_s) {
        Some(pair) => {
            let message = format!("keys: the key at {} s follows the key at {} s", pair[1].time_s, pair[0].time_s);
            part.fault(message, "write keys in rising order of `time_s`")
        }
        None => Ok(()),
    }
}

fn check_view_line(part: &ScenarioPart, eye_m: Vec3, look_at_m: Vec3) -> Result<(), ScenarioFault> {
    check_point(part, "eye_m", eye_m)?;
    check_point(part, "look_at_m", look_at_m)?;
    if eye_m.distance(look_at_m) < 0.01 {
        return part.fault("look_at_m: the camera looks at its own position".into(), TARGET_HELP);
    }
    Ok(())
}

fn check_up(part: &ScenarioPart, eye_m: Vec3, look_at_m: Vec3, up: Option<Vec3>) -> Result<(), ScenarioFault> {
    let across = up.map(|up| (look_at_m - eye_m).normalize_or_zero().cross(up.normalize_or_zero()).length());
    match across.filter(|across| across.is_nan() || *across < 1e-3) {
        Some(_) => part.fault("`up` is no direction across the view".into(), "give a direction such as [0, 0, 1]"),
        None => Ok(()),
    }
}

fn check_point(part: &ScenarioPart, name: &str, point_m: Vec3) -> Result<(), ScenarioFault> {
    let range = -COORDINATE_MAX_M..=COORDINATE_MAX_M;
    let coordinates = point_m.to_array().into_iter();
    coordinates.zip(["x", "y", "z"]).try_for_each(|(at_m, axis)| {
        within(part, &format!("{axis} of {name}"), at_m, &range, "give a position in metres")
    })
}

fn check_lens(part: &ScenarioPart, camera: &CameraSpec) -> Result<(), ScenarioFault> {
    let CameraSpec { focal_mm, film_width_mm, fov_deg, width_m, fog_m, eyes_of, .. } = *camera;
    if camera.gltf.is_some() {
        return match (focal_mm, film_width_mm, fov_deg, width_m) {
            (None, None, None, None) => Ok(()),
            _ => part.fault(
                "the camera's file states its lens".into(),
                "remove focal_mm, film_width_mm, fov_deg and width_m",
            ),
        };
    }
    let lenses = [focal_mm.is_some(), fov_deg.is_some(), width_m.is_some()];
    match lenses.iter().filter(|is_stated| **is_stated).count() {
        1 => {}
        0 => return part.fault("the camera has no focal length".into(), LENS_HELP),
        _ => return part.fault("the camera has several lenses".into(), LENS_HELP),
    }
    if film_width_mm.is_some() && focal_mm.is_none() {
        return part.fault("`film_width_mm` belongs to `focal_mm`".into(), LENS_HELP);
    }
    if width_m.is_some() && eyes_of.is_some() {
        return part.fault("eyes see in perspective".into(), "replace `width_m` by `fov_deg`");
    }
    let lengths = [("focal_mm", focal_mm), ("film_width_mm", film_width_mm)];
    for (name, length_mm) in lengths.into_iter().filter_map(|(name, length)| Some((name, length?))) {
        within(part, name, length_mm, &LENGTH_MM, "give a length in millimetres, such as 35")?;
    }
    if let Some(fov_deg) = fov_deg {
        within(part, "fov_deg", fov_deg, &FOV_DEG, "give the angle between the left and the right edge in degrees")?;
    }
    for (name, distance_m) in [("width_m", width_m), ("fog_m", fog_m)] {
        if let Some(distance_m) = distance_m {
            within(part, name, distance_m, &DISTANCE_M, "give a distance in metres")?;
        }
    }
    // The film may be far wider than the focal length.
    match camera.width_tangent().filter(|tangent| *tangent > 23.0) {
        Some(_) => part.fault("the film is more than 23 times as wide as the focal length".into(), LENS_HELP),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use motiondb::files::SourceText;

    use crate::scenario::parse;

    /// Line of the error, and its text, for a scenario with these tables from line 3 on.
    fn fault_of(tables: &str) -> (usize, String) {
        let text = format!("duration_s = 1\nagents = {{ at_m = [0, 0], goals_m = [[1, 0]] }}\n{tables}\n");
        let source = SourceText { path: PathBuf::from("x.toml"), text };
        match parse(&source) {
            Ok((scenario, _)) => panic!("{tables} is accepted: {:?}", scenario.cameras),
            Err(crate::scenario::ScenarioError::Invalid(invalid)) => (invalid.line(), invalid.to_string()),
            Err(error) => panic!("{error}"),
        }
    }

    #[test]
    fn bad_cameras_are_errors_at_their_line() {
        let still = "eye_m = [0, -4, 1.6]\nlook_at_m = [0, 0, 1]";
        let cases = [
            (format!("[camera]\n{still}"), 3, "no focal length"),
            (format!("[camera]\n{still}\nfocal_mm = nan"), 6, "focal_mm is NaN"),
            ("[camera]\neye_m = [0, nan, 1]\nlook_at_m = [0, 0, 1]\nfocal_mm = 35".to_owned(), 4, "y of eye_m is NaN"),
            (format!("[camera]\n{still}\nfocal_mm = 35\nfov_deg = 40"), 3, "several lenses"),
            ("[camera]\nfov_deg = 40".to_owned(), 3, "no position"),
            (format!("[camera]\n{still}\neyes_of = 0\nfov_deg = 40"), 3, "several positions"),
            (format!("[camera]\n{still}\nfov_deg = 40\nzoom = 2"), 7, "zoom"),
            ("[camera]\neyes_of = 1\nfov_deg = 40".to_owned(), 4, "no agent 1: the agents are 0 to 0"),
            ("[camera]\nfov_deg = 40\nfollow = { agent = 7 }".to_owned(), 5, "no agent 7"),
            ("[camera]\neye_m = [0, 0, 1]\nlook_at_m = [0, 0, 1]\nfov_deg = 40".to_owned(), 5, "its own position"),
            (format!("[camera]\n{still}\nfov_deg = 40\nup = [0, 0, 0]"), 7, "`up` is no direction"),
            (
                "[camera]\nfov_deg = 40\norbit = { centre_m = [0, 0, inf], radius_m = 3, height_m = 2, period_s = 9 }"
                    .to_owned(),
                5,
                "orbit: z of centre_m is inf",
            ),
            (
                "[camera]\nfov_deg = 40\norbit = { centre_m = [0, 0, 1], radius_m = 0, height_m = 2, period_s = 9 }"
                    .to_owned(),
                5,
                "orbit: radius_m is 0",
            ),
            ("[camera]\nfov_deg = 40\nfollow = { agent = 0, left_m = 900 }".to_owned(), 5, "follow: left_m is 900"),
            (
                "[camera]\nfov_deg = 40\nkeys = [\n{ time_s = 0, eye_m = [0, 1, 1], look_at_m = [0, 0, 1] },\n\
                 { time_s = 0, eye_m = [0, 1, nan], look_at_m = [0, 0, 1] }]"
                    .to_owned(),
                5,
                "keys, entry 2: z of eye_m is NaN",
            ),
            (
                format!(
                    "[[cameras]]\nname = 'a'\n{still}\nfov_deg = 40\n[[cameras]]\nname = 'a'\n{still}\nfov_deg = 40"
                ),
                8,
                "two cameras",
            ),
        ];
        for (tables, line, words) in cases {
            let (at, message) = fault_of(&tables);
            assert!(at == line && message.contains(words), "{tables}\nline {at}: {message}");
        }
    }

    #[test]
    fn cameras_keep_their_order_and_defaults() {
        let text = "duration_s = 1\nagents = { at_m = [0, 0], goals_m = [[1, 0]] }\n[[cameras]]\nname = 'wide'\n\
                    orbit = { centre_m = [0, 0, 1], radius_m = 5, height_m = 2, period_s = 20 }\nfocal_mm = 18\n\
                    [[cameras]]\nname = 'behind'\nfollow = { agent = 0 }\nfov_deg = 50\n";
        let source = SourceText { path: PathBuf::from("x.toml"), text: text.to_owned() };
        let (scenario, _) = parse(&source).unwrap();
        let names: Vec<&str> = scenario.cameras.iter().map(|camera| camera.name.as_str()).collect();
        assert_eq!(names, ["wide", "behind"]);
        assert_eq!(scenario.cameras[0].width_tangent(), Some(2.0));
        assert_eq!(scenario.cameras[1].follow.unwrap().behind_m, 3.5);
    }
}
