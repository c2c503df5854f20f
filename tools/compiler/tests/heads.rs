//! Claims about heads: a head that is bent throughout a clip stays bent, an offset of the rig does not.

mod zoo {
    #![allow(dead_code, reason = "shared with the zoo's own tests")]
    pub(crate) mod body;
    pub(crate) mod file;
    pub(crate) mod names;
    pub(crate) mod rig;
}

use std::path::Path;

use glam::{DQuat, DVec3, Vec3};
use motiondb::body::Joint;
use motiondb::motion::{MotionDb, PHASE_COUNT};
use motiondb_compiler::{HumanClip, Options, compile, import_bytes};
use zoo::body::{Performance, Pose, part};
use zoo::file::{self, File};
use zoo::names::tools;
use zoo::rig::{self, Rest};

const CLIPS: [&str; 7] =
    ["walk_050", "walk_080", "walk_110", "walk_180", "turn_060_left", "turn_090_left", "side_060_left"];
/// Greatest change of the median of seven clips by one that is bent, degrees.
const TOLERANCE_DEG: f32 = 3.0;

/// The clip with its head pitched down by an angle in the whole clip, on a rig of which the head's axes are turned.
fn imported(clip: &str, down_rad: f64, rig_turn: DQuat) -> HumanClip {
    written(clip, &with_bent_head(clip, down_rad, rig_turn))
}

fn with_bent_head(clip: &str, down_rad: f64, rig_turn: DQuat) -> Performance {
    let mut body = Performance::read(clip);
    for pose in &mut body.poses {
        let across = across(pose);
        let head = &mut pose.turns[part("Head")];
        *head = DQuat::from_axis_angle(across, down_rad) * *head * rig_turn;
    }
    body
}

/// The left of a body that is upright.
fn across(pose: &Pose) -> DVec3 {
    DVec3::Y.cross((pose.turns[0] * DVec3::Z).with_y(0.0)).normalize()
}

/// The clip that a file of this performance gives; its zero pose is no body.
fn written(clip: &str, body: &Performance) -> HumanClip {
    written_at_rest(clip, body, Rest::Along(0))
}

fn written_at_rest(clip: &str, body: &Performance, rest: Rest) -> HumanClip {
    let rig = rig::build(body, &tools()[0], &[], rest, || DQuat::IDENTITY);
    let text = file::write(body, &rig, &File::plain(100.0, 1.0));
    import_bytes(Path::new(&format!("{clip}.bvh")), text.as_bytes()).unwrap().remove(0).outcome.unwrap()
}

/// Mean pitch of the head of an example, degrees, + down.
fn pitch_deg(db: &MotionDb, name: &str) -> f32 {
    let example = db.examples.iter().position(|example| example.name == name).unwrap();
    let forward = |row: usize| {
        let mut turn = glam::Quat::IDENTITY;
        let mut joint = Some(Joint::Head);
        while let Some(at) = joint {
            turn = db.rows.rotations(example, row)[at.index()] * turn;
            joint = at.parent();
        }
        turn * Vec3::X
    };
    let sum = (0..PHASE_COUNT).map(forward).sum::<Vec3>();
    libm::atan2f(-sum.z, libm::hypotf(sum.x, sum.y)).to_degrees()
}

fn compiled(bent: &[&str], down_deg: f64, rig_turn: DQuat) -> MotionDb {
    let down_rad = |clip: &str| if bent.contains(&clip) { down_deg.to_radians() } else { 0.0 };
    let clips = CLIPS.map(|clip| imported(clip, down_rad(clip), rig_turn));
    compile(clips.to_vec(), &Options::default(), &|_| ()).unwrap()
}

#[test]
fn a_bent_head_stays_bent_and_the_others_level() {
    let plain = compiled(&[], 0.0, DQuat::IDENTITY);
    for rig_turn in [DQuat::IDENTITY, DQuat::from_rotation_x(0.7), DQuat::from_rotation_y(1.4)] {
        let db = compiled(&["walk_110"], 25.0, rig_turn);
        for clip in CLIPS {
            let bend_deg = pitch_deg(&db, clip) - pitch_deg(&plain, clip);
            let wanted_deg = if clip == "walk_110" { 25.0 } else { 0.0 };
            assert!((bend_deg - wanted_deg).abs() < TOLERANCE_DEG, "{clip}: {bend_deg}°, not {wanted_deg}°");
        }
    }
}

#[test]
fn a_clip_alone_has_a_level_head() {
    let level = |down_deg: f64| {
        let clip = imported("walk_110", down_deg.to_radians(), DQuat::from_rotation_x(0.4));
        pitch_deg(&compile(vec![clip], &Options::default(), &|_| ()).unwrap(), "walk_110")
    };
    assert!((level(0.0) - level(25.0)).abs() < 0.5);
}

#[test]
fn a_rest_pose_shows_the_bent_head_of_a_lone_clip() {
    let pitch_of = |down_deg: f64, rest: Rest| {
        let body = with_bent_head("walk_110", down_deg.to_radians(), DQuat::IDENTITY);
        let clip = written_at_rest("walk_110", &body, rest);
        pitch_deg(&compile(vec![clip], &Options::default(), &|_| ()).unwrap(), "walk_110")
    };
    for rest in [Rest::TPose, Rest::APose, Rest::ArmsDown] {
        let bend_deg = pitch_of(25.0, rest) - pitch_of(0.0, rest);
        assert!((bend_deg - 25.0).abs() < TOLERANCE_DEG + 3.0, "{rest:?}: {bend_deg}°");
    }
}

#[test]
fn a_body_that_lies_bends_no_head_of_its_walk() {
    let pitch_of = |body: &Performance| {
        let clip = written("walk_110", body);
        pitch_deg(&compile(vec![clip], &Options::default(), &|_| ()).unwrap(), "walk_110")
    };
    let walk = Performance::read("walk_110");
    for down_deg in [-90.0_f64, 90.0] {
        let mut lies = walk.clone();
        lies.poses.truncate(walk.poses.len() / 2);
        for pose in &mut lies.poses {
            let turn = DQuat::from_axis_angle(across(pose), down_deg.to_radians());
            pose.hips_m.y = 0.15;
            pose.turns = pose.turns.map(|part| turn * part);
        }
        lies.poses.splice(0..0, walk.poses.iter().cloned());
        let bend_deg = pitch_of(&lies) - pitch_of(&walk);
        assert!(bend_deg.abs() < TOLERANCE_DEG, "{down_deg}: {bend_deg}°");
    }
}
