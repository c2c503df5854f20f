//! The styles of a database: what each holds, and what it lacks.

use fbcrowd_jobs::wording::counted;
use motiondb::diagnostic::{Diagnostic, Note};
use motiondb::motion::{ActionKind, MotionDb, SourceRecord};
use motiondb::quality::coverage;
use schemars::JsonSchema;
use serde::Serialize;

/// A style of a database.
#[derive(JsonSchema, Serialize)]
pub(crate) struct StyleReport {
    /// The style; empty for clips without one.
    pub(crate) style: String,
    /// Number of examples, mirrored ones included.
    pub(crate) example_count: usize,
    /// Number of mirrored examples.
    pub(crate) mirror_count: usize,
    /// Number of idles.
    pub(crate) idle_count: usize,
    /// Number of transitions, mirrored ones included.
    pub(crate) transition_count: usize,
    /// The style whose idle it has; null where the idle is its own, or there is none.
    pub(crate) idle_of: Option<String>,
    /// What the style lacks and what to do, a sentence each.
    pub(crate) lacks: Vec<String>,
}

/// The styles of a database, the one of agents without a style first; empty where it has none.
pub(crate) fn style_reports(db: &MotionDb) -> Vec<StyleReport> {
    if db.has_styles() { db.styles().map(StyleReport::new).collect() } else { Vec::new() }
}

impl StyleReport {
    fn new(db: &MotionDb) -> Self {
        let count =
            |counts: &dyn Fn(ActionKind) -> bool| db.actions.iter().filter(|action| counts(action.kind)).count();
        let idle_of = db.sources.iter().find_map(lender).map(str::to_owned);
        Self {
            style: db.style.clone(),
            example_count: db.examples.len(),
            mirror_count: db.examples.iter().filter(|example| example.mirrored).count(),
            idle_count: db.idles().count(),
            transition_count: count(&|kind| kind != ActionKind::Idle),
            lacks: lacks(db, idle_of.is_some()),
            idle_of,
        }
    }

    /// The style in `width` columns, its counts, and what it lacks.
    fn line(&self, width: usize) -> String {
        let name = if self.style.is_empty() { "(no style)" } else { &self.style };
        let lender = self.idle_of.as_ref().map(|lender| match lender.as_str() {
            "" => " of a clip without style".to_owned(),
            lender => format!(" of `{lender}`"),
        });
        let counts = format!(
            "{} ({} mirrored), {}{}, {}",
            counted(self.example_count, "example", "examples"),
            self.mirror_count,
            counted(self.idle_count, "idle", "idles"),
            lender.unwrap_or_default(),
            counted(self.transition_count, "transition", "transitions"),
        );
        let lacks: String = self.lacks.iter().map(|sentence| format!("; {sentence}")).collect();
        format!("{name:<width$}  {counts}{lacks}")
    }
}

/// The style that lends a clip for its idle; none of a style's own clip.
pub(crate) fn lender(source: &SourceRecord) -> Option<&str> {
    source.diagnostics.iter().find_map(|diagnostic| match diagnostic {
        Diagnostic::Note(Note::IdleOfOtherStyle { lender, .. }) => Some(lender.as_str()),
        _ => None,
    })
}

/// What a style lacks, and what to do.
fn lacks(db: &MotionDb, has_lent_idle: bool) -> Vec<String> {
    let recorded = db.examples.iter().filter(|example| !example.mirrored);
    let stepping = recorded.filter(|example| example.key_times_s.is_some()).count();
    let mut lacks = Vec::new();
    if stepping == 0 {
        lacks.push("no stride: its agents reach no goal; add a steady walk, or state `style = \"\"`".to_owned());
    } else if !coverage::walks_ahead(db) {
        lacks.push("no walk straight on: add one, or its agents reach no goal".to_owned());
    } else if stepping == 1 {
        lacks.push("one stride: bodies deform it for every speed and turn; add a slow walk and a turn".to_owned());
    }
    if db.examples.iter().all(|example| example.key_times_s.is_some()) {
        lacks.push("no idle: bodies stand as in mid-stance; add a clip that stands".to_owned());
    } else if has_lent_idle {
        lacks.push("no idle of its own; add a clip that stands".to_owned());
    }
    lacks
}

/// A line for each style.
pub(crate) fn lines(styles: &[StyleReport]) -> Vec<String> {
    let width = styles.iter().map(|style| style.style.chars().count()).max().unwrap_or(0).max(10);
    styles.iter().map(|style| style.line(width)).collect()
}
