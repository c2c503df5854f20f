//! What moves the discs: a key of every scenario.

use serde::{Deserialize, Serialize};

/// What moves the discs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coupling {
    /// The paper's: bodies follow the plans, and discs follow the bodies (§3.4).
    #[default]
    TwoWay,
    /// Without bodies: each disc moves and faces as planned at once, to compare planners alone. A recording shows
    /// bodies that stand and glide; no foot is planted.
    Discs,
    /// The baseline of the user study (§7): discs move as planned, and bodies follow them exactly.
    Decoupled,
}

impl Coupling {
    /// Whether bodies carry the plans out, which respond later than a disc.
    pub fn plans_for_bodies(self) -> bool {
        self == Self::TwoWay
    }
}
