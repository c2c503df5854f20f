//! Comparisons that were made: which clips are different takes, and which are one take, by the keys of the clips.
//!
//! Almost all pairs of a library are different takes. They are one bit each.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use crate::dedup::comparison::Match;
use crate::retarget::human_clip::{Digest, HumanClip};

/// Number of pairs in a word of bits.
const WORD_BITS: usize = u64::BITS as usize;

/// The comparisons of a set of clips: those made before, and those that are added.
#[derive(Debug, Default)]
pub(crate) struct ComparisonLog {
    /// Keys of the clips, in ascending order.
    keys: Vec<Digest>,
    /// One bit for each ordered pair of clips: they were compared and are two takes.
    different: Vec<AtomicU64>,
    /// Ordered pairs that are one take.
    matches: Mutex<BTreeMap<(usize, usize), Match>>,
    /// Whether a comparison was added.
    is_new: AtomicBool,
}

/// The comparisons of a set of clips, as they are stored.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct LoggedComparisons {
    keys: Vec<Digest>,
    different: Vec<u64>,
    matches: Vec<((usize, usize), Match)>,
}

impl ComparisonLog {
    /// The log of clips of these keys, with what an earlier one knows of them.
    pub(crate) fn of(keys: impl Iterator<Item = Digest>, earlier: Option<&LoggedComparisons>) -> Self {
        let mut keys: Vec<Digest> = keys.collect();
        keys.sort_unstable();
        keys.dedup();
        let words = (keys.len() * keys.len()).div_ceil(WORD_BITS);
        let mut log = Self { keys, ..Self::default() };
        log.different.resize_with(words, AtomicU64::default);
        earlier.into_iter().for_each(|earlier| log.adopt(earlier));
        log
    }

    /// Adds what an earlier log knows of the same clips.
    fn adopt(&mut self, earlier: &LoggedComparisons) {
        let of_earlier = |key: &Digest| self.keys.binary_search(key).ok();
        let indices: Vec<Option<usize>> = earlier.keys.iter().map(of_earlier).collect();
        let index = |earlier: usize| indices.get(earlier).copied().flatten();
        let count = earlier.keys.len();
        let present: Vec<usize> = (0..count).filter(|&at| indices[at].is_some()).collect();
        for &leader in &present {
            for &clip in &present {
                let bit = leader * count + clip;
                let is_different =
                    earlier.different.get(bit / WORD_BITS).is_some_and(|word| word >> (bit % WORD_BITS) & 1 == 1);
                if let (true, Some(leader), Some(clip)) = (is_different, index(leader), index(clip)) {
                    self.mark_different(leader, clip);
                }
            }
        }
        let mut matches = self.matches.lock().unwrap_or_else(PoisonError::into_inner);
        for &((leader, clip), found) in &earlier.matches {
            if let (Some(leader), Some(clip)) = (index(leader), index(clip)) {
                matches.insert((leader, clip), found);
            }
        }
    }

    /// The index of a clip in this log; `None` where no cache knows the clip.
    pub(crate) fn index(&self, clip: &HumanClip) -> Option<usize> {
        self.keys.binary_search(&clip.stored.as_ref()?.key).ok()
    }

    /// The comparison of a leader with a clip: the logged one, or that of `compare`, which is logged.
    pub(crate) fn compared(
        &self,
        [leader, clip]: [Option<usize>; 2],
        compare: impl FnOnce() -> Option<Match>,
    ) -> Option<Match> {
        let (Some(leader), Some(clip)) = (leader, clip) else { return compare() };
        let (word, bit) = self.word(leader, clip);
        if word.load(Ordering::Relaxed) >> bit & 1 == 1 {
            return None;
        }
        let known = self.matches.lock().unwrap_or_else(PoisonError::into_inner).get(&(leader, clip)).copied();
        known.or_else(|| {
            let found = compare();
            self.is_new.store(true, Ordering::Relaxed);
            match found {
                None => self.mark_different(leader, clip),
                Some(found) => {
                    self.matches.lock().unwrap_or_else(PoisonError::into_inner).insert((leader, clip), found);
                }
            }
            found
        })
    }

    /// The log as it is stored; `None` where no comparison was added.
    pub(crate) fn logged_if_new(&self) -> Option<LoggedComparisons> {
        let matches = self.matches.lock().unwrap_or_else(PoisonError::into_inner);
        self.is_new.load(Ordering::Relaxed).then(|| LoggedComparisons {
            keys: self.keys.clone(),
            different: self.different.iter().map(|word| word.load(Ordering::Relaxed)).collect(),
            matches: matches.iter().map(|(pair, found)| (*pair, *found)).collect(),
        })
    }

    fn mark_different(&self, leader: usize, clip: usize) {
        let (word, bit) = self.word(leader, clip);
        word.fetch_or(1 << bit, Ordering::Relaxed);
    }

    fn word(&self, leader: usize, clip: usize) -> (&AtomicU64, usize) {
        let bit = leader * self.keys.len() + clip;
        (&self.different[bit / WORD_BITS], bit % WORD_BITS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dedup::alignment::Alignment;

    const TAKE: Match = Match { alignment: Alignment::IDENTITY, unlikeness: 0.1 };

    #[test]
    fn known_comparisons_are_not_made_again() {
        let keys = |all: &[u8]| all.iter().map(|&key| [key; 32]).collect::<Vec<Digest>>().into_iter();
        let log = ComparisonLog::of(keys(&[5, 3, 9, 3]), None);
        assert!(log.logged_if_new().is_none());
        let index = |log: &ComparisonLog, key: u8| log.keys.binary_search(&[key; 32]).ok();
        let ask = |log: &ComparisonLog, pair: [u8; 2], answer: Option<Match>| {
            let mut asked = false;
            let found = log.compared(pair.map(|key| index(log, key)), || {
                asked = true;
                answer
            });
            (asked, found.map(|found| found.unlikeness))
        };
        assert_eq!(ask(&log, [3, 5], None), (true, None));
        assert_eq!(ask(&log, [9, 3], Some(TAKE)), (true, Some(0.1)));
        assert_eq!(ask(&log, [3, 5], Some(TAKE)), (false, None));
        let later = ComparisonLog::of(keys(&[1, 3, 5, 9, 200]), log.logged_if_new().as_ref());
        assert!(later.logged_if_new().is_none());
        assert_eq!(ask(&later, [3, 5], Some(TAKE)), (false, None));
        assert_eq!(ask(&later, [9, 3], None), (false, Some(0.1)));
        assert_eq!(ask(&later, [3, 9], None), (true, None));
        assert_eq!(ask(&later, [5, 3], None), (true, None));
        assert_eq!(ask(&later, [77, 3], None), (true, None));
        assert_eq!(ask(&later, [77, 3], None), (true, None));
    }
}
