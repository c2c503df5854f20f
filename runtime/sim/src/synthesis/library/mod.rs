//! Data shared by all bodies: the motion database, with standing and stepping examples added where crowds need them,
//! and values derived from it once.
//!
//! Enters: a motion database and the tunables. Leaves: the synthesis context that every step of every body reads.
//!
//! Read `synthesis_context`, then its parts: `augmented_database` with `standing`, `starts`, and `hybrid_data`.

pub(crate) mod augmented_database;
pub(crate) mod hybrid_data;
pub(crate) mod standing;
pub(crate) mod starts;
pub(crate) mod synthesis_context;

pub use augmented_database::{augmented, deformed_walk};
pub use hybrid_data::HybridData;
pub use synthesis_context::SynthesisContext;
pub(crate) use synthesis_context::context_of;
