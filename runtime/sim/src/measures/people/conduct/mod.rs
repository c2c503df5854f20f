//! How bodies carry themselves in a crowd: turns, queues, narrow gaps, head and wrists.
//!
//! Enters: the track of each body. Leaves: figures of the crowd.
//!
//! Read `turning`, `queue`, `shoulder_turn`, `upper_body`.

pub(crate) mod queue;
pub(crate) mod shoulder_turn;
pub(crate) mod turning;
pub(crate) mod upper_body;

pub(crate) use queue::QueueTally;
pub use queue::Queues;
pub use shoulder_turn::shoulder_turn_deg;
pub use turning::Turning;
pub(crate) use turning::TurningTally;
pub use upper_body::UpperBodies;
pub(crate) use upper_body::UpperBodyTally;
