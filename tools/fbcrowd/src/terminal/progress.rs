//! Progress of a job on standard error: a bar on a terminal, a plain line every tenth elsewhere.

use std::io::{self, IsTerminal};
use std::sync::{Mutex, PoisonError};

use fbcrowd_jobs::JobEvent;
use indicatif::{ProgressBar, ProgressStyle};

use crate::terminal::output;

const TEMPLATE: &str = "{msg:>12} [{bar:40}] {pos}/{len} {eta}";

/// Shows the events of a job. All threads of the job share it.
#[derive(Default)]
pub(crate) struct ProgressDisplay {
    work: Mutex<Option<Work>>,
}

/// The work under way.
struct Work {
    units: &'static str,
    total: usize,
    done: usize,
    /// On a terminal only.
    bar: Option<ProgressBar>,
}

impl ProgressDisplay {
    /// Shows one event.
    pub(crate) fn observe(&self, event: JobEvent<'_>) {
        match event {
            // Stages are for reports.
            JobEvent::Stage(_) => {}
            JobEvent::Begin { units, total } => self.replace(Some(Work::new(units, total))),
            JobEvent::Advance => {
                if let Some(work) = self.work.lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
                    work.advance();
                }
            }
            JobEvent::End => self.replace(None),
            JobEvent::Note(note) => output::say(&format!("note: {note}")),
        }
    }

    fn replace(&self, work: Option<Work>) {
        let before = std::mem::replace(&mut *self.work.lock().unwrap_or_else(PoisonError::into_inner), work);
        if let Some(bar) = before.and_then(|work| work.bar) {
            bar.finish();
        }
    }
}

impl Work {
    fn new(units: &'static str, total: usize) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template(TEMPLATE).unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::new(total as u64).with_style(style.progress_chars("=> ")).with_message(units)
        });
        Self { units, total, done: 0, bar }
    }

    fn advance(&mut self) {
        self.done += 1;
        match &self.bar {
            Some(bar) => bar.inc(1),
            None if self.tenth(self.done) != self.tenth(self.done - 1) => {
                output::say(&format!("{}: {}/{}", self.units, self.done, self.total));
            }
            None => {}
        }
    }

    fn tenth(&self, done: usize) -> usize {
        10 * done / self.total.max(1)
    }
}
