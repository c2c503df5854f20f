//! What moves the discs: a key of every scenario.

use serde::{Deserialize, Serialize};

/// What moves the discs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coupling {
    /// The paper's: bodies follow the plans, and discs the bodies.
    #[default]
    TwoWay,
    /// Bodies off: each disc moves as planned and faces as planned at once, to compare planners alone. A recording
    /// shows bodies that stand and glide, no foot of which is planted.
    Discs,
    /// The user study's rival: discs move as planned, and bodies follow them exactly; see `coupling::decoupled`.
    Decoupled,
}

impl Coupling {
    /// Whether what is planned is carried out by bodies, which take it up later than a disc does.
    pub fn plans_for_bodies(self) -> bool {
        self == Self::TwoWay
    }
}
