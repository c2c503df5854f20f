//! The text of `fbcrowd compile`: a summary, the clips and examples (the worst first), what to do next, and a last line
//! for scripts.
//!
//! A folder may hold a hundred clips, and a file thousands. Sentences that differ in one number become one, and long
//! lists end early (`--json` has all).

use fbcrowd_jobs::wording::counted;
use motiondb::diagnostic::Severity;
use motiondb::motion::SourceRecord;

use crate::report::compile_report::{CompileReport, UnusedClip};
use crate::report::example_table;
use crate::report::motion::{action_report, style_report};
use crate::report::plain_text::{one_line, title};
use crate::report::sentence_groups::group;

/// Most lines of a section; the others are counted.
const SHOWN_LINES: usize = 100;
/// Most clips that are named for one sentence; the others are counted.
const SHOWN_CLIPS: usize = 12;
/// Head of the table of examples. Seam and jerk are ratios to the cycle's own median step, of its pose and its
/// velocity.
const EXAMPLES: &str =
    "examples, worst first (! beyond its threshold; seam, jerk: in the cycle's usual step; leg: in its length)";
/// Head of the table of actions.
pub(crate) const ACTIONS: &str = "idles, the best first, and transitions (! has findings)";
/// Head of the table of styles.
pub(crate) const STYLES: &str = "styles, each blended by itself; agents without a style move in the first";
/// Columns of a line.
const WIDTH: usize = 110;

/// The whole report.
pub(crate) fn text(report: &CompileReport) -> String {
    let sections = [
        headline(report),
        section("rejected", grouped(report.refused.iter().map(reason))),
        section("no example", grouped(report.unused.iter().map(reason))),
        section("warnings", grouped(diagnostics(report, Severity::Warning))),
        section(STYLES, style_report::lines(&report.styles)),
        section(EXAMPLES, example_table::lines(report)),
        section(ACTIONS, action_report::lines(&report.actions)),
        section("quality", grouped(findings(report).chain(action_report::findings(&report.actions)))),
        section("notes: nothing to do", grouped(diagnostics(report, Severity::Note))),
        section(coverage_head(report), report.coverage.iter().map(|gap| gap.sentence.clone()).collect()),
        section("next", report.next.clone()),
    ];
    sections.concat() + "\n" + &last_line(report)
}

fn coverage_head(report: &CompileReport) -> &'static str {
    if report.styles.len() > 1 {
        "coverage gaps of the first style; `fbcrowd inspect --style NAME` lists those of another"
    } else {
        "coverage gaps"
    }
}

/// Why clips give no example, and what to do next.
pub(crate) fn reasons(report: &CompileReport) -> String {
    section("rejected", grouped(report.refused.iter().map(reason)))
        + &section("no example", grouped(report.unused.iter().map(reason)))
        + &section("warnings", grouped(diagnostics(report, Severity::Warning)))
        + &section("next", report.next.clone())
}

/// Diagnostics of clips by severity: no example, warnings, notes.
pub(crate) fn source_diagnostics<'a>(sources: impl Iterator<Item = &'a SourceRecord> + Clone) -> String {
    let of_severity = |severity: Severity| {
        let of_source = |source: &'a SourceRecord| {
            let found = source.diagnostics.iter().filter(move |diagnostic| diagnostic.severity() == severity);
            found.map(|diagnostic| (title(&source.file, &source.clip), diagnostic.to_string()))
        };
        grouped(sources.clone().flat_map(of_source))
    };
    section("no example", of_severity(Severity::NoExample))
        + &section("warnings", of_severity(Severity::Warning))
        + &section("notes: nothing to do", of_severity(Severity::Note))
}

/// The line that scripts read.
fn last_line(report: &CompileReport) -> String {
    let clips = report.used.len() + report.unused.len();
    format!(
        "{}: {} ({} of them mirrored) from {}, {}",
        report.output.as_deref().unwrap_or("nothing written"),
        counted(report.example_count, "example", "examples"),
        report.mirror_count,
        counted(clips, "clip", "clips"),
        counted(report.simplex_count, "simplex", "simplices"),
    )
}

/// Counts of clips and examples, and the durations of the stages.
fn headline(report: &CompileReport) -> String {
    let all = report.used.len() + report.unused.len() + report.refused.len();
    let mut warned: Vec<String> = diagnostics(report, Severity::Warning).map(|(clip, _)| clip).collect();
    warned.dedup();
    let counts = format!(
        "{}: {} used, {} without example, {} rejected; {} with warnings\n",
        counted(all, "clip", "clips"),
        report.used.len(),
        report.unused.len(),
        report.refused.len(),
        warned.len(),
    );
    let made = format!(
        "{}: {} recorded, {} mirrored; {}; {}\n",
        counted(report.example_count, "example", "examples"),
        report.example_count - report.mirror_count,
        report.mirror_count,
        counted(report.simplex_count, "simplex", "simplices"),
        action_report::counts(&report.actions),
    );
    let total_s: f64 = report.stages.iter().map(|stage| stage.seconds).sum();
    let stages = report.stages.iter().map(|stage| format!("{} {:.2}", stage.name, stage.seconds));
    counts + &made + &format!("{total_s:.2} s: {}\n", stages.collect::<Vec<_>>().join(", "))
}

/// A blank line, a head, and the lines; empty without lines.
pub(crate) fn section(head: &str, lines: Vec<String>) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let shown: String = lines.iter().take(SHOWN_LINES).map(|line| format!("  {}\n", one_line(line))).collect();
    let more = match lines.len().saturating_sub(SHOWN_LINES) {
        0 => String::new(),
        more => format!("  … and {more} more: --json has all\n"),
    };
    format!("\n{head}\n{shown}{more}")
}

/// Of a sentence about several clips, the number of clips and their names; else the clip and its sentence.
pub(crate) fn grouped(sentences: impl IntoIterator<Item = (String, String)>) -> Vec<String> {
    let mut lines = Vec::new();
    for group in group(sentences) {
        match &group.subjects[..] {
            [only] => lines.push(format!("{only}: {}", group.sentence())),
            several => {
                lines.push(format!("{} ({})", group.sentence(), several.len()));
                lines.extend(wrapped(several));
            }
        }
    }
    lines
}

/// Names side by side, in lines of the report's width.
fn wrapped(names: &[String]) -> Vec<String> {
    let more = names.len().saturating_sub(SHOWN_CLIPS);
    let shown = names.iter().take(SHOWN_CLIPS).cloned();
    let mut lines: Vec<String> = Vec::new();
    for name in shown.chain((more > 0).then(|| format!("and {more} more"))) {
        match lines.last_mut() {
            Some(line) if line.chars().count() + name.chars().count() + 2 <= WIDTH => *line += &format!(", {name}"),
            _ => lines.push(format!("    {name}")),
        }
    }
    lines
}

/// A clip, and why it gives no example.
fn reason(unused: &UnusedClip) -> (String, String) {
    (title(&unused.file, &unused.clip), unused.reason.clone())
}

/// Examples, and their figures beyond a threshold.
fn findings(report: &CompileReport) -> impl Iterator<Item = (String, String)> {
    report.findings.iter().map(|finding| (finding.example.clone(), finding.sentence.clone()))
}

/// Clips and the sentences of their diagnostics of a severity.
fn diagnostics(report: &CompileReport, severity: Severity) -> impl Iterator<Item = (String, String)> {
    report.of_severity(severity).map(|found| (title(&found.file, &found.clip), found.diagnostic.to_string()))
}
