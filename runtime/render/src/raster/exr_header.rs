//! The header of an EXR file with its attributes sorted by name.
//!
//! The `exr` crate stores attributes without a named field in a hash map, so that their order changes from run to run.
//! Sorted, the same picture has the same bytes. A header is a list of attributes (name, type, size, value), and an empty
//! name (OpenEXR file layout); the order of attributes is free.

use std::ops::Range;

/// Length of the magic number and the version before the header, bytes.
const START: usize = 8;

/// Sorts the attributes of a file of one part, in place, and returns the byte at which they end. Nothing changes where
/// the header is cut short.
pub(crate) fn sort_attributes(file: &mut [u8]) -> usize {
    let Some(ranges) = attributes(file) else { return 0 };
    let mut sorted: Vec<&[u8]> = ranges.iter().map(|range| &file[range.clone()]).collect();
    sorted.sort_unstable();
    let sorted = sorted.concat();
    let end = START + sorted.len();
    file[START..end].copy_from_slice(&sorted);
    end
}

/// The bytes of each attribute.
fn attributes(file: &[u8]) -> Option<Vec<Range<usize>>> {
    let text_end = |from: usize| Some(from + file.get(from..)?.iter().position(|byte| *byte == 0)? + 1);
    let (mut ranges, mut at) = (Vec::new(), START);
    while *file.get(at)? != 0 {
        let size_at = text_end(text_end(at)?)?;
        let size = u32::from_le_bytes(*file.get(size_at..)?.first_chunk()?) as usize;
        let end = size_at.checked_add(4)?.checked_add(size)?;
        file.get(at..end)?;
        ranges.push(at..end);
        at = end;
    }
    Some(ranges)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attribute(name: &str, value: &[u8]) -> Vec<u8> {
        [name.as_bytes(), b"\0int\0", &(value.len() as u32).to_le_bytes(), value].concat()
    }

    #[test]
    fn attributes_are_sorted_and_all_else_stays() {
        let [a, b] = [attribute("a", &[0; 4]), attribute("b", &[1, 2])];
        let file = |first: &[u8], second: &[u8]| [&[7; START], first, second, b"\0pixels"].concat();
        let mut written = file(&b, &a);
        sort_attributes(&mut written);
        assert_eq!(written, file(&a, &b));
        for length in 0..written.len() - 7 {
            let mut cut = written[..length].to_vec();
            sort_attributes(&mut cut);
            assert_eq!(cut, written[..length]);
        }
    }
}
