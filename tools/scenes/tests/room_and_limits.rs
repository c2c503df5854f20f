//! What a scenario cannot hold is left out with a note, or refused.

mod support;

use support::{read_text, written};

/// A hall of Vadere with a number of agents in an area 3 m by 12 m, of which a wall covers a third.
fn hall(agents: usize) -> String {
    format!(
        r#"{{"release": "2.4", "scenario": {{"topography": {{
        "attributes": {{"bounds": {{"x": 0, "y": 0, "width": 30, "height": 15}}, "boundingBoxWidth": 0.5}},
        "obstacles": [{{"id": 1, "shape": {{"type": "RECTANGLE", "x": 0.5, "y": 9, "width": 9, "height": 4}}}}],
        "targets": [{{"id": 3, "shape": {{"type": "RECTANGLE", "x": 27, "y": 6, "width": 2, "height": 2}}}}],
        "sources": [{{"id": 6, "shape": {{"type": "RECTANGLE", "x": 1, "y": 1, "width": 3, "height": 12}}, "targetIds": [3],
          "spawnNumber": {agents}}}]}}}}}}"#
    )
}

#[test]
fn agents_without_room_are_left_out() {
    let (written, notes) = written(&read_text("hall.scenario", &hall(500)).unwrap());
    let [file] = &written.agent_files[..] else { panic!("{}", written.scenario) };
    let numbers = |line: &str| line.split(' ').map(|word| word.parse().unwrap()).collect::<Vec<f64>>();
    let starts_m: Vec<Vec<f64>> = file.text.lines().filter(|line| !line.starts_with('#')).map(numbers).collect();
    // 24 m² less the discs at the edge of the wall: a disc of 0.2 m takes 0.139 m² at its densest.
    assert!((140..=200).contains(&starts_m.len()), "{}", starts_m.len());
    let expected = format!("!0: {} agents have no room and are left out", 500 - starts_m.len());
    assert!(notes.contains(&expected), "{notes:?}");
    for (index, a) in starts_m.iter().enumerate() {
        assert!((1.0..=4.0).contains(&a[0]) && (1.0..=8.8001).contains(&a[1]), "{a:?}");
        let is_apart = |b: &Vec<f64>| libm::hypot(a[0] - b[0], a[1] - b[1]) >= 0.3998;
        assert!(starts_m[..index].iter().all(is_apart), "{a:?}");
    }
}

#[test]
fn agents_with_room_stay_in_their_area() {
    let (written, notes) = written(&read_text("hall.scenario", &hall(60)).unwrap());
    assert!(written.scenario.contains("area = { rect_m = [1, 1, 4, 13], count = 60 }"), "{}", written.scenario);
    assert!(!notes.iter().any(|note| note.contains("no room")), "{notes:?}");
}

#[test]
fn ground_beyond_the_limits_of_a_scenario_is_refused() {
    let triangles = |count: usize| {
        let triangle = |index: usize| {
            let [x, y] = [(index % 300) * 3, (index / 300) * 3];
            format!("(({x} {y}, {} {y}, {} {}))", x + 2, x + 2, y + 2)
        };
        format!("MULTIPOLYGON ({})", (0..count).map(triangle).collect::<Vec<_>>().join(", "))
    };
    assert!(read_text("plan.wkt", &triangles(66_666)).is_ok());
    let error = read_text("plan.wkt", &triangles(66_667)).unwrap_err().to_string();
    assert!(error.contains("plan.wkt: the walkable polygons have 200001 corners; a scenario takes 200000"), "{error}");
    let drawing = |corners: usize| {
        let corner = |index: usize| {
            let angle_rad = std::f64::consts::TAU * index as f64 / corners as f64;
            format!("10\n{}\n20\n{}\n", 90.0 * libm::cos(angle_rad), 90.0 * libm::sin(angle_rad))
        };
        let corners: String = (0..corners).map(corner).collect();
        format!(
            "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\nW\n70\n1\n{corners}0\nENDSEC\n0\nEOF\n"
        )
    };
    assert!(read_text("plan.dxf", &drawing(1_000)).is_ok());
    let error = read_text("plan.dxf", &drawing(1_001)).unwrap_err().to_string();
    assert!(error.contains("plan.dxf: an obstacle has 1001 corners; a scenario takes 1000"), "{error}");
}
