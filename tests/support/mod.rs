//! The tests of the command line share: the built binary, a folder for each test, and the clips of others.
#![allow(dead_code, unreachable_pub, reason = "every test target includes this file and uses its own share of it")]

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use fbcrowd_bench::compiler::ground_truth::marine_files;
use serde_json::Value;

/// A bundled clip, from the repository's root.
pub const WALK: &str = "assets/clips/walk_110.bvh";

/// The outcome of a command.
pub struct Outcome {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    /// Fails with all output of the command unless it ended with this exit code.
    #[track_caller]
    pub fn expect_code(self, code: i32) -> Self {
        assert_eq!(self.code, code, "stdout:\n{}\nstderr:\n{}", self.stdout, self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        self
    }

    /// Fails unless standard error names each of these.
    #[track_caller]
    pub fn says(self, words: &[&str]) -> Self {
        // The reporter wraps long lines: the comparison ignores line breaks and their decoration.
        let flat =
            |text: &str| text.chars().filter(|letter| !letter.is_whitespace() && *letter != '│').collect::<String>();
        let printed = flat(&self.stderr);
        for word in words {
            assert!(printed.contains(&flat(word)), "`{word}` is missing from:\n{}", self.stderr);
        }
        self
    }

    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error} in\n{}", self.stdout))
    }
}

/// Runs the built `fbcrowd` in the repository's root.
pub fn fbcrowd(arguments: &[&str]) -> Outcome {
    let output = Command::new(env!("CARGO_BIN_EXE_fbcrowd"))
        .args(arguments)
        .current_dir(repository())
        .output()
        .expect("the built binary starts");
    Outcome {
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the repository exists")
}

/// An empty folder of the test's own.
pub fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("cargo's temporary folder is writable");
    folder
}

/// Files of a folder by name, sorted; hidden and temporary ones too.
pub fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .map(|entries| entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect())
        .unwrap_or_default();
    names.sort();
    names
}

/// A path as an argument.
pub fn text(path: &Path) -> &str {
    path.to_str().expect("the tests' paths are UTF-8")
}

/// Writes `folder/scene.toml`.
pub fn scenario(folder: &Path, content: &str) -> String {
    let path = folder.join("scene.toml");
    fs::write(&path, content).unwrap();
    text(&path).to_owned()
}

/// The folder of other people's clips. Tests that need it are ignored unless it is given.
pub fn mocap() -> PathBuf {
    let folder = env::var_os("FBCROWD_MOCAP").map(PathBuf::from);
    let folder = folder.expect("set FBCROWD_MOCAP to the folder of other people's clips, as an absolute path");
    assert!(folder.is_dir(), "FBCROWD_MOCAP: {} is no folder", folder.display());
    folder
}

/// Paths of the twelve recordings that make the paper's 19 examples.
pub fn marine_clips() -> Vec<String> {
    marine_files(&mocap()).iter().map(|path| text(path).to_owned()).collect()
}

/// Compiles clips into `folder/motion.fbdb`.
pub fn compile(clips: &[String], folder: &Path) -> PathBuf {
    let database = folder.join("motion.fbdb");
    let mut arguments = vec!["compile"];
    arguments.extend(clips.iter().map(String::as_str));
    arguments.extend(["-o", text(&database)]);
    fbcrowd(&arguments).expect_code(0);
    database
}

/// Fails unless JSON has exactly the keys and types of `docs/schemas/NAME.schema.json`.
#[track_caller]
pub fn check_schema(name: &str, json: &Value) {
    let path = repository().join(format!("docs/schemas/{name}.schema.json"));
    let schema = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let validator = jsonschema::validator_for(&serde_json::from_str(&schema).unwrap()).unwrap();
    let errors: Vec<String> =
        validator.iter_errors(json).map(|error| format!("{}: {error}", error.instance_path())).collect();
    assert!(errors.is_empty(), "{name}:\n{}", errors.join("\n"));
}
