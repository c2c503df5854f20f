//! The text of the lines, areas and egress that a scenario measures.

use fbcrowd_sim::measures::{AreaMeasures, EgressMeasures, LEVELS_OF_SERVICE, LineMeasures, Passages, PlaceMeasures};

/// A line for each figure of each measure.
pub(crate) fn text(places: &[PlaceMeasures]) -> String {
    places.iter().flat_map(|place| lines(place).into_iter().map(|line| named(&place.name, &line))).collect()
}

fn named(name: &str, line: &str) -> String {
    format!("{name:<25}{line}\n")
}

fn lines(place: &PlaceMeasures) -> Vec<String> {
    let line = place.line.iter().flat_map(of_line);
    line.chain(place.area.iter().flat_map(of_area)).chain(place.egress.iter().flat_map(of_egress)).collect()
}

fn of_line(line: &LineMeasures) -> Vec<String> {
    let direction = |name: &str, passages: &Passages| {
        let flow = optional(passages.flow_per_s, "1/s");
        let specific = optional(passages.specific_flow_per_m_s, "1/(m s)");
        format!("{} passages {name}, flow {flow}, specific flow {specific}", passages.count)
    };
    vec![direction("forward", &line.forward), direction("backward", &line.backward)]
}

fn of_area(area: &AreaMeasures) -> Vec<String> {
    let levels = LEVELS_OF_SERVICE.iter().zip(area.level_of_service_shares).filter(|(_, share)| *share > 0.0);
    let levels: Vec<String> = levels.map(|((name, _), share)| format!("{name} {:.0} %", 100.0 * share)).collect();
    vec![
        format!(
            "{:.1} agents inside, density {:.2} 1/m², at most {:.2}; Voronoi {:.2}, at most {:.2}",
            area.mean_number,
            area.mean_density_per_m2,
            area.greatest_density_per_m2,
            area.mean_voronoi_density_per_m2,
            area.greatest_voronoi_density_per_m2
        ),
        format!("speed {}, level of service {}", optional(area.mean_speed_mps, "m/s"), levels.join(", ")),
    ]
}

fn of_egress(egress: &EgressMeasures) -> Vec<String> {
    let EgressMeasures { left, remaining, .. } = egress;
    let [p10, p50, p90, p95, last] =
        [egress.percentile_10_s, egress.percentile_50_s, egress.percentile_90_s, egress.percentile_95_s, egress.last_s]
            .map(|time_s| optional(time_s, "s"));
    vec![
        format!("{left} agents left, {remaining} remain"),
        format!("10 % by {p10}, 50 % by {p50}, 90 % by {p90}, 95 % by {p95}, the last at {last}"),
    ]
}

fn optional(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.2} {unit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_and_an_egress_are_told_apart() {
        let passages = |times_s: Vec<f64>| Passages {
            count: times_s.len(),
            flow_per_s: Some(0.5),
            specific_flow_per_m_s: Some(0.25),
            times_s,
        };
        let line = LineMeasures { width_m: 2.0, forward: passages(vec![1.0, 3.0]), backward: passages(vec![]) };
        let place = PlaceMeasures { name: "door".into(), line: Some(line), area: None, egress: None };
        let shown = text(&[place]);
        assert!(
            shown.starts_with(
                "door                     2 passages forward, flow 0.50 1/s, specific flow 0.25 1/(m s)\n"
            )
        );
        assert_eq!(shown.lines().count(), 2);
    }
}
