//! Cryptomatte: ids from names, coverage of each id in a pixel, and the manifest (Psyop, Cryptomatte specification 1.2).

use std::fmt::Write as _;

/// MurmurHash3, x86, 32 bits, seed 0 (Appleby 2011).
pub(crate) fn murmur3(bytes: &[u8]) -> u32 {
    let scramble = |word: u32| word.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593);
    let (words, rest) = bytes.as_chunks::<4>();
    let mut hash = 0_u32;
    for word in words {
        hash ^= scramble(u32::from_le_bytes(*word));
        hash = hash.rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64);
    }
    if !rest.is_empty() {
        let mut word = [0; 4];
        word[..rest.len()].copy_from_slice(rest);
        hash ^= scramble(u32::from_le_bytes(word));
    }
    hash ^= bytes.len() as u32;
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
    hash ^ (hash >> 16)
}

/// The id of a name as the bits of a finite float that is no denormal: where all bits of the exponent are equal, the
/// lowest one changes.
pub(crate) fn id_bits(name: &str) -> u32 {
    let hash = murmur3(name.as_bytes());
    match (hash >> 23) & 0xff {
        0 | 0xff => hash ^ (1 << 23),
        _ => hash,
    }
}

/// The first seven digits of the hash of a layer's name: the key of its metadata.
pub(crate) fn layer_key(layer: &str) -> String {
    format!("{:08x}", murmur3(layer.as_bytes()))[..7].to_owned()
}

/// Number of ids that a pixel with a number of samples keeps: all for up to four samples, six for sixteen.
pub(crate) fn ranks(samples: usize) -> usize {
    match samples {
        1 => 2,
        2..=4 => 4,
        _ => 6,
    }
}

/// Coverages of the ids of a pixel.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coverage {
    /// Bits of the id, and the number of samples.
    of_ids: Vec<(u32, u32)>,
}

impl Coverage {
    /// Empties the pixel.
    pub(crate) fn clear(&mut self) {
        self.of_ids.clear();
    }

    /// Adds samples of an id.
    pub(crate) fn add(&mut self, id: u32, samples: u32) {
        match self.of_ids.iter_mut().find(|(other, _)| *other == id) {
            Some((_, count)) => *count += samples,
            None => self.of_ids.push((id, samples)),
        }
    }

    /// Appends id and coverage of each rank: falling coverage, ties by id; zeros beyond.
    pub(crate) fn append_ranks(&mut self, of_samples: usize, out: &mut Vec<f32>) {
        self.of_ids.sort_unstable_by_key(|&(id, samples)| (std::cmp::Reverse(samples), id));
        for rank in 0..ranks(of_samples) {
            let (id, samples) = self.of_ids.get(rank).copied().unwrap_or_default();
            out.extend([f32::from_bits(id), samples as f32 / of_samples as f32]);
        }
    }
}

/// Names and ids of a layer as JSON, in the order of the names.
pub(crate) fn manifest(names: impl Iterator<Item = String>) -> String {
    let mut text = String::from("{");
    for (index, name) in names.enumerate() {
        let separator = if index == 0 { "" } else { "," };
        // Names are made here: they hold no character that JSON escapes.
        let _ = write!(text, "{separator}\"{name}\":\"{:08x}\"", id_bits(&name));
    }
    text + "}"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_the_reference() {
        // Values of the reference implementation for seed 0.
        for (text, hash) in [("", 0), ("test", 0xba6b_d213), ("Hello, world!", 0xc036_3e43)] {
            assert_eq!(murmur3(text.as_bytes()), hash, "{text}");
        }
        // The key in the specification's example.
        assert_eq!(layer_key("CryptoAsset"), "f42029d");
    }

    #[test]
    fn ids_are_finite_and_no_denormals() {
        let ids = (0..100_000).map(|agent| f32::from_bits(id_bits(&format!("agent_{agent:04}"))));
        assert!({ ids }.all(f32::is_normal));
    }

    #[test]
    fn ranks_fall_in_coverage_and_then_rise_in_id() {
        let mut coverage = Coverage::default();
        for (id, samples) in [(9, 1), (7, 1), (3, 1), (9, 1)] {
            coverage.add(id, samples);
        }
        let mut out = Vec::new();
        coverage.append_ranks(4, &mut out);
        let bits = |value: &f32| value.to_bits();
        assert_eq!(out.iter().step_by(2).map(bits).collect::<Vec<_>>(), [9, 3, 7, 0]);
        assert_eq!(out.iter().skip(1).step_by(2).copied().collect::<Vec<_>>(), [0.5, 0.25, 0.25, 0.0]);
    }

    #[test]
    fn manifests_list_names_in_their_order() {
        let text = manifest(["agent_0000", "agent_0002"].map(str::to_owned).into_iter());
        assert!(text.starts_with("{\"agent_0000\":\"") && text.contains(",\"agent_0002\":\""), "{text}");
    }
}
