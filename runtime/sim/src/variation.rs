//! Variation: how much the bodies of a crowd differ, and the traits of each agent.
//!
//! Every draw depends on the seed, the agent's id and the trait alone. So the traits of an agent stay when other agents
//! are added, or when another trait is switched off.

use serde::{Deserialize, Serialize};

use crate::behaviour::Distribution;
use crate::maths::random::SplitMix64;
use crate::synthesis::Traits;

/// Streams of the traits in a seed; scenario, starting phases, behaviour and events use those below.
const TRAIT_STREAMS: u64 = 1 << 42;
/// Greatest distance of a trait from its mean, in deviations: 12 % of cadence for a deviation of 5 %.
pub(crate) const DEVIATIONS_MAX: f32 = 2.4;
/// Lead up to which the foot that a body prefers makes the first step, m: less than a third of a small step.
const FIRST_FOOT_M: f32 = 0.05;

/// How much the bodies of a crowd differ: the table `[variation]` of a scenario. Deviations are standard deviations
/// over agents; no agent deviates by more than 2.4 of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Variation {
    /// Least and greatest reaction time, s: an agent of the start stands for that long before it begins.
    pub reaction_s: [f32; 2],
    /// Deviation of cadence at equal speed, as a share.
    pub cadence: f32,
    /// Deviation of the swing of the arms, as a share.
    pub arm_swing: f32,
    /// Deviation of the difference between the swings of left and right arm and their mean, as a share.
    pub arm_asymmetry: f32,
    /// Deviation of the trunk's pitch, degrees.
    pub trunk_pitch_deg: f32,
    /// Deviation of the head's pitch, degrees.
    pub head_pitch_deg: f32,
    /// Small motion of head, forearms and hands in walks, and sway at rest, divided by that of captures, where the clips
    /// lack it.
    pub secondary_motion: f32,
    /// Deviation of the size of bodies of the skeleton's size, as a share. Speed and radius stay.
    pub stature: f32,
}

impl Default for Variation {
    fn default() -> Self {
        Self {
            reaction_s: [0.2, 0.8],
            cadence: 0.05,
            arm_swing: 0.2,
            arm_asymmetry: 0.1,
            trunk_pitch_deg: 2.0,
            head_pitch_deg: 4.0,
            secondary_motion: 1.0,
            stature: 0.05,
        }
    }
}

/// What a number is drawn for.
#[derive(Clone, Copy, Debug)]
enum Purpose {
    Reaction = 0,
    FirstFoot,
    Cadence,
    ArmSwing,
    ArmAsymmetry,
    TrunkPitch,
    HeadPitch,
    SecondaryMotion,
    Stature,
}

impl Variation {
    /// The traits of an agent, by its id.
    pub fn traits(&self, seed: u64, agent: u32) -> Traits {
        let deviating = |deviation: f32, purpose: Purpose| deviation_of(deviation, seed, agent, purpose);
        let arm_swing = 1.0 + deviating(self.arm_swing, Purpose::ArmSwing);
        let asymmetry = deviating(self.arm_asymmetry, Purpose::ArmAsymmetry);
        let prefers_left = random(seed, agent, Purpose::FirstFoot).unit() < 0.5;
        Traits {
            cadence: 1.0 + deviating(self.cadence, Purpose::Cadence),
            arm_swing: [arm_swing * (1.0 + asymmetry), arm_swing * (1.0 - asymmetry)],
            trunk_pitch_rad: deviating(self.trunk_pitch_deg, Purpose::TrunkPitch).to_radians(),
            head_pitch_rad: deviating(self.head_pitch_deg, Purpose::HeadPitch).to_radians(),
            first_foot_m: if prefers_left { FIRST_FOOT_M } else { -FIRST_FOOT_M },
            secondary_motion: self.secondary_motion,
            secondary_seed: random(seed, agent, Purpose::SecondaryMotion).next_u64(),
        }
    }

    /// Size of the body of an agent, by its id, relative to the database's skeleton.
    pub fn drawn_stature(&self, seed: u64, agent: u32) -> f32 {
        1.0 + deviation_of(self.stature, seed, agent, Purpose::Stature)
    }

    /// Reaction time of an agent, by its id, s.
    pub fn drawn_reaction_s(&self, seed: u64, agent: u32) -> f32 {
        let [from, to] = self.reaction_s;
        Distribution::Uniform { from, to }.draw(&mut random(seed, agent, Purpose::Reaction))
    }
}

/// A number about 0 with a standard deviation.
fn deviation_of(deviation: f32, seed: u64, agent: u32, purpose: Purpose) -> f32 {
    let limit = DEVIATIONS_MAX * deviation;
    let normal = Distribution::Normal { mean: 0.0, deviation, min: -limit, max: limit };
    normal.draw(&mut random(seed, agent, purpose))
}

fn random(seed: u64, agent: u32, purpose: Purpose) -> SplitMix64 {
    let of_agent = SplitMix64::new(seed, TRAIT_STREAMS + u64::from(agent)).next_u64();
    SplitMix64::new(of_agent, purpose as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean, deviation, least and greatest value of a trait over many agents.
    fn moments(value: impl Fn(&Traits) -> f32) -> [f32; 4] {
        let traits = (0..20_000).map(|id| Variation::default().traits(7, id));
        let values: Vec<f32> = traits.map(|traits| value(&traits)).collect();
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f32>() / values.len() as f32;
        [
            mean,
            variance.sqrt(),
            values.iter().copied().fold(f32::MAX, f32::min),
            values.into_iter().fold(f32::MIN, f32::max),
        ]
    }

    #[test]
    fn cadence_deviates_by_5_percent_and_12_at_most() {
        let [mean, deviation, least, greatest] = moments(|traits| traits.cadence);
        assert!((mean - 1.0).abs() < 2e-3 && (deviation - 0.048).abs() < 2e-3, "{mean} {deviation}");
        assert!(least >= 0.88 && greatest <= 1.12 && greatest - least > 0.23, "{least} {greatest}");
    }

    #[test]
    fn adults_of_175_cm_differ_by_9_cm() {
        let heights_m = (0..20_000).map(|id| 1.75 * Variation::default().drawn_stature(7, id));
        let [least, greatest] = heights_m
            .clone()
            .fold([f32::MAX, f32::MIN], |[least, greatest], height_m| [least.min(height_m), greatest.max(height_m)]);
        let variance = heights_m.map(|height_m| (height_m - 1.75) * (height_m - 1.75)).sum::<f32>() / 20_000.0;
        assert!((variance.sqrt() - 0.0836).abs() < 2e-3 && least > 1.53 && greatest < 1.97, "{least} {greatest} m");
    }

    #[test]
    fn half_of_the_agents_begin_with_each_foot() {
        assert!(moments(|traits| traits.first_foot_m.signum())[0].abs() < 0.03);
    }

    #[test]
    fn traits_are_drawn_apart() {
        let correlation = |a: fn(&Traits) -> f32, b: fn(&Traits) -> f32| {
            let [[mean_a, deviation_a, ..], [mean_b, deviation_b, ..]] = [moments(a), moments(b)];
            moments(|traits| (a(traits) - mean_a) * (b(traits) - mean_b))[0] / (deviation_a * deviation_b)
        };
        let all: [fn(&Traits) -> f32; 5] = [
            |traits| traits.cadence,
            |traits| traits.arm_swing[0] + traits.arm_swing[1],
            |traits| traits.trunk_pitch_rad,
            |traits| traits.head_pitch_rad,
            |traits| traits.first_foot_m,
        ];
        for (index, &a) in all.iter().enumerate() {
            assert!(all[..index].iter().all(|&b| correlation(a, b).abs() < 0.03), "{index}");
        }
    }

    #[test]
    fn a_trait_that_is_switched_off_leaves_the_others() {
        let [all, even] = [Variation::default(), Variation { cadence: 0.0, ..Variation::default() }]
            .map(|variation| variation.traits(3, 5));
        assert_eq!(even, Traits { cadence: 1.0, ..all });
        assert!(all.cadence != 1.0);
    }
}
