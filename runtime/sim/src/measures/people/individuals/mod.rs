//! Whether the bodies of a crowd differ: in phase, in first steps, in cadence, and where they stand.
//!
//! Enters: the track of each body. Leaves: figures of the crowd.
//!
//! Read `phase_order` and `first_step` (after a common start), `cadence` (at equal speed), `standing`.

pub(crate) mod cadence;
pub(crate) mod first_step;
pub(crate) mod phase_order;
pub(crate) mod standing;

pub use cadence::CadenceSpread;
pub(crate) use cadence::Cadences;
pub(crate) use first_step::FirstStepTally;
pub use first_step::FirstSteps;
pub use phase_order::PhaseOrder;
pub(crate) use phase_order::PhaseOrders;
pub use standing::StandingBodies;
pub(crate) use standing::StandingTally;
