//! Decimal numbers from text: the same bits as `str::parse`, several times faster. A capture of minutes holds millions
//! of short numbers.
//!
//! A whole number of up to 15 digits and a power of ten up to 10²² are exact in an f64, so one division rounds
//! correctly (W. D. Clinger, *How to read floating point numbers accurately*, 1990). The standard library reads longer
//! numbers.

/// Greatest length of an unsigned number that is read here; whole numbers of up to 15 digits are exact in an f64.
const MAX_DIGITS: usize = 15;
/// Powers of ten, by exponent.
const POWERS: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// The finite number that a word spells, if any.
pub(crate) fn number(word: &str) -> Option<f64> {
    short(word.as_bytes()).or_else(|| word.parse().ok()).filter(|value| value.is_finite())
}

/// A short number without an exponent, such as `-12.345678`.
fn short(word: &[u8]) -> Option<f64> {
    let (is_negative, unsigned) = match word {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, word),
    };
    if unsigned.len() > MAX_DIGITS {
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
        fn every_word_reads_as_in_the_standard_library(word in "[-+]?[0-9]{0,12}[.]?[0-9]{0,12}(e[-+]?[0-9]{1,2})?") {
            let bits = |value: Option<f64>| value.map(f64::to_bits);
            prop_assert_eq!(bits(number(&word)), bits(word.parse().ok()), "{}", word);
        }
    }

    #[test]
    fn other_words_are_no_numbers() {
        for word in ["", "-", ".", "-.", "1.2.3", "1,5", "nan", "inf", "1e999", "0x10", "--1"] {
            assert_eq!(number(word), None, "{word}");
        }
    }
}
