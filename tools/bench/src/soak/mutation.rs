//! Mutations of a file's bytes, for readers that must never panic.
//!
//! An edit is three numbers that the caller draws: equal draws make equal mutations.

/// Bytes with a meaning in BVH, JSON and TOML.
const PUNCTUATION: &[u8] = b"0-{}[]\"=,:\n.e ";
/// Numbers that overflow, vanish, are negative or none.
const NUMBERS: [&str; 8] = ["0", "-1", "nan", "1e30", "1e-30", "4294967295", "18446744073709551615", "0.5"];
/// Four bytes that are hostile as a number, an index or a length.
const WORDS: [u32; 8] = [
    0,
    1,
    u32::MAX,
    i32::MAX as u32,
    f32::NAN.to_bits(),
    f32::INFINITY.to_bits(),
    (-1.0_f32).to_bits(),
    1e30_f32.to_bits(),
];
/// Most bytes that one edit drops or repeats.
const LONGEST: u32 = 256;

/// One edit. Any three numbers are one.
#[derive(Clone, Copy, Debug)]
pub struct Edit {
    /// Position, modulo the length of the bytes.
    pub position: u64,
    /// Kind of edit, modulo the number of kinds.
    pub kind: u8,
    /// Value for the edit.
    pub value: u32,
}

/// The bytes after some edits, one after the other.
pub fn mutated(bytes: &[u8], edits: &[Edit]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    edits.iter().for_each(|edit| edit.apply(&mut bytes));
    bytes
}

impl Edit {
    /// Alters some bytes; their number stays.
    pub fn alter(self, bytes: &mut [u8]) {
        let Some(at) = self.at(bytes) else { return };
        let word = at..bytes.len().min(at + size_of::<u32>());
        match self.kind % 4 {
            0 => bytes[at] = self.value as u8,
            1 => bytes[at] ^= 1 << (self.value % u8::BITS),
            2 => {
                let hostile = WORDS[self.value as usize % WORDS.len()].to_le_bytes();
                bytes[word.clone()].copy_from_slice(&hostile[..word.len()]);
            }
            _ => {
                let from = self.value as usize % (bytes.len() - word.len() + 1);
                bytes.copy_within(from..from + word.len(), at);
            }
        }
    }

    /// Alters, drops, repeats, inserts or cuts bytes, or replaces a number.
    pub fn apply(self, bytes: &mut Vec<u8>) {
        let Some(at) = self.at(bytes) else { return };
        let some = at..bytes.len().min(at + (self.value % LONGEST) as usize);
        match self.kind % 16 {
            0..4 => self.alter(bytes),
            4 => drop(bytes.drain(some)),
            5 => {
                let again = bytes[some].to_vec();
                bytes.splice(at..at, again);
            }
            6 => bytes.insert(at, PUNCTUATION[self.value as usize % PUNCTUATION.len()]),
            7 => bytes.truncate(at),
            // Most files that are read to the end are valid except for their numbers.
            _ => self.replace_number(bytes),
        }
    }

    /// Replaces the number at the position of a text, or after it.
    pub fn replace_number(self, text: &mut Vec<u8>) {
        let Some(at) = self.at(text) else { return };
        match self.kind % 8 {
            0..4 => replace_number(text, at, &(self.value % 1000).to_string()),
            _ => replace_number(text, at, NUMBERS[self.value as usize % NUMBERS.len()]),
        }
    }

    /// Position in the bytes; none where there are no bytes.
    fn at(self, bytes: &[u8]) -> Option<usize> {
        self.position.checked_rem(bytes.len() as u64).map(|at| at as usize)
    }
}

/// Replaces the next number of a text.
fn replace_number(bytes: &mut Vec<u8>, at: usize, number: &str) {
    let Some(start) = (at..bytes.len()).find(|&index| bytes[index].is_ascii_digit()) else {
        return;
    };
    let is_number = |&byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
    let length = bytes[start..].iter().take_while(|byte| is_number(byte)).count();
    bytes.splice(start..start + length, number.bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_replaced_as_a_whole() {
        let mut text = b"OFFSET 9.25e-1 4".to_vec();
        replace_number(&mut text, 3, "nan");
        assert_eq!(text, b"OFFSET nan 4");
    }

    #[test]
    fn every_edit_works_on_few_bytes_and_on_none() {
        for (kind, length) in (0..=u8::MAX).flat_map(|kind| (0..6).map(move |length| (kind, length))) {
            for (position, value) in [(0, 0), (u64::MAX, u32::MAX), (3, 255)] {
                let (edit, bytes) = (Edit { position, kind, value }, vec![b'7'; length]);
                let mut altered = bytes.clone();
                edit.alter(&mut altered);
                assert_eq!(altered.len(), length);
                mutated(&bytes, &[edit]);
            }
        }
    }
}
