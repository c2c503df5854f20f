//! What can go wrong at the import edge: one enum, each variant naming the file, the place in it and the remedy.

use std::path::{Path, PathBuf};

use motiondb::body::Joint;

/// A file that cannot be read as motion at all. A single clip that is readable but not human is a [`Refusal`] instead.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file or folder cannot be read.
    #[error("{}: {source}; check that the path exists and may be read", file.display())]
    Unreadable {
        /// The path.
        file: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
    },
    /// Not `.bvh`, `.glb` or `.gltf`.
    #[error("{}: not a motion clip; clips are *.bvh, *.glb and *.gltf", file.display())]
    UnknownFormat {
        /// The path.
        file: PathBuf,
    },
    /// A BVH file whose text is malformed.
    #[error("{}, line {line}: {problem}; {remedy}", file.display())]
    Bvh {
        /// The path.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there.
        problem: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A glTF file that breaks its format.
    #[error("{}, {place}: {problem}; {remedy}", file.display())]
    Gltf {
        /// The path.
        file: PathBuf,
        /// Byte, buffer, accessor or animation.
        place: String,
        /// What is wrong there.
        problem: String,
        /// What to do.
        remedy: &'static str,
    },
}

impl ImportError {
    /// The file.
    pub fn file(&self) -> &Path {
        match self {
            Self::Unreadable { file, .. } | Self::UnknownFormat { file } => file,
            Self::Bvh { file, .. } | Self::Gltf { file, .. } => file,
        }
    }

    /// The whole message but for the file's name.
    pub fn reason(&self) -> String {
        let message = self.to_string();
        let file = self.file().display().to_string();
        message.strip_prefix(&file).unwrap_or(&message).trim_start_matches([':', ',', ' ']).to_owned()
    }
}

/// Why a readable clip gives no [`crate::retarget::human_clip::HumanClip`]; other clips of the same file are not affected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// Nothing to measure.
    #[error("only one frame: a motion needs at least {MIN_FRAMES}; export the whole clip")]
    TooShort,
    /// An animation of shapes, materials or props.
    #[error("no joint moves: the animation is of shapes, materials or props; export the skeleton's motion")]
    Motionless,
    /// This clip's part of the file breaks the format.
    #[error("{reason}")]
    Malformed {
        /// Where, what is wrong and what to do.
        reason: String,
    },
    /// Positions of joints alone.
    #[error("no joint turns: its motion is in the joints' positions alone; export the joints' rotations")]
    Unturned,
    /// Several people in one skeleton.
    #[error("two bodies under one root, `{first}` and `{second}`; export each to a file of its own")]
    TwoBodies {
        /// The joint that carries the first.
        first: String,
        /// The joint that carries the second.
        second: String,
    },
    /// More joints than any body has.
    #[error("no human skeleton: it has {count} joints; export the body alone")]
    TooManyJoints {
        /// Joints of the file.
        count: usize,
    },
    /// No pair of limbs with hip, knee and ankle.
    #[error(
        "no human legs: no two mirrored limbs with hip, knee and ankle among the joints; if the skeleton is human, state \
         `joints` in a manifest.toml"
    )]
    NoLegs,
    /// The bones of a leg change their length.
    #[error("no human legs: the bones at `{knee}` change their length; export a rigid skeleton")]
    LooseLeg {
        /// The joint between them.
        knee: String,
    },
    /// No pair of arms above the legs. Without knees or ankles the arms are the likeliest legs.
    #[error(
        "no human arms: no two mirrored limbs with shoulder, elbow and wrist beside the seeming legs, {}; if the skeleton \
         is human, state `joints` in a manifest.toml",
        limbs(seeming_legs)
    )]
    NoArms {
        /// First and last joint of each limb that was taken for a leg.
        seeming_legs: [[String; 2]; 2],
    },
    /// Joints in places that no body has.
    #[error("positions or rotations are not finite: the skeleton is degenerate; export the clip again")]
    Degenerate,
    /// Legs of a length that no body has.
    #[error("no human proportions: thigh and shank are {leg_m:.3} m long; correct the skeleton's offsets and its unit")]
    LegLength {
        /// Thigh plus shank, m.
        leg_m: f64,
    },
    /// Legs that no knee could bend.
    #[error("no human proportions: of legs of {leg_m:.3} m one bone has {bone_m:.3} m; correct the skeleton's offsets")]
    ShortLegBone {
        /// Thigh plus shank, m.
        leg_m: f64,
        /// The shorter of both, m.
        bone_m: f64,
    },
    /// A bone that no body has.
    #[error("no human proportions: on legs of {leg_m:.3} m one bone has {bone_m:.3} m; correct the skeleton's offsets")]
    LongBone {
        /// Thigh plus shank, m.
        leg_m: f64,
        /// The longest bone, m.
        bone_m: f64,
    },
    /// The manifest says of the clip what is not so.
    #[error("{reason}; {remedy}")]
    Setting {
        /// What it says.
        setting: Setting,
        /// Why it is not so.
        reason: String,
        /// What to do.
        remedy: &'static str,
    },
    /// Limbs are there, but the body is a quadruped's or crawls or lies.
    #[error(
        "not upright: the trunk lies {trunk_deg:.0}° off the legs' direction, like that of a quadruped or a crawling body; \
         use clips of a walking human skeleton"
    )]
    NotUpright {
        /// Angle between the legs' direction (toes → hips) and the trunk (hips → shoulders), degrees.
        trunk_deg: f64,
    },
    /// Limbs are there, but the body moves as no walker does.
    #[error(
        "not upright: the body moves along its own length, as one that crawls, swims or climbs; use clips of a walking \
         human skeleton"
    )]
    MovesAlongItself,
}

/// `` `Hips` to `Foot` and `Hips` to `Foot` ``.
fn limbs(limbs: &[[String; 2]; 2]) -> String {
    limbs.each_ref().map(|[first, last]| format!("`{first}` to `{last}`")).join(" and ")
}

/// What a manifest states of a clip and the clip may contradict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Setting {
    /// Which animation of a glTF file.
    Animation,
    /// Which frames.
    Frames,
    /// Where the body faces.
    Forward,
    /// Who plays a role.
    Joint(Joint),
}

/// The fewest frames of a clip: two positions make one velocity.
pub const MIN_FRAMES: usize = 2;
