//! Clips → pairs of one take, without comparing each with each.
//!
//! The clips are gone through from the best on. Each is compared with those of the *list* in its order, and joins it:
//! unless it is a copy of the first clip of a take that the list already holds [`LISTED_MAX`] clips of. Such a clip is
//! settled, and neither it nor anything later is compared with it. So thousands of copies cost a comparison each, and
//! every two clips of a take of ordinary size are still compared.
//!
//! Clips that are no copies all come on the list: their cost grows with the square of their number, but at a rate of
//! some microseconds a pair ([`crate::dedup::outline`]), until the list is full; from then on clips are only compared with it,
//! and it is told which.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::dedup::same_take::{self, Entry, Match};

/// Clips of one take that later ones are compared with.
pub(crate) const LISTED_MAX: usize = 8;
/// Longest list: 8 million pairs, half a minute.
pub(crate) const LIST_MAX: usize = 4000;
/// Clips that are compared at once: as many as are listed, within these bounds. Within a batch each is compared with
/// each, which is wasted on what a longer list would have settled.
const BATCH_MIN: usize = 4;
const BATCH_MAX: usize = 256;

/// Two clips that were found to be one take: the better one, the other, and how.
pub(crate) type Found = (usize, usize, Match);

/// What was found, and which clips no later one was compared with since the list was full.
pub(crate) struct Search {
    pub(crate) found: Vec<Found>,
    pub(crate) beyond_list: Vec<usize>,
}

/// Pairs of one take. `order` are the clips from the best on; `may_pair` says which are compared at all.
pub(crate) fn search(entries: &[Entry], order: &[usize], may_pair: impl Fn(usize, usize) -> bool + Sync) -> Search {
    let (mut list, mut found, mut rest) = (List::default(), Vec::new(), order);
    let compare = |better: usize, clip: usize| {
        let how = || same_take::compare(&entries[better], &entries[clip]);
        if may_pair(better, clip) { how().map(|how| (better, clip, how)) } else { None }
    };
    while !rest.is_empty() {
        let (batch, later) = rest.split_at(list.clips.len().clamp(BATCH_MIN, BATCH_MAX).min(rest.len()));
        rest = later;
        let on_list = |&clip: &usize| {
            let all = list.clips.iter().filter_map(|&better| compare(better, clip));
            through_first(all, |(better, ..)| list.settles(*better))
        };
        let on_list: Vec<Vec<Found>> = batch.par_iter().map(on_list).collect();
        let is_open = |matches: &Vec<Found>| !matches.last().is_some_and(|(better, ..)| list.settles(*better));
        let open = batch.iter().zip(&on_list).filter(|(_, matches)| is_open(matches));
        let open: Vec<usize> = open.map(|(&clip, _)| clip).collect();
        let in_batch = |place: usize| open[..place].iter().filter_map(|&better| compare(better, open[place])).collect();
        let in_batch: Vec<Vec<Found>> = (0..open.len()).into_par_iter().map(in_batch).collect();
        let new = found.len();
        found.extend(on_list.into_iter().chain(in_batch).flatten());
        open.iter().for_each(|&clip| list.add(clip, &found[new..]));
    }
    Search { found, beyond_list: list.beyond }
}

/// What comes up to the first that is meant, and that one.
fn through_first<T>(mut all: impl Iterator<Item = T>, is_meant: impl Fn(&T) -> bool) -> Vec<T> {
    let mut told = Vec::new();
    while !told.last().is_some_and(&is_meant) {
        let Some(next) = all.next() else { break };
        told.push(next);
    }
    told
}

/// What later clips are compared with.
#[derive(Default)]
struct List {
    clips: Vec<usize>,
    /// The first clip of each listed one's take.
    first: BTreeMap<usize, usize>,
    /// Listed clips of the take of each first clip.
    counts: BTreeMap<usize, usize>,
    /// Clips that found it full.
    beyond: Vec<usize>,
}

impl List {
    /// Whether a copy of this clip need be compared with no other.
    fn settles(&self, clip: usize) -> bool {
        self.counts.get(&clip).is_some_and(|count| *count >= LISTED_MAX)
    }

    /// Adds a clip that was matched so, unless it is settled.
    fn add(&mut self, clip: usize, found: &[Found]) {
        let mut better = found.iter().filter(|(_, worse, _)| *worse == clip).map(|(better, ..)| *better);
        if better.clone().any(|better| self.settles(better)) {
            return;
        }
        if self.clips.len() == LIST_MAX {
            self.beyond.push(clip);
            return;
        }
        let first = better.find_map(|better| self.first.get(&better).copied()).unwrap_or(clip);
        self.clips.push(clip);
        self.first.insert(clip, first);
        *self.counts.entry(first).or_default() += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_finds_the_list_full_is_told() {
        let mut list = List::default();
        (0..LIST_MAX + 2).for_each(|clip| list.add(clip, &[]));
        assert_eq!((list.clips.len(), list.beyond), (LIST_MAX, vec![LIST_MAX, LIST_MAX + 1]));
    }
}
