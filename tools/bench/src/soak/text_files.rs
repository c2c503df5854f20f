//! Manifests and scenarios: mutated texts. A manifest that is accepted is compiled, a scenario simulated.

use std::sync::Arc;

use fbcrowd_sim::scenario;
use motiondb::files::SourceText;
use motiondb::motion::MotionDb;
use motiondb_compiler::{Manifest, compile_manifest};

use crate::error::BenchError;
use crate::soak::databases::{check_invariants, moves_bodies};
use crate::soak::draw::Draw;
use crate::soak::mutation::mutated;
use crate::soak::scratch::Scratch;
use crate::soak::tally::CopyOutcome;

/// The clips that the manifest names.
const CLIPS: [&str; 3] = ["run_350.bvh", "walk_140.glb", "walk_110.bvh"];
/// A manifest with every key.
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
/// A scenario with every form of agents, and obstacles between them.
const SCENARIO: &str = include_str!("../../../../fuzz/corpus/scenario/everything.toml");
/// Most agents of a scenario that is simulated: a mutated number may be large.
const MOST_AGENTS: usize = 64;

/// Writes the clips to the folder in which the manifests name them.
pub(crate) fn write_clips(scratch: &Scratch) -> Result<(), BenchError> {
    for clip in clipgen::generate().iter().filter(|clip| CLIPS.contains(&clip.name.as_str())) {
        scratch.write(&clip.name, &clip.bytes)?;
    }
    Ok(())
}

/// Mutates a manifest.
pub(crate) fn manifest(scratch: &Scratch, draw: &mut Draw) -> CopyOutcome {
    // No path leads out of the folder.
    let text = mutated_text(MANIFEST, draw).replace('/', "-").replace("..", "._");
    let source = SourceText { path: scratch.path().join("manifest.toml"), text };
    let Ok(manifest) = Manifest::parse(source) else {
        return CopyOutcome::Rejected;
    };
    compile_manifest(&manifest, &|_| ()).map_or(CopyOutcome::Rejected, |compiled| check_invariants(&compiled.db))
}

/// Mutates a scenario.
pub(crate) fn scenario(db: &Arc<MotionDb>, scratch: &Scratch, draw: &mut Draw) -> CopyOutcome {
    let text = mutated_text(SCENARIO, draw);
    match scratch.with(draw, text.as_bytes(), scenario::read) {
        Ok((scenario, _)) if scenario.agents.len() <= MOST_AGENTS => moves_bodies(db, &scenario),
        Ok(_) => CopyOutcome::Used,
        Err(_) => CopyOutcome::Rejected,
    }
}

/// A mutated text.
fn mutated_text(text: &str, draw: &mut Draw) -> String {
    String::from_utf8_lossy(&mutated(text.as_bytes(), &draw.edits(text.len()))).into_owned()
}
