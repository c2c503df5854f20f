//! What the tests of the whole share: the built binary, a folder each, and other people's clips where they are.
#![allow(dead_code, unreachable_pub, reason = "every test target includes this file and uses its own share of it")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use motiondb_compiler::truth::marine_files;
use serde_json::Value;

/// A bundled clip, from the repository's root.
pub const WALK: &str = "assets/clips/walk_110.bvh";

/// What a command did.
pub struct Outcome {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    /// Fails with everything that the command said unless it ended with this code.
    #[track_caller]
    pub fn expect_code(self, code: i32) -> Self {
        assert_eq!(self.code, code, "stdout:\n{}\nstderr:\n{}", self.stdout, self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        self
    }

    /// Fails unless standard error names each of these.
    #[track_caller]
    pub fn says(self, words: &[&str]) -> Self {
        // The reporter wraps long lines: compare without line breaks and their decoration.
        let flat =
            |text: &str| text.chars().filter(|letter| !letter.is_whitespace() && *letter != '│').collect::<String>();
        let said = flat(&self.stderr);
        for word in words {
            assert!(said.contains(&flat(word)), "`{word}` is missing from:\n{}", self.stderr);
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

/// `../shared/NAME` beside the repository, or a line that says the test was skipped.
pub fn shared(test: &str, name: &str) -> Option<PathBuf> {
    let path = repository().join("../shared").join(name);
    if path.exists() {
        return Some(path);
    }
    println!("SKIPPED {test}: {} is not there", path.display());
    None
}

/// Paths of the twelve recordings that make the paper's 19 examples.
pub fn marine_clips(test: &str) -> Option<Vec<String>> {
    let mocap = shared(test, "mocap")?;
    Some(marine_files(&mocap).iter().map(|path| text(path).to_owned()).collect())
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
