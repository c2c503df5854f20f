//! The syntheses: which of them moves a body, and which a body may use (`FbCrowd` §3.4.1).

use serde::{Deserialize, Serialize};

/// The synthesis that made a pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Mode {
    /// Motion blending.
    #[default]
    Blending = 0,
    /// Semi-procedural locomotion.
    SemiProcedural = 1,
    /// A recorded transition of the database; the root moves as in motion blending. `FbCrowd` does not have it.
    Transition = 2,
}

/// The syntheses that a body may use; `FbCrowd` §7 compares them on its obstacle course.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Modes {
    /// Both; Eq. 1 selects.
    #[default]
    Hybrid,
    /// Motion blending alone.
    Blending,
    /// Semi-procedural locomotion wherever the body walks; a standing body blends.
    SemiProcedural,
}
