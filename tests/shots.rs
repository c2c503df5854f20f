//! `[shot]`, motion blur, `--video` and cameras of glTF files, by the built binary.

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use exr::prelude::{ReadChannels, ReadLayers};
use fbcrowd_sim::measures::shot_slide;
use fbcrowd_sim::recording::{FrameTimes, Recording};
use fbcrowd_sim::scenario::ShotSpec;
use support::{WALK, compile, fbcrowd, files, folder, scenario, text};

/// Six agents that walk, two of them faster, before a still camera; frames 101 on at 24 Hz after half a second.
const SCENE: &str = "duration_s = 3\ndatabase = \"motion.fbdb\"\n\
    [[agents]]\ngrid = { columns = 3, rows = 2, spacing_m = 1.2, centre_m = [0, 0] }\ngoals_m = [[9, 0]]\n\
    [camera]\neye_m = [2, -6, 1.6]\nlook_at_m = [2, 0, 1]\nfocal_mm = 35\n\
    [view]\nwidth = 192\nheight = 108\n\
    [shot]\npreroll_s = 0.5\nfirst_frame = 101\nfps = 24\n";

/// The recording of [`SCENE`], made once.
fn recording() -> &'static Path {
    static RECORDING: OnceLock<PathBuf> = OnceLock::new();
    RECORDING.get_or_init(|| {
        let folder = folder("shots");
        compile(&[WALK.to_owned()], &folder);
        let scene = scenario(&folder, SCENE);
        let recording = folder.join("scene.fbrec");
        fbcrowd(&["simulate", &scene, "-o", text(&recording)]).expect_code(0);
        recording
    })
}

/// Renders with these options into a folder of the recording's.
fn render(name: &str, options: &[&str]) -> PathBuf {
    let output = recording().with_file_name(name);
    let arguments = [&["render", text(recording()), "-o", text(&output)], options].concat();
    fbcrowd(&arguments).expect_code(0);
    output
}

#[test]
fn a_shot_numbers_its_frames_and_leaves_out_the_preroll() {
    for view in ["top", "camera"] {
        let folder = render(&format!("numbers_{view}"), &["--view", view, "--frames", "101-160x20"]);
        // 2.5 s at 24 Hz are 61 frames: 101 to 161.
        assert_eq!(files(&folder), ["scene.0101.png", "scene.0121.png", "scene.0141.png"], "{view}");
    }
    let other = render("other", &["--fps", "12", "--preroll", "2", "--first-frame", "7"]);
    assert_eq!(files(&other).len(), 13);
    assert!(other.join("scene.0007.png").exists() && other.join("scene.0019.png").exists());
    fbcrowd(&["render", text(recording()), "-o", text(&other), "--frames", "90"]).expect_code(2).says(&["101 to 161"]);
    fbcrowd(&["render", text(recording()), "-o", text(&other), "--preroll", "9"])
        .expect_code(2)
        .says(&["preroll_s is 9"]);
    fbcrowd(&["render", text(recording()), "-o", text(&other), "--preroll", "-1"])
        .expect_code(2)
        .says(&["preroll_s is -1"]);
    fbcrowd(&["render", text(recording()), "-o", text(&other), "--fps", "nan"]).expect_code(2).says(&["fps is NaN"]);
}

#[test]
fn headers_state_rate_number_and_time_in_both_views() {
    for view in ["top", "camera"] {
        let folder = render(&format!("headers_{view}"), &["--view", view, "--format", "exr", "--frames", "113"]);
        let image = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = image.all_attributes().from_file(folder.join("scene.0113.exr")).unwrap();
        let attributes = &image.layer_data.attributes;
        assert_eq!(attributes.frames_per_second, Some((24, 1)), "{view}");
        let value = |name: &str| format!("{:?}", attributes.other[&exr::prelude::Text::from(name)]);
        assert_eq!(value("imageCounter"), "I32(113)");
        // 12 frames after 0.5 s.
        assert_eq!(value("time_s"), "F32(1.0)");
    }
}

#[test]
fn planted_feet_stay_planted_between_steps() {
    let recording = Recording::open(recording()).unwrap();
    for fps in [23.976, 24.0, 25.0, 60.0] {
        let shot = ShotSpec { fps: Some(fps), ..ShotSpec::default() };
        let slide = shot_slide(&recording, &FrameTimes::of(&shot, &recording.header().scenario)).unwrap();
        let [shown, recorded] = [slide.planted_slide_cm_s, slide.recorded_slide_cm_s].map(Option::unwrap);
        assert!(shown <= 1.5 * recorded.max(0.02), "{fps}: {shown} cm/s, recorded {recorded}");
    }
}

#[test]
fn measure_prints_the_slide_of_a_frame_rate() {
    let measured = fbcrowd(&["measure", text(recording()), "--fps", "24"]).expect_code(0).stdout;
    assert!(measured.contains("at 24.000 frames/s"), "{measured}");
    fbcrowd(&["measure", text(recording()), "--fps", "0"]).expect_code(2).says(&["fps is 0"]);
}

#[test]
fn blurred_frames_smear_bodies_and_their_mattes_but_not_depth() {
    let options = ["--view", "camera", "--frames", "140", "--format", "exr", "--passes", "z,agent,id"];
    let sharp = render("sharp", &options);
    let blurred = render("blurred", &[&options[..], &["--samples-per-frame", "4", "--shutter", "360"]].concat());
    let again = render("again", &[&options[..], &["--samples-per-frame", "4", "--shutter", "360"]].concat());
    let file = |folder: &Path| folder.join("scene.0140.exr");
    assert!(fs::read(file(&blurred)).unwrap() == fs::read(file(&again)).unwrap());
    let channel = |folder: &Path, name: &str| -> Vec<f32> {
        let image = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = image.all_attributes().from_file(file(folder)).unwrap();
        let found = image.layer_data.channel_data.list.iter().find(|channel| channel.name.to_string() == name);
        found.unwrap_or_else(|| panic!("{name}")).sample_data.values_as_f32().collect()
    };
    for unblurred in ["Z", "agent.id"] {
        assert!(channel(&sharp, unblurred) == channel(&blurred, unblurred), "{unblurred}");
    }
    // Coverages of the first rank: quarters while sharp, sixteenths while blurred; their sum stays about the same.
    let partly = |values: &[f32]| values.iter().filter(|cover| **cover > 0.0 && **cover < 1.0).count();
    let [clear, smeared] = [&sharp, &blurred].map(|folder| channel(folder, "CryptoAsset00.G"));
    assert!(2 * partly(&smeared) > 3 * partly(&clear), "{} {}", partly(&smeared), partly(&clear));
    assert!(smeared.iter().all(|cover| (cover * 16.0).fract() == 0.0));
    let [clear_px, smeared_px]: [f32; 2] = [&clear, &smeared].map(|covers| covers.iter().sum());
    assert!((smeared_px / clear_px - 1.0).abs() < 0.15, "{clear_px} {smeared_px}");
    assert!(channel(&sharp, "R") != channel(&blurred, "R"));
}

#[test]
fn options_without_effect_are_refused() {
    let output = recording().with_file_name("without_effect");
    let refused = |options: &[&str], reason: &str| {
        let arguments = [&["render", text(recording()), "-o", text(&output), "--frames", "1"], options].concat();
        fbcrowd(&arguments).expect_code(2).says(&[reason]);
    };
    refused(&["--size", "640x360"], "--size belongs to a camera; add --view camera");
    refused(&["--samples", "16"], "--samples belongs to a camera");
    refused(&["--colour-by", "speed"], "--colour-by belongs to a camera");
    refused(&["--labels"], "--labels belongs to a camera");
    refused(&["--view", "camera", "--labels", "--format", "exr"], "drawn into PNG");
    refused(&["--view", "camera", "--passes", "z"], "add --format exr");
}

#[test]
fn an_unknown_camera_lists_those_that_exist() {
    let output = recording().with_file_name("nowhere");
    fbcrowd(&["render", text(recording()), "-o", text(&output), "--view", "camera", "--camera", "x"])
        .expect_code(2)
        .says(&["\"x\"", "camera, default"]);
}

#[test]
fn a_video_needs_ffmpeg_and_says_so() {
    let video = recording().with_file_name("none.mp4");
    fbcrowd(&["render", text(recording()), "--video", text(&video), "--ffmpeg", "/no/such/ffmpeg"])
        .expect_code(3)
        .says(&["/no/such/ffmpeg", "install"]);
    let avi = recording().with_file_name("none.avi");
    fbcrowd(&["render", text(recording()), "--video", text(&avi)]).expect_code(2).says(&[".mp4"]);
    assert!(!video.exists());
}

/// A stand-in for ffmpeg: a shell script.
#[cfg(unix)]
fn script(name: &str, text: &str) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;

    let path = recording().with_file_name(name);
    let start = "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\nfor last; do :; done\n";
    fs::write(&path, format!("{start}{text}\n")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path
}

#[cfg(unix)]
#[test]
fn a_video_gets_all_frames_in_order_and_its_name_at_the_end() {
    let (video, pixels) = (recording().with_file_name("all.mp4"), script("keep.sh", "cat > \"$last\""));
    let render = |output: &Path, ffmpeg: &Path| {
        let path = text(recording());
        let options = ["--frames", "101-105", "--view", "camera", "--size", "191x107"];
        fbcrowd(&[&["render", path, "--video", text(output), "--ffmpeg", text(ffmpeg)], &options[..]].concat())
    };
    render(&video, &pixels).expect_code(0);
    // Even sides.
    assert_eq!(fs::metadata(&video).unwrap().len(), 5 * 192 * 108 * 3);
    let failing = script("fail.sh", "head -c 1000 > /dev/null; echo 'No space left' >&2; exit 7");
    let lost = recording().with_file_name("lost.mp4");
    render(&lost, &failing).expect_code(3).says(&["No space left", "no video is left"]);
    render(&lost, &script("idle.sh", "exit 0")).expect_code(3).says(&["ended early"]);
    assert!(!lost.exists());
    let left = files(recording().parent().unwrap());
    assert!(!left.iter().any(|name| name.ends_with(".tmp")), "{left:?}");
}

#[test]
#[ignore = "needs ffmpeg: FBCROWD_FFMPEG=/path/to/ffmpeg"]
fn ffmpeg_writes_a_video_that_it_reads_again() {
    let ffmpeg = std::env::var("FBCROWD_FFMPEG").expect("FBCROWD_FFMPEG names ffmpeg");
    let video = recording().with_file_name("real.mp4");
    fbcrowd(&["render", text(recording()), "--video", text(&video), "--ffmpeg", &ffmpeg]).expect_code(0);
    let shown = std::process::Command::new(&ffmpeg)
        .args(["-hide_banner", "-i", text(&video), "-f", "null", "-"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&shown.stderr).into_owned();
    for word in ["h264", "yuv420p(tv, bt709", "192x108", "24 fps", "frame=   61"] {
        assert!(said.contains(word), "{word} is missing from {said}");
    }
}

/// A glTF file and its buffer: a camera that a parent carries along glTF's x while it turns about y, and a still
/// orthographic one that looks down and jumps at 1 s.
fn gltf_with_cameras(folder: &Path) -> PathBuf {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // Times; positions of the carrier; turns of it (0° and 90° about y); positions of the jump.
    let numbers: [&[f32]; 4] = [
        &[0.0, 2.0],
        &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0],
        &[0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half],
        &[0.0, 9.0, 0.0, 0.0, 5.0, 0.0],
    ];
    let bytes: Vec<u8> = numbers.concat().iter().flat_map(|number| number.to_le_bytes()).collect();
    fs::write(folder.join("shot.bin"), &bytes).unwrap();
    let document = format!(
        r#"{{ "asset": {{ "version": "2.0" }}, "scene": 0, "scenes": [{{ "nodes": [0, 2] }}],
        "nodes": [
            {{ "name": "carrier", "children": [1] }},
            {{ "name": "dolly", "camera": 0, "translation": [0, 1.5, 3] }},
            {{ "name": "plan", "camera": 1, "translation": [0, 9, 0], "rotation": [-{half}, 0, 0, {half}] }}
        ],
        "cameras": [
            {{ "type": "perspective", "perspective": {{ "yfov": 0.9, "aspectRatio": 1.5, "znear": 0.1 }} }},
            {{ "type": "orthographic", "orthographic": {{ "xmag": 6, "ymag": 4, "znear": 0.1, "zfar": 50 }} }}
        ],
        "animations": [
            {{ "channels": [
                {{ "sampler": 0, "target": {{ "node": 0, "path": "translation" }} }},
                {{ "sampler": 1, "target": {{ "node": 0, "path": "rotation" }} }}
            ], "samplers": [{{ "input": 0, "output": 1 }}, {{ "input": 0, "output": 2 }}] }},
            {{ "channels": [{{ "sampler": 0, "target": {{ "node": 2, "path": "translation" }} }}],
               "samplers": [{{ "input": 0, "output": 3, "interpolation": "STEP" }}] }}
        ],
        "buffers": [{{ "uri": "shot.bin", "byteLength": {length} }}],
        "bufferViews": [
            {{ "buffer": 0, "byteOffset": 0, "byteLength": 8 }}, {{ "buffer": 0, "byteOffset": 8, "byteLength": 24 }},
            {{ "buffer": 0, "byteOffset": 32, "byteLength": 32 }}, {{ "buffer": 0, "byteOffset": 64, "byteLength": 24 }}
        ],
        "accessors": [
            {{ "bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2] }},
            {{ "bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3" }},
            {{ "bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC4" }},
            {{ "bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3" }}
        ] }}"#,
        length = bytes.len()
    );
    let path = folder.join("shot.gltf");
    fs::write(&path, document).unwrap();
    path
}

#[test]
fn a_camera_of_a_gltf_file_moves_with_its_parents() {
    use glam::Vec3;

    let folder = folder("gltf_cameras");
    let path = gltf_with_cameras(&folder);
    let cameras = fbcrowd_jobs::camera_file::cameras_of(&path, 2.0, motiondb_compiler::Outside::Refused).unwrap();
    let [dolly, plan] = &cameras[..] else { panic!("{cameras:?}") };
    assert_eq!((dolly.name.as_str(), plan.name.as_str()), ("dolly", "plan"));
    // The file's aspect ratio counts, not that of the picture.
    // 2·atan(1.5·tan 0.45).
    assert!((dolly.fov_deg.unwrap() - 71.853).abs() < 1e-2);
    assert_eq!((plan.fov_deg, plan.width_m), (None, Some(12.0)));
    let at = |time_s: f32| {
        dolly.keys.iter().min_by(|a, b| (a.time_s - time_s).abs().total_cmp(&(b.time_s - time_s).abs())).unwrap()
    };
    // glTF (0, 1.5, 3) is (0, -3, 1.5); after a turn of 90° about up it is (4 + 3, 0, 1.5), and looks along -x.
    let near = |found: Vec3, expected: [f32; 3]| found.distance(Vec3::from(expected)) < 1e-3;
    assert!(near(at(0.0).eye_m, [0.0, -3.0, 1.5]) && near(at(0.0).look_at_m, [0.0, 7.0, 1.5]), "{:?}", at(0.0));
    assert!(near(at(2.0).eye_m, [7.0, 0.0, 1.5]) && near(at(2.0).look_at_m, [-3.0, 0.0, 1.5]), "{:?}", at(2.0));
    let turned = std::f32::consts::FRAC_1_SQRT_2 * 3.0;
    assert!(near(at(1.0).eye_m, [2.0 + turned, -turned, 1.5]), "{:?}", at(1.0));
    // A camera that looks straight down has a direction that is up; it jumps at once.
    let heights: Vec<(f32, f32)> = plan.keys.iter().map(|key| (key.time_s, key.eye_m.z)).collect();
    assert!(heights.iter().all(|(time_s, height_m)| (*height_m - if *time_s < 2.0 { 9.0 } else { 5.0 }).abs() < 1e-4));
    assert!(near(plan.keys[0].up.unwrap(), [0.0, 1.0, 0.0]), "{:?}", plan.keys[0]);
}

#[test]
fn a_scenario_takes_its_camera_from_a_gltf_file() {
    let folder = folder("gltf_scene");
    gltf_with_cameras(&folder);
    compile(&[WALK.to_owned()], &folder);
    let scene = |camera: &str| {
        let tables = "duration_s = 0.4\ndatabase = \"motion.fbdb\"\nagents = { at_m = [0, 0], goals_m = [[3, 0]] }\n[view]\nwidth = 96\nheight = 64\n";
        scenario(&folder, &format!("{tables}[[cameras]]\nname = \"shot\"\n{camera}\n"))
    };
    let recording = folder.join("scene.fbrec");
    let simulate = |camera: &str| fbcrowd(&["simulate", &scene(camera), "-o", text(&recording)]);
    simulate("gltf = \"shot.gltf\"\nnode = \"absent\"").expect_code(2).says(&[".toml:10", "absent", "dolly, plan"]);
    // Each mistake is shown at its line and key.
    simulate("gltf = \"none.glb\"").expect_code(2).says(&[".toml:9", "gltf: ", "none.glb is no file"]);
    fs::write(folder.join("text.glb"), "no model").unwrap();
    simulate("gltf = \"text.glb\"").expect_code(2).says(&[".toml:9", "gltf: ", "text.glb"]);
    fs::write(folder.join("bare.gltf"), r#"{ "asset": { "version": "2.0" }, "nodes": [{}] }"#).unwrap();
    simulate("fog_m = 50\ngltf = \"bare.gltf\"").expect_code(2).says(&[".toml:10", "gltf: ", "no camera in it"]);
    fs::create_dir_all(folder.join("folder.glb")).unwrap();
    simulate("gltf = \"folder.glb\"").expect_code(2).says(&[".toml:9", "gltf: ", "folder.glb"]);
    simulate("gltf = \"shot.gltf\"\nfocal_mm = 35").expect_code(2).says(&["states its lens"]);
    simulate("gltf = \"shot.gltf\"\nnode = \"plan\"").expect_code(0);
    let [own, given] = ["own", "given"].map(|name| folder.join(name));
    let render = |options: &[&str]| {
        fbcrowd(&[&["render", text(&recording), "--view", "camera", "--frames", "1005"], options].concat())
    };
    render(&["-o", text(&own)]).expect_code(0);
    let file = folder.join("shot.gltf");
    render(&["-o", text(&given), "--cameras", text(&file), "--camera", "plan"]).expect_code(0);
    let picture = |folder: &Path| fs::read(folder.join("scene.1005.png")).unwrap();
    assert!(picture(&own) == picture(&given));
    render(&["-o", text(&given), "--cameras", text(&file), "--camera", "x"]).expect_code(2).says(&["dolly, plan"]);
    // A TOML file may hold cameras alone, and its paths are relative to it.
    fs::create_dir_all(folder.join("cameras")).unwrap();
    let alone = folder.join("cameras/alone.toml");
    let with_cameras = |tables: &str, options: &[&str]| {
        fs::write(&alone, tables).unwrap();
        render(&[&["-o", text(&given), "--cameras", text(&alone)], options].concat())
    };
    fs::remove_file(given.join("scene.1005.png")).unwrap();
    with_cameras("[camera]\ngltf = \"../shot.gltf\"\nnode = \"plan\"\n", &[]).expect_code(0);
    assert!(picture(&own) == picture(&given));
    let still = "eye_m = [0, -4, 1.6]\nlook_at_m = [0, 0, 1]";
    let two = format!("[view]\nwidth = 48\nheight = 32\n[[cameras]]\nname = \"a\"\n{still}\nfov_deg = 40\n");
    with_cameras(&two, &["--camera", "a"]).expect_code(0);
    assert_eq!(picture(&given)[16..24], [0, 0, 0, 48, 0, 0, 0, 32]);
    with_cameras(&two, &["--camera", "x"]).expect_code(2).says(&["a, default"]);
    with_cameras(&format!("[camera]\n{still}\nfocal_mm = 0"), &[])
        .expect_code(2)
        .says(&["alone.toml:4", "focal_mm is 0"]);
    with_cameras("[camera]\nfog_m = 9\ngltf = \"no.glb\"", &[]).expect_code(2).says(&["alone.toml:3", "gltf: "]);
    with_cameras("[view]\nwidth = 48", &[]).expect_code(2).says(&[
        "alone.toml",
        "no camera in this file",
        "add `[camera]`",
    ]);
    let empty = folder.join("empty.gltf");
    fs::write(&empty, r#"{ "asset": { "version": "2.0" }, "nodes": [{}] }"#).unwrap();
    render(&["-o", text(&given), "--cameras", text(&empty)]).expect_code(2).says(&["no camera in it"]);
}

#[test]
fn a_teleport_is_not_interpolated() {
    let folder = folder("teleport");
    compile(&[WALK.to_owned()], &folder);
    let scene = scenario(
        &folder,
        "duration_s = 3\ndatabase = \"motion.fbdb\"\n[areas.door]\nrect_m = [1, -2, 6, 2]\n\
         [states.walk]\nwalk_mps = [1.2, 0]\nthen = [{ when = { inside = \"door\" }, to = \"jump\" }]\n\
         [states.jump]\nwalk_mps = [1.2, 0]\nset = { teleport = { point_m = [0, 8] } }\n\
         [[agents]]\nat_m = [0, 0]\nstate = \"walk\"\n",
    );
    let path = folder.join("scene.fbrec");
    fbcrowd(&["simulate", &scene, "-o", text(&path)]).expect_code(0);
    let recording = Recording::open(&path).unwrap();
    let jump = recording.population().agents[0].teleports[0];
    let dt_s = f64::from(recording.header().scenario.dt_s);
    let y_at = |step: f64| fbcrowd_sim::recording::sample(&recording, step * dt_s).unwrap()[0].root.position_m.y;
    for share in [0.2, 0.5, 0.9] {
        assert!(y_at(f64::from(jump) - 1.0 + share).abs() < 0.5, "{share}");
    }
    assert!(y_at(f64::from(jump)) > 7.0);
}

#[test]
fn a_strip_shows_one_agent_in_one_picture() {
    let folder = render("strips", &["--view", "strip", "--agent", "0,4", "--frames", "101-149x4"]);
    assert_eq!(files(&folder), ["scene.agent0.png", "scene.agent4.png"]);
    let refused = |options: &[&str], message: &str| {
        let arguments = [&["render", text(recording()), "-o", text(&folder), "--view", "strip"], options].concat();
        fbcrowd(&arguments).expect_code(2).says(&[message]);
    };
    refused(&[], "add --agent N");
    refused(&["--agent", "6"], "agents 0 to 5");
    refused(&["--agent", "0", "--burn-in"], "--burn-in belongs to frames");
    refused(&["--agent", "0", "--fps", "600"], "choose fewer by --frames");
    refused(&["--agent", "0", "--passes", "z"], "need --view camera");
    for view in ["top", "camera"] {
        let without_effect = ["render", text(recording()), "-o", text(&folder), "--view", view, "--agent", "0"];
        fbcrowd(&without_effect).expect_code(2).says(&["--view strip"]);
    }
    assert_eq!(files(&folder).len(), 2);
}
