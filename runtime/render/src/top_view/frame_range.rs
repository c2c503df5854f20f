//! Frame ranges, as film tools write them: `1001-1100`, `1001-1100x2` (or `:2`), `1010`, and lists of these with
//! commas.

use std::collections::BTreeSet;
use std::str::FromStr;

use crate::error::{FrameRangeFault, RenderError};

/// Frame numbers, as a user wrote them.
///
/// ```
/// use fbcrowd_render::{FrameRange, RenderError};
///
/// let range: FrameRange = "1001-1006x2, 1010".parse()?;
/// assert_eq!(range.clip(1001, 8)?, [1001, 1003, 1005]); // the sequence ends at 1008
/// assert!("1006-1001".parse::<FrameRange>().is_err());
/// # Ok::<(), RenderError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameRange {
    /// The user's text.
    text: String,
    spans: Vec<FrameSpan>,
}

/// A part `FIRST-LASTxSTEP` of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct FrameSpan {
    first: u32,
    last: u32,
    step: u32,
}

impl FromStr for FrameRange {
    type Err = RenderError;

    fn from_str(text: &str) -> Result<Self, RenderError> {
        let error = |part: &str, fault| RenderError::FrameRange { text: text.to_owned(), part: part.to_owned(), fault };
        let span = |part: &str| parse_span(part.trim()).map_err(|fault| error(part, fault));
        let spans = text.split(',').map(span).collect::<Result<_, _>>()?;
        Ok(Self { text: text.to_owned(), spans })
    }
}

impl FrameRange {
    /// The frame numbers that exist in a sequence of `frame_count` frames from `first` on, ascending, each once.
    ///
    /// # Errors
    /// If none exists.
    pub fn clip(&self, first: u32, frame_count: u32) -> Result<Vec<u32>, RenderError> {
        let last = first + frame_count.saturating_sub(1);
        let numbers: BTreeSet<u32> = self
            .spans
            .iter()
            .flat_map(|span| (span.first_from(first)..=span.last.min(last)).step_by(span.step as usize))
            .collect();
        if numbers.is_empty() {
            return Err(RenderError::NoFrames { text: self.text.clone(), first, last });
        }
        Ok(numbers.into_iter().collect())
    }
}

impl FrameSpan {
    /// The first number that is not below `first`.
    fn first_from(&self, first: u32) -> u32 {
        let steps = first.saturating_sub(self.first).div_ceil(self.step);
        self.first.saturating_add(steps.saturating_mul(self.step))
    }
}

fn parse_span(part: &str) -> Result<FrameSpan, FrameRangeFault> {
    let number = |digits: &str| digits.trim().parse::<u32>().map_err(|_| FrameRangeFault::Number);
    let (numbers, step) = match part.split_once(['x', ':']) {
        Some((numbers, step)) => (numbers, step.trim().parse::<u32>().map_err(|_| FrameRangeFault::Step)?),
        None => (part, 1),
    };
    let (first, last) = match numbers.split_once('-') {
        Some((first, last)) => (number(first)?, number(last)?),
        None => (number(numbers)?, number(numbers)?),
    };
    match (step, first <= last) {
        (0, _) => Err(FrameRangeFault::ZeroStep),
        (_, false) => Err(FrameRangeFault::Reversed),
        _ => Ok(FrameSpan { first, last, step }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &[u32]) {
        assert_eq!(text.parse::<FrameRange>().unwrap().clip(1001, 20).unwrap(), expected, "{text}");
    }

    #[test]
    fn frames_are_clipped_and_sorted() {
        check("1001-1003", &[1001, 1002, 1003]);
        check("1001-1006x2", &[1001, 1003, 1005]);
        check("1001-1006:3", &[1001, 1004]);
        check("1010,1005", &[1005, 1010]);
        check("1002, 1001-1003", &[1001, 1002, 1003]);
        check("1-4000000000x5", &[1001, 1006, 1011, 1016]);
        check("1019-1100", &[1019, 1020]);
    }

    #[test]
    fn invalid_range_is_rejected_with_its_fault() {
        use FrameRangeFault::{Number, Reversed, Step, ZeroStep};
        for (text, part, fault) in [
            ("", "", Number),
            ("1001,,1002", "", Number),
            ("a", "a", Number),
            ("1001-", "1001-", Number),
            ("1005-1001", "1005-1001", Reversed),
            ("1001-1005x0", "1001-1005x0", ZeroStep),
            ("1001-1005x", "1001-1005x", Step),
            ("99999999999", "99999999999", Number),
        ] {
            let error = text.parse::<FrameRange>().unwrap_err();
            let RenderError::FrameRange { part: found_part, fault: found, .. } = error else {
                panic!("{text}: {error}")
            };
            assert_eq!((found_part.as_str(), found), (part, fault), "{text}");
        }
        assert!(matches!("1-20".parse::<FrameRange>().unwrap().clip(1001, 5), Err(RenderError::NoFrames { .. })));
    }
}
