//! Profiles: the numbers of an agent that are drawn when it is born. Metres, seconds.

use serde::{Deserialize, Serialize};

use crate::behaviour::Distribution;
use crate::behaviour::choice::draw;
use crate::maths::random::SplitMix64;
use crate::scenario::agent_spec::{enters_all, has_no_style, is_0};
use crate::scenario::characters::character_spec::wears_any;

/// A kind of agents, and its share among those of a table.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Profile {
    /// Share of the agents, relative to those of the table's other profiles.
    pub weight: f32,
    /// Preferred speed, m/s; none: that of the table.
    pub preferred_speed_mps: Option<Distribution>,
    /// Radius of the disc that other agents see, m; none: that of the table.
    pub radius_m: Option<Distribution>,
    /// Time for which an agent stands before it begins, s; none: that of the table.
    pub pre_movement_s: Option<Distribution>,
    /// Size of the body; none: that of the table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stature: Option<DrawnStature>,
    /// Zones that the agents do not enter, by bits as in [`AgentSpec`](crate::AgentSpec).
    #[serde(skip_serializing_if = "enters_all")]
    pub closed_zones: u32,
    /// Right of way of the agents, as in [`AgentSpec`](crate::AgentSpec).
    #[serde(skip_serializing_if = "is_0")]
    pub priority: f32,
    /// Characters that the agents may wear, by bits as in [`AgentSpec`](crate::AgentSpec).
    #[serde(skip_serializing_if = "wears_any")]
    pub characters: u64,
    /// Style of the agents' motion, as in [`AgentSpec`](crate::AgentSpec); 0: that of the table.
    #[serde(skip_serializing_if = "has_no_style")]
    pub style: u32,
}

/// A size of bodies, relative to the database's skeleton, and what follows it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DrawnStature {
    /// The size.
    pub size: Distribution,
    /// Whether the radius grows with the size, because the scenario states none.
    pub scales_radius: bool,
    /// Whether the preferred speed grows with the root of the size, because the scenario states none.
    pub scales_speed: bool,
}

/// The numbers of one agent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnNumbers {
    /// Preferred speed, m/s.
    pub preferred_speed_mps: f32,
    /// Radius of the disc that other agents see, m.
    pub radius_m: f32,
    /// Time for which the agent stands before it begins, s.
    pub pre_movement_s: f32,
    /// Zones that the agent does not enter, by bits.
    pub closed_zones: u32,
    /// Right of way of the agent.
    pub priority: f32,
    /// Size of the body, relative to the database's skeleton.
    pub stature: f32,
    /// Characters that the agent may wear, by bits.
    pub characters: u64,
    /// Whether the radius is that of the character that the agent wears.
    pub wears_radius: bool,
    /// Style of the agent's motion, as in [`AgentSpec`](crate::AgentSpec).
    pub style: u32,
}

impl DrawnNumbers {
    /// Draws a profile by its weight, and its numbers; the others stay as they are. Without profiles it draws nothing.
    pub(crate) fn draw(self, profiles: &[Profile], random: &mut SplitMix64) -> Self {
        let indices: Vec<usize> = (0..profiles.len()).collect();
        let Some(index) = draw(&indices, |index| profiles[index].weight, random) else { return self };
        let Profile {
            preferred_speed_mps,
            radius_m,
            pre_movement_s,
            stature,
            closed_zones,
            priority,
            characters,
            style,
            ..
        } = profiles[index];
        // Every number takes a generator of its own, so that a profile without one changes no other.
        let [of_speed, of_radius, of_time] = std::array::from_fn(|_| random.next_u64());
        let number = |drawn: Option<Distribution>, otherwise: f32, seed: u64, stream: u64| {
            drawn.map_or(otherwise, |drawn| drawn.draw(&mut SplitMix64::new(seed, stream)))
        };
        let size = number(stature.map(|stature| stature.size), self.stature, of_speed, 1);
        let growth = |grows: bool, growth: f32| if grows { growth } else { 1.0 };
        let radius_growth = growth(stature.is_some_and(|stature| stature.scales_radius), size);
        let speed_growth = growth(stature.is_some_and(|stature| stature.scales_speed), libm::sqrtf(size));
        Self {
            preferred_speed_mps: speed_growth * number(preferred_speed_mps, self.preferred_speed_mps, of_speed, 0),
            radius_m: radius_growth * number(radius_m, self.radius_m, of_radius, 0),
            pre_movement_s: number(pre_movement_s, self.pre_movement_s, of_time, 0),
            closed_zones,
            priority,
            stature: size,
            characters,
            wears_radius: self.wears_radius && radius_m.is_none(),
            style: if style == 0 { self.style } else { style },
        }
    }
}
