//! No mutation of a clip makes its import panic.

use std::path::Path;

use fbcrowd_bench::soak::mutation::{Edit, mutated};
use motiondb_compiler::import::import_bytes;
use proptest::prelude::*;

use super::written_body::{bvh_text, gltf_text};

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let edit = any::<(u64, u8, u32)>().prop_map(|(position, kind, value)| Edit { position, kind, value });
    prop::collection::vec(edit, 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_mutation_of_a_bvh_panics(edits in edits()) {
        let _ = import_bytes(Path::new("walk.bvh"), &mutated(bvh_text().as_bytes(), &edits));
    }

    #[test]
    fn no_mutation_of_a_bvh_header_panics(edits in edits()) {
        let text = bvh_text();
        let (head, tail) = text.split_at(text.find("MOTION").unwrap() + 60);
        let _ = import_bytes(Path::new("walk.bvh"), &[&mutated(head.as_bytes(), &edits), tail.as_bytes()].concat());
    }

    #[test]
    fn no_mutation_of_a_gltf_panics(edits in edits()) {
        let text = gltf_text("LINEAR");
        let (head, tail) = text.split_at(text.find(";base64").unwrap());
        let _ = import_bytes(Path::new("walk.gltf"), &[&mutated(head.as_bytes(), &edits), tail.as_bytes()].concat());
    }
}
