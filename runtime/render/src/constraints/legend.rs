//! The column beside a velocity space: the legend of its colours, and the step in numbers.

use fbcrowd_sim::planning::orca::{HalfPlane, HalfPlaneSource};
use fbcrowd_sim::planning::{Planner, VelocitySet};
use fbcrowd_sim::synthesis::Mode;
use glam::Vec2;

use crate::constraints::constraint_style::{ACTUAL, ADAPTED, PLANNED, PREFERRED, STANCE, source_name};
use crate::constraints::explained_step::ExplainedStep;
use crate::plots::chart::axis::number;
use crate::plots::chart::figure::{LegendEntry, PlotFigure};
use crate::plots::chart::mark::PlotMark;
use crate::raster::palette::{HOLDING_SET, INK, OBSTACLE_RIM, SHARP_TURN_EDGES, TURNING_SET, line_colour};
use crate::raster::text::TextAnchor;

/// Distance of lines, panel units.
const LINE_STEP: f32 = 20.0;
/// Distance between legend and numbers, beyond that of lines, panel units.
const PART_STEP: f32 = 14.0;
/// Room for an entry's mark, to the left of its text, panel units.
const MARK_WIDTH: f32 = 9.0;

/// Draws legend and numbers, one below the other, from the upper left corner on; a panel unit is `unit_px` pixels.
pub(crate) fn draw(figure: &mut PlotFigure, explained: &ExplainedStep, [left, top, width]: [f32; 3], unit_px: f32) {
    let mut baseline = top + 0.5 * LINE_STEP * unit_px;
    for entry in entries(explained) {
        figure.legend(Vec2::new(left + MARK_WIDTH * unit_px, baseline), &[entry]);
        baseline += LINE_STEP * unit_px;
    }
    baseline += PART_STEP * unit_px;
    for (quantity, value) in numbers(explained) {
        figure.text(quantity, Vec2::new(left, baseline), TextAnchor::Left);
        let room_px = width - figure.width_px(quantity) - LINE_STEP * unit_px;
        for line in wrapped(&value, |line| figure.width_px(line) <= room_px) {
            figure.text(&line, Vec2::new(left + width, baseline), TextAnchor::Right);
            baseline += LINE_STEP * unit_px;
        }
    }
}

/// The lines of a text that is broken between words. A word that does not fit has a line of its own.
fn wrapped(text: &str, fits: impl Fn(&str) -> bool) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if fits(&format!("{line} {word}")) => *line = format!("{line} {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The legend: only what the step's planner uses.
fn entries(explained: &ExplainedStep) -> Vec<LegendEntry<'static>> {
    let planner = explained.planner();
    let mut entries = vec![(PlotMark::Bar, PREFERRED, "v_pref, preferred")];
    if planner == Planner::Mcn {
        entries.push((PlotMark::Bar, ADAPTED, "v_op, adapted"));
    }
    entries.push((PlotMark::Bar, PLANNED, "v_i, planned"));
    entries.extend([(PlotMark::Ring, ACTUAL, "actual before"), (PlotMark::Disc, ACTUAL, "actual after")]);
    entries.push((PlotMark::Dashes, INK, "planned facing"));
    entries.extend([(PlotMark::Bar, TURNING_SET, "turning set"), (PlotMark::Bar, HOLDING_SET, "holding set")]);
    entries.push((PlotMark::Bar, SHARP_TURN_EDGES, "sharp-turn edges"));
    if planner == Planner::Mcn {
        entries.push((PlotMark::Bar, STANCE, "stance foot"));
    }
    if planner == Planner::Orca {
        entries.push((PlotMark::Ring, INK, "greatest speed"));
    }
    entries.push((PlotMark::Ring, OBSTACLE_RIM, "disc that walls hold"));
    let other = line_colour(explained.id(explained.agent).index() + 1);
    if planner == Planner::SocialForce {
        entries.push((PlotMark::Bar, OBSTACLE_RIM, "force of a wall"));
        entries.push((PlotMark::Bar, other, "force of an agent, its colour"));
    } else {
        entries.push((PlotMark::Bar, OBSTACLE_RIM, "wall"));
        entries.push((PlotMark::Bar, other, "agent, in its colour"));
        entries.push((PlotMark::Dashes, INK, "had to yield"));
    }
    entries
}

/// Quantities of the step, with their values.
fn numbers(explained: &ExplainedStep) -> Vec<(&'static str, String)> {
    let ExplainedStep { step, agent, explanation, .. } = explained;
    let (plan, planner, world) = (&explanation.plan, explained.planner(), step.world());
    let time_s = plan.time_to_collision_s;
    let speed = |velocity_mps: Vec2| format!("{:.2} m/s", velocity_mps.length());
    let mut lines = vec![
        ("planner", planner_name(planner).to_owned()),
        ("synthesis", mode_name(step.after[*agent].mode).to_owned()),
        ("time to collision", if time_s.is_finite() { format!("{time_s:.2} s") } else { "none".to_owned() }),
        ("density ahead", format!("{:.2} /m", plan.density)),
        ("preferred", speed(world.preferred_mps[*agent])),
    ];
    if planner == Planner::Mcn {
        lines.push(("adapted", speed(explanation.adapted_mps)));
    }
    lines.push(("planned", speed(plan.velocity_mps)));
    lines.push(("actual", speed(step.actual_mps(*agent))));
    let degrees = [world.facings_rad[*agent], plan.facing_rad].map(|angle| number(angle.to_degrees(), 0));
    lines.push(("facing, planned", format!("{}°, {}°", degrees[0], degrees[1])));
    if planner == Planner::Mcn {
        let params = &step.header().scenario.params.planner;
        let spent = |spent_s: f32, limit_s: f32| format!("{spent_s:.2} of {limit_s:.1} s");
        lines.push(("set in force", set_name(plan.set).to_owned()));
        lines.push(("strafing", spent(plan.strafing_s, params.strafing_limit_s)));
        lines.push(("stepping back", spent(plan.stepping_back_s, params.stepping_back_limit_s)));
    }
    if planner != Planner::SocialForce {
        lines.push(("bound by", source_names(explained, |half_plane| explanation.binds(half_plane))));
        lines.push(("yielded", source_names(explained, |half_plane| explanation.has_yielded(half_plane))));
    }
    lines
}

/// Names of the sources of the selected half-planes, by rank, each once; agents come last.
fn source_names(explained: &ExplainedStep, is_selected: impl Fn(&HalfPlane) -> bool) -> String {
    let (mut names, mut agents): (Vec<String>, Vec<String>) = Default::default();
    for half_plane in explained.explanation.half_planes.iter().filter(|half_plane| is_selected(half_plane)) {
        let name = source_name(half_plane.source);
        match half_plane.source {
            HalfPlaneSource::Agent(_) => agents.push(name),
            _ if names.contains(&name) => (),
            _ => names.push(name),
        }
    }
    match agents.len() {
        0 => (),
        1 => names.push(format!("agent {}", agents[0])),
        _ => names.push(format!("agents {}", agents.join(", "))),
    }
    if names.is_empty() { "–".to_owned() } else { names.join(", ") }
}

fn planner_name(planner: Planner) -> &'static str {
    match planner {
        Planner::Mcn => "MCN",
        Planner::Orca => "ORCA",
        Planner::SocialForce => "social forces",
    }
}

fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Blending => "motion blending",
        Mode::SemiProcedural => "semi-procedural",
        Mode::Transition => "recorded transition",
    }
}

fn set_name(set: VelocitySet) -> &'static str {
    match set {
        VelocitySet::Turning => "turning",
        VelocitySet::Holding => "holding",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_values_break_between_words() {
        let lines = wrapped("wall, agents 5, 12, 7", |line| line.len() <= 9);
        assert_eq!(lines, ["wall,", "agents 5,", "12, 7"]);
    }
}
