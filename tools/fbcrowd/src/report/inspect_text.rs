//! The texts of `fbcrowd inspect`: a database or clips as tables.

use fbcrowd_jobs::wording::counted;
use glam::Vec2;
use motiondb::motion::MotionDb;
use motiondb::quality::coverage::CoverageGap;
use motiondb::velocity_sets::velocity_hull::{Construction, VelocityHull};
use motiondb_compiler::survey::{GaitKind, SourceGait, SurveyedSource};

use crate::report::correspondence_table::CorrespondenceTable;
use crate::report::inspect_report::{BlendSpaceReport, Correspondence, DatabaseReport, InspectedExample};
use crate::report::motion::{action_report, extra_joint_report, style_report};
use crate::report::plain_text::{one_line, title, unsigned_zero};
use crate::report::{compile_text, leave_one_out_text};

/// A database as tables.
pub(crate) fn database_text(db: &MotionDb, report: &DatabaseReport) -> String {
    let sections = [
        styles_text(report),
        examples_text(&report.examples),
        compile_text::section(compile_text::ACTIONS, action_report::lines(&report.actions)),
        compile_text::section(
            "findings about actions",
            compile_text::grouped(action_report::findings(&report.actions)),
        ),
        extra_joint_report::text(&report.extra_joints),
        sets_text(&report.velocity_hull),
        blend_space_text(&report.blend_space),
        correspondence_text(report.correspondence.as_ref()),
        report.correspondence_between.as_ref().map(CorrespondenceTable::text).unwrap_or_default(),
        coverage_text(&report.coverage),
        report.leave_one_out.as_ref().map(leave_one_out_text::text).unwrap_or_default(),
        compile_text::source_diagnostics(db.sources.iter()),
    ];
    sections.concat()
}

/// The styles of the database, and which one the tables show; empty where it has none.
fn styles_text(report: &DatabaseReport) -> String {
    if report.styles.is_empty() {
        return String::new();
    }
    let shown =
        if report.style.is_empty() { "clips without style".to_owned() } else { format!("style `{}`", report.style) };
    let styles = compile_text::section(compile_text::STYLES, style_report::lines(&report.styles));
    format!("{}\n{shown}; --style NAME shows another\n\n", styles.trim_start())
}

fn examples_text(examples: &[InspectedExample]) -> String {
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

fn blend_space_text(space: &BlendSpaceReport) -> String {
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
    let examples = format!("m_sp / m_mb         {} / {}\n", found.semi_procedural, found.blending);
    examples + &format!("t_sp/t_mb, s        {}\n", pairs.join("  "))
}

fn coverage_text(coverage: &[CoverageGap]) -> String {
    let none = coverage.is_empty().then_some("none");
    let sentences = none.into_iter().chain(coverage.iter().map(|gap| gap.sentence.as_str()));
    let lines: String = sentences.map(|sentence| format!("  {sentence}\n")).collect();
    format!("\ncoverage gaps\n{lines}")
}

fn corners(polygon: &[Vec2]) -> String {
    let corner = |corner: &Vec2| format!("({:.2}, {:.2})", unsigned_zero(corner.x, 2), unsigned_zero(corner.y, 2));
    polygon.iter().map(corner).collect::<Vec<_>>().join(" ")
}

/// Clips as a table.
pub(crate) fn clips_text(surveyed: &[SurveyedSource]) -> String {
    let names: Vec<String> =
        surveyed.iter().map(|found| one_line(&title(&found.source.file, &found.source.clip))).collect();
    let width = width(names.iter().map(String::as_str), "clip");
    let mut text = format!("{:<width$}  speed m/s  turn °/s  strafe m/s  up  m per unit     Hz  gait\n", "clip");
    for (name, SurveyedSource { source, style, gait }) in names.iter().zip(surveyed) {
        text += &format!(
            "{name:<width$}  {:9.3}  {:8.1}  {:10.3}  {}  {:10.6}  {:5.1}  {}\n",
            unsigned_zero(source.speed_mps, 3),
            unsigned_zero(source.turn_rate_rad_s.to_degrees(), 1),
            unsigned_zero(source.strafe_mps, 3),
            source.up_axis,
            source.metres_per_unit,
            source.frame_rate_hz,
            gait_text(gait) + &if style.is_empty() { String::new() } else { format!(", style {style}") },
        );
    }
    text + &compile_text::source_diagnostics(surveyed.iter().map(|found| &found.source))
}

/// Columns of the widest name, or of the head above the names.
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
