//! Files of `docs/` that are generated from the report structs: the JSON schemas, and `json.md`, which describes them.
//!
//! In: the schemas of all reports ([`schemas`]). Out: the files' texts, the description by [`markdown`]. The test below
//! compares them with the files; `FBCROWD_WRITE_DOCS=1 cargo test -p fbcrowd docs` writes them.

mod markdown;
mod schemas;

use std::path::{Path, PathBuf};
use std::{env, fs};

/// Path within the repository and text of every generated file.
fn generated_files() -> Vec<(PathBuf, String)> {
    let schemas = schemas::schemas();
    let description = (PathBuf::from("docs/json.md"), markdown::document(&schemas));
    let files = schemas.into_iter().map(|schema| {
        let text = serde_json::to_string_pretty(&schema.content).unwrap() + "\n";
        (PathBuf::from(format!("docs/schemas/{}.schema.json", schema.name)), text)
    });
    files.chain([description]).collect()
}

#[test]
fn generated_docs_match_the_report_structs() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for (path, text) in generated_files() {
        let file = repository.join(&path);
        if env::var_os("FBCROWD_WRITE_DOCS").is_some() {
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(&file, &text).unwrap();
        }
        let found = fs::read_to_string(&file).unwrap_or_default();
        let remedy = "run FBCROWD_WRITE_DOCS=1 cargo test -p fbcrowd docs";
        assert!(found == text, "{} differs from the report structs; {remedy}", path.display());
    }
}

#[test]
fn every_schema_file_has_a_report() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/schemas");
    let mut found: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    let mut wanted: Vec<String> =
        schemas::schemas().iter().map(|schema| format!("{}.schema.json", schema.name)).collect();
    found.sort();
    wanted.sort();
    assert_eq!(found, wanted);
}
