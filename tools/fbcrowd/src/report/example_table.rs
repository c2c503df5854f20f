//! The recorded examples of a compilation as a table, the worst first: parameters and quality of each. `!` marks
//! figures beyond their threshold ([`motiondb::quality`]).

use motiondb::quality::example_quality::ExampleQuality;

use crate::report::compile_report::{CompileReport, ExampleReport};
use crate::report::plain_text::unsigned_zero;

/// One line of the table.
struct TableRow<'a> {
    example: &'a ExampleReport,
    quality: &'a ExampleQuality,
    /// Names of the figures beyond their threshold.
    findings: Vec<&'static str>,
    is_mirrored: bool,
}

/// A head and a line for each recorded example.
pub(crate) fn lines(report: &CompileReport) -> Vec<String> {
    let mut rows = rows(report);
    let slide_cm_s = |row: &TableRow| row.quality.planted_slide_cm_s;
    rows.sort_by(|a, b| b.findings.len().cmp(&a.findings.len()).then(slide_cm_s(b).total_cmp(&slide_cm_s(a))));
    let width = rows.iter().map(|row| row.example.name.chars().count()).max().unwrap_or(0).max(7);
    let head = format!(
        "{:<width$}  window s       m/s    °/s  aside m/s  slide cm/s  planted %  seam  jerk  sinks mm  knee °  leg",
        "example"
    );
    std::iter::once(head).chain(rows.iter().map(|row| row.line(width))).collect()
}

fn rows(report: &CompileReport) -> Vec<TableRow<'_>> {
    let mut rows = Vec::new();
    for used in &report.used {
        for example in used.examples.iter().filter(|example| !example.mirrored) {
            let Some(quality) = report.quality.iter().find(|quality| quality.example == example.name) else { continue };
            let is_its_mirror = |other: &&ExampleReport| other.mirrored && other.window_s == example.window_s;
            let findings = report.findings.iter().filter(|finding| finding.example == example.name);
            rows.push(TableRow {
                example,
                quality,
                findings: findings.map(|finding| finding.measure).collect(),
                is_mirrored: used.examples.iter().any(|other| is_its_mirror(&other)),
            });
        }
    }
    rows
}

impl TableRow<'_> {
    /// The name in `width` columns, window and parameters, figures.
    fn line(&self, width: usize) -> String {
        let (example, quality) = (self.example, self.quality);
        let mark = |measure: &str| if self.findings.contains(&measure) { '!' } else { ' ' };
        let parameters = format!(
            "{:<width$}  {:>4.1} – {:<5.1}  {:6.2}  {:5.0}  {:9.2}",
            example.name,
            example.window_s[0],
            example.window_s[1],
            unsigned_zero(example.speed_mps, 2),
            unsigned_zero(example.turn_rate_rad_s.to_degrees(), 0),
            unsigned_zero(example.strafe_mps, 2),
        );
        let figures = format!(
            "{:9.1}{}  {:8.0}{}  {:4.1}{} {:4.1}{} {:8.0}{}  {:5.0}{}  {:4.2}{}",
            quality.planted_slide_cm_s,
            mark("planted_slide_cm_s"),
            100.0 * quality.planted_share,
            mark("planted_share"),
            quality.seam_angle_ratio,
            mark("seam_angle_ratio"),
            quality.seam_velocity_ratio,
            mark("seam_velocity_ratio"),
            quality.penetration_mm,
            mark("penetration_mm"),
            quality.knee_flexion_min_deg,
            mark("knee_flexion_min_deg"),
            quality.leg_extension_max,
            mark("leg_extension_max"),
        );
        let joint = self.findings.contains(&"range_excess_deg").then(|| format!(" {}!", quality.range_excess_joint));
        let mirrored = if self.is_mirrored { " and mirrored" } else { "" };
        let base_walk = if example.base_walk { "; base walk (m_sp)" } else { "" };
        format!("{parameters}  {figures}{}{mirrored}{base_walk}", joint.unwrap_or_default()).trim_end().to_owned()
    }
}
