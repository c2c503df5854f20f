//! The report of `fbcrowd compile` for people: a summary first, then the worst first, what to do, and a last line that
//! says it all once more.
//!
//! A folder may hold a hundred clips and a file thousands: sentences that differ in one number are told once, and long
//! lists end early (`--json` has all).

use motiondb::diagnostic::Severity;
use motiondb::motion::SourceRecord;

use crate::compile_report::{CompileReport, Reason};
use crate::example_table;
use crate::grouping::group;
use crate::output::one_line;

/// Lines of a section, and clips named in a sentence; what follows is counted.
const SHOWN_LINES: usize = 100;
const SHOWN_CLIPS: usize = 12;
/// Seam and jerk are ratios to the cycle's own median step, of its pose and of its velocity.
const EXAMPLES: &str =
    "examples, worst first (! beyond its threshold; seam, jerk: in the cycle's usual step; leg: in its length)";
/// Columns of a line.
const WIDTH: usize = 110;

/// The whole report.
pub(crate) fn text(report: &CompileReport) -> String {
    let sections = [
        headline(report),
        section("refused", grouped(report.refused.iter().map(said))),
        section("no example", grouped(report.unused.iter().map(said))),
        section("warnings", grouped(found(report, Severity::Warning))),
        section(EXAMPLES, example_table::lines(report)),
        section("quality", grouped(findings(report))),
        section("notes: nothing to do", grouped(found(report, Severity::Note))),
        section("where the set is thin", report.coverage.iter().map(|thin| thin.sentence.clone()).collect()),
        section("next", report.next.clone()),
    ];
    sections.concat() + "\n" + &last_line(report)
}

/// Of clips of which none gives an example, why.
pub(crate) fn reasons(report: &CompileReport) -> String {
    section("refused", grouped(report.refused.iter().map(said)))
        + &section("no example", grouped(report.unused.iter().map(said)))
        + &section("warnings", grouped(found(report, Severity::Warning)))
}

/// The diagnostics of clips, by severity.
pub(crate) fn diagnostics<'a>(sources: impl Iterator<Item = &'a SourceRecord> + Clone) -> String {
    let of_severity = |wanted: Severity| {
        let of_source = |source: &'a SourceRecord| {
            let found = source.diagnostics.iter().filter(move |found| found.severity() == wanted);
            found.map(|found| (title(&source.file, &source.clip), found.to_string()))
        };
        grouped(sources.clone().flat_map(of_source))
    };
    section("no example", of_severity(Severity::NoExample))
        + &section("warnings", of_severity(Severity::Warning))
        + &section("notes: nothing to do", of_severity(Severity::Note))
}

/// What scripts read.
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

fn headline(report: &CompileReport) -> String {
    let all = report.used.len() + report.unused.len() + report.refused.len();
    let mut warned: Vec<String> = found(report, Severity::Warning).map(|(clip, _)| clip).collect();
    warned.dedup();
    let counts = format!(
        "{}: {} used, {} without example, {} refused; {} with warnings\n",
        counted(all, "clip", "clips"),
        report.used.len(),
        report.unused.len(),
        report.refused.len(),
        warned.len(),
    );
    let made = format!(
        "{}: {} recorded, {} mirrored; {}\n",
        counted(report.example_count, "example", "examples"),
        report.example_count - report.mirror_count,
        report.mirror_count,
        counted(report.simplex_count, "simplex", "simplices"),
    );
    let total_s: f64 = report.stages.iter().map(|stage| stage.seconds).sum();
    let stages = report.stages.iter().map(|stage| format!("{} {:.2}", stage.name, stage.seconds));
    counts + &made + &format!("{total_s:.2} s: {}\n", stages.collect::<Vec<_>>().join(", "))
}

/// "1 simplex", "2 simplices".
pub(crate) fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// A file and its clip, as one name.
pub(crate) fn title(file: &str, clip: &str) -> String {
    format!("{file} {clip}").trim_end().to_owned()
}

fn said(reason: &Reason) -> (String, String) {
    (title(&reason.file, &reason.clip), reason.reason.clone())
}

/// Nothing, or a blank line, a head, and the lines.
fn section(head: &str, lines: Vec<String>) -> String {
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

/// A sentence that was said of several clips, how often and of which; else the clip and its sentence.
fn grouped(said: impl IntoIterator<Item = (String, String)>) -> Vec<String> {
    let mut lines = Vec::new();
    for group in group(said) {
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

fn findings(report: &CompileReport) -> impl Iterator<Item = (String, String)> {
    report.findings.iter().map(|finding| (finding.example.clone(), finding.sentence.clone()))
}

/// Clips and the sentences of their diagnostics of a severity.
fn found(report: &CompileReport, severity: Severity) -> impl Iterator<Item = (String, String)> {
    report.of_severity(severity).map(|found| (title(&found.file, &found.clip), found.diagnostic.to_string()))
}
