//! Scenario files give what they describe, and every mistake is shown at its position in the text.

mod agent_files;
mod agent_tables;
#[path = "../common/mod.rs"]
mod common;
mod ground;
mod markings;
mod sources;
mod support;
mod top_level;
