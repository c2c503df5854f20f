//! Claims about obstacles and walkable ground.

use std::fs;

use fbcrowd_sim::scenario::read;
use glam::Vec2;

use crate::support::{HEAD, ONE, check_rejected, scenario, write};

#[test]
fn obstacles_run_counter_clockwise_in_either_order() {
    let obstacles =
        |corners: &str| scenario("winding", &format!("{ONE}[[obstacles]]\npolygon_m = {corners}")).obstacles_m;
    let counter_clockwise = obstacles("[[2, 2], [3, 2], [3, 3]]");
    assert_eq!(counter_clockwise, [[Vec2::new(2.0, 2.0), Vec2::new(3.0, 2.0), Vec2::new(3.0, 3.0)]]);
    assert_eq!(obstacles("[[3, 3], [3, 2], [2, 2]]"), counter_clockwise);
}

#[test]
fn obstacles_must_be_simple_polygons() {
    let check = |test: &str, polygon: &str, message: &str| {
        let obstacle = format!("{{ polygon_m = {polygon} }}");
        check_rejected(test, &format!("{HEAD}{ONE}obstacles = [{obstacle}]"), &obstacle, message);
    };
    check("two_corners", "[[8, 8], [9, 9]]", "obstacle 0 has 2 corners");
    check("bow_tie", "[[8, 8], [9, 9], [9, 8], [8, 9]]", "obstacle 0 crosses or touches itself at [8.50, 8.50]");
    check("repeated", "[[8, 8], [9, 8], [9, 9], [8, 8]]", "obstacle 0 crosses or touches itself at [8.00, 8.00]");
    check("sliver", "[[8, 8], [9, 8], [8.5, 8.00001]]", "obstacle 0 has no area");
}

#[test]
fn walkable_ground_is_read_from_tables_and_wkt() {
    let ground =
        "[[walkable]]\npolygon_m = [[-2, -2], [9, -2], [9, 2], [-2, 2]]\nholes_m = [[[2, -1], [3, -1], [3, 1]]]\n";
    let enclosure = "[[obstacles]]\nkind = \"enclosure\"\npolygon_m = [[7, 1], [8, 1], [8, 1.5]]\n";
    let inline = scenario("ground", &format!("{ONE}{ground}{enclosure}"));
    assert_eq!((inline.walkable_m.len(), inline.obstacles_m.len(), inline.enclosures_m.len()), (1, 0, 1));
    let path = write("wkt", &format!("{HEAD}{ONE}[[walkable]]\nfile = \"a.wkt\"\n"));
    let wkt = "POLYGON ((-2 -2, 9 -2, 9 2, -2 2, -2 -2), (2 -1, 3 -1, 3 1, 2 -1))";
    fs::write(path.with_file_name("a.wkt"), wkt).unwrap();
    assert_eq!(read(&path).unwrap().0.walkable_m, inline.walkable_m);
}

#[test]
fn mistakes_of_the_ground_are_shown_at_their_table() {
    let walkable = |polygon: &str| format!("{HEAD}{ONE}[[walkable]]\npolygon_m = {polygon}\n");
    let part = "[[walkable]]";
    check_rejected(
        "bow",
        &walkable("[[-9, -9], [9, 9], [9, -9], [-9, 9]]"),
        part,
        "crosses or touches itself at [0.00, 0.00]",
    );
    check_rejected("far", &walkable("[[-9, -9], [1e9, -9], [9, 9]]"), part, "not within 10 km");
    check_rejected("short", &walkable("[[-9, -9], [9, 9]]"), part, "has 2 corners");
    check_rejected("empty", &format!("{HEAD}{ONE}[[walkable]]\nholes_m = []\n"), part, "either `polygon_m` or `file`");
    let file = format!("{HEAD}{ONE}[[walkable]]\nfile = \"none.wkt\"\n");
    check_rejected("none", &file, "\"none.wkt\"", "cannot be read");
}
