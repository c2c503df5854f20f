//! Plans and scenarios of other formats: WKT, GeoJSON, DXF, Vadere.

mod support;

use fbcrowd_scenes::{ReadOptions, Units, read};
use support::{read_text, written};

fn check(name: &str, text: &str, parts: &[&str]) {
    let (written, notes) = written(&read_text(name, text).unwrap());
    let found = written.scenario + &notes.join("\n");
    for part in parts {
        assert!(found.contains(part), "{part}\nis missing in\n{found}");
    }
}

fn check_refused(name: &str, text: &str, words: &str) {
    let error = read_text(name, text).expect_err(text).to_string();
    assert!(error.contains(words), "{error}");
}

const HALL: &str = "POLYGON ((0 0, 8 0, 8 5, 0 5, 0 0), (2 2, 3 2, 3 3, 2 2))";

#[test]
fn well_known_text_is_walkable_ground() {
    for text in [HALL.to_owned(), format!("GEOMETRYCOLLECTION ({HALL}, MULTIPOLYGON (((9 9, 10 9, 10 10, 9 9))))")] {
        check(
            "hall.wkt",
            &text,
            &[
                "polygon_m = [[0, 0], [8, 0], [8, 5], [0, 5]]\nholes_m = [\n",
                "# [[agents]]\n# grid = {",
                "# hall.wkt:1",
            ],
        );
    }
    let lines = HALL.replace("), (", "),\n (");
    let second = format!("GEOMETRYCOLLECTION ({lines},\n POLYGON ((9 9, 10 9, 10 10, 9 9)))");
    check("hall.wkt", &second, &["# hall.wkt:1\npolygon_m = [[0, 0]", "# hall.wkt:3\npolygon_m = [[9, 9]"]);
    check(
        "hall.wkt",
        &format!("SRID=25832;{HALL}"),
        &["1: coordinates of EPSG:25832 are taken as metres", "[[0, 0], [8, 0]"],
    );
    check_refused("hall.wkt", &format!("SRID = 4326;\n{HALL}"), "the coordinates are degrees of EPSG:4326");
    check_refused("hall.wkt", "POINT (1 2)", "no polygon");
    check_refused("hall.wkt", "POLYGON Z ((0 0 1, 1 0 1, 1 1 1, 0 0 1))", "third coordinate");
    check_refused("hall.wkt", "POLYGON ((0 0, 1 1, 1 0, 0 1, 0 0))", "crosses");
    check_refused("hall.wkt", &"GEOMETRYCOLLECTION(".repeat(100_000), "nested");
}

#[test]
fn a_far_plan_moves_to_the_origin() {
    let text = "POLYGON ((690000 5334000, 690008 5334000, 690008 5334005, 690000 5334005, 690000 5334000))";
    check("utm.wkt", text, &["[[-4, -3], [4, -3], [4, 2], [-4, 2]]", "shifted by [-690004, -5334003] m"]);
    check_refused("wide.wkt", "POLYGON ((0 0, 90000 0, 90000 9, 0 0))", "20 km across");
}

#[test]
fn geojson_is_walkable_ground() {
    let polygon = r#"{"type": "Polygon", "coordinates": [[[0, 0], [8, 0], [8, 5], [0, 0]]]}"#;
    for text in [
        polygon.to_owned(),
        format!(
            r#"{{"type": "FeatureCollection", "features": [{{"type": "Feature", "properties": {{}}, "geometry": {polygon}}}]}}"#
        ),
    ] {
        check("hall.geojson", &text, &["polygon_m = [[0, 0], [8, 0], [8, 5]]", "coordinates are taken as metres"]);
    }
    let second = format!(
        r#"{{"type": "GeometryCollection", "geometries": [{polygon}, {}]}}"#,
        polygon.replace("[8, 5]", "[8, 6]")
    );
    check(
        "hall.geojson",
        &second,
        &["# hall.geojson: geometries[1].coordinates\npolygon_m = [[0, 0], [8, 0], [8, 6]]"],
    );
    let degrees = r#"{"type": "Polygon", "coordinates": [[[11.5, 48.1], [11.6, 48.1], [11.6, 48.2], [11.5, 48.1]]]}"#;
    check_refused("town.geojson", degrees, "degrees");
    check_refused("x.json", "{\"type\": \"Polygon\", \"coordinates\": [", "no GeoJSON");
}

/// A drawing with a unit and polylines, each of a layer, flags and vertices with bulges.
fn drawing(units: &str, polylines: &[(&str, u32, &[[f64; 3]])]) -> String {
    let mut text = format!("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{units}\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n");
    for (layer, flags, vertices) in polylines {
        text += &format!("0\nLWPOLYLINE\n8\n{layer}\n70\n{flags}\n");
        for [x, y, bulge] in *vertices {
            text += &format!("10\n{x}\n20\n{y}\n42\n{bulge}\n");
        }
    }
    text + "0\nLINE\n8\n0\n10\n0\n20\n0\n0\nENDSEC\n0\nEOF\n"
}

#[test]
fn closed_polylines_of_a_drawing_are_obstacles_by_layer() {
    let square = [[0.0, 0.0, 0.0], [4000.0, 0.0, 0.0], [4000.0, 4000.0, 0.0], [0.0, 4000.0, 0.0]];
    let half_circle = [[1000.0, 1000.0, 1.0], [2000.0, 1000.0, 0.0]];
    let text = drawing("4", &[("Walkable area", 1, &square), ("WALLS", 1, &half_circle), ("WALLS", 0, &square)]);
    check(
        "plan.dxf",
        &text,
        &[
            "polygon_m = [[0, 0], [4, 0], [4, 4], [0, 4]]\n",
            "[1.5, 0.5]",
            "layer WALLS",
            "open polylines are left out",
            "1 × LINE left out",
        ],
    );
}

#[test]
fn a_drawing_without_unit_needs_one() {
    let text = drawing("0", &[("WALLS", 1, &[[0.0, 0.0, 0.0], [400.0, 0.0, 0.0], [400.0, 300.0, 0.0]])]);
    check_refused("plan.dxf", &text, "--units");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.dxf");
    std::fs::write(&path, text).unwrap();
    let options = ReadOptions { units: Some(Units::Centimetres), ..ReadOptions::default() };
    let (written, _) = written(&read(&path, &options).unwrap());
    assert!(written.scenario.contains("polygon_m = [[0, 0], [4, 0], [4, 3]]"), "{}", written.scenario);
    check_refused("plan.dxf", "no drawing", "group code");
    check_refused("plan.dxf", "AutoCAD Binary DXF\r\n", "binary");
}

const VADERE: &str = r#"{
  "name": "hall", "release": "3.0",
  "scenario": {
    "attributesSimulation": { "finishTime": 200.0 },
    "topography": {
      "attributes": { "bounds": { "x": 0.0, "y": 0.0, "width": 20.0, "height": 10.0 }, "boundingBoxWidth": 0.5, "bounded": true },
      "obstacles": [ { "id": 7, "shape": { "type": "RECTANGLE", "x": 9.0, "y": 4.0, "width": 1.1, "height": 2.0 } } ],
      "targets": [
        { "id": 1, "shape": { "type": "RECTANGLE", "x": 18.0, "y": 1.0, "width": 1.0, "height": 8.0 },
          "absorber": { "enabled": true, "deletionDistance": 0.1 }, "waiter": { "enabled": false, "distribution": null } },
        { "id": 2, "shape": { "type": "POLYGON", "points": [ { "x": 5, "y": 8 }, { "x": 6, "y": 8 }, { "x": 6, "y": 9 } ] },
          "absorber": { "enabled": false, "deletionDistance": 0.1 },
          "waiter": { "enabled": true, "distribution": { "type": "org.vadere.state.attributes.distributions.AttributesConstantDistribution", "updateFrequency": 4.0 } } }
      ],
      "sources": [
        { "id": 3, "shape": { "type": "RECTANGLE", "x": 1.0, "y": 1.0, "width": 3.0, "height": 8.0 }, "targetIds": [ 2, 1 ],
          "spawner": { "constraintsElementsMax": -1, "constraintsTimeStart": 0.0, "constraintsTimeEnd": 0.0, "eventElementCount": 12,
            "distribution": { "type": "a.AttributesConstantDistribution", "updateFrequency": 1.0 } } },
        { "id": 4, "shape": { "type": "RECTANGLE", "x": 1.0, "y": 1.0, "width": 1.0, "height": 8.0 }, "targetIds": [ 1 ],
          "spawner": { "constraintsElementsMax": 40, "constraintsTimeStart": 10.0, "constraintsTimeEnd": 110.0, "eventElementCount": 1,
            "distribution": { "type": "a.AttributesConstantDistribution", "updateFrequency": 2.0 } } },
        { "id": 5, "shape": { "type": "CIRCLE", "center": { "x": 3.0, "y": 4.0 }, "radius": 1.0 }, "targetIds": [ 1 ],
          "spawner": { "constraintsElementsMax": -1, "constraintsTimeStart": 5.0, "constraintsTimeEnd": 180.0, "eventElementCount": 1,
            "distribution": { "type": "a.AttributesNegativeExponentialDistribution", "mean": 2.0 } } },
        { "id": 6, "shape": { "type": "RECTANGLE", "x": 1.0, "y": 1.0, "width": 1.0, "height": 8.0 }, "targetIds": [ 1 ],
          "spawner": { "constraintsElementsMax": -1, "constraintsTimeStart": 30.0, "constraintsTimeEnd": 30.0, "eventElementCount": 7,
            "distribution": { "type": "a.AttributesConstantDistribution", "updateFrequency": 2.0 } } }
      ],
      "dynamicElements": [ { "position": { "x": 12.0, "y": 5.0 }, "targetIds": [ 1 ] } ],
      "stairs": [ {} ]
    }
  }
}"#;

#[test]
fn a_scenario_of_vadere_keeps_targets_and_sources() {
    for name in ["hall.scenario", "hall.json"] {
        check(
            name,
            VADERE,
            &[
                "duration_s = 200\n",
                "polygon_m = [[0.5, 0.5], [19.5, 0.5], [19.5, 9.5], [0.5, 9.5]]\n",
                "polygon_m = [[9, 4], [10.1, 4], [10.1, 6], [9, 6]]\n",
                "area = { rect_m = [1, 1, 4, 9], count = 12 }\nprofile = \"pedestrian\"\nstate = \"to_2_then_1\"\n",
                "rect_m = [1, 1, 2, 9]\nschedule = [\n    [10, 1], [12, 1], [14, 1], [16, 1], [18, 1], [20, 1], [22, 1], [24, 1],\n    [26, 1],",
                "[84, 1], [86, 1], [88, 1],\n]\nprofile",
                "circle_m = [3, 4, 1]\nrate_per_s = 0.5\nfrom_s = 5\nto_s = 180\n",
                "schedule = [[30, 7]]\n",
                "at_m = [12, 5]\n",
                "[states.to_2_then_1]\ngo = \"target_2\"\nthen = [{ when = { reached_m = 0.1 }, to = \"wait_2_then_1\" }]\n",
                "[states.wait_2_then_1]\nstand = {}\nthen = [{ when = { after_s = 4 }, to = \"to_1\" }]\n",
                "[states.gone]\nremove = true\n",
                "preferred_speed_mps = { normal = [1.34, 0.26], min = 0.5, max = 2.2 }\n",
                "!0: 1 stairs are level ground",
            ],
        );
    }
    check_refused("hall.scenario", &VADERE.replace("[ 2, 1 ]", "[ 2, 9 ]"), "target 9");
    check_refused("hall.scenario", &VADERE.replace("\"bounds\"", "\"bonds\""), "hall.scenario:6");
    check_refused("hall.scenario", "{}", "no scenario of Vadere");
}

#[test]
fn a_scenario_of_vadere_keeps_seed_speeds_and_duration() {
    let with = |from: &str, to: &str| {
        assert!(VADERE.contains(from), "{from}");
        VADERE.replacen(from, to, 1)
    };
    let seed = "\"useFixedSeed\": true, \"fixedSeed\": 77, \"finishTime\": 200.0";
    check("hall.scenario", &with("\"finishTime\": 200.0", seed), &["duration_s = 200\nseed = 77\n"]);
    let (written, _) =
        written(&read_text("hall.scenario", &with("\"finishTime\": 200.0", &seed.replace("true", "false"))).unwrap());
    assert!(!written.scenario.contains("seed"), "{}", written.scenario);
    let long = with("\"finishTime\": 200.0", "\"finishTime\": 1e300");
    check("hall.scenario", &long, &["duration_s = 86400\n", "!0: `finishTime` 1e300 s is cut to 86400 s"]);
    let agents = "\"dynamicElements\": [ { \"position\": { \"x\": 13, \"y\": 5 }, \"targetIds\": [ 1 ], \"freeFlowSpeed\": 1.5 }, \
                  { \"position\": { \"x\": 14, \"y\": 5 }, \"targetIds\": [ 1 ], \"freeFlowSpeed\": 99 },";
    check(
        "hall.scenario",
        &with("\"dynamicElements\": [", agents),
        &[
            "inherits = \"pedestrian\"\npreferred_speed_mps = 1.5\n",
            "preferred_speed_mps = 10\n",
            "!0: `freeFlowSpeed` is cut to 0.1 to 10 m/s",
            "at_m = [13, 5]\nprofile = \"pedestrian_150_cm_per_s\"\n",
            "at_m = [12, 5]\nprofile = \"pedestrian\"\n",
        ],
    );
    let area =
        "{ \"id\": 9, \"shape\": { \"type\": \"RECTANGLE\", \"x\": 10, \"y\": 5, \"width\": 3, \"height\": 4 } }";
    check(
        "hall.scenario",
        &with("\"stairs\": [ {} ]", &format!("\"measurementAreas\": [ {area}, {area} ]")),
        &[
            "[[measure]]\nname = \"measurement area 9\"\nrect_m = [10, 5, 13, 9]\n",
            "name = \"measurement area 9 (2)\"\n",
        ],
    );
}

/// The error's whole text, without the folder.
fn check_error(name: &str, text: &str, expected: &str) {
    let error = read_text(name, text).expect_err(text).to_string();
    assert_eq!(&error[error.find(name).unwrap_or(0)..], expected);
}

#[test]
fn mistakes_are_shown_at_the_line_of_their_item() {
    let wkt = "GEOMETRYCOLLECTION (\n POINT (1 2),\n POLYGON ((0 0, 9 0, 9 9, 0 9),\n  (1 1, 2 1, 2 2)),\n MULTIPOLYGON (((20 0, 21 0, 21 1)),\n  ((30 0, 31 1, 31 0, 30 1))))";
    check_error(
        "hall.wkt",
        wkt,
        "hall.wkt:6: the ring that begins at [30, 0] crosses or touches itself, or has no area; list its corners in order, each once",
    );
    check_error(
        "hall.wkt",
        "GEOMETRYCOLLECTION (POLYGON ((0 0, 9 0, 9 9)),\n POLYGON Z (\n (0 0 1, 1 0 1, 1 1 1)))",
        "hall.wkt:3: a position has a third coordinate; give x and y alone; the ground is flat",
    );
    let feature =
        |geometry: &str| format!("{{\"type\": \"Feature\", \"properties\": {{\"]\": 1}}, \"geometry\":\n{geometry}}}");
    let square = "{\"type\": \"Polygon\", \"coordinates\":\n[[[0, 0], [9, 0], [9, 9], [0, 0]]]}";
    let several = "{\"type\": \"GeometryCollection\", \"geometries\": [\n{\"type\": \"MultiPolygon\", \"coordinates\": [\n[[[0, 0], [1, 0], [1, 1], [0, 0]]],\n[[[0, 0], [1, 0, 7], [1, 1], [0, 0]]]]}]}";
    let collection =
        format!("{{\"type\": \"FeatureCollection\", \"features\": [\n{},\n{}]}}", feature(square), feature(several));
    check_error(
        "hall.geojson",
        &collection,
        "hall.geojson:9: features[1].geometry.geometries[0].coordinates[1][0][1]: a position has a third coordinate; give x and y alone; the ground is flat",
    );
    check_error(
        "hall.scenario",
        &VADERE.replace("[ 2, 1 ]", "[ 2, 9 ]"),
        "hall.scenario:16: scenario.topography.sources[0]: source 3 names target 9, which does not exist; correct its `targetIds`",
    );
    check_error(
        "hall.scenario",
        &VADERE.replace("\"width\": 20.0", "\"width\": 0.5"),
        "hall.scenario:6: scenario.topography.attributes.bounds: the bounds hold no ground; give them a width and a height",
    );
}

#[test]
fn an_unknown_extension_is_refused() {
    check_refused("hall.txt", HALL, "states no format");
}
