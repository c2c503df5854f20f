//! Decimal numbers from text, to the bit as `str::parse` reads them and several times faster: a capture of minutes is
//! millions of short ones.
//!
//! Up to fifteen digits and a power of ten up to 10²² are both exact in an f64, so that one division rounds correctly
//! (W. D. Clinger, *How to read floating point numbers accurately*, 1990). What is longer is left to the standard
//! library.

/// More digits may not be exact in an f64.
const MOST_DIGITS: usize = 15;
const POWERS: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// The number that a word spells; none where it spells none, or one that is not finite.
pub(crate) fn number(word: &str) -> Option<f64> {
    short(word.as_bytes()).or_else(|| word.parse().ok()).filter(|value| value.is_finite())
}

/// `-12.345678`: a sign, digits with a point among them and nothing else.
fn short(word: &[u8]) -> Option<f64> {
    let (is_negative, unsigned) = match word {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, word),
    };
    if unsigned.len() > MOST_DIGITS {
        return None;
    }
    let (mut digits, mut decimals, mut points) = (0u64, 0, 0);
    for &byte in unsigned {
        match byte {
            b'0'..=b'9' => {
                digits = 10 * digits + u64::from(byte - b'0');
                decimals += points;
            }
            b'.' => points += 1,
            _ => return None,
        }
    }
    if points > 1 || unsigned.len() == points {
        return None;
    }
    let value = digits as f64 / POWERS[decimals];
    Some(if is_negative { -value } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_word_reads_as_the_standard_library_reads_it(word in "[-+]?[0-9]{0,12}[.]?[0-9]{0,12}(e[-+]?[0-9]{1,2})?") {
            let bits = |value: Option<f64>| value.map(f64::to_bits);
            prop_assert_eq!(bits(number(&word)), bits(word.parse().ok()), "{}", word);
        }
    }

    #[test]
    fn what_is_no_number_is_none() {
        for word in ["", "-", ".", "-.", "1.2.3", "1,5", "nan", "inf", "1e999", "0x10", "--1"] {
            assert_eq!(number(word), None, "{word}");
        }
    }
}
