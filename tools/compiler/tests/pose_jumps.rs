//! Claims about jumps of the pose: no example is made across one, and it is reported with its time.

mod zoo {
    #![allow(dead_code, reason = "shared with the zoo's own tests")]
    pub(crate) mod body;
    pub(crate) mod file;
    pub(crate) mod names;
    pub(crate) mod rig;
}

use std::path::Path;

use glam::{DQuat, DVec3};
use motiondb::body::JOINT_COUNT;
use motiondb::diagnostic::{Diagnostic, Warning};
use motiondb::motion::{MotionDb, PHASE_COUNT};
use motiondb_compiler::{HumanClip, Options, compile, import_bytes};
use zoo::body::{Performance, part};
use zoo::file::{self, File};
use zoo::names::tools;
use zoo::rig::{self, Rest};

fn imported(body: &Performance) -> HumanClip {
    let rig = rig::build(body, &tools()[0], &[], Rest::TPose, || DQuat::IDENTITY);
    let text = file::write(body, &rig, &File::plain(100.0, 1.0));
    import_bytes(Path::new("capture.bvh"), text.as_bytes()).unwrap().remove(0).outcome.unwrap()
}

/// A walk whose arms jump at a second: from there on they hang otherwise.
fn walk_with_jump(at_s: f64) -> Performance {
    let mut body = Performance::read("walk_110");
    let first = (at_s * body.frame_rate_hz) as usize;
    for pose in &mut body.poses[first..] {
        for (side, sign) in [("Left", 1.0), ("Right", -1.0)] {
            let out = DQuat::from_rotation_z(sign * 0.9);
            for name in ["Arm", "ForeArm", "Hand"] {
                let turn = &mut pose.turns[part(&format!("{side}{name}"))];
                *turn = out * *turn;
            }
        }
    }
    body
}

/// Greatest angular acceleration of a joint in the examples, rad/s².
fn greatest_acceleration(db: &MotionDb) -> f32 {
    let of_example = |at: usize| {
        let step_s = db.examples[at].phase_map.period_s / PHASE_COUNT as f32;
        let turn = |joint: usize, row: usize| {
            let [from, to] = [row, row + 1].map(|row| db.rows.rotations(at, row % PHASE_COUNT)[joint]);
            (from.inverse() * to).to_scaled_axis() / step_s
        };
        let change = |joint: usize, row: usize| (turn(joint, row + 1) - turn(joint, row)).length() / step_s;
        (0..JOINT_COUNT * PHASE_COUNT).map(|at| change(at / PHASE_COUNT, at % PHASE_COUNT)).fold(0.0, f32::max)
    };
    (0..db.examples.len()).map(of_example).fold(0.0, f32::max)
}

fn jumps(clip: &HumanClip) -> Vec<(f32, u32)> {
    let found = clip.source.diagnostics.iter();
    found
        .filter_map(|found| match found {
            Diagnostic::Warning(Warning::PoseJumps { at_s, more, .. }) => Some((*at_s, *more)),
            _ => None,
        })
        .collect()
}

fn compiled(clip: HumanClip) -> MotionDb {
    compile(vec![clip], &Options::default(), &|_| ()).unwrap()
}

#[test]
fn a_jump_before_the_end_is_in_no_example() {
    let plain = imported(&Performance::read("walk_110"));
    let (duration_s, usual) =
        (plain.frames.len() as f64 / plain.frame_rate_hz, greatest_acceleration(&compiled(plain)));
    for before_end_s in [0.3, 0.8, 1.5, 0.5 * duration_s] {
        let at_s = duration_s - before_end_s;
        let clip = imported(&walk_with_jump(at_s));
        let [(found_s, 0)] = jumps(&clip)[..] else { panic!("{:?}", clip.source.diagnostics) };
        assert!((f64::from(found_s) - at_s).abs() < 0.05, "{found_s} s, not {at_s} s");
        let found = greatest_acceleration(&compiled(clip));
        assert!(found < 2.0 * usual, "{before_end_s} s before the end: {found} rad/s², without jump {usual}");
    }
}

#[test]
fn a_body_that_is_put_elsewhere_jumps() {
    let mut body = Performance::read("walk_110");
    let first = body.poses.len() / 2;
    body.poses[first..].iter_mut().for_each(|pose| pose.hips_m += 0.25 * DVec3::X);
    assert_eq!(jumps(&imported(&body)).len(), 1);
}

#[test]
fn runs_and_spins_do_not_jump() {
    for clip in ["walk_110", "run_350", "jog_turn_110_left", "spin_170_left", "idle"] {
        assert_eq!(jumps(&imported(&Performance::read(clip))), [], "{clip}");
    }
}
