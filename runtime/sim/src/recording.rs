//! `.fbrec`: a simulation, recorded frame by frame while it runs; self-contained, any frame readable without the others.

use motiondb::skeleton::Skeleton;
use serde::{Deserialize, Serialize};

use crate::scenario::Scenario;

/// What a recording says once. No timings, no dates, no paths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// CRC-32 of the database that the bodies came from.
    pub database_checksum: u32,
    /// The bodies: bones, soles, capsules.
    pub skeleton: Skeleton,
    /// The whole scenario: agents, obstacles, parameters, dt, view.
    pub scenario: Scenario,
}
