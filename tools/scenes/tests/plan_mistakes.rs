//! Mistakes of plans: files cut off, coordinates in degrees.

mod support;

use support::read_text;

/// The error's text, from the name of the file on.
fn check_error(name: &str, text: &str, expected: &str) {
    let error = read_text(name, text).expect_err(text).to_string();
    assert_eq!(&error[error.find(name).unwrap_or(0)..], expected);
}

/// A drawing of one closed polyline of four corners, which states a number of vertices.
fn square(stated: usize) -> String {
    format!(
        "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\nwalls\n90\n{stated}\n70\n1\n\
         10\n0\n20\n0\n10\n4\n20\n0\n10\n4\n20\n4\n10\n0\n20\n4\n0\nENDSEC\n0\nEOF\n"
    )
}

#[test]
fn a_drawing_that_ends_early_is_refused() {
    let text = square(4);
    let lines: Vec<&str> = text.lines().collect();
    assert!(read_text("plan.dxf", &text).is_ok());
    assert!(read_text("plan.dxf", &format!("{text}\n\n")).is_ok());
    for count in 1..lines.len() {
        let error = read_text("plan.dxf", &(lines[..count].join("\n") + "\n")).expect_err("a part of a drawing");
        let place = format!("plan.dxf:{count}: the drawing ends early, without EOF; export it anew");
        assert!(error.to_string().contains(&place), "{count}: {error}");
    }
    check_error("plan.dxf", "", "plan.dxf:1: the drawing ends early, without EOF; export it anew");
}

#[test]
fn a_polyline_with_another_number_of_vertices_is_refused() {
    let message = "plan.dxf:16: the polyline states 5 vertices (group 90) and has 4; export the drawing anew";
    check_error("plan.dxf", &square(5), message);
}
