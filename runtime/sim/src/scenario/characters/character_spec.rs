//! One character of a scenario.

use serde::{Deserialize, Serialize};

/// Greatest number of characters: a set of them is 64 bits.
pub const CHARACTERS_MAX: usize = 64;

/// Greatest radius of a segment, m: skirts and capes are wide.
pub(crate) const SEGMENT_RADIUS_MAX_M: f32 = 1.0;

/// A character that bodies are drawn as. Its file is no part of it, so that no path gets into a recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CharacterSpec {
    /// Name of the character.
    pub name: String,
    /// Share of the agents that may wear it, relative to the other characters.
    pub weight: f32,
    /// Greatest turn of the hue of its clothes, to either side, degrees.
    #[serde(default)]
    pub hue_variation_deg: f32,
    /// Its size as it is worn; none until the character is loaded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<CharacterSize>,
}

/// The size of a character on the crowd's bodies: what agents that wear it are for others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CharacterSize {
    /// Radius of the disc around trunk and hanging arms, m.
    pub radius_m: f32,
    /// Radius of the capsule of each joint's segment, m.
    pub segment_radii_m: Vec<f32>,
}

/// Whether a set of characters is that of agents that may wear all; recordings leave it out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub(crate) fn wears_any(characters: &u64) -> bool {
    *characters == 0
}
