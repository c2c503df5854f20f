//! Compiles a folder of clips into a motion database, reports what each clip gives, and writes the database.
//!
//! ```text
//! cargo run --release -p motiondb-compiler --example compile_a_folder -- assets/clips motion.fbdb
//! ```
//!
//! Both arguments are optional; these are the defaults.

use std::error::Error;
use std::path::PathBuf;

use motiondb::files::database_file;
use motiondb_compiler::{CompileEvent, clip_files, compile_files};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let folder = arguments.next().unwrap_or_else(|| "assets/clips".into());
    let output = arguments.next().unwrap_or_else(|| "motion.fbdb".into());

    let observer = |event: CompileEvent| {
        if let CompileEvent::Stage(name) = event {
            eprintln!("{name}");
        }
    };
    let compiled = compile_files(&clip_files(&folder)?, &observer)?;
    for rejection in &compiled.rejected {
        println!("not used: {rejection}");
    }
    for source in &compiled.db.sources {
        for diagnostic in &source.diagnostics {
            println!("{}: {diagnostic}", source.file);
        }
    }
    for example in compiled.db.examples.iter().filter(|example| !example.mirrored) {
        let [speed_mps, turn_rate_rad_s, strafe_mps] = example.parameters.to_vec3().to_array();
        println!("{:<24} {speed_mps:5.2} m/s {turn_rate_rad_s:6.2} rad/s {strafe_mps:5.2} m/s aside", example.name);
    }
    database_file::write(&output, &compiled.db)?;
    println!("{}: {} examples", output.display(), compiled.db.examples.len());
    Ok(())
}
