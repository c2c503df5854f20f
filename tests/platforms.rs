//! The same input gives the same bytes on every platform: databases, recordings, PNG and EXR frames, and frames of
//! cameras.
//!
//! `golden/sums.txt` holds the SHA-256 of the outputs of all bundled scenarios. This build must give the same sums, and
//! so must builds for other platforms, which an emulator runs. `.ci/clients` makes these builds.

mod support;

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sha2::{Digest, Sha256};
use support::{files, folder, repository, text};

/// Frames that are drawn: one in five seconds.
const FRAMES: &str = "1001-1301x150";
/// Scenarios that an emulator simulates for minutes.
const LONG: [&str; 1] = ["rimea/12_c_two_bottlenecks"];
/// Beginnings of the names of scenarios that take this build too long; `fbcrowd bench rimea` simulates them.
const LARGE: [&str; 8] =
    ["rimea/04", "rimea/09", "rimea/11", "rimea/12_a", "rimea/12_b", "rimea/12_d", "rimea/12_passage", "rimea/15"];
/// Command that writes the sums.
const REWRITE: &str = "cargo test -p fbcrowd --test platforms -- --ignored rewrite";

/// A build of `fbcrowd`, as the words of the command that runs it.
struct Program(Vec<String>);

impl Program {
    /// The program of this build.
    fn native() -> Self {
        Self(vec![env!("CARGO_BIN_EXE_fbcrowd").to_owned()])
    }

    /// Runs it in the repository's root; paths among the arguments are absolute, as WASI needs them.
    #[track_caller]
    fn run(&self, arguments: &[&str]) {
        let mut command = Command::new(&self.0[0]);
        command.args(&self.0[1..]).args(arguments).arg("--no-sync").current_dir(repository());
        let output = command.output().unwrap_or_else(|error| panic!("{}: {error}", self.0[0]));
        assert!(output.status.success(), "{arguments:?}:\n{}", String::from_utf8_lossy(&output.stderr));
    }

    /// Lines `SHA-256  NAME`: of the database of the bundled clips, and of recording and frames of each scenario.
    #[track_caller]
    fn sums(&self, scenarios: &[String], folder: &Path) -> Vec<String> {
        let (database, recording) = (folder.join("motion.fbdb"), folder.join("crowd.fbrec"));
        self.run(&["compile", text(&assets().join("clips")), "-o", text(&database)]);
        let mut sums = vec![sum("motion.fbdb", std::slice::from_ref(&database))];
        for name in scenarios {
            let scenario = assets().join(format!("scenarios/{name}.toml"));
            self.run(&["simulate", text(&scenario), "--db", text(&database), "-o", text(&recording)]);
            sums.push(sum(&format!("{name}.fbrec"), std::slice::from_ref(&recording)));
            for format in ["png", "exr"] {
                let frames = folder.join(name).join(format);
                self.run(&["render", text(&recording), "-o", text(&frames), "--format", format, "--frames", FRAMES]);
                let frames: Vec<PathBuf> = files(&frames).iter().map(|file| frames.join(file)).collect();
                sums.push(sum(&format!("{name}.{format}"), &frames));
            }
            if fs::read_to_string(&scenario).unwrap().contains("[camera") {
                let frames = folder.join(name).join("camera");
                let to = ["render", text(&recording), "-o", text(&frames), "--view", "camera", "--size", "640x360"];
                self.run(&[&to[..], &["--frames", FRAMES]].concat());
                let frames: Vec<PathBuf> = files(&frames).iter().map(|file| frames.join(file)).collect();
                sums.push(sum(&format!("{name}.camera"), &frames));
            }
            // WASI reports every file as read-only, so no recording replaces another.
            fs::remove_file(&recording).unwrap();
        }
        sums
    }
}

/// One line: SHA-256 of the files' bytes, one file after the other, and a name.
fn sum(name: &str, files: &[PathBuf]) -> String {
    let bytes: Vec<u8> = files.iter().flat_map(|file| fs::read(file).unwrap()).collect();
    let digits: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    format!("{digits}  {name}")
}

fn assets() -> PathBuf {
    repository().join("assets")
}

/// Names of the bundled scenarios but the large ones.
fn bundled() -> Vec<String> {
    let names = |folder: &str| {
        let files = files(&assets().join("scenarios").join(folder));
        let stems: Vec<String> =
            files.iter().filter_map(|file| file.strip_suffix(".toml").map(str::to_owned)).collect();
        let stems = stems.into_iter().filter(|stem| !stem.ends_with("_large"));
        stems.map(|stem| format!("{folder}{stem}")).collect::<Vec<String>>()
    };
    let all = [names(""), names("rimea/")].concat();
    all.into_iter().filter(|name| !LARGE.iter().any(|large| name.starts_with(large))).collect()
}

/// The file of the sums.
fn golden() -> PathBuf {
    repository().join("tests/golden/sums.txt")
}

/// Fails unless the file holds each of these sums.
#[track_caller]
fn check(sums: &[String]) {
    let golden = fs::read_to_string(golden()).unwrap();
    let other: Vec<&str> =
        sums.iter().map(String::as_str).filter(|sum| !golden.lines().any(|line| line == *sum)).collect();
    let remedy = format!("if all platforms are to give other bytes than before: {REWRITE}");
    assert!(other.is_empty(), "tests/golden/sums.txt holds other sums than these:\n{}\n{remedy}", other.join("\n"));
}

#[test]
fn bundled_scenarios_have_their_sums() {
    check(&Program::native().sums(&bundled(), &folder("sums")));
}

#[test]
#[ignore = "needs a build for another platform: set FBCROWD_PLATFORM to the command that runs it, as .ci/clients does"]
fn another_platform_gives_the_same_sums() {
    let command = env::var("FBCROWD_PLATFORM").expect("set FBCROWD_PLATFORM to the command that runs the build");
    let program = Program(command.split_whitespace().map(str::to_owned).collect());
    let short: Vec<String> = bundled().into_iter().filter(|name| !LONG.contains(&name.as_str())).collect();
    check(&program.sums(&short, &folder("sums_of_platform")));
}

#[test]
#[ignore = "rewrites the sums"]
fn rewrite_the_sums() {
    let sums = Program::native().sums(&bundled(), &folder("sums_rewritten"));
    fs::write(golden(), sums.join("\n") + "\n").unwrap();
}
