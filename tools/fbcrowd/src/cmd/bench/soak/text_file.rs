//! Manifests and scenarios: mutated text that names clips and agents; what is accepted is compiled, or simulated.

use std::sync::Arc;

use fbcrowd_sim::scenario;
use motiondb::files::SourceText;
use motiondb::motion::MotionDb;
use motiondb_compiler::Manifest;
use motiondb_compiler::compile::compile_manifest;
use motiondb_compiler::mutation::mutated;

use crate::cmd::bench::soak::scratch::Scratch;
use crate::cmd::bench::soak::{Draw, Fate, database, judged};
use crate::failure::Failure;

/// The clips that the manifest names.
const CLIPS: [&str; 3] = ["run_350.bvh", "walk_140.glb", "walk_110.bvh"];
/// Every key of a manifest.
const MANIFEST: &str = r#"
semi_procedural = "stroll"
target_skeleton = "walk_140"
max_examples = 40
velocity_hull = "paper"

[[clips]]
path = "run_350.bvh"
metres_per_unit = 0.01
up = "+Y"
forward = "+Z"
frame_rate_hz = 60.0

[[clips]]
path = "walk_110.bvh"
name = "stroll"
frames = [1, 120]
joints = { neck = "Neck", head = "Head" }
mirror = true

[[clips]]
path = "walk_140.glb"
skip = false
"#;
/// Every way to place agents, and obstacles between them.
const SCENARIO: &str = include_str!("../../../../../../fuzz/corpus/scenario/everything.toml");
/// More agents than this are not simulated: their number is the scenario's own wish.
const MOST_AGENTS: usize = 64;

/// Puts the clips where the manifests look for them.
pub(super) fn write_clips(scratch: &Scratch) -> Result<(), Failure> {
    for clip in clipgen::generate().iter().filter(|clip| CLIPS.contains(&clip.name.as_str())) {
        scratch.write(&clip.name, &clip.bytes)?;
    }
    Ok(())
}

/// Mutates a manifest.
pub(super) fn manifest(scratch: &Scratch, draw: &mut Draw) -> Fate {
    // No path leads out of the folder.
    let text = mutated_text(MANIFEST, draw).replace('/', "-").replace("..", "._");
    let source = SourceText { path: scratch.path().join("manifest.toml"), text };
    let Ok(manifest) = Manifest::parse(source) else {
        return Fate::Refused;
    };
    compile_manifest(&manifest, &|_| ()).map_or(Fate::Refused, |compiled| judged(&compiled.db))
}

/// Mutates a scenario.
pub(super) fn scenario(db: &Arc<MotionDb>, scratch: &Scratch, draw: &mut Draw) -> Fate {
    let text = mutated_text(SCENARIO, draw);
    match scratch.with(draw, text.as_bytes(), scenario::read) {
        Ok((scenario, _)) if scenario.agents.len() <= MOST_AGENTS => database::moves_bodies(db, &scenario),
        Ok(_) => Fate::Used,
        Err(_) => Fate::Refused,
    }
}

fn mutated_text(text: &str, draw: &mut Draw) -> String {
    String::from_utf8_lossy(&mutated(text.as_bytes(), &draw.edits(text.len()))).into_owned()
}
