//! What to do after a compilation, in the order of what it would gain.

use motiondb::diagnostic::{Diagnostic, Severity, Unfit};

use crate::compile_report::CompileReport;
use crate::compile_text::title;

/// Clips that an advice names.
const NAMED: usize = 3;

/// One sentence each; the commands in them can be copied.
pub(crate) fn next(report: &CompileReport) -> Vec<String> {
    let mut next = Vec::new();
    if !report.refused.is_empty() {
        next.push("Repair what is refused, or leave it out: `skip = true` in its table of a manifest.toml.".to_owned());
    }
    let inhuman = inhuman(report);
    if !inhuman.is_empty() {
        next.push(format!(
            "Where a frame time is wrong, state `frame_rate_hz` in a manifest.toml: {}.",
            named(&inhuman)
        ));
    }
    if report.example_count == 0 {
        next.push("Give clips of steady walking, running, turning or standing.".to_owned());
    }
    next.extend(report.output.iter().flat_map(|output| with_database(report, output)));
    next
}

/// What can be done with what was written.
fn with_database(report: &CompileReport, output: &str) -> Vec<String> {
    let mut next = Vec::new();
    if !report.findings.is_empty() || report.of_severity(Severity::Warning).next().is_some() {
        next.push(format!("Look at what is doubtful: fbcrowd inspect {output} --plots out/plots"));
    }
    if !report.coverage.is_empty() {
        next.push(
            "Add clips where the set is thin; without them bodies deform a walk, or do what is nearest.".to_owned(),
        );
    }
    if report.example_count - report.mirror_count > 2 {
        next.push(format!(
            "See how near each comes to a blend of the others: fbcrowd inspect {output} --leave-one-out"
        ));
    }
    next.push(format!("Let a crowd walk: fbcrowd simulate SCENARIO.toml --db {output} -o crowd.fbrec"));
    next
}

/// Clips whose gait no human has.
fn inhuman(report: &CompileReport) -> Vec<String> {
    let is_inhuman = |found: &Diagnostic| matches!(found, Diagnostic::NoExample(Unfit::InhumanGait { .. }));
    let inhuman = report.diagnostics.iter().filter(|found| is_inhuman(&found.diagnostic));
    inhuman.map(|found| title(&found.file, &found.clip)).collect()
}

fn named(titles: &[String]) -> String {
    let shown = titles.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
    match titles.len().saturating_sub(NAMED) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}
