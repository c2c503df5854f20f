//! Which agent wears which character, and in which hue: seeded hashes of the agent's id.
//!
//! A choice depends on the seed, the id and the weights alone, so it does not change when agents are added after it.

/// Distinguishes the hash of the hue from that of the character.
const HUE: u64 = 0x68_75_65;

/// Index of the weight that an agent draws; none where no weight is positive. Weights that are not finite count as 0.
///
/// ```
/// use motiondb::character::chosen;
///
/// let counts = (0..1000).fold([0; 2], |mut counts, id| {
///     counts[chosen(7, id, [3.0, 1.0]).unwrap()] += 1;
///     counts
/// });
/// assert!((700..800).contains(&counts[0]));
/// assert_eq!(chosen(7, 0, [0.0]), None);
/// ```
pub fn chosen(seed: u64, id: u32, weights: impl IntoIterator<Item = f32>) -> Option<usize> {
    let weight = |weight: f32| if weight.is_finite() { f64::from(weight.max(0.0)) } else { 0.0 };
    let weights: Vec<f64> = weights.into_iter().map(weight).collect();
    let total: f64 = weights.iter().sum();
    let mut rest = fraction(seed, u64::from(id)) * total;
    let last = weights.iter().rposition(|weight| *weight > 0.0)?;
    for (index, weight) in weights.iter().enumerate().take(last) {
        if rest < *weight {
            return Some(index);
        }
        rest -= weight;
    }
    Some(last)
}

/// Turn of an agent's hue, in [−1, 1) times the greatest turn.
pub fn hue_turn(seed: u64, id: u32) -> f32 {
    (2.0 * fraction(seed ^ HUE, u64::from(id)) - 1.0) as f32
}

/// A number in [0, 1) by SplitMix64 (Steele, Lea and Flood 2014) of seed and number.
fn fraction(seed: u64, number: u64) -> f64 {
    const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;
    let mixed = |state: u64| {
        let state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        state ^ (state >> 31)
    };
    let hash = mixed(mixed(seed.wrapping_add(GAMMA)).wrapping_add(number.wrapping_add(1).wrapping_mul(GAMMA)));
    (hash >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_in_a_row_are_no_twins() {
        let choices: Vec<usize> = (0..60).map(|id| chosen(1, id, [1.0; 3]).unwrap()).collect();
        let repeats = choices.windows(2).filter(|pair| pair[0] == pair[1]).count();
        assert!((8..32).contains(&repeats), "{repeats}");
        for period in 1..=6 {
            assert!((0..60 - period).any(|index| choices[index] != choices[index + period]), "period {period}");
        }
    }

    #[test]
    fn a_weight_of_zero_is_never_chosen() {
        assert!((0..2000).all(|id| chosen(3, id, [0.0, 1.0, 0.0]) == Some(1)));
    }
}
