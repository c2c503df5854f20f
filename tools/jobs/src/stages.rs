//! Durations of a job's stages. The libraries below have no clock: they report when a stage begins.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use schemars::JsonSchema;
use serde::Serialize;

use crate::observer::JobEvent;

/// Duration of one stage.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct StageTime {
    /// Name of the stage.
    pub name: &'static str,
    /// Duration, s.
    pub seconds: f64,
}

/// Start times of the stages that an observer passes on.
#[derive(Default)]
pub struct Stopwatch {
    begun: Mutex<Vec<(&'static str, Instant)>>,
}

impl Stopwatch {
    /// Notes the start of a stage; ignores every other event.
    pub fn observe(&self, event: JobEvent<'_>) {
        if let JobEvent::Stage(name) = event {
            // A list of start times cannot be left half-written.
            self.begun.lock().unwrap_or_else(PoisonError::into_inner).push((name, Instant::now()));
        }
    }

    /// All stages in the order in which they began, those of one name together. The last one ends now.
    pub fn stage_times(&self) -> Vec<StageTime> {
        let end = Instant::now();
        let begun = self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        let ends = begun.iter().skip(1).map(|(_, next)| *next).chain([end]);
        let stage_time = |(&(name, start), end): (&(&'static str, Instant), Instant)| StageTime {
            name,
            seconds: (end - start).as_secs_f64(),
        };
        let mut times: Vec<StageTime> = Vec::new();
        for time in begun.iter().zip(ends).map(stage_time) {
            match times.iter_mut().find(|other| other.name == time.name) {
                Some(other) => other.seconds += time.seconds,
                None => times.push(time),
            }
        }
        times
    }
}
