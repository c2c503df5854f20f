//! What stands beside a velocity space: what its colours mean, and the step in numbers.

use fbcrowd_sim::planning::orca::{HalfPlane, HalfPlaneSource};
use fbcrowd_sim::planning::{Planner, VelocitySet};
use fbcrowd_sim::synthesis::Mode;
use glam::Vec2;

use crate::constraints::overlay_constraints::Planned;
use crate::constraints::velocity_panel::{ADAPTED, PLANNED, PREFERRED, STANCE, WALKED, name};
use crate::plots::chart::axis::number;
use crate::plots::chart::mark::Mark;
use crate::plots::chart::plot::Figure;
use crate::plots::database::velocity_space::{HOLDING, SHARP_TURN, TURNING};
use crate::raster::palette::{INK, OBSTACLE_RIM, Rgb, line_colour};
use crate::raster::text::Anchor;

/// Distance of lines, and between legend and numbers, in the panel's units.
const LINE_STEP: f32 = 20.0;
const PART_STEP: f32 = 14.0;
/// Left of a legend's words, for their marks, likewise.
const MARK_WIDTH: f32 = 9.0;

/// A line of the legend.
type Entry = (Mark, Rgb, &'static str);

/// Writes legend and numbers below each other from the upper left corner on, within a width.
pub(crate) fn draw(figure: &mut Figure, planned: &Planned, [left, top, width]: [f32; 3], unit_px: f32) {
    let mut baseline = top + 0.5 * LINE_STEP * unit_px;
    for entry in legend(planned) {
        figure.legend(Vec2::new(left + MARK_WIDTH * unit_px, baseline), &[entry]);
        baseline += LINE_STEP * unit_px;
    }
    baseline += PART_STEP * unit_px;
    for (what, value) in numbers(planned) {
        figure.text(what, Vec2::new(left, baseline), Anchor::Left);
        let room_px = width - figure.width_px(what) - LINE_STEP * unit_px;
        for line in wrapped(&value, |line| figure.width_px(line) <= room_px) {
            figure.text(&line, Vec2::new(left + width, baseline), Anchor::Right);
            baseline += LINE_STEP * unit_px;
        }
    }
}

/// Words in as many lines as it takes, none without a word.
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

/// Only what the planner knows.
fn legend(planned: &Planned) -> Vec<Entry> {
    let mut entries = vec![(Mark::Bar, PREFERRED, "v_pref, wanted")];
    if planned.planner() == Planner::Mcn {
        entries.push((Mark::Bar, ADAPTED, "v_op, adapted"));
    }
    entries.push((Mark::Bar, PLANNED, "v, planned"));
    entries.extend([(Mark::Ring, WALKED, "walked before"), (Mark::Disc, WALKED, "walked then")]);
    entries.push((Mark::Dashes, INK, "facing planned"));
    entries.extend([(Mark::Bar, TURNING, "turning set"), (Mark::Bar, HOLDING, "holding set")]);
    entries.push((Mark::Bar, SHARP_TURN, "sharp-turn edges"));
    if planned.planner() == Planner::Mcn {
        entries.push((Mark::Bar, STANCE, "stance foot"));
    }
    let other = line_colour(planned.agent + 1);
    match planned.planner() {
        Planner::SocialForce => {
            entries.push((Mark::Bar, OBSTACLE_RIM, "push of a wall"));
            entries.push((Mark::Bar, other, "push of an agent, its colour"));
        }
        Planner::Mcn | Planner::Orca => {
            if planned.planner() == Planner::Orca {
                entries.push((Mark::Ring, INK, "greatest speed"));
            }
            entries.push((Mark::Bar, OBSTACLE_RIM, "wall"));
            entries.push((Mark::Bar, other, "agent, in its colour"));
            entries.push((Mark::Dashes, INK, "had to yield"));
        }
    }
    entries
}

fn numbers(planned: &Planned) -> Vec<(&'static str, String)> {
    let Planned { step, agent, reasons, .. } = planned;
    let (after, world) = (&step.after[*agent], step.world());
    let time_s = reasons.plan.time_to_collision_s;
    let speed = |velocity_mps: Vec2| format!("{:.2} m/s", velocity_mps.length());
    let mut lines = vec![
        ("planner", planner(planned.planner()).to_owned()),
        ("synthesis", mode(after.mode).to_owned()),
        ("next collision in", if time_s.is_finite() { format!("{time_s:.2} s") } else { "none".to_owned() }),
        ("density ahead", format!("{:.2} /m", reasons.plan.density)),
        ("wanted", speed(world.preferred_mps[*agent])),
    ];
    if planned.planner() == Planner::Mcn {
        lines.push(("adapted", speed(reasons.adapted_mps)));
    }
    lines.push(("planned", speed(reasons.plan.velocity_mps)));
    lines.push(("walked", speed(step.actual_mps(*agent))));
    let degrees = [world.facings_rad[*agent], reasons.plan.facing_rad].map(|angle| number(angle.to_degrees(), 0));
    lines.push(("facing, planned", format!("{}°, {}°", degrees[0], degrees[1])));
    if planned.planner() == Planner::Mcn {
        let params = &step.header().scenario.params.planner;
        let spent = |spent_s: f32, limit_s: f32| format!("{spent_s:.2} of {limit_s:.1} s");
        lines.push(("set in force", set(reasons.plan.set).to_owned()));
        lines.push(("strafing", spent(reasons.plan.strafing_s, params.strafing_limit_s)));
        lines.push(("stepping back", spent(reasons.plan.stepping_back_s, params.stepping_back_limit_s)));
    }
    if planned.planner() != Planner::SocialForce {
        lines.push(("bound by", sources(planned, |half_plane| reasons.binds(half_plane))));
        lines.push(("yielded", sources(planned, |half_plane| reasons.has_yielded(half_plane))));
    }
    lines
}

/// The sources of some half-planes, by rank, each once; agents come last.
fn sources(planned: &Planned, is_one: impl Fn(&HalfPlane) -> bool) -> String {
    let (mut names, mut agents): (Vec<String>, Vec<String>) = Default::default();
    for half_plane in planned.reasons.half_planes.iter().filter(|half_plane| is_one(half_plane)) {
        let name = name(half_plane.source);
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

fn planner(planner: Planner) -> &'static str {
    match planner {
        Planner::Mcn => "MCN",
        Planner::Orca => "ORCA",
        Planner::SocialForce => "social forces",
    }
}

fn mode(mode: Mode) -> &'static str {
    match mode {
        Mode::Blending => "motion blending",
        Mode::SemiProcedural => "semi-procedural",
    }
}

fn set(set: VelocitySet) -> &'static str {
    match set {
        VelocitySet::Turning => "turning",
        VelocitySet::Holding => "holding",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_values_break_between_words_and_keep_them_all() {
        let lines = wrapped("wall, agents 5, 12, 7", |line| line.len() <= 9);
        assert_eq!(lines, ["wall,", "agents 5,", "12, 7"]);
    }
}
