//! Converts a scene and prints the scenario.
//!
//!     cargo run -p fbcrowd-scenes --example convert_a_scene -- SCENE

use std::env;
use std::path::PathBuf;
use std::process::ExitCode;

use fbcrowd_scenes::write::{WriteOptions, write};
use fbcrowd_scenes::{ReadOptions, read};

fn main() -> ExitCode {
    let Some(path) = env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("name a scene");
        return ExitCode::from(2);
    };
    match read(&path, &ReadOptions::default()) {
        Ok(read) => {
            for note in read.scene.notes.list() {
                eprintln!(
                    "{}:{}: {} (changes: {}, {} times)",
                    note.file, note.line, note.what, note.changes, note.count
                );
            }
            println!("{}", write(&read.scene, &WriteOptions::default()).scenario);
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}
