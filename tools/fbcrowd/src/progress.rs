//! Progress of long work on standard error: a bar on a terminal, a plain line every tenth elsewhere.

use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicU64, Ordering};

use indicatif::{ProgressBar, ProgressStyle};

use crate::output;

const TEMPLATE: &str = "{msg:>12} [{bar:40}] {pos}/{len} {eta}";

/// Work of a known length; shared by the threads that do it.
pub(crate) struct Progress {
    label: &'static str,
    total: u64,
    done: AtomicU64,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// `total` units of work called `label`.
    pub(crate) fn new(label: &'static str, total: usize) -> Self {
        let total = total as u64;
        let bar = io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template(TEMPLATE).unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::new(total).with_style(style.progress_chars("=> ")).with_message(label)
        });
        Self { label, total, done: AtomicU64::new(0), bar }
    }

    /// One unit is done.
    pub(crate) fn advance(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        match &self.bar {
            Some(bar) => bar.inc(1),
            None if tenth(done, self.total) != tenth(done - 1, self.total) => {
                output::say(&format!("{}: {done}/{}", self.label, self.total));
            }
            None => {}
        }
    }

    /// All is done.
    pub(crate) fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish();
        }
    }
}

fn tenth(done: u64, total: u64) -> u64 {
    10 * done / total.max(1)
}
