//! Outputs of the built binary: they replace no input, and a path that cannot be written is named.

mod support;

use std::fs;

use support::{WALK, compile, fbcrowd, files, folder, scenario, text};

#[test]
fn a_database_replaces_none_of_its_clips() {
    let folder = folder("over_a_clip");
    let clip = folder.join("walk.bvh");
    fs::copy(support::repository().join(WALK), &clip).unwrap();
    let before = fs::read(&clip).unwrap();
    fbcrowd(&["compile", text(&folder), "-o", text(&clip)]).expect_code(2).says(&["walk.bvh", "another output path"]);
    assert!(fs::read(&clip).unwrap() == before);
}

#[test]
fn database_never_replaces_clip_resources() {
    let folder = folder("over_a_buffer");
    let clip = folder.join("walk.gltf");
    let document = r#"{ "asset": { "version": "2.0" }, "buffers": [{ "byteLength": 4, "uri": "walk%20data.bin" }],
        "images": [{ "uri": "skin.png" }, { "uri": "data:image/png;base64,AAAA" }] }"#;
    fs::write(&clip, document).unwrap();
    for name in ["walk data.bin", "skin.png"] {
        let file = folder.join(name);
        fs::write(&file, "all there is").unwrap();
        fbcrowd(&["compile", text(&clip), WALK, "-o", text(&file)]).expect_code(2).says(&[name, "another output path"]);
        assert_eq!(fs::read_to_string(&file).unwrap(), "all there is");
    }
    fbcrowd(&["compile", text(&clip), WALK, "-o", text(&folder.join("motion.fbdb"))]).expect_code(1);
}

#[test]
fn an_output_replaces_no_input_and_no_folder() {
    let folder = folder("replaced");
    let walk = folder.join("walk.bvh");
    fs::copy(support::repository().join(WALK), &walk).unwrap();
    let before = fs::read(&walk).unwrap();
    fbcrowd(&["compile", text(&walk), "-o", text(&walk)]).expect_code(2).says(&["walk.bvh"]);
    assert_eq!(fs::read(&walk).unwrap(), before);
    fbcrowd(&["compile", WALK, "-o", text(&folder)]).expect_code(2).says(&["regular file"]);
    let database = compile(&[WALK.to_owned()], &folder);
    let scene = scenario(
        &folder,
        "duration_s = 0.1\ndatabase = \"motion.fbdb\"\nagents = { at_m = [0, 0], goals_m = [[2, 0]] }\n",
    );
    fbcrowd(&["simulate", &scene, "-o", &scene]).expect_code(2).says(&["scene.toml"]);
    fbcrowd(&["simulate", &scene, "-o", text(&database)]).expect_code(2).says(&["motion.fbdb"]);
    let (recording, report) = (folder.join("scene.fbrec"), folder.join("no/report.json"));
    fbcrowd(&["simulate", &scene, "-o", text(&recording), "--report", text(&report)])
        .expect_code(2)
        .says(&["report.json"]);
    let spelt = folder.join("../replaced/./scene.fbrec");
    fbcrowd(&["simulate", &scene, "-o", text(&recording), "--report", text(&spelt)])
        .expect_code(2)
        .says(&["both recording and report"]);
    fbcrowd(&["simulate", &scene, "-o", text(&recording)]).expect_code(0);
    fbcrowd(&["measure", text(&recording), "--table", text(&recording)]).expect_code(2).says(&["scene.fbrec"]);
    let table = folder.join("table");
    fbcrowd(&["measure", text(&recording), "--table", text(&table), "--trajectories", text(&table)])
        .expect_code(2)
        .says(&["both trajectories and table"]);
    fs::remove_file(&recording).unwrap();
    fs::write(folder.join("agents.txt"), "0 0 2 0\n").unwrap();
    let scene = scenario(&folder, "duration_s = 0.1\ndatabase = \"motion.fbdb\"\nagents = { file = \"agents.txt\" }\n");
    fbcrowd(&["simulate", &scene, "-o", text(&folder.join("agents.txt"))]).expect_code(2).says(&["agents.txt"]);
    assert_eq!(files(&folder), ["agents.txt", "motion.fbdb", "scene.toml", "walk.bvh"]);
}

#[test]
fn a_path_that_cannot_be_written_is_named() {
    let folder = folder("unwritable");
    let file = folder.join("a_file");
    fs::write(&file, "not a folder").unwrap();
    let inside = file.join("motion.fbdb");
    fbcrowd(&["compile", WALK, "-o", text(&inside)]).expect_code(2).says(&["a_file"]);
    fbcrowd(&["clips", "--out", text(&file.join("clips"))]).expect_code(2).says(&["a_file"]);
    assert_eq!(files(&folder), ["a_file"]);
}
