//! Which character an agent wears, and in which hue.

use motiondb::body::Skeleton;
use motiondb::character::{CharacterFit, chosen, hue_turn};

use crate::scenario::agent_spec::AgentSpec;
use crate::scenario::characters::character_spec::{CharacterSize, CharacterSpec, SEGMENT_RADIUS_MAX_M};
use crate::scenario::ranges::RADIUS_M;
use crate::scenario::resolved::Scenario;

impl Scenario {
    /// Index of the character that an agent wears; none of the plain body. It depends on the seed, the agent's id and
    /// its set of characters alone, so agents that are added later change nothing.
    pub fn character_of(&self, id: u32, spec: &AgentSpec) -> Option<u32> {
        let may_wear = |index: usize| spec.characters == 0 || spec.characters >> index & 1 == 1;
        let weight = |(index, character): (usize, &CharacterSpec)| if may_wear(index) { character.weight } else { 0.0 };
        let index = chosen(self.seed, id, self.characters.iter().enumerate().map(weight))?;
        Some(index as u32)
    }

    /// Gives the characters their sizes, in their order, and agents that wear them their radius, unless one is stated.
    pub fn wear(&mut self, sizes: impl IntoIterator<Item = CharacterSize>) {
        for (spec, size) in self.characters.iter_mut().zip(sizes) {
            spec.size = Some(size);
        }
        let mut agents = std::mem::take(&mut self.agents);
        agents.iter_mut().enumerate().for_each(|(index, agent)| self.dress(index as u32, agent));
        self.agents = agents;
    }

    /// Gives an agent the radius of its character, unless the scenario states one.
    pub(crate) fn dress(&self, id: u32, agent: &mut AgentSpec) {
        let character = self.character_of(id, agent).filter(|_| agent.wears_radius);
        let Some(size) = character.and_then(|index| self.characters[index as usize].size.as_ref()) else { return };
        agent.radius_m = (agent.stature * size.radius_m).max(*RADIUS_M.start());
        agent.wall_radius_m = agent.wall_radius_m.min(agent.radius_m);
    }

    /// Turn of the hue of an agent's character, as a share of the full circle.
    pub fn hue_turn_of(&self, id: u32, character: u32) -> f32 {
        let variation_deg = self.characters.get(character as usize).map_or(0.0, |spec| spec.hue_variation_deg);
        hue_turn(self.seed, id) * variation_deg / 360.0
    }
}

impl CharacterSize {
    /// The size of a character that is fitted to a skeleton. Segments without a mesh of their own have the skeleton's.
    pub fn of(fit: &CharacterFit, skeleton: &Skeleton) -> Self {
        let own_m = fit.character.segment_radii_m.map(|radius_m| fit.scale * radius_m);
        let radius_m =
            |(own_m, crowd_m): (f32, f32)| if own_m > 0.0 { own_m.min(SEGMENT_RADIUS_MAX_M) } else { crowd_m };
        Self {
            radius_m: (fit.scale * fit.character.radius_m).clamp(*RADIUS_M.start(), *RADIUS_M.end()),
            segment_radii_m: own_m.into_iter().zip(skeleton.segment_radii_m).map(radius_m).collect(),
        }
    }
}
