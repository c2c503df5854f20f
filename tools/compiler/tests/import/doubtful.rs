//! Doubtful files of human bodies: each is rejected or reported with what was measured in it.

use std::path::Path;

use motiondb::body::Joint;
use motiondb::diagnostic::{ClipEnd, Diagnostic, Note, Unfit, Warning};
use motiondb_compiler::{Axis, ClipSettings, RejectionReason, import_bytes, import_with_settings};

use super::written_body::bvh_text;

fn imported(text: &str) -> Result<super::HumanClip, RejectionReason> {
    let imports = import_bytes(Path::new("clip.bvh"), text.as_bytes());
    imports.unwrap_or_else(|rejection| panic!("{rejection}")).remove(0).outcome
}

/// The written walker with edited rows. The first three numbers of a row are the root's position.
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
fn diagnostics(text: &str) -> Vec<Diagnostic> {
    imported(text).unwrap_or_else(|reason| panic!("{reason}")).source.diagnostics
}

/// The only warning of a file.
#[track_caller]
fn warning(text: &str) -> Warning {
    let [Diagnostic::Warning(warning)] = &diagnostics(text)[..] else { panic!("{:?}", diagnostics(text)) };
    warning.clone()
}

#[track_caller]
fn check_rejected(text: &str, expected: &RejectionReason) {
    assert_eq!(imported(text).err().as_ref(), Some(expected));
}

#[test]
fn bodies_not_carried_by_level_ground_are_reported() {
    // 12 cm for each step of 60 cm, up and down; over a step and a quarter, feet show it roughly.
    for sign in [1.0, -1.0] {
        let slope = warning(&rows(|frame, row| row[1] += 0.8 * sign * frame as f64));
        let is_steep = |rise_cm: f32| (rise_cm * sign as f32 - 12.0).abs() < 3.0;
        assert!(matches!(slope, Warning::Slope { rise_cm } if is_steep(rise_cm)), "{slope:?}");
    }
    let still = |row: &mut Vec<f64>| row[3..].fill(0.0);
    let skating = warning(&rows(|_, row| still(row)));
    let is_at = |slide_mps: f32| (slide_mps - 1.2).abs() < 0.05;
    assert!(matches!(skating, Warning::Skating { slide_mps, steps: false, .. } if is_at(slide_mps)), "{skating:?}");
    // A body that stands, sways a little and slides is not a gait in radians.
    let swaying = |frame: usize, row: &mut Vec<f64>| {
        still(row);
        row[30..33].fill(1.5 * libm::sin(0.1 * frame as f64));
    };
    let slides = warning(&rows(swaying));
    assert!(matches!(slides, Warning::Skating { steps: false, .. }), "{slides:?}");
    let turned = |frame: usize, row: &mut Vec<f64>| {
        still(row);
        (row[2], row[5]) = (0.0, 3.0 * frame as f64);
    };
    let turns = warning(&rows(turned));
    let is_at = |turn_rate_rad_s: f32| (turn_rate_rad_s.to_degrees() - 90.0).abs() < 0.5;
    assert!(matches!(turns, Warning::TurnWithoutStep { turn_rate_rad_s } if is_at(turn_rate_rad_s)), "{turns:?}");
    let jumped = |frame: usize, row: &mut Vec<f64>| {
        still(row);
        row[2] = 0.0;
        row[1] += 40.0 * libm::sin(0.3 * frame as f64).max(0.0);
    };
    let jump = warning(&rows(jumped));
    assert!(matches!(jump, Warning::Jump { lift_cm } if (39.0..=41.0).contains(&lift_cm)), "{jump:?}");
    let leapt = rows(|frame, row| row[2] += if frame < 20 { 0.0 } else { 300.0 });
    let leap = warning(&leapt);
    let is_3_m = |distance_m: f32| (distance_m - 3.0).abs() < 0.1;
    assert!(matches!(leap, Warning::Leap { distance_m, frame: 20, more: 0 } if is_3_m(distance_m)), "{leap:?}");
}

#[test]
fn radians_are_reported() {
    let found = warning(&rows(|_, row| row[3..].iter_mut().for_each(|angle| *angle = angle.to_radians())));
    assert!(matches!(found, Warning::RadiansLikely { turned_rad } if turned_rad.to_degrees() < 1.5), "{found:?}");
}

/// A bundled clip of which each frame occurs so many times.
fn with_frames(clip: &str, times: impl Fn(usize) -> usize) -> String {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips"));
    let text = std::fs::read_to_string(folder.join(clip).with_extension("bvh")).unwrap();
    let start = text.find("Frame Time").and_then(|at| Some(at + text[at..].find('\n')? + 1)).unwrap();
    let rows: Vec<&str> =
        text[start..].lines().enumerate().flat_map(|(frame, row)| std::iter::repeat_n(row, times(frame))).collect();
    let count_at = text.find("Frames:").unwrap();
    let count_end = count_at + text[count_at..].find('\n').unwrap();
    let head = format!("{}Frames: {}{}", &text[..count_at], rows.len(), &text[count_end..start]);
    head + &rows.join("\n") + "\n"
}

#[test]
fn dropped_frames_are_reported() {
    let share = |clip: &str, times: &dyn Fn(usize) -> usize| {
        diagnostics(&with_frames(clip, times)).into_iter().find_map(|found| match found {
            Diagnostic::Warning(Warning::FramesDropped { share }) => Some(share),
            _ => None,
        })
    };
    for clip in ["walk_110", "turn_090_left", "run_350"] {
        let dropped = share(clip, &|frame| usize::from(frame % 7 != 3)).unwrap_or_default();
        assert!((dropped - 1.0 / 7.0).abs() < 0.02, "{clip}: {dropped}");
        // Frames that are repeated, as of a film at 24 Hz played at 30, keep the time.
        for times in [&|_| 1, &|frame| 1 + usize::from(frame % 4 == 0), &|_| 2] as [&dyn Fn(usize) -> usize; 3] {
            assert_eq!(share(clip, times), None, "{clip}");
        }
        let found = diagnostics(&with_frames(clip, |_| 2));
        let is_half = |found: &Diagnostic| match found {
            Diagnostic::Warning(Warning::FramesRepeated { share }) => (share - 0.5).abs() < 0.01,
            _ => false,
        };
        assert!(found.iter().any(is_half), "{clip}: {found:?}");
    }
    assert_eq!(share("idle", &|frame| usize::from(frame % 7 != 3)), None);
}

/// A bundled clip in place; its angles are in radians where `is_in_radians`.
fn in_place(clip: &str, is_in_radians: bool) -> String {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips"));
    let text = std::fs::read_to_string(folder.join(clip).with_extension("bvh")).unwrap();
    let start = text.find("Frame Time").and_then(|at| Some(at + text[at..].find('\n')? + 1)).unwrap();
    let channels =
        text[..start].split_whitespace().filter(|word| word.ends_with("position") || word.ends_with("rotation"));
    let channels: Vec<&str> = channels.collect();
    let first: Vec<f64> =
        text[start..].lines().next().unwrap().split_whitespace().map(|word| word.parse().unwrap()).collect();
    let mut edited = text[..start].to_owned();
    for line in text[start..].lines() {
        let values = line.split_whitespace().zip(&channels).zip(&first).map(|((word, channel), first)| {
            let value: f64 = word.parse().unwrap();
            match *channel {
                "Xposition" | "Zposition" => *first,
                "Yposition" => value,
                _ if is_in_radians => value.to_radians(),
                _ => value,
            }
        });
        edited += &values.map(|value| value.to_string()).collect::<Vec<String>>().join(" ");
        edited.push('\n');
    }
    edited
}

#[test]
fn radians_of_clips_in_place_are_reported() {
    let is_reported = |text: &str| {
        let is_radians = |found: &Diagnostic| matches!(found, Diagnostic::Warning(Warning::RadiansLikely { .. }));
        diagnostics(text).iter().any(is_radians)
    };
    for clip in ["walk_050", "walk_080", "walk_110", "walk_180", "run_350", "backward_040", "turn_060_left"] {
        assert!(is_reported(&in_place(clip, true)), "{clip}");
        assert!(!is_reported(&in_place(clip, false)), "{clip}");
    }
    assert!(!is_reported(&in_place("idle", false)));
}

#[test]
fn a_frozen_clip_is_reported() {
    assert_eq!(warning(&rows(|_, row| row.fill(0.0))), Warning::PoseFrozen);
}

#[test]
fn frozen_ends_are_not_motion() {
    let text = bvh_text();
    let (head, motion) = text.split_at(text.find("Frames: ").unwrap());
    let lines: Vec<&str> = motion.lines().collect();
    let (first, last, count) = (lines[2], lines[lines.len() - 1], lines.len() - 2);
    let padded = |before: usize, after: usize| {
        let rows = [vec![first; before], lines[2..].to_vec(), vec![last; after]].concat();
        format!("{head}Frames: {}\n{}\n{}\n", rows.len(), lines[1], rows.join("\n"))
    };
    let imported = |before: usize, after: usize| imported(&padded(before, after)).unwrap();
    // Half a second at 30 Hz stays.
    assert_eq!(imported(0, 15).frames.len(), count + 15);
    let long = imported(90, 60);
    assert_eq!(long.frames.len(), count + 30);
    let cut = |frames: u32, end: ClipEnd| Diagnostic::Note(Note::HeldPoseCut { frames, end });
    assert_eq!(long.source.diagnostics, [cut(75, ClipEnd::First), cut(45, ClipEnd::Last)]);
}

#[test]
fn text_after_the_last_row_is_not_motion() {
    for rest in ["\n# exported by 1.2\nEND OF FILE\n", "\u{1a}", "\0\0\0\0"] {
        let found = diagnostics(&format!("{}{rest}", bvh_text()));
        assert!(matches!(found[..], [Diagnostic::Note(Note::TextAfterMotion { .. })]), "{rest:?}: {found:?}");
    }
    let early = bvh_text().replace("Frames: ", "Frames: 9") + "END OF FILE\n";
    assert!(import_bytes(Path::new("clip.bvh"), early.as_bytes()).is_err());
}

#[test]
fn comments_before_the_rows_do_not_matter() {
    let plain = imported(&bvh_text()).unwrap();
    let text = bvh_text().replace("HIERARCHY", "# exported by 1.2\n\n// rig 3\nHIERARCHY");
    let text = text.replace("MOTION", "  # motion\nMOTION\n// 40 rows").replace("Frame Time", "# time\nFrame Time");
    assert_eq!(imported(&text).unwrap().frames, plain.frames);
}

#[test]
fn a_walk_at_twice_its_rate_is_inhuman() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips"));
    let is_inhuman = |clip: &str, rate: f64| {
        let path = folder.join(clip).with_extension("bvh");
        let settings = ClipSettings { frame_rate_hz: Some(30.0 * rate), ..ClipSettings::from(path) };
        let human = import_with_settings(&settings).unwrap().remove(0).outcome.unwrap();
        matches!(human.unfit, Some(Unfit::InhumanGait { .. }))
    };
    // walk_180 has 133 steps a minute. Race walkers take up to 210.
    assert_eq!([is_inhuman("walk_180", 1.0), is_inhuman("walk_180", 2.0)], [false, true]);
    assert!(!is_inhuman("jog_240", 1.0) && !is_inhuman("run_350", 1.0));
}

/// A slow walk in inches, whose numbers would be a small child's in centimetres, at a multiple of its frame rate.
fn slow_walk_in_inches(rate: f64) -> Vec<Diagnostic> {
    let text = include_str!("../../../../assets/clips/walk_050.bvh");
    let (skeleton, motion) = text.split_at(text.find("MOTION").unwrap());
    let inches = |word: &str| word.parse::<f64>().map_or(word.to_owned(), |number| (number / 2.54).to_string());
    let offsets = skeleton.lines().map(|line| match line.trim_start().strip_prefix("OFFSET") {
        Some(numbers) => format!("OFFSET {}\n", numbers.split_whitespace().map(inches).collect::<Vec<_>>().join(" ")),
        None => format!("{line}\n"),
    });
    let rows = motion.lines().enumerate().map(|(line, row)| match line {
        0 | 1 => format!("{row}\n"),
        2 => format!("Frame Time: {}\n", 1.0 / (30.0 * rate)),
        _ => {
            let words: Vec<&str> = row.split(' ').collect();
            let root: Vec<String> = words[..3].iter().map(|word| inches(word)).collect();
            format!("{} {}\n", root.join(" "), words[3..].join(" "))
        }
    });
    diagnostics(&offsets.chain(rows).collect::<String>())
}

#[test]
fn a_walk_in_inches_is_doubtful_at_any_frame_time() {
    // Its leg in centimetres is 0.33 m long. At six times its rate the walk is taken for one of that size.
    for (rate, other_is_inch) in [(1.0, false), (2.0, false), (4.0, false), (6.0, true), (10.0, false)] {
        let found = slow_walk_in_inches(rate);
        let other_unit_m = found.iter().find_map(|found| match found {
            Diagnostic::Warning(Warning::UnitDoubtful { other_unit_m, .. }) => Some(*other_unit_m),
            _ => None,
        });
        assert_eq!(other_unit_m, Some(if other_is_inch { 0.0254 } else { 0.01 }), "{rate}: {found:?}");
    }
}

#[test]
fn straight_knees_do_not_turn_the_thighs() {
    for (back_deg, aside_deg) in [(0.0, 0.0), (4.0, 0.0), (8.0, 0.0), (-4.0, 0.0), (0.0, 5.0), (2.0, -5.0)] {
        let text = rows(|frame, row| {
            row[2] = 0.01 * frame as f64;
            row[3..].fill(0.0);
            for knee in [2, 6] {
                (row[3 + 3 * knee], row[3 + 3 * knee + 1]) = (aside_deg, back_deg);
            }
        });
        let human = imported(&text).unwrap_or_else(|reason| panic!("{reason}"));
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
fn a_repeated_name_does_not_hide_a_body() {
    let text = bvh_text().replace("LeftLeg", "RightLeg");
    let speed_mps = imported(&text).unwrap_or_else(|reason| panic!("{reason}")).source.speed_mps;
    assert!((speed_mps - 1.2).abs() < 0.01, "{speed_mps}");
}

#[test]
fn a_duet_is_rejected_with_both_names() {
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
    check_rejected(&duet, &RejectionReason::TwoBodies { first: "HipsA".into(), second: "HipsB".into() });
}

#[test]
fn a_body_without_ankles_has_no_legs() {
    // A row begins with the root's position; each joint has three numbers.
    let mut footless = rows(|_, row| {
        row.drain(3 + 3 * 7..3 + 3 * 9);
        row.drain(3 + 3 * 3..3 + 3 * 5);
    });
    for foot in ["JOINT LeftFoot", "JOINT RightFoot"] {
        let start = footless.find(foot).unwrap();
        let end = start + footless[start..].find("}\n}\n").unwrap() + "}\n}\n".len();
        footless.replace_range(start..end, "");
    }
    check_rejected(&footless, &RejectionReason::NoLegs);
    // Without names the arms seem to be the legs.
    let (mut unnamed, mut joint) = (String::new(), 0);
    for line in footless.lines() {
        let indent = &line[..line.len() - line.trim_start().len()];
        match line.trim_start().strip_prefix("JOINT ") {
            Some(_) => {
                joint += 1;
                unnamed += &format!("{indent}JOINT j{joint}\n");
            }
            None => unnamed += &format!("{line}\n"),
        }
    }
    let clip = import_bytes(Path::new("clip.bvh"), unnamed.as_bytes()).unwrap().remove(0);
    assert!(matches!(clip.outcome, Err(RejectionReason::NoArms { .. })), "{:?}", clip.outcome.err());
}

#[test]
fn a_file_of_positions_alone_is_rejected() {
    let clip = motiondb_compiler::read::bvh::read(Path::new("clip.bvh"), bvh_text().as_bytes()).unwrap();
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
    check_rejected(&positions, &RejectionReason::NoRotations);
}

#[test]
fn a_sideways_forward_axis_is_rejected() {
    let folder = std::env::temp_dir().join(format!("fbcrowd_forward_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("walk.bvh");
    std::fs::write(&path, bvh_text()).unwrap();
    let outcome = |forward: &str| {
        let forward = Some(Axis::try_from(forward.to_owned()).unwrap());
        let settings = ClipSettings { forward, ..ClipSettings::from(path.clone()) };
        import_with_settings(&settings).unwrap().remove(0).outcome
    };
    assert!(outcome("+Z").is_ok() && outcome("-Z").is_ok());
    for sideways in ["+X", "-X"] {
        let reason = outcome(sideways).unwrap_err().to_string();
        assert!(reason.contains("the body faces +Z or -Z, not"), "{reason}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn other_formats_are_reported_by_their_first_bytes() {
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
