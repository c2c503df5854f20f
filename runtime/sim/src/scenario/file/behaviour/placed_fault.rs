//! Mistakes in the tables of behaviour, with their position in the text; names and their indices.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;

use crate::scenario::fault::TableFault;

/// Greatest number of states, goals, signals or areas: each name is a table of its own.
pub(crate) const ITEMS_MAX: usize = 4_000;
/// Greatest duration, s: a day.
pub(crate) const DURATION_MAX_S: f32 = 86_400.0;
/// Names that a message lists.
const NAMES_SHOWN: usize = 20;

/// A mistake, and its bytes in the text.
pub(crate) type PlacedFault = (Range<usize>, TableFault);

/// Gives faults a position.
pub(crate) trait At<T> {
    fn at(self, span: &Range<usize>) -> Result<T, PlacedFault>;
}

impl<T> At<T> for Result<T, TableFault> {
    fn at(self, span: &Range<usize>) -> Result<T, PlacedFault> {
        self.map_err(|fault| (span.clone(), fault))
    }
}

pub(crate) fn fault(span: &Range<usize>, message: String, help: &'static str) -> PlacedFault {
    (span.clone(), (message, help))
}

/// Checks the number of tables of one kind.
pub(crate) fn check_count<T>(what: &str, items: &BTreeMap<String, Spanned<T>>) -> Result<(), PlacedFault> {
    match items.values().nth(ITEMS_MAX) {
        None => Ok(()),
        Some(item) => {
            let message = format!("the scenario has {} {what}, more than {ITEMS_MAX}", items.len());
            Err(fault(&item.span(), message, "give fewer"))
        }
    }
}

/// The names of one kind of table, in the order of their indices.
pub(crate) struct Names<'a> {
    what: &'static str,
    sorted: Vec<&'a str>,
}

impl<'a> Names<'a> {
    /// The names of tables of a kind.
    pub(crate) fn new<T>(what: &'static str, items: &'a BTreeMap<String, T>) -> Self {
        Self { what, sorted: items.keys().map(String::as_str).collect() }
    }

    /// Index of a name.
    pub(crate) fn index(&self, name: &str) -> Result<usize, TableFault> {
        self.sorted.binary_search(&name).map_err(|_| {
            let (what, shown) = (self.what, &self.sorted[..self.sorted.len().min(NAMES_SHOWN)]);
            let message = match shown.is_empty() {
                true => format!("there is no {what} `{name}`, and none at all"),
                false => format!("there is no {what} `{name}`; there are `{}`", shown.join("`, `")),
            };
            (message, "correct the name, or add its table")
        })
    }
}
