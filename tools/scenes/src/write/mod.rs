//! From a [`Scene`](crate::scene::Scene) to the text of a scenario file that reads as if a person had written it.
//!
//! Enters: a scene. Leaves: the scenario, and the agent files that it names. Read `scenario_text` (the order of the
//! tables), `words` (numbers, names, lists), then `agent_tables` with `example`, `behaviour_tables`, `ground_tables`.

mod agent_tables;
mod behaviour_tables;
mod example;
mod ground_tables;
mod scenario_text;
mod text_file;
mod words;

pub use scenario_text::{WriteOptions, WrittenScene, write};
pub use text_file::TextFile;
