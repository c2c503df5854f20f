//! What `fbcrowd inspect` says: the stable JSON (field names carry their units) and the tables for people.

use glam::Vec2;
use motiondb::diagnostic::Diagnostic;
use motiondb::motion::{MotionDb, MotionExample, SourceRecord};
use motiondb::quality::coverage::{self, CoverageGap};
use motiondb::velocity_sets::velocity_hull::{Construction, VelocityHull};
use motiondb_compiler::Rejection;
use motiondb_compiler::survey::{GaitKind, SourceGait, SurveyedSource};
use serde::Serialize;

use crate::compile_report::Reason;
use crate::compile_text::{self, counted, title};
use crate::correspondence_between::Between;
use crate::example_table::unsigned_zero;
use crate::leave_one_out::LeaveOneOut;
use crate::leave_one_out_text;
use crate::output::one_line;
use crate::readable::Readable;

/// Clips without a database.
#[derive(Serialize)]
pub(crate) struct SourcesReport {
    sources: Vec<Source>,
    refused: Vec<Reason>,
}

impl SourcesReport {
    pub(crate) fn new(surveyed: &[SurveyedSource], rejected: Vec<Rejection>) -> Self {
        let source = |found: &SurveyedSource| Source::new(&found.source, Some(found.gait.clone()));
        Self {
            sources: surveyed.iter().map(source).collect(),
            refused: rejected.into_iter().map(Reason::from).collect(),
        }
    }
}

/// A clip as it came.
#[derive(Serialize)]
struct Source {
    file: String,
    clip: String,
    speed_mps: f32,
    turn_rate_rad_s: f32,
    strafe_mps: f32,
    up_axis: String,
    metres_per_unit: f32,
    frame_rate_hz: f32,
    /// Sentences of the diagnostics.
    warnings: Vec<String>,
    diagnostics: Vec<Readable>,
    /// Of a clip without a database.
    #[serde(skip_serializing_if = "Option::is_none")]
    gait: Option<SourceGait>,
}

/// A whole database.
#[derive(Serialize)]
pub(crate) struct DatabaseReport {
    examples: Vec<Example>,
    sources: Vec<Source>,
    velocity_hull: VelocityHull,
    blend_space: BlendSpace,
    correspondence: Option<Correspondence>,
    coverage: Vec<CoverageGap>,
    /// Where asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) leave_one_out: Option<LeaveOneOut>,
    /// Where asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) correspondence_between: Option<Between>,
}

#[derive(Serialize)]
struct Example {
    name: String,
    source: String,
    clip: String,
    window_s: [f32; 2],
    mirrored: bool,
    speed_mps: f32,
    turn_rate_rad_s: f32,
    strafe_mps: f32,
    duration_s: f32,
    key_times_s: Option<[f32; 4]>,
    planted_slide_cm_s: f32,
    planted_share: f32,
}

/// Examples by name.
#[derive(Serialize)]
struct Correspondence {
    semi_procedural: String,
    blending: String,
    pairs_s: Vec<[f32; 2]>,
}

#[derive(Serialize)]
struct BlendSpace {
    dimension: u32,
    simplices: Vec<Vec<u32>>,
    covered_share: f32,
}

impl DatabaseReport {
    pub(crate) fn new(db: &MotionDb) -> Self {
        let name = |example: u32| db.examples[example as usize].name.clone();
        Self {
            examples: db.examples.iter().map(|example| Example::new(example, &db.sources)).collect(),
            sources: db.sources.iter().map(|source| Source::new(source, None)).collect(),
            velocity_hull: db.velocity_hull.clone(),
            blend_space: BlendSpace {
                dimension: db.blend_space.dimension,
                // A lone example is a point to the runtime, no simplex to people.
                simplices: db
                    .blend_space
                    .simplices()
                    .filter(|corners| corners.len() > 1)
                    .map(<[u32]>::to_vec)
                    .collect(),
                covered_share: db.blend_space.covered_share,
            },
            correspondence: db.correspondence.as_ref().map(|found| Correspondence {
                semi_procedural: name(found.semi_procedural),
                blending: name(found.blending),
                pairs_s: found.pairs_s.clone(),
            }),
            coverage: coverage::coverage(db),
            leave_one_out: None,
            correspondence_between: None,
        }
    }
}

impl Example {
    fn new(example: &MotionExample, sources: &[SourceRecord]) -> Self {
        let source = &sources[example.source as usize];
        Self {
            name: example.name.clone(),
            source: source.file.clone(),
            clip: source.clip.clone(),
            window_s: example.window_s,
            mirrored: example.mirrored,
            speed_mps: example.parameters.speed_mps,
            turn_rate_rad_s: example.parameters.turn_rate_rad_s,
            strafe_mps: example.parameters.strafe_mps,
            duration_s: example.phase_map.period_s,
            key_times_s: example.key_times_s,
            planted_slide_cm_s: example.planted_slide_cm_s,
            planted_share: example.planted_share,
        }
    }
}

impl Source {
    fn new(source: &SourceRecord, gait: Option<SourceGait>) -> Self {
        let sentence = |found: &Diagnostic| match found {
            Diagnostic::NoExample(unfit) => format!("no example: {unfit}"),
            other => other.to_string(),
        };
        Self {
            file: source.file.clone(),
            clip: source.clip.clone(),
            speed_mps: source.speed_mps,
            turn_rate_rad_s: source.turn_rate_rad_s,
            strafe_mps: source.strafe_mps,
            up_axis: source.up_axis.clone(),
            metres_per_unit: source.metres_per_unit,
            frame_rate_hz: source.frame_rate_hz,
            warnings: source.diagnostics.iter().map(sentence).collect(),
            diagnostics: source.diagnostics.iter().map(Readable::from).collect(),
            gait,
        }
    }
}

/// The database as tables.
pub(crate) fn database_text(db: &MotionDb, report: &DatabaseReport) -> String {
    let sections = [
        examples_text(&report.examples),
        sets_text(&report.velocity_hull),
        blend_space_text(&report.blend_space),
        correspondence_text(report.correspondence.as_ref()),
        report.correspondence_between.as_ref().map(Between::text).unwrap_or_default(),
        coverage_text(&report.coverage),
        report.leave_one_out.as_ref().map(leave_one_out_text::text).unwrap_or_default(),
        compile_text::diagnostics(db.sources.iter()),
    ];
    sections.concat()
}

fn examples_text(examples: &[Example]) -> String {
    let width = width(examples.iter().map(|example| example.name.as_str()), "example");
    let mut text = format!("{:<width$}  speed m/s  turn °/s  strafe m/s  period s  slide cm/s  planted\n", "example");
    for example in examples {
        text += &format!(
            "{:<width$}  {:9.3}  {:8.1}  {:10.3}  {:8.3}  {:10.2}  {:6.0} %\n",
            example.name,
            unsigned_zero(example.speed_mps, 3),
            unsigned_zero(example.turn_rate_rad_s.to_degrees(), 1),
            unsigned_zero(example.strafe_mps, 3),
            example.duration_s,
            example.planted_slide_cm_s,
            100.0 * example.planted_share,
        );
    }
    text
}

fn sets_text(hull: &VelocityHull) -> String {
    let holding = match hull.construction {
        Construction::TurningAndHolding => format!("holding set, m/s    {}\n", corners(&hull.holding_mps)),
        Construction::Paper => "holding set         the turning set (the paper's construction)\n".into(),
    };
    let turning = format!("\nturning set, m/s    {}\n", corners(&hull.turning_mps));
    turning + &holding + &format!("sharp-turn edges    {}\n", hull.sharp_turn_edges_mps.len())
}

fn blend_space_text(space: &BlendSpace) -> String {
    if space.dimension == 0 {
        return "blend space         a single point: nothing to blend\n".into();
    }
    let simplices = counted(space.simplices.len(), "simplex", "simplices");
    let dimensions = counted(space.dimension as usize, "dimension", "dimensions");
    format!("blend space         {simplices} in {dimensions}, {:.1} % of the hull\n", 100.0 * space.covered_share)
}

fn correspondence_text(correspondence: Option<&Correspondence>) -> String {
    let Some(found) = correspondence else { return "correspondences     none\n".into() };
    let pairs: Vec<String> = found.pairs_s.iter().map(|[sp, mb]| format!("{sp:.3}/{mb:.3}")).collect();
    format!("correspondences, s  {} / {}: {}\n", found.semi_procedural, found.blending, pairs.join("  "))
}

fn coverage_text(coverage: &[CoverageGap]) -> String {
    let nowhere = coverage.is_empty().then_some("nowhere");
    let sentences = nowhere.into_iter().chain(coverage.iter().map(|thin| thin.sentence.as_str()));
    let lines: String = sentences.map(|sentence| format!("  {sentence}\n")).collect();
    format!("\nwhere the set is thin\n{lines}")
}

fn corners(polygon: &[Vec2]) -> String {
    let corner = |corner: &Vec2| format!("({:.2}, {:.2})", unsigned_zero(corner.x, 2), unsigned_zero(corner.y, 2));
    polygon.iter().map(corner).collect::<Vec<_>>().join(" ")
}

/// Clips as a table.
pub(crate) fn sources_text(surveyed: &[SurveyedSource]) -> String {
    let names: Vec<String> =
        surveyed.iter().map(|found| one_line(&title(&found.source.file, &found.source.clip))).collect();
    let width = width(names.iter().map(String::as_str), "clip");
    let mut text = format!("{:<width$}  speed m/s  turn °/s  strafe m/s  up  m per unit     Hz  gait\n", "clip");
    for (name, SurveyedSource { source, gait }) in names.iter().zip(surveyed) {
        text += &format!(
            "{name:<width$}  {:9.3}  {:8.1}  {:10.3}  {}  {:10.6}  {:5.1}  {}\n",
            unsigned_zero(source.speed_mps, 3),
            unsigned_zero(source.turn_rate_rad_s.to_degrees(), 1),
            unsigned_zero(source.strafe_mps, 3),
            source.up_axis,
            source.metres_per_unit,
            source.frame_rate_hz,
            gait_text(gait),
        );
    }
    text + &compile_text::diagnostics(surveyed.iter().map(|found| &found.source))
}

/// Columns that names and the head above them take.
fn width<'a>(names: impl Iterator<Item = &'a str>, head: &str) -> usize {
    names.map(|name| name.chars().count()).fold(head.len(), usize::max)
}

/// "12 steps, 58 % planted"; "stands"; "3 steps, 61 % planted, unsteady".
fn gait_text(gait: &SourceGait) -> String {
    let steps = counted(gait.step_count(), "step", "steps");
    let text = format!("{steps}, {:.0} % planted", 100.0 * gait.planted_share);
    match &gait.kind {
        GaitKind::Steps => text,
        GaitKind::Stands => "stands".to_owned(),
        GaitKind::Unsteady { .. } => format!("{text}, unsteady"),
    }
}
