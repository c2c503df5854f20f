//! The motion database as the runtime holds it: read once, shared by every agent.

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::blend_space::space::BlendSpace;
use crate::body::pose::{Joints, Pose};
use crate::body::skeleton::{JOINT_COUNT, Skeleton};
use crate::diagnostic::Diagnostic;
use crate::motion::correspondence::Correspondence;
use crate::motion::parameters::Parameters;
use crate::motion::phase_map::PhaseMap;
use crate::velocity_sets::velocity_hull::VelocityHull;

/// Uniform phases at which every cycle is stored.
pub const PHASE_COUNT: usize = 64;

/// Everything that the runtime knows of motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionDb {
    /// The body that all examples are retargeted to.
    pub skeleton: Skeleton,
    /// Every clip that was read, sorted by file name and clip name.
    pub sources: Vec<SourceRecord>,
    /// Closed, phase-aligned cycles, sorted by name.
    pub examples: Vec<MotionExample>,
    /// Their poses.
    pub rows: Rows,
    /// The velocity sets of §4.1.
    pub velocity_hull: VelocityHull,
    /// Simplices in (v_f, ω_t, ω_s).
    pub blend_space: BlendSpace,
    /// Absent where there are fewer than two cycles with steps.
    pub correspondence: Option<Correspondence>,
}

impl MotionDb {
    /// The joints of one example in every row, in the root frame.
    pub fn posed_rows(&self, example: usize) -> Vec<Joints> {
        (0..PHASE_COUNT).map(|phase| self.rows.pose(example, phase).forward_kinematics(&self.skeleton)).collect()
    }
}

/// One closed cycle: one stride, right and left step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionExample {
    /// Unique in the database: the clip's name, `@12.4s` appended to windows after its first, `_mirrored` to mirrors.
    pub name: String,
    /// Index into [`MotionDb::sources`].
    pub source: u32,
    /// The part of the source that it was made from, first and last second, from the file's first frame on.
    pub window_s: [f32; 2],
    /// Left and right were exchanged.
    pub mirrored: bool,
    /// The root's motion in one cycle, scaled to the database's skeleton.
    pub parameters: Parameters,
    /// Phase to time.
    pub phase_map: PhaseMap,
    /// Right toe-off, right heel strike, left toe-off, left heel strike, seconds from phase 0; none for a body that
    /// stands.
    pub key_times_s: Option<[f32; 4]>,
    /// Planted-foot slide of the cycle, cm/s, by the contacts of its rows.
    pub planted_slide_cm_s: f32,
    /// Share of the cycle that a foot is planted, mean of both.
    pub planted_share: f32,
}

impl MotionExample {
    /// Whether both were made from the same stretch of the same source: an example and its mirror.
    pub fn is_of_one_window_with(&self, other: &Self) -> bool {
        self.source == other.source && self.window_s == other.window_s
    }
}

/// Poses of all examples at [`PHASE_COUNT`] uniform phases, flat: index (example · 64 + phase), then joint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rows {
    /// Local joint rotations, hemisphere-aligned over all rows of all examples, so that a blend is a weighted sum.
    pub rotations: Vec<Quat>,
    /// Pelvis joint in the root frame, metres.
    pub pelvis_m: Vec<Vec3>,
    /// Contact of each foot, `[left, right]`, 0 to 1.
    pub contacts: Vec<[f32; 2]>,
}

impl Rows {
    /// Rotations of one row.
    pub fn rotations(&self, example: usize, phase: usize) -> &[Quat; JOINT_COUNT] {
        let start = (example * PHASE_COUNT + phase) * JOINT_COUNT;
        self.rotations[start..].first_chunk().expect("validated: every row is whole")
    }

    /// The pose of one row.
    pub fn pose(&self, example: usize, phase: usize) -> Pose {
        Pose { pelvis_m: self.pelvis_m[example * PHASE_COUNT + phase], rotations: *self.rotations(example, phase) }
    }

    /// Adds a row of a new example, in the hemisphere of the row (example, phase): no joint is turned so far from it
    /// that it would belong into the other.
    pub fn push_like(&mut self, (example, phase): (usize, usize), pose: &Pose, contacts: [f32; 2]) {
        let mut rotations = pose.rotations;
        for (rotation, like) in rotations.iter_mut().zip(self.rotations(example, phase)) {
            *rotation = if rotation.dot(*like) < 0.0 { -*rotation } else { *rotation };
        }
        self.rotations.extend(rotations);
        self.pelvis_m.push(pose.pelvis_m);
        self.contacts.push(contacts);
    }

    /// The weighted sum of rows (example, phase, weight), whose weights sum to 1.
    pub fn blended(&self, rows: impl IntoIterator<Item = (usize, usize, f32)>) -> Pose {
        let mut pose = Pose { pelvis_m: Vec3::ZERO, rotations: [Quat::from_xyzw(0.0, 0.0, 0.0, 0.0); JOINT_COUNT] };
        for (example, phase, weight) in rows {
            pose.pelvis_m += weight * self.pelvis_m[example * PHASE_COUNT + phase];
            for (sum, rotation) in pose.rotations.iter_mut().zip(self.rotations(example, phase)) {
                *sum += *rotation * weight;
            }
        }
        // Rows share a hemisphere, so a sum is never near zero.
        pose.rotations.iter_mut().for_each(|rotation| *rotation = rotation.normalize());
        pose
    }

    /// The mean over a cycle.
    pub fn mean_pose(&self, example: usize) -> Pose {
        self.blended((0..PHASE_COUNT).map(|phase| (example, phase, 1.0 / PHASE_COUNT as f32)))
    }
}

/// What was found in one source clip. Parameters are whole-clip means on the source's own skeleton, before any scaling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SourceRecord {
    /// File name without folders.
    pub file: String,
    /// Clip within the file; empty where a file holds one unnamed clip.
    pub clip: String,
    /// v_f, m/s.
    pub speed_mps: f32,
    /// ω_t, rad/s.
    pub turn_rate_rad_s: f32,
    /// ω_s, m/s.
    pub strafe_mps: f32,
    /// `+X` … `-Z` in the source's axes.
    pub up_axis: String,
    /// Metres per unit of the source.
    pub metres_per_unit: f32,
    /// Frames a second.
    pub frame_rate_hz: f32,
    /// What a user should know: wrong headers, no steady cycle, snapped parameters.
    pub diagnostics: Vec<Diagnostic>,
}
