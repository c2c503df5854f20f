//! Styles through the built binary: from folders of clips to a crowd in which two styles walk side by side.

mod support;

#[path = "../tools/compiler/tests/extra_joints/hands.rs"]
#[allow(dead_code, reason = "the compiler's tests use all of it")]
mod hands;

use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_sim::planning::PlanExplanation;
use fbcrowd_sim::recording::{Recording, Replay};
use fbcrowd_sim::scenario::Scenario;
use motiondb::body::{ExtraJoint, Side};
use motiondb::files::database_file;
use support::{check_schema, fbcrowd, folder, mocap, repository, text};

/// A folder with bundled clips, each at a path of its own.
fn clips(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = folder(name).join("clips");
    for (clip, path) in files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::copy(repository().join("assets/clips").join(clip), path).unwrap();
    }
    folder
}

/// Neutral clips, and two slow walks of an elderly body.
fn styled(name: &str) -> PathBuf {
    clips(
        name,
        &[
            ("walk_080.bvh", "neutral/slow_walk.bvh"),
            ("walk_110.bvh", "neutral/walk.bvh"),
            ("walk_140.glb", "neutral/fast_walk.glb"),
            ("turn_060_left.bvh", "neutral/turn.bvh"),
            ("idle.bvh", "neutral/idle.bvh"),
            ("walk_050.bvh", "elderly/walk.bvh"),
            ("walk_080.bvh", "elderly/fast_walk.bvh"),
        ],
    )
}

fn compile(clips: &Path) -> PathBuf {
    let database = clips.with_file_name("motion.fbdb");
    fbcrowd(&["compile", text(clips), "-o", text(&database)]).expect_code(0);
    database
}

#[test]
fn folders_become_styles() {
    let clips = styled("folders");
    let database = clips.with_file_name("motion.fbdb");
    let report = fbcrowd(&["compile", text(&clips), "-o", text(&database), "--json"]).expect_code(0).json();
    let styles: Vec<&str> =
        report["styles"].as_array().unwrap().iter().map(|style| style["style"].as_str().unwrap()).collect();
    assert_eq!(styles, ["neutral", "elderly"]);
    assert_eq!(report["styles"][1]["idle_of"], "neutral");
    assert_eq!(report["used"].as_array().unwrap().len(), 7, "{report}");
    fbcrowd(&["validate", text(&database)]).expect_code(0);
    let inspected = fbcrowd(&["inspect", text(&database), "--style", "elderly", "--json"]).expect_code(0).json();
    let names: Vec<&str> =
        inspected["examples"].as_array().unwrap().iter().map(|example| example["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["elderly fast_walk", "elderly walk", "idle"]);
    fbcrowd(&["inspect", text(&database), "--style", "eldrly"]).expect_code(2).says(&["eldrly", "elderly, neutral"]);
    let plots = clips.with_file_name("plots");
    fbcrowd(&["inspect", text(&database), "--plots", text(&plots)]).expect_code(0);
    assert!(plots.join("contact_sheet.png").is_file() && plots.join("elderly/contact_sheet.png").is_file());
}

#[test]
fn one_style_alone_and_unknown_ones() {
    let clips = styled("alone");
    let database = clips.with_file_name("motion.fbdb");
    let compile = |style: &str| fbcrowd(&["compile", text(&clips), "-o", text(&database), "--style", style]);
    compile("tired").expect_code(2).says(&["no style `tired`", "neutral, elderly"]);
    compile("elderly").expect_code(0);
    let (db, _) = database_file::load(&database).unwrap();
    assert_eq!(db.styles().map(|db| db.style.as_str()).collect::<Vec<_>>(), ["elderly"]);
    assert_eq!(db.sources.len(), 2);
}

#[test]
fn a_manifest_states_and_removes_styles() {
    let clips = styled("manifest");
    let with = |manifest: &str| {
        fs::write(clips.join("manifest.toml"), manifest).unwrap();
        let (db, _) = database_file::load(&compile(&clips)).unwrap();
        db.styles().map(|db| (db.style.clone(), db.sources.len())).collect::<Vec<_>>()
    };
    assert_eq!(with("[[clips]]\npath = '.'\nstyle = ''\n"), [(String::new(), 7)]);
    let stated = "[[clips]]\npath = '.'\nstyle = ''\n[[clips]]\npath = 'elderly'\nstyle = 'old'\n\
                  [[clips]]\npath = 'elderly/fast_walk.bvh'\nstyle = ''\n";
    assert_eq!(with(stated), [(String::new(), 6), ("old".to_owned(), 2)]);
    fs::write(clips.join("manifest.toml"), "[[clips]]\npath = '.'\nstyle = '../x'\n").unwrap();
    let database = clips.with_file_name("motion.fbdb");
    fbcrowd(&["compile", text(&clips), "-o", text(&database)]).expect_code(2).says(&["manifest.toml:3", "style"]);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn published_sets_have_their_styles() {
    let folder = folder("published");
    let found = |set: &str| {
        let (clips, database) = (mocap().join(set), folder.join(format!("{set}.fbdb")));
        fbcrowd(&["compile", text(&clips), "-o", text(&database)]).expect_code(0);
        fbcrowd(&["validate", text(&database)]).expect_code(0);
        let (db, _) = database_file::load(&database).unwrap();
        db.styles().map(|db| (db.style.clone(), db.correspondence.is_some())).collect::<Vec<_>>()
    };
    let wanted =
        |styles: &[(&str, bool)]| styles.iter().map(|(style, both)| ((*style).to_owned(), *both)).collect::<Vec<_>>();
    let bandai = [("normal", true), ("active", true), ("feminine", false), ("masculine", true), ("masculinity", true)];
    assert_eq!(found("bandai_namco"), wanted(&bandai));
    assert_eq!(found("xia"), wanted(&[("neutral", false), ("strutting", false)]));
    assert_eq!(found("games105").len(), 1);
}

/// A scenario of agents side by side, each with keys of its own.
fn scenario(database: &Path, name: &str, agents: &str) -> PathBuf {
    let path = database.with_file_name(format!("{name}.toml"));
    fs::write(&path, format!("database = 'motion.fbdb'\nduration_s = 8\n{agents}")).unwrap();
    path
}

#[test]
fn agents_walk_in_their_styles() {
    let database = compile(&styled("crowd"));
    let lanes = "[[agents]]\nat_m = [0, 0]\ngoals_m = [[20, 0]]\n\
                 [[agents]]\nat_m = [0, 3]\ngoals_m = [[20, 3]]\nstyle = 'elderly'\n\
                 [profiles.old]\nstyle = 'elderly'\n\
                 [[agents]]\nat_m = [0, 6]\ngoals_m = [[20, 6]]\nprofile = 'old'\n\
                 [[agents]]\nat_m = [0, 9]\ngoals_m = [[20, 9]]\nprofile = 'old'\nstyle = ''\n\
                 [[sources]]\nat_m = [0, -3]\ngoals_m = [[20, -3]]\nrate_per_s = 1\ncount = 1\nstyle = 'elderly'\n";
    let file = scenario(&database, "lanes", lanes);
    let recording = file.with_extension("fbrec");
    fbcrowd(&["check", text(&file)]).expect_code(0);
    fbcrowd(&["simulate", text(&file), "-o", text(&recording)]).expect_code(0);
    let opened = Recording::open(&recording).unwrap();
    let styles: Vec<&str> = opened.header().databases.iter().map(|database| database.style.as_str()).collect();
    assert_eq!(styles, ["", "elderly"]);
    let databases: Vec<u32> = opened.population().agents.iter().map(|life| life.database).collect();
    assert_eq!(databases, [0, 1, 1, 0, 1]);
    let (mut first, mut last) = (Vec::new(), Vec::new());
    opened.read_frame(90, &mut first).unwrap();
    opened.read_frame(opened.frame_count() - 1, &mut last).unwrap();
    let mps = |agent: usize| (last[agent].root.position_m.x - first[agent].root.position_m.x) / 5.0;
    for neutral in [0, 3] {
        assert!((mps(neutral) - 1.33).abs() < 0.1, "agent {neutral}: {} m/s", mps(neutral));
    }
    // The fastest elderly walk is one of 0.8 m/s.
    for elderly in [1, 2] {
        assert!((mps(elderly) - 0.8).abs() < 0.1, "agent {elderly}: {} m/s", mps(elderly));
    }
    // Planned again, each agent keeps the velocity sets of its style.
    let replay = Replay::new(&opened);
    let step = replay.step(200).unwrap();
    let Scenario { planner, params, .. } = &opened.header().scenario;
    for (agent, after) in step.after.iter().enumerate() {
        let plan = PlanExplanation::new(*planner, &step.world(), agent, params).plan;
        let off_mps = plan.velocity_mps.distance(after.planned_mps);
        assert!(off_mps < 0.01, "agent {agent}: {off_mps} m/s");
    }
    fbcrowd(&["measure", text(&recording)]).expect_code(0);
    let frames = file.with_file_name("frames");
    fbcrowd(&[
        "render",
        text(&recording),
        "-o",
        text(&frames),
        "--overlay",
        "constraints",
        "--agent",
        "1",
        "--frames",
        "1060-1061",
    ])
    .expect_code(0);
}

/// The neutral clips have fingers, the elderly ones have none: their bodies hold the mean.
#[test]
fn all_styles_have_the_same_extra_joints() {
    let folder = folder("finger_styles");
    for (clip, path) in [("walk_110", "neutral/walk"), ("idle", "neutral/idle"), ("walk_080", "neutral/slow")] {
        let path = folder.join("clips").join(format!("{path}.bvh"));
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, hands::text_with_hands(clip, &hands::both(|_, _| 30.0))).unwrap();
    }
    for (clip, path) in [("walk_050", "elderly/walk"), ("walk_080", "elderly/fast_walk")] {
        let path = folder.join("clips").join(format!("{path}.bvh"));
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::copy(repository().join("assets/clips").join(format!("{clip}.bvh")), path).unwrap();
    }
    let database = compile(&folder.join("clips"));
    let (db, _) = database_file::load(&database).unwrap();
    assert_eq!(db.further_styles.len(), 1);
    for style in db.styles() {
        assert_eq!(style.extra.bones, db.extra.bones);
    }
    let lanes = "[[agents]]\nat_m = [0, 0]\ngoals_m = [[20, 0]]\n\
                 [[agents]]\nat_m = [0, 3]\ngoals_m = [[20, 3]]\nstyle = 'elderly'\n";
    let recording = database.with_file_name("lanes.fbrec");
    fbcrowd(&["simulate", text(&scenario(&database, "lanes", lanes)), "-o", text(&recording)]).expect_code(0);
    let opened = Recording::open(&recording).unwrap();
    let mut rotations = Vec::new();
    opened.read_extra(200, &mut rotations).unwrap();
    assert_eq!(rotations.len(), 2 * 30);
    let knuckle = ExtraJoint::finger(Side::Left, 1, 0).name();
    let at = opened.header().extra_joints.iter().position(|joint| joint.name == knuckle).unwrap();
    for (agent, rotations) in rotations.chunks_exact(30).enumerate() {
        let curl_deg = rotations[at].to_axis_angle().1.to_degrees();
        assert!((curl_deg - 30.0).abs() < 1.0, "agent {agent}: {curl_deg}°");
    }
    let measures = fbcrowd(&["measure", text(&recording), "--json"]).expect_code(0).json();
    check_schema("measure", &measures);
    assert_eq!(measures["extra_joints"].as_array().unwrap().len(), 30);
    assert_eq!(measures["extra_joints"][at], knuckle);
    let shown = fbcrowd(&["measure", text(&recording)]).expect_code(0).stdout;
    assert!(shown.contains("30 beside the 22 roles: left_thumb_1 … right_little_3"), "{shown}");
}

#[test]
fn an_unknown_style_is_shown_at_its_line() {
    let database = compile(&styled("unknown"));
    let file = scenario(&database, "wrong", "[[agents]]\nat_m = [0, 0]\ngoals_m = [[9, 0]]\nstyle = 'angry'\n");
    let recording = file.with_extension("fbrec");
    let run = database.with_file_name("run");
    for command in [
        &["check", text(&file)][..],
        &["simulate", text(&file), "-o", text(&recording)],
        &["run", text(&file), "-o", text(&run)],
    ] {
        fbcrowd(command).expect_code(2).says(&["wrong.toml:6", "angry", "elderly"]);
    }
    assert!(!recording.exists());
    let plain = database.with_file_name("plain.fbdb");
    let clip = repository().join("assets/clips/walk_110.bvh");
    fbcrowd(&["compile", text(&clip), "-o", text(&plain)]).expect_code(0);
    fbcrowd(&["simulate", text(&file), "--db", text(&plain), "-o", text(&recording)])
        .expect_code(2)
        .says(&["wrong.toml:6", "has none"]);
}
