//! Why a file gives no character, and what the compiler reports about one that it does give.

use std::fmt;

use motiondb::body::Joint;

use crate::error::RejectionReason;

/// A file that gives no character.
#[derive(Clone, Debug, PartialEq)]
pub struct CharacterRejection {
    /// The file, as the caller named it.
    pub file: String,
    /// What is wrong, where, and how to mend it.
    pub reason: CharacterReason,
}

impl std::error::Error for CharacterRejection {}

impl fmt::Display for CharacterRejection {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "{}: {}", self.file, self.reason)
    }
}

/// Why a file gives no character. The message does not name the file: a [`CharacterRejection`] does.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CharacterReason {
    /// The file cannot be read, or breaks its format.
    #[error(transparent)]
    File(#[from] RejectionReason),
    /// The file's name ends in none of `.glb`, `.gltf` and `.vrm`.
    #[error("not a character; characters are *.glb, *.gltf and *.vrm")]
    UnknownFormat,
    /// The meshes are compressed by an extension that is not read.
    #[error("its meshes are compressed with {extension}; export the file again without mesh compression")]
    Compressed {
        /// Name of the extension.
        extension: String,
    },
    /// The file has no triangles to draw.
    #[error("it has no triangles on a skeleton; export the figure's meshes together with its armature")]
    NoMesh,
    /// A mesh that is to be hidden does not exist.
    #[error("it has no mesh `{name}` to hide; its meshes are {meshes}")]
    NoSuchMesh {
        /// The name that was given.
        name: String,
        /// Names of all meshes.
        meshes: String,
    },
    /// The file has more of something than can be drawn for every agent.
    #[error("it has {count} {what}, more than {most}; reduce them before the export")]
    TooLarge {
        /// Number of them.
        count: u64,
        /// `triangles`, `vertices`, …
        what: &'static str,
        /// Greatest number of them.
        most: usize,
    },
    /// A texture is larger than can be decoded, or than any is.
    #[error("texture {index} has {width} × {height} pixels, more than {most} a side; scale it down")]
    LargeTexture {
        /// Index of the image.
        index: usize,
        /// Width, pixels.
        width: usize,
        /// Height, pixels.
        height: usize,
        /// Greatest width and height, pixels.
        most: usize,
    },
    /// A bone table of VRM names no joint for a role.
    #[error("its VRM bone table lacks `{bone}`; assign the bone in the VRM exporter")]
    MissingBone {
        /// VRM's name of the bone.
        bone: &'static str,
    },
    /// A bone table of VRM contradicts the file.
    #[error("its VRM bone table names node {node} as `{bone}`, {problem}; assign the bone in the VRM exporter")]
    WrongBone {
        /// VRM's name of the bone.
        bone: String,
        /// Index of the node.
        node: usize,
        /// What is wrong.
        problem: &'static str,
    },
    /// A bone table of VRM names joints of a limb that do not hang from each other.
    #[error("its VRM bone table is wrong: {problem}; assign the bones of each limb from the trunk outwards")]
    BrokenLimb {
        /// Which joint does not hang from which.
        problem: String,
    },
    /// No two limbs have hip, knee and ankle.
    #[error(
        "no human legs: no two mirrored limbs with hip, knee and ankle among the joints; name the joints \
         (LeftUpLeg, LeftLeg, LeftFoot), or export a VRM file"
    )]
    NoLegs,
    /// No two limbs above the legs have shoulder, elbow and wrist.
    #[error(
        "no human arms: no two mirrored limbs with shoulder, elbow and wrist beside the likeliest legs, {legs}; name the \
         joints (LeftArm, LeftForeArm, LeftHand), or export a VRM file"
    )]
    NoArms {
        /// The likeliest legs.
        legs: String,
    },
    /// The trunk lies: a quadruped.
    #[error(
        "four legs: the trunk lies {trunk_deg:.0}° off the legs' direction, like a quadruped's; crowds walk on two legs, \
         so give a human figure"
    )]
    FourLegs {
        /// Angle between the legs' direction and the trunk, degrees.
        trunk_deg: f64,
    },
    /// Limbs beside the legs stand on the ground: a spider or a centaur.
    #[error(
        "more than two legs: `{first}` and `{second}` stand on the ground beside the likeliest legs; crowds walk on two \
         legs, so give a human figure, or export a VRM file whose bone table names two legs and two arms"
    )]
    ManyLegs {
        /// Uppermost joint of one limb.
        first: String,
        /// Uppermost joint of the other limb.
        second: String,
    },
    /// The likeliest legs are ears, wings or the like.
    #[error(
        "no human legs: the likeliest are {first} and {second}, which {problem}; name the legs' joints (LeftUpLeg, \
         LeftLeg, LeftFoot), or export a VRM file"
    )]
    NotLegs {
        /// Uppermost joint of one limb.
        first: String,
        /// Uppermost joint of the other limb.
        second: String,
        /// Why these are no legs.
        problem: &'static str,
    },
    /// A number is not finite, or a joint's matrix has no inverse.
    #[error("{part}: a number is not finite; repair the file, and export it again")]
    NotFinite {
        /// The part of the file.
        part: String,
    },
    /// The hips are at or under the soles.
    #[error("the hips are not above the soles; export the figure standing, with its feet")]
    HipsAtSoles,
    /// The compiled character breaks an invariant.
    #[error("{fault}; export it again")]
    Unsound {
        /// The invariant that is broken.
        fault: String,
    },
}

impl CharacterReason {
    /// Whether the machine failed (disk, memory). Otherwise the file is wrong.
    pub fn is_of_machine(&self) -> bool {
        matches!(self, Self::File(reason) if reason.is_of_machine())
    }
}

/// What the compiler reports about a character.
#[derive(Clone, Debug, PartialEq)]
pub enum CharacterNote {
    /// Roles that no joint has; the character wears the motion of the joints that it has.
    MissingRoles(Vec<Joint>),
    /// A foot has no toe joint: it rolls over its tip.
    NoToes,
    /// Morph targets (faces, shapes) are passed over.
    MorphTargets(usize),
    /// Textures whose format is not read; their materials keep their plain colour.
    UnreadTextures(Vec<String>),
    /// Triangles that the alpha mask hides.
    MaskedTriangles(usize),
    /// Meshes that hang from no joint of the body.
    LooseMeshes(Vec<String>),
    /// Meshes that hang from a joint of the hand from which another one hangs.
    SpareMeshes(Vec<String>),
    /// Weights of so many vertices did not add up to 1.
    UnevenWeights(usize),
    /// So many weights are not finite; they count as 0.
    NotFiniteWeights(usize),
    /// Vertices that no joint moves; they move with the pelvis.
    UnweightedVertices(usize),
    /// Required extensions that are not read.
    UnreadExtensions(Vec<String>),
    /// The names of left and right contradict toes and knees.
    MirroredNames,
}

impl CharacterNote {
    /// Stable name in JSON.
    pub fn code(&self) -> &'static str {
        match self {
            Self::MissingRoles(_) => "missing_roles",
            Self::NoToes => "no_toes",
            Self::MorphTargets(_) => "morph_targets",
            Self::UnreadTextures(_) => "unread_textures",
            Self::MaskedTriangles(_) => "masked_triangles",
            Self::LooseMeshes(_) => "loose_meshes",
            Self::SpareMeshes(_) => "spare_meshes",
            Self::UnevenWeights(_) => "uneven_weights",
            Self::NotFiniteWeights(_) => "not_finite_weights",
            Self::UnweightedVertices(_) => "unweighted_vertices",
            Self::UnreadExtensions(_) => "unread_extensions",
            Self::MirroredNames => "mirrored_names",
        }
    }
}

impl fmt::Display for CharacterNote {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::MissingRoles(roles) => {
                let names: Vec<&str> = roles.iter().map(|role| role.name()).collect();
                write!(out, "no joint is {}", names.join(", "))
            }
            Self::NoToes => out.write_str("the feet have no toe joints; they roll over their tips"),
            Self::MorphTargets(count) => write!(out, "{count} morph targets are passed over"),
            Self::UnreadTextures(names) => {
                write!(out, "textures are passed over, only PNG and JPEG are read: {}", names.join(", "))
            }
            Self::MaskedTriangles(count) => write!(out, "{count} transparent triangles are left out"),
            Self::LooseMeshes(names) => {
                write!(out, "meshes that hang from no joint of the body are left out: {}", names.join(", "))
            }
            Self::SpareMeshes(names) => write!(
                out,
                "a hand holds one thing, the first; left out are {}; `hide` of a mesh lets the hand hold the next",
                names.join(", ")
            ),
            Self::UnevenWeights(count) => {
                write!(out, "weights of {count} vertices did not add up to 1 and were scaled")
            }
            Self::NotFiniteWeights(count) => write!(out, "{count} weights are not finite and count as 0"),
            Self::UnweightedVertices(count) => write!(out, "{count} vertices without weights move with the pelvis"),
            Self::UnreadExtensions(names) => write!(out, "extensions that are not read: {}", names.join(", ")),
            Self::MirroredNames => out.write_str("names call left what stands on the right; sides follow the feet"),
        }
    }
}
