//! One character of a scenario, and the choice of an agent's.

use motiondb::character::{chosen, hue_turn};
use serde::{Deserialize, Serialize};

use crate::population::AgentId;
use crate::scenario::agent_spec::AgentSpec;
use crate::scenario::resolved::Scenario;

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

impl Scenario {
    /// Index of the character that an agent wears; none of the plain body. It depends on the seed, the agent's id and
    /// its set of characters alone, so agents that are added later change nothing.
    pub fn character_of(&self, id: AgentId, spec: &AgentSpec) -> Option<u32> {
        let may_wear = |index: usize| spec.characters == 0 || spec.characters >> index & 1 == 1;
        let weight = |(index, character): (usize, &CharacterSpec)| if may_wear(index) { character.weight } else { 0.0 };
        let index = chosen(self.seed, id.0, self.characters.iter().enumerate().map(weight))?;
        Some(index as u32)
    }

    /// Turn of the hue of an agent's character, as a share of the full circle.
    pub fn hue_turn_of(&self, id: AgentId, character: u32) -> f32 {
        let variation_deg = self.characters.get(character as usize).map_or(0.0, |spec| spec.hue_variation_deg);
        hue_turn(self.seed, id.0) * variation_deg / 360.0
    }
}
