//! The example of agents in a converted plan: without comment signs, all its starts and goals have room on the ground.

mod support;

use support::{read_text, written};
use toml::Value;

type Point = [f64; 2];

/// Greatest radius of a disc at a point of the ground, m: the distance to the nearest ring, negative off the ground.
fn room_m(rings_m: &[Vec<Point>], at_m: Point) -> f64 {
    let (mut crossings, mut nearest_m) = (0, f64::INFINITY);
    for ring_m in rings_m {
        for (index, a) in ring_m.iter().enumerate() {
            let b = ring_m[(index + 1) % ring_m.len()];
            let along = [b[0] - a[0], b[1] - a[1]];
            let to = [at_m[0] - a[0], at_m[1] - a[1]];
            let part = (along[0] * to[0] + along[1] * to[1]) / (along[0] * along[0] + along[1] * along[1]);
            let gap = [0, 1].map(|axis| to[axis] - part.clamp(0.0, 1.0) * along[axis]);
            nearest_m = nearest_m.min((gap[0] * gap[0] + gap[1] * gap[1]).sqrt());
            let is_beside = (a[1] > at_m[1]) != (b[1] > at_m[1]);
            crossings += usize::from(is_beside && to[0] < to[1] * along[0] / along[1]);
        }
    }
    if crossings % 2 == 1 { nearest_m } else { -nearest_m }
}

fn numbers(value: &Value) -> Vec<f64> {
    let number = |item: &Value| item.as_float().or(item.as_integer().map(|whole| whole as f64)).unwrap();
    value.as_array().unwrap().iter().map(number).collect()
}

/// Checks the example of a ground of rings: the number of agents in a row, and room along the whole walk.
fn check(name: &str, text: &str, rows: i64, rings_m: &[Vec<Point>]) {
    let (written, _) = written(&read_text(name, text).unwrap());
    let begin = written.scenario.find("# [[agents]]").unwrap_or_else(|| panic!("{}", written.scenario));
    let lines = written.scenario[begin..].lines().take(3).map(|line| line.trim_start_matches("# "));
    let table: toml::Table = toml::from_str(&lines.collect::<Vec<_>>().join("\n")).unwrap();
    let (grid, offset_m) = (&table["agents"][0]["grid"], numbers(&table["agents"][0]["goal_offset_m"]));
    assert_eq!(grid["rows"].as_integer(), Some(rows), "{}", written.scenario);
    let centre_m = numbers(&grid["centre_m"]);
    for step in 0..=20 {
        let part = f64::from(step) / 20.0;
        for index in 0..rows * rows {
            let of_grid = [index % rows, index / rows].map(|line| line as f64 - 0.5 * (rows as f64 - 1.0));
            let at_m = [0, 1].map(|axis| centre_m[axis] + part * offset_m[axis] + of_grid[axis]);
            assert!(room_m(rings_m, at_m) > 0.3, "{at_m:?} has no room\n{}", written.scenario);
        }
    }
}

fn rect(left: f64, low: f64, right: f64, high: f64) -> Vec<Point> {
    vec![[left, low], [right, low], [right, high], [left, high]]
}

fn wkt(rings_m: &[Vec<Point>]) -> String {
    let ring = |ring_m: &Vec<Point>| {
        let corners: Vec<String> = ring_m.iter().map(|[x, y]| format!("{x} {y}")).collect();
        format!("({})", corners.join(", "))
    };
    format!("POLYGON ({})", rings_m.iter().map(ring).collect::<Vec<_>>().join(", "))
}

#[test]
fn the_example_stands_on_the_ground() {
    // A hall with a pillar in its middle, far from the origin.
    let hall = [rect(700.0, 300.0, 730.0, 320.0), rect(710.0, 305.0, 720.0, 315.0)];
    check("plan.wkt", &wkt(&hall), 3, &hall);
    // An L of corridors 1.5 m wide, 100 m long; its box is empty.
    let corridors = [vec![[0.0, 0.0], [100.0, 0.0], [100.0, 1.5], [1.5, 1.5], [1.5, 80.0], [0.0, 80.0]]];
    check("plan.wkt", &wkt(&corridors), 1, &corridors);
    // A slanted ring around a courtyard.
    let ring = [
        vec![[0.0, 0.0], [20.0, 10.0], [10.0, 30.0], [-10.0, 20.0]],
        vec![[0.0, 4.0], [16.0, 12.0], [10.0, 24.0], [-6.0, 18.0]],
    ];
    check("plan.wkt", &wkt(&ring), 3, &ring);
}

#[test]
fn the_example_stands_in_the_largest_polygon() {
    let large = [rect(50.0, 0.0, 62.0, 9.0)];
    let text = format!("GEOMETRYCOLLECTION ({}, {})", wkt(&[rect(0.0, 0.0, 2.0, 2.0)]), wkt(&large));
    check("plan.wkt", &text, 3, &large);
}

#[test]
fn the_example_keeps_off_the_obstacles_of_a_drawing() {
    let polyline = |layer: &str, ring_m: &[Point]| {
        let corners: String = ring_m.iter().map(|[x, y]| format!("10\n{x}\n20\n{y}\n")).collect();
        format!("0\nLWPOLYLINE\n8\n{layer}\n70\n1\n{corners}")
    };
    let head = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
    let (room, wall) = (rect(0.0, 0.0, 20.0, 12.0), rect(8.0, 1.0, 11.0, 10.0));
    let rings = [room.clone(), wall.clone()];
    let text = format!("{head}{}{}0\nENDSEC\n0\nEOF\n", polyline("walkable", &room), polyline("walls", &wall));
    check("plan.dxf", &text, 3, &rings);
    // Without walkable ground, all ground but the walls.
    let world = [rect(-99.0, -99.0, 99.0, 99.0), wall.clone()];
    let text = format!("{head}{}0\nENDSEC\n0\nEOF\n", polyline("walls", &wall));
    check("plan.dxf", &text, 3, &world);
}

#[test]
fn ground_without_room_has_no_example() {
    let (written, _) = written(&read_text("plan.wkt", &wkt(&[rect(0.0, 0.0, 0.6, 9.0)])).unwrap());
    assert!(written.scenario.contains("no example has room on its ground"), "{}", written.scenario);
}
