//! Mistakes of plans: files cut off, coordinates in degrees.

mod support;

use support::{read_text, written};

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

/// A plan of 1.5 by 1 that states its coordinate system.
fn located(crs: &str) -> String {
    format!(
        "{{\"type\": \"FeatureCollection\",\n \"crs\": {crs},\n \"features\": [{{\"type\": \"Feature\", \"properties\": {{}}, \"geometry\": \
         {{\"type\": \"Polygon\", \"coordinates\": [[[9, 53], [10.5, 53], [10.5, 54], [9, 54], [9, 53]]]}}}}]}}"
    )
}

/// A coordinate system as most programs name it.
fn named(name: &str) -> String {
    format!("{{\"type\": \"name\", \"properties\": {{\"name\": \"{name}\"}}}}")
}

#[test]
fn a_coordinate_system_in_degrees_is_refused() {
    for name in [
        "urn:ogc:def:crs:OGC:1.3:CRS84",
        "urn:ogc:def:crs:EPSG::4326",
        "EPSG:4326",
        "http://www.opengis.net/def/crs/OGC/1.3/CRS84",
        "http://www.opengis.net/gml/srs/epsg.xml#4326",
        "epsg:4258",
    ] {
        let message = format!(
            "plan.geojson:2: the coordinates are degrees of {name}; project it to metres, for instance to the UTM zone of the \
             place"
        );
        check_error("plan.geojson", &located(&named(name)), &message);
    }
    let old = located("{\"type\": \"EPSG\", \"properties\": {\"code\": 4326}}");
    assert!(read_text("plan.geojson", &old).unwrap_err().to_string().contains("degrees of 4326"));
}

#[test]
fn any_other_coordinate_system_is_noted() {
    let check = |crs: &str, expected: &str| {
        let (_, notes) = written(&read_text("plan.geojson", &located(crs)).unwrap());
        assert_eq!(notes, [expected]);
    };
    check("null", "0: coordinates are taken as metres");
    check(&named("urn:ogc:def:crs:EPSG::25832"), "2: coordinates of urn:ogc:def:crs:EPSG::25832 are taken as metres");
    check("{\"type\": \"link\", \"properties\": {}}", "2: coordinates of a system without name are taken as metres");
    check(
        &named("EPSG:3857"),
        "!2: coordinates of EPSG:3857 are taken as metres; this projection stretches lengths away from the equator",
    );
}

#[test]
fn degrees_are_named_before_all_other_mistakes() {
    for side in [0.4, 0.05, 0.005, 0.0005] {
        // A house in degrees has no area in square metres; the third coordinate is a mistake, too.
        for third in ["", ", 7"] {
            let [west, south, east, north] = [9.99, 53.55, 9.99 + side, 53.55 + side];
            let plan = format!(
                "{{\"type\": \"GeometryCollection\", \"geometries\": [{{\"type\": \"Point\", \"coordinates\": [3, 3]}}, {{\"type\": \"MultiPolygon\", \"coordinates\": \
                 [[[[{west}, {south}{third}], [{east}, {south}], [{east}, {north}], [{west}, {south}]]]]}}]}}"
            );
            check_error(
                "plan.geojson",
                &plan,
                "plan.geojson:1: the plan is less than 0.5 m across, so its coordinates are degrees; project it to metres, for \
                 instance to the UTM zone of the place",
            );
        }
    }
    let empty = read_text("plan.geojson", "{\"type\": \"Point\", \"coordinates\": [3, 3]}").unwrap_err();
    assert!(empty.to_string().contains("there is no polygon"), "{empty}");
}
