//! Clips whose way is taken out tread on the spot as fast as they went.

use std::path::Path;

use glam::DVec3;
use motiondb::skeleton::{JOINT_COUNT, Joint};
use motiondb_compiler::skeleton_map::{Roles, find_roles};
use motiondb_compiler::source_clip::SourceClip;
use motiondb_compiler::{source_parameters, units};

use super::source;

const BUNDLED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");

/// Straight clips of every gait: name, v_f and ω_s in m/s (`assets/clips/README.md`).
const STRAIGHT: [(&str, [f64; 2]); 10] = [
    ("walk_050", [0.5, 0.0]),
    ("walk_080", [0.8, 0.0]),
    ("walk_110", [1.1, 0.0]),
    ("walk_180", [1.8, 0.0]),
    ("jog_240", [2.4, 0.0]),
    ("run_350", [3.5, 0.0]),
    ("side_060_left", [0.0, 0.6]),
    ("shuffle_120_left", [0.0, 1.2]),
    ("diagonal_080_040_left", [0.8, 0.4]),
    ("backward_110", [-1.1, 0.0]),
];

/// Takes the straight way from the first to the last frame out.
fn stay_in_place(clip: &mut SourceClip, roles: &Roles) {
    let hips =
        |frame: usize| 0.5 * Joint::THIGHS.map(|hip| clip.position(frame, roles.required(hip))).iter().sum::<DVec3>();
    let last = clip.frame_count() - 1;
    let way = (hips(last) - hips(0)).with_z(0.0) / last as f64;
    for (index, position) in clip.positions.iter_mut().enumerate() {
        *position -= way * (index / clip.joints.len()) as f64;
    }
}

#[test]
fn what_treads_on_the_spot_goes_as_fast_as_it_did() {
    let mut bad = Vec::new();
    for (name, wanted) in STRAIGHT {
        let clip = source(&Path::new(BUNDLED).join(format!("{name}.bvh")), "");
        let roles = find_roles(&clip, &[None; JOINT_COUNT]).unwrap();
        let (mut clip, _) = units::to_metres_z_up(clip, &roles);
        stay_in_place(&mut clip, &roles);
        let whole = source_parameters::measure(&clip, &roles);
        let found = [whole.speed_mps, whole.strafe_mps];
        let off = (0..2).map(|axis| (found[axis] - wanted[axis]).abs()).fold(0.0, f64::max);
        let limit = 0.03 * f64::hypot(wanted[0], wanted[1]);
        if !whole.in_place || off > limit {
            bad.push(format!("{name}: {found:.3?}, not {wanted:?}"));
        }
    }
    assert!(bad.is_empty(), "{}", bad.join("\n"));
}
