//! Rejections: files and clips that cannot be used, each with a typed reason.

use std::fmt;
use std::io;

use motiondb::body::Joint;
use motiondb::files::input_file;

use crate::read::ForeignFormat;

/// A file that cannot be read as motion, or a clip of it that is not human.
#[derive(Clone, Debug, PartialEq)]
pub struct Rejection {
    /// The file, as the caller named it.
    pub file: String,
    /// Clip within the file; empty where the whole file is rejected.
    pub clip: String,
    /// What is wrong, where, and how to mend it.
    pub reason: RejectionReason,
}

impl std::error::Error for Rejection {}

impl fmt::Display for Rejection {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self.clip.as_str() {
            "" => write!(out, "{}: {}", self.file, self.reason),
            clip => write!(out, "{}, {clip}: {}", self.file, self.reason),
        }
    }
}

/// Why a file or a clip cannot be used. The message does not name the file: a [`Rejection`] does.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RejectionReason {
    /// The system does not let us read the file.
    #[error("{problem}; check that the path exists and may be read")]
    Unreadable {
        /// The system's reason.
        problem: String,
    },
    /// The system fails to read the file: a retry may help.
    #[error("{problem}; check the disk, and try again")]
    ReadFailed {
        /// The system's reason.
        problem: String,
    },
    /// The system has too little memory for the clip.
    #[error("its motion needs {mib} MiB of memory, more than the system gives; cut the clip into shorter ones")]
    OutOfMemory {
        /// Memory that was not given, MiB.
        mib: usize,
    },
    /// The file's name ends in none of `.bvh`, `.glb` and `.gltf`.
    #[error("not a motion clip; clips are *.bvh, *.glb and *.gltf")]
    UnknownFormat,
    /// The file is of a known format that is not read.
    #[error("{}; {}; clips are *.bvh, *.glb and *.gltf", format.name, format.remedy)]
    ForeignFormat {
        /// The format.
        format: ForeignFormat,
    },
    /// The file, or the clip's part of it, breaks its format.
    #[error("{position}: {problem}; {remedy}")]
    Malformed {
        /// Line of a BVH file; byte, buffer, accessor or animation of a glTF file.
        position: String,
        /// What is wrong there.
        problem: String,
        /// How to mend it.
        remedy: &'static str,
    },
    /// The clip has fewer than two frames.
    #[error("only one frame: a motion needs at least two; export the whole clip")]
    TooShort,
    /// The animation moves no joint.
    #[error("no joint moves: the animation is of shapes, materials or props; export the skeleton's motion")]
    Motionless,
    /// The animation moves no joint, and the file has channels that are not read.
    #[error(
        "no joint moves, but the file has channels of KHR_animation_pointer, which are not read; export channels of nodes"
    )]
    PointersOnly,
    /// Joints change their positions, but none rotates.
    #[error("no joint rotates: the motion is in the joints' positions alone; export the joints' rotations")]
    NoRotations,
    /// One skeleton holds two bodies.
    #[error("two bodies under one root, `{first}` and `{second}`; export each to a file of its own")]
    TwoBodies {
        /// Topmost joint of one body.
        first: String,
        /// Topmost joint of the other body.
        second: String,
    },
    /// The skeleton has more joints than any body.
    #[error("no human skeleton: it has {count} joints; export the body alone")]
    TooManyJoints {
        /// Joints of the file.
        count: usize,
    },
    /// No pair of limbs has hip, knee and ankle.
    #[error(
        "no human legs: no two mirrored limbs with hip, knee and ankle among the joints; if the skeleton is human, state \
         `joints` in a manifest.toml"
    )]
    NoLegs,
    /// The bones of a leg change their lengths.
    #[error("no human legs: the bones at `{knee}` change their length; export a rigid skeleton")]
    LooseLeg {
        /// The joint between the two bones.
        knee: String,
    },
    /// No pair of limbs above the legs has shoulder, elbow and wrist.
    #[error(
        "no human arms: no two mirrored limbs with shoulder, elbow and wrist beside the likeliest legs, {}; if the \
         skeleton is human, state `joints` in a manifest.toml",
        joint_spans(likeliest_legs)
    )]
    NoArms {
        /// First and last joint of each likeliest leg. On an unnamed skeleton without knees or ankles these are the arms.
        likeliest_legs: Box<[[String; 2]; 2]>,
    },
    /// A pose is not finite.
    #[error("positions or rotations are not finite: the skeleton is degenerate; export the clip again")]
    Degenerate,
    /// No walking body has legs of this length.
    #[error(
        "no human proportions: thigh and shank are {leg_m:.3} m long; correct the skeleton's offsets, or state the \
         unit as `metres_per_unit` in a manifest.toml"
    )]
    LegLength {
        /// Thigh plus shank, m.
        leg_m: f64,
    },
    /// A bone of a leg is too short for a knee that bends.
    #[error("no human proportions: of legs of {leg_m:.3} m one bone has {bone_m:.3} m; correct the skeleton's offsets")]
    ShortLegBone {
        /// Thigh plus shank, m.
        leg_m: f64,
        /// The shorter bone, m.
        bone_m: f64,
    },
    /// A bone is too long for the legs.
    #[error("no human proportions: on legs of {leg_m:.3} m one bone has {bone_m:.3} m; correct the skeleton's offsets")]
    LongBone {
        /// Thigh plus shank, m.
        leg_m: f64,
        /// The longest bone, m.
        bone_m: f64,
    },
    /// The clip contradicts its manifest. With a manifest at hand this becomes
    /// [`crate::CompileError::InvalidManifest`].
    #[error("{problem}; {remedy}")]
    ManifestContradicted {
        /// The key whose value is wrong.
        key: ManifestKey,
        /// How clip and value differ.
        problem: String,
        /// How to mend it.
        remedy: &'static str,
    },
    /// The trunk does not stand over the legs.
    #[error(
        "not upright: the trunk lies {trunk_deg:.0}° off the legs' direction, like that of a quadruped or a crawling body; \
         use clips of a walking human skeleton"
    )]
    NotUpright {
        /// Angle between the legs' direction (toes → hips) and the trunk (hips → shoulders), degrees.
        trunk_deg: f64,
    },
}

impl RejectionReason {
    /// The system does not let us read the file, or fails to.
    pub(crate) fn unreadable(error: &io::Error) -> Self {
        let problem = error.to_string();
        if input_file::is_of_machine(error) { Self::ReadFailed { problem } } else { Self::Unreadable { problem } }
    }

    /// Whether the machine failed (disk, memory). Otherwise the file is wrong.
    pub fn is_of_machine(&self) -> bool {
        matches!(self, Self::ReadFailed { .. } | Self::OutOfMemory { .. })
    }
}

/// `` `Hips` to `Foot` and `Hips` to `Foot` ``.
fn joint_spans(limbs: &[[String; 2]; 2]) -> String {
    limbs.each_ref().map(|[first, last]| format!("`{first}` to `{last}`")).join(" and ")
}

/// A manifest's key whose value a clip can contradict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ManifestKey {
    /// `animation`: the only animation to use of a glTF file.
    Animation,
    /// `frames`: the first and the last frame to use.
    Frames,
    /// `metres_per_unit`: metres of one source unit.
    MetresPerUnit,
    /// `forward`: the facing in the first frame.
    Forward,
    /// `joints`: the source joint of this role.
    Joint(Joint),
    /// `transition`: the kind of transition that the clip shows.
    Transition,
}
