//! Files of human bodies that no database can be made of, or only by a guess: each is told by what was measured in it.

use std::path::Path;

use motiondb::remark::Kind;
use motiondb::skeleton::Joint;
use motiondb_compiler::axis::Axis;
use motiondb_compiler::error::{ImportError, Refusal};
use motiondb_compiler::import::{Import, import_bytes, import_take};
use motiondb_compiler::take::{Settings, Take};

use super::written_body::bvh_text;

fn imported(text: &str) -> Result<super::HumanClip, Refusal> {
    let imports: Result<Vec<Import>, ImportError> = import_bytes(Path::new("clip.bvh"), text.as_bytes());
    imports.unwrap_or_else(|error| panic!("{error}")).remove(0).outcome
}

/// The written walker with other numbers in every row, by frame; the first three are the root's place.
fn rows(edit: impl Fn(usize, &mut Vec<f64>)) -> String {
    let text = bvh_text();
    let start = text.find("Frame Time").and_then(|at| Some(at + text[at..].find('\n')? + 1)).unwrap();
    let mut edited = text[..start].to_owned();
    for (frame, line) in text[start..].lines().enumerate() {
        let mut row: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        edit(frame, &mut row);
        edited += &row.iter().map(f64::to_string).collect::<Vec<String>>().join(" ");
        edited.push('\n');
    }
    edited
}

#[track_caller]
fn check_told(text: &str, words: &str) {
    let warnings = imported(text).unwrap_or_else(|refusal| panic!("{refusal}")).source.warnings;
    assert!(warnings.iter().any(|warning| warning.text.contains(words)), "{warnings:?} do not say {words:?}");
}

#[track_caller]
fn check_refused(text: &str, words: &str) {
    let refusal = imported(text).err().map(|refusal| refusal.to_string()).unwrap_or_default();
    assert!(refusal.contains(words), "{refusal:?} does not say {words:?}");
}

#[test]
fn what_moves_a_body_beside_its_feet_on_level_ground_is_told() {
    // 12 cm a step of 60 cm, up and down.
    check_told(&rows(|frame, row| row[1] += 0.8 * frame as f64), "not level: the body climbs");
    check_told(&rows(|frame, row| row[1] -= 0.8 * frame as f64), "not level: the body descends");
    let still = |row: &mut Vec<f64>| row[3..].fill(0.0);
    check_told(&rows(|_, row| still(row)), "without a step, its feet slide over the ground at 1.2 m/s");
    let turned = |frame: usize, row: &mut Vec<f64>| {
        still(row);
        (row[2], row[5]) = (0.0, 3.0 * frame as f64);
    };
    check_told(&rows(turned), "90 °/s without a step");
    let jumped = |frame: usize, row: &mut Vec<f64>| {
        still(row);
        row[2] = 0.0;
        row[1] += 40.0 * (0.3 * frame as f64).sin().max(0.0);
    };
    check_told(&rows(jumped), "both feet leave the ground together, by 4");
    let leapt = rows(|frame, row| row[2] += if frame < 20 { 0.0 } else { 300.0 });
    check_told(&leapt, "the body leaps by 3.0 m from frame 20 to the next: its mean speeds");
}

#[test]
fn what_editors_and_exporters_leave_after_the_last_row_is_no_motion() {
    for rest in ["\n# exported by 1.2\nEND OF FILE\n", "\u{1a}", "\0\0\0\0"] {
        check_told(&format!("{}{rest}", bvh_text()), "what follows the motion is not used");
    }
    let early = bvh_text().replace("Frames: ", "Frames: 9") + "END OF FILE\n";
    assert!(import_bytes(Path::new("clip.bvh"), early.as_bytes()).is_err());
}

#[test]
fn a_walk_at_twice_its_rate_is_told_by_its_cadence_and_a_jog_is_not() {
    let said = |clip: &str, rate: f64| {
        let path =
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips")).join(clip).with_extension("bvh");
        let settings = Settings { frame_rate_hz: Some(30.0 * rate), ..Settings::default() };
        let human = import_take(&Take { settings, ..Take::from(path) }).unwrap().remove(0).outcome.unwrap();
        human.source.warnings.iter().any(|remark| remark.kind == Kind::FrameTime)
    };
    // 133 steps a minute; a walk at twice fewer than 107 goes as race walkers do.
    assert_eq!([said("walk_180", 1.0), said("walk_180", 2.0)], [false, true]);
    assert!(!said("jog_240", 1.0) && !said("run_350", 1.0));
}

#[test]
fn thighs_of_who_stands_on_straight_knees_are_not_turned_by_what_these_give_back_or_aside() {
    for (back_deg, aside_deg) in [(0.0, 0.0), (4.0, 0.0), (8.0, 0.0), (-4.0, 0.0), (0.0, 5.0), (2.0, -5.0)] {
        let text = rows(|frame, row| {
            row[2] = 0.01 * frame as f64;
            row[3..].fill(0.0);
            for knee in [2, 6] {
                (row[3 + 3 * knee], row[3 + 3 * knee + 1]) = (aside_deg, back_deg);
            }
        });
        let human = imported(&text).unwrap_or_else(|refusal| panic!("{refusal}"));
        for thigh in Joint::THIGHS {
            let turned_deg = human.frames[0].rotations[thigh.index()].to_scaled_axis().z.to_degrees();
            assert!(
                turned_deg.abs() < 30.0,
                "{back_deg}° back, {aside_deg}° aside: {thigh:?} turned by {turned_deg:.0}°"
            );
        }
    }
}

#[test]
fn a_name_that_stands_twice_does_not_hide_a_body() {
    let text = bvh_text().replace("LeftLeg", "RightLeg");
    let speed_mps = imported(&text).unwrap_or_else(|refusal| panic!("{refusal}")).source.speed_mps;
    assert!((speed_mps - 1.2).abs() < 0.01, "{speed_mps}");
}

#[test]
fn a_duet_under_one_root_is_refused_with_both_names() {
    let text = bvh_text();
    let (hierarchy, motion) = text.split_once("MOTION").unwrap();
    let body = hierarchy.strip_prefix("HIERARCHY\n").unwrap();
    let person = |name: &str| body.replacen("ROOT Hips", &format!("JOINT {name}"), 1);
    let (frames, rows) = motion.split_at(motion.find("0.0333333333").unwrap() + "0.0333333333\n".len());
    let both: String = rows.lines().map(|row| format!("0 0 0 0 0 0 {row} {row}\n")).collect();
    let duet = format!(
        "HIERARCHY\nROOT World\n{{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation \
         Yrotation\n{}{}}}\nMOTION{frames}{both}",
        person("HipsA"),
        person("HipsB").replace("OFFSET 0 92 0", "OFFSET 80 92 0"),
    );
    check_refused(&duet, "two bodies under one root, `HipsA` and `HipsB`");
}

#[test]
fn a_body_without_ankles_is_told_what_its_legs_seem_to_be() {
    // A row begins with the root's place; each joint has three numbers.
    let mut footless = rows(|_, row| {
        row.drain(3 + 3 * 7..3 + 3 * 9);
        row.drain(3 + 3 * 3..3 + 3 * 5);
    });
    for foot in ["JOINT LeftFoot", "JOINT RightFoot"] {
        let start = footless.find(foot).unwrap();
        let end = start + footless[start..].find("}\n}\n").unwrap() + "}\n}\n".len();
        footless.replace_range(start..end, "");
    }
    check_refused(&footless, "beside its seeming legs, `Left Arm` to `LeftHand` and `Right Arm` to `RightHand`");
}

#[test]
fn a_file_of_positions_alone_is_refused() {
    let clip = motiondb_compiler::bvh::read(Path::new("clip.bvh"), bvh_text().as_bytes()).unwrap();
    let text = bvh_text();
    let (hierarchy, _) = text.split_once("MOTION").unwrap();
    let channels = |line: &str| match line.split_whitespace().next() {
        Some("CHANNELS") => "CHANNELS 3 Xposition Yposition Zposition\n".to_owned(),
        _ => format!("{line}\n"),
    };
    let mut positions: String = hierarchy.lines().map(channels).collect();
    positions += &format!("MOTION\nFrames: {}\nFrame Time: 0.0333333\n", clip.frame_count());
    let real: Vec<usize> = (0..clip.joints.len()).filter(|&joint| !clip.joints[joint].is_end).collect();
    for frame in 0..clip.frame_count() {
        for &joint in &real {
            let from = clip.joints[joint].parent.map_or(glam::DVec3::ZERO, |parent| clip.position(frame, parent));
            let local = clip.position(frame, joint) - from;
            positions += &format!("{} {} {} ", local.x, local.y, local.z);
        }
        positions.push('\n');
    }
    check_refused(&positions, "no joint turns");
}

#[test]
fn a_forward_axis_to_the_side_of_the_body_is_refused() {
    let folder = std::env::temp_dir().join(format!("fbcrowd_forward_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("walk.bvh");
    std::fs::write(&path, bvh_text()).unwrap();
    let outcome = |forward: &str| {
        let forward = Some(Axis::try_from(forward.to_owned()).unwrap());
        let settings = Settings { forward, ..Settings::default() };
        import_take(&Take { settings, ..Take::from(path.clone()) }).unwrap().remove(0).outcome
    };
    assert!(outcome("+Z").is_ok() && outcome("-Z").is_ok());
    for sideways in ["+X", "-X"] {
        let refusal = outcome(sideways).unwrap_err().to_string();
        assert!(refusal.contains("the body faces +Z or -Z, not"), "{refusal}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn what_is_no_text_of_its_format_is_told_by_its_first_bytes() {
    let check = |file: &str, bytes: &[u8], words: &str| {
        let message = import_bytes(Path::new(file), bytes).unwrap_err().to_string();
        assert!(message.contains(words), "{file}: {message}");
    };
    let wide: Vec<u8> = [0xff, 0xfe].into_iter().chain(bvh_text().encode_utf16().flat_map(u16::to_le_bytes)).collect();
    check("walk.bvh", &wide, "UTF-16");
    check("walk.bvh", &wide[2..], "UTF-16");
    check("walk.bvh", b"", "the file is empty");
    check("walk.gltf", &wide, "UTF-16");
    check("walk.gltf", &wide[2..], "UTF-16");
    check("walk.glb", b"", "the file is empty");
    check("walk.glb", b"PK\x03\x04....", "a zip archive");
    check("walk.glb", b"glTF\x02\0\0\0\xff\0\0\0....", "cut short: 16 of 255 bytes");
}
