//! Claims about posture: a body that kneels, crawls or crouches gives no example, and does not spoil its upright walk.

mod zoo {
    #![allow(dead_code, reason = "shared with the zoo's own tests")]
    pub(crate) mod body;
    pub(crate) mod file;
    pub(crate) mod names;
    pub(crate) mod rig;
}

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use glam::{DQuat, DVec3};
use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, Note, Posture, Unfit};
use motiondb::motion::MotionDb;
use motiondb_compiler::{ClipSettings, CompileError, HumanClip, Options, compile, import_bytes, import_with_settings};
use zoo::body::{PARTS, Performance, Pose, part};
use zoo::file::{self, File};
use zoo::names::tools;
use zoo::rig::{self, Rest};

/// Length of a thigh of the performer, m, and of a shank.
fn bones_m(body: &Performance) -> [f64; 2] {
    ["LeftLeg", "LeftFoot"].map(|name| body.offsets_m[part(name)].length())
}

/// The walk with other legs and trunk: `change` gets the pose, the facing and the phase of the stride in cycles.
fn changed(walk: &Performance, change: impl Fn(&mut Pose, DQuat, f64)) -> Performance {
    let mut body = walk.clone();
    for (frame, pose) in body.poses.iter_mut().enumerate() {
        let facing = pose.turns[0] * DVec3::Z;
        let turn = DQuat::from_rotation_y(libm::atan2(facing.x, facing.z));
        change(pose, turn, 0.9 * frame as f64 / walk.frame_rate_hz);
    }
    body
}

/// Turns both legs in the vertical plane of the facing: thigh and shank off the vertical, radians, + to the front.
fn set_leg(pose: &mut Pose, facing: DQuat, side: &str, [thigh_rad, shank_rad, foot_rad]: [f64; 3]) {
    let turns = [("UpLeg", thigh_rad), ("Leg", shank_rad), ("Foot", foot_rad), ("ToeBase", foot_rad)];
    for (name, angle_rad) in turns {
        pose.turns[part(&format!("{side}{name}"))] = facing * DQuat::from_rotation_x(-angle_rad);
    }
}

/// A body that walks on its knees: .4 m/s, the shanks behind it, toes pointed.
fn knee_walk(walk: &Performance) -> Performance {
    let [thigh_m, _] = bones_m(walk);
    let start = walk.poses[0].hips_m;
    changed(walk, |pose, facing, cycles| {
        for (side, offset) in [("Left", 0.0), ("Right", 0.5)] {
            // The thigh swings forward in a quarter of the cycle and back, on the ground, in the rest.
            let at = (cycles + offset).rem_euclid(1.0);
            let (swing, is_swing) = if at < 0.3 { (at / 0.3, true) } else { (1.0 - (at - 0.3) / 0.7, false) };
            let thigh_rad = 0.5 * (swing - 0.5);
            let lift_rad = if is_swing { 0.2 } else { 0.0 };
            set_leg(pose, facing, side, [thigh_rad, -1.45 - lift_rad, -2.6]);
        }
        let travel_m = (pose.hips_m - start).with_y(0.0) * 0.3;
        pose.hips_m = start.with_y(thigh_m + 0.05) + travel_m;
    })
}

/// A body that goes on hands and knees.
fn crawl(walk: &Performance) -> Performance {
    let upper = ["Spine", "Spine1", "Spine2", "Neck", "Head", "Hips"];
    let mut body = knee_walk(walk);
    for pose in &mut body.poses {
        let facing = pose.turns[0] * DVec3::Z;
        let turn = DQuat::from_rotation_y(libm::atan2(facing.x, facing.z));
        for name in upper.iter().copied().chain(["LeftShoulder", "RightShoulder"]) {
            pose.turns[part(name)] = turn * DQuat::from_rotation_x(1.35);
        }
        for (side, sign) in [("Left", 1.0), ("Right", -1.0)] {
            for name in ["Arm", "ForeArm", "Hand"] {
                pose.turns[part(&format!("{side}{name}"))] = turn * DQuat::from_rotation_z(-sign * 1.5);
            }
        }
    }
    body
}

/// A body that walks with its hips 30 cm lower, feet as before.
fn crouch(walk: &Performance) -> Performance {
    let [thigh_m, shank_m] = bones_m(walk);
    let positions: Vec<[DVec3; 22]> = walk.poses.iter().map(|pose| walk.positions_m(pose)).collect();
    let mut body = walk.clone();
    for (pose, positions_m) in body.poses.iter_mut().zip(positions) {
        let facing = pose.turns[0] * DVec3::Z;
        let turn = DQuat::from_rotation_y(libm::atan2(facing.x, facing.z));
        pose.hips_m.y -= 0.3;
        for side in ["Left", "Right"] {
            let [hip, ankle] = ["UpLeg", "Foot"].map(|name| positions_m[part(&format!("{side}{name}"))]);
            let leg = turn.inverse() * (ankle - (hip - 0.3 * DVec3::Y));
            let reach_m = leg.length().min(thigh_m + shank_m - 1e-3);
            let knee = |a: f64, b: f64| libm::acos((a * a + reach_m * reach_m - b * b) / (2.0 * a * reach_m));
            let leg_rad = libm::atan2(leg.z, -leg.y);
            let angles = [leg_rad + knee(thigh_m, shank_m), leg_rad - knee(shank_m, thigh_m)];
            let foot = pose.turns[part(&format!("{side}Foot"))];
            let toe = pose.turns[part(&format!("{side}ToeBase"))];
            set_leg(pose, turn, side, [angles[0], angles[1], 0.0]);
            pose.turns[part(&format!("{side}Foot"))] = foot;
            pose.turns[part(&format!("{side}ToeBase"))] = toe;
        }
    }
    body
}

/// A body that stands and bows from its hips, the arms along the trunk.
fn bow(bow_deg: f64) -> Performance {
    let is_of_leg = |name: &str| ["Leg", "Foot", "Toe"].iter().any(|part| name.contains(part));
    changed(&Performance::read("idle"), |pose, facing, _| {
        let turn = facing * DQuat::from_rotation_x(bow_deg.to_radians()) * facing.inverse();
        for name in PARTS.iter().filter(|name| !is_of_leg(name)) {
            pose.turns[part(name)] = turn * pose.turns[part(name)];
        }
    })
}

/// One capture of several parts, each from where the one before ends, with half a second between two.
fn capture(parts: &[&Performance]) -> Performance {
    let mut all = parts[0].clone();
    for part in &parts[1..] {
        let last = all.poses[all.poses.len() - 1].clone();
        let shift_m = (last.hips_m - part.poses[0].hips_m).with_y(0.0);
        let moved = |pose: &Pose| Pose { hips_m: pose.hips_m + shift_m, turns: pose.turns };
        let first = moved(&part.poses[0]);
        all.poses.extend((1..15).map(|frame| last.lerp(&first, f64::from(frame) / 15.0)));
        all.poses.extend(part.poses.iter().map(moved));
    }
    all
}

/// The text of a BVH file.
fn text(body: &Performance) -> String {
    let rig = rig::build(body, &tools()[0], &[], Rest::TPose, || DQuat::IDENTITY);
    file::write(body, &rig, &File::plain(100.0, 1.0))
}

fn imported(body: &Performance) -> HumanClip {
    import_bytes(Path::new("capture.bvh"), text(body).as_bytes()).unwrap().remove(0).outcome.unwrap()
}

fn compiled(body: &Performance) -> Result<MotionDb, CompileError> {
    compile(vec![imported(body)], &Options::default(), &|_| ())
}

fn walk() -> Performance {
    Performance::read("walk_110")
}

/// The parts that are not upright: posture, first and last second.
fn low_parts(clip: &HumanClip) -> Vec<(Posture, [f64; 2])> {
    let time_s = |frame: usize| frame as f64 / clip.frame_rate_hz;
    clip.low_parts.iter().map(|part| (part.posture, [time_s(part.frames.start), time_s(part.frames.end)])).collect()
}

#[test]
fn a_body_that_climbs_is_no_example_and_not_refused() {
    let walk = walk();
    let start = walk.poses[0].hips_m;
    let climb = changed(&walk, |pose, _, cycles| pose.hips_m = start + DVec3::Y * 0.5 * cycles);
    let unfit = imported(&climb).unfit;
    assert_eq!(unfit, Some(Unfit::MovesLengthwise));
}

#[track_caller]
fn check_posture(body: &Performance, posture: Posture) {
    let clip = imported(body);
    let found = low_parts(&clip);
    assert!(found.iter().all(|(found, _)| *found == posture) && !found.is_empty(), "{found:?}");
    let Err(CompileError::NoExample { sources, .. }) = compiled(body) else { panic!("{:?}", compiled(body)) };
    let reason = Diagnostic::NoExample(Unfit::NotUpright { posture });
    assert!(sources[0].diagnostics.contains(&reason), "{:?}", sources[0].diagnostics);
}

#[test]
fn bodies_that_are_not_upright_give_no_example() {
    check_posture(&knee_walk(&walk()), Posture::Kneeling);
    check_posture(&crouch(&walk()), Posture::Crouching);
    check_posture(&crawl(&walk()), Posture::OnHands);
    check_posture(&bow(70.0), Posture::BentOver);
    check_posture(&bow(58.0), Posture::BentOver);
    check_posture(&bow(48.0), Posture::BentOver);
}

#[test]
fn a_manifest_can_take_a_crawl_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("crawl.bvh");
    std::fs::write(&path, text(&crawl(&walk()))).unwrap();
    let settings = ClipSettings { takes_any_posture: true, ..ClipSettings::from(path) };
    let clip = import_with_settings(&settings).unwrap().remove(0).outcome.unwrap();
    assert_eq!((clip.source.up_axis.as_str(), &clip.unfit), ("+Y", &None));
    let db = compile(vec![clip], &Options::default(), &|_| ()).unwrap();
    assert!((db.examples[0].parameters.speed_mps - 0.33).abs() < 0.1, "{:?}", db.examples);
}

#[test]
fn a_bow_of_a_few_degrees_is_upright() {
    assert_eq!(low_parts(&imported(&bow(20.0))), []);
}

#[test]
fn a_long_crawl_does_not_hide_a_short_walk() {
    let crawl = crawl(&walk());
    let clip = imported(&capture(&[&walk(), &crawl, &crawl, &crawl, &crawl]));
    assert_eq!(clip.source.up_axis, "+Y");
    let [(Posture::OnHands, [from_s, to_s])] = low_parts(&clip)[..] else { panic!("{:?}", low_parts(&clip)) };
    assert!((from_s - 5.1).abs() < 0.4 && to_s > 20.0, "{from_s} to {to_s}");
}

/// A clip of a rig whose rest pose stands along z, though its bodies move with y up.
fn imported_with_rest_along_z(body: &Performance) -> HumanClip {
    let turn = DQuat::from_rotation_x(-FRAC_PI_2);
    let rig = rig::build(body, &tools()[0], &[], Rest::Any, || turn);
    let text = file::write(body, &rig, &File::plain(100.0, 1.0));
    import_bytes(Path::new("motion.bvh"), text.as_bytes()).unwrap().remove(0).outcome.unwrap()
}

#[test]
fn jumps_and_climbs_are_no_crawls_of_a_rig_that_walks() {
    let walk = walk();
    let start = walk.poses[0].hips_m;
    let raised = |height_m: &dyn Fn(f64) -> f64| {
        changed(&walk, |pose, _, cycles| pose.hips_m = start + DVec3::Y * height_m(cycles))
    };
    let climb = raised(&|cycles| 0.5 * cycles);
    let jumps = raised(&|cycles| 0.9 * libm::sin(3.0 * cycles).abs());
    for body in [climb, jumps] {
        let clips = [&walk, &body].map(imported_with_rest_along_z);
        assert_eq!(clips.each_ref().map(|clip| clip.seems_to_crawl), [false, true]);
        let db = compile(clips.to_vec(), &Options::default(), &|_| ()).unwrap();
        let found: Vec<&Diagnostic> = db.sources.iter().flat_map(|source| &source.diagnostics).collect();
        assert!(found.contains(&&Diagnostic::NoExample(Unfit::MovesLengthwise)), "{found:?}");
    }
}

#[test]
fn a_body_that_lies_is_no_idle_of_a_rig_that_walks() {
    for down_deg in [-90.0_f64, 90.0] {
        let mut lies = Performance::read("idle");
        for pose in &mut lies.poses {
            let across = DVec3::Y.cross((pose.turns[0] * DVec3::Z).with_y(0.0)).normalize();
            let turn = DQuat::from_axis_angle(across, down_deg.to_radians());
            pose.hips_m.y = 0.15;
            pose.turns = pose.turns.map(|part| turn * part);
        }
        let stills_of = |lies: HumanClip| {
            let db = compile(vec![imported(&walk()), lies], &Options::default(), &|_| ()).unwrap();
            let lies_down = |found: &Diagnostic| matches!(found, Diagnostic::NoExample(Unfit::LiesDown { .. }));
            let noted = db.sources.iter().any(|source| source.diagnostics.iter().any(lies_down));
            (db.examples.iter().filter(|example| example.parameters.speed_mps < 1.0).count(), noted)
        };
        let clip = imported(&lies);
        assert_eq!(stills_of(clip.clone()), (0, true), "{down_deg}°");
        let mut stated = clip.clone();
        stated.choices.is_up_stated = true;
        assert_eq!(stills_of(stated), (1, false), "{down_deg}°");
    }
    let upright = compile(vec![imported(&walk()), imported(&Performance::read("idle"))], &Options::default(), &|_| ());
    assert!(upright.unwrap().examples.iter().any(|example| example.parameters.speed_mps == 0.0));
}

#[test]
fn every_bundled_clip_is_upright() {
    for clip in ["walk_050", "walk_180", "jog_240", "run_350", "jog_turn_110_left", "backward_110", "idle"] {
        assert_eq!(low_parts(&imported(&Performance::read(clip))), [], "{clip}");
    }
}

#[test]
fn an_upright_walk_survives_knees_and_hands() {
    let alone = compiled(&walk()).unwrap();
    let all = capture(&[&walk(), &knee_walk(&walk()), &knee_walk(&walk()), &crawl(&walk()), &crawl(&walk())]);
    let db = compiled(&all).unwrap();
    let [walk] = &db.examples[..] else { panic!("{:#?}", db.examples) };
    assert!((walk.parameters.speed_mps - alone.examples[0].parameters.speed_mps).abs() < 0.05, "{walk:?}");
    let noted = |found: &Diagnostic| matches!(found, Diagnostic::Note(Note::LowPartsLeftOut { .. }));
    assert!(db.sources[0].diagnostics.iter().any(noted), "{:?}", db.sources[0].diagnostics);
    // Feet that kneel lie on their insteps: measured there, a sole would be turned by a right angle.
    for toe in Joint::TOES {
        let turn = |db: &MotionDb| db.skeleton.offsets_m[toe.index()];
        assert!(turn(&db).distance(turn(&alone)) < 0.02, "{:?}, not {:?}", turn(&db), turn(&alone));
    }
}

#[test]
fn a_manifest_can_take_any_posture() {
    let mut clip = imported(&capture(&[&walk(), &knee_walk(&walk()), &knee_walk(&walk()), &knee_walk(&walk())]));
    clip.choices.takes_any_posture = true;
    let db = compile(vec![clip], &Options::default(), &|_| ()).unwrap();
    let [knees, walk] = [0.33, 1.1].map(|speed_mps: f32| {
        db.examples.iter().position(|example| (example.parameters.speed_mps - speed_mps).abs() < 0.12)
    });
    assert!(knees.is_some(), "{:#?}", db.examples);
    assert_eq!(db.correspondence.map(|found| found.semi_procedural as usize), walk, "{:#?}", db.examples);
}

#[test]
fn with_any_posture_a_crowd_still_stands_upright() {
    let stand = |seconds: f64| {
        let mut idle = Performance::read("idle");
        idle.poses.truncate((seconds * idle.frame_rate_hz) as usize);
        idle
    };
    let mut clip = imported(&capture(&[&walk(), &stand(2.8), &crouch(&stand(4.0)), &walk()]));
    clip.choices.takes_any_posture = true;
    let db = compile(vec![clip], &Options::default(), &|_| ()).unwrap();
    let standing = db.examples.iter().find(|example| example.key_times_s.is_none()).unwrap();
    let crouched_s = 4.8 + 2.8;
    assert!(standing.window_s[1] < crouched_s + 1.0, "{standing:?}");
}

/// The bundled idle with its arms turned up by so many degrees off hanging, about the body's long axis of travel.
fn idle_with_arms(spread_deg: f64) -> Performance {
    changed(&Performance::read("idle"), |pose, facing, _| {
        for (side, sign) in [("Left", 1.0), ("Right", -1.0)] {
            let arm = facing * DQuat::from_rotation_z(sign * (spread_deg - 90.0).to_radians());
            for name in ["Arm", "ForeArm", "Hand"] {
                pose.turns[part(&format!("{side}{name}"))] = arm;
            }
        }
    })
}

#[test]
fn a_t_pose_is_no_idle() {
    let Err(CompileError::NoExample { sources, .. }) = compiled(&idle_with_arms(88.0)) else { panic!("accepted") };
    assert!(sources[0].diagnostics.contains(&Diagnostic::NoExample(Unfit::TPose)), "{:?}", sources[0].diagnostics);
    assert_eq!(compiled(&idle_with_arms(10.0)).unwrap().examples.len(), 1);
}

#[test]
fn of_idles_the_one_with_hanging_arms_is_blended() {
    let named = |name: &str, spread_deg: f64| {
        let mut clip = imported(&idle_with_arms(spread_deg));
        clip.name = name.to_owned();
        clip
    };
    let clips = vec![named("aims", 60.0), named("hangs", 10.0), imported(&walk())];
    let db = compile(clips, &Options::default(), &|_| ()).unwrap();
    let at_rest = db.blend_space.simplices.iter().map(|&corner| db.examples[corner as usize].name.as_str());
    let names: Vec<&str> = at_rest.collect();
    assert!(names.contains(&"hangs") && !names.contains(&"aims"), "{names:?}: {:#?}", db.sources);
}

#[test]
fn a_bind_pose_within_an_idle_is_left_out() {
    let idle = || Performance::read("idle");
    for spread_deg in [88.0, 45.0] {
        let db = compiled(&capture(&[&idle(), &idle_with_arms(spread_deg), &idle()])).unwrap();
        let ends_s =
            [idle().poses.len(), 2 * idle().poses.len()].map(|frame| frame as f32 / idle().frame_rate_hz as f32);
        let windows_s: Vec<[f32; 2]> = db.idles().map(|idle| idle.window_s).collect();
        assert!(!windows_s.is_empty(), "{spread_deg}: {:?}", db.sources[0].diagnostics);
        for [first_s, last_s] in windows_s {
            assert!(last_s < ends_s[0] + 0.1 || first_s > ends_s[1], "{spread_deg}: {first_s} to {last_s}");
        }
        let noted = |found: &Diagnostic| matches!(found, Diagnostic::Note(Note::RestsLeftOut { .. }));
        assert!(db.sources[0].diagnostics.iter().any(noted), "{spread_deg}: {:?}", db.sources[0].diagnostics);
    }
}

#[test]
fn a_body_on_a_turntable_is_no_idle() {
    let mut body = Performance::read("idle");
    let centre_m = body.poses[0].hips_m.with_y(0.0);
    let frame_rate_hz = body.frame_rate_hz;
    for (frame, pose) in body.poses.iter_mut().enumerate() {
        let share = ((frame as f64 / frame_rate_hz - 2.0) / 2.0).clamp(0.0, 1.0);
        let turn = DQuat::from_rotation_y(1.4 * share * share * (3.0 - 2.0 * share));
        pose.hips_m = centre_m + turn * (pose.hips_m - centre_m);
        pose.turns = pose.turns.map(|part| turn * part);
    }
    let db = compiled(&body).unwrap();
    for idle in db.idles() {
        let [first_s, last_s] = idle.window_s;
        assert!(last_s < 2.6 || first_s > 3.4, "{first_s} to {last_s}");
    }
}
