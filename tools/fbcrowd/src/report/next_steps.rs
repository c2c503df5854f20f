//! What to do after a compilation, the most useful step first.

use std::collections::BTreeSet;

use motiondb::diagnostic::{Diagnostic, Severity, Unfit};
use motiondb_compiler::input::manners_in_names;

use crate::report::compile_report::{CompileReport, ExampleReport};
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
    let manners = unstyled_manners(report);
    if manners.len() > 1 {
        next.push(format!(
            "File names suggest several styles ({}), but all these clips are blended as one. To separate them, state the \
             `style` of the clips in a manifest.toml.",
            manners.into_iter().collect::<Vec<_>>().join(", ")
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

/// Manners of moving in the names of the clips that have no style and give examples of gaits.
fn unstyled_manners(report: &CompileReport) -> BTreeSet<&'static str> {
    let moves = |example: &ExampleReport| example.speed_mps != 0.0 || example.strafe_mps != 0.0;
    let blended = report.used.iter().filter(|used| used.style.is_empty() && used.examples.iter().any(moves));
    manners_in_names(blended.map(|used| used.file.as_str()))
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
