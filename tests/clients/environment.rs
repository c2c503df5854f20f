//! A virtual environment with pinned packages, kept in `target/clients` between runs.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, PoisonError};

use sha2::{Digest, Sha256};

use crate::checks;
use crate::support::repository;

/// Held while an environment is made.
static MAKING: Mutex<()> = Mutex::new(());

/// A Python with packages.
pub(crate) struct Environment {
    python: PathBuf,
}

impl Environment {
    /// The environment of a list of packages with the first of some Pythons that is there; none where one of them cannot
    /// be had. It is made once for each list and Python version.
    pub(crate) fn new(requirements: &str, pythons: &[&str]) -> Option<Self> {
        let (python, version) = pythons.iter().flat_map(|name| candidates(name)).find_map(|python| {
            let version = run(Command::new(&python).arg("--version")).ok()?;
            Some((python, version.stdout))
        })?;
        let list = checks().join(requirements);
        let key = Sha256::new().chain_update(fs::read(&list).ok()?).chain_update(&version).finalize();
        let key: String = key.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
        let folder = repository().join("target/clients").join(format!("python-{key}"));
        let environment = Self { python: folder.join("bin/python") };
        // Tests of one process run at once, and one makes the environment for all.
        let _one_at_a_time = MAKING.lock().unwrap_or_else(PoisonError::into_inner);
        if folder.join("complete").exists() {
            return Some(environment);
        }
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.parent()?).ok()?;
        run(Command::new(&python).args(["-m", "venv"]).arg(&folder)).map_err(|error| eprintln!("{error}")).ok()?;
        let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
        run(Command::new(&environment.python).args(pip).arg(&list)).map_err(|error| eprintln!("{error}")).ok()?;
        fs::write(folder.join("complete"), "").ok()?;
        Some(environment)
    }

    /// Runs a check, which must succeed; returns what it prints.
    #[track_caller]
    pub(crate) fn check(&self, script: &str, arguments: &[&str]) -> String {
        let output = run(Command::new(&self.python).arg(checks().join(script)).args(arguments));
        let output = output.unwrap_or_else(|error| panic!("{script}: {error}"));
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        print!("{printed}");
        printed
    }
}

/// Says that a check did not run, and why.
pub(crate) fn skip(what: &str, reason: &str) {
    println!("skipped: {what}: {reason}");
}

/// A Python on the path, and those of its name among the versions of pyenv.
fn candidates(name: &str) -> Vec<PathBuf> {
    let home = std::env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
    let root = std::env::var_os("PYENV_ROOT").map_or_else(|| home.join(".pyenv"), PathBuf::from);
    let versions = fs::read_dir(root.join("versions")).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> = versions.map(|entry| entry.path().join("bin").join(name)).collect();
    found.retain(|path| path.exists());
    found.sort();
    [vec![Path::new(name).to_owned()], found].concat()
}

/// The output of a command that succeeds; else what it says.
fn run(command: &mut Command) -> Result<Output, io::Error> {
    let output = command.output()?;
    match output.status.success() {
        true => Ok(output),
        false => Err(io::Error::other(String::from_utf8_lossy(&output.stderr).into_owned())),
    }
}
