//! Ends of the built binary that are no answer: wrong outputs, a machine that fails, signals. Exit codes 2, 3, 128 + n.

#![cfg(target_os = "linux")]

mod support;

use std::fs::{self, File};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use support::{WALK, compile, fbcrowd, files, folder, repository, scenario, text};

/// A scenario of one agent and some steps, and its recording.
fn recorded(test: &str) -> (PathBuf, PathBuf) {
    let folder = folder(test);
    compile(&[WALK.to_owned()], &folder);
    let agents = "agents = { at_m = [0, 0], goals_m = [[2, 0]] }\n";
    let scene = scenario(&folder, &format!("duration_s = 1.0\ndatabase = \"motion.fbdb\"\n{agents}"));
    let recording = folder.join("scene.fbrec");
    fbcrowd(&["simulate", &scene, "-o", text(&recording)]).expect_code(0);
    (folder, recording)
}

/// Runs a shell line; `$BIN` is the built binary.
fn shell(line: &str) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", line]).env("BIN", env!("CARGO_BIN_EXE_fbcrowd")).current_dir(repository());
    command
}

#[track_caller]
fn check_shell(line: &str, code: i32, words: &str) {
    let output = shell(line).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{line}\n{stderr}");
    assert!(stderr.contains(words), "`{words}` is missing from\n{stderr}");
}

#[test]
fn a_full_disk_ends_with_code_3() {
    let (folder, recording) = recorded("full_disk");
    let (recording, folder_text) = (text(&recording), text(&folder));
    check_shell(&format!("$BIN measure {recording} > /dev/full"), 3, "No output is complete.");
    let table = format!("--table {folder_text}/table.csv");
    check_shell(&format!("$BIN measure {recording} {table} > /dev/full"), 3, "Complete outputs: ");
    fs::remove_file(folder.join("table.csv")).unwrap();
    // Files of at most one block: enough for the trajectories, not for the table.
    let outputs = format!("--trajectories {folder_text}/paths.txt {table}");
    let limited = format!("trap '' XFSZ; ulimit -f 4; exec $BIN measure {recording} {outputs}");
    check_shell(&limited, 3, "paths.txt.");
    assert_eq!(files(&folder), ["motion.fbdb", "paths.txt", "scene.fbrec", "scene.toml"]);
}

#[test]
fn outputs_are_checked_before_work_begins() {
    let (folder, recording) = recorded("checked_first");
    let before = files(&folder);
    let (paths, missing) = (folder.join("paths.txt"), folder.join("no/table.csv"));
    let measure = |table: &Path, says: &str| {
        let arguments = ["measure", text(&recording), "--trajectories", text(&paths), "--table", text(table)];
        fbcrowd(&arguments).expect_code(2).says(&[says]);
    };
    measure(&missing, "table.csv");
    measure(Path::new("/dev/full"), "not a regular file");
    measure(&folder, "not a regular file");
    measure(&folder.join("n".repeat(256)), "too long");
    fs::create_dir(folder.join("scene.1003.png")).unwrap();
    fbcrowd(&["render", text(&recording), "-o", text(&folder)]).expect_code(2).says(&["scene.1003.png"]);
    fs::remove_dir(folder.join("scene.1003.png")).unwrap();
    fs::create_dir(folder.join("coverage.png")).unwrap();
    let database = folder.join("motion.fbdb");
    fbcrowd(&["inspect", text(&database), "--plots", text(&folder)]).expect_code(2).says(&["coverage.png"]);
    fs::remove_dir(folder.join("coverage.png")).unwrap();
    assert_eq!(files(&folder), before);
}

#[test]
fn a_read_only_output_is_refused() {
    let folder = folder("read_only");
    let database = compile(&[WALK.to_owned()], &folder);
    let mut permissions = fs::metadata(&database).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&database, permissions).unwrap();
    let before = fs::read(&database).unwrap();
    fbcrowd(&["compile", "assets/clips/run_350.bvh", "-o", text(&database)]).expect_code(2).says(&["read-only"]);
    assert!(fs::read(&database).unwrap() == before);
}

#[test]
fn a_cache_that_is_a_file_is_refused() {
    let folder = folder("cache_is_file");
    fs::write(folder.join("cache"), "notes").unwrap();
    let (database, cache) = (folder.join("a.fbdb"), folder.join("cache"));
    let arguments = ["compile", WALK, "-o", text(&database), "--cache", text(&cache)];
    fbcrowd(&arguments).expect_code(2).says(&[text(&cache), "name another folder"]);
    assert!(!database.exists());
}

#[test]
fn other_formats_are_named() {
    let folder = folder("other_formats");
    let clip = folder.join("walk.fbx");
    fs::write(&clip, b"Kaydara FBX Binary  \0\x1a\0").unwrap();
    for command in [&["inspect", text(&clip)][..], &["compile", text(&clip), "-o", text(&folder.join("a.fbdb"))]] {
        fbcrowd(command).expect_code(2).says(&["walk.fbx", "an FBX file", "glTF"]);
    }
}

#[test]
fn a_run_replaces_none_of_its_inputs() {
    let folder = folder("run_over_inputs");
    let database = compile(&[WALK.to_owned()], &folder);
    let agents = "agents = { file = \"trajectories.png\" }\n";
    let content = |database: &str| format!("duration_s = 0.1\ndatabase = \"{database}\"\n{agents}");
    fs::write(folder.join("trajectories.png"), "0 0 2 0\n").unwrap();
    let scene = scenario(&folder, &content("motion.fbdb"));
    let run = |scene: &str, says: &str| {
        let before = files(&folder);
        fbcrowd(&["run", scene, "-o", text(&folder)]).expect_code(2).says(&[says, "another output path"]);
        assert_eq!(files(&folder), before);
    };
    run(&scene, "trajectories.png");
    fs::rename(folder.join("trajectories.png"), folder.join("agents.txt")).unwrap();
    fs::copy(&database, folder.join("scene.fbrec")).unwrap();
    let content = content("scene.fbrec").replace("trajectories.png", "agents.txt");
    run(&scenario(&folder, &content), "scene.fbrec");
    let spelt_as_recording = folder.join("scene.fbrec");
    fs::write(&spelt_as_recording, content.replace("scene.fbrec", "motion.fbdb")).unwrap();
    run(text(&spelt_as_recording), "scene.fbrec");
    fs::create_dir(folder.join("frames")).unwrap();
    let frame = folder.join("frames/scene.1001.png");
    fs::write(&frame, content.replace("scene.fbrec", "../motion.fbdb").replace("agents.txt", "../agents.txt")).unwrap();
    fs::write(&frame, format!("name = \"scene\"\n{}", fs::read_to_string(&frame).unwrap())).unwrap();
    fs::remove_file(&spelt_as_recording).unwrap();
    run(text(&frame), "scene.1001.png");
}

#[test]
fn a_picture_replaces_no_recording() {
    let (folder, recording) = recorded("over_its_recording");
    let picture = folder.join("scene.1002.png");
    fs::rename(&recording, &picture).unwrap();
    let before = fs::read(&picture).unwrap();
    fbcrowd(&["render", text(&picture), "-o", text(&folder)]).expect_code(2).says(&["scene.1002.png"]);
    assert!(fs::read(&picture).unwrap() == before);
    assert_eq!(files(&folder), ["motion.fbdb", "scene.1002.png", "scene.toml"]);
}

#[test]
fn two_outputs_are_not_links_to_one_file() {
    let (folder, recording) = recorded("two_links");
    let [one, other] = ["one", "other"].map(|name| folder.join(name));
    symlink("file", &one).unwrap();
    symlink("file", &other).unwrap();
    let arguments = ["measure", text(&recording), "--table", text(&one), "--trajectories", text(&other)];
    fbcrowd(&arguments).expect_code(2).says(&["both trajectories and table"]);
}

#[test]
fn a_folder_has_one_run_at_a_time() {
    let folder = folder("one_run");
    compile(&[WALK.to_owned()], &folder);
    let agents = "agents = { at_m = [0, 0], goals_m = [[2, 0]] }\n";
    let scene = scenario(&folder, &format!("duration_s = 0.1\ndatabase = \"motion.fbdb\"\n{agents}"));
    let out = folder.join("out");
    fs::create_dir(&out).unwrap();
    let lock = File::open(&out).unwrap();
    lock.lock().unwrap();
    let run = || fbcrowd(&["run", &scene, "-o", text(&out)]);
    run().expect_code(3).says(&["another fbcrowd writes", "No output is complete."]);
    assert_eq!(files(&out), [""; 0]);
    // Not by closing: a process that another test starts holds a copy of the file for a moment.
    lock.unlock().unwrap();
    run().expect_code(0);
}

#[test]
fn an_unexpected_file_is_not_quoted() {
    let folder = folder("secrets");
    let secret = folder.join("secret");
    let check = |arguments: &[&str]| {
        let outcome = fbcrowd(arguments).expect_code(2);
        assert!(!outcome.stderr.contains("hunter2"), "{}", outcome.stderr);
    };
    for content in ["root:hunter2:0:0\n", "hunter2 = 1\n", "[hunter2]\n", "= hunter2\n", "1 2 3 hunter2\n"] {
        fs::write(&secret, content).unwrap();
        fs::copy(&secret, folder.join("secret.toml")).unwrap();
        let agents = "duration_s = 0.1\nagents = { file = \"secret\" }\n";
        check(&["simulate", &scenario(&folder, agents), "-o", text(&folder.join("a.fbrec"))]);
        let named = text(&secret);
        check(&["simulate", named, "-o", text(&folder.join("a.fbrec"))]);
        check(&["compile", text(&folder.join("secret.toml")), "-o", text(&folder.join("a.fbdb"))]);
        for name in ["secret.bvh", "secret.gltf", "secret.glb"] {
            fs::copy(&secret, folder.join(name)).unwrap();
            check(&["compile", text(&folder.join(name)), "-o", text(&folder.join("a.fbdb"))]);
        }
    }
    fs::write(folder.join("agents.txt"), "0 0 2 0\n0 0 2 O\n").unwrap();
    let agents = "duration_s = 0.1\nagents = { file = \"agents.txt\" }\n";
    let scene = scenario(&folder, agents);
    fbcrowd(&["simulate", &scene, "-o", text(&folder.join("a.fbrec"))]).expect_code(2).says(&["`O` is not a number"]);
}

/// Starts `simulate` on an hour of a crowd, and waits until its temporary file is there.
fn started(folder: &Path, trap: &str) -> Child {
    let agents = "agents = { circle = { count = 200, radius_m = 30.0 } }\n";
    let scene = scenario(folder, &format!("duration_s = 3600\ndatabase = \"motion.fbdb\"\n{agents}"));
    let output = folder.join("scene.fbrec");
    let line = format!("{trap} exec $BIN simulate {scene} -o {}", text(&output));
    let child = shell(&line).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    while !files(folder).iter().any(|name| name.ends_with(".tmp")) {
        assert!(start.elapsed() < Duration::from_secs(60), "no temporary file after a minute");
        thread::sleep(Duration::from_millis(10));
    }
    child
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

#[test]
fn a_signal_leaves_no_temporary_file() {
    let folder = folder("signals");
    compile(&[WALK.to_owned()], &folder);
    for (signal, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        let mut child = started(&folder, "");
        send(signal, &child);
        assert_eq!(child.wait().unwrap().code(), Some(code), "{signal}");
        assert_eq!(files(&folder), ["motion.fbdb", "scene.toml"]);
    }
}

#[test]
fn a_signal_that_was_ignored_stays_ignored() {
    let folder = folder("nohup");
    compile(&[WALK.to_owned()], &folder);
    let mut child = started(&folder, "trap '' HUP;");
    send("HUP", &child);
    thread::sleep(Duration::from_millis(300));
    assert_eq!(child.try_wait().unwrap(), None);
    send("TERM", &child);
    assert_eq!(child.wait().unwrap().code(), Some(143));
}

#[test]
fn a_killed_process_leaves_nothing_for_long() {
    let folder = folder("killed");
    compile(&[WALK.to_owned()], &folder);
    let mut child = started(&folder, "");
    send("KILL", &child);
    child.wait().unwrap();
    assert_eq!(files(&folder).len(), 3);
    fbcrowd(&["compile", WALK, "-o", text(&folder.join("n".repeat(255)))]).expect_code(0);
    assert!(!files(&folder).iter().any(|name| name.ends_with(".tmp")));
}
