//! Postures of a body that is not upright.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Posture of a body that does not walk, run or stand upright.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Posture {
    /// Both legs are bent and carry the trunk: a crouch, a squat, a seat.
    Crouching,
    /// A knee is on the ground.
    Kneeling,
    /// The trunk lies forward, with a hand on the ground: a crawl.
    OnHands,
    /// The trunk lies forward or back, over legs that stand.
    BentOver,
    /// Trunk and hips lie on the ground.
    Lying,
}

impl fmt::Display for Posture {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Crouching => "crouches",
            Self::Kneeling => "kneels",
            Self::OnHands => "goes on its hands",
            Self::BentOver => "bends over",
            Self::Lying => "lies on the ground",
        })
    }
}
