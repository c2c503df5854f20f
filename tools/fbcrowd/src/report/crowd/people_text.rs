//! The text of `fbcrowd measure --people`: the measures in groups, a figure a line.

use fbcrowd_sim::measures::people::{PeopleMeasures, PhaseOrder, SwingClass};

/// The groups of the measures, each below its title.
pub(crate) fn text(people: &PeopleMeasures) -> String {
    let groups = [
        ("individuals", individuals(people)),
        ("steps", steps(people)),
        ("legs", legs(people)),
        ("conduct", conduct(people)),
    ];
    let line = |(name, value): &(String, String)| format!("  {name:<34}{value}\n");
    let group = |(title, lines): &(&str, Vec<(String, String)>)| {
        format!("{title}\n{}", lines.iter().map(line).collect::<String>())
    };
    format!("{:<36}{:.1} agent-minutes\n", "before arrival", people.agent_minutes)
        + &groups.iter().map(group).collect::<String>()
}

fn individuals(people: &PeopleMeasures) -> Vec<(String, String)> {
    let PeopleMeasures { first_steps, cadence, standing, .. } = people;
    let order = |order: &PhaseOrder| {
        let value =
            format!("{} of {} agents, {} at random", number(order.order, ""), order.agents, number(order.random, ""));
        (format!("phase order R at {} s", order.time_s), value)
    };
    let mut lines: Vec<(String, String)> = people.phase_order.iter().map(order).collect();
    lines.push(line(
        "first steps",
        format!(
            "{} left, {} right, {} with one foot within 10 ms, times spread over {}",
            first_steps.left,
            first_steps.right,
            first_steps.together,
            number(first_steps.spread_s, " s")
        ),
    ));
    lines.push(line(
        "cadence",
        format!(
            "{}, {} of variation at equal speed",
            number(cadence.mean_steps_per_min, " steps/min"),
            number(cadence.variation.map(|share| 100.0 * share), " %")
        ),
    ));
    lines.push(line(
        "standing",
        format!(
            "upper bodies {} apart, sway {} in 6 s, repeated after {}",
            number(standing.likeness_deg, "°"),
            number(standing.sway_mm, " mm"),
            number(standing.repeat_s, " s")
        ),
    ));
    lines
}

fn steps(people: &PeopleMeasures) -> Vec<(String, String)> {
    let PeopleMeasures { starts, stops, .. } = people;
    let swing = |class: &SwingClass| {
        let [from_cm, to_cm] = class.lengths_m.map(|length_m| 100.0 * length_m);
        let [clearance, duration] = [number(class.clearance_cm, " cm"), number(class.duration_s, " s")];
        (
            format!("swings of {from_cm:.0} to {to_cm:.0} cm"),
            format!("{clearance} high, {duration}, of {}", class.count),
        )
    };
    let mut lines: Vec<(String, String)> = people.swings.iter().map(swing).collect();
    lines.push(line(
        "starts",
        format!(
            "{} to 90 % of the speed, {}, peak {}, lean {}, of {}, {}",
            number(starts.duration_s, " s"),
            number(starts.acceleration_mps2, " m/s²"),
            number(starts.peak_mps2, " m/s²"),
            number(starts.lean_deg_per_mps2, "° per m/s²"),
            starts.count,
            number(starts.recorded_share.map(|share| 100.0 * share), " % recorded")
        ),
    ));
    lines.push(line(
        "stops",
        format!(
            "{}, peak {}, creep {} at {}, closing step {}, of {}",
            number(stops.duration_s, " s"),
            number(stops.peak_mps2, " m/s²"),
            number(stops.creep_s, " s"),
            number(stops.creep_mps, " m/s"),
            number(stops.closing_step_s, " s"),
            stops.count
        ),
    ));
    lines
}

fn legs(people: &PeopleMeasures) -> Vec<(String, String)> {
    let PeopleMeasures { pelvis_lurches, shank_gaps, foot_pivots, slide, .. } = people;
    vec![
        line(
            "lurches of the pelvis",
            format!(
                "{}, at most {:.1} m/s²",
                number(pelvis_lurches.per_minute, " per walking minute"),
                pelvis_lurches.greatest_mps2
            ),
        ),
        line(
            "shanks too near",
            format!(
                "{}, axes at least {} of their radii apart",
                number(shank_gaps.per_minute, " per agent-minute"),
                number(shank_gaps.least_over_radii, "")
            ),
        ),
        line(
            "pivot of flat feet in turns",
            format!(
                "{} at {}, of {} contacts",
                number(foot_pivots.pivot_deg, "°"),
                number(foot_pivots.turn_rate_deg_s, " °/s"),
                foot_pivots.contacts
            ),
        ),
        line(
            "planted-foot slide",
            format!(
                "{} at the soles, {} at the joints, planted {:.0} %",
                number(slide.at_soles_cm_s, " cm/s"),
                number(slide.at_joints_cm_s, " cm/s"),
                100.0 * slide.planted_share
            ),
        ),
    ]
}

fn conduct(people: &PeopleMeasures) -> Vec<(String, String)> {
    let PeopleMeasures { turning, queues, upper_bodies, .. } = people;
    vec![
        line(
            "turns per agent-minute",
            format!(
                "{} sudden, {} to and fro, {} of the head too fast",
                number(turning.sudden_per_minute, ""),
                number(turning.to_and_fro_per_minute, ""),
                number(turning.fast_head_per_minute, "")
            ),
        ),
        line(
            "queues",
            format!(
                "{:.1} agent-minutes, {} of them backward",
                queues.minutes,
                number(queues.backward_share.map(|share| 100.0 * share), " %")
            ),
        ),
        line(
            "head and wrists in walks",
            format!(
                "roll {}, pitch {}, wrists {}",
                number(upper_bodies.head_roll_deg, "°"),
                number(upper_bodies.head_pitch_deg, "°"),
                number(upper_bodies.wrist_acceleration_rad_s2, " rad/s²")
            ),
        ),
    ]
}

fn line(name: &str, value: String) -> (String, String) {
    (name.to_owned(), value)
}

fn number(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.2}{unit}"))
}
