//! Damaged and hostile files: a scene or an error, never a panic, in little time.

mod support;

use std::fs;
use std::time::{Duration, Instant};

use fbcrowd_scenes::write::{WriteOptions, write};
use fbcrowd_scenes::{ReadOptions, read};
use support::{BEHAVIOUR, Project, SCENE};

/// Copies of each file. Each takes about a millisecond.
const COPIES: u64 = 400;
/// Longest time for one scene.
const LIMIT: Duration = Duration::from_secs(20);

/// A generator of wild numbers.
struct Wild(u64);

impl Wild {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end.max(1)
    }

    /// A text with a few parts cut, doubled, swapped or replaced.
    fn damaged(&mut self, text: &str) -> String {
        const TOKENS: [&str; 16] = [
            "0",
            "-1",
            "1e300",
            "NaN",
            "99999999999",
            "\"",
            "<",
            ">",
            "/",
            "</State>",
            "<State name=\"x\" final=\"0\">",
            "&amp;",
            "-0.0",
            "inf",
            " ",
            "Visit",
        ];
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..1 + self.below(4) {
            let (at, length) = (self.below(bytes.len()), self.below(40));
            let end = (at + length).min(bytes.len());
            match self.below(12) {
                0 => drop(bytes.drain(at..end)),
                1 => bytes.truncate(at),
                2 => {
                    let part = bytes[at..end].to_vec();
                    bytes.splice(at..at, part);
                }
                3 => {
                    let token = TOKENS[self.below(TOKENS.len())];
                    bytes.splice(at..(at + 1).min(bytes.len()), token.bytes());
                }
                _ => {
                    // A number is replaced by another one.
                    let from = (at..bytes.len()).find(|&index| bytes[index].is_ascii_digit()).unwrap_or(at);
                    let to = (from..bytes.len()).find(|&index| !bytes[index].is_ascii_digit()).unwrap_or(bytes.len());
                    let token = TOKENS[self.below(5)];
                    bytes.splice(from..to, token.bytes());
                }
            }
        }
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

/// Reads and writes a scene; returns whether it could be read.
fn check(path: &std::path::Path, what: &str) -> bool {
    let begin = Instant::now();
    let read = read(path, &ReadOptions::default());
    if let Ok(read) = &read {
        let written = write(&read.scene, &WriteOptions::default());
        toml::from_str::<toml::Table>(&written.scenario).unwrap_or_else(|error| panic!("{what}: {error}"));
        assert!(!written.scenario.contains("NaN") && !written.scenario.contains("inf,"), "{what}");
    }
    assert!(begin.elapsed() < LIMIT, "{what} took {:?}", begin.elapsed());
    read.is_ok()
}

#[test]
fn damaged_projects_give_a_scene_or_an_error() {
    let project = Project::new(&[]);
    let mut wild = Wild(1);
    let mut read = 0;
    for copy in 0..COPIES {
        for (name, text) in [("fair/scene.xml", SCENE), ("fair/behaviour.xml", BEHAVIOUR)] {
            let damaged = wild.damaged(text);
            fs::write(project.0.path().join(name), &damaged).unwrap();
            read += usize::from(check(&project.path(), &format!("copy {copy} of {name}:\n{damaged}")));
            fs::write(project.0.path().join(name), text).unwrap();
        }
    }
    assert!(read > 50, "{read} copies could be read");
}

#[test]
fn damaged_plans_give_a_scene_or_an_error() {
    let mesh = "4\n0 0\n4 0\n4 4\n0 4\n0\n4\n0 1 0 1\n1 2 0 2\n2 3 0 3\n3 0 0 -1\nhall\n1\n2 2\n4 0 1 2 3\n0 0 0\n0\n4 0 1 2 3\n";
    let scene =
        SCENE.replace("</Experiment>", "<ObstacleSet type=\"nav_mesh\" file_name=\"m.nav\" class=\"1\"/></Experiment>");
    let texts = [
        ("a.wkt", "GEOMETRYCOLLECTION (POLYGON ((0 0, 8 0, 8 5, 0 5, 0 0), (2 2, 3 2, 3 3, 2 2)))"),
        ("a.geojson", r#"{"type": "Polygon", "coordinates": [[[0, 0], [8, 0], [8, 5], [0, 0]]]}"#),
        (
            "a.dxf",
            "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\nW\n70\n1\n10\n0\n20\n0\n42\n0.5\n10\n4\n20\n0\n10\n4\n20\n3\n0\nENDSEC\n0\nEOF\n",
        ),
        (
            "a.scenario",
            r#"{"scenario": {"topography": {"attributes": {"bounds": {"x": 0, "y": 0, "width": 9, "height": 9}}, "targets": [{"id": 1, "shape": {"type": "CIRCLE", "center": {"x": 3, "y": 3}, "radius": 1}}], "sources": [{"id": 2, "shape": {"type": "RECTANGLE", "x": 1, "y": 1, "width": 2, "height": 2}, "targetIds": [1], "spawnNumber": 3}]}}}"#,
        ),
        ("fair/m.nav", mesh),
    ];
    let project = Project::new(&[("fair/scene.xml", &scene)]);
    let mut wild = Wild(2);
    for (name, text) in texts {
        let file = project.0.path().join(name);
        let path = if name.ends_with(".nav") { project.path() } else { file.clone() };
        fs::write(&file, text).unwrap();
        assert!(check(&path, name), "{name} itself");
        for copy in 0..COPIES {
            let damaged = wild.damaged(text);
            fs::write(&file, &damaged).unwrap();
            check(&path, &format!("copy {copy} of {name}:\n{damaged}"));
        }
        fs::write(&file, text).unwrap();
    }
}

#[test]
fn deep_and_long_files_end_soon() {
    let deep = "<Condition type=\"not\">".repeat(100_000);
    let behaviour = BEHAVIOUR.replace("<Condition type=\"and\">", &deep);
    let nested = format!(
        "{}<Condition type=\"auto\"/>{}",
        "<Condition type=\"not\">".repeat(50_000),
        "</Condition>".repeat(50_000)
    );
    let nested = BEHAVIOUR.replace("<Condition type=\"goal_reached\" distance=\"0.4\"/>", &nested);
    let crowd = "<Generator type=\"rect_grid\" anchor_x=\"0\" anchor_y=\"0\" offset_x=\"0\" offset_y=\"0\" count_x=\"1000\" count_y=\"999\"/>";
    let scene = SCENE.replace(
        "<Generator type=\"explicit\"><Agent p_x=\"5\" p_y=\"5\"/><Agent p_x=\"8.5\" p_y=\"8.5\"/></Generator>",
        crowd,
    );
    for (name, text) in
        [("fair/behaviour.xml", &behaviour), ("fair/behaviour.xml", &nested), ("fair/scene.xml", &scene)]
    {
        let project = Project::new(&[(name, text)]);
        check(&project.path(), name);
    }
    let long = Project::new(&[]);
    let file = fs::File::create(long.0.path().join("fair/scene.xml")).unwrap();
    file.set_len(1 << 40).unwrap();
    assert!(long.read().unwrap_err().to_string().contains("16 MiB"));
}
