//! Idles and transitions of a database in JSON, and as a table.

use fbcrowd_jobs::json_schema::motion::{ActionKindMirror, FindingMirror};
use fbcrowd_jobs::wording::counted;
use motiondb::motion::{Action, ActionEnd, ActionKind, MotionDb};
use motiondb::quality::action_quality;
use motiondb::quality::finding::Finding;
use schemars::JsonSchema;
use serde::Serialize;

use crate::report::plain_text::{one_line, title, unsigned_zero};

/// An idle or a transition.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ActionReport {
    /// Name of the action.
    pub(crate) name: String,
    /// What the body does.
    #[schemars(with = "ActionKindMirror")]
    pub(crate) kind: ActionKind,
    /// File of the clip that it comes from.
    pub(crate) source: String,
    /// Name of the clip within the file; empty where the file holds one.
    pub(crate) clip: String,
    /// Start and end of the window in the clip, s.
    pub(crate) window_s: [f32; 2],
    /// Whether the motion is mirrored.
    pub(crate) mirrored: bool,
    /// Duration, s.
    pub(crate) duration_s: f32,
    /// Displacement of the root in the first root frame: forward and left, m.
    pub(crate) displacement_m: [f32; 2],
    /// Turn of the root, rad; counter-clockwise from above is positive.
    pub(crate) turn_rad: f32,
    /// The example that it leaves at its first frame.
    pub(crate) entry: ActionEndReport,
    /// The example that it joins at its last frame.
    pub(crate) exit: ActionEndReport,
    /// Mean speed of planted feet, cm/s.
    pub(crate) planted_slide_cm_s: f32,
    /// Quality figures beyond their threshold.
    #[schemars(with = "Vec<FindingMirror>")]
    pub(crate) findings: Vec<Finding>,
}

/// Where an action meets the cycle of an example.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ActionEndReport {
    /// Name of the example.
    pub(crate) example: String,
    /// Phase of the example, 0 to 1.
    pub(crate) phase: f32,
    /// Speed of the example along the facing, m/s; negative backward.
    pub(crate) speed_mps: f32,
    /// Turn rate of the example, rad/s; counter-clockwise from above is positive.
    pub(crate) turn_rate_rad_s: f32,
    /// Speed of the example to the left of the facing, m/s.
    pub(crate) strafe_mps: f32,
}

/// The reports of all actions of a database, in its order.
pub(crate) fn action_reports(db: &MotionDb) -> Vec<ActionReport> {
    db.actions.iter().map(|action| ActionReport::new(db, action)).collect()
}

impl ActionReport {
    fn new(db: &MotionDb, action: &Action) -> Self {
        let source = &db.sources[action.source as usize];
        Self {
            name: action.name.clone(),
            kind: action.kind,
            source: source.file.clone(),
            clip: source.clip.clone(),
            window_s: action.window_s,
            mirrored: action.mirrored,
            duration_s: action.duration_s(),
            displacement_m: action.displacement_m().to_array(),
            turn_rad: action.turn_rad(),
            entry: ActionEndReport::new(db, action.entry),
            exit: ActionEndReport::new(db, action.exit),
            planted_slide_cm_s: action_quality::quality(db, action).planted_slide_cm_s,
            findings: action_quality::findings(db, action),
        }
    }

    /// The name in `width` columns, what it does and where it comes from.
    fn line(&self, width: usize) -> String {
        let [ahead_m, left_m] = self.displacement_m.map(|metres| unsigned_zero(metres, 2));
        let mark = if self.findings.is_empty() { ' ' } else { '!' };
        let mirrored = if self.mirrored { ", mirrored" } else { "" };
        format!(
            "{:<width$}  {:<5}  {:>6.1} – {:<6.1}  {:8.2}  {:7.2}  {:6.2}  {:6.0}  {:9.1}{mark}  {}, {}{mirrored}",
            self.name,
            self.kind.name(),
            self.window_s[0],
            self.window_s[1],
            self.duration_s,
            ahead_m,
            left_m,
            unsigned_zero(self.turn_rad.to_degrees(), 0),
            self.planted_slide_cm_s,
            self.ends(),
            one_line(&title(&self.source, &self.clip)),
        )
    }

    /// "idle → walk"; the example alone where both ends are at the same.
    fn ends(&self) -> String {
        match (&self.entry.example, &self.exit.example) {
            (entry, exit) if entry == exit => entry.clone(),
            (entry, exit) => format!("{entry} → {exit}"),
        }
    }
}

impl ActionEndReport {
    fn new(db: &MotionDb, end: ActionEnd) -> Self {
        let example = &db.examples[end.example as usize];
        Self {
            example: example.name.clone(),
            phase: end.phase,
            speed_mps: example.parameters.speed_mps,
            turn_rate_rad_s: example.parameters.turn_rate_rad_s,
            strafe_mps: example.parameters.strafe_mps,
        }
    }
}

/// A head and a line for each action; none without actions.
pub(crate) fn lines(actions: &[ActionReport]) -> Vec<String> {
    let Some(width) = actions.iter().map(|action| action.name.chars().count()).max() else { return Vec::new() };
    let width = width.max(6);
    let head = format!(
        "{:<width$}  kind     window s          length s  ahead m  left m  turn °  slide cm/s  example at each end, source",
        "action"
    );
    std::iter::once(head).chain(actions.iter().map(|action| action.line(width))).collect()
}

/// The findings about all recorded actions, by name.
pub(crate) fn findings(actions: &[ActionReport]) -> impl Iterator<Item = (String, String)> {
    let recorded = actions.iter().filter(|action| !action.mirrored);
    recorded.flat_map(|action| action.findings.iter().map(|found| (action.name.clone(), found.sentence.clone())))
}

/// Kinds of transitions, with their names for one and for several.
const TRANSITIONS: [(ActionKind, [&str; 2]); 5] = [
    (ActionKind::Start, ["start", "starts"]),
    (ActionKind::Stop, ["stop", "stops"]),
    (ActionKind::Turn, ["turn", "turns"]),
    (ActionKind::Step, ["step", "steps"]),
    (ActionKind::Pivot, ["pivot", "pivots"]),
];

/// The kinds of transitions that a set lacks.
pub(crate) fn missing(actions: &[ActionReport]) -> Vec<ActionKind> {
    let kinds = TRANSITIONS.into_iter().map(|(kind, _)| kind);
    kinds.filter(|&kind| actions.iter().all(|action| action.kind != kind)).collect()
}

/// "1 idle; 2 turns, 1 step, no start, stop, pivot"; mirrored ones are not counted.
pub(crate) fn counts(actions: &[ActionReport]) -> String {
    let recorded = |kind: ActionKind| actions.iter().filter(|action| action.kind == kind && !action.mirrored).count();
    let idles = counted(recorded(ActionKind::Idle), "idle", "idles");
    let found = TRANSITIONS.into_iter().filter(|&(kind, _)| recorded(kind) > 0);
    let found: Vec<String> = found.map(|(kind, [one, many])| counted(recorded(kind), one, many)).collect();
    let missing: Vec<&str> = missing(actions).into_iter().map(ActionKind::name).collect();
    if found.is_empty() {
        return format!("{idles}, no transitions");
    }
    let missing = if missing.is_empty() { String::new() } else { format!(", no {}", missing.join(", ")) };
    format!("{idles}; {}{missing}", found.join(", "))
}
