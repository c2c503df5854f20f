//! A rig's performance as BVH text, in a file's own axes, unit and channels.

use std::fmt::Write as _;

use glam::{DMat3, DQuat, DVec3, EulerRot};

use super::body::{Performance, Pose};
use super::rig::Rig;

/// Three rotation channels, outermost first.
pub(crate) const ORDERS: [(EulerRot, [usize; 3]); 6] = [
    (EulerRot::XYZ, [0, 1, 2]),
    (EulerRot::XZY, [0, 2, 1]),
    (EulerRot::YXZ, [1, 0, 2]),
    (EulerRot::YZX, [1, 2, 0]),
    (EulerRot::ZXY, [2, 0, 1]),
    (EulerRot::ZYX, [2, 1, 0]),
];

/// What position channels do to a root's OFFSET.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RootOffset {
    Zero,
    Replaced,
    Added,
}

/// How a tool writes its files.
#[derive(Clone, Copy, Debug)]
pub(crate) struct File {
    /// From x left, y up, z forward to the file's axes.
    pub axes: DQuat,
    /// File units to a metre.
    pub units_per_m: f64,
    /// All of the performer over an adult.
    pub size: f64,
    pub shift_m: DVec3,
    pub order: usize,
    pub rotations_first: bool,
    pub positions_everywhere: bool,
    pub root_offset: RootOffset,
    /// The file's handedness is the wrong one: everything mirrored.
    pub is_left_handed: bool,
}

impl File {
    /// A file of y up and z forward, its channels in the usual order, its root at the origin.
    pub(crate) fn plain(units_per_m: f64, size: f64) -> Self {
        Self {
            axes: DQuat::IDENTITY,
            units_per_m,
            size,
            shift_m: DVec3::ZERO,
            order: 0,
            rotations_first: false,
            positions_everywhere: false,
            root_offset: RootOffset::Replaced,
            is_left_handed: false,
        }
    }
}

struct Track {
    offset: DVec3,
    /// Position and rotation against the parent.
    locals: Vec<(DVec3, DQuat)>,
    moves: bool,
}

/// The text of the file.
pub(crate) fn write(body: &Performance, rig: &Rig, file: &File) -> String {
    let globals: Vec<Vec<(DVec3, DQuat)>> = body.poses.iter().map(|pose| globals(body, rig, file, pose)).collect();
    let tracks: Vec<Track> = (0..rig.bones.len()).map(|bone| track(rig, file, &globals, bone)).collect();
    let mut text = String::from("HIERARCHY\n");
    hierarchy(&mut text, rig, file, &tracks, 0);
    let _ = write!(text, "MOTION\nFrames: {}\nFrame Time: {:.8}\n", body.poses.len(), 1.0 / body.frame_rate_hz);
    for frame in 0..body.poses.len() {
        let mut row = Vec::new();
        numbers(&mut row, rig, file, &tracks, frame, 0);
        let row: Vec<String> = row.iter().map(|value| format!("{value:.6}")).collect();
        let _ = writeln!(text, "{}", row.join(" "));
    }
    text
}

fn globals(body: &Performance, rig: &Rig, file: &File, pose: &Pose) -> Vec<(DVec3, DQuat)> {
    let positions_m = body.positions_m(pose);
    let global = |bone: &super::rig::Bone| {
        let (position_m, turn) = match bone.part {
            Some(part) => (positions_m[part] + pose.turns[part] * bone.position_m, pose.turns[part] * bone.rest),
            None => (DVec3::ZERO, DQuat::IDENTITY),
        };
        let position = file.axes * (position_m * file.size + file.shift_m) * file.units_per_m;
        let turn = (file.axes * turn).normalize();
        if file.is_left_handed { (position * DVec3::new(-1.0, 1.0, 1.0), reflected(turn)) } else { (position, turn) }
    };
    rig.bones.iter().map(global).collect()
}

fn reflected(turn: DQuat) -> DQuat {
    DQuat::from_xyzw(turn.x, -turn.y, -turn.z, turn.w)
}

fn track(rig: &Rig, file: &File, globals: &[Vec<(DVec3, DQuat)>], bone: usize) -> Track {
    let local = |frame: &Vec<(DVec3, DQuat)>| {
        let (position, turn) = frame[bone];
        match rig.bones[bone].parent {
            Some(parent) => {
                let (from, back) = (frame[parent].0, frame[parent].1.inverse());
                (back * (position - from), back * turn)
            }
            None => (position, turn),
        }
    };
    let locals: Vec<(DVec3, DQuat)> = globals.iter().map(local).collect();
    let mean = locals.iter().map(|(position, _)| *position).sum::<DVec3>() / locals.len() as f64;
    let is_root = rig.bones[bone].parent.is_none();
    let first = locals[0].0;
    let offset = match file.root_offset {
        _ if !rig.bones[bone].is_loose => mean,
        RootOffset::Zero => DVec3::ZERO,
        RootOffset::Replaced => first,
        RootOffset::Added => first,
    };
    let moves = is_root || rig.bones[bone].is_loose || file.positions_everywhere;
    let is_added = file.root_offset == RootOffset::Added && (is_root || rig.bones[bone].part == Some(0));
    let value = |(position, turn): (DVec3, DQuat)| match rig.bones[bone].is_loose {
        true if is_added => (position - offset, turn),
        true => (position, turn),
        false => (offset, turn),
    };
    Track { offset, locals: locals.into_iter().map(value).collect(), moves }
}

fn children(rig: &Rig, bone: usize) -> impl Iterator<Item = usize> {
    (0..rig.bones.len()).filter(move |&child| rig.bones[child].parent == Some(bone))
}

fn hierarchy(text: &mut String, rig: &Rig, file: &File, tracks: &[Track], bone: usize) {
    let keyword = if rig.bones[bone].parent.is_none() { "ROOT" } else { "JOINT" };
    let offset = tracks[bone].offset;
    let rotations = ORDERS[file.order].1.map(|axis| ["Xrotation", "Yrotation", "Zrotation"][axis]).join(" ");
    let channels = match (tracks[bone].moves, file.rotations_first) {
        (false, _) => format!("3 {rotations}"),
        (true, false) => format!("6 Xposition Yposition Zposition {rotations}"),
        (true, true) => format!("6 {rotations} Xposition Yposition Zposition"),
    };
    let _ = writeln!(text, "{keyword} {}\n{{", rig.bones[bone].name);
    let _ = writeln!(text, "OFFSET {:.6} {:.6} {:.6}\nCHANNELS {channels}", offset.x, offset.y, offset.z);
    for child in children(rig, bone) {
        hierarchy(text, rig, file, tracks, child);
    }
    if children(rig, bone).next().is_none() {
        text.push_str("End Site\n{\nOFFSET 0 0 0\n}\n");
    }
    text.push_str("}\n");
}

fn numbers(row: &mut Vec<f64>, rig: &Rig, file: &File, tracks: &[Track], frame: usize, bone: usize) {
    let (position, turn) = tracks[bone].locals[frame];
    let angles = DMat3::from_quat(turn).to_euler(ORDERS[file.order].0);
    let angles = [angles.0, angles.1, angles.2].map(f64::to_degrees);
    if file.rotations_first {
        row.extend(angles);
    }
    if tracks[bone].moves {
        row.extend(position.to_array());
    }
    if !file.rotations_first {
        row.extend(angles);
    }
    for child in children(rig, bone) {
        numbers(row, rig, file, tracks, frame, child);
    }
}
