//! One character of a scenario.

use serde::{Deserialize, Serialize};

/// Greatest number of characters: a set of them is 64 bits.
pub const CHARACTERS_MAX: usize = 64;

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
}

/// Whether a set of characters is that of agents that may wear all; recordings leave it out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub(crate) fn wears_any(characters: &u64) -> bool {
    *characters == 0
}
