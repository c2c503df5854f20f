//! Claims about the compiler that need what the benches have: independent measurements, and mutations.

mod ground_truth;
mod in_place;
mod mutations;
#[path = "../support/mod.rs"]
mod support;
#[path = "../../../compiler/tests/import/written_body.rs"]
mod written_body;
