//! The text of `fbcrowd measure`.

use fbcrowd_sim::measures::{Measures, StateMeasures};

use crate::report::crowd::places_text;

/// One figure a line.
pub(crate) fn text(measures: &Measures) -> String {
    [
        ("agents", agents(measures)),
        ("steps", format!("{} of {:.4} s", measures.steps, measures.dt_s)),
        ("collisions C", collisions(measures)),
        ("bodies", bodies(measures)),
        ("walls", walls(measures)),
        ("acceleration A", acceleration(measures)),
        ("arrived", format!("{} of {}, {} stalled", measures.arrived, measures.agents, measures.stalled)),
        ("mean time to goal", optional(measures.mean_time_to_goal_s, "s")),
        ("path", path(measures)),
        ("planted-foot slide", slide(measures)),
        ("root tracking error", tracking(measures)),
        ("facing off the travel", facing(measures)),
    ]
    .map(|(name, value)| format!("{name:<25}{value}\n"))
    .concat()
        + &extra_joints(&measures.extra_joints)
        + &states(&measures.states)
        + &places_text::text(&measures.places)
}

/// A line where the recording holds joints beside the 22 roles.
fn extra_joints(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [only] => format!("{:<25}1 beside the 22 roles: {only}\n", "joints"),
        [first, .., last] => format!("{:<25}{} beside the 22 roles: {first} … {last}\n", "joints", names.len()),
    }
}

/// A line for each state that any agent was in.
fn states(states: &[StateMeasures]) -> String {
    let visited = states.iter().filter(|state| state.visited > 0);
    let line = |state: &StateMeasures| {
        let time = optional(state.mean_time_s, "s");
        let name = format!("state `{}`", state.state);
        format!("{name:<24} {} agents visited it for {time} in the mean, {} at the end\n", state.visited, state.at_end)
    };
    visited.map(line).collect()
}

fn agents(measures: &Measures) -> String {
    let Measures { agents, born, removed, waiting, source_blocked_s, .. } = measures;
    if born + removed + waiting == 0 {
        return format!("{agents}");
    }
    format!("{agents}, {born} of them born, {removed} removed, {waiting} wait, sources blocked {source_blocked_s:.1} s")
}

fn optional(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.2} {unit}"))
}

fn collisions(measures: &Measures) -> String {
    let apart = optional(measures.minimum_separation_m, "m");
    format!("{:.5}, centres {apart} apart", measures.collision_rate)
}

fn bodies(measures: &Measures) -> String {
    format!(
        "{:.3} mm into each other, {} where they touch ({:.2} % of the time), {:.0} mm at most",
        measures.body_penetration_mm,
        optional(measures.body_penetration_touching_mm, "mm"),
        100.0 * measures.body_touching_share,
        measures.body_penetration_max_mm
    )
}

fn acceleration(measures: &Measures) -> String {
    format!(
        "{:.3} m/s², before arrival {:.3} m/s²",
        measures.mean_acceleration_mps2, measures.mean_acceleration_before_arrival_mps2
    )
}

fn path(measures: &Measures) -> String {
    format!(
        "{}, {:.1} % of the time strafing, {:.1} % stepping back",
        optional(measures.path_over_straight_line, "× the straight line"),
        100.0 * measures.strafing_share,
        100.0 * measures.stepping_back_share
    )
}

fn slide(measures: &Measures) -> String {
    format!(
        "{}, of the examples {}, planted {:.0} %",
        optional(measures.planted_slide_cm_s, "cm/s"),
        optional(measures.examples_slide_cm_s, "cm/s"),
        100.0 * measures.planted_share
    )
}

fn tracking(measures: &Measures) -> String {
    let [mean_mm, worst_mm] = [measures.root_tracking_error_m, measures.root_tracking_worst_m].map(|error| 1e3 * error);
    format!("{mean_mm:.2} mm a step, {worst_mm:.0} mm at most")
}

fn facing(measures: &Measures) -> String {
    let [meant_to, walking] = [measures.heading_error_deg, measures.walking_heading_error_deg];
    format!("{meant_to:.1}°, with side-steps and steps back {walking:.1}°")
}

fn walls(measures: &Measures) -> String {
    format!(
        "discs held {:.2} % of the time, bodies in them {:.2} %, by more than 1 cm {:.2} %, {:.0} mm at most",
        100.0 * measures.wall_disc_share,
        100.0 * measures.wall_body_share,
        100.0 * measures.wall_body_deep_share,
        measures.wall_body_max_mm
    )
}
