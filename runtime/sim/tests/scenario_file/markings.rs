//! Copies of the ground's tables, markings and labels of a scenario file; every mistake is shown at its table.

use fbcrowd_sim::scenario::{MarkingColour, MarkingShape, ScenarioError, read};
use glam::Vec2;

use crate::support::{BLOCK, HEAD, ONE, check_at_table_or_key, scenario, write};

/// Checks that reading fails at the table on a line, or at a key of it, with a message that contains these words.
fn check_rejected(test: &str, text: &str, line: usize, message: &str) {
    match read(&write(test, text)) {
        Err(ScenarioError::Invalid(invalid)) => {
            assert!(invalid.message.contains(message), "{}", invalid.message);
            check_at_table_or_key(&invalid, line);
        }
        other => panic!("{message} expected, found {other:?}"),
    }
}

#[test]
fn copies_repeat_polygons_and_labels() {
    let body = format!(
        "{ONE}[[walkable]]\npolygon_m = [[-9, -9], [9, -9], [9, 9], [-9, 9]]\nlabel = 'Hall'\n\
         [[walkable]]\ncopies_m = [[10, 0], [20, 0]]\npolygon_m = [[-2, -1], [9, -1], [9, 1], [-2, 1]]\n\
         holes_m = [[[4, 0], [5, 0], [5, 0.5]]]\n\
         [[obstacles]]\ncopies_m = [[0, 3], [0, -6]]\npolygon_m = [[0, 0], [2, 0], [2, 2], [0, 2]]\nlabel = ['A', 'B']\n\
         [[obstacles]]\nkind = 'enclosure'\ncopies_m = [[1, 1]]\npolygon_m = [[5, 5], [6, 5], [6, 6]]\n"
    );
    let scenario = scenario("copies", &body);
    let corner_m = |x: f32, y: f32| Vec2::new(x, y);
    assert_eq!(
        scenario.walkable_m.iter().map(|polygon| polygon.outline_m[0]).collect::<Vec<_>>(),
        [corner_m(-9.0, -9.0), corner_m(8.0, -1.0), corner_m(18.0, -1.0)]
    );
    assert_eq!(scenario.walkable_m[2].holes_m, [[[24.0, 0.0], [25.0, 0.0], [25.0, 0.5]].map(Vec2::from)]);
    assert_eq!(
        scenario.obstacles_m.iter().map(|corners_m| corners_m[2]).collect::<Vec<_>>(),
        [corner_m(2.0, 5.0), corner_m(2.0, -4.0)]
    );
    assert_eq!(scenario.enclosures_m, [[[6.0, 6.0], [7.0, 6.0], [7.0, 7.0]].map(Vec2::from)]);
    let labels: Vec<(&str, Vec2)> = scenario.labels.iter().map(|label| (label.text.as_str(), label.at_m)).collect();
    assert_eq!(labels, [("A", corner_m(1.0, 4.0)), ("B", corner_m(1.0, -5.0)), ("Hall", Vec2::ZERO)]);
}

#[test]
fn a_mistake_in_a_copy_is_shown_at_its_table() {
    let far = "[[obstacles]]\npolygon_m = [[2, 2], [3, 2], [3, 3]]\ncopies_m = [[0, 0], [20000, 0]]";
    let on_agent = "[[obstacles]]\ncopies_m = [[9, 9], [0, 0]]\npolygon_m = [[-2, -1], [2, -1], [0, 2]]";
    let labels = "[[obstacles]]\ncopies_m = [[9, 9], [5, 9]]\npolygon_m = [[0, 0], [1, 0], [1, 1]]\nlabel = ['A']";
    let hall = "[[walkable]]\npolygon_m = [[-9, -9], [9, -9], [9, 9]]\nlabel = 'two\\nlines'".replace('\'', "\"");
    let cases = [
        (far, "not within 10 km"),
        (on_agent, "agent 0 starts inside obstacle 2"),
        (labels, "1 labels and 2 copies"),
        (hall.as_str(), "more than one line"),
    ];
    for (table, message) in cases {
        let text = format!("{HEAD}{ONE}[[obstacles]]\npolygon_m = {BLOCK}\n{table}\n");
        let line = if table == on_agent { 3 } else { 6 };
        check_rejected("bad_copies", &text, line, message);
    }
}

#[test]
fn copies_are_counted_before_they_are_made() {
    let many = vec!["[0, 0]"; 200_001].join(", ");
    let corners: Vec<String> = (0..900).map(|corner| format!("[{corner}, {}]", corner * corner % 7)).collect();
    for (table, message) in
        [("obstacles", "200001 obstacles"), ("walkable", "180000900 corners"), ("markings", "200001 markings")]
    {
        let text = format!("{HEAD}{ONE}[[{table}]]\npolygon_m = [{}]\ncopies_m = [{many}]\n", corners.join(", "));
        let text = if table == "markings" { text.replace(&corners.join(", "), "[0, 0], [1, 0], [1, 1]") } else { text };
        check_rejected("many_copies", &text, 4, message);
    }
}

#[test]
fn markings_have_shapes_colours_and_signals() {
    let body = format!(
        "{ONE}[signals.b]\ngreen_s = 1\nred_s = 2\n[signals.a]\ngreen_s = 1\nred_s = 2\n\
         [[markings]]\nrect_m = [0, 0, 2, 1]\n\
         [[markings]]\nline_m = [[0, 0], [4, 0]]\nwidth_m = 3\ndash_m = [0.5, 1]\ncolour = '#102030'\ncopies_m = [[0, 5]]\nlabel = 'Zebra'\n\
         [[markings]]\ncircle_m = [1, 2, 0.5]\nsignal = 'b'\n"
    );
    let scenario = scenario("markings", &body);
    let colours: Vec<MarkingColour> = scenario.markings.iter().map(|marking| marking.colour).collect();
    let white = MarkingColour::Fixed([250, 249, 246]);
    assert_eq!(colours, [white, MarkingColour::Fixed([16, 32, 48]), MarkingColour::Signal(1)]);
    let ends_m = [Vec2::new(0.0, 5.0), Vec2::new(4.0, 5.0)];
    assert_eq!(scenario.markings[1].shape, MarkingShape::Line { ends_m, width_m: 3.0, dash_m: Some([0.5, 1.0]) });
    assert_eq!((scenario.labels[0].text.as_str(), scenario.labels[0].at_m), ("Zebra", Vec2::new(2.0, 5.0)));
}

#[test]
fn broken_markings_are_shown_at_their_table() {
    let line = "line_m = [[0, 0], [4, 0]]";
    for (keys, message) in [
        (line.to_owned(), "a line needs `width_m`"),
        (format!("{line}\nwidth_m = 0.0"), "width_m is 0"),
        (format!("{line}\nwidth_m = 1\ndash_m = [0, 1]"), "dash_m is 0"),
        ("line_m = [[0, 0], [9000, 0]]\nwidth_m = 1\ndash_m = [0.01, 0.01]".into(), "dashes and areas of all"),
        (format!("{line}\nwidth_m = 1\nrect_m = [0, 0, 1, 1]"), "either a line or an area"),
        ("rect_m = [0, 0, 1, 1]\nwidth_m = 1".into(), "belong to `line_m`"),
        ("colour = 'white'".into(), "exactly one of"),
        ("rect_m = [0, 0, 1, 1]\ncolour = 'mauve'".into(), "there is no colour \"mauve\""),
        ("rect_m = [0, 0, 1, 1]\ncolour = '#+1+2+3'".into(), "there is no colour"),
        ("rect_m = [0, 0, 1, 1]\nsignal = 'gone'".into(), "there is no signal `gone`"),
        ("rect_m = [0, 0, 1, 1]\nlabel = ''".into(), "a label has 0 bytes"),
    ] {
        let text = format!("{HEAD}{ONE}[[markings]]\nrect_m = [0, 0, 1, 1]\n[[markings]]\n{keys}\n");
        check_rejected("bad_markings", &text, 6, message);
    }
}
