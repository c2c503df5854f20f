//! What the colours of clothes show: the agent, or a quantity on a scale.

use std::collections::BTreeMap;

use fbcrowd_sim::Population;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::synthesis::Mode;
use glam::{Vec2, Vec3};

use crate::raster::palette::{HOLDING_SET, Look, Rgb, TURNING_SET, heat, look};

/// What the colours of clothes show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourBy {
    /// The agent: each has its own hue.
    #[default]
    Agent,
    /// The group; agents without one are grey.
    Group,
    /// The planned speed: slow is red, a brisk walk is green.
    Speed,
    /// The active motion: blue where examples are blended, ochre where the base walk is deformed.
    Synthesis,
    /// Agents per square metre around: green is free, red is crowded.
    Density,
}

/// Speed that is shown as the good end of the scale, m/s.
const BRISK_MPS: f32 = 1.5;
/// Density that is shown as the bad end of the scale, 1/m².
const CROWDED_PER_M2: f32 = 3.0;
/// Radius of the disc in which agents are counted, m.
const AROUND_M: f32 = 1.5;
/// Clothes of an agent without a group.
const ALONE: Rgb = Rgb::new(0.62, 0.62, 0.62);
/// Share of light that trousers keep of the shown colour.
const TROUSERS_SHARE: f32 = 0.55;

/// Colours of agents that show a quantity, sRGB-encoded; none where each agent has its own.
pub(crate) fn shown(colour_by: ColourBy, agents: &[AgentFrame], population: &Population) -> Vec<Option<Rgb>> {
    let density = (colour_by == ColourBy::Density).then(|| Densities::new(agents));
    let shown = |agent: &AgentFrame| match colour_by {
        ColourBy::Agent => None,
        ColourBy::Group => {
            let group = population.agents.get(agent.id.index()).and_then(|life| life.group);
            Some(group.map_or(ALONE, |group| look(group as usize).shirt))
        }
        ColourBy::Speed => Some(heat(1.0 - agent.planned_mps.length() / BRISK_MPS)),
        ColourBy::Synthesis => Some(if agent.mode == Mode::SemiProcedural { HOLDING_SET } else { TURNING_SET }),
        ColourBy::Density => {
            let per_m2 = density.as_ref().map_or(0.0, |density| density.at_per_m2(agent.root.position_m));
            Some(heat(per_m2 / CROWDED_PER_M2))
        }
    };
    agents.iter().map(shown).collect()
}

/// The look of an agent, in clothes of a shown colour.
pub(crate) fn dressed(agent: &AgentFrame, shown: Option<Rgb>) -> Look {
    let own = look(agent.id.index());
    shown.map_or(own, |shirt: Vec3| Look { shirt, trousers: TROUSERS_SHARE * shirt, ..own })
}

/// Agents by cells as wide as the radius in which they are counted.
struct Densities {
    cells: BTreeMap<[i32; 2], Vec<Vec2>>,
}

impl Densities {
    fn new(agents: &[AgentFrame]) -> Self {
        let mut cells = BTreeMap::<_, Vec<Vec2>>::new();
        for agent in agents {
            cells.entry(cell(agent.root.position_m)).or_default().push(agent.root.position_m);
        }
        Self { cells }
    }

    fn at_per_m2(&self, at_m: Vec2) -> f32 {
        let [x, y] = cell(at_m);
        let around = (y - 1..=y + 1).flat_map(|row| (x - 1..=x + 1).map(move |column| [column, row]));
        let near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        let count = near.filter(|other_m| other_m.distance_squared(at_m) <= AROUND_M * AROUND_M).count();
        count as f32 / (std::f32::consts::PI * AROUND_M * AROUND_M)
    }
}

fn cell(at_m: Vec2) -> [i32; 2] {
    // Casts saturate.
    (at_m / AROUND_M).floor().to_array().map(|side| (side as i32).clamp(-1 << 20, 1 << 20))
}
