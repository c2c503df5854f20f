//! How long each stage of a command took. The libraries have no clock: they tell when a stage begins.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use motiondb_compiler::CompileEvent;
use serde::Serialize;

/// One stage.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Stage {
    pub(crate) name: &'static str,
    pub(crate) seconds: f64,
}

/// Stages as they begin.
#[derive(Default)]
pub(crate) struct Stopwatch {
    begun: Mutex<Vec<(&'static str, Instant)>>,
}

impl Stopwatch {
    /// A stage begins; the one before it is done.
    pub(crate) fn begin(&self, name: &'static str) {
        // A list of times cannot be left half-written.
        self.begun.lock().unwrap_or_else(PoisonError::into_inner).push((name, Instant::now()));
    }

    /// A compilation tells of its stages.
    pub(crate) fn watch(&self, event: CompileEvent) {
        if let CompileEvent::Stage(name) = event {
            self.begin(name);
        }
    }

    /// All stages in the order in which they began; the last ends now.
    pub(crate) fn finish(&self) -> Vec<Stage> {
        let end = Instant::now();
        let begun = self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        let ends = begun.iter().skip(1).map(|(_, next)| *next).chain([end]);
        let stage = |(&(name, start), end): (&(&'static str, Instant), Instant)| Stage {
            name,
            seconds: (end - start).as_secs_f64(),
        };
        begun.iter().zip(ends).map(stage).collect()
    }
}
