//! Figures on the command line: compiled, inspected, worn by a crowd.

mod support;

#[path = "../tools/compiler/tests/characters/figure.rs"]
#[allow(dead_code, reason = "the compiler's tests use all of it")]
mod figure;

#[path = "../tools/compiler/tests/extra_joints/hands.rs"]
#[allow(dead_code, reason = "the compiler's tests use all of it")]
mod hands;

use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_sim::recording::{Recording, sample, sample_extra};
use figure::Figure;
use glam::{DVec2, Quat};
use motiondb::body::{ExtraJoint, Side};
use motiondb::character::CharacterFit;
use motiondb::motion::PHASE_COUNT;
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

    fs::rename(folder.join("characters"), folder.join("elsewhere")).unwrap();
    fbcrowd(&["render", text(&recording), "-o", text(&folder.join("frames")), "--view", "camera", "--frames", "1001"])
        .expect_code(2)
        .says(&["adult.fbchar is missing", "keep the folder `characters` beside the recording"]);
}

/// A database of a walk and an idle whose fingers curl by an angle, degrees, of the finger and the time.
fn compile_with_fingers(folder: &Path, name: &str, curl_deg: fn(usize, f64) -> f64) -> PathBuf {
    let clips = folder.join(name);
    fs::create_dir_all(&clips).unwrap();
    for clip in ["walk_110", "idle"] {
        fs::write(clips.join(format!("{clip}.bvh")), hands::text_with_hands(clip, &hands::both(curl_deg))).unwrap();
    }
    let database = folder.join(format!("{name}.fbdb"));
    fbcrowd(&["compile", text(&clips), "-o", text(&database)]).expect_code(0);
    database
}

/// A scenario of an agent that walks with a database and wears a figure, before a camera.
fn walk_scene(folder: &Path, database: &str) -> PathBuf {
    let scene = format!(
        "duration_s = 6\nvariation = false\ndatabase = \"{database}.fbdb\"\n[[characters]]\nfile = \"adult.glb\"\n\
         [camera]\neye_m = [7, 2.5, 1]\nlook_at_m = [5, 0, 0.8]\nfocal_mm = 50\n\
         [[agents]]\nat_m = [0, 0]\ngoals_m = [[20, 0]]\npreferred_speed_mps = 1.1\n"
    );
    let scene = scenario(folder, &scene);
    let recording = folder.join(format!("{database}.fbrec"));
    fbcrowd(&["simulate", &scene, "-o", text(&recording)]).expect_code(0);
    recording
}

/// From clips with curling fingers to those of a figure: the curl of a stride, at its phase.
#[test]
fn fingers_of_a_figure_curl_as_in_the_clips() {
    // A stride of the clip.
    const STRIDE_S: f64 = 1.208_333;
    let curl_deg = |finger: usize, time_s: f64| {
        let in_stride = DVec2::from_angle(TAU * time_s / STRIDE_S).y;
        10.0 * finger as f64 + 20.0 + if finger == 1 { 15.0 * in_stride } else { 0.0 }
    };
    let folder = folder("fingers");
    let adult = write(&folder, "adult.glb", &Figure::adult().with_fingers());
    let database = compile_with_fingers(&folder, "curling", curl_deg);
    let (db, _) = motiondb::files::database_file::load(&database).unwrap();
    let report = fbcrowd(&["inspect", text(&adult), "--json"]).expect_code(0).json();
    check_schema("inspect", &report);
    let fingers = &report["character"]["extra_joints"];
    assert_eq!(fingers.as_array().unwrap().len(), 30);
    assert_eq!((&fingers[0]["extra"], &fingers[0]["joint"]), (&"left_thumb_1".into(), &"LeftHandThumb1".into()));
    let opened = Recording::open(&walk_scene(&folder, "curling")).unwrap();
    let character = motiondb::character::load(&folder.join("characters/adult.fbchar")).unwrap().0;
    let fit = CharacterFit::new(&character, opened.header().skeleton());
    let joints: Vec<ExtraJoint> =
        opened.header().extra_joints.iter().map(|joint| ExtraJoint::named(&joint.name).unwrap()).collect();
    assert_eq!(joints.len(), 30);
    let walk = db.examples.iter().position(|example| example.name == "walk_110").unwrap();
    let mut curls_deg = Vec::new();
    for frame in 120..180 {
        let time_s = f64::from(frame) / 30.0;
        let (agent, extra) = (sample(&opened, time_s).unwrap()[0], sample_extra(&opened, time_s).unwrap());
        let rotation =
            |joint: ExtraJoint| joints.iter().position(|known| *known == joint).map(|at| extra.of(agent.id)[at]);
        let pose = agent.pose.forward_kinematics(opened.header().skeleton());
        let mut transforms = Vec::new();
        fit.pose(opened.header().skeleton(), &pose, agent.root.frame(), &mut transforms);
        fit.pose_extra(rotation, &mut transforms);
        for side in Side::BOTH {
            // The curl of the middle joint, by the bones on both sides of it.
            let at_m = |finger: usize, joint: usize| {
                let joint = character.extra_joint(ExtraJoint::finger(side, finger, joint)).unwrap();
                transforms[joint].point_m(character.joints[joint].position_m)
            };
            let bone = |finger: usize, joint: usize| at_m(finger, joint + 1) - at_m(finger, joint);
            let knuckle = Quat::from_rotation_arc(bone(2, 0).normalize(), bone(2, 1).normalize());
            let found_deg = knuckle.to_axis_angle().1.to_degrees();
            assert!((found_deg - 40.0).abs() < 1.0, "middle finger: {found_deg}°");
            // Fingers curl towards the palm: the thumb is on the other side of the knuckles' axis.
            let palm = bone(2, 0).cross(at_m(1, 0) - at_m(4, 0)) * side.sign();
            assert!(bone(2, 1).dot(palm) > 0.0, "{side:?}: fingers bend backwards");
            let row = agent.phase * PHASE_COUNT as f32;
            let at_row = |row: usize| {
                let joint = db.extra.position(ExtraJoint::finger(side, 1, 1)).unwrap();
                db.extra.row(walk, row % PHASE_COUNT)[joint].to_scaled_axis().x.abs().to_degrees()
            };
            let wanted_deg = at_row(row as usize) + row.fract() * (at_row(row as usize + 1) - at_row(row as usize));
            let curl = Quat::from_rotation_arc(bone(1, 0).normalize(), bone(1, 1).normalize());
            let found_deg = curl.to_axis_angle().1.to_degrees();
            assert!((found_deg - wanted_deg).abs() < 3.0, "index finger: {found_deg}°, not {wanted_deg}°");
            curls_deg.push(found_deg);
        }
    }
    let (least, greatest) =
        curls_deg.iter().fold((f32::MAX, 0.0_f32), |(least, greatest), curl| (least.min(*curl), greatest.max(*curl)));
    assert!((least - 15.0).abs() < 2.0 && (greatest - 45.0).abs() < 2.0, "{least}° to {greatest}°");
}

#[test]
fn pictures_show_curled_fingers() {
    let folder = folder("finger_pictures");
    write(&folder, "adult.glb", &Figure::adult().with_fingers());
    let [straight, curled, again] = [("straight", 0.0), ("curled", 1.0), ("again", 1.0)].map(|(name, curl)| {
        compile_with_fingers(&folder, name, if curl > 0.0 { |_, _| 60.0 } else { |_, _| 0.0 });
        let (recording, frames) = (walk_scene(&folder, name), folder.join(format!("{name}_frames")));
        let camera = ["--view", "camera", "--frames", "1121", "--size", "320x180"];
        let arguments = [&["render", text(&recording), "-o", text(&frames)][..], &camera].concat();
        fbcrowd(&arguments).expect_code(0);
        fs::read(fs::read_dir(&frames).unwrap().next().unwrap().unwrap().path()).unwrap()
    });
    assert_ne!(straight, curled);
    assert_eq!(curled, again);
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

/// The adult with its shoulders farther apart.
fn with_shoulders(factor: f32) -> Figure {
    let mut figure = Figure::adult();
    let arms = ["Arm", "Hand", "Shoulder"];
    for bone in figure.bones.iter_mut().filter(|bone| arms.iter().any(|part| bone.0.contains(part))) {
        bone.2[0] *= factor;
    }
    figure
}

/// Radius of each agent, and its greatest overlap with another body in mm, where two lines of four walk into each other.
fn of_two_lines(folder: &Path, figure: &str, keys: &str) -> (Vec<f32>, f64, f64) {
    let line = |y: f32, x: f32, offset: f32| {
        format!(
            "[[agents]]\ngrid = {{ columns = 1, rows = 4, spacing_m = 0.9, centre_m = [{x}, {y}] }}\n\
             goal_offset_m = [{offset}, 0]\n{keys}"
        )
    };
    let head = format!("duration_s = 8\ndatabase = \"motion.fbdb\"\n[[characters]]\nfile = \"{figure}.glb\"\n");
    let scene = scenario(folder, &format!("{head}{}{}", line(0.0, -3.0, 7.0), line(0.2, 3.0, -7.0)));
    let recording = folder.join(format!("{figure}.fbrec"));
    fbcrowd(&["simulate", &scene, "-o", text(&recording)]).expect_code(0);
    let measures = fbcrowd(&["measure", text(&recording), "--json"]).expect_code(0).json();
    let opened = Recording::open(&recording).unwrap();
    let radii = opened.population().agents.iter().map(|life| life.spec.radius_m).collect();
    let number = |key: &str| measures[key].as_f64().unwrap_or_else(|| panic!("{key} in {measures}"));
    (radii, number("minimum_separation_m"), number("body_penetration_max_mm"))
}

#[test]
fn a_broad_figure_needs_more_room() {
    let folder = folder("broad");
    compile(&[WALK.to_owned()], &folder);
    for (name, factor) in [("narrow", 0.7), ("broad", 1.9)] {
        write(&folder, &format!("{name}.glb"), &with_shoulders(factor));
    }
    let (narrow, apart_m, _) = of_two_lines(&folder, "narrow", "");
    let (broad, broad_apart_m, _) = of_two_lines(&folder, "broad", "");
    assert!(narrow.iter().all(|radius_m| (0.12..0.22).contains(radius_m)), "{narrow:?}");
    assert!(broad.iter().all(|radius_m| (0.3..0.45).contains(radius_m)), "{broad:?}");
    assert!(broad_apart_m > apart_m + 0.15, "{apart_m} {broad_apart_m}");
    // A stated radius stays.
    assert!(of_two_lines(&folder, "broad", "radius_m = 0.25\n").0.iter().all(|radius_m| *radius_m == 0.25));
}

/// The adult with legs of half the length.
fn with_short_legs() -> Figure {
    let mut figure = Figure::adult();
    let hips_m = 0.5 * 0.9;
    for bone in &mut figure.bones {
        let height_m = &mut bone.2[1];
        *height_m = if *height_m < 0.9 { 0.5 * *height_m } else { *height_m - hips_m };
    }
    let is_leg = |name: &str| name.contains("UpLeg");
    figure.bones.iter_mut().filter(|bone| is_leg(bone.0)).for_each(|bone| bone.2[1] = hips_m);
    figure
}

#[test]
fn a_giant_is_warned_of_with_the_stature_that_mends_it() {
    let folder = folder("giant");
    compile(&[WALK.to_owned()], &folder);
    write(&folder, "squat.glb", &with_short_legs());
    let scene = |keys: &str| {
        let head = "duration_s = 2\ndatabase = \"motion.fbdb\"\n[[characters]]\nfile = \"squat.glb\"\n";
        format!("{head}[profiles.own]\n{keys}[[agents]]\nat_m = [0, 0]\ngoal_offset_m = [9, 0]\nprofile = \"own\"\n")
    };
    let recording = folder.join("scene.fbrec");
    let worn = fbcrowd(&["simulate", &scenario(&folder, &scene("")), "-o", text(&recording)]).expect_code(0);
    let warning = &worn.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
    let number = |after: &str| {
        let (_, rest) = warning.split_once(after).unwrap_or_else(|| panic!("{after}: {warning}"));
        let end = rest.find(|letter: char| letter != '.' && !letter.is_ascii_digit()).unwrap_or(rest.len());
        rest[..end].parse::<f32>().unwrap()
    };
    let scale = number("scaled by ");
    let [worn_m, crowd_m] =
        [format!("scaled by {scale:.2}, "), "as tall as the crowd (".to_owned()].map(|part| number(&part));
    let stature = number("`stature = ");
    assert!(worn_m > 1.3 * crowd_m && (stature * worn_m - crowd_m).abs() < 0.02, "{warning}");
    assert!(warning.contains("for its own size (1.2"), "{warning}");
    // The remedy holds: the agent that wears it has this stature.
    let mended = scenario(&folder, &scene(&format!("stature = {stature}\n")));
    fbcrowd(&["simulate", &mended, "-o", text(&recording)]).expect_code(0);
    assert_eq!(Recording::open(&recording).unwrap().population().agents[0].stature, stature);
}

#[test]
fn bad_figures_are_named_with_a_remedy() {
    let folder = folder("bad_figures");
    let legless = write(&folder, "legless.glb", &Figure::adult().without("UpLeg"));
    let output = folder.join("x.fbchar");
    fbcrowd(&["compile", text(&legless), "-o", text(&output)])
        .expect_code(2)
        .says(&["legless.glb: no human", "name the"]);
    let fox = write(&folder, "fox.glb", &Figure::fox());
    fbcrowd(&["compile", text(&fox), "-o", text(&output)])
        .expect_code(2)
        .says(&["fox.glb: four legs", "give a human figure"]);
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
