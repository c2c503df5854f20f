//! What a job reports while it runs: stages, progress in units of work, and notes for the user.

/// One report of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobEvent<'a> {
    /// A stage begins, and the stage before it ends. [`crate::stages::Stopwatch`] measures the time of each stage.
    Stage(&'static str),
    /// Work of a known number of units begins. At most one piece of work is under way.
    Begin {
        /// What is counted, in the plural: "files", "steps", "frames".
        units: &'static str,
        /// Number of units.
        total: usize,
    },
    /// One unit of the work under way is done. Any thread may report it, in any order.
    Advance,
    /// The work under way is complete.
    End,
    /// One line for the user.
    Note(&'a str),
}

/// Receives the reports of a job. A job calls it from all its threads.
pub type Observer<'a> = dyn Fn(JobEvent<'_>) + Sync + 'a;

/// Work of a known number of units, reported to an observer.
pub struct Work<'a> {
    observer: &'a Observer<'a>,
}

impl<'a> Work<'a> {
    /// Reports that `total` units of work begin.
    pub fn begin(observer: &'a Observer<'a>, units: &'static str, total: usize) -> Self {
        observer(JobEvent::Begin { units, total });
        Self { observer }
    }

    /// Reports that one unit is done.
    pub fn advance(&self) {
        (self.observer)(JobEvent::Advance);
    }

    /// Reports that all units are done.
    pub fn end(self) {
        (self.observer)(JobEvent::End);
    }
}
