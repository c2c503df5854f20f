//! Parts of the body that each manner of moving holds in its own way.

use serde::{Deserialize, Serialize};

/// A part of the body that is held in a manner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HeldPart {
    /// Left shoulder to left wrist.
    LeftArm,
    /// Right shoulder to right wrist.
    RightArm,
    /// The head's facing.
    Head,
    /// Pelvis to neck.
    Trunk,
}

impl HeldPart {
    /// Name of the part, with its article.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::LeftArm => "the left arm",
            Self::RightArm => "the right arm",
            Self::Head => "the head",
            Self::Trunk => "the trunk",
        }
    }
}
