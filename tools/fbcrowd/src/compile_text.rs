//! The report of `fbcrowd compile` for people: a summary first, then the worst first, what to do, and a last line that
//! says it all once more.
//!
//! A folder may hold a hundred clips and a file thousands: sentences that differ in one number are told once, and long
//! lists end early (`--json` has all).

use motiondb::motion_db::SourceRecord;
use motiondb_compiler::remark::{Weight, bare, weight};

use crate::compile_report::{CompileReport, Reason};
use crate::example_table;
use crate::grouping::group;

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
        section("warnings", warnings(report)),
        section(EXAMPLES, example_table::lines(report)),
        section("quality", grouped(findings(report))),
        section("notes: nothing to do", grouped(notes(report))),
        section("where the set is thin", report.coverage.iter().map(|thin| thin.sentence.clone()).collect()),
        section("next", report.next.clone()),
    ];
    sections.concat() + "\n" + &last_line(report)
}

/// Of clips of which none gives an example, why.
pub(crate) fn reasons(report: &CompileReport) -> String {
    section("refused", grouped(report.refused.iter().map(said)))
        + &section("no example", grouped(report.unused.iter().map(said)))
        + &section("warnings", warnings(report))
}

/// What is said of clips, by weight: which give no example, what is doubtful, what is only noted.
pub(crate) fn remarks<'a>(sources: impl Iterator<Item = &'a SourceRecord> + Clone) -> String {
    let of_weight = |wanted: Weight| {
        let said = |source: &'a SourceRecord| {
            let texts = source.warnings.iter().filter(move |text| weight(text) == wanted);
            texts.map(|text| (title(&source.file, &source.clip), bare(text).to_owned()))
        };
        grouped(sources.clone().flat_map(said))
    };
    section("no example", of_weight(Weight::NoExample))
        + &section("warnings", of_weight(Weight::Warning))
        + &section("notes: nothing to do", of_weight(Weight::Note))
}

/// What scripts read.
fn last_line(report: &CompileReport) -> String {
    let clips = report.used.len() + report.unused.len();
    format!(
        "{}: {} ({} of them mirrored) from {}, {}",
        report.output.as_deref().unwrap_or("nothing written"),
        counted(report.example_count, "example"),
        report.mirror_count,
        counted(clips, "clip"),
        simplices(report.simplex_count),
    )
}

fn headline(report: &CompileReport) -> String {
    let all = report.used.len() + report.unused.len() + report.refused.len();
    let warned = warnings(report).len();
    let counts = format!(
        "{}: {} used, {} without example, {} refused; {warned} with warnings\n",
        counted(all, "clip"),
        report.used.len(),
        report.unused.len(),
        report.refused.len(),
    );
    let made = format!(
        "{}: {} recorded, {} mirrored; {}\n",
        counted(report.example_count, "example"),
        report.example_count - report.mirror_count,
        report.mirror_count,
        simplices(report.simplex_count),
    );
    let total_s: f64 = report.stages.iter().map(|stage| stage.seconds).sum();
    let stages = report.stages.iter().map(|stage| format!("{} {:.2}", stage.name, stage.seconds));
    counts + &made + &format!("{total_s:.2} s: {}\n", stages.collect::<Vec<_>>().join(", "))
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

fn simplices(count: usize) -> String {
    if count == 1 { "1 simplex".to_owned() } else { format!("{count} simplices") }
}

/// A file and its clip, as one name.
pub(crate) fn title(file: &str, clip: &str) -> String {
    format!("{file} {clip}").trim_end().to_owned()
}

fn said(reason: &Reason) -> (String, String) {
    (title(&reason.file, &reason.clip), reason.reason.clone())
}

/// Nothing, or a blank line, a head with the number of lines, and the lines.
fn section(head: &str, lines: Vec<String>) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let shown = lines.iter().take(SHOWN_LINES).map(|line| format!("  {line}\n")).collect::<String>();
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

/// One line a clip.
fn warnings(report: &CompileReport) -> Vec<String> {
    let mut lines: Vec<(String, Vec<&str>)> = Vec::new();
    for warning in report.warnings.iter().filter(|warning| !warning.note) {
        let title = title(&warning.file, &warning.clip);
        match lines.last_mut() {
            Some((clip, texts)) if *clip == title => texts.push(&warning.text),
            _ => lines.push((title, vec![&warning.text])),
        }
    }
    lines.into_iter().map(|(title, texts)| format!("{title}: {}", texts.join("; "))).collect()
}

fn findings(report: &CompileReport) -> impl Iterator<Item = (String, String)> {
    report.findings.iter().map(|finding| (finding.example.clone(), finding.sentence.clone()))
}

fn notes(report: &CompileReport) -> impl Iterator<Item = (String, String)> {
    let notes = report.warnings.iter().filter(|warning| warning.note);
    notes.map(|note| (title(&note.file, &note.clip), note.text.clone()))
}
