//! What to do after a compilation, the most useful step first.

use motiondb::diagnostic::{Diagnostic, Severity, Unfit};

use crate::report::compile_report::CompileReport;
use crate::report::plain_text::title;

/// Most clips that one sentence names.
const NAMED: usize = 3;

/// A report with its next steps.
pub(crate) fn with_next_steps(report: CompileReport) -> CompileReport {
    CompileReport { next: next_steps(&report), ..report }
}

/// One sentence for each step. The commands in the sentences can be copied.
fn next_steps(report: &CompileReport) -> Vec<String> {
    let mut next = Vec::new();
    if !report.refused.is_empty() {
        let step = "Repair what is rejected, or leave it out: `skip = true` in its table of a manifest.toml.";
        next.push(step.to_owned());
    }
    let implausible = implausible_frame_times(report);
    if !implausible.is_empty() {
        next.push(format!(
            "Where a frame time is wrong, state `frame_rate_hz` in a manifest.toml: {}.",
            first_titles(&implausible)
        ));
    }
    if report.example_count == 0 {
        next.push("Give clips of steady walking, running, turning or standing.".to_owned());
    }
    if !report.unstyled_manners.is_empty() {
        next.push(format!(
            "Names of files and folders suggest styles ({}), but all these clips are blended as one. To separate them, state \
             the `style` of the clips in a manifest.toml.",
            Vec::from_iter(report.unstyled_manners.iter().copied()).join(", ")
        ));
    }
    next.extend(report.output.iter().flat_map(|output| with_database(report, output)));
    next
}

/// Steps that need the database at `output`.
fn with_database(report: &CompileReport, output: &str) -> Vec<String> {
    let mut next = Vec::new();
    if !report.findings.is_empty() || report.of_severity(Severity::Warning).next().is_some() {
        next.push(format!("Look at what is doubtful: fbcrowd inspect {output} --plots out/plots"));
    }
    if !report.coverage.is_empty() {
        next.push(
            "Add clips that close the coverage gaps; without them bodies deform a walk, or play the nearest example."
                .to_owned(),
        );
    }
    if report.example_count - report.mirror_count > 2 {
        next.push(format!(
            "See how near each example comes to a blend of the others: fbcrowd inspect {output} --leave-one-out"
        ));
    }
    next.push(format!("Simulate a crowd: fbcrowd simulate SCENARIO.toml --db {output} -o crowd.fbrec"));
    next
}

/// Clips with a gait that is too fast or too slow for a human.
fn implausible_frame_times(report: &CompileReport) -> Vec<String> {
    let is_inhuman = |found: &Diagnostic| matches!(found, Diagnostic::NoExample(Unfit::InhumanGait { .. }));
    let inhuman = report.diagnostics.iter().filter(|found| is_inhuman(&found.diagnostic));
    inhuman.map(|found| title(&found.file, &found.clip)).collect()
}

/// The first titles, and the number of the others.
fn first_titles(titles: &[String]) -> String {
    let shown = titles.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
    match titles.len().saturating_sub(NAMED) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}
