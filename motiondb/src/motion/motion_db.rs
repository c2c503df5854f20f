//! The motion database in memory: loaded once, read by every body.
//!
//! Poses are in the root frame (x forward, y left, z up, on the ground), metres and seconds. Velocities of joints are
//! derived, not stored.

use std::array;

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::blend_space::locator::Locator;
use crate::blend_space::space::BlendSpace;
use crate::body::pose::{Joints, Pose};
use crate::body::skeleton::{JOINT_COUNT, Skeleton};
use crate::diagnostic::Diagnostic;
use crate::motion::action::{Action, ActionKind};
use crate::motion::extra_motion::ExtraMotion;
use crate::motion::parameters::Parameters;
pub use crate::motion::phase_map::PHASE_COUNT;
use crate::motion::phase_map::PhaseMap;
use crate::velocity_sets::velocity_hull::VelocityHull;

/// A motion database: the target body, its examples, and what follows from them.
///
/// ```no_run
/// use std::path::Path;
///
/// use motiondb::files::database_file;
///
/// let (db, _checksum) = database_file::load(Path::new("motion.fbdb"))?;
/// for (index, example) in db.examples.iter().enumerate() {
///     let joints = &db.posed_rows(index)[0];
///     println!("{}: the pelvis starts at {:.2} m", example.name, joints.positions_m[0].z);
/// }
/// # Ok::<(), motiondb::files::database_file::FileError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionDb {
    /// Body to which all examples are retargeted.
    pub skeleton: Skeleton,
    /// Every clip that was read, sorted by file name and clip name.
    pub sources: Vec<SourceRecord>,
    /// Closed, phase-aligned cycles, sorted by name.
    pub examples: Vec<MotionExample>,
    /// Poses of all examples.
    pub rows: Rows,
    /// Velocity sets of the examples (`FbCrowd` §4.1).
    pub velocity_hull: VelocityHull,
    /// Simplices between the examples in (v_f, ω_t, ω_s) (`FbCrowd` §5).
    pub blend_space: BlendSpace,
    /// Times at which synthesis may switch; `None` if fewer than two examples step.
    pub correspondence: Option<Correspondence>,
    /// Idles, the best first, then transitions by kind and name.
    pub actions: Vec<Action>,
    /// Motion of the joints beside the 22 roles; all styles have the same joints.
    // The file holds this field and the next two after the others, and only where they are not empty.
    #[serde(skip)]
    pub extra: ExtraMotion,
    /// The style of all clips, such as `elderly`; empty where none is stated or found.
    #[serde(skip)]
    pub style: String,
    /// Databases of further styles over the same skeleton, sorted by style. They have no further styles themselves.
    #[serde(skip)]
    pub further_styles: Vec<Self>,
}

impl MotionDb {
    /// Joints of one example in every row, root frame.
    pub fn posed_rows(&self, example: usize) -> Vec<Joints> {
        (0..PHASE_COUNT).map(|phase| self.rows.pose(example, phase).forward_kinematics(&self.skeleton)).collect()
    }

    /// The databases of all styles: this one, which serves agents without a style, then the further ones.
    pub fn styles(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(&self.further_styles)
    }

    /// The database of a style; `None` where the set lacks it.
    pub fn of_style(&self, style: &str) -> Option<&Self> {
        self.styles().find(|db| db.style == style)
    }

    /// The names of all styles, that of agents without a style first; empty for clips without style.
    pub fn style_names(&self) -> Vec<String> {
        self.styles().map(|db| db.style.clone()).collect()
    }

    /// Whether the set distinguishes styles.
    pub fn has_styles(&self) -> bool {
        !self.style.is_empty() || !self.further_styles.is_empty()
    }

    /// Whether a style has joints beside the 22 roles.
    pub fn has_extra_joints(&self) -> bool {
        self.styles().any(|db| !db.extra.is_empty())
    }

    /// The idles, the best first; they are the first actions.
    pub fn idles(&self) -> impl Iterator<Item = &Action> {
        self.actions.iter().take_while(|action| action.kind == ActionKind::Idle)
    }

    /// Rotations of the extra joints in the two frames of an action next to a time from its first frame, s, and the
    /// shares of both.
    pub fn extra_frames(&self, action: usize, time_s: f32) -> [(&[Quat], f32); 2] {
        let ([index, next], share) = self.actions[action].frames_at(time_s);
        [(self.extra.frame(action, index), 1.0 - share), (self.extra.frame(action, next), share)]
    }

    /// Parameters of all examples, by index.
    pub fn parameters(&self) -> impl Iterator<Item = Parameters> {
        self.examples.iter().map(|example| example.parameters)
    }

    /// The locator of the database's blend space.
    pub fn locator(&self) -> Locator {
        Locator::new(&self.blend_space, &self.parameters().collect::<Vec<_>>())
    }
}

/// Times T at which the poses of m_sp and m_mb are most alike, so that synthesis may switch (`FbCrowd` §5, Eq. 10).
/// [`Correspondence::of`] finds them.
///
/// ```no_run
/// use motiondb::{Correspondence, MotionDb};
///
/// fn print_switching_times(db: &MotionDb, base_walk: usize) {
///     let Some(found) = Correspondence::of(db, base_walk) else { return };
///     for [base_s, other_s] in found.pairs_s {
///         println!("{base_s:.2} s of the base walk, {other_s:.2} s of {}", db.examples[found.blending as usize].name);
///     }
/// }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Correspondence {
    /// m_sp: index of the base walk, which semi-procedural locomotion deforms.
    pub semi_procedural: u32,
    /// m_mb: index of the other stepping example that is nearest to m_sp in (v_f, ω_t, ω_s).
    pub blending: u32,
    /// T: pairs [t_sp, t_mb], seconds from phase 0 of each cycle, in order of t_sp; cyclic and monotone in both.
    pub pairs_s: Vec<[f32; 2]>,
}

/// One closed cycle: one stride, a right and a left step. A standing body is an example too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionExample {
    /// Unique name: the clip's; later windows of a clip end in `@12.4s`, mirrored examples in `_mirrored`.
    pub name: String,
    /// Index of the source in [`MotionDb::sources`].
    pub source: u32,
    /// First and last second of the source's part that the example was made from, from the file's first frame.
    pub window_s: [f32; 2],
    /// Whether left and right were exchanged.
    pub mirrored: bool,
    /// Motion of the root over one cycle, scaled to the database's skeleton.
    pub parameters: Parameters,
    /// Map from phase to time.
    pub phase_map: PhaseMap,
    /// Right toe-off, right heel strike, left toe-off, left heel strike, seconds from phase 0; `None` if it stands.
    pub key_times_s: Option<[f32; 4]>,
    /// Slide of the planted feet over the cycle, by the contacts of its rows, cm/s.
    pub planted_slide_cm_s: f32,
    /// Share of the cycle in which a foot is planted, mean of both feet.
    pub planted_share: f32,
}

impl MotionExample {
    /// Whether both were made from the same part of the same source: an example and its mirror image.
    pub fn is_of_one_window_with(&self, other: &Self) -> bool {
        self.source == other.source && self.window_s == other.window_s
    }
}

/// Poses of all examples at [`PHASE_COUNT`] uniform phases, as flat arrays. Row of an example at a phase: example · 64
/// + phase.
///
/// ```
/// use glam::{Quat, Vec3};
/// use motiondb::{JOINT_COUNT, PHASE_COUNT, Rows};
///
/// // Two standing examples, with the pelvis at 0.9 and 1.0 m.
/// let rows = Rows {
///     rotations: vec![Quat::IDENTITY; 2 * PHASE_COUNT * JOINT_COUNT],
///     pelvis_m: [0.9, 1.0].into_iter().flat_map(|height_m| [Vec3::Z * height_m; PHASE_COUNT]).collect(),
///     contacts: vec![[1.0; 2]; 2 * PHASE_COUNT],
/// };
/// let between = rows.blended([(0, 0, 0.25), (1, 0, 0.75)]);
/// assert!((between.pelvis_m.z - 0.975).abs() < 1e-6);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rows {
    /// Joint rotations relative to the parent, row by row, in one hemisphere over all rows: a blend is a weighted sum.
    pub rotations: Vec<Quat>,
    /// Position of the pelvis joint in the root frame, by row, metres.
    pub pelvis_m: Vec<Vec3>,
    /// Contact of each foot with the ground, `[left, right]`, by row, 0 to 1.
    pub contacts: Vec<[f32; 2]>,
}

impl Rows {
    /// Joint rotations of one row.
    pub fn rotations(&self, example: usize, phase: usize) -> &[Quat; JOINT_COUNT] {
        let start = (example * PHASE_COUNT + phase) * JOINT_COUNT;
        self.rotations[start..].first_chunk().expect("validated: every row is whole")
    }

    /// Pose of one row.
    pub fn pose(&self, example: usize, phase: usize) -> Pose {
        Pose { pelvis_m: self.pelvis_m[example * PHASE_COUNT + phase], rotations: *self.rotations(example, phase) }
    }

    /// Appends a row of a new example, aligned to the hemisphere of the row (example, phase). Each joint of the pose
    /// must be within half a turn of that row.
    pub fn push_like(&mut self, (example, phase): (usize, usize), pose: &Pose, contacts: [f32; 2]) {
        let mut rotations = pose.rotations;
        for (rotation, like) in rotations.iter_mut().zip(self.rotations(example, phase)) {
            *rotation = if rotation.dot(*like) < 0.0 { -*rotation } else { *rotation };
        }
        self.rotations.extend(rotations);
        self.pelvis_m.push(pose.pelvis_m);
        self.contacts.push(contacts);
    }

    /// Weighted sum of rows (example, phase, weight). The weights must sum to 1.
    pub fn blended(&self, rows: impl IntoIterator<Item = (usize, usize, f32)>) -> Pose {
        weighted_sum(&rows.into_iter().map(|row| self.weighted(row)).collect::<Vec<_>>())
    }

    /// Weighted sum of a pose, in the hemisphere of the rows, and of rows (example, phase, weight). The weights must sum
    /// to 1.
    pub fn blended_with(&self, pose: &Pose, weight: f32, rows: impl IntoIterator<Item = (usize, usize, f32)>) -> Pose {
        let rows = rows.into_iter().map(|row| self.weighted(row));
        weighted_sum(&rows.chain([(pose.pelvis_m, &pose.rotations, weight)]).collect::<Vec<_>>())
    }

    fn weighted(&self, (example, phase, weight): (usize, usize, f32)) -> WeightedPose<'_> {
        (self.pelvis_m[example * PHASE_COUNT + phase], self.rotations(example, phase), weight)
    }

    /// Mean pose of an example over its cycle.
    pub fn mean_pose(&self, example: usize) -> Pose {
        self.blended((0..PHASE_COUNT).map(|phase| (example, phase, 1.0 / PHASE_COUNT as f32)))
    }
}

/// Position of the pelvis (m), rotations of the joints, weight.
type WeightedPose<'a> = (Vec3, &'a [Quat; JOINT_COUNT], f32);

/// Weighted sum of poses whose rotations share a hemisphere.
fn weighted_sum(rows: &[WeightedPose]) -> Pose {
    let pelvis_m = rows.iter().fold(Vec3::ZERO, |sum, &(pelvis_m, _, weight)| sum + weight * pelvis_m);
    // Joint by joint: each sum stays in a register.
    let zero = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let sum = |joint: usize| rows.iter().fold(zero, |sum, &(_, rotations, weight)| sum + rotations[joint] * weight);
    // All rows share a hemisphere, so no sum is near zero.
    Pose { pelvis_m, rotations: array::from_fn(|joint| sum(joint).normalize()) }
}

/// Findings about one source clip. Parameters are means over the clip, on the source's own skeleton, before any
/// scaling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SourceRecord {
    /// File name without folders.
    pub file: String,
    /// Name of the clip within the file; empty if the file holds one unnamed clip.
    pub clip: String,
    /// v_f: mean speed along the facing, m/s.
    pub speed_mps: f32,
    /// ω_t: mean rate of change of the facing, rad/s.
    pub turn_rate_rad_s: f32,
    /// ω_s: mean speed to the left of the facing, m/s.
    pub strafe_mps: f32,
    /// Up axis of the source, `+X` … `-Z`.
    pub up_axis: String,
    /// Metres per unit of the source.
    pub metres_per_unit: f32,
    /// Frame rate, Hz.
    pub frame_rate_hz: f32,
    /// Diagnostics for the user: wrong headers, no steady cycle, snapped parameters.
    pub diagnostics: Vec<Diagnostic>,
}
