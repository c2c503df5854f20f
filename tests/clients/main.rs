//! Programs of other people read what FbCrowd writes: OpenImageIO, jsonschema, pandas, and Blender as a Python package.
//!
//! Each test makes its own virtual environment in `target/clients`, with the versions that `requirements*.txt` pin, and
//! runs a check that lies beside this file. Where Python or a package cannot be had, the test prints `skipped:` and why.
//! They are ignored by default, since they need the network once: `cargo test -p fbcrowd --test clients -- --ignored`.

#[path = "../support/mod.rs"]
mod support;

mod environment;

use std::fs;
use std::path::{Path, PathBuf};

use environment::{Environment, skip};
use support::{fbcrowd, folder, repository, text};

/// A small crowd that was simulated, in a folder of its own.
struct Crowd {
    folder: PathBuf,
    recording: PathBuf,
}

impl Crowd {
    fn new(name: &str) -> Self {
        let folder = folder(&format!("clients_{name}"));
        let scenario = fs::read_to_string(repository().join("assets/scenarios/crossing.toml")).unwrap();
        let clips = repository().join("assets/clips");
        let scenario = scenario.replace("\"../clips\"", &format!("\"{}\"", text(&clips)));
        let of_duration =
            |line: &str| if line.starts_with("duration_s") { "duration_s = 3".into() } else { line.to_owned() };
        let scenario = scenario.lines().map(of_duration).collect::<Vec<String>>().join("\n");
        let [file, database] = ["crossing.toml", "motion.fbdb"].map(|name| folder.join(name));
        fs::write(&file, scenario).unwrap();
        let report = fbcrowd(&["compile", "assets/clips", "-o", text(&database), "--json"]).expect_code(0).stdout;
        fs::write(folder.join("compile.clips.json"), report).unwrap();
        let recording = folder.join("crossing.fbrec");
        let timings = folder.join("simulate.crossing.json");
        let arguments = ["simulate", text(&file), "--db", text(&database), "-o", text(&recording)];
        fbcrowd(&[&arguments[..], &["--report", text(&timings)]].concat()).expect_code(0);
        Self { folder, recording }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Frames of the recording with further arguments.
    fn render(&self, name: &str, arguments: &[&str]) -> PathBuf {
        let output = self.path(name);
        fbcrowd(&[&["render", text(&self.recording), "-o", text(&output)], arguments].concat()).expect_code(0);
        output
    }

    /// Frame 1090 of the camera view with all passes.
    fn passes(&self) -> PathBuf {
        let arguments = ["--view", "camera", "--format", "exr", "--passes", "all", "--size", "640x360"];
        self.render("passes", &[&arguments[..], &["--frames", "1090"]].concat()).join("crossing.1090.exr")
    }

    /// Standard output of a command, as a file.
    fn save(&self, name: &str, arguments: &[&str]) {
        fs::write(self.path(name), fbcrowd(arguments).stdout).unwrap();
    }
}

fn python() -> Option<Environment> {
    Environment::new("requirements.txt", &["python3"])
}

#[test]
#[ignore = "needs Python packages from PyPI: .ci/clients runs it"]
fn openimageio_reads_frames() {
    let Some(python) = python() else { return skip("frames", "no Python 3, or PyPI gives no packages here") };
    let crowd = Crowd::new("frames");
    let [png, exr] =
        ["png", "exr"].map(|format| crowd.render(format, &["--format", format, "--frames", "1001,1045,1090"]));
    python.check("frames.py", &[text(&png), text(&exr)]);
}

#[test]
#[ignore = "needs Python packages from PyPI: .ci/clients runs it"]
fn openimageio_reads_passes_and_blender_their_matte() {
    let Some(python) = python() else { return skip("passes", "no Python 3, or PyPI gives no packages here") };
    let passes = Crowd::new("passes").passes();
    let printed = python.check("passes.py", &[text(&passes)]);
    let (name, coverage) = printed.lines().last().and_then(|line| line.split_once(' ')).expect("name and coverage");
    // Blender's package asks for Python 3.11.
    let Some(blender) = Environment::new("requirements-blender.txt", &["python3.11"]) else {
        return skip("a matte in Blender", "no Python 3.11, or PyPI does not give bpy here");
    };
    blender.check("blender_matte.py", &[text(&passes), "640", "360", name, coverage]);
}

#[test]
#[ignore = "needs Python packages from PyPI: .ci/clients runs it"]
fn jsonschema_and_pandas_read_reports_and_tables() {
    let Some(python) = python() else { return skip("JSON and tables", "no Python 3, or PyPI gives no packages here") };
    let crowd = Crowd::new("reports");
    let [database, table, trajectories] = ["motion.fbdb", "table.csv", "trajectories.txt"].map(|name| crowd.path(name));
    crowd.save("inspect.database.json", &["inspect", text(&database), "--json"]);
    crowd.save("inspect.clips.json", &["inspect", "assets/clips", "--json"]);
    crowd.save("validate.database.json", &["validate", text(&database), "--json"]);
    let measure = ["measure", text(&crowd.recording), "--json", "--table", text(&table)];
    crowd.save("measure.crossing.json", &[&measure[..], &["--trajectories", text(&trajectories)]].concat());
    crowd.save("bench-blend-space.json", &["bench", "blend-space", "--json"]);
    let mut reports: Vec<PathBuf> = fs::read_dir(&crowd.folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    reports.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    reports.sort();
    assert_eq!(reports.len(), 7, "{reports:?}");
    let schemas = repository().join("docs/schemas");
    let arguments: Vec<&str> =
        [schemas.as_path()].into_iter().chain(reports.iter().map(PathBuf::as_path)).map(text).collect();
    python.check("json_schemas.py", &arguments);
    python.check("tables.py", &[text(&table), text(&trajectories)]);
}

/// The folder of the checks.
fn checks() -> PathBuf {
    repository().join(Path::new("tests/clients"))
}
