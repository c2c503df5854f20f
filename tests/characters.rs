//! Figures on the command line: compiled, inspected, worn by a crowd.

mod support;

#[path = "../tools/compiler/tests/characters/figure.rs"]
#[allow(dead_code, reason = "the compiler's tests use all of it")]
mod figure;

use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_sim::recording::Recording;
use figure::Figure;
use support::{WALK, check_schema, compile, fbcrowd, folder, scenario, text};

/// Writes a figure into a folder.
fn write(folder: &Path, name: &str, figure: &Figure) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, figure.glb()).unwrap();
    path
}

/// A scenario of two agents with two characters.
const SCENE: &str = "duration_s = 2\ndatabase = \"motion.fbdb\"\n\
    [[characters]]\nfile = \"adult.glb\"\n[[characters]]\nfile = \"child.glb\"\nweight = 2\n\
    [[agents]]\ngrid = { columns = 4, rows = 3, spacing_m = 1.5 }\ngoal_offset_m = [9, 0]\n";

#[test]
fn figures_are_compiled_inspected_and_worn() {
    let folder = folder("worn");
    let adult = write(&folder, "adult.glb", &Figure::adult());
    write(&folder, "child.glb", &Figure { size: 0.6, ..Figure::adult() });
    let compiled = folder.join("adult.fbchar");
    let outcome = fbcrowd(&["compile", text(&adult), "-o", text(&compiled), "--json"]).expect_code(0);
    check_schema("inspect", &outcome.json());
    let checksum = outcome.json()["character"]["checksum"].clone();

    compile(&[WALK.to_owned()], &folder);
    let (scene, recording) = (scenario(&folder, SCENE), folder.join("scene.fbrec"));
    fbcrowd(&["simulate", &scene, "-o", text(&recording)]).expect_code(0).says(&["character child", "worn scaled by"]);
    let opened = Recording::open(&recording).unwrap();
    let [first, second] = &opened.header().characters[..] else { panic!("{:?}", opened.header().characters) };
    assert_eq!([first.name.as_str(), second.name.as_str()], ["adult", "child"]);
    assert_eq!(format!("{:08x}", first.checksum), checksum);
    assert!(opened.population().agents.iter().all(|life| life.character.is_some()));
    assert_eq!(fs::read(folder.join("characters/adult.fbchar")).unwrap(), fs::read(&compiled).unwrap());

    // A figure, and what was compiled of it, are the same character.
    for path in [&adult, &compiled] {
        let arguments = ["inspect", text(path), "--recording", text(&recording), "--json"];
        let report = fbcrowd(&arguments).expect_code(0).json();
        check_schema("inspect", &report);
        let character = &report["character"];
        assert_eq!(character["checksum"], checksum);
        assert_eq!(character["roles"][0]["joint"], "Hips");
        assert_eq!(character["fit"]["is_scaled"], false);
        assert!(character["soles"]["planted_slide_cm_s"].as_f64().unwrap() < 2.0, "{character}");
        assert!(character["soles"]["sole_depth_cm"].as_f64().unwrap() < 1.0, "{character}");
    }
    let shown = fbcrowd(&["inspect", text(&adult)]).expect_code(0).stdout;
    assert!(shown.contains("left_thigh          LeftUpLeg"), "{shown}");
}

/// Number of pixels of a colour in a PNG file.
fn count_of(path: &Path, colour: [u8; 3]) -> usize {
    let mut reader = png::Decoder::new(std::io::BufReader::new(fs::File::open(path).unwrap())).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    pixels.chunks_exact(3).filter(|pixel| **pixel == colour).count()
}

#[test]
fn a_picture_shows_the_joints_of_a_figure() {
    let folder = folder("figure_picture");
    let adult = write(&folder, "adult.glb", &Figure::adult());
    let picture = folder.join("adult.png");
    fbcrowd(&["inspect", text(&adult), "-o", text(&picture)]).expect_code(0).says(&["drew"]);
    // Marks of the left, the right and the middle joints, as the palette has them.
    for (side, colour) in [("left", [33, 140, 77]), ("right", [133, 69, 173]), ("middle", [51, 50, 48])] {
        let count = count_of(&picture, colour);
        assert!(count > 1000, "{side}: {count} pixels");
    }
    fbcrowd(&["inspect", text(&adult), "-o", text(&folder), "--plots", "x"]).expect_code(2).says(&["--output PICTURE"]);
    fbcrowd(&["inspect", text(&adult), "-o", text(&adult)]).expect_code(2).says(&["adult.glb: pictures", "*.png"]);
    fbcrowd(&["inspect", text(&adult), text(&adult), "-o", text(&picture)]).expect_code(2).says(&["name one file"]);
}

#[test]
fn bad_figures_are_named_with_a_remedy() {
    let folder = folder("bad_figures");
    let legless = write(&folder, "legless.glb", &Figure::adult().without("UpLeg"));
    let output = folder.join("x.fbchar");
    fbcrowd(&["compile", text(&legless), "-o", text(&output)])
        .expect_code(2)
        .says(&["legless.glb: no human", "name the"]);
    assert!(!output.exists());
    let adult = write(&folder, "adult.glb", &Figure::adult());
    fbcrowd(&["compile", text(&adult), text(&legless), "-o", text(&output)]).expect_code(2).says(&["one file"]);
    fbcrowd(&["compile", text(&adult), "-o", text(&output)]).expect_code(0);
    fbcrowd(&["compile", text(&output), "-o", text(&output)]).expect_code(2).says(&["another output path"]);
    let mut bytes = fs::read(&output).unwrap();
    bytes[100] ^= 1;
    fs::write(&output, &bytes).unwrap();
    fbcrowd(&["inspect", text(&output)]).expect_code(2).says(&["x.fbchar: not a readable character", "checksum"]);
    compile(&[WALK.to_owned()], &folder);
    let scene = scenario(&folder, &SCENE.replace("child.glb", "legless.glb"));
    fbcrowd(&["simulate", &scene, "-o", text(&folder.join("x.fbrec"))]).expect_code(2).says(&["legless.glb: no human"]);
}
