//! What `fbcrowd inspect` says: the stable JSON (`definitions.md`; field names carry their units) and the tables for
//! people.

use glam::Vec2;
use motiondb::coverage::{self, ThinPlace};
use motiondb::motion_db::{MotionDb, MotionExample, SourceRecord};
use motiondb::velocity_hull::{Construction, VelocityHull};
use motiondb_compiler::refused::Refused;
use motiondb_compiler::survey::{GaitKind, SourceGait, SurveyedSource};
use serde::Serialize;

use crate::compile_report::Reason;
use crate::correspondence_between::Between;
use crate::example_table::unsigned_zero;
use crate::leave_one_out::LeaveOneOut;
use crate::{compile_text, leave_one_out_text};

/// Clips without a database.
#[derive(Serialize)]
pub(crate) struct SourcesReport {
    pub(crate) sources: Vec<SurveyedSource>,
    refused: Vec<Reason>,
}

impl SourcesReport {
    pub(crate) fn new(sources: Vec<SurveyedSource>, refused: Vec<Refused>) -> Self {
        Self { sources, refused: refused.into_iter().map(Reason::from).collect() }
    }
}

/// A whole database.
#[derive(Serialize)]
pub(crate) struct DatabaseReport {
    examples: Vec<Example>,
    sources: Vec<SourceRecord>,
    velocity_hull: VelocityHull,
    blend_space: BlendSpace,
    correspondence: Option<Correspondence>,
    coverage: Vec<ThinPlace>,
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
            sources: db.sources.clone(),
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

/// The database as tables.
pub(crate) fn database_text(report: &DatabaseReport) -> String {
    let width = report.examples.iter().map(|example| example.name.chars().count()).max().unwrap_or(0).max(7);
    let mut text = format!("{:<width$}  speed m/s  turn °/s  strafe m/s  period s  slide cm/s  planted\n", "example");
    for example in &report.examples {
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
    let hull = &report.velocity_hull;
    text += &format!("\nturning set, m/s    {}\n", corners(&hull.turning_mps));
    text += &match hull.construction {
        Construction::TurningAndHolding => format!("holding set, m/s    {}\n", corners(&hull.holding_mps)),
        Construction::Paper => "holding set         the turning set (the paper's construction)\n".into(),
    };
    text += &format!("sharp-turn edges    {}\n", hull.sharp_turn_edges_mps.len());
    text += &format!(
        "blend space         {} simplices in {} dimensions, {:.1} % of the hull\n",
        report.blend_space.simplices.len(),
        report.blend_space.dimension,
        100.0 * report.blend_space.covered_share,
    );
    text += &correspondence_text(report);
    text += &report.correspondence_between.as_ref().map(Between::text).unwrap_or_default();
    text += &coverage_text(report);
    text += &report.leave_one_out.as_ref().map(leave_one_out_text::text).unwrap_or_default();
    text + &compile_text::remarks(report.sources.iter())
}

fn correspondence_text(report: &DatabaseReport) -> String {
    let Some(found) = &report.correspondence else { return "correspondences     none\n".into() };
    let pairs: Vec<String> = found.pairs_s.iter().map(|[sp, mb]| format!("{sp:.3}/{mb:.3}")).collect();
    format!("correspondences, s  {} / {}: {}\n", found.semi_procedural, found.blending, pairs.join("  "))
}

fn coverage_text(report: &DatabaseReport) -> String {
    if report.coverage.is_empty() {
        return "\nthin                nowhere\n".into();
    }
    let lines: String = report.coverage.iter().map(|thin| format!("  {}\n", thin.sentence)).collect();
    format!("\nwhere the set is thin\n{lines}\n")
}

fn corners(polygon: &[Vec2]) -> String {
    let corner = |corner: &Vec2| format!("({:.2}, {:.2})", unsigned_zero(corner.x, 2), unsigned_zero(corner.y, 2));
    polygon.iter().map(corner).collect::<Vec<_>>().join(" ")
}

/// Clips as a table.
pub(crate) fn sources_text(surveyed: &[SurveyedSource]) -> String {
    let name = |source: &SourceRecord| format!("{} {}", source.file, source.clip).trim_end().to_owned();
    let width = surveyed.iter().map(|found| name(&found.source).chars().count()).max().unwrap_or(0).max(4);
    let mut text = format!("{:<width$}  speed m/s  turn °/s  strafe m/s  up  m per unit     Hz  gait\n", "clip");
    for SurveyedSource { source, gait } in surveyed {
        text += &format!(
            "{:<width$}  {:9.3}  {:8.1}  {:10.3}  {}  {:10.6}  {:5.1}  {}\n",
            name(source),
            unsigned_zero(source.speed_mps, 3),
            unsigned_zero(source.turn_rate_rad_s.to_degrees(), 1),
            unsigned_zero(source.strafe_mps, 3),
            source.up_axis,
            source.metres_per_unit,
            source.frame_rate_hz,
            gait_text(gait),
        );
    }
    text + &compile_text::remarks(surveyed.iter().map(|found| &found.source))
}

/// "12 steps, 58 % planted"; "stands"; "3 steps, 61 % planted, unsteady".
fn gait_text(gait: &SourceGait) -> String {
    let steps = match gait.step_count() {
        1 => "1 step".to_owned(),
        count => format!("{count} steps"),
    };
    let text = format!("{steps}, {:.0} % planted", 100.0 * gait.planted_share);
    match gait.kind {
        GaitKind::Steps => text,
        GaitKind::Stands => "stands".to_owned(),
        GaitKind::Unsteady => format!("{text}, unsteady"),
    }
}
