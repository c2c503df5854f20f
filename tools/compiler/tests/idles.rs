//! Claims about clips that stand.

use std::fs;
use std::path::Path;

use motiondb_compiler::{HumanClip, Options, compile, import_bytes, import_file};

const CLIPS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");

/// The bundled idle, cut after so many frames.
fn idle(frames: usize) -> HumanClip {
    let text = fs::read_to_string(Path::new(CLIPS).join("idle.bvh")).unwrap();
    let (head, rows) = text.split_once("Frame Time:").unwrap();
    let (skeleton, _) = head.split_once("Frames:").unwrap();
    let rows: Vec<&str> = rows.lines().take(1 + frames).collect();
    let cut = format!("{skeleton}Frames: {frames}\nFrame Time:{}\n", rows.join("\n"));
    import_bytes(Path::new("idle.bvh"), cut.as_bytes()).unwrap().remove(0).outcome.unwrap()
}

#[test]
fn an_idle_closes_wherever_it_is_cut() {
    let walk = import_file(&Path::new(CLIPS).join("walk_110.bvh")).unwrap().remove(0).outcome.unwrap();
    for frames in [50, 60, 70, 80, 90, 100, 110, 120] {
        let db = compile(vec![walk.clone(), idle(frames)], &Options::default(), &|_| ());
        assert!(db.is_ok(), "{frames} frames: {:?}", db.err());
    }
}
